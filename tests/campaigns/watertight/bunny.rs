//! A scanned mesh, its holes closed.

use super::solid::{Face, Solid};
use crate::random::Random;
use glam::DVec3;
use std::collections::{BTreeMap, HashSet};
use std::path::PathBuf;
use wavelane::load::load;

/// The file, in the folder that `WAVELANE_SCENES` names.
pub(super) fn file() -> Option<PathBuf> {
    let path = PathBuf::from(std::env::var_os("WAVELANE_SCENES")?).join("bunny.obj");
    path.exists().then_some(path)
}

/// Around each hole there is a fan of triangles to its middle, a strip of its own.
pub(super) fn bunny(_: &mut Random) -> Solid {
    let path = file().expect("there is a bunny where one is asked for");
    let geometry = load(&path).unwrap_or_else(|error| panic!("{error}")).scene.geometry;
    let corners: Vec<DVec3> = geometry.vertices.iter().map(|vertex| vertex.as_dvec3()).collect();
    let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
    let mut solid = Solid::new(corners, vec![middle]);
    for triangle in &geometry.triangles {
        solid.add(0, &triangle.vertices.map(|corner| corner as usize));
    }
    for (number, rim) in (1..).zip(rims(&solid)) {
        let middle = solid.corners.len();
        solid.corners.push(rim.iter().map(|&corner| solid.corners[corner]).sum::<DVec3>() / rim.len() as f64);
        for (&from, &to) in rim.iter().zip(rim.iter().cycle().skip(1)) {
            solid.add(number, &[from, to, middle]);
        }
    }
    solid
}

/// The rims of holes, as the faces that close them run along them.
fn rims(solid: &Solid) -> Vec<Vec<usize>> {
    let edges: HashSet<[usize; 2]> = solid.faces.iter().flat_map(Face::edges).collect();
    let open = edges.iter().filter(|[from, to]| !edges.contains(&[*to, *from]));
    let mut next: BTreeMap<usize, usize> = open.map(|&[from, to]| (to, from)).collect();
    let mut rims = Vec::new();
    while let Some((first, mut corner)) = next.pop_first() {
        let mut rim = vec![first];
        while let Some(beyond) = next.remove(&corner) {
            rim.push(corner);
            corner = beyond;
        }
        rims.push(rim);
    }
    rims
}
