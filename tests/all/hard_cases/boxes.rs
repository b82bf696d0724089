//! Boxes of the hierarchy: cases 27 to 32. A box shows only in the primitive that is lost behind it, so each case has
//! primitives enough for a tree.

use super::case::{Aimed, Case, Faces, Shape, Within, ray};
use super::solids::{Made, aimed_at, cube_faces, seams};
use Shape::{Polygon, Sphere, Triangle};
use Within::Ulps;
use glam::DVec3;

hard_cases! {
    case_27_zero_times_infinity: ZERO_TIMES_INFINITY,
    case_27_zero_times_infinity_of_tangents: TANGENTS,
    case_28_negative_zero: NEGATIVE_ZERO,
    case_29_clamped_reciprocal: CLAMPED_RECIPROCAL,
    case_30_fused_slab: FUSED_SLAB,
    case_31_slab_rounding_of_polygons: SLAB_ROUNDING_OF_POLYGONS,
    case_31_slab_rounding_of_triangles: SLAB_ROUNDING_OF_TRIANGLES,
    case_31_slab_rounding_of_both: SLAB_ROUNDING_OF_BOTH,
    case_32_flat_boxes: FLAT_BOXES,
}

/// Squares of a side that cover `columns` × `rows` in the plane of two axes, the third coordinate the same for all.
fn tiles([columns, rows]: [u8; 2], side: f32, place: impl Fn(f32, f32) -> [f32; 3]) -> Vec<Vec<[f32; 3]>> {
    let squares = (0..columns).flat_map(|i| (0..rows).map(move |j| [i, j].map(f32::from)));
    let corner = |i: f32, j: f32| place(side * i, side * j);
    squares
        .map(|[i, j]| vec![corner(i, j), corner(i + 1.0, j), corner(i + 1.0, j + 1.0), corner(i, j + 1.0)])
        .collect()
}

/// Unit squares at integers: the boxes of all nodes end at integers too, and rays there have (0 − 0) · ∞.
const ZERO_TIMES_INFINITY: Case = Case {
    number: 27,
    name: "0 · ∞",
    shapes: || Made::Both.shapes(&tiles([8, 8], 1.0, |x, y| [x, y, 1.0])),
    rays: || {
        let halves = (1..16_u8).map(|half| f32::from(half) / 2.0);
        let points = halves.clone().flat_map(|x| halves.clone().map(move |y| [x, y, -1.0]));
        let zeros = [[0.0, 0.0], [0.0, -0.0], [-0.0, 0.0], [-0.0, -0.0]];
        let rays = points.flat_map(|origin| zeros.map(|[x, y]| ray(origin, [x, y, 1.0])));
        rays.map(|ray| ray.hits_something_at(2.0, Ulps(0.0)).on_faces(Faces::Exactly(1))).collect()
    },
};

/// Spheres in boxes [0, 1]³ side by side; rays within the faces of the boxes touch the spheres, at t = 1.5, without rounding.
const TANGENTS: Case = Case {
    number: 27,
    name: "0 · ∞, tangents",
    shapes: || (0..9_u8).map(|i| Sphere([2.0 * f32::from(i) + 0.5, 0.5, 0.5], 0.5)).collect(),
    rays: || {
        let mut rays = Vec::new();
        for (x, id) in [(0.0, 0), (1.0, 0), (8.0, 4), (9.0, 4), (16.0, 8), (17.0, 8)] {
            for zero in [0.0, -0.0] {
                rays.push(ray([x, 0.5, -1.0], [zero, -zero, 1.0]).hits(id, 1.5, Ulps(0.0)));
            }
        }
        rays.push(ray([(-0.0_f32).next_down(), 0.5, -1.0], [0.0, 0.0, 1.0]).hits(0, 1.5, Ulps(0.0)));
        rays.push(ray([1.0_f32.next_up(), 0.5, -1.0], [0.0, 0.0, 1.0]).misses());
        rays
    },
};

/// From within a cube whose faces are tiled at halves, along each axis, with zeros of either sign: as if all were +0.
const NEGATIVE_ZERO: Case = Case {
    number: 28,
    name: "negative zero",
    shapes: || Made::Both.shapes(&cube_faces(4, |point| point)),
    rays: || {
        let origin = [0.5, -0.25, 0.0_f32];
        let mut rays = Vec::new();
        for (axis, way) in (0..3).flat_map(|axis| [1.0, -1.0_f32].map(|way| (axis, way))) {
            for zeros in [[0.0, 0.0], [0.0, -0.0], [-0.0, 0.0], [-0.0, -0.0_f32]] {
                let mut direction = [way; 3];
                (direction[(axis + 1) % 3], direction[(axis + 2) % 3]) = (zeros[0], zeros[1]);
                let t = 1.0 - f64::from(origin[axis] * way);
                let ray = ray(origin, direction).hits_something_at(t, Ulps(0.0));
                rays.push(ray.on_faces(Faces::Exactly(1)));
            }
        }
        rays
    },
};

/// A small square far down the ray, spheres around it; 1/0 taken as a large number ends the slab before it.
const CLAMPED_RECIPROCAL: Case = Case {
    number: 29,
    name: "clamped reciprocal",
    shapes: || {
        let small = 1e-3;
        let square = [[-small, -small, 1e4], [small, -small, 1e4], [small, small, 1e4], [-small, small, 1e4]];
        let [a, b, c, d] = square.map(|[x, y, _]| [x, y, 2e4]);
        let others = (0..20_u8).map(|i| Sphere([5.0 + f32::from(i), 1.0, 500.0 * f32::from(i)], 0.5));
        [Polygon(square.into()), Triangle([a, b, c]), Triangle([a, c, d])].into_iter().chain(others).collect()
    },
    rays: || {
        let mut rays = Vec::new();
        for zero in [0.0, -0.0, 1e-30, -1e-30, 1e-40_f32] {
            for x in [0.0, 9e-4, -9e-4, 1e-30] {
                let along = ray([x, 1e-4, 0.0], [zero, -zero, 1.0]);
                rays.push(along.clone().hits(0, 1e4, Ulps(2.0)));
                // Off the diagonal of the two triangles behind.
                rays.push(along.beyond(1.5e4).hits_something_at(2e4, Ulps(2.0)));
            }
            rays.push(ray([1.1e-3, 0.0, 0.0], [zero, 0.0, 1.0]).misses());
        }
        rays.push(ray([9e-4, 0.0, 0.0], [5e-9, 0.0, 1.0]).hits(0, 1e4, Ulps(2.0)));
        rays
    },
};

/// A wall of tiles at x = 10⁶, from 1 before it: b/d − o/d has five digits of the distance left, (b − o)/d has all.
const FUSED_SLAB: Case = Case {
    number: 30,
    name: "fused slab",
    shapes: || {
        let wall = tiles([9, 9], 1.0, |y, z| [1e6, y - 4.5, z - 4.5]);
        Made::Both.shapes(&wall)
    },
    rays: || {
        let mut rays = Vec::new();
        let component = 0.577_350_26_f32;
        let signs = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
        for [y, z] in signs.into_iter().chain([[1.5, 0.25], [-0.75, 3.0], [0.5, -0.5], [6.0, 6.5]]) {
            let to_wall = ray([1e6 + 1.0, 0.0, 0.0], [-component, y * component, z * component]);
            // 1 / 0.57735026; beyond the last tile there is none.
            rays.push(match y {
                6.0 => to_wall.misses(),
                _ => to_wall.hits_something_at(1.732_050_838_656_126_6, Ulps(4.0)),
            });
        }
        rays
    },
};

/// A cube of 3 × 3 squares a face, at coordinates that take all digits: its corners are corners of boxes, its edges edges of
/// them. From within each ray meets one face.
fn corners_of_boxes() -> Vec<Vec<[f32; 3]>> {
    cube_faces(3, |point| point / 3.0 + DVec3::new(0.1, -0.7, 1.3))
}

fn rays_at_corners_of_boxes() -> Vec<Aimed> {
    let origins =
        [[0.1, -0.7, 1.3], [0.3, -0.95, 1.1], [-0.12, -0.5, 1.55], [0.099_999, -0.7, 1.5], [0.4, -0.4, 1.0]];
    let seams = seams(&corners_of_boxes());
    let rays = origins.into_iter().flat_map(|origin| seams.iter().map(move |&point| aimed_at(origin, point)));
    rays.map(|ray| ray.hits_something().on_faces(Faces::Exactly(1))).collect()
}

const SLAB_ROUNDING_OF_POLYGONS: Case = Case {
    number: 31,
    name: "slab rounding, of polygons",
    shapes: || Made::Polygons.shapes(&corners_of_boxes()),
    rays: rays_at_corners_of_boxes,
};

const SLAB_ROUNDING_OF_TRIANGLES: Case = Case {
    number: 31,
    name: "slab rounding, of triangles",
    shapes: || Made::Triangles.shapes(&corners_of_boxes()),
    rays: rays_at_corners_of_boxes,
};

const SLAB_ROUNDING_OF_BOTH: Case = Case {
    number: 31,
    name: "slab rounding, of both",
    shapes: || Made::Both.shapes(&corners_of_boxes()),
    rays: rays_at_corners_of_boxes,
};

/// Tiles in y = 0, whose boxes have no height, seen at 10⁻⁷ from the plane: at x = −0.5, y = −10⁻⁷ + 10⁻⁷ is 0 to the bit.
const FLAT_BOXES: Case = Case {
    number: 32,
    name: "flat boxes",
    shapes: || Made::Both.shapes(&tiles([7, 7], 0.3, |x, z| [x - 1.05, 0.0, z - 1.05])),
    rays: || {
        let mut rays = Vec::new();
        for z in [0.25, -0.7, 0.5] {
            for side in [1.0, -1.0_f32] {
                for slope in [1e-7, 1e-3, 1e-20] {
                    let grazing = ray([-1.5, -side * slope, z], [1.0, side * slope, 0.0]);
                    rays.push(grazing.hits_something_at(1.0, Ulps(4.0)).on_faces(Faces::Exactly(1)));
                }
            }
            rays.push(ray([-1.5, 0.0, z], [1.0, 0.0, 0.0]).misses());
        }
        rays
    },
};
