//! One question, asked in two ways that share nothing but the numbers.

use super::{at_sphere, at_triangle};
use crate::certified::exact::{Exact, Surd};
use crate::certified::number::Number;
use crate::certified::{Limb, Line, Seen, Side, polygon, sphere, triangle};
use glam::Vec3;
use proptest::prelude::*;
use std::cmp::Ordering;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    /// By three determinants, and by crossings of the outline with a half-line.
    #[test]
    fn a_triangle_is_a_polygon_of_three_corners((line, corners) in at_triangle()) {
        let (one, other) = (triangle(&line, corners), polygon(&line, &corners));
        prop_assert_eq!(one.seen, other.seen);
        if let (Some(one), Some(other)) = (one.t, other.t) {
            prop_assert!(one.low <= other.high && other.low <= one.high, "{one:?} and {other:?}");
        }
    }

    /// A polygon cut along a chord: what is strictly inside of the whole is inside of one part, or on the cut.
    #[test]
    fn parts_of_a_polygon_share_out_its_inside((line, corners) in super::at_polygon(), ends in [any::<prop::sample::Index>(), any::<prop::sample::Index>()]) {
        let [one, other] = ends.map(|end| end.index(corners.len()));
        let (first, last) = (one.min(other), one.max(other));
        let part: Vec<Vec3> = corners[first..=last].to_vec();
        let rest: Vec<Vec3> = corners[last..].iter().chain(&corners[..=first]).copied().collect();
        let [whole, part, rest] = [&corners, &part, &rest].map(|corners| polygon(&line, corners).seen);
        let is_plain = [whole, part, rest].iter().all(|seen| matches!(seen, Seen::Inside | Seen::Outside));
        if is_plain {
            prop_assert_eq!(whole == Seen::Inside, (part == Seen::Inside) != (rest == Seen::Inside));
        }
    }

    /// The quadratic has opposite signs around each root, and its middle is between them.
    #[test]
    fn roots_of_spheres_are_where_the_quadratic_changes_its_sign((line, center, radius) in at_sphere()) {
        let meeting = sphere(&line, center, radius);
        let excess = |t: f64| {
            let square = |axis: usize| {
                let [o, d, c] = [line.origin[axis], line.direction[axis], f64::from(center[axis])].map(Exact::of);
                let off = o.plus(&Exact::of(t).times(&d)).minus(&c);
                off.times(&off)
            };
            let radius = Exact::of(f64::from(radius));
            square(0).plus(&square(1)).plus(&square(2)).minus(&radius.times(&radius)).sign().unwrap()
        };
        prop_assert_eq!(excess(0.0), match meeting.origin {
            Side::Inside => Ordering::Less,
            Side::On => Ordering::Equal,
            Side::Outside => Ordering::Greater,
        });
        match (meeting.limb, meeting.roots) {
            (Limb::Missed, roots) => prop_assert!(roots.is_none()),
            (Limb::Touched, Some([near, far])) => {
                prop_assert_eq!(near, far);
                prop_assert!(excess(near.low) != Ordering::Less && excess(near.high) != Ordering::Less);
            }
            (Limb::Crossed, Some([near, far])) => {
                prop_assert!(excess(near.low) != Ordering::Less && excess(far.high) != Ordering::Less);
                if near.high < far.low {
                    prop_assert!(excess(near.high) != Ordering::Greater && excess(far.low) != Ordering::Greater);
                }
            }
            _ => prop_assert!(false, "no roots of a sphere that is met"),
        }
    }

    /// a + b·√d in an order that f64 sees too, and the order of equal numbers written in two ways.
    #[test]
    fn numbers_with_roots_are_in_their_order(parts in [[-20..20_i8, -5..5, 0..9], [-20..20_i8, -5..5, 0..9]]) {
        let surd = |[a, b, d]: [i8; 3]| {
            let [a, b, d] = [a, b, d].map(|part| Exact::of(f64::from(part)));
            Surd::new(a, b, d)
        };
        let rough = |[a, b, d]: [i8; 3]| f64::from(a) + f64::from(b) * f64::from(d).sqrt();
        let [x, y] = parts.map(surd);
        let [rough_x, rough_y] = parts.map(rough);
        if (rough_x - rough_y).abs() > 1e-9 {
            prop_assert_eq!(Some(x.compare(&y)), rough_x.partial_cmp(&rough_y));
        }
        prop_assert_eq!(x.compare(&y), y.compare(&x).reverse());
        // √(4d) is 2√d.
        let [a, b, d] = parts[0];
        let [half, four] = [f64::from(b) / 2.0, 4.0 * f64::from(d)].map(Exact::of);
        prop_assert_eq!(x.compare(&Surd::new(Exact::of(f64::from(a)), half, four)), Ordering::Equal);
        let enclosure = x.enclosure();
        prop_assert!(x.compare_f64(enclosure.low) != Ordering::Less && x.compare_f64(enclosure.high) != Ordering::Greater);
        prop_assert!(enclosure.high == enclosure.low || enclosure.high == enclosure.low.next_up());
        prop_assert!((enclosure.middle() - rough_x).abs() <= 1e-9);
    }
}

/// A number with a root whose f64 has no digit right.
#[test]
fn what_cancels_is_enclosed_all_the_same() {
    // 2⁶⁰ − √(2¹²⁰ − 1) = 2⁻⁶¹·(1 + 2⁻¹²²…): just above the power of two.
    let [a, b, d] = [2.0_f64.powi(60), -1.0, 1.0].map(Exact::of);
    let d = a.times(&a).minus(&d);
    let enclosure = Surd::new(a, b, d).enclosure();
    assert_eq!((enclosure.low, enclosure.high), (2.0_f64.powi(-61), 2.0_f64.powi(-61).next_up()));
}

/// A polygon whose corners are not in a plane is met no nearer and no farther than they are.
#[test]
fn bent_polygons_are_met_between_their_corners() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.001], [0.0, 1.0, 0.0]].map(Vec3::from);
    let graze = Line::new([-1000.0, 0.5, 0.000_25], [1000.5, 0.0, -1e-7]);
    let t = polygon(&graze, &corners).t;
    // The corners lie at x = 0 and 1.
    let [least, most] = [1000.0 / 1000.5, 1001.0 / 1000.5];
    assert!(t.is_none_or(|t| least <= t.high && t.low <= most), "{t:?}");
    let head_on = polygon(&Line::new([0.25, 0.25, 1.0], [0.0, 0.0, -1.0]), &corners);
    assert_eq!(head_on.seen, Seen::Inside);
    let t = head_on.t.unwrap();
    assert!(0.999 <= t.low && t.high <= 1.0, "{t:?}");
}
