//! Where to part a group of items: the binned surface area heuristic of Wald, "On Fast Construction of SAH-based Bounding
//! Volume Hierarchies", 2007, along the three axes and also by kind.

use super::binary::Reference;
use super::group::{Group, Spread, in_chunks};
use super::{Costs, Kind};
use glam::{IVec3, Vec3A};

/// Reorders two or more items into two groups that are not empty, the cheapest pair that the bins tell apart, and returns
/// the size of the first. Few items do not need many bins.
pub(super) fn part(references: &mut [Reference], spread: &Spread, costs: &Costs) -> usize {
    match references.len() {
        2 => 1,
        3..=6 => part_by_bins::<4>(references, spread, costs),
        7..=24 => part_by_bins::<8>(references, spread, costs),
        _ => part_by_bins::<16>(references, spread, costs),
    }
}

/// Likewise, into two of the same size, or of sizes that differ by 1.
pub(super) fn halve(references: &mut [Reference], spread: &Spread) -> usize {
    let half = references.len() / 2;
    let extent = spread.high - spread.low;
    if extent.max_element() > 0.0 {
        let axis = extent.max_position();
        let along = |reference: &Reference| Group::of(reference).middle()[axis];
        references.select_nth_unstable_by(half, |one, other| along(one).total_cmp(&along(other)));
    }
    half
}

fn part_by_bins<const BINS: usize>(references: &mut [Reference], spread: &Spread, costs: &Costs) -> usize {
    let places = Places::<BINS>::new(spread);
    // The largest extent becomes 1, so that no area overflows.
    let scale = (spread.group.high - spread.group.low).max_element().recip().min(f32::MAX);
    let cost = |group: &Group| group.half_area(scale) * costs.of_weights(group.weights);
    let mut cheapest = Cut::NONE;
    let mut cheapest_axis = 0;
    for (axis, bins) in places.fill(references).iter().enumerate() {
        let cut = Cut::cheapest(bins, cost);
        if cut.cost < cheapest.cost {
            (cheapest, cheapest_axis) = (cut, axis);
        }
    }
    if !spread.group.is_of_one_kind() {
        let cut = Cut::cheapest(&of_kinds(references), cost);
        if cut.cost < cheapest.cost {
            return partition(references, |reference| (reference.kind as usize) < cut.bin);
        }
    }
    if cheapest.bin == 0 {
        return halve(references, spread);
    }
    // Nothing is at or beyond NaN: only the axis of the cut decides.
    let mut start = Vec3A::NAN;
    start[cheapest_axis] = cheapest.bin as f32;
    partition(references, |reference| !places.of(&Group::of(reference)).cmpge(start).any())
}

/// Moves the items that `goes_left` to the front, and returns how many. Every item is swapped, with itself or with one
/// that goes right: that is sooner done than guessing which way each goes.
fn partition(references: &mut [Reference], goes_left: impl Fn(&Reference) -> bool) -> usize {
    let mut left = 0;
    for index in 0..references.len() {
        let moves = goes_left(&references[index]);
        references.swap(left, index);
        left += usize::from(moves);
    }
    left
}

/// Equal slices of the box of the middles, along each axis.
struct Places<const BINS: usize> {
    low: Vec3A,
    per_length: Vec3A,
}

impl<const BINS: usize> Places<BINS> {
    fn new(spread: &Spread) -> Self {
        Self { low: spread.low, per_length: Vec3A::splat(BINS as f32) / (spread.high - spread.low) }
    }

    /// Place of the middle, in bins from the lowest one; NaN along an axis on which there is one place only.
    fn of(&self, group: &Group) -> Vec3A {
        (group.middle() - self.low) * self.per_length
    }

    /// The bin of each axis. The conversion saturates and takes NaN to 0.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "few bins, counted from 0")]
    fn bin(&self, group: &Group) -> [usize; 3] {
        let bin = self.of(group).as_ivec3().min(IVec3::splat(BINS as i32 - 1));
        [bin.x as usize, bin.y as usize, bin.z as usize]
    }

    /// What is in each bin of each axis.
    fn fill(&self, references: &[Reference]) -> [[Group; BINS]; 3] {
        let add = |axes: &mut [[Group; BINS]; 3], references: &[Reference]| {
            for group in references.iter().map(Group::of) {
                for (bins, bin) in axes.iter_mut().zip(self.bin(&group)) {
                    bins[bin] = bins[bin].union(group);
                }
            }
        };
        let join = |axes: &mut [[Group; BINS]; 3], others: &[[Group; BINS]; 3]| {
            for (bin, other) in axes.as_flattened_mut().iter_mut().zip(others.as_flattened()) {
                *bin = bin.union(*other);
            }
        };
        in_chunks(references, &[[Group::EMPTY; BINS]; 3], add, join)
    }
}

fn of_kinds(references: &[Reference]) -> [Group; Kind::COUNT] {
    let mut kinds = [Group::EMPTY; Kind::COUNT];
    for reference in references {
        let kind = &mut kinds[reference.kind as usize];
        *kind = kind.union(Group::of(reference));
    }
    kinds
}

/// A way to part bins in two.
struct Cut {
    /// Sum over both sides of area times cost.
    cost: f32,
    /// What is before this bin goes left.
    bin: usize,
}

impl Cut {
    const NONE: Self = Self { cost: f32::INFINITY, bin: 0 };

    /// [`Cut::NONE`] where all is in one bin.
    fn cheapest<const BINS: usize>(bins: &[Group; BINS], cost: impl Fn(&Group) -> f32) -> Self {
        let mut right_costs = [f32::INFINITY; BINS];
        let mut right = Group::EMPTY;
        for bin in (1..BINS).rev() {
            right = right.union(bins[bin]);
            if !right.is_empty() {
                right_costs[bin] = cost(&right);
            }
        }
        let mut cheapest = Self::NONE;
        let mut left = Group::EMPTY;
        for bin in 1..BINS {
            left = left.union(bins[bin - 1]);
            if !left.is_empty() {
                let cost = cost(&left) + right_costs[bin];
                if cost < cheapest.cost {
                    cheapest = Self { cost, bin };
                }
            }
        }
        cheapest
    }
}
