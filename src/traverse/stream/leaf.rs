//! The rays of a list against what is in a leaf.

use super::super::candidate::Candidate;
use super::super::exact::Spot;
use super::super::leaf::{RayLanes, RayLines};
use super::super::tile::{Origin, TileLines, TileRays};
use super::rays::{BoxLanes, StreamRays};
use crate::kernel::RaySpace;
use crate::kernel::axes_from;
use crate::kernel::sphere::Line;
use crate::lanes::{Mask, RECORD, Single, Vector};
use crate::prepare::Hierarchy;

/// As many rays as there are lanes, of these numbers.
pub(super) struct Listed<'a, L> {
    rays: &'a mut StreamRays,
    numbers: &'a [u32],
    boxes: BoxLanes<L>,
    faces: [L; RECORD],
}

impl<'a, L: Single> Listed<'a, L> {
    #[inline(always)]
    pub(super) fn new(rays: &'a mut StreamRays, numbers: &'a [u32], boxes: BoxLanes<L>) -> Self {
        let faces = rays.faces(numbers);
        Self { rays, numbers: &numbers[..L::WIDTH], boxes, faces }
    }
}

impl<L: Single> RayLines<L> for Listed<'_, L> {
    const ARE_ALIKE: bool = false;

    #[inline(always)]
    fn line<const DEPARTING: bool>(&self) -> Line<L> {
        let [x, y, z, a, inverse_a, ..] = self.rays.lines(self.numbers);
        let [.., low_x, low_y, low_z, _] = self.faces;
        Line {
            origin: self.boxes.origin,
            origin_low: DEPARTING.then(|| Vector::new(low_x, low_y, low_z)),
            direction: Vector::new(x, y, z),
            a,
            inverse_a,
        }
    }
}

impl<L: Single> RayLanes<L> for Listed<'_, L> {
    #[inline(always)]
    fn axes(&self) -> [usize; 3] {
        axes_from(self.rays.class.third)
    }

    #[inline(always)]
    fn space<const DEPARTING: bool>(&self) -> RaySpace<L> {
        let Vector { x, y, z } = self.boxes.origin;
        let [shear_x, shear_y, t_per_z, _, low_x, low_y, low_z, _] = self.faces;
        let third = self.rays.class.third;
        RaySpace {
            origin: turned(third, [x, y, z]),
            origin_low: DEPARTING.then(|| turned(third, [low_x, low_y, low_z])),
            shear: [shear_x, shear_y],
            t_per_z,
        }
    }

    #[inline(always)]
    fn padding(&self) -> L {
        self.boxes.padding
    }

    #[inline(always)]
    fn t_min(&self) -> L {
        self.faces[3]
    }

    #[inline(always)]
    fn departure(&self) -> L::Ids {
        self.faces[7].bits_as_ids()
    }

    #[inline(always)]
    fn offer<const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        candidate: &Candidate<L>,
        mask: L::Mask,
        (spot, _): (Spot, u32),
    ) {
        let Candidate { t, error, hit, unclear } = *candidate;
        let mut unclear = (unclear & mask).bits();
        while unclear != 0 {
            let number = self.numbers[unclear.trailing_zeros() as usize] as usize;
            unclear &= unclear - 1;
            self.rays.offer_exact::<DEPARTING, ANY>(hierarchy, number, spot);
        }
        let mut bits = (hit & mask & !(t - error).gt(self.boxes.end)).bits();
        if bits == 0 {
            return;
        }
        let (mut ts, mut errors) = ([0.0; 16], [0.0; 16]);
        t.store(&mut ts);
        error.store(&mut errors);
        while bits != 0 {
            let lane = bits.trailing_zeros() as usize;
            bits &= bits - 1;
            let number = self.numbers[lane] as usize;
            self.rays.offer::<ANY>(hierarchy, number, (ts[lane], errors[lane], spot));
        }
    }
}

/// Rays of these numbers.
pub(super) struct Tiled<'a> {
    rays: &'a mut StreamRays,
    /// As many as go into a tile may be read from each on.
    numbers: &'a [u32],
}

impl<'a> Tiled<'a> {
    pub(super) fn new(rays: &'a mut StreamRays, numbers: &'a [u32]) -> Self {
        Self { rays, numbers }
    }

    /// What the origins' rounding left out, and the departures' bits, where there are any.
    #[inline(always)]
    fn departures<L: Single, const DEPARTING: bool>(&self, numbers: &[u32]) -> [L; 4] {
        if DEPARTING { self.rays.spread_departures::<L>(numbers) } else { [L::splat(0.0); 4] }
    }
}

impl TileRays for Tiled<'_> {
    #[inline(always)]
    fn axes(&self) -> [usize; 3] {
        axes_from(self.rays.class.third)
    }

    #[inline(always)]
    fn space<L: Single, const DEPARTING: bool>(&self, place: usize) -> (RaySpace<L>, Origin<L>) {
        let numbers = &self.numbers[place..];
        let [x, y, z, padding] = self.rays.spread_origins::<L>(numbers);
        let [shear_x, shear_y, t_per_z, t_min] = self.rays.spread_shears::<L>(numbers);
        let [low_x, low_y, low_z, departure] = self.departures::<L, DEPARTING>(numbers);
        let third = self.rays.class.third;
        let space = RaySpace {
            origin: turned(third, [x, y, z]),
            origin_low: DEPARTING.then(|| turned(third, [low_x, low_y, low_z])),
            shear: [shear_x, shear_y],
            t_per_z,
        };
        (space, Origin { padding, t_min, departure })
    }

    #[inline(always)]
    fn offer<const ANY: bool>(&mut self, hierarchy: &Hierarchy, place: usize, found: (f32, f32, Spot)) {
        self.rays.offer::<ANY>(hierarchy, self.numbers[place] as usize, found);
    }

    #[inline(always)]
    fn offer_exact<const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        place: usize,
        spot: Spot,
    ) {
        self.rays.offer_exact::<DEPARTING, ANY>(hierarchy, self.numbers[place] as usize, spot);
    }
}

impl TileLines for Tiled<'_> {
    #[inline(always)]
    fn line<L: Single, const DEPARTING: bool>(&self, place: usize) -> (Line<L>, Origin<L>) {
        let numbers = &self.numbers[place..];
        let [x, y, z, padding] = self.rays.spread_origins::<L>(numbers);
        let [.., t_min] = self.rays.spread_shears::<L>(numbers);
        let [low_x, low_y, low_z, departure] = self.departures::<L, DEPARTING>(numbers);
        let ([dx, dy, dz, a], inverse_a) = self.rays.spread_lines::<L>(numbers);
        let line = Line {
            origin: Vector::new(x, y, z),
            origin_low: DEPARTING.then(|| Vector::new(low_x, low_y, low_z)),
            direction: Vector::new(dx, dy, dz),
            a,
            inverse_a,
        };
        (line, Origin { padding, t_min, departure })
    }
}

/// In the order of axes of rays that are fastest along the third.
#[inline(always)]
fn turned<L: Copy>(third: usize, [x, y, z]: [L; 3]) -> [L; 3] {
    match third {
        0 => [y, z, x],
        1 => [z, x, y],
        _ => [x, y, z],
    }
}
