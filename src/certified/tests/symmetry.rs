//! What changes nothing about a line and a primitive changes nothing about the answer.

use super::{at_polygon, at_sphere, at_triangle};
use crate::certified::{Enclosure, FaceMeeting, Line, Seen, polygon, sphere, triangle};
use glam::{DVec3, Vec3};
use proptest::prelude::*;

/// A change of all coordinates that rounds none of them.
#[derive(Clone, Copy, Debug)]
enum Change {
    /// By a power of two.
    Scale(i32),
    /// x, y, z become y, z, x.
    Turn,
    /// x and y change places.
    Swap,
    /// An axis is mirrored.
    Mirror(usize),
}

impl Change {
    fn of_point(self, point: DVec3) -> DVec3 {
        match self {
            Self::Scale(power) => point * 2.0_f64.powi(power),
            Self::Turn => DVec3::new(point.y, point.z, point.x),
            Self::Swap => DVec3::new(point.y, point.x, point.z),
            Self::Mirror(axis) => {
                let mut mirrored = point;
                mirrored[axis] = -mirrored[axis];
                mirrored
            }
        }
    }

    fn of_corner(self, corner: Vec3) -> Vec3 {
        let changed = self.of_point(corner.as_dvec3()).as_vec3();
        assert_eq!(changed.as_dvec3(), self.of_point(corner.as_dvec3()), "something was rounded");
        changed
    }

    /// The direction keeps its length, so t is scaled.
    fn of_line(self, line: Line) -> Line {
        let origin = self.of_point(line.origin);
        let direction = match self {
            Self::Scale(_) => line.direction,
            _ => self.of_point(line.direction),
        };
        Line { origin, direction }
    }

    fn factor(self) -> f64 {
        if let Self::Scale(power) = self { 2.0_f64.powi(power) } else { 1.0 }
    }
}

fn change() -> impl Strategy<Value = Change> {
    prop_oneof![
        2 => prop::sample::select(vec![-60, -20, 20, 60]).prop_map(Change::Scale),
        1 => Just(Change::Turn),
        1 => Just(Change::Swap),
        1 => (0..3_usize).prop_map(Change::Mirror),
    ]
}

/// Of the same truth.
fn overlap(a: Option<Enclosure>, b: Option<Enclosure>) -> bool {
    match (a, b) {
        (None, None) => true,
        (Some(a), Some(b)) => a.low <= b.high && b.low <= a.high,
        _ => false,
    }
}

fn scaled(t: Enclosure, factor: f64) -> Enclosure {
    Enclosure { low: t.low * factor, high: t.high * factor }
}

/// The same but for the names of edges and corners. What is at exactly one place, through a polygon that comes by there twice, may
/// be any of its edges or corners.
fn same_kind(a: Seen, b: Seen) -> bool {
    a == b || (a.is_boundary() && b.is_boundary())
}

fn assert_same(found: FaceMeeting, expected: FaceMeeting, change: Change) -> Result<(), TestCaseError> {
    prop_assert_eq!(found.seen, expected.seen);
    let t = expected.t.map(|t| scaled(t, change.factor()));
    match change {
        Change::Scale(_) => prop_assert_eq!((found.t, found.by), (t, expected.by), "equal bits"),
        _ => prop_assert!(overlap(found.t, t), "{:?} for {t:?}", found.t),
    }
    Ok(())
}

fn is_fastest_along_two_axes(line: &Line) -> bool {
    let size = line.direction.abs();
    size.to_array().into_iter().filter(|&component| component == size.max_element()).count() > 1
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn triangles_are_seen_alike_at_every_scale_from_every_side((line, corners) in at_triangle(), change in change()) {
        let found = triangle(&change.of_line(line), corners.map(|corner| change.of_corner(corner)));
        assert_same(found, triangle(&line, corners), change)?;
    }

    #[test]
    fn polygons_are_seen_alike_at_every_scale_from_every_side((line, corners) in at_polygon(), change in change()) {
        // What keeps t of a bent polygon between its corners is where these are along the axis in which the line is fastest, of two
        // axes the first: the other one once they have changed places.
        prop_assume!(!is_fastest_along_two_axes(&line));
        let changed: Vec<Vec3> = corners.iter().map(|&corner| change.of_corner(corner)).collect();
        assert_same(polygon(&change.of_line(line), &changed), polygon(&line, &corners), change)?;
    }

    #[test]
    fn spheres_are_seen_alike_at_every_scale_from_every_side((line, center, radius) in at_sphere(), change in change()) {
        let factor = change.factor();
        #[expect(clippy::cast_possible_truncation, reason = "a power of two changes no digit of an f32")]
        let found = sphere(&change.of_line(line), change.of_corner(center), radius * factor as f32);
        let expected = sphere(&line, center, radius);
        prop_assert_eq!((found.limb, found.origin), (expected.limb, expected.origin));
        let roots = expected.roots.map(|roots| roots.map(|t| scaled(t, factor)));
        match change {
            Change::Scale(_) => prop_assert_eq!((found.roots, found.by), (roots, expected.by), "equal bits"),
            _ => for at in 0..2 {
                let [found, expected] = [found.roots, roots].map(|roots| roots.map(|roots| roots[at]));
                prop_assert!(overlap(found, expected), "{:?} for {:?}", found, expected);
            },
        }
    }

    #[test]
    fn triangles_are_seen_alike_from_whichever_corner_they_are_named((line, [a, b, c]) in at_triangle()) {
        let expected = triangle(&line, [a, b, c]);
        // The place of each corner and each edge of the first order in the others.
        for (corners, places) in [([b, c, a], [2, 0, 1]), ([c, a, b], [1, 2, 0]), ([c, b, a], [2, 1, 0]), ([a, c, b], [0, 2, 1])] {
            let found = triangle(&line, corners);
            let seen = match expected.seen {
                Seen::Corner(at) => Seen::Corner(places[at]),
                Seen::Edge(at) => {
                    let [from, to] = [places[at], places[(at + 1) % 3]];
                    Seen::Edge(if (from + 1) % 3 == to { from } else { to })
                }
                other => other,
            };
            prop_assert_eq!(found.seen, seen);
            prop_assert!(overlap(found.t, expected.t));
        }
    }

    #[test]
    fn outlines_can_be_walked_from_any_corner_either_way((line, corners) in at_polygon(), start in any::<prop::sample::Index>()) {
        let expected = polygon(&line, &corners);
        // The plane goes through the first corner, so t is the same only of what is planar.
        let mut turned = corners.clone();
        turned.reverse();
        turned.rotate_left(start.index(corners.len()));
        let found = polygon(&line, &turned);
        let is_edge_on = [found.seen, expected.seen].contains(&Seen::EdgeOn);
        prop_assert!(same_kind(found.seen, expected.seen) || is_edge_on, "{:?} for {:?}", found.seen, expected.seen);
    }

    #[test]
    fn nothing_depends_on_where_the_world_begins((line, corners) in at_triangle(), offset in [-512..512_i16, -512..512, -512..512]) {
        // Eighths, which stay what they are anywhere in a world of a million.
        let eighths = |point: DVec3| (point * 8.0).round() / 8.0;
        let corners = corners.map(|corner| eighths(corner.as_dvec3()).as_vec3());
        let line = Line { origin: eighths(line.origin), ..line };
        let offset = Vec3::from(offset.map(f32::from));
        let moved = corners.map(|corner| corner + offset);
        let moved_line = Line { origin: line.origin + offset.as_dvec3(), ..line };
        let (found, expected) = (triangle(&moved_line, moved), triangle(&line, corners));
        prop_assert_eq!(found.seen, expected.seen);
        prop_assert!(overlap(found.t, expected.t));
        prop_assert_eq!(polygon(&moved_line, &moved).seen.is_boundary(), expected.seen.is_boundary());
    }

    #[test]
    fn a_longer_direction_shortens_t((line, corners) in at_triangle(), power in -40..40_i32) {
        let factor = 2.0_f64.powi(power);
        let found = triangle(&Line { direction: line.direction * factor, ..line }, corners);
        let expected = triangle(&line, corners);
        prop_assert_eq!(found.seen, expected.seen);
        prop_assert_eq!(found.t, expected.t.map(|t| scaled(t, 1.0 / factor)));
    }
}
