//! Items in bins along the three axes, and the cheapest cut between bins.
//!
//! All three axes are swept at once, an axis a lane: what costs much in a fork of few items is to weigh the cuts.

use super::extent::Extent;
use super::group::{CHUNK, Group, Spread};
use super::reference::Reference;
use super::{Costs, Kind};
use glam::{Mat3A, Vec3A};
use rayon::prelude::*;
use std::ops::Range;

/// Equal slices of the box of the middles, along each axis.
pub(super) struct Places<const BINS: usize> {
    low: Vec3A,
    per_length: Vec3A,
}

impl<const BINS: usize> Places<BINS> {
    pub(super) fn new(middles: Extent) -> Self {
        Self { low: middles.low(), per_length: Vec3A::splat(BINS as f32) / middles.size() }
    }

    /// Place of a middle along an axis, in bins, of which the lowest is number `BINS`: for numbers from `BINS` to twice that, which
    /// have one exponent, the bin is the first bits of the mantissa.
    pub(super) fn along(&self, axis: usize) -> impl Fn(&Reference) -> f32 + use<BINS> {
        let (low, per_length) = (self.low[axis], self.per_length[axis]);
        move |reference| (reference.middle_along(axis) - low) * per_length + BINS as f32
    }

    /// The bin of each axis; 0 along an axis on which all middles are in one place, which makes NaN.
    #[inline(always)]
    fn bin(&self, reference: &Reference) -> [usize; 3] {
        const { assert!(BINS.is_power_of_two()) };
        let (first, beyond) = (BINS as f32, (2 * BINS) as f32);
        let place = (reference.middle() - self.low) * self.per_length + first;
        let place = Vec3A::select(place.cmpge(Vec3A::splat(first)), place, Vec3A::splat(first));
        let place = place.min(Vec3A::splat(beyond.next_down()));
        place.to_array().map(|place| (place.to_bits() >> (23 - BINS.ilog2())) as usize & (BINS - 1))
    }
}

/// What is in each bin of each axis.
#[derive(Clone)]
pub(super) struct Bins<const BINS: usize> {
    /// By axis and bin.
    boxes: [[Extent; BINS]; 3],
    /// By kind and bin; a lane an axis.
    weights: [[[f32; 4]; BINS]; Kind::COUNT],
}

/// A way to part bins in two along an axis.
pub(super) struct Cut {
    /// Sum over both sides of area times cost.
    pub(super) cost: f32,
    pub(super) axis: usize,
    /// What is before this bin goes left; 0 where no cut parts anything.
    pub(super) bin: usize,
}

/// Bins on one side of a cut, for each axis.
#[derive(Clone, Copy)]
struct Side {
    boxes: [Extent; 3],
    /// By kind; a lane an axis.
    weights: [Vec3A; Kind::COUNT],
}

impl<const BINS: usize> Bins<BINS> {
    #[inline(always)]
    pub(super) fn empty() -> Self {
        Self { boxes: [[Extent::EMPTY; BINS]; 3], weights: [[[0.0; 4]; BINS]; Kind::COUNT] }
    }

    /// Adds items, many in parallel.
    #[inline(always)]
    pub(super) fn fill(&mut self, places: &Places<BINS>, references: &[Reference], group: &Group) {
        let of_units = group.kind_of_units(references.len());
        if references.len() > CHUNK {
            self.fill_parallel(places, references, of_units);
        } else {
            self.fill_chunk(places, references, of_units);
        }
    }

    /// `of_units`: the kind of all items, if they are of one and weigh 1 each.
    #[inline(always)]
    fn fill_chunk(&mut self, places: &Places<BINS>, references: &[Reference], of_units: Option<usize>) {
        if let Some(kind) = of_units {
            self.fill_weighed(places, references, |_| (kind, 1.0));
        } else {
            let weigh = |item: &Reference| (item.kind() as usize, f32::from(item.weight()));
            self.fill_weighed(places, references, weigh);
        }
    }

    #[inline(always)]
    fn fill_weighed(
        &mut self,
        places: &Places<BINS>,
        references: &[Reference],
        weigh: impl Fn(&Reference) -> (usize, f32),
    ) {
        for reference in references {
            let one = reference.extent();
            let (kind, weight) = weigh(reference);
            for (axis, bin) in places.bin(reference).into_iter().enumerate() {
                self.boxes[axis][bin] = self.boxes[axis][bin].union(one);
                self.weights[kind][bin][axis] += weight;
            }
        }
    }

    #[inline(never)]
    fn fill_parallel(&mut self, places: &Places<BINS>, references: &[Reference], of_units: Option<usize>) {
        let chunks = references.par_chunks(CHUNK).map(|chunk| {
            let mut bins = Self::empty();
            bins.fill_chunk(places, chunk, of_units);
            bins
        });
        for part in chunks.collect::<Vec<Self>>() {
            self.join(&part);
        }
    }

    fn join(&mut self, others: &Self) {
        for (bin, other) in self.boxes.as_flattened_mut().iter_mut().zip(others.boxes.as_flattened()) {
            *bin = bin.union(*other);
        }
        let others = others.weights.as_flattened().as_flattened();
        for (weight, other) in self.weights.as_flattened_mut().as_flattened_mut().iter_mut().zip(others) {
            *weight += other;
        }
    }

    /// The cheapest cut; of equals the first axis, and there the first bin.
    pub(super) fn cheapest_cut(&self, spread: &Spread, scale: f32, costs: &Costs) -> Cut {
        let kinds = spread.group.kinds();
        // Of nothing it is infinity · 0, which is not a number and less than none.
        let cost = |side: &Side| side.half_areas(scale) * costs.of_lanes(&side.weights, kinds.clone());
        let mut right_costs = [Vec3A::INFINITY; BINS];
        let mut right = Side::EMPTY;
        for bin in (1..BINS).rev() {
            self.add_to(&mut right, bin, kinds.clone());
            right_costs[bin] = cost(&right);
        }
        let (mut least, mut bins) = (Vec3A::INFINITY, Vec3A::ZERO);
        let mut left = Side::EMPTY;
        for (bin, right_cost) in right_costs.iter().enumerate().skip(1) {
            self.add_to(&mut left, bin - 1, kinds.clone());
            let cost = cost(&left) + right_cost;
            let is_less = cost.cmplt(least);
            least = Vec3A::select(is_less, cost, least);
            bins = Vec3A::select(is_less, Vec3A::splat(bin as f32), bins);
        }
        let (least, bins) = (least.to_array(), bins.to_array());
        let mut cheapest = Cut { cost: f32::INFINITY, axis: 0, bin: 0 };
        for axis in 0..3 {
            if least[axis] < cheapest.cost {
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "few bins")]
                let bin = bins[axis] as usize;
                cheapest = Cut { cost: least[axis], axis, bin };
            }
        }
        cheapest
    }

    /// What is on the two sides of a cut. Every bin is looked at for both: how many there are on a side, nothing could foresee.
    #[inline(always)]
    pub(super) fn sides(&self, cut: &Cut, kinds: Range<usize>) -> [Group; 2] {
        let (mut left, mut right) = (Extent::EMPTY, Extent::EMPTY);
        let (mut to_left, mut to_right) = ([0.0; Kind::COUNT], [0.0; Kind::COUNT]);
        for bin in 0..BINS {
            let one = self.boxes[cut.axis][bin];
            let goes_left = bin < cut.bin;
            left = left.union(one.only_if(goes_left));
            right = right.union(one.only_if(!goes_left));
            for kind in kinds.clone() {
                let weight = self.weights[kind][bin][cut.axis];
                to_left[kind] += if goes_left { weight } else { 0.0 };
                to_right[kind] += if goes_left { 0.0 } else { weight };
            }
        }
        let group = |extent, weights: [f32; 3]| Group { extent, weights: weights.into() };
        [group(left, to_left), group(right, to_right)]
    }

    #[inline(always)]
    fn add_to(&self, side: &mut Side, bin: usize, kinds: Range<usize>) {
        for (all, one) in side.boxes.iter_mut().zip(&self.boxes) {
            *all = all.union(one[bin]);
        }
        for kind in kinds {
            let [x, y, z, _] = self.weights[kind][bin];
            side.weights[kind] += Vec3A::new(x, y, z);
        }
    }
}

impl Side {
    const EMPTY: Self = Self { boxes: [Extent::EMPTY; 3], weights: [Vec3A::ZERO; Kind::COUNT] };

    /// Halves of the surface areas, of lengths times `scale`; a lane an axis.
    #[inline(always)]
    fn half_areas(&self, scale: f32) -> Vec3A {
        let [x, y, z] = self.boxes.map(|one| one.size() * scale);
        let sizes = Mat3A::from_cols(x, y, z).transpose();
        let [x, y, z] = [sizes.x_axis, sizes.y_axis, sizes.z_axis];
        x * y + y * z + z * x
    }
}
