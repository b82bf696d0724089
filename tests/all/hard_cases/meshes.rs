//! Triangles that share edges: cases 13, 15, 16, 23 and 25.

use super::case::{Aimed, Case, Faces, Shape, Within, plane_t, ray, scene};
use super::run::{Company, ENGINES, Engine, Engines};
use super::solids::{Made, aimed_at, cube_faces, globe_faces, rounded, seams, spread, turned};
use Shape::Triangle;
use Within::Roundings;
use glam::{DQuat, DVec3};
use wavelane::lanes::Width;

hard_cases! {
    case_13_rotated_quad: ROTATED_QUAD,
    case_15_closed_jittered_globe: JITTERED_GLOBE,
    case_23_mesh_far_from_the_origin: FAR_MESH,
    case_25_double_hit_on_a_shared_edge: DOUBLE_HIT,
}

/// The unit square turned by 90° about (1, 1, 1).
fn quad() -> [[f32; 3]; 4] {
    let about = DQuat::from_axis_angle(DVec3::ONE.normalize(), std::f64::consts::FRAC_PI_2);
    [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| rounded(about * DVec3::new(x, y, 0.0)))
}

/// From 32 × 32 places at the middle of the diagonal that the two halves share. There both planes, which rounding has tilted
/// against each other, are at one place.
const ROTATED_QUAD: Case = Case {
    number: 13,
    name: "rotated quad, shared diagonal",
    shapes: || {
        let [a, b, c, d] = quad();
        vec![Triangle([a, b, c]), Triangle([a, c, d])]
    },
    rays: || {
        let [a, b, c, d] = quad();
        let [wa, wb, wc, wd] = [a, b, c, d].map(|corner| DVec3::from(corner.map(f64::from)));
        let (middle, along, across) = ((wa + wc) / 2.0, wb - wa, wd - wa);
        let normal = along.cross(across);
        let places =
            (0..32_u8).flat_map(|i| (0..32_u8).map(move |j| [i, j].map(|k| f64::from(k) / 8.0 - 1.97)));
        let rays = places.map(|[i, j]| {
            let ray = aimed_at(rounded(middle + 3.0 * normal + i * along + j * across), middle);
            let t = plane_t(&ray, [a, b, c]);
            ray.hits_something_at(t, Roundings(6.0)).on_faces(Faces::Exactly(1))
        });
        rays.collect()
    },
};

/// Around the origin, each radius from 1 to 6 for itself: pbrt's construction.
fn jittered_globe() -> Vec<Vec<[f32; 3]>> {
    globe_faces(15, 16, DVec3::ZERO, |vertex| 1.0 + 5.0 * spread(vertex + 1))
}

/// From its middle every direction meets one face, and a ray at an edge or a corner no less and no more.
const JITTERED_GLOBE: Case = Case {
    number: 15,
    name: "closed jittered latitude-longitude mesh",
    shapes: || Made::Triangles.shapes(&jittered_globe()),
    rays: || {
        let at_seams = seams(&jittered_globe()).into_iter().map(|point| aimed_at([0.0; 3], point));
        at_seams.map(|ray| ray.hits_something().on_faces(Faces::Exactly(1))).collect()
    },
};

#[test]
fn case_15_is_seen_whole_from_its_middle() {
    for face in jittered_globe() {
        let [a, b, c] = [0, 1, 2].map(|corner| DVec3::from(face[corner].map(f64::from)));
        assert!(a.dot(b.cross(c)) > 0.0, "{face:?} shows its outside to the origin");
    }
}

/// All kinds.
const WHOLE: usize = 8;

/// A lattice of n × n squares, each cut in two, under rays at all lattice points that lie inside. Six triangles meet in each
/// of these points and one is to be hit. They cannot be counted one by one, but triangles of eight kinds can: no two of a
/// kind have a corner in common.
fn lattice(n: u16, kind: usize) -> Vec<Shape> {
    let squares = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
    let of_kind =
        squares.filter(|(i, j)| kind == WHOLE || (usize::from(i % 2) + 2 * usize::from(j % 2)) == kind / 2);
    of_kind
        .flat_map(|(i, j)| {
            let corner = |di: u16, dj: u16| [f32::from(i + di), f32::from(j + dj), 0.0];
            let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            [Triangle([a, b, c]), Triangle([a, c, d])].into_iter().enumerate()
        })
        .filter(|(half, _)| kind == WHOLE || *half == kind % 2)
        .map(|(_, triangle)| triangle)
        .collect()
}

fn check_lattice(n: u16, engines: &[Engine]) {
    let points = (1..n).flat_map(|i| (1..n).map(move |j| [f32::from(i), f32::from(j), 1.0]));
    let rays: Vec<Aimed> = points.map(|point| ray(point, [0.0, 0.0, -1.0])).collect();
    let mut counts = vec![vec![0_u8; rays.len()]; engines.len()];
    for kind in 0..=WHOLE {
        let scene = scene(&lattice(n, kind));
        let ready = Engines::new(&scene, 2);
        for (&engine, counts) in engines.iter().zip(&mut counts) {
            let found = ready.answers(&rays, engine, Company::Listed);
            for (count, answer) in counts.iter_mut().zip(&found) {
                let is_hit = answer.id != u32::MAX;
                *count += u8::from(is_hit && kind != WHOLE);
                assert_eq!(answer.occluded, is_hit, "case 16, {engine:?}: {answer}");
                assert!(!is_hit || answer.t == 1.0, "case 16, {engine:?}: {answer}");
                assert!(is_hit || kind != WHOLE, "case 16, {engine:?}: {answer} of the lattice as a whole");
            }
        }
    }
    for (engine, counts) in engines.iter().zip(counts) {
        let wrong = counts.iter().filter(|&&count| count != 1).count();
        let (least, most) = (counts.iter().min(), counts.iter().max());
        assert_eq!(
            wrong,
            0,
            "case 16, integer lattice, {engine:?}: {wrong} of {} rays found from {least:?} to {most:?} triangles; \
             wanted exactly 1",
            rays.len()
        );
    }
}

#[test]
fn case_16_integer_lattice() {
    check_lattice(65, &ENGINES);
    check_lattice(301, &[Engine::Wavefront(Width::BEST)]);
}

const FAR: DVec3 = DVec3::new(148_376.0, 1_234.0, -223_423.0);

fn far_globe() -> Vec<Vec<[f32; 3]>> {
    globe_faces(100, 200, FAR, |_| 2.0)
}

/// Its edges are 4 ulp long, so boxes are padded by several of its triangles, and some of its triangles have become lines, which are left out.
const FAR_MESH: Case = Case {
    number: 23,
    name: "mesh far from the origin",
    shapes: || Made::Triangles.shapes(&far_globe()),
    rays: || {
        let targets = seams(&far_globe()).into_iter().step_by(1009);
        let origins = [[0.0; 3], [0.5, -0.25, 1.0], [-1.0, 0.0, -0.5]];
        let origins = origins.map(|by| rounded(FAR + DVec3::from(by)));
        let rays = targets.flat_map(|target| origins.map(|origin| aimed_at(origin, target).hits_something()));
        rays.collect()
    },
};

/// Lines through the edges and corners of a closed cube enter it as often as they leave it.
const DOUBLE_HIT: Case = Case {
    number: 25,
    name: "double hit on a shared edge",
    shapes: || Made::Triangles.shapes(&cube_faces(1, turned)),
    rays: || {
        let outside = [[4.0, 0.3, -0.2], [-1.5, 3.0, 2.5], [0.1, 0.2, -7.0], [-2.0, -2.0, -2.0_f32]];
        let targets = seams(&cube_faces(1, turned));
        let rays = outside
            .into_iter()
            .flat_map(|origin| targets.iter().map(move |&target| aimed_at(origin, target)));
        // Whether a line that touches an edge from outside hits anything is left to rounding; that it is even is not.
        rays.map(|ray| ray.on_faces(Faces::Even).unasked()).collect()
    },
};
