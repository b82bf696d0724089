//! The rays of a packet against what is in a leaf.

use super::super::candidate::{self, Candidate, Start, View};
use super::super::exact::{self, Nearest, Spot};
use super::super::{Counts, DEAD, NOTHING};
use super::{Columns, PACKET, Packet};
use crate::kernel::polygon::Outline;
use crate::kernel::sphere::Line;
use crate::kernel::{RaySpace, unclear_area};
use crate::lanes::{Mask, Single, Vector};
use crate::prepare::bvh::Node;
use crate::prepare::{BLOCK, Hierarchy, Place};

impl Packet {
    /// Tests what is in a leaf, against every group from the given one on whose rays meet its box.
    #[inline(always)]
    pub(super) fn visit_leaf<F: Single, const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        leaf: Place,
        (node, slot): (&Node, u8),
        (first_group, mask): (u8, F::Mask),
        counts: &mut Counts,
    ) {
        let mut group = first_group;
        let mut mask = mask;
        loop {
            let bits = mask.bits();
            if bits != 0 {
                let row = group as usize * F::WIDTH;
                let used = bits.count_ones() as usize;
                match leaf {
                    Place::Triangles(index) => {
                        self.test_triangles::<F, DEPARTING, ANY>(hierarchy, index, row, (mask, used), counts);
                    }
                    Place::Spheres(index) => {
                        self.test_spheres::<F, DEPARTING, ANY>(hierarchy, index, row, (mask, used), counts);
                    }
                    Place::Polygons(first, count) => {
                        for index in first..first + count {
                            self.test_polygon::<F, DEPARTING, ANY>(
                                hierarchy,
                                index,
                                row,
                                (mask, used),
                                counts,
                            );
                        }
                    }
                    Place::Node(_) => {}
                }
            }
            group += 1;
            if group as usize * F::WIDTH >= PACKET {
                return;
            }
            mask = self.group_enters::<F>(node, slot, group, counts);
        }
    }

    #[inline(always)]
    fn test_triangles<F: Single, const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        index: usize,
        row: usize,
        (mask, used): (F::Mask, usize),
        counts: &mut Counts,
    ) {
        let block = &hierarchy.triangles[index];
        let (space, padding) = (self.space::<F, DEPARTING>(row), F::load(&self.padding[row..]));
        for lane in 0..BLOCK {
            let id = block.ids[lane];
            if id == NOTHING {
                return; // the others are empty too
            }
            if ANY && !hierarchy.casts_shadow(id) {
                continue;
            }
            let [x, y, z] = self.axes;
            let [a, b, c] = &block.vertices;
            let corner = |of: &[[f32; BLOCK]; 3]| {
                [F::splat(of[x][lane]), F::splat(of[y][lane]), F::splat(of[z][lane])]
            };
            let vertices = [corner(a), corner(b), corner(c)];
            let start = self.start::<F, DEPARTING>(row, id);
            let sizes = [F::splat(block.size[lane]), F::splat(block.error_area[lane])];
            let candidate = candidate::triangle::<F, DEPARTING>(&space, padding, vertices, sizes, start);
            counts.triangles.add(F::WIDTH, used);
            self.offer::<F, DEPARTING, ANY>(
                hierarchy,
                row,
                &candidate,
                mask,
                (Spot::triangle(index, lane), id),
            );
        }
    }

    #[inline(always)]
    fn test_spheres<F: Single, const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        index: usize,
        row: usize,
        (mask, used): (F::Mask, usize),
        counts: &mut Counts,
    ) {
        let block = &hierarchy.spheres[index];
        let (line, padding) = (self.line::<F, DEPARTING>(row), F::load(&self.padding[row..]));
        for lane in 0..BLOCK {
            let id = block.ids[lane];
            if id == NOTHING {
                return; // the others are empty too
            }
            if ANY && !hierarchy.casts_shadow(id) {
                continue;
            }
            let center = Vector::splat(block.centers.map(|column| column[lane]));
            let start = self.start::<F, DEPARTING>(row, id);
            let sizes = [F::splat(block.radii[lane]), F::splat(block.slack[lane])];
            let candidate = candidate::sphere::<F, DEPARTING>(&line, padding, center, sizes, start);
            counts.spheres.add(F::WIDTH, used);
            self.offer::<F, DEPARTING, ANY>(
                hierarchy,
                row,
                &candidate,
                mask,
                (Spot::sphere(index, lane), id),
            );
        }
    }

    #[inline(always)]
    fn test_polygon<F: Single, const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        index: usize,
        row: usize,
        (mask, used): (F::Mask, usize),
        counts: &mut Counts,
    ) {
        let face = &hierarchy.polygons[index];
        if ANY && !hierarchy.casts_shadow(face.id) {
            return;
        }
        let zero = F::splat(0.0);
        let space = self.space::<F, DEPARTING>(row);
        let first = face.first_corner as usize;
        let [x, y, z] = self.axes.map(|axis| &hierarchy.corners[axis][..]);
        let corner = |index: usize| space.see([F::splat(x[index]), F::splat(y[index]), F::splat(z[index])]);
        let mut outline = Outline::<F>::new();
        let mut from = corner(first);
        let doubt = if DEPARTING {
            unclear_area(&from, [F::splat(face.size), F::splat(face.longest_edge)])
        } else {
            zero
        };
        for index in first + 1..=first + face.edges as usize {
            let to = corner(index);
            if DEPARTING {
                outline.add_edge_with_doubt(&from, &to, (doubt, mask), zero);
            } else {
                outline.add_edge(&from, &to, zero);
            }
            from = to;
        }
        counts.polygons.calls += u64::from(face.edges);
        counts.polygons.lanes += u64::from(face.edges) * F::WIDTH as u64;
        counts.polygons.used += u64::from(face.edges) * used as u64;
        if !DEPARTING {
            let (before, beyond) = outline.sides_of(F::load(&self.t_min[row..]), space.t_per_z);
            outline.unclear = before & beyond;
        }
        if !((outline.odd | outline.unclear) & mask).any() {
            return;
        }
        let view =
            View { space, line: self.line::<F, DEPARTING>(row), padding: F::load(&self.padding[row..]) };
        let plane = [Vector::splat(face.point), Vector::splat(face.normal)];
        let start = self.start::<F, DEPARTING>(row, face.id);
        let candidate =
            candidate::polygon::<F, DEPARTING>(&view, plane, &outline, F::splat(face.slack), start);
        self.offer::<F, DEPARTING, ANY>(hierarchy, row, &candidate, mask, (Spot::polygon(index), face.id));
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
    fn offer_exact<const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        row: usize,
        spot: Spot,
    ) {
        if self.t[row] < 0.0 {
            return;
        }
        let line = self.exact(row);
        let found =
            if DEPARTING { line.departs_to(hierarchy, spot) } else { line.meets_beyond(hierarchy, spot) };
        let Some(t) = found else { return };
        let error = t * exact::ROUNDED;
        if !self.decide::<ANY>(hierarchy, row, (t, error, spot)) {
            return;
        }
        self.is_changed = true;
        if ANY {
            (self.t[row], self.end[row]) = (DEAD, DEAD);
        } else {
            (self.t[row], self.error[row], self.end[row]) = (t, error, t + error);
            (self.spot[row], self.id[row]) = (spot.0, spot.id(hierarchy));
        }
    }

    /// Decides for one ray, in f64 where it takes that.
    #[cold]
    fn decide<const ANY: bool>(&self, hierarchy: &Hierarchy, row: usize, found: (f32, f32, Spot)) -> bool {
        let nearest = Nearest { t: self.t[row], error: self.error[row], spot: Spot(self.spot[row]) };
        nearest.yields_to::<ANY>(hierarchy, || self.exact(row), found)
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

    #[inline(always)]
    fn space<F: Single, const DEPARTING: bool>(&self, row: usize) -> RaySpace<F> {
        RaySpace {
            origin: self.axes.map(|axis| F::load(&self.origin[axis][row..])),
            origin_low: DEPARTING.then(|| self.axes.map(|axis| F::load(&self.origin_low[axis][row..]))),
            shear: [F::load(&self.shear[0][row..]), F::load(&self.shear[1][row..])],
            t_per_z: F::load(&self.t_per_z[row..]),
        }
    }

    #[inline(always)]
    fn line<F: Single, const DEPARTING: bool>(&self, row: usize) -> Line<F> {
        Line {
            origin: self.origin.map_lanes(row),
            origin_low: DEPARTING.then(|| self.origin_low.map_lanes(row)),
            direction: self.direction.map_lanes(row),
            a: F::load(&self.a[row..]),
            inverse_a: F::load(&self.inverse_a[row..]),
        }
    }

    /// Which rays of a group start on a primitive, and which go inside what they start on.
    #[inline(always)]
    fn start<F: Single, const DEPARTING: bool>(&self, row: usize, id: u32) -> Start<F> {
        if !DEPARTING {
            let none = F::first(0);
            return Start { own: none, inward: none, t_min: F::load(&self.t_min[row..]) };
        }
        let departure = F::load_ids(&self.departure[row..]);
        Start {
            own: F::ids_eq(F::ids_half(departure), F::splat_ids(id)),
            inward: F::ids_odd(departure),
            t_min: F::splat(0.0),
        }
    }
}
