//! The rungs: what speed costs in accuracy, choice by choice.

use crate::real_scenes;
use crate::support::{STILL_LIFE, ball, render_with, scene};
use glam::Vec3;
use std::num::NonZeroU64;
use std::sync::atomic::AtomicBool;
use std::sync::{Mutex, PoisonError};
use wavelane::lanes::Width;
use wavelane::load::load;
use wavelane::measure::rungs::RungOptions;
use wavelane::measure::rungs::kernels::{BoxRung, FormulaRun, KernelRung, KernelRungs, LeakRung};
use wavelane::measure::rungs::min_weight::MinWeightRung;
use wavelane::measure::rungs::samples::SamplesRung;
use wavelane::prepare::Prepared;
use wavelane::rays::{RayKind, RaySet};
use wavelane::render::{Engine, RenderError};
use wavelane::scene::Scene;

fn options(stop: &AtomicBool) -> RungOptions<'_> {
    RungOptions { width: Width::BEST, threads: 2, repeats: 1, on_progress: &|_| {}, stop }
}

fn rungs_of(scene: &Scene, kind: RayKind) -> KernelRungs {
    let rays = NonZeroU64::new(1);
    let engine = Engine::Wavefront { width: Width::BEST, batch: 4096, records: false, rays };
    let recorded = render_with(scene, engine).recorded;
    let prepared = Prepared::new(scene).unwrap();
    KernelRungs::measure(&prepared, kind, recorded.of(kind), &options(&AtomicBool::new(false))).unwrap()
}

fn leaks_of(scene: &Scene) -> Option<LeakRung> {
    let prepared = Prepared::new(scene).unwrap();
    LeakRung::of_triangles(&prepared, &options(&AtomicBool::new(false))).unwrap()
}

fn polygon_leaks_of(scene: &Scene) -> Option<LeakRung> {
    let prepared = Prepared::new(scene).unwrap();
    LeakRung::of_polygons(&prepared, &options(&AtomicBool::new(false))).unwrap()
}

fn formula<'a>(rung: &'a KernelRung, name: &str) -> &'a FormulaRun {
    rung.formulas.iter().find(|run| run.name == name).unwrap()
}

/// One sphere, seen from `height` above it or from far away.
fn one_sphere(eye: [f64; 3], target: [f64; 3], fov: f64, center: [f64; 3], radius: f64) -> Scene {
    scene(&format!(
        "[image]\nsize = [100, 100]\n[camera]\neye = {eye:?}\ntarget = {target:?}\nup = [0, 1, 0]\nfov = {fov}\n\
         [material.m]\ndiffuse = 0.7\n[[sphere]]\ncenter = {center:?}\nradius = {radius}\nmaterial = \"m\"\n"
    ))
}

#[track_caller]
fn assert_engines_formula_is_right(rung: &KernelRung) {
    let engines: Vec<_> = rung.formulas.iter().filter(|run| run.is_engines).collect();
    assert_eq!(engines.len(), 1);
    let errors = &engines[0].errors;
    assert_eq!(errors.mistakes(), 0, "{errors:?}");
    // Twice the bounds that the kernels state, which leave the rounding of what a ray stores of itself out.
    assert!(errors.t_backward.is_none_or(|roundings| roundings.max <= 12.0), "{errors:?}");
    assert!(
        rung.formulas
            .iter()
            .all(|run| run.seconds.is_some_and(|seconds| seconds.runs == 1 && seconds.best > 0.0))
    );
}

#[test]
fn a_far_sphere_is_mistaken_by_the_quadratic_formula_and_not_by_the_engine_s() {
    let far = one_sphere([0.3, 0.2, -4100.0], [0.0; 3], 0.035, [0.0; 3], 1.0);
    let rung = rungs_of(&far, RayKind::Primary).sphere.unwrap();
    assert_engines_formula_is_right(&rung);
    let [naive, stable] = ["naive", "stable"].map(|name| formula(&rung, name).errors);
    // |o − c|² is 2²⁴ here, and r² is its last place.
    assert!(naive.mistakes() > 100, "{naive:?}");
    assert!(naive.t_backward.unwrap().p50 > 20.0 * stable.t_backward.unwrap().p50, "{naive:?}, {stable:?}");
}

#[test]
fn near_a_huge_ground_the_compensated_formula_alone_sees_it() {
    // The eye's height is less than the rounding of the radius.
    let ground = one_sphere([0.3, 0.01, -5.0], [0.3, 0.005, 0.0], 60.0, [0.0, -1e6, 0.0], 1e6);
    let rung = rungs_of(&ground, RayKind::Primary).sphere.unwrap();
    assert_engines_formula_is_right(&rung);
    let wrong = |name: &str| formula(&rung, name).errors.near_edges();
    assert!(wrong("naive") > rung.pairs / 10 && wrong("stable") > rung.pairs / 10, "{rung:?}");
    assert_eq!(wrong("compensated") + formula(&rung, "compensated").errors.mistakes(), 0, "{rung:?}");
}

#[test]
fn still_life_has_both_rungs_and_the_engine_s_formulas_make_no_mistakes() {
    let scene = scene(STILL_LIFE);
    for kind in RayKind::ALL {
        let rungs = rungs_of(&scene, kind);
        assert_eq!(rungs.rays, kind);
        // Shadow rays rise from the one polygon that there is.
        assert_eq!(rungs.primitives().count(), if kind == RayKind::Shadow { 2 } else { 3 }, "{kind:?}");
        for rung in rungs.primitives() {
            assert_engines_formula_is_right(rung);
            assert_eq!(rung.pairs, rung.tested, "so few are all played back");
        }
        let boxes = rungs.boxes.unwrap();
        assert!(boxes.pairs > 1000 && boxes.true_hits > 100, "{boxes:?}");
        assert_engine_s_box_hides_nothing(&boxes);
        assert!(boxes.formulas.iter().all(|run| boxes.nanoseconds(run).is_some_and(|time| time > 0.0)));
    }
}

#[test]
fn many_pairs_are_sampled_and_what_is_found_is_the_same_from_run_to_run() {
    let Some(path) = real_scenes::file("spd/shells.nff") else { return };
    let mut shells = load(&path).unwrap().scene;
    (shells.image.width, shells.image.height) = (200, 200);
    let without_times = || {
        let mut rung = rungs_of(&shells, RayKind::Primary).sphere.unwrap();
        rung.formulas.iter_mut().for_each(|run| run.seconds = None);
        rung
    };
    let rung = without_times();
    assert!(rung.tested > 1 << 20 && rung.pairs <= 1 << 20 && rung.pairs > 1 << 19, "{rung:?}");
    assert_eq!(format!("{rung:?}"), format!("{:?}", without_times()));
}

#[test]
fn nothing_to_test_is_no_rung() {
    let triangle = scene(
        "[image]\nsize = [8, 8]\n[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nfov = 45\n[material.m]\n\
         [[triangle]]\nvertices = [[-1, -1, 0], [1, -1, 0], [0, 1, 0]]\nmaterial = \"m\"\n",
    );
    let rungs = rungs_of(&triangle, RayKind::Primary);
    assert!(rungs.sphere.is_none() && rungs.triangle.is_some() && rungs.polygon.is_none());
    assert!(leaks_of(&triangle).is_none(), "no edge is shared");
    let none = rungs_of(&triangle, RayKind::Reflect);
    assert!(none.is_empty());
    let empty = scene(
        "[image]\nsize = [8, 8]\n[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nfov = 45\n",
    );
    let none = rungs_of(&empty, RayKind::Primary);
    assert!(none.is_empty());
    assert!(leaks_of(&empty).is_none() && polygon_leaks_of(&empty).is_none());
    let prepared = Prepared::new(&empty).unwrap();
    assert!(BoxRung::at_corners(&prepared, &options(&AtomicBool::new(false))).unwrap().is_none());
}

#[test]
fn rays_that_are_no_rays_are_left_out() {
    let scene = scene(STILL_LIFE);
    let rows = vec![[f32::NAN; 8], [0.0; 8], [0.0, 0.0, 9.0, 0.0, 0.0, 0.0, -1.0, f32::INFINITY]];
    let rays = RaySet { rows, ..RaySet::default() };
    let prepared = Prepared::new(&scene).unwrap();
    let stop = AtomicBool::new(false);
    let rungs = KernelRungs::measure(&prepared, RayKind::Primary, &rays, &options(&stop)).unwrap();
    assert_engines_formula_is_right(&rungs.sphere.unwrap());
}

#[test]
fn a_closed_mesh_leaks_by_moller_and_trumbore_s_test_and_not_by_the_engine_s() {
    let ball = scene(&format!(
        "[image]\nsize = [8, 8]\n[camera]\neye = [0.1, 0.2, 9.3]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nfov = 45\n\
         [material.m]\n{}",
        ball(Vec3::new(0.3, 0.1, 0.2), 2.0, false)
    ));
    let rung = leaks_of(&ball).unwrap();
    assert!(rung.edge_rays > 1000 && rung.corner_rays > 20, "{rung:?}");
    for leaks in &rung.formulas {
        assert_eq!(leaks.is_engines, leaks.at_edges == 0, "{rung:?}");
        assert!(!leaks.is_engines || leaks.at_corners == 0, "{rung:?}");
    }
}

/// A cube of squares, turned about its middle, of any size anywhere; its corners rounded to f32.
fn cube(size: f64, middle: [f64; 3]) -> String {
    // Three orthogonal directions that no axis is along.
    let axes =
        [[2.0, 3.0, 6.0], [3.0, -6.0, 2.0], [6.0, 2.0, -3.0]].map(|axis| axis.map(|part: f64| part / 7.0));
    let corner = |signs: [f64; 3]| -> [f64; 3] {
        std::array::from_fn(|part| {
            middle[part] + size * (0..3).map(|axis| signs[axis] * axes[axis][part]).sum::<f64>()
        })
    };
    let mut text = String::new();
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[one, other]| {
                let mut signs = [side; 3];
                (signs[(axis + 1) % 3], signs[(axis + 2) % 3]) = (one, other);
                corner(signs)
            });
            text += &format!("[[polygon]]\nvertices = {corners:?}\nmaterial = \"m\"\n");
        }
    }
    text
}

fn seen_from(eye: [f64; 3], shapes: &str) -> Scene {
    scene(&format!(
        "[image]\nsize = [16, 16]\n[camera]\neye = {eye:?}\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nfov = 30\n[material.m]\n{shapes}"
    ))
}

#[test]
fn cubes_leak_where_polygons_are_projected_along_an_axis_and_not_along_the_ray() {
    let cubes: String = (0..64_u8)
        .map(|at| cube(0.2, [f64::from(at % 8) - 3.5, f64::from(at / 8) - 3.5, f64::from(at) / 64.0]))
        .collect();
    let rung = polygon_leaks_of(&seen_from([0.3, 0.2, 20.0], &cubes)).unwrap();
    // Of each cube the nearest corner and the farthest one, and the three edges at each.
    assert_eq!((rung.primitive, rung.edge_rays, rung.corner_rays), ("polygon", 64 * 6 * 16, 64 * 2));
    let [along_axis, along_ray] = &rung.formulas[..] else { panic!("{rung:?}") };
    assert!(along_ray.is_engines && (along_ray.at_edges, along_ray.at_corners) == (0, 0), "{rung:?}");
    assert!(along_axis.at_edges > rung.edge_rays / 50 && along_axis.at_corners > 2, "{rung:?}");
}

#[test]
fn both_formulas_for_polygons_agree_but_for_edges() {
    // A star with two hollows beside the cube, so that outlines are concave too.
    let star = "[[polygon]]\nvertices = [[-2, -2, 0], [2, -2, 0], [0.5, 0, 0], [2, 2, 0], [-2, 2, 0], [-0.5, 0, 0]]\n\
                material = \"m\"\n";
    let scene = seen_from([0.3, 0.2, 12.0], &(cube(0.8, [0.4, 0.3, 1.0]) + star));
    let rung = rungs_of(&scene, RayKind::Primary).polygon.unwrap();
    assert_engines_formula_is_right(&rung);
    assert_eq!(rung.formulas.len(), 2);
    for run in &rung.formulas {
        assert_eq!(run.errors.mistakes(), 0, "{run:?}");
        assert!(run.errors.hits > 50, "{run:?}");
    }
    assert!(rung.edges.is_some_and(|edges| edges > 4 * rung.pairs && edges < 6 * rung.pairs), "{rung:?}");
}

#[track_caller]
fn assert_engine_s_box_hides_nothing(rung: &BoxRung) {
    let engines: Vec<_> = rung.formulas.iter().filter(|run| run.is_engines).collect();
    assert_eq!((engines.len(), engines[0].left_out), (1, 0), "{rung:?}");
}

/// Squares along the axes have flat boxes whose corners are theirs: rays at them enter on one axis where they leave on another.
#[test]
fn boxes_that_are_not_padded_hide_corners() {
    let square = |at: u8| {
        let [x, y, z] = [at % 5, at / 5 % 5, at / 25].map(|step| f64::from(step) * 1.37 - 2.9);
        let [high_x, high_y] = [x + 0.4, y + 0.3];
        format!(
            "[[polygon]]\nvertices = [[{x}, {y}, {z}], [{high_x}, {y}, {z}], [{high_x}, {high_y}, {z}], [{x}, {high_y}, {z}]]\n\
             material = \"m\"\n"
        )
    };
    let squares: String = (0..125).map(square).collect();
    let corners_of = |scene: &Scene| {
        let prepared = Prepared::new(scene).unwrap();
        BoxRung::at_corners(&prepared, &options(&AtomicBool::new(false))).unwrap().unwrap()
    };
    let near = corners_of(&seen_from([9.3, 8.2, 10.1], &squares));
    // The same from ten thousand times as far: a distance along a slab has few digits of what the box is wide.
    let far = corners_of(&seen_from([9.3e4, 8.2e4, 10.1e4], &squares));
    for rung in [&near, &far] {
        assert!(rung.true_hits > 50, "{rung:?}");
        assert_engine_s_box_hides_nothing(rung);
        for run in rung.formulas.iter().filter(|run| !run.is_engines) {
            assert!(run.left_out > 0, "{rung:?}");
            assert!(run.seconds.is_none() && rung.nanoseconds(run).is_none(), "{run:?}");
        }
    }
}

#[test]
fn without_weak_rays_there_are_fewer_rays_and_more_error() {
    let scene = scene(STILL_LIFE);
    let stop = AtomicBool::new(false);
    let rung = MinWeightRung::measure(&scene, &options(&stop)).unwrap().unwrap();
    let all = rung.frames.first().unwrap();
    assert_eq!((all.min_weight, rung.size), (0.0, [64, 48]));
    // Without a limit what is left is the engine's own error.
    assert!(all.rms < 1e-4, "{rung:?}");
    for pair in rung.frames.windows(2) {
        assert!(pair[0].min_weight < pair[1].min_weight);
        assert!(pair[0].rays.total() >= pair[1].rays.total(), "{rung:?}");
    }
    let last = rung.frames.last().unwrap();
    assert!(last.rays.total() < all.rays.total() && last.rms > 10.0 * all.rms, "{rung:?}");
}

#[test]
fn without_reflection_there_is_no_rung_of_weak_rays() {
    let matte = one_sphere([0.0, 0.0, 5.0], [0.0; 3], 45.0, [0.0; 3], 1.0);
    assert!(MinWeightRung::measure(&matte, &options(&AtomicBool::new(false))).unwrap().is_none());
    let mut shallow = scene(STILL_LIFE);
    shallow.render.max_depth = 0;
    assert!(MinWeightRung::measure(&shallow, &options(&AtomicBool::new(false))).unwrap().is_none());
}

#[test]
fn more_samples_come_nearer_to_the_truth_and_stratified_ones_faster() {
    let mut scene = scene(STILL_LIFE);
    (scene.image.width, scene.image.height) = (48, 36);
    let stop = AtomicBool::new(false);
    let rung = SamplesRung::measure(&scene, &options(&stop)).unwrap();
    assert_eq!((rung.size, rung.truth_samples), ([48, 36], 4096));
    let slope = |name: &str| {
        let run = rung.patterns.iter().find(|run| run.sampling == name).unwrap();
        assert_eq!(
            run.pictures.iter().map(|picture| picture.n).collect::<Vec<_>>(),
            [1, 2, 3, 4, 5, 6, 7, 8]
        );
        assert!(run.pictures[7].rms < run.pictures[0].rms / 3.0, "{rung:?}");
        run.slope.unwrap()
    };
    // The error of N independent samples goes with N^−½; of a sample in each of N cells, edges need N^−¾.
    assert!((slope("random") + 0.5).abs() < 0.06, "{rung:?}");
    assert!(slope("jittered") < -0.62, "{rung:?}");
    assert!(rung.least_over_numerical().unwrap() > 10.0, "{rung:?}");
}

#[test]
fn pictures_without_error_have_no_slope_and_keep_their_size_within_bounds() {
    let mut empty = scene(
        "[image]\nsize = [8, 8]\nbackground = 0.25\n[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nfov = 45\n",
    );
    (empty.image.width, empty.image.height) = (100_000, 1);
    let rung = SamplesRung::measure(&empty, &options(&AtomicBool::new(false))).unwrap();
    assert_eq!(rung.size, [8192, 1]);
    assert!(rung.patterns.iter().all(|run| run.slope.is_none()), "{rung:?}");
    assert_eq!((rung.numerical_rms, rung.least_over_numerical()), (0.0, None));
}

#[test]
fn a_measurement_says_how_far_it_is_and_stops_when_told_to() {
    let scene = scene(STILL_LIFE);
    let seen = Mutex::new(Vec::new());
    let on_progress = |progress| seen.lock().unwrap_or_else(PoisonError::into_inner).push(progress);
    let stop = AtomicBool::new(false);
    let options = RungOptions { repeats: 0, on_progress: &on_progress, ..options(&stop) };
    let rung = MinWeightRung::measure(&scene, &options).unwrap().unwrap();
    assert!(
        rung.frames.iter().all(|frame| frame.seconds.is_some_and(|seconds| seconds.runs == 1)),
        "no repeats are one"
    );
    let seen = seen.lock().unwrap();
    assert_eq!(
        seen.iter().map(|progress| (progress.done, progress.steps)).collect::<Vec<_>>(),
        [(0, 2), (1, 2)]
    );
    stop.store(true, std::sync::atomic::Ordering::Relaxed);
    let prepared = Prepared::new(&scene).unwrap();
    let stopped = |error: RenderError| matches!(error, RenderError::Stopped);
    assert!(MinWeightRung::measure(&scene, &options).is_err_and(stopped));
    assert!(SamplesRung::measure(&scene, &options).is_err_and(stopped));
    assert!(LeakRung::of_triangles(&prepared, &options).is_err_and(stopped));
    assert!(BoxRung::at_corners(&prepared, &options).is_err_and(stopped));
    let rays = RaySet::default();
    assert!(KernelRungs::measure(&prepared, RayKind::Primary, &rays, &options).is_err_and(stopped));
}
