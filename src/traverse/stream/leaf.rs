//! The rays of a list against what is in a leaf.

use super::super::candidate::Candidate;
use super::super::exact::{self, Spot};
use super::super::leaf::{RayLanes, RayLines};
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

    /// Takes a hit in if it is nearer, or if any will do.
    #[inline(always)]
    fn offer_one<const ANY: bool>(&mut self, hierarchy: &Hierarchy, number: usize, found: (f32, f32, Spot)) {
        if self.rays.is_done::<ANY>(number) {
            return;
        }
        let nearest = self.rays.nearest[number];
        if nearest.yields_to::<ANY>(hierarchy, || self.rays.exact(number), found) {
            let (t, error, spot) = found;
            self.rays.keep::<ANY>(number, exact::Nearest { t, error, spot });
        }
    }

    #[cold]
    fn offer_exact<const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        number: usize,
        spot: Spot,
    ) {
        let line = self.rays.exact(number);
        let found =
            if DEPARTING { line.departs_to(hierarchy, spot) } else { line.meets_beyond(hierarchy, spot) };
        if let Some(t) = found {
            self.offer_one::<ANY>(hierarchy, number, (t, t * exact::ROUNDED, spot));
        }
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
        let turned = |x: L, y: L, z: L| match self.rays.class.third {
            0 => [y, z, x],
            1 => [z, x, y],
            _ => [x, y, z],
        };
        RaySpace {
            origin: turned(x, y, z),
            origin_low: DEPARTING.then(|| turned(low_x, low_y, low_z)),
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
            self.offer_exact::<DEPARTING, ANY>(hierarchy, number, spot);
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
            self.offer_one::<ANY>(hierarchy, number, (ts[lane], errors[lane], spot));
        }
    }
}
