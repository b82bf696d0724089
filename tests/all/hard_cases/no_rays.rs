//! What is no ray: cases 33 and 34.

use super::case::{Aimed, Case, Shape, Within, ray, scene};
use super::run::{ENGINES, Engines};
use super::solids::{Made, cube_faces, turned};
use crate::support::{Folder, npy_floats, stderr, wavelane};
use Shape::Sphere;
use Within::{Absolute, Ulps};
use wavelane::lanes::Width;
use wavelane::prepare::Prepared;
use wavelane::rays::RaySet;
use wavelane::trace::{Query, RayColumns, Run};

hard_cases! {
    case_33_not_a_number_and_infinite: NOT_A_NUMBER,
    case_34_direction_of_no_length: NO_LENGTH,
}

/// A ball in a turned cube.
fn ball_in_cube() -> Vec<Shape> {
    let cube = Made::Both.shapes(&cube_faces(3, |point| 4.0 * turned(point)));
    [Sphere([0.0, 0.0, -2.0], 0.5)].into_iter().chain(cube).collect()
}

/// Of all that is not a number or not finite, `t_max` = +∞ is as it should be, and `t_min` = −∞ excludes nothing; with any
/// other there is no stretch on which to hit anything.
fn spoilt() -> Vec<Aimed> {
    let good = ray([0.0; 3], [0.0, 0.0, -1.0]);
    let bad = [f32::NAN, -f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    let rays = (0..8).flat_map(|column| bad.map(|value| (column, value))).map(|(column, value)| {
        let mut ray = good.clone().before(100.0).misses();
        ray.row[column] = value;
        match (column, value) {
            (7, f32::INFINITY) | (3, f32::NEG_INFINITY) => ray.hits(0, 1.5, Ulps(2.0)),
            _ => ray,
        }
    });
    rays.chain([good.clone().hits(0, 1.5, Ulps(2.0))]).collect()
}

const NOT_A_NUMBER: Case =
    Case { number: 33, name: "not a number and infinite", shapes: ball_in_cube, rays: spoilt };

const NO_LENGTH: Case = Case {
    number: 34,
    name: "direction of no length",
    shapes: ball_in_cube,
    rays: || {
        let zeros = [[0.0; 3], [-0.0; 3], [0.0, -0.0, 0.0], [-0.0, 0.0, -0.0]];
        let origins = [[0.0; 3], [0.0, 0.0, -2.0], [0.0, 0.0, -1.5]];
        let rays = origins.into_iter().flat_map(|origin| zeros.map(|zero| ray(origin, zero).misses()));
        // The shortest direction that is one.
        let least = f32::from_bits(1);
        let least = ray([0.0; 3], [0.0, 0.0, -least]).hits(0, f64::from(f32::MAX), Absolute(0.0));
        rays.chain([least]).collect()
    },
};

/// Rays that are none take no longer than rays. The best of many passes is compared, and three times as long allowed, since
/// the machine may be busy; to try all of these squares takes far longer.
#[test]
fn case_33_costs_no_time() {
    let squares = Made::Polygons.shapes(&cube_faces(24, |point| 4.0 * turned(point)));
    let scene = scene(&[ball_in_cube(), squares].concat());
    let prepared = Prepared::new(&scene).unwrap();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let good = ray([0.0; 3], [0.0, 0.0, -1.0]).row;
    let seconds = |row: [f32; 8]| {
        let rays = RaySet { rows: vec![row; 1 << 14], ..RaySet::default() };
        let columns = RayColumns::new(&prepared, &rays);
        let mut run = Run::new(&prepared, &columns, Query::Closest);
        (0..25).map(|_| run.pass(Width::BEST, &pool)).fold(f64::INFINITY, f64::min)
    };
    let of_good = seconds(good);
    for (column, value) in (0..8).flat_map(|column| [f32::NAN, f32::INFINITY].map(|value| (column, value))) {
        let mut row = good;
        row[column] = value;
        let of_bad = seconds(row);
        assert!(
            of_bad < 3.0 * of_good,
            "case 33, column {column} = {value}: {of_bad:.2e} s, good rays {of_good:.2e} s"
        );
    }
}

/// The same through the command line: what is no ray is counted, and a miss in the files.
#[test]
fn case_33_by_the_command() {
    let folder = Folder::new();
    let scene = folder.write(
        "scene.toml",
        "[material.m]\ndiffuse = 1\n[[sphere]]\ncenter = [0, 0, -2]\nradius = 0.5\nmaterial = \"m\"\n",
    );
    let [scene, prefix] =
        [scene, folder.file("out")].map(|path| path.into_os_string().into_string().unwrap());
    let rays: Vec<[f32; 8]> = spoilt().iter().map(|ray| ray.row).collect();
    let path = folder.write("rays.npy", npy_floats(&rays)).into_os_string().into_string().unwrap();
    for (engine, query) in ["simd", "scalar", "reference"]
        .into_iter()
        .flat_map(|engine| ["closest", "any"].map(|query| (engine, query)))
    {
        let output = wavelane(&[
            "trace", &scene, "--rays", &path, "--engine", engine, "--query", query, "--hits", &prefix,
            "--repeat", "1",
        ]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        // NaN of either sign in 8 columns, ±∞ in 6 of them; ∞ at the wrong end of a stretch leaves a ray that hits nothing.
        assert!(stderr(&output).contains("28 of 33 rows are no rays"), "{}", stderr(&output));
        let t = std::fs::read(folder.file("out.t.npy")).unwrap();
        let t: Vec<f32> = t[t.len() - 4 * rays.len()..]
            .as_chunks()
            .0
            .iter()
            .map(|&bytes| f32::from_le_bytes(bytes))
            .collect();
        let hits: Vec<usize> = (0..t.len()).filter(|&row| t[row] != f32::INFINITY).collect();
        assert_eq!(hits, [15, 30, 32], "{engine} {query}: {t:?}");
    }
}

/// A scene that holds nothing is missed too.
#[test]
fn case_33_in_an_empty_scene() {
    let empty = scene(&[]);
    let engines = Engines::new(&empty, 1);
    let rays = RaySet { rows: spoilt().iter().map(|ray| ray.row).collect(), ..RaySet::default() };
    for (engine, query) in
        ENGINES.into_iter().flat_map(|engine| [Query::Closest, Query::Any].map(|query| (engine, query)))
    {
        assert_eq!(engines.hits(&rays, engine, query).count(), 0, "{engine:?}, {query:?}");
    }
}
