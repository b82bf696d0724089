//! Every engine's answers to single rays, judged by what is certain; and what must not change an answer.

use crate::support::scene;
use glam::Vec3;
use proptest::prelude::*;
use std::sync::atomic::AtomicBool;
use wavelane::certified::{Answer, Judge, Judgement, Verdict};
use wavelane::lanes::Width;
use wavelane::prepare::Prepared;
use wavelane::rays::RaySet;
use wavelane::reference::Tracer;
use wavelane::scene::{Geometry, MaterialId, PrimitiveId, Scene};
use wavelane::trace::{Hits, Query, RayColumns, ReferenceRun, Run};

/// A primitive before it has an id.
#[derive(Clone, Debug)]
enum Shape {
    Sphere(Vec3, f32),
    Triangle([Vec3; 3]),
    Polygon(Vec<Vec3>),
}

/// Of any magnitude between 2⁻¹⁶ and 2, or on a grid of quarters, where edges and corners meet rays and each other exactly.
fn coordinate() -> impl Strategy<Value = f32> + Clone {
    let any = (-16.0..1.0_f32, any::<bool>());
    prop_oneof![
        1 => any.prop_map(|(power, negative)| if negative { -power.exp2() } else { power.exp2() }),
        2 => (-6..=6_i8).prop_map(|step| f32::from(step) / 4.0),
    ]
}

fn point() -> impl Strategy<Value = Vec3> + Clone {
    [coordinate(), coordinate(), coordinate()].prop_map(Vec3::from)
}

fn shape() -> impl Strategy<Value = Shape> {
    let polygon = (point(), prop::collection::vec([-4..=4_i8, -4..=4], 3..8), 0..3_usize).prop_map(
        |(at, places, axis)| {
            let corner = |[u, v]: [i8; 2]| {
                let mut corner = at;
                corner[axis] += f32::from(u) / 4.0;
                corner[(axis + 1) % 3] += f32::from(v) / 4.0;
                corner
            };
            Shape::Polygon(places.into_iter().map(corner).collect())
        },
    );
    prop_oneof![
        2 => (point(), -10.0..0.0_f32).prop_map(|(center, size)| Shape::Sphere(center, size.exp2())),
        3 => [point(), point(), point()].prop_map(Shape::Triangle),
        2 => polygon,
    ]
}

impl Shape {
    /// Points that are on it or on its edges, or nearly so.
    fn point(&self, [u, v]: [f32; 2]) -> Vec3 {
        let corners = match self {
            Self::Sphere(center, radius) => {
                return *center + *radius * Vec3::new(u - 0.5, v - 0.5, 0.5).normalize_or_zero();
            }
            Self::Triangle(corners) => &corners[..],
            Self::Polygon(corners) => corners,
        };
        corners[0].lerp(corners[1], u).lerp(corners[2], v)
    }

    /// With its points changed, and named from another corner.
    fn changed(&self, change: impl Fn(Vec3) -> Vec3, by: usize) -> Self {
        match self {
            Self::Sphere(center, radius) => Self::Sphere(change(*center), *radius),
            Self::Triangle(corners) => {
                let mut corners = corners.map(change);
                corners.rotate_left(by % 3);
                Self::Triangle(corners)
            }
            Self::Polygon(corners) => {
                let mut corners: Vec<Vec3> = corners.iter().map(|&corner| change(corner)).collect();
                corners.rotate_left(by % self.corner_count());
                Self::Polygon(corners)
            }
        }
    }

    fn scaled(&self, factor: f32) -> Self {
        match self.changed(|point| point * factor, 0) {
            Self::Sphere(center, radius) => Self::Sphere(center, radius * factor),
            other => other,
        }
    }

    fn corner_count(&self) -> usize {
        if let Self::Polygon(corners) = self { corners.len() } else { 3 }
    }
}

/// Shapes, and rays aimed at them: through any point, an edge or a corner, from a limited stretch now and then.
fn case() -> impl Strategy<Value = (Vec<Shape>, Vec<[f32; 8]>)> {
    let share = || prop_oneof![2 => Just(0.0), 1 => Just(0.5), 2 => 0.0..1.0_f32];
    let end = prop_oneof![4 => Just([0.0, f32::INFINITY]), 1 => [0.0..1.0_f32, 0.0..3.0_f32]];
    let aim = (any::<prop::sample::Index>(), [share(), share()], point(), end, -6.0..6.0_f32, any::<bool>());
    (prop::collection::vec(shape(), 1..12), prop::collection::vec(aim, 1..80)).prop_map(|(shapes, aims)| {
        let ray = |(at, shares, from, [t_min, t_max], length, along_axis): (
            prop::sample::Index,
            [f32; 2],
            Vec3,
            [f32; 2],
            f32,
            bool,
        )| {
            let target = shapes[at.index(shapes.len())].point(shares);
            let (origin, direction) = if along_axis {
                (Vec3::new(target.x, target.y, from.z - 2.0), Vec3::Z)
            } else {
                (from, (target - from) * length.exp2())
            };
            [origin.x, origin.y, origin.z, t_min, direction.x, direction.y, direction.z, t_max]
        };
        let rays = aims.into_iter().map(ray).filter(|ray| ray[4..7] != [0.0; 3]).collect();
        (shapes, rays)
    })
}

/// Shapes that are none, without an area or bent, keep their id and are not there.
fn scene_of(shapes: &[Shape]) -> Scene {
    let mut scene = scene(
        "[image]\nsize = [8, 8]\n[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nfov = 45\n[material.m]\n\
         [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"m\"\n",
    );
    let mut geometry = Geometry::default();
    for shape in shapes {
        match shape {
            Shape::Sphere(center, radius) => geometry.add_sphere(*center, *radius, MaterialId(0)).unwrap(),
            Shape::Triangle(corners) => {
                let first = geometry.add_vertices(*corners).unwrap();
                geometry.add_triangle([first, first + 1, first + 2], None, MaterialId(0)).unwrap();
            }
            Shape::Polygon(corners) => {
                let _ = geometry.add_polygon(corners, None, MaterialId(0));
            }
        }
    }
    scene.geometry = geometry;
    scene
}

/// What every engine says, the reference first.
fn answers(scene: &Scene, rays: &RaySet, query: Query) -> Vec<Hits> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let stop = AtomicBool::new(false);
    let tracer = Tracer::new(scene, &stop);
    let mut reference = ReferenceRun::new(&tracer, rays, query);
    reference.pass(&pool);
    let prepared = Prepared::new(scene).unwrap();
    let columns = RayColumns::new(&prepared, rays);
    let of_width = |width: Width| {
        let mut run = Run::new(&prepared, &columns, query);
        run.pass(width, &pool);
        run.hits()
    };
    [reference.hits().clone()].into_iter().chain(Width::ALL.map(of_width)).collect()
}

fn ray_set(rows: &[[f32; 8]]) -> RaySet {
    RaySet { rows: rows.to_vec(), ..RaySet::default() }
}

fn judged(judge: &Judge, rays: &RaySet, row: usize, hits: &Hits) -> Judgement {
    let id = Some(hits.id[row]).filter(|&id| id != Hits::MISS).map(PrimitiveId);
    let stretch = rays.stretch(row).unwrap();
    judge.judge_closest(&stretch, Answer { t: f64::from(hits.t[row]), id })
}

/// The reference takes t for equal that differ by 2⁻⁴⁶ of the coordinates: at most 16·2⁻²² of a rounding of f32, since no coordinate
/// that it counts is larger than the distance of the farthest point and twice the origin's together; rounded up.
const REFERENCE_BAND: f64 = 1.0 / (1 << 17) as f64;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn no_engine_s_first_hit_is_wrong((shapes, rows) in case()) {
        let (scene, rays) = (scene_of(&shapes), ray_set(&rows));
        let judge = Judge::new(&scene);
        for (engine, hits) in answers(&scene, &rays, Query::Closest).iter().enumerate() {
            for row in 0..rows.len() {
                let judgement = judged(&judge, &rays, row, hits);
                let said = (hits.id[row], hits.t[row]);
                prop_assert!(judgement.verdict != Verdict::Wrong, "engine {engine}, {said:?}: {judgement:?} of {:?}", rays.stretch(row));
                prop_assert!(engine > 0 || judgement.decision <= REFERENCE_BAND, "the reference, {said:?}: {judgement:?} of {:?}", rays.stretch(row));
            }
        }
    }

    #[test]
    fn no_engine_s_shadow_is_wrong((shapes, rows) in case()) {
        let (scene, rays) = (scene_of(&shapes), ray_set(&rows));
        let judge = Judge::new(&scene);
        for (engine, hits) in answers(&scene, &rays, Query::Any).iter().enumerate() {
            for row in 0..rows.len() {
                let stretch = rays.stretch(row).unwrap();
                let judgement = judge.judge_occluded(&stretch, hits.t[row] == 0.0);
                prop_assert!(judgement.verdict != Verdict::Wrong, "engine {engine}, {}: {judgement:?} of {stretch:?}", hits.t[row]);
            }
        }
    }

    /// Whatever f64 makes of the triangle's plane.
    #[test]
    fn a_triangle_is_not_met_from_its_own_corner(corners in [point(), point(), point()], at in 0..3_usize, aims in prop::collection::vec(point(), 1..20)) {
        let scene = scene_of(&[Shape::Triangle(corners)]);
        let [x, y, z] = corners[at].to_array();
        let aims = aims.into_iter().map(<[f32; 3]>::from).filter(|aim| *aim != [0.0; 3]);
        let rays: Vec<[f32; 8]> = aims.map(|[dx, dy, dz]| [x, y, z, 0.0, dx, dy, dz, f32::INFINITY]).collect();
        for (engine, hits) in answers(&scene, &ray_set(&rays), Query::Closest).iter().enumerate() {
            for (row, &id) in hits.id.iter().enumerate() {
                prop_assert!(id == Hits::MISS, "engine {engine}, {:?}: met at {:e}", rays[row], hits.t[row]);
            }
        }
    }

    /// A million times as large or as small: t is scaled, and nothing else changes by a bit.
    #[test]
    fn engines_see_the_same_at_every_scale((shapes, rows) in case(), power in prop::sample::select(vec![-20, 20])) {
        let factor = 2.0_f32.powi(power);
        let larger: Vec<Shape> = shapes.iter().map(|shape| shape.scaled(factor)).collect();
        let scaled = |row: &[f32; 8]| {
            let [x, y, z, t_min, dx, dy, dz, t_max] = *row;
            [x * factor, y * factor, z * factor, t_min * factor, dx, dy, dz, t_max * factor]
        };
        let larger_rows: Vec<[f32; 8]> = rows.iter().map(scaled).collect();
        for query in [Query::Closest, Query::Any] {
            let before = answers(&scene_of(&shapes), &ray_set(&rows), query);
            let after = answers(&scene_of(&larger), &ray_set(&larger_rows), query);
            for (engine, (mut before, after)) in before.into_iter().zip(after).enumerate() {
                before.t.iter_mut().for_each(|t| *t *= factor);
                prop_assert!(before.has_same_bits(&after), "engine {engine}, {query:?}: {before:?} and {after:?}");
            }
        }
    }

    /// Corners named in another order, axes in another order, an axis mirrored: the same primitive, or both within rounding of the
    /// truth, and t within its bound.
    #[test]
    fn engines_see_the_same_from_every_side((shapes, rows) in case(), turns in 0..3_usize, mirrored in any::<bool>(), by in 0..5_usize) {
        let change = move |point: Vec3| {
            let mut turned = Vec3::from([0, 1, 2].map(|axis| point[(axis + turns) % 3]));
            if mirrored {
                turned.x = -turned.x;
            }
            turned
        };
        let turned: Vec<Shape> = shapes.iter().map(|shape| shape.changed(change, by)).collect();
        let turned_rows: Vec<[f32; 8]> = rows
            .iter()
            .map(|&[x, y, z, t_min, dx, dy, dz, t_max]| {
                let (origin, direction) = (change(Vec3::new(x, y, z)), change(Vec3::new(dx, dy, dz)));
                [origin.x, origin.y, origin.z, t_min, direction.x, direction.y, direction.z, t_max]
            })
            .collect();
        let scenes = [scene_of(&shapes), scene_of(&turned)];
        prop_assume!(scenes[0].geometry.primitive_count() == scenes[1].geometry.primitive_count());
        let rays = [ray_set(&rows), ray_set(&turned_rows)];
        let judges = scenes.each_ref().map(Judge::new);
        let [before, after] = [0, 1].map(|at| answers(&scenes[at], &rays[at], Query::Closest));
        for (engine, both) in before.iter().zip(&after).enumerate() {
            for row in 0..rows.len() {
                let judgements = [(0, both.0), (1, both.1)].map(|(at, hits)| judged(&judges[at], &rays[at], row, hits));
                let both_right = judgements.iter().all(|judgement| judgement.verdict != Verdict::Wrong);
                prop_assert!(both_right, "engine {engine}, {} and {}: {judgements:?}", both.0.id[row], both.1.id[row]);
                if both.0.id[row] != both.1.id[row] {
                    // Certain is only what no rounding may change, in the one as in the other.
                    let truth = judges[0].closest(&rays[0].stretch(row).unwrap());
                    let is_open = truth.only().is_none() || judgements.iter().any(|judgement| judgement.decision > 0.0);
                    prop_assert!(is_open, "engine {engine}: {truth:?}");
                }
            }
        }
    }
}

/// Rays that start in the plane of a triangle, beside the middle of an edge by less than f32 can tell, and one that lies in a plane and
/// is aimed at the middle of an edge: found at random, once in some ten thousand cases.
#[test]
fn rays_that_start_in_a_plane_meet_it_within_rounding() {
    let edge_on = [[-1.5, 0.75, 0.0], [-1.0, 1.5, -0.25], [1.0, -0.75, 0.5]];
    let beside = [[-0.000_986_554_7, -1.0, 0.0], [0.001_797_568_4, -1.5, 0.25], [1.0, 1.25, -1.0]];
    let turned = |[x, y, z]: [f32; 3]| [-y, z, x];
    let along_z = [0.499_506_7, 0.125, -0.5];
    for (corners, origin, direction) in [
        (edge_on, [-0.000_188_313_79, 0.0, 0.25], [-1.249_811_6, 1.125, -0.375]),
        (beside, along_z, [0.0, 0.0, 1.0]),
        (beside.map(turned), turned(along_z), [0.0, 1.0, 0.0]),
    ] {
        let scene = scene_of(&[Shape::Triangle(corners.map(Vec3::from))]);
        let ([x, y, z], [dx, dy, dz]) = (origin, direction);
        let rays = ray_set(&[[x, y, z, 0.0, dx, dy, dz, f32::INFINITY]]);
        let judge = Judge::new(&scene);
        for (engine, hits) in answers(&scene, &rays, Query::Closest).iter().enumerate() {
            let judgement = judged(&judge, &rays, 0, hits);
            assert!(
                judgement.verdict != Verdict::Wrong,
                "engine {engine}, t = {:e}: {judgement:?}",
                hits.t[0]
            );
        }
    }
}
