//! What stands in a frame, and where the eye looks.

use super::bodies::{Body, Face};
use super::grid::{ANGLE, COMB, Grid, OCTAGON, SQUARE, STAR, Style, frame, icosphere, prism};
use crate::random::Random;
use glam::{DVec3, I64Vec3};
use wavelane::scene::{Geometry, MaterialId};

/// Bodies, and a place on one of them to look at.
pub(super) struct Setting {
    pub(super) name: &'static str,
    pub(super) geometry: Geometry,
    pub(super) bodies: Vec<Body>,
    /// World length.
    pub(super) size: f64,
    pub(super) center: DVec3,
    /// A point and the outward unit normal there.
    pub(super) aim: (DVec3, DVec3),
    /// From there along the surface to the edge, unit, where it lies next to one.
    pub(super) to_edge: Option<DVec3>,
}

const GLASS: MaterialId = MaterialId(0);

impl Setting {
    /// A point within a body, in one frame of three close to its surface.
    pub(super) fn inside(&self, random: &mut Random) -> DVec3 {
        let away = if random.one_in(3) { random.log_between(1e-4, 0.5) } else { random.between(0.05, 1.0) };
        let closed = self.bodies.iter().find(|body| !matches!(body, Body::Flat(_)));
        match closed {
            Some(Body::Sphere { center, radius, .. }) => center + random.direction() * *radius * (1.0 - away),
            Some(Body::Solid(faces)) => {
                let middle = middle(faces);
                let (wall, _, _) = place_on(random.pick(faces), false, random);
                wall + (middle - wall) * away
            }
            _ => self.center + random.direction() * self.size * away,
        }
    }

    fn new(
        name: &'static str,
        (geometry, bodies): (Geometry, Vec<Body>),
        grid: &Grid,
        at_edge: bool,
        random: &mut Random,
    ) -> Self {
        let faces = bodies.iter().flat_map(|body| match body {
            Body::Solid(faces) => faces.as_slice(),
            Body::Flat(face) => std::slice::from_ref(face),
            Body::Sphere { .. } => &[],
        });
        let faces: Vec<&Face> = faces.collect();
        let (point, normal, to_edge) = place_on(random.pick::<&Face>(&faces), at_edge, random);
        let center = grid.world(I64Vec3::ZERO);
        Self {
            name,
            geometry,
            bodies,
            size: grid.world_size(),
            center,
            aim: (point, normal),
            to_edge: Some(to_edge),
        }
    }
}

fn middle(faces: &[Face]) -> DVec3 {
    let corners = || faces.iter().flat_map(|face| &face.corners);
    corners().sum::<DVec3>() / corners().count() as f64
}

/// A point of a convex face, the normal, and the way to the nearest edge; everywhere alike, or close to an edge, or on it.
fn place_on(face: &Face, at_edge: bool, random: &mut Random) -> (DVec3, DVec3, DVec3) {
    let first = random.whole(0, face.corners.len() as i64 - 1) as usize;
    let (from, to) = (face.corners[first], face.corners[(first + 1) % face.corners.len()]);
    let normal = face.normal.normalize();
    let to_edge = (to - from).cross(normal).normalize();
    let on_edge = if random.one_in(6) { *random.pick(&[from, to]) } else { from.lerp(to, random.unit()) };
    let middle = face.corners.iter().sum::<DVec3>() / face.corners.len() as f64;
    let share = match random.whole(0, 2) {
        _ if at_edge => 0.0,
        0 => random.unit(),
        1 => random.log_between(2.0_f64.powi(-30), 1.0),
        _ => 0.0,
    };
    (on_edge.lerp(middle, share), normal, to_edge)
}

/// A sphere, a triangle or a polygon, and nothing else.
pub(super) fn alone(random: &mut Random) -> Setting {
    let grid = Grid::random(1, random);
    let mut geometry = Geometry::default();
    let size = grid.size as f64;
    let which = random.whole(0, 3);
    if which == 0 {
        return lone_sphere(&grid, random);
    }
    // Down to slivers.
    let narrow = size * random.log_between(4.0 / size, 1.0);
    let (name, outline, style, steps) = match which {
        1 => ("triangle", [[0, 0], [1, 0], [random.whole(0, 1), 1]].to_vec(), Style::Triangles, 1.0),
        2 => ("polygon", OCTAGON.to_vec(), Style::Polygons, 3.0),
        _ => {
            let outline = *random.pick(&[&ANGLE[..], &STAR[..], &COMB[..]]);
            ("concave polygon", outline.to_vec(), Style::Polygons, 6.0)
        }
    };
    let [a, b, _] = frame([size / steps, narrow.max(4.0 * steps) / steps, size], random);
    let corners = outline.iter().map(|&[i, j]| a * i + b * j).collect();
    let faces = grid.add(&[corners], style, &mut geometry, random);
    let bodies = faces.into_iter().map(Body::Flat).collect();
    Setting::new(name, (geometry, bodies), &grid, false, random)
}

fn lone_sphere(grid: &Grid, random: &mut Random) -> Setting {
    let mut geometry = Geometry::default();
    // Off the grid: a sphere is one wherever it stands.
    let radius = (grid.world_size() * random.between(0.25, 0.5)) as f32;
    let center = (grid.world(I64Vec3::ZERO) + random.direction() * f64::from(radius)).as_vec3();
    geometry.add_sphere(center, radius, GLASS).unwrap();
    let (center, radius) = (center.as_dvec3(), f64::from(radius));
    let normal = random.direction();
    Setting {
        name: "sphere",
        bodies: vec![Body::Sphere { id: geometry.spheres[0].id, center, radius }],
        geometry,
        size: 2.0 * radius,
        center,
        aim: (center + normal * radius, normal),
        to_edge: None,
    }
}

/// A closed convex solid; `at_edge`: looked at where two of its faces meet.
pub(super) fn solid(at_edge: bool, random: &mut Random) -> Setting {
    let grid = Grid::random(1, random);
    let size = grid.size as f64;
    let style = *random.pick(&[Style::Triangles, Style::Polygons, Style::Both]);
    let of = |names: [&'static str; 3]| names[style as usize];
    let thin = (size * random.log_between(1e-4, 0.1)).max(3.0);
    let (name, loops) = match random.whole(0, 4) {
        0 => {
            let lengths = [(); 3].map(|()| size * random.between(0.3, 0.6));
            (
                of(["brick of triangles", "brick of polygons", "brick of both"]),
                prism(&SQUARE, I64Vec3::ZERO, frame(lengths, random)),
            )
        }
        1 => {
            let [a, b, c] = frame([size / 6.0, size / 6.0, size * random.between(0.1, 0.6)], random);
            // Oblique.
            let c = c + a * random.whole(-2, 2);
            (
                of(["prism of triangles", "prism of polygons", "prism of both"]),
                prism(&OCTAGON, I64Vec3::ZERO, [a, b, c]),
            )
        }
        2 => (
            of(["needle of triangles", "needle of polygons", "needle of both"]),
            prism(&SQUARE, I64Vec3::ZERO, frame([thin, thin, 0.7 * size], random)),
        ),
        3 => {
            let lengths = [0.6 * size, 0.6 * size, thin];
            (
                of(["slab of triangles", "slab of polygons", "slab of both"]),
                prism(&SQUARE, I64Vec3::ZERO, frame(lengths, random)),
            )
        }
        _ => ("icosphere", icosphere(0.7 * size, random.whole(0, 2) as u32, random)),
    };
    let mut geometry = Geometry::default();
    match grid.add_solid(&loops, style, &mut geometry, random) {
        Some(body) => Setting::new(name, (geometry, vec![body]), &grid, at_edge, random),
        // The grid was too coarse for a ball of many faces.
        None => solid(at_edge, random),
    }
}
