//! Where to part a group of items: the binned surface area heuristic of Wald, "On Fast Construction of SAH-based Bounding
//! Volume Hierarchies", 2007, along the three axes and also by kind.

use super::bins::{Bins, Places};
use super::extent::Extent;
use super::group::{Group, Spread};
use super::reference::Reference;
use super::{Costs, Kind};

/// A group parted in two: how many items the first half has, and what is known of both.
pub(super) struct Halves {
    pub(super) middle: usize,
    pub(super) left: Spread,
    pub(super) right: Spread,
}

impl Halves {
    fn at(middle: usize, references: &[Reference]) -> Self {
        let (left, right) = references.split_at(middle);
        Self { middle, left: Spread::of(left), right: Spread::of(right) }
    }
}

/// Reorders two or more items into two groups that are not empty, the cheapest pair that the bins tell apart. Few items do
/// not need many bins.
pub(super) fn part(references: &mut [Reference], spread: &Spread, costs: &Costs) -> Halves {
    match references.len() {
        2 => Halves::at(1, references),
        3..=6 => part_by_bins::<4>(references, spread, costs),
        7..=24 => part_by_bins::<8>(references, spread, costs),
        _ => part_by_bins::<16>(references, spread, costs),
    }
}

/// Likewise, into two of the same size, or of sizes that differ by 1.
pub(super) fn halve(references: &mut [Reference], spread: &Spread) -> Halves {
    let half = references.len() / 2;
    let size = spread.middles.size();
    if size.max_element() > 0.0 {
        let axis = size.max_position();
        let along = |reference: &Reference| reference.middle_along(axis);
        references.select_nth_unstable_by(half, |one, other| along(one).total_cmp(&along(other)));
    }
    Halves::at(half, references)
}

fn part_by_bins<const BINS: usize>(references: &mut [Reference], spread: &Spread, costs: &Costs) -> Halves {
    let places = Places::<BINS>::new(spread.middles);
    let mut bins = Bins::empty();
    bins.fill(&places, references, &spread.group);
    // The largest extent becomes 1, so that no area overflows.
    let scale = spread.group.extent.size().max_element().recip().min(f32::MAX);
    let cut = bins.cheapest_cut(spread, scale, costs);
    if !spread.group.is_of_one_kind() {
        let (cost, kind) = cheapest_kinds(&of_kinds(references), scale, costs);
        if cost < cut.cost {
            let goes_left = |reference: &Reference| (reference.kind() as usize) < kind;
            let (middle, ..) = partition(references, goes_left);
            return Halves::at(middle, references);
        }
    }
    if cut.bin == 0 {
        return halve(references, spread);
    }
    let (place, start) = (places.along(cut.axis), (BINS + cut.bin) as f32);
    let (middle, left, right) = partition(references, |reference| {
        // Where the middles are so close together that a place is not a number, its bin is the first.
        let goes_right = place(reference) >= start;
        !goes_right
    });
    let [left_group, right_group] = bins.sides(&cut, spread.group.kinds());
    Halves {
        middle,
        left: Spread { group: left_group, middles: left },
        right: Spread { group: right_group, middles: right },
    }
}

/// Moves the items that `goes_left` to the front, and returns how many, and the boxes of the middles on both sides. Every item
/// is swapped, with itself or with one that goes right: that is sooner done than guessing which way each goes.
fn partition(
    references: &mut [Reference],
    goes_left: impl Fn(&Reference) -> bool,
) -> (usize, Extent, Extent) {
    let mut left = 0;
    let (mut left_middles, mut right_middles) = (Extent::EMPTY, Extent::EMPTY);
    for index in 0..references.len() {
        let reference = references[index];
        let moves = goes_left(&reference);
        let middle = Extent::of_point(reference.middle());
        left_middles = left_middles.union(middle.only_if(moves));
        right_middles = right_middles.union(middle.only_if(!moves));
        references[index] = references[left];
        references[left] = reference;
        left += usize::from(moves);
    }
    (left, left_middles, right_middles)
}

fn of_kinds(references: &[Reference]) -> [Group; Kind::COUNT] {
    let mut kinds = [Group::EMPTY; Kind::COUNT];
    for reference in references {
        let kind = &mut kinds[reference.kind() as usize];
        *kind = kind.union(Group::of(reference));
    }
    kinds
}

/// The cost of the cheapest way to part kinds in two, and the first kind that goes right.
fn cheapest_kinds(kinds: &[Group; Kind::COUNT], scale: f32, costs: &Costs) -> (f32, usize) {
    let cost = |kinds: &[Group]| {
        let group = kinds.iter().fold(Group::EMPTY, |all, kind| all.union(*kind));
        if group.is_empty() {
            f32::INFINITY
        } else {
            group.half_area(scale) * costs.of_weights(group.weights)
        }
    };
    let mut cheapest = (f32::INFINITY, 0);
    for kind in 1..Kind::COUNT {
        let cost = cost(&kinds[..kind]) + cost(&kinds[kind..]);
        if cost < cheapest.0 {
            cheapest = (cost, kind);
        }
    }
    cheapest
}
