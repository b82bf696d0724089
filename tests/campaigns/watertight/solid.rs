//! Closed surfaces as lists of corners and faces, before they are placed anywhere.

use crate::random::Random;
use glam::{DVec2, DVec3};
use std::collections::HashMap;

/// A closed surface, faces outward: every edge belongs to two faces, which run along it in opposite directions.
pub(super) struct Solid {
    pub(super) corners: Vec<DVec3>,
    pub(super) faces: Vec<Face>,
    /// Points inside, far from the surface.
    pub(super) inside: Vec<DVec3>,
    /// Its corners are all points of a lattice of this many cells a side, from 0 on; it must not be turned.
    pub(super) lattice: Option<usize>,
}

/// A face; counterclockwise as seen from outside.
#[derive(Clone)]
pub(super) struct Face {
    pub(super) corners: Vec<usize>,
    /// Else a triangle.
    pub(super) is_polygon: bool,
    /// Faces that lie side by side in a row or on one side have one number. Seams are where two numbers meet, or two kinds.
    pub(super) strip: usize,
}

/// What a flat part of a surface is made of.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Made {
    Polygons,
    Triangles,
}

impl Solid {
    pub(super) fn new(corners: Vec<DVec3>, inside: Vec<DVec3>) -> Self {
        Self { corners, faces: Vec::new(), inside, lattice: None }
    }

    /// The same, every other time made up to 64 times as thin along its axes.
    pub(super) fn stretched(mut self, random: &mut Random) -> Self {
        if random.chance(0.5) {
            let stretch = DVec3::from([(); 3].map(|()| random.between(-6.0, 0.0).exp2()));
            self.corners.iter_mut().chain(&mut self.inside).for_each(|point| *point *= stretch);
        }
        self
    }

    /// A triangle, or a polygon of more corners.
    pub(super) fn add(&mut self, strip: usize, corners: &[usize]) {
        self.faces.push(Face { corners: corners.to_vec(), is_polygon: corners.len() > 3, strip });
    }

    /// Four corners in one plane: as a polygon, or as two triangles.
    pub(super) fn add_quad(&mut self, strip: usize, [a, b, c, d]: [usize; 4], made: Made) {
        match made {
            Made::Polygons => self.add(strip, &[a, b, c, d]),
            Made::Triangles => {
                self.add(strip, &[a, b, c]);
                self.add(strip, &[a, c, d]);
            }
        }
    }

    /// Edges, and of them the seams; none of them is twice in a list. None if this is no closed surface.
    pub(super) fn edges(&self) -> Option<[Vec<[usize; 2]>; 2]> {
        let mut faces_at: HashMap<[usize; 2], usize> = HashMap::new();
        for (number, face) in self.faces.iter().enumerate() {
            for edge in face.edges() {
                if faces_at.insert(edge, number).is_some() {
                    return None;
                }
            }
        }
        let (mut edges, mut seams) = (Vec::new(), Vec::new());
        for face in &self.faces {
            for [from, to] in face.edges() {
                let other = &self.faces[*faces_at.get(&[to, from])?];
                if from < to {
                    edges.push([from, to]);
                    if face.strip != other.strip || face.is_polygon != other.is_polygon {
                        seams.push([from, to]);
                    }
                }
            }
        }
        Some([edges, seams])
    }
}

impl Face {
    pub(super) fn edges(&self) -> impl Iterator<Item = [usize; 2]> {
        self.corners.iter().zip(self.corners.iter().cycle().skip(1)).map(|(&from, &to)| [from, to])
    }
}

/// A prism over an outline, which is counterclockwise. With `middle`, caps are fans of triangles around a point in the middle,
/// else polygons.
pub(super) fn prism(outline: &[DVec2], inside: &[DVec2], middle: Option<DVec2>, sides: Made) -> Solid {
    let count = outline.len();
    let height = 0.7;
    let at = |z: f64| outline.iter().map(move |point| point.extend(z));
    let mut corners: Vec<DVec3> = at(-height).chain(at(height)).collect();
    corners.extend(middle.into_iter().flat_map(|middle| [-height, height].map(|z| middle.extend(z))));
    let mut solid = Solid::new(corners, inside.iter().map(|point| point.extend(0.0)).collect());
    for at in 0..count {
        let next = (at + 1) % count;
        solid.add_quad(2 + at, [at, next, count + next, count + at], sides);
        if middle.is_some() {
            solid.add(0, &[next, at, 2 * count]);
            solid.add(1, &[count + at, count + next, 2 * count + 1]);
        }
    }
    if middle.is_none() {
        solid.add(0, &(0..count).rev().collect::<Vec<_>>());
        solid.add(1, &(count..2 * count).collect::<Vec<_>>());
    }
    solid
}
