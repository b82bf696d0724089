//! What a processor or a build could change: cases 21 and 57 to 59.
//!
//! That no formula is an estimate (57) or fused (58), or fused on one processor alone (21), shows in the bits: every build and
//! every processor has to come to the snapshot of this file, and to that of pictures in `wavefront.rs`. Subnormal numbers (59)
//! would be taken for 0 by a processor that was told so. This cannot be tried from here, since it takes unsafe code to tell
//! it; what is tried is that they are not, and that sizes down to 2⁻⁵⁰ of the scene's do not come near them.

use super::case::{Aimed, Case, Shape, Within, ray, scene};
use super::run::{Company, Engine, Engines};
use Shape::{Polygon, Sphere, Triangle};
use Within::Ulps;
use wavelane::lanes::Width;

hard_cases! {
    case_59_triangle_of_10_to_the_minus_19: SMALL_TRIANGLE,
    case_59_polygon_of_10_to_the_minus_19: SMALL_POLYGON,
    case_59_sphere_of_10_to_the_minus_19: SMALL_SPHERE,
    case_59_subnormal_triangle: SUBNORMAL_TRIANGLE,
    case_59_subnormal_polygon: SUBNORMAL_POLYGON,
    case_59_subnormal_sphere: SUBNORMAL_SPHERE,
    case_59_subnormal_t: SUBNORMAL_T,
}

#[test]
fn cases_21_57_58_the_same_bits_for_every_build() {
    let tables = [
        super::spheres::CASES,
        super::triangles::CASES,
        super::meshes::CASES,
        super::boxes::CASES,
        super::no_rays::CASES,
        super::polygons::CASES,
        CASES,
    ];
    let lines: Vec<String> = tables.into_iter().flatten().map(|case| line(case)).collect();
    insta::assert_snapshot!(lines.join("\n"));
}

/// Number, name, and a hash of the bits of all t and ids: Fowler, Noll and Vo's, 1a.
fn line(case: &Case) -> String {
    let (scene, rays) = (scene(&(case.shapes)()), (case.rays)());
    let found = Engines::new(&scene, 1).answers(&rays, Engine::Wavefront(Width::BEST), Company::Listed);
    let words = found.iter().flat_map(|answer| [answer.t.to_bits(), answer.id, u32::from(answer.occluded)]);
    let hash = words.flat_map(u32::to_le_bytes).fold(0xCBF2_9CE4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3)
    });
    format!("{} {}: {hash:016x}", case.number, case.name)
}

/// Sets the scale of a scene.
const UNIT: Shape = Triangle([[1.0, 0.0, 0.0], [1.5, 0.0, 0.0], [1.0, 1.0, 0.0]]);

/// Corners at z = leg − y, and the middle of it.
fn tilted(leg: f32) -> [[f32; 3]; 3] {
    [[0.0, 0.0, leg], [leg, 0.0, leg], [0.0, leg, 0.0]]
}

/// From 1 away, and from 4 legs: down to z = ¾ of a leg. Products of two legs are subnormal, of three 0.
fn rays_at_tilted(leg: f32) -> Vec<Aimed> {
    let down = |z: f32| ray([leg / 4.0, leg / 4.0, z], [0.0, 0.0, -1.0]);
    let near = 3.25 * f64::from(leg);
    vec![
        down(1.0).hits(0, 1.0, Ulps(2.0)),
        down(4.0 * leg).hits(0, near, Ulps(16.0)),
        ray([leg / 4.0, -1.0, leg / 4.0], [0.0, 1.0, 0.0]).hits(0, 1.0, Ulps(2.0)),
        ray([leg, leg, 1.0], [0.0, 0.0, -1.0]).misses(),
    ]
}

const SMALL_TRIANGLE: Case = Case {
    number: 59,
    name: "denormals, a triangle of 10⁻¹⁹ beside 1",
    shapes: || vec![Triangle(tilted(1e-19)), UNIT],
    rays: || rays_at_tilted(1e-19),
};

const SMALL_POLYGON: Case = Case {
    number: 59,
    name: "denormals, a polygon of 10⁻¹⁹ beside 1",
    shapes: || vec![Polygon(tilted(1e-19).into()), UNIT],
    rays: || rays_at_tilted(1e-19),
};

/// Through the middle, and at half the radius, from 4 radii away: (4 − √¾)·r.
fn rays_at_ball(radius: f32) -> Vec<Aimed> {
    let down = |x: f32, z: f32| ray([x, 0.0, z], [0.0, 0.0, -1.0]);
    let near = (4.0 - 0.75_f64.sqrt()) * f64::from(radius);
    vec![
        down(0.0, 4.0 * radius).hits(0, 3.0 * f64::from(radius), Ulps(4.0)),
        down(radius / 2.0, 4.0 * radius).hits(0, near, Ulps(16.0)),
        down(radius / 2.0, 1.0).hits(0, 1.0, Ulps(2.0)),
        down(1.5 * radius, 1.0).misses(),
    ]
}

const SMALL_SPHERE: Case = Case {
    number: 59,
    name: "denormals, a sphere of 10⁻¹⁹ beside 1",
    shapes: || vec![Sphere([0.0; 3], 1e-19), UNIT],
    rays: || rays_at_ball(1e-19),
};

/// f32 has 16 bits for 10⁻⁴⁰; the scene is brought to the size of 1.
const SUBNORMAL_TRIANGLE: Case = Case {
    number: 59,
    name: "denormals, a triangle of 10⁻⁴⁰ alone",
    shapes: || vec![Triangle(tilted(1e-40))],
    rays: || rays_at_tilted(1e-40),
};

const SUBNORMAL_POLYGON: Case = Case {
    number: 59,
    name: "denormals, a polygon of 10⁻⁴⁰ alone",
    shapes: || vec![Polygon(tilted(1e-40).into())],
    rays: || rays_at_tilted(1e-40),
};

const SUBNORMAL_SPHERE: Case = Case {
    number: 59,
    name: "denormals, a sphere of 10⁻⁴⁰ alone",
    shapes: || vec![Sphere([0.0; 3], 1e-40)],
    rays: || rays_at_ball(1e-40),
};

/// From 10⁻³⁹ before a surface of 1.
const SUBNORMAL_T: Case = Case {
    number: 59,
    name: "denormals, t of 10⁻³⁹",
    shapes: || {
        vec![
            Triangle([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]),
            Polygon(vec![[2.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 1.0, 0.0], [2.0, 1.0, 0.0]]),
        ]
    },
    rays: || {
        let down = |x: f32| ray([x, 0.25, 1e-39], [0.0, 0.0, -1.0]);
        let t = f64::from(1e-39_f32);
        let up = |x: f32| ray([x, 0.25, 1e-39], [0.0, 0.0, 1.0]).misses();
        vec![down(0.25).hits(0, t, Ulps(1.0)), down(2.25).hits(1, t, Ulps(1.0)), up(0.25), up(2.25)]
    },
};
