//! Where to part a group of items: the binned surface area heuristic of Wald, "On Fast Construction of SAH-based Bounding
//! Volume Hierarchies", 2007, along the three axes and also by kind.

use super::binary::Reference;
use super::group::{Group, Spread, in_chunks};
use super::{Costs, Kind};
use glam::{UVec3, Vec3A};

const BINS: usize = 16;
/// Kinds are bins of one more axis.
const AXES: usize = 4;
const BY_KIND: usize = 3;

/// Reorders two or more items into two groups that are not empty, the cheapest that the bins tell apart, and returns the
/// size of the first.
pub(super) fn part(references: &mut [Reference], spread: &Spread, costs: &Costs) -> usize {
    if references.len() == 2 {
        return 1;
    }
    let bins = Bins::new(references.len(), spread);
    let Some(cut) = cheapest(references, &bins, spread, costs) else {
        return halve(references, spread);
    };
    if cut.axis == BY_KIND {
        partition(references, |reference| (reference.kind as u32) < cut.bin)
    } else {
        partition(references, |reference| bins.of(reference)[cut.axis] < cut.bin)
    }
}

/// Likewise, into two of the same size, or of sizes that differ by 1.
pub(super) fn halve(references: &mut [Reference], spread: &Spread) -> usize {
    let half = references.len() / 2;
    let extent = spread.high - spread.low;
    if extent.max_element() > 0.0 {
        let axis = extent.max_position();
        let along = |reference: &Reference| reference.middle()[axis];
        references.select_nth_unstable_by(half, |one, other| along(one).total_cmp(&along(other)));
    }
    half
}

/// Moves the items that `goes_left` to the front, and returns how many. Swaps them all: to guess which way each goes takes
/// longer.
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
struct Bins {
    count: usize,
    low: Vec3A,
    per_length: Vec3A,
}

impl Bins {
    /// Few items do not need many bins.
    fn new(items: usize, spread: &Spread) -> Self {
        let count = items.clamp(4, BINS);
        Self { count, low: spread.low, per_length: Vec3A::splat(count as f32) / (spread.high - spread.low) }
    }

    /// The conversion saturates, and takes the 0 · ∞ of an axis without extent to 0.
    fn of(&self, reference: &Reference) -> UVec3 {
        let position = (reference.middle() - self.low) * self.per_length;
        position.as_uvec3().min(UVec3::splat(self.count as u32 - 1))
    }
}

/// What is in bins before `bin` goes left.
#[derive(Clone, Copy)]
struct Cut {
    axis: usize,
    bin: u32,
}

fn cheapest(references: &[Reference], bins: &Bins, spread: &Spread, costs: &Costs) -> Option<Cut> {
    let is_mixed = !spread.group.is_of_one_kind();
    let fill = |references: &[Reference]| {
        let mut groups = [[Group::EMPTY; BINS]; AXES];
        for reference in references {
            let bin = bins.of(reference);
            for axis in 0..3 {
                groups[axis][bin[axis] as usize].add(reference);
            }
            if is_mixed {
                groups[BY_KIND][reference.kind as usize].add(reference);
            }
        }
        groups
    };
    let groups = in_chunks(references, fill, |mut all, more| {
        for (group, more) in all.as_flattened_mut().iter_mut().zip(more.as_flattened()) {
            *group = group.union(*more);
        }
        all
    });
    let counts = [bins.count, bins.count, bins.count, if is_mixed { Kind::COUNT } else { 0 }];
    // The largest extent becomes 1, so that no area overflows.
    let scale = (spread.group.high - spread.group.low).max_element().recip().min(f32::MAX);
    let cost = |group: &Group| group.half_area(scale) * costs.of_weights(group.weights);
    let mut cheapest = (f32::INFINITY, None);
    for (axis, (groups, count)) in groups.iter().zip(counts).enumerate() {
        let (least, bin) = cheapest_along(&groups[..count], &cost);
        if least < cheapest.0 {
            cheapest = (least, Some(Cut { axis, bin }));
        }
    }
    cheapest.1
}

/// The least sum of the costs of both sides, and the first bin of the right one; infinite where all are in one bin.
fn cheapest_along(groups: &[Group], cost: &impl Fn(&Group) -> f32) -> (f32, u32) {
    let cost = |group: &Group| if group.is_empty() { f32::INFINITY } else { cost(group) };
    let mut right_costs = [f32::INFINITY; BINS];
    let mut right = Group::EMPTY;
    for (group, right_cost) in groups.iter().zip(&mut right_costs).rev() {
        right = right.union(*group);
        *right_cost = cost(&right);
    }
    let mut cheapest = (f32::INFINITY, 0);
    let mut left = Group::EMPTY;
    for ((group, right_cost), bin) in groups.iter().zip(&right_costs[1..]).zip(1..) {
        left = left.union(*group);
        let sum = cost(&left) + right_cost;
        if sum < cheapest.0 {
            cheapest = (sum, bin);
        }
    }
    cheapest
}
