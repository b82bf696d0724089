//! What the judge says of scenes, and of answers.

use crate::certified::{Answer, BAND, Judge, Occlusion, Place, Verdict};
use crate::rays::{Departure, Stretch};
use crate::scene::{Geometry, Material, MaterialId, PrimitiveId, Scene};
use glam::{DVec3, Vec3};

const OPAQUE: MaterialId = MaterialId(0);
const SHADOWLESS: MaterialId = MaterialId(1);

fn judge(geometry: Geometry) -> Judge {
    let shadowless = Material { casts_shadow: false, ..Material::grey() };
    Judge::new(&Scene::unlit(geometry, vec![Material::grey(), shadowless]))
}

fn add_square(geometry: &mut Geometry, half: f32, z: f32, material: MaterialId) {
    let corners = [[-half, -half], [half, -half], [half, half], [-half, half]];
    geometry.add_polygon(&corners.map(|[x, y]| Vec3::new(x, y, z)), None, material).unwrap();
}

/// Straight down from height 5, without an end.
fn down(x: f64, y: f64) -> Stretch {
    Stretch {
        origin: DVec3::new(x, y, 5.0),
        direction: DVec3::NEG_Z,
        t_min: 0.0,
        t_max: f64::INFINITY,
        departure: None,
    }
}

fn hit(id: u32, t: f64) -> Answer {
    Answer { t, id: Some(PrimitiveId(id)) }
}

const MISS: Answer = Answer { t: f64::INFINITY, id: None };

#[test]
fn the_first_of_what_is_crossed_is_the_answer_and_of_what_coincides_the_smallest_id() {
    let mut geometry = Geometry::default();
    for z in [0.0, 1.0, 1.0] {
        add_square(&mut geometry, 1.0, z, OPAQUE);
    }
    geometry.add_sphere(Vec3::new(0.0, 0.0, 1.5), 0.25, OPAQUE).unwrap();
    let judge = judge(geometry);
    let beside = judge.closest(&down(0.5, 0.5));
    assert_eq!(beside.candidates.iter().map(|crossing| crossing.id.0).collect::<Vec<_>>(), [1, 2]);
    assert_eq!((beside.only(), beside.may_miss), (Some(Some(PrimitiveId(1))), false));
    assert!(
        beside.admits(Some(PrimitiveId(1))) && !beside.admits(Some(PrimitiveId(2))) && !beside.admits(None)
    );
    assert_eq!(judge.closest(&down(0.0, 0.125)).only(), Some(Some(PrimitiveId(3))));
    assert_eq!(judge.crossings(&down(0.0, 0.125)).len(), 5);
    assert_eq!(
        judge.closest(&Stretch { t_max: 4.0, ..down(0.5, 0.5) }).only(),
        Some(None),
        "hits are before the end"
    );
    assert_eq!(judge.closest(&Stretch { t_min: 4.0, ..down(0.5, 0.5) }).only(), Some(Some(PrimitiveId(0))));
}

/// A sphere and a plane that touch it are met at one t, though the one is a root and the other a quotient.
#[test]
fn a_sphere_and_a_plane_are_told_apart_by_their_last_bit() {
    for (z, first) in [(1.0_f32, 0), (1.0_f32.next_up(), 0), (1.0_f32.next_down(), 1)] {
        let mut geometry = Geometry::default();
        add_square(&mut geometry, 2.0, z, OPAQUE);
        geometry.add_sphere(Vec3::ZERO, 1.0, OPAQUE).unwrap();
        let found = judge(geometry).closest(&down(0.0, 0.0));
        assert_eq!(found.only(), Some(Some(PrimitiveId(first))), "the plane at {z}");
        assert_eq!(found.candidates.len(), if z == 1.0 { 2 } else { 1 });
    }
}

/// Seen from 2³¹ away, t that differ by 2⁻²⁴ are one number of f64.
#[test]
fn what_is_nearer_by_less_than_f64_can_tell_is_nearer() {
    for (gap, first) in [(-1.0, 0), (0.0, 0), (1.0, 1)] {
        let mut geometry = Geometry::default();
        add_square(&mut geometry, 1.0, 1e-3, OPAQUE);
        let z = 1e-3 + gap / f64::from(1 << 24);
        #[expect(clippy::cast_possible_truncation, reason = "a multiple of its last place")]
        add_square(&mut geometry, 1.0, z as f32, OPAQUE);
        let from_afar = Stretch { origin: DVec3::new(0.25, 0.125, 2.0_f64.powi(31)), ..down(0.0, 0.0) };
        let found = judge(geometry).closest(&from_afar);
        assert_eq!(found.only(), Some(Some(PrimitiveId(first))), "{gap}");
        assert_eq!(found.candidates.len(), if gap == 0.0 { 2 } else { 1 });
    }
}

#[test]
fn only_what_casts_a_shadow_is_in_the_way() {
    let mut geometry = Geometry::default();
    add_square(&mut geometry, 1.0, 1.0, SHADOWLESS);
    add_square(&mut geometry, 0.5, 0.0, OPAQUE);
    let judge = judge(geometry);
    assert_eq!(judge.occluded(&down(0.25, 0.25)), Occlusion::Occluded);
    assert_eq!(judge.occluded(&down(0.75, 0.25)), Occlusion::Free);
    assert_eq!(judge.occluded(&down(0.5, 0.25)), Occlusion::Boundary);
    assert_eq!(
        judge.occluded(&Stretch { t_max: 5.0, ..down(0.25, 0.25) }),
        Occlusion::Free,
        "at the end exactly"
    );
    assert_eq!(
        judge.occluded(&Stretch { t_max: 5.0_f64.next_up(), ..down(0.25, 0.25) }),
        Occlusion::Occluded
    );
    let verdict = |x: f64, occluded: bool| judge.judge_occluded(&down(x, 0.25), occluded).verdict;
    assert_eq!([verdict(0.25, true), verdict(0.25, false)], [Verdict::Right, Verdict::Wrong]);
    assert_eq!([verdict(0.75, true), verdict(0.75, false)], [Verdict::Wrong, Verdict::Right]);
    assert_eq!([verdict(0.5, true), verdict(0.5, false)], [Verdict::Right; 2]);
    assert_eq!([verdict(0.5 + 1e-7, true), verdict(0.5 - 1e-7, false)], [Verdict::WithinRounding; 2]);
}

#[test]
fn a_ray_never_meets_the_face_that_it_leaves_and_a_sphere_once_if_it_goes_inside() {
    let mut geometry = Geometry::default();
    add_square(&mut geometry, 1.0, 0.0, OPAQUE);
    geometry.add_sphere(Vec3::new(0.0, 0.0, 2.0), 1.0, OPAQUE).unwrap();
    let judge = judge(geometry);
    let leaving = |id: u32, inward: bool, z: f64| {
        let departure = Some(Departure { from: PrimitiveId(id), inward });
        Stretch { origin: DVec3::new(0.25, 0.0, z), departure, ..down(0.0, 0.0) }
    };
    // Whatever rounding made of the start.
    for off in [-1e-14, 0.0, 1e-14] {
        assert_eq!(judge.closest(&leaving(0, true, off)).only(), Some(None));
        let height = 2.0 + (1.0_f64 - 0.0625).sqrt() + off;
        let inside = judge.closest(&leaving(1, true, height));
        assert_eq!(inside.only(), Some(Some(PrimitiveId(1))));
        assert!(inside.candidates[0].t.distance(2.0 * (1.0_f64 - 0.0625).sqrt()) < 1e-13);
        assert_eq!(
            judge.closest(&leaving(1, false, 2.0 - (1.0_f64 - 0.0625).sqrt() + off)).only(),
            Some(Some(PrimitiveId(0)))
        );
    }
}

/// A face that touches the start may be met or not; a little way off it is met.
#[test]
fn what_touches_the_start_may_be_met_or_not() {
    let mut geometry = Geometry::default();
    add_square(&mut geometry, 1.0, 0.0, OPAQUE);
    add_square(&mut geometry, 1.0, 0.0, OPAQUE);
    add_square(&mut geometry, 1.0, -1.0, OPAQUE);
    let judge = judge(geometry);
    let departure = Some(Departure { from: PrimitiveId(0), inward: true });
    for (height, touches) in [(1e-16, true), (0.0, true), (-1e-16, true), (1e-12, false), (-1e-12, false)] {
        let found =
            judge.closest(&Stretch { origin: DVec3::new(0.25, 0.125, height), departure, ..down(0.0, 0.0) });
        let places: Vec<Place> = found.candidates.iter().map(|crossing| crossing.place).collect();
        let expected: &[Place] = if touches { &[Place::Start, Place::Inside] } else { &[Place::Inside] };
        assert_eq!(places, expected, "{height}");
        assert_eq!(found.admits(Some(PrimitiveId(1))), touches || height > 0.0);
        assert_eq!(found.admits(Some(PrimitiveId(2))), touches || height < 0.0);
    }
}

/// Beside an edge by so many roundings, the wrong answer is so far from right, and counts as rounding within the band.
#[test]
fn a_wrong_answer_is_as_far_from_right_as_the_edge_is() {
    let mut geometry = Geometry::default();
    add_square(&mut geometry, 1.0, 0.0, OPAQUE);
    let judge = judge(geometry);
    let farthest = DVec3::new(2.0, 1.25, 5.0).length();
    let unit = (farthest + DVec3::new(1.0, 0.25, 5.0).length() / BAND) / f64::from(1 << 24);
    for (roundings, verdict) in [
        (0.01, Verdict::WithinRounding),
        (3.0, Verdict::WithinRounding),
        (7.7, Verdict::WithinRounding),
        (7.8, Verdict::Wrong),
        (1000.0, Verdict::Wrong),
    ] {
        for (side, wrong, right) in [(1.0, hit(0, 5.0), MISS), (-1.0, MISS, hit(0, 5.0))] {
            let stretch = down(1.0 + side * roundings * unit, 0.25);
            let judged = judge.judge_closest(&stretch, wrong);
            assert!((judged.decision / roundings - 1.0).abs() < 2e-3, "{judged:?} for {roundings}");
            assert_eq!(judged.verdict, verdict, "{roundings}");
            let judged = judge.judge_closest(&stretch, right);
            assert_eq!((judged.verdict, judged.decision), (Verdict::Right, 0.0));
            let inside_by = judge.judge_closest(&stretch, hit(0, 5.0)).inside_by.unwrap();
            assert!((inside_by / (-side * roundings) - 1.0).abs() < 1e-3, "{inside_by} for {roundings}");
        }
    }
}

/// A ray that starts exactly at a corner does not meet the triangle beyond its start, by however little an answer is beyond it: such a
/// one is within rounding, and not right.
#[test]
fn an_answer_that_is_wrong_by_nothing_that_f64_can_see_is_not_right() {
    let corners =
        [[3.034_815_2e-5, -0.001_183_343_2, 0.25], [-1.5, -0.399_910_54, 0.236_049_56], [1.0, -1.0, -1.0]];
    let mut geometry = Geometry::default();
    let first = geometry.add_vertices(corners.map(Vec3::from)).unwrap();
    geometry.add_triangle([first, first + 1, first + 2], None, OPAQUE).unwrap();
    let judge = judge(geometry);
    let origin = Vec3::from(corners[1]).as_dvec3();
    let stretch = Stretch { origin, direction: DVec3::X, ..down(0.0, 0.0) };
    assert_eq!(judge.closest(&stretch).only(), Some(None));
    assert_eq!(judge.judge_closest(&stretch, MISS).verdict, Verdict::Right);
    let judged = judge.judge_closest(&stretch, hit(0, 6e-17));
    assert!(judged.verdict == Verdict::WithinRounding && judged.decision > 0.0, "{judged:?}");
    let judged = judge.judge_occluded(&stretch, true);
    assert!(judged.verdict == Verdict::WithinRounding && judged.decision > 0.0, "{judged:?}");
}

/// t of a face in units of u·L / cos θ.
#[test]
fn t_is_judged_by_how_far_the_plane_would_have_to_be_moved() {
    let mut geometry = Geometry::default();
    add_square(&mut geometry, 1.0, 0.0, OPAQUE);
    geometry.add_sphere(Vec3::new(9.0, 0.0, 0.0), 1.0, OPAQUE).unwrap();
    let judge = judge(geometry);
    let (origin, direction) = (DVec3::new(-3.0, 0.25, 4.0), DVec3::new(6.0, 0.0, -8.0));
    let stretch = Stretch { origin, direction, ..down(0.0, 0.0) };
    let farthest = DVec3::new(4.0, 1.25, 4.0).length();
    // cos θ = 0.8, |d| = 10, t = ½.
    let per_rounding = (farthest + origin.length() / BAND) / f64::from(1 << 24) / 8.0;
    for roundings in [-30.0, -5.0, 0.25, 2.0, 100.0] {
        let judged = judge.judge_closest(&stretch, hit(0, 0.5 + roundings * per_rounding));
        assert!((judged.t.unwrap() / f64::abs(roundings) - 1.0).abs() < 2e-3, "{judged:?} for {roundings}");
        assert_eq!(judged.verdict, if f64::abs(roundings) < BAND { Verdict::Right } else { Verdict::Wrong });
    }
    // The far side of a sphere is not its near one.
    let at_sphere = down(9.0, 0.0);
    assert_eq!(judge.judge_closest(&at_sphere, hit(1, 4.0)).verdict, Verdict::Right);
    assert_eq!(judge.judge_closest(&at_sphere, hit(1, 6.0)).verdict, Verdict::Wrong);
    // The square is 8 away from this ray.
    assert!(judge.judge_closest(&at_sphere, hit(0, 5.0)).decision > 1e6);
    assert_eq!(judge.judge_closest(&at_sphere, hit(7, 5.0)).decision, f64::INFINITY);
}

/// Two planes so near that f32 cannot tell which is first.
#[test]
fn the_farther_of_two_is_within_rounding_where_rounding_hides_the_gap() {
    let other = |gap: f32| {
        let mut geometry = Geometry::default();
        add_square(&mut geometry, 1.0, 0.0, OPAQUE);
        add_square(&mut geometry, 1.0, gap, OPAQUE);
        let judged = judge(geometry).judge_closest(&down(0.25, 0.125), hit(0, 5.0));
        (judged.verdict, judged.decision)
    };
    let u = 1.0 / (1 << 24) as f32;
    assert_eq!(other(-0.5), (Verdict::Right, 0.0));
    let (verdict, decision) = other(32.0 * u);
    // Each is moved by half of the gap, in units of L ≈ 5.3 and what the origin adds.
    assert!(verdict == Verdict::WithinRounding && (2.4..3.0).contains(&decision), "{decision}");
    assert_eq!(other(256.0 * u).0, Verdict::Wrong);
}

/// A miss between two triangles that share an edge exactly under the ray is no mistake of the first kind: either holds it.
#[test]
fn on_a_shared_edge_either_triangle_is_right() {
    let mut geometry = Geometry::default();
    let corners = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]].map(Vec3::from);
    let first = geometry.add_vertices(corners).unwrap();
    for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
        geometry.add_triangle([first + a, first + b, first + c], None, OPAQUE).unwrap();
    }
    add_square(&mut geometry, 2.0, -1.0, OPAQUE);
    let judge = judge(geometry);
    let found = judge.closest(&down(0.25, 0.25));
    assert!(found.is_shared_boundary());
    for id in 0..3 {
        assert!(found.admits(Some(PrimitiveId(id))), "{id}");
    }
    assert!(!found.admits(None) && found.only().is_none());
}
