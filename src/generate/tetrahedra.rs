//! Sierpinski's tetrahedron: a tetrahedron is replaced by four of half its size in its corners, and so on.
//!
//! The corners of all of them are corners of cubes, sums of powers of two, so f32 holds every coordinate exactly.

use super::is_chosen;
use crate::scene::{
    Camera, Geometry, GeometryProblem, ImageSettings, Light, Material, MaterialId, Projection,
    RenderSettings, Rgb, Scene,
};
use glam::Vec3;

/// Every other corner of a cube.
const CORNERS: [Vec3; 4] = [
    Vec3::new(1.0, 1.0, 1.0),
    Vec3::new(1.0, -1.0, -1.0),
    Vec3::new(-1.0, 1.0, -1.0),
    Vec3::new(-1.0, -1.0, 1.0),
];
/// Counter-clockwise from outside.
const FACES: [[usize; 3]; 4] = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]];

#[derive(Clone, Copy)]
struct Tetrahedron {
    /// Middle of the cube.
    center: Vec3,
    /// Half of the cube's side.
    half: f32,
}

impl Tetrahedron {
    fn divided(self) -> [Self; 4] {
        let half = self.half / 2.0;
        CORNERS.map(|corner| Self { center: self.center + half * corner, half })
    }

    /// Which corner of the whole it belongs to; the first for the whole itself.
    fn nearest_corner(self) -> MaterialId {
        let along = |corner: u32| CORNERS[corner as usize].dot(self.center);
        MaterialId((1..4).fold(0, |best, corner| if along(corner) > along(best) { corner } else { best }))
    }
}

/// Triangles alone, 4 + 12 k of them.
pub(super) fn scene(size: usize) -> Result<Scene, GeometryProblem> {
    // A colour for each corner of the whole.
    let colors = [[0.9, 0.75, 0.3], [0.85, 0.28, 0.2], [0.2, 0.55, 0.75], [0.35, 0.65, 0.3]];
    let materials = colors.map(|color| Material { diffuse: color.into(), ..Material::default() }).to_vec();

    let mut geometry = Geometry::default();
    for solid in divided(size) {
        let material = solid.nearest_corner();
        for face in FACES {
            let corners = face.map(|corner| solid.center + solid.half * CORNERS[corner]);
            let first = geometry.add_vertices(corners)?;
            geometry.add_triangle([first, first + 1, first + 2], None, material)?;
        }
    }
    Ok(Scene {
        image: ImageSettings { width: 1024, height: 1024, background: Rgb::new(0.07, 0.11, 0.2) },
        render: RenderSettings { max_depth: 4, ..RenderSettings::default() },
        camera: Camera {
            eye: Vec3::new(4.2, -0.3, -1.5),
            target: Vec3::splat(0.13),
            up: Vec3::ONE,
            projection: Projection::PerspectiveAngle { vertical_degrees: 43.0 },
        },
        ambient: Rgb::ZERO,
        lights: vec![Light::Point { position: Vec3::new(10.0, 0.0, 2.0), intensity: Rgb::ONE }],
        materials,
        geometry,
    })
}

/// All tetrahedra are divided alike, and as many once more, spread evenly, as brings their faces nearest to `size`.
fn divided(size: usize) -> Vec<Tetrahedron> {
    let mut solids = vec![Tetrahedron { center: Vec3::ZERO, half: 1.0 }];
    while solids.len() * 16 <= size {
        solids = solids.into_iter().flat_map(Tetrahedron::divided).collect();
    }
    // Each division makes 16 faces of 4.
    let more = (size.saturating_sub(solids.len() * 4) + 6) / 12;
    let count = solids.len();
    let divide = |(index, solid): (usize, Tetrahedron)| match is_chosen(index, more, count) {
        true => solid.divided().to_vec(),
        false => vec![solid],
    };
    solids.into_iter().enumerate().flat_map(divide).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_of_the_parts_are_the_corners_of_the_whole_and_the_middles_of_its_edges() {
        let whole = Tetrahedron { center: Vec3::ZERO, half: 1.0 };
        for (nth, part) in (0..).zip(whole.divided()) {
            let corners = CORNERS.map(|corner| part.center + part.half * corner);
            for (other, corner) in corners.into_iter().enumerate() {
                assert_eq!(corner, (CORNERS[nth as usize] + CORNERS[other]) / 2.0);
            }
            assert_eq!(part.nearest_corner(), MaterialId(nth));
        }
    }

    #[test]
    fn the_outside_of_every_face_is_outside() {
        for face in FACES {
            let [a, b, c] = face.map(|corner| CORNERS[corner]);
            assert!((b - a).cross(c - a).dot(a) > 0.0, "{face:?}");
        }
    }

    #[test]
    fn a_part_is_divided_once_more_than_another_at_most() {
        for size in [4, 5, 100, 1000, 4096, 50_000] {
            let solids = divided(size);
            assert!((solids.len() * 4).abs_diff(size) <= 6, "{size}");
            let halves = || solids.iter().map(|solid| solid.half);
            let (least, most) = (halves().fold(1.0, f32::min), halves().fold(0.0, f32::max));
            assert!(most <= 2.0 * least, "{size}: {least} to {most}");
        }
    }
}
