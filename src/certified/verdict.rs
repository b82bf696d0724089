//! An engine's answer, judged.

use super::rounding::View;
use super::{Closest, Judge, Line, Occlusion};
use crate::rays::Stretch;
use crate::scene::PrimitiveId;

/// How many roundings an engine whose only fault is rounding to f32 is off by at most, in units of u·L: six for the test of an edge or
/// a limb, √3 for the ray's direction, whose components round by u each. The origin's rounding, u·|o|, is part of the unit.
pub const BAND: f64 = 7.732_050_807_568_877;

/// What an engine says that a ray meets first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// The ray's parameter; means nothing on a miss.
    pub t: f64,
    /// The primitive; none on a miss.
    pub id: Option<PrimitiveId>,
}

/// What an answer is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// The primitive, or the miss, is the true one, or one of those that share a boundary there; t is within [`BAND`].
    Right,
    /// It would be if primitives were moved by no more than [`BAND`] roundings.
    WithinRounding,
    /// Rounding does not explain it.
    Wrong,
}

/// An answer, judged. Roundings are in units of u·L, u = 2⁻²⁴, L the primitive's farthest point from the ray's origin, with the
/// origin's own rounding in it: u·(L + |o|/[`BAND`]).
#[derive(Clone, Debug, PartialEq)]
pub struct Judgement {
    /// In a word.
    pub verdict: Verdict,
    /// The least number of roundings by which primitives would have to be moved for the decision, which primitive or none, to be right;
    /// 0 where it is, infinite where no move explains it.
    pub decision: f64,
    /// The same for t, given the primitive: |t − t*|·|d|·cos θ / (u·L) of a face, and of a sphere away from its limb. Of a triangle, L
    /// is more by s²/h, s the longest edge and h the height above it, since rounding tilts a needle. None on a miss.
    pub t: Option<f64>,
    /// How far the ray passes inside of the primitive's outline or limb, in roundings; below 0 outside. None on a miss.
    pub inside_by: Option<f64>,
}

impl Judge {
    /// What to think of a hit or a miss.
    #[must_use]
    pub fn judge_closest(&self, stretch: &Stretch, answer: Answer) -> Judgement {
        self.judge(stretch, answer, &self.closest(stretch))
    }

    /// The same, where it is known what the ray may meet first.
    #[must_use]
    pub fn judge(&self, stretch: &Stretch, answer: Answer, truth: &Closest) -> Judgement {
        let decision = if truth.admits(answer.id) {
            0.0
        } else {
            let sights = self.sights(stretch, |_| true);
            least_roundings(|roundings| sights.admit(stretch, answer.id, roundings)).max(LEAST_ROUNDINGS)
        };
        let own = answer.id.and_then(|id| self.view(stretch, id));
        let t = own.as_ref().map(|own| {
            least_roundings(|roundings| {
                let (sides, is_sure) = own.sides(roundings);
                let [near, far] = sides.map(|side| side.filter(|[_, to]| *to > stretch.t_min));
                let far = far.filter(|_| !near.is_some_and(|[from, _]| is_sure && from > stretch.t_min));
                [near, far].into_iter().flatten().any(|[from, to]| from <= answer.t && answer.t <= to)
            })
        });
        let verdict = match (decision, t.unwrap_or(0.0)) {
            (decision, t) if !(decision <= BAND && t <= BAND) => Verdict::Wrong,
            (0.0, _) => Verdict::Right,
            _ => Verdict::WithinRounding,
        };
        Judgement { verdict, decision, t, inside_by: own.map(|own| own.inside_by()) }
    }

    /// What to think of a shadow ray that was found occluded, or not.
    #[must_use]
    pub fn judge_occluded(&self, stretch: &Stretch, occluded: bool) -> Judgement {
        let truth = self.occluded(stretch);
        let is_right = match truth {
            Occlusion::Boundary => true,
            Occlusion::Occluded => occluded,
            Occlusion::Free => !occluded,
        };
        let decision = if is_right {
            0.0
        } else {
            let sights = self.sights(stretch, |primitive| primitive.casts_shadow);
            let least = least_roundings(|roundings| {
                if occluded {
                    sights.may_occlude(stretch, roundings)
                } else {
                    sights.may_let_pass(stretch, roundings)
                }
            });
            least.max(LEAST_ROUNDINGS)
        };
        let verdict = match decision {
            0.0 => Verdict::Right,
            decision if decision <= BAND => Verdict::WithinRounding,
            _ => Verdict::Wrong,
        };
        Judgement { verdict, decision, t: None, inside_by: None }
    }

    fn view(&self, stretch: &Stretch, id: PrimitiveId) -> Option<View> {
        let departure = stretch.departure.filter(|departure| departure.from == id);
        Some(View::new(&line(stretch), &self.primitive(id)?.shape, departure))
    }

    fn sights(&self, stretch: &Stretch, which: impl Fn(&super::scene::Primitive) -> bool) -> Sights {
        let chosen = self.primitives.iter().filter(|primitive| which(primitive));
        Sights(
            chosen.filter_map(|primitive| Some((primitive.id, self.view(stretch, primitive.id)?))).collect(),
        )
    }
}

fn line(stretch: &Stretch) -> Line {
    Line { origin: stretch.origin, direction: stretch.direction }
}

/// All that a ray may meet.
struct Sights(Vec<(PrimitiveId, View)>);

impl Sights {
    /// Whether an answer is right for some scene whose primitives are moved by no more than so many roundings each.
    fn admit(&self, stretch: &Stretch, id: Option<PrimitiveId>, roundings: f64) -> bool {
        // The least t up to which something else is met whatever the move; of a sphere, its far side if the near may be behind.
        let mut end = f64::INFINITY;
        let mut begin = None;
        for (other, view) in &self.0 {
            let (sides, is_sure) = view.sides(roundings);
            if id == Some(*other) {
                let reached = sides
                    .into_iter()
                    .flatten()
                    .find(|[from, to]| *to > stretch.t_min && *from < stretch.t_max);
                begin = reached.map(|[from, _]| from);
            } else if is_sure {
                let first = sides.into_iter().flatten().find(|[from, _]| *from > stretch.t_min);
                end = end.min(first.map_or(f64::INFINITY, |[_, to]| to));
            }
        }
        match (id, begin) {
            (None, _) => end >= stretch.t_max,
            (Some(_), Some(begin)) => begin <= end,
            (Some(_), None) => false,
        }
    }

    fn may_occlude(&self, stretch: &Stretch, roundings: f64) -> bool {
        self.0.iter().any(|(_, view)| {
            let (sides, _) = view.sides(roundings);
            sides.into_iter().flatten().any(|[from, to]| to > stretch.t_min && from < stretch.t_max)
        })
    }

    fn may_let_pass(&self, stretch: &Stretch, roundings: f64) -> bool {
        !self.0.iter().any(|(_, view)| {
            let (sides, is_sure) = view.sides(roundings);
            // The end is rounded as the primitive is.
            let is_within =
                |[from, to]: [f64; 2]| from > stretch.t_min && to + (to - from) / 2.0 < stretch.t_max;
            is_sure && sides.into_iter().flatten().any(is_within)
        })
    }
}

/// What takes less is not told apart. What is moved is f64, so an answer that exact arithmetic finds wrong may need no move there; it
/// needs this much.
const LEAST_ROUNDINGS: f64 = 1.0 / (1 << 20) as f64;

/// The least number of roundings for which something holds that holds for all larger ones too, to a 1000th of itself; infinite beyond 2⁵⁰.
fn least_roundings(holds: impl Fn(f64) -> bool) -> f64 {
    if holds(0.0) {
        return 0.0;
    }
    let mut high = LEAST_ROUNDINGS;
    while !holds(high) {
        high *= 2.0;
        if high > (1_u64 << 50) as f64 {
            return f64::INFINITY;
        }
    }
    let mut low = if high == LEAST_ROUNDINGS { 0.0 } else { high / 2.0 };
    for _ in 0..10 {
        let middle = low + (high - low) / 2.0;
        *(if holds(middle) { &mut high } else { &mut low }) = middle;
    }
    high
}
