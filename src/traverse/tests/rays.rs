//! Rays that walk together and rays that do not, aimed at what scenes are made of.

use super::Random;
use super::brute_force::Query;
use super::scenes::grid_point;
use crate::kernel::tests::sight::Sight;
use crate::kernel::tests::single;
use crate::lanes::{Job, Single, Width};
use crate::prepare::{Hierarchy, Prepared};
use crate::traverse::{Counts, DEAD, Ends, NOTHING, RUN, Rays, Shuffled, Walker, Walkers};
use glam::DVec3;
use std::cell::RefCell;
use std::sync::LazyLock;

/// Rays that agree in the signs and the order of their directions' components: from one point, or side by side.
pub(super) fn coherent(random: &mut Random, count: usize) -> Vec<Query> {
    let eye = grid_point(random) * 2.0;
    let side_by_side = random.chance(0.3);
    let mut middle = grid_point(random) - eye;
    if random.chance(0.2) {
        // Along an axis, with zeros of either sign.
        let zero = if random.chance(0.5) { 0.0 } else { -0.0 };
        middle = [DVec3::X, DVec3::NEG_Y, DVec3::Z][random.below(3)]
            .map(|size| if size == 0.0 { zero } else { size });
    }
    let middle = if middle == DVec3::ZERO { DVec3::X } else { middle };
    let rays = (0..count).map(|_| {
        if side_by_side {
            let shift = [(); 3].map(|()| (random.below(9) as f64 - 4.0) / 4.0);
            return Query::new(Sight::new(eye + DVec3::from(shift), middle));
        }
        // A component that may be 0 stays so, and none changes its sign.
        let near =
            (1.0 + 0.2 * random.vector().x, 1.0 + 0.2 * random.vector().y, 1.0 + 0.2 * random.vector().z);
        Query::new(Sight::new(eye, middle * DVec3::from(near)))
    });
    let rays: Vec<Query> = rays.collect();
    let third = rays.first().map(|ray| ray.sight.third());
    let like_the_first = |ray: &Query| Some(ray.sight.third()) == third;
    let first = rays[0];
    rays.iter().map(|ray| if like_the_first(ray) { *ray } else { first }).collect()
}

/// Each from somewhere to somewhere.
pub(super) fn shuffled(random: &mut Random, count: usize) -> Vec<Query> {
    let rays = (0..count).map(|_| {
        let origin = grid_point(random) * if random.chance(0.5) { 1.0 } else { 2.0 };
        let mut direction = grid_point(random) - origin;
        if random.chance(0.3) {
            direction[random.below(3)] = if random.chance(0.5) { 0.0 } else { -0.0 };
        }
        let length = if random.chance(0.5) { 1.0 } else { random.between(-20.0, 20.0).exp2() };
        let direction = if direction == DVec3::ZERO { DVec3::NEG_Z } else { direction };
        Query::new(Sight::new(origin, direction * length))
    });
    rays.collect()
}

/// Lets hits count from somewhere on, for rays that start on no primitive.
pub(super) fn begin(random: &mut Random, rays: &mut [Query]) {
    for ray in rays {
        let length = ray.sight.d().length();
        ray.t_min = match random.below(3) {
            0 => 0.0,
            1 => single(random.between(0.0, 2.0) / length),
            _ => single(random.below(9) as f64 / 4.0 / length),
        };
    }
}

/// Lets rays end somewhere.
pub(super) fn end(random: &mut Random, rays: &mut [Query]) {
    for ray in rays {
        let length = ray.sight.d().length();
        ray.t_max = match random.below(4) {
            0 => f32::INFINITY,
            1 => single(random.between(0.0, 3.0) / length),
            2 => single(random.below(13) as f64 / 4.0 / length),
            _ => DEAD,
        };
    }
}

thread_local! {
    /// One for all walks of a test: what one leaves behind must not reach the next, whatever its scene and rays.
    static WALKER: RefCell<Walker> = RefCell::new(Walker::new());
    static SHUFFLED: RefCell<(Shuffled, Walkers)> = RefCell::default();
}

static THREADS: LazyLock<rayon::ThreadPool> =
    LazyLock::new(|| rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap());

/// What a walk leaves in the columns, and what it did.
pub(super) struct Walked {
    pub(super) t: Vec<f32>,
    pub(super) id: Vec<u32>,
    pub(super) counts: Counts,
}

/// A walk of rays at one width.
pub(super) struct Walk<'a> {
    pub(super) hierarchy: &'a Hierarchy,
    pub(super) rays: &'a [Query],
    pub(super) departing: bool,
    pub(super) any: bool,
    pub(super) by: By,
}

/// Who walks.
#[derive(Clone, Copy, Debug)]
pub(super) enum By {
    /// One walker, row by row.
    Rows,
    /// Three threads, each some cells of what rays in no order are sorted by.
    Cells,
}

/// What the id of a row that is no ray holds before.
pub(super) const FILLED: u32 = 12345;

impl Job for Walk<'_> {
    type Output = Walked;

    fn run<F: Single>(self) -> Walked {
        let count = self.rays.len();
        let filled = count.next_multiple_of(RUN);
        // Rows beyond the last ray repeat it, as the stages leave them.
        let row = |at: usize| self.rays[at.min(count - 1)];
        let column =
            |number: &dyn Fn(&Query) -> f32| (0..filled).map(|at| number(&row(at))).collect::<Vec<f32>>();
        let origin = [0, 1, 2].map(|axis| column(&|ray| ray.sight.origin[axis]));
        let direction = [0, 1, 2].map(|axis| column(&|ray| ray.sight.direction[axis]));
        let t_min = column(&|ray| ray.t_min);
        let departure: Vec<u32> = (0..filled).map(|at| row(at).departure).collect();
        let mut t: Vec<f32> = (0..filled).map(|at| if at < count { row(at).t_max } else { DEAD }).collect();
        let mut id = vec![FILLED; if self.any { 0 } else { filled }];
        id.iter_mut().take(count).for_each(|id| *id = NOTHING);
        let origin_low = [0, 1, 2].map(|axis| column(&|ray| ray.origin_low[axis]));
        let rays = Rays {
            origin_low: origin_low.each_ref().map(|column| if self.departing { &column[..] } else { &[] }),
            origin: origin.each_ref().map(Vec::as_slice),
            direction: direction.each_ref().map(Vec::as_slice),
            departure: if self.departing { &departure } else { &[] },
            t_min: if self.departing { &[] } else { &t_min },
            count,
        };
        let mut counts = Counts::default();
        let before = t.clone();
        let mut ends = Ends { t: &mut t, id: &mut id };
        match self.by {
            By::Rows => WALKER.with_borrow_mut(|walker| {
                if self.any {
                    walker.occluded::<F>(self.hierarchy, &rays, &mut ends, &mut counts);
                } else {
                    walker.closest::<F>(self.hierarchy, &rays, &mut ends, &mut counts);
                }
            }),
            By::Cells => SHUFFLED.with_borrow_mut(|(shuffled, walkers)| {
                ends.t.fill(f32::NAN);
                ends.id.iter_mut().take(count).for_each(|id| *id = FILLED);
                counts = THREADS.install(|| {
                    if self.any {
                        shuffled.trace::<F, true>(self.hierarchy, (&rays, &before), &mut ends, walkers)
                    } else {
                        shuffled.trace::<F, false>(self.hierarchy, (&rays, &before), &mut ends, walkers)
                    }
                });
            }),
        }
        Walked { t, id, counts }
    }
}

/// Holds both queries at every width to the loop over all primitives. Returns how many rays walked in packets and how many
/// of all found something.
pub(super) fn assert_same_as_all(prepared: &Prepared<'_>, rays: &[Query], departing: bool) -> (u64, usize) {
    let hierarchy = &prepared.hierarchy;
    let expected: Vec<(f32, u32)> = rays
        .iter()
        .map(|ray| if departing { ray.closest::<true>(hierarchy) } else { ray.closest::<false>(hierarchy) })
        .collect();
    let occluded: Vec<f32> = rays
        .iter()
        .map(|ray| if departing { ray.occluded::<true>(hierarchy) } else { ray.occluded::<false>(hierarchy) })
        .collect();
    let mut in_packets = 0;
    for (width, by) in Width::ALL.into_iter().flat_map(|width| [(width, By::Rows), (width, By::Cells)]) {
        let found = width.run(Walk { hierarchy, rays, departing, any: false, by });
        for (row, ray) in rays.iter().enumerate() {
            let (t, id) = (found.t[row], found.id[row]);
            let (expected_t, expected_id) = expected[row];
            assert!(
                (t.to_bits(), id) == (expected_t.to_bits(), expected_id),
                "{width:?}, by {by:?}, row {row} of {}: hit {id} at {t:e}, not {expected_id} at {expected_t:e}, by {ray:?}; {} in packets",
                rays.len(),
                found.counts.in_packets,
            );
        }
        assert!(found.t[rays.len()..].iter().all(|&t| t == DEAD), "a row that is no ray came to life");
        assert!(found.id[rays.len()..].iter().all(|&id| id == FILLED || id == NOTHING), "it hit something");
        in_packets += found.counts.in_packets;

        let found = width.run(Walk { hierarchy, rays, departing, any: true, by });
        for (row, ray) in rays.iter().enumerate() {
            let (t, expected) = (found.t[row], occluded[row]);
            assert!(
                t.to_bits() == expected.to_bits(),
                "{width:?}, by {by:?}, row {row} of {}: left at {t:e}, not {expected:e}, by {ray:?}",
                rays.len(),
            );
        }
        assert!(found.t[rays.len()..].iter().all(|&t| t == DEAD), "a row that is no ray came to life");
    }
    (in_packets, expected.iter().filter(|(_, id)| *id != NOTHING).count())
}
