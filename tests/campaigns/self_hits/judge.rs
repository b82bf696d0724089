//! What an engine found for the secondary rays of a frame, held against what geometry says of each.

use super::bodies::Body;
use super::table::{Counts, Row, Table};
use super::verdicts::Verdict;
use wavelane::rays::{RayKind, RaySet, Stretch};
use wavelane::scene::PrimitiveId;
use wavelane::trace::{Hits, Query};

/// What was found for a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Answer {
    Nothing,
    /// Something, whatever it is.
    Something,
    Primitive(PrimitiveId),
}

impl Answer {
    pub(super) fn of(query: Query, hits: &Hits, row: usize) -> Self {
        match query {
            _ if !hits.t[row].is_finite() => Self::Nothing,
            Query::Any => Self::Something,
            Query::Closest => Self::Primitive(PrimitiveId(hits.id[row])),
        }
    }
}

/// Judges all rays of a kind.
pub(super) fn judge(
    table: &mut Table,
    (setting, bodies): (&'static str, &[Body]),
    (kind, rays): (RayKind, &RaySet),
    answer: impl Fn(usize) -> Answer,
    name: impl Fn() -> String,
) {
    for row in 0..rays.len() {
        let ray = rays.stretch(row).expect("what an engine traces is a ray");
        let answer = answer(row);
        let judged = judged(bodies, &ray, answer);
        if judged.self_hits + judged.missed > 0 {
            table.note(|| {
                format!("{}, {}: {answer:?}, {:?}, {ray:?}", name(), kind.name(), verdicts(bodies, &ray))
            });
        }
        let inward = ray.departure.expect("secondary rays start on a primitive").inward;
        *table.row(Row { setting, kind, inward }) += judged;
    }
}

fn verdicts(bodies: &[Body], ray: &Stretch) -> Vec<Verdict> {
    bodies.iter().map(|body| body.verdict(ray)).collect()
}

/// The counts of one ray.
fn judged(bodies: &[Body], ray: &Stretch, answer: Answer) -> Counts {
    let mut all_never = true;
    let mut some_meets = false;
    let mut is_impossible = false;
    for body in bodies {
        let verdict = body.verdict(ray);
        all_never &= verdict == Verdict::Never;
        some_meets |= matches!(verdict, Verdict::Meets(_));
        if let Answer::Primitive(id) = answer {
            is_impossible |= body.holds(id) && (verdict == Verdict::Never || !body.allows(ray, id));
        }
    }
    is_impossible |= all_never && answer != Answer::Nothing;
    Counts {
        rays: 1,
        free: u64::from(all_never),
        self_hits: u64::from(is_impossible),
        bound: u64::from(some_meets),
        missed: u64::from(some_meets && answer == Answer::Nothing),
    }
}
