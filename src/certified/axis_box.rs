//! A ray and an axis-aligned box, in fractions alone: only tests of the slab test ask.

use super::number::Number;
use super::{Exact, Line};
use glam::Vec3;
use std::cmp::Ordering;

/// What a ray makes of a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoxMeeting {
    /// Some of the ray is strictly inside of the box; never of a flat one.
    Through,
    /// The ray and the box have no more than points of the box's boundary in common.
    Touched,
    /// They have nothing in common.
    Missed,
}

/// The ray 0 ≤ t ≤ `t_max` and a box between two corners, low ≤ high in every axis.
#[must_use]
pub fn axis_box(line: &Line, low: Vec3, high: Vec3, t_max: f64) -> BoxMeeting {
    let mut enter = Exact::of(0.0);
    let mut leave = t_max.is_finite().then(|| Exact::of(t_max));
    let mut is_through = true;
    for axis in 0..3 {
        let [low, high] = [low, high].map(|corner| Exact::of(f64::from(corner[axis])));
        let [origin, direction] = [line.origin, line.direction].map(|vector| Exact::of(vector[axis]));
        let [to_low, to_high] = [low, high].map(|plane| plane.minus(&origin));
        let (near, far) = match direction.sign() {
            Some(Ordering::Greater) => (to_low, to_high),
            Some(Ordering::Less) => (to_high, to_low),
            _ => match [to_low.sign(), to_high.sign()] {
                [Some(Ordering::Greater), _] | [_, Some(Ordering::Less)] => return BoxMeeting::Missed,
                [Some(Ordering::Less), Some(Ordering::Greater)] => continue,
                _ => {
                    is_through = false;
                    continue;
                }
            },
        };
        let [near, far] = [near, far].map(|plane| plane.over(&direction));
        if near.compare(&enter) == Ordering::Greater {
            enter = near;
        }
        if leave.as_ref().is_none_or(|leave| far.compare(leave) == Ordering::Less) {
            leave = Some(far);
        }
    }
    let room = leave.map_or(Ordering::Greater, |leave| leave.compare(&enter));
    match room {
        Ordering::Less => BoxMeeting::Missed,
        Ordering::Greater if is_through => BoxMeeting::Through,
        _ => BoxMeeting::Touched,
    }
}
