//! The rays of a packet against what is in a leaf.

use super::super::candidate::Candidate;
use super::super::exact::{self, Nearest, Spot};
use super::super::leaf::{self, RayLanes, RayLines};
use super::super::sight::{SeenBounds, Sight};
use super::super::{Counts, DEAD};
use super::picked::{self, Rows};
use super::{Columns, PACKET, Packet};
use crate::kernel::RaySpace;
use crate::kernel::sphere::Line;
use crate::lanes::{Lanes, Mask, Single};
use crate::prepare::bvh::Node;
use crate::prepare::{BLOCK, Hierarchy, Place, TriangleBlock, count_there};

impl Packet {
    /// Tests what is in a leaf, against every group from the given one on whose rays meet its box.
    #[inline(always)]
    pub(super) fn visit_leaf<F: Single, const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        leaf: Place,
        (node, slot): (&Node, u8),
        (first_group, bits): (u8, u32),
        counts: &mut Counts,
    ) {
        let in_sight = match (leaf, &self.sight) {
            (Place::Triangles(index), Some(sight)) if !DEPARTING => {
                self.in_sight::<F>(sight, &hierarchy.triangles[index])
            }
            _ => !0,
        };
        if in_sight == 0 {
            return;
        }
        if let (true, Place::Triangles(index)) = (ANY, leaf) {
            let rows = self.entering::<F>((node, slot), (first_group, bits), counts);
            self.visit_rows::<F, DEPARTING>(hierarchy, (index, in_sight), rows, counts);
            return;
        }
        let leaf = (leaf, in_sight);
        let mut group = first_group;
        let mut mask = F::of_bits(bits);
        loop {
            let row = group as usize * F::WIDTH;
            self.visit_group::<F, DEPARTING, ANY>(hierarchy, leaf, (row, mask), counts);
            group += 1;
            if group as usize * F::WIDTH >= PACKET {
                return;
            }
            mask = self.group_enters::<F>(node, slot, group, counts);
        }
    }

    /// Tests the triangles of a leaf, those that are in sight, against the shadow rays of some rows: in tiles if that is less
    /// work. Closest hits are so many that to give them back to rows one by one cost more than it saved: primary rays of the
    /// bunny at 0.92 of the speed, of tetrahedra at 1.07, 2026-11.
    #[inline(always)]
    fn visit_rows<F: Single, const DEPARTING: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        (index, in_sight): (usize, u32),
        rows: Rows,
        counts: &mut Counts,
    ) {
        let triangles = count_there(&hierarchy.triangles[index].ids).min(in_sight.count_ones() as usize);
        if picked::pays::<F>(rows, triangles) {
            self.visit_picked::<F, DEPARTING>(hierarchy, index, rows, counts);
            return;
        }
        let leaf = (Place::Triangles(index), in_sight);
        for row in (0..PACKET).step_by(F::WIDTH) {
            let mask = F::of_bits(picked::of_group::<F>(rows, row));
            self.visit_group::<F, DEPARTING, true>(hierarchy, leaf, (row, mask), counts);
        }
    }

    /// Tests what is in a leaf against the rays of a group that a mask says, if any.
    #[inline(always)]
    fn visit_group<F: Single, const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        leaf: (Place, u32),
        (row, mask): (usize, F::Mask),
        counts: &mut Counts,
    ) {
        let bits = mask.bits();
        if bits == 0 {
            return;
        }
        let used = bits.count_ones() as usize;
        let upper = bits.trailing_zeros() as usize / F::Node::WIDTH;
        let is_in_half = bits >> (upper * F::Node::WIDTH) >> F::Node::WIDTH == 0;
        match F::halves(mask) {
            // Rays of a packet lie in an order, so those that meet a leaf often lie side by side.
            Some(halves) if is_in_half => {
                let mut rays = Group { packet: self, row: row + upper * F::Node::WIDTH };
                let mask = (halves[upper], used);
                leaf::visit::<F::Node, _, DEPARTING, ANY>(hierarchy, leaf, &mut rays, mask, counts);
            }
            _ => {
                let mut rays = Group { packet: self, row };
                leaf::visit::<F, _, DEPARTING, ANY>(hierarchy, leaf, &mut rays, (mask, used), counts);
            }
        }
    }

    /// The rows whose rays meet the box of a child, of which no group before the given one has any.
    #[inline(always)]
    fn entering<F: Single>(
        &self,
        (node, slot): (&Node, u8),
        (first_group, bits): (u8, u32),
        counts: &mut Counts,
    ) -> Rows {
        let mut rows = Rows::from(bits) << (first_group as usize * F::WIDTH);
        #[expect(clippy::cast_possible_truncation, reason = "at most 64 groups")]
        for group in first_group + 1..(PACKET / F::WIDTH) as u8 {
            let bits = self.group_enters::<F>(node, slot, group, counts).bits();
            rows |= Rows::from(bits) << (group as usize * F::WIDTH);
        }
        rows
    }

    /// The triangles of a block that some ray may meet, a bit each: all but those with all corners on one side of all feet, or
    /// behind the start.
    ///
    /// That is what each ray's own test would find. Its areas have the right sign or are 0 for the corners as it sees them, and
    /// then each edge that it crosses is on the same side, so it crosses none or two. (That needs products of coordinates that
    /// do not vanish; these are above 2⁻⁸⁹ unless corners and starts agree in more digits than f32 has at the scene's size.)
    #[inline(always)]
    fn in_sight<F: Single>(&self, sight: &Sight, block: &TriangleBlock) -> u32 {
        (0..BLOCK)
            .step_by(F::Block::WIDTH)
            .fold(0, |bits, lane| bits | self.lanes_in_sight::<F::Block>(sight, block, lane) << lane)
    }

    #[inline(always)]
    fn lanes_in_sight<L: Single>(&self, sight: &Sight, block: &TriangleBlock, lane: usize) -> u32 {
        let zero = L::splat(0.0);
        let all = L::first(L::WIDTH);
        let (mut left, mut right, mut above, mut below, mut behind) = (all, all, all, all, all);
        for corner in &block.vertices {
            let SeenBounds { x, y, z } = sight.see(self.axes.map(|axis| L::load(&corner[axis][lane..])));
            left = left & x[1].lt(zero);
            right = right & x[0].gt(zero);
            below = below & y[1].lt(zero);
            // A corner level with a foot counts as above it.
            above = above & y[0].ge(zero);
            let is_behind = if self.backwards[self.axes[2]] { z[0].gt(zero) } else { z[1].lt(zero) };
            behind = behind & is_behind;
        }
        !(left | right | above | below | behind).bits() & ((1 << L::WIDTH) - 1)
    }

    /// Takes hits in where they are nearer than what was found so far or, if ANY, before the end. See [`exact`] for those
    /// lanes in which f32 cannot tell.
    #[inline(always)]
    fn offer<F: Single, const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        row: usize,
        candidate: &Candidate<F>,
        mask: F::Mask,
        (spot, id): (Spot, u32),
    ) {
        let Candidate { t, error, hit, unclear } = *candidate;
        let mut unclear = (unclear & mask).bits();
        while unclear != 0 {
            let row = row + unclear.trailing_zeros() as usize;
            unclear &= unclear - 1;
            self.offer_exact::<DEPARTING, ANY>(hierarchy, row, spot);
        }
        let hit = hit & mask;
        if !hit.any() {
            return;
        }
        let nearest = F::load(&self.t[row..]);
        let (closer, unclear);
        if ANY {
            closer = hit & (t + error).lt(nearest);
            unclear = hit & !closer & !(t - error).ge(nearest);
        } else {
            let (nearest_error, end) = (F::load(&self.error[row..]), F::load(&self.end[row..]));
            closer = hit & (t + error).lt(nearest - nearest_error);
            unclear = hit & !closer & !(t - error).gt(end);
        }
        let mut bits = unclear.bits();
        if bits != 0 {
            let (mut ts, mut errors) = ([0.0; 16], [0.0; 16]);
            t.store(&mut ts);
            error.store(&mut errors);
            let mut is_taken = [0.0; 16];
            while bits != 0 {
                let lane = bits.trailing_zeros() as usize;
                bits &= bits - 1;
                let found = (ts[lane], errors[lane], spot);
                is_taken[lane] = f32::from(u8::from(self.decide::<ANY>(hierarchy, row + lane, found)));
            }
            self.take::<F, ANY>(row, candidate, closer | F::load(&is_taken).gt(F::splat(0.0)), (spot, id));
        } else if closer.any() {
            self.take::<F, ANY>(row, candidate, closer, (spot, id));
        }
    }

    fn exact(&self, row: usize) -> exact::Line {
        let vectors = [&self.origin, &self.origin_low, &self.direction]
            .map(|columns| columns.each_ref().map(|column| column[row]));
        exact::Line::new(vectors, self.departure[row], self.t_min[row])
    }

    /// Takes in what a ray meets of a primitive for which f32 cannot tell.
    #[cold]
    pub(super) fn offer_exact<const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        row: usize,
        spot: Spot,
    ) {
        if self.t[row] < 0.0 {
            return;
        }
        if let Some((t, error, spot)) = self.exact(row).meets::<DEPARTING>(hierarchy, spot) {
            self.offer_one::<ANY>(hierarchy, row, (t, error), (spot, spot.id(hierarchy)));
        }
    }

    /// Takes a hit in if it is nearer, or if any will do.
    #[inline(always)]
    pub(super) fn offer_one<const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        row: usize,
        (t, error): (f32, f32),
        (spot, id): (Spot, u32),
    ) {
        let is_done = ANY && self.t[row] < 0.0;
        if is_done || !self.yields::<ANY>(hierarchy, row, (t, error, spot)) {
            return;
        }
        self.is_changed = true;
        if ANY {
            (self.t[row], self.end[row]) = (DEAD, DEAD);
        } else {
            (self.t[row], self.error[row], self.end[row]) = (t, error, t + error);
            (self.spot[row], self.id[row]) = (spot.0, id);
        }
    }

    /// Whether what a ray has found gives way to a hit.
    #[inline(always)]
    fn yields<const ANY: bool>(&self, hierarchy: &Hierarchy, row: usize, found: (f32, f32, Spot)) -> bool {
        let nearest = Nearest { t: self.t[row], error: self.error[row], spot: Spot(self.spot[row]) };
        nearest.yields_to::<ANY>(hierarchy, || self.exact(row), found)
    }

    /// Decides for one ray, in f64 where it takes that.
    #[cold]
    fn decide<const ANY: bool>(&self, hierarchy: &Hierarchy, row: usize, found: (f32, f32, Spot)) -> bool {
        self.yields::<ANY>(hierarchy, row, found)
    }

    #[inline(always)]
    fn take<F: Single, const ANY: bool>(
        &mut self,
        row: usize,
        candidate: &Candidate<F>,
        taken: F::Mask,
        (spot, id): (Spot, u32),
    ) {
        self.is_changed = true;
        let Candidate { t, error, .. } = *candidate;
        if ANY {
            let dead = F::select(taken, F::splat(DEAD), F::load(&self.t[row..]));
            dead.store(&mut self.t[row..]);
            dead.store(&mut self.end[row..]);
            return;
        }
        F::select(taken, t, F::load(&self.t[row..])).store(&mut self.t[row..]);
        F::select(taken, error, F::load(&self.error[row..])).store(&mut self.error[row..]);
        F::select(taken, t + error, F::load(&self.end[row..])).store(&mut self.end[row..]);
        for (column, word) in [(&mut self.spot, spot.0), (&mut self.id, id)] {
            let words = F::select_ids(taken, F::splat_ids(word), F::load_ids(&column[row..]));
            F::store_ids(words, &mut column[row..]);
        }
    }
}

/// Rays of a packet that lie side by side, from a row on.
struct Group<'a> {
    packet: &'a mut Packet,
    row: usize,
}

impl<F: Single> RayLines<F> for Group<'_> {
    const ARE_ALIKE: bool = true;

    #[inline(always)]
    fn line<const DEPARTING: bool>(&self) -> Line<F> {
        let Self { packet, row } = self;
        Line {
            origin: packet.origin.map_lanes(*row),
            origin_low: DEPARTING.then(|| packet.origin_low.map_lanes(*row)),
            direction: packet.direction.map_lanes(*row),
            a: F::load(&packet.a[*row..]),
            inverse_a: F::load(&packet.inverse_a[*row..]),
        }
    }
}

impl<F: Single> RayLanes<F> for Group<'_> {
    #[inline(always)]
    fn axes(&self) -> [usize; 3] {
        self.packet.axes
    }

    #[inline(always)]
    fn space<const DEPARTING: bool>(&self) -> RaySpace<F> {
        let Self { packet, row } = self;
        RaySpace {
            origin: packet.axes.map(|axis| F::load(&packet.origin[axis][*row..])),
            origin_low: DEPARTING.then(|| packet.axes.map(|axis| F::load(&packet.origin_low[axis][*row..]))),
            shear: [F::load(&packet.shear[0][*row..]), F::load(&packet.shear[1][*row..])],
            t_per_z: F::load(&packet.t_per_z[*row..]),
        }
    }

    #[inline(always)]
    fn padding(&self) -> F {
        F::load(&self.packet.padding[self.row..])
    }

    #[inline(always)]
    fn t_min(&self) -> F {
        F::load(&self.packet.t_min[self.row..])
    }

    #[inline(always)]
    fn departure(&self) -> F::Ids {
        F::load_ids(&self.packet.departure[self.row..])
    }

    #[inline(always)]
    fn offer<const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        candidate: &Candidate<F>,
        mask: F::Mask,
        at: (Spot, u32),
    ) {
        self.packet.offer::<F, DEPARTING, ANY>(hierarchy, self.row, candidate, mask, at);
    }
}
