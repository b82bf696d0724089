//! Hard cases whose answers are known in closed form.

use super::line;
use crate::certified::{Judge, Limb, Line, Place, Seen, Side, polygon, sphere, triangle};
use crate::rays::Stretch;
use crate::scene::{Geometry, Material, MaterialId, Scene};
use glam::{DVec3, Vec3};

/// √¾.
const ROOT: f64 = 0.866_025_403_784_438_6;

/// A unit sphere seen from afar at half its radius off the axis: t = D ∓ √¾.
#[test]
fn far_spheres_keep_their_shape() {
    for distance in [100.0, 1000.0, 2000.0, 4100.0, 8000.0, 65536.0, 1e6_f32] {
        let meeting = sphere(&line(Vec3::new(0.0, 0.5, -distance), Vec3::Z), Vec3::ZERO, 1.0);
        assert_eq!((meeting.limb, meeting.origin), (Limb::Crossed, Side::Outside));
        let distance = f64::from(distance);
        for (t, expected) in meeting.roots.unwrap().into_iter().zip([distance - ROOT, distance + ROOT]) {
            assert!(
                t.contains(expected) || t.distance(expected) <= f64::EPSILON * distance,
                "{t:?} for {expected}"
            );
            assert!(t.width() <= 8.0 * f64::EPSILON * distance, "{t:?}");
        }
    }
}

/// A ray that passes the centre at exactly the radius, and at its neighbours in f32.
#[test]
fn a_tangent_is_told_from_its_neighbours() {
    let at = |y: f32| sphere(&line(Vec3::new(0.0, y, -4.0), Vec3::Z), Vec3::ZERO, 1.0);
    assert_eq!(at(1.0).limb, Limb::Touched);
    assert_eq!(at(1.0).roots.map(|[t, same]| (t.low, t.high, t == same)), Some((4.0, 4.0, true)));
    assert_eq!((at(1.0_f32.next_up()).limb, at(1.0_f32.next_up()).roots), (Limb::Missed, None));
    let crossed = at(1.0_f32.next_down());
    assert_eq!(crossed.limb, Limb::Crossed);
    // y = 1 − u: half the chord is √(2u − u²), u = 2⁻²⁴.
    let u = 1.0 / f64::from(1 << 24);
    let half = (2.0 * u - u * u).sqrt();
    for (t, expected) in crossed.roots.unwrap().into_iter().zip([4.0 - half, 4.0 + half]) {
        assert!(t.distance(expected) <= 4.0 * f64::EPSILON, "{t:?} for {expected}");
    }
}

/// The unit square in two triangles, turned by a third about (1, 1, 1), and rays through its common edge.
#[test]
fn rays_at_a_common_edge_pass_both_triangles_or_their_edge() {
    let turned = |x: f32, y: f32| Vec3::new(0.0, x, y);
    let [a, b, c, d] = [turned(0.0, 0.0), turned(1.0, 0.0), turned(1.0, 1.0), turned(0.0, 1.0)];
    let mut on_edge = 0;
    for (x, y) in (0..32).flat_map(|x: u8| (0..32).map(move |y: u8| (f32::from(x), f32::from(y)))) {
        let origin = Vec3::new(3.0, x / 8.0 - 2.0, y / 8.0 - 2.0);
        let ray = line(origin, turned(0.5, 0.5) - origin);
        let seen = [[a, b, c], [a, c, d]].map(|corners| triangle(&ray, corners));
        // (½, ½) is the middle of the diagonal, from the third corner of the one to the first, and back in the other.
        assert_eq!(seen.map(|meeting| meeting.seen), [Seen::Edge(2), Seen::Edge(0)]);
        on_edge +=
            seen.iter().filter(|meeting| meeting.t.is_some_and(|t| t.low == 1.0 && t.high == 1.0)).count();
    }
    assert_eq!(on_edge, 2 * 32 * 32, "at t = 1 exactly");
}

/// Integer rays on an integer lattice: each is at a corner of four squares, and between them on an edge of two.
#[test]
fn rays_of_a_lattice_are_on_corners_and_edges() {
    let corner = |x: i16, y: i16| Vec3::new(f32::from(x), f32::from(y), 0.0);
    let mut geometry = Geometry::default();
    for (x, y) in (0..8).flat_map(|x| (0..8).map(move |y| (x, y))) {
        let square = [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
        geometry.add_polygon(&square, None, MaterialId(0)).unwrap();
    }
    let judge = Judge::new(&Scene::unlit(geometry, vec![Material::grey()]));
    for (x, y, expected) in [(3.0, 4.0, 4), (3.5, 4.0, 2), (3.0, 4.25, 2), (0.0, 4.0, 2), (0.0, 0.0, 1)] {
        let found = judge.closest(&down(x, y));
        assert_eq!(found.candidates.len(), expected, "at ({x}, {y})");
        assert!(found.candidates.iter().all(|crossing| crossing.place == Place::Boundary));
        assert!(found.candidates.iter().all(|crossing| (crossing.t.low, crossing.t.high) == (5.0, 5.0)));
        assert_eq!((found.may_miss, found.only(), found.is_shared_boundary()), (true, None, expected > 1));
    }
    let inside = judge.closest(&down(3.5, 4.25));
    assert_eq!((inside.candidates.len(), inside.candidates[0].id.0, inside.may_miss), (1, 3 * 8 + 4, false));
    assert_eq!(judge.closest(&down(9.0, 1.0)).only(), Some(None));
}

fn down(x: f64, y: f64) -> Stretch {
    Stretch {
        origin: DVec3::new(x, y, 5.0),
        direction: DVec3::NEG_Z,
        t_min: 0.0,
        t_max: f64::INFINITY,
        departure: None,
    }
}

/// Legs of 10⁻⁴, 10⁻¹² and 10⁻²⁰: no area is too small.
#[test]
fn small_triangles_are_met() {
    for leg in [1e-4, 1e-12, 1e-20_f32] {
        let corners = [Vec3::ZERO, leg * Vec3::X, leg * Vec3::Y];
        let ray = line(Vec3::new(leg / 4.0, leg / 4.0, 3.0), Vec3::NEG_Z);
        let meeting = triangle(&ray, corners);
        assert_eq!(meeting.seen, Seen::Inside);
        assert!(
            meeting.t.is_some_and(|t| t.contains(3.0) && t.width() <= 16.0 * f64::EPSILON),
            "{meeting:?}"
        );
        assert_eq!(polygon(&ray, &corners).seen, Seen::Inside);
        let beside = line(Vec3::new(leg / 2.0, leg / 2.0, 3.0), Vec3::NEG_Z);
        assert_eq!(triangle(&beside, corners).seen, Seen::Edge(1));
    }
}

/// In the plane of a triangle and beside it.
#[test]
fn what_is_seen_edge_on_is_said_to_be() {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
    for ray in
        [Line::new([-1.0, 0.25, 0.0], [1.0, 0.0, 0.0]), Line::new([-1.0, 0.25, 1e-30], [1.0, 0.0, 0.0])]
    {
        assert_eq!(triangle(&ray, corners).seen, Seen::EdgeOn);
        assert_eq!(polygon(&ray, &corners).seen, Seen::EdgeOn);
    }
    let barely = Line::new([-1.0, 0.25, 1e-30], [1.0, 0.0, -1e-30]);
    assert_eq!(triangle(&barely, corners).seen, Seen::Edge(2), "at x = 0 exactly");
}
