//! The rays of a stream, as records: what is needed together lies together.

use super::super::exact::{self, Nearest, Spot};
use super::super::regroup::Incoming;
use super::super::single::Ray;
use super::super::terms::Terms;
use super::super::{DEAD, NOTHING, NOWHERE};
use super::{AHEAD, CAPACITY};
use crate::kernel::axes_from;
use crate::kernel::bounds::Slabs;
use crate::lanes::{RECORD, Record, Single, Vector};
use crate::prepare::Hierarchy;

/// What the directions of all rays of a stream have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::traverse) struct Class {
    /// The axis along which they are fastest.
    pub(in crate::traverse) third: usize,
    /// Whether their components are negative.
    pub(in crate::traverse) backwards: [bool; 3],
}

impl Class {
    /// Bit i is set if the direction is negative along axis i.
    pub(super) fn octant(self) -> usize {
        (0..3).map(|axis| usize::from(self.backwards[axis]) << axis).sum()
    }
}

type Records = Box<[Record; CAPACITY]>;

pub(super) struct StreamRays {
    pub(super) class: Class,
    /// | number | |
    /// |---|---|
    /// | 0–2 | origin |
    /// | 3 | by how much boxes are grown |
    /// | 4–6 | 1 / direction, all of it finite |
    /// | 7 | nothing beyond this t can be nearer |
    slabs: Records,
    /// | number | |
    /// |---|---|
    /// | 0–1 | shear |
    /// | 2 | t for each unit along the fastest axis |
    /// | 3 | hits are wanted beyond this t |
    /// | 4–6 | what the origin's rounding left out |
    /// | 7 | the bits of the departure |
    faces: Records,
    /// | number | |
    /// |---|---|
    /// | 0–2 | direction d |
    /// | 3–4 | a = d·d and 1/a |
    lines: Records,
    /// The nearest hit so far, or where hits end to be of interest.
    pub(super) nearest: Vec<Nearest>,
}

const END: usize = 7;
const T_PER_Z: usize = 2;
const T_MIN: usize = 3;
const LOW: usize = 4;
const DEPARTURE: usize = 7;

impl StreamRays {
    pub(super) fn new() -> Self {
        let records = || Box::new([Record::default(); CAPACITY]);
        Self {
            class: Class { third: 2, backwards: [false; 3] },
            slabs: records(),
            faces: records(),
            lines: records(),
            nearest: Vec::with_capacity(CAPACITY),
        }
    }

    /// Takes rays in, of these places among those that came.
    pub(super) fn load<L: Single, const DEPARTING: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        incoming: &Incoming,
        places: &[u32],
        class: Class,
    ) {
        self.class = class;
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        for first in (0..places.len()).step_by(L::WIDTH) {
            let place = |lane: usize| places[(first + lane).min(places.len() - 1)] as usize;
            incoming.prefetch::<DEPARTING>(&places[(first + AHEAD).min(places.len())..], L::WIDTH);
            let [x, y, z, end, dx, dy, dz, t_min] = L::transposed(|lane| &incoming.rays[place(lane)]);
            let ray = [[x, y, z], [dx, dy, dz]];
            let terms = Terms::new(hierarchy.extent, ray, class.third, class.backwards);
            let Terms { padding, inverse, shear, t_per_z, a } = terms;
            let slabs = [x, y, z, padding, inverse[0], inverse[1], inverse[2], end];
            L::store_records(slabs, &mut self.slabs[first..]);
            let [low_x, low_y, low_z, departure] = if DEPARTING {
                let [x, y, z, departure, ..] = L::transposed(|lane| &incoming.departures[place(lane)]);
                [x, y, z, departure]
            } else {
                [zero, zero, zero, L::splat(f32::from_bits(NOWHERE))]
            };
            let faces = [shear[0], shear[1], t_per_z, t_min, low_x, low_y, low_z, departure];
            L::store_records(faces, &mut self.faces[first..]);
            L::store_records([dx, dy, dz, a, one / a, zero, zero, zero], &mut self.lines[first..]);
        }
        self.nearest.clear();
        self.nearest.extend(self.slabs[..places.len()].iter().map(|slab| Nearest::before(slab.0[END])));
    }

    /// What slab tests need of the rays of these numbers: as many as there are lanes.
    #[inline(always)]
    pub(super) fn boxes<L: Single>(&self, numbers: &[u32]) -> BoxLanes<L> {
        let numbers = &numbers[..L::WIDTH];
        let [x, y, z, padding, a, b, c, end] =
            L::transposed(|lane| &self.slabs[numbers[lane] as usize % CAPACITY]);
        let padded = |axis: usize| if self.class.backwards[axis] { -padding } else { padding };
        let (dx, dy, dz) = (padded(0), padded(1), padded(2));
        BoxLanes {
            origin: Vector::new(x, y, z),
            padding,
            slabs: Slabs {
                near_origin: Vector::new(x + dx, y + dy, z + dz),
                far_origin: Vector::new(x - dx, y - dy, z - dz),
                inverse: Vector::new(a, b, c),
            },
            end,
        }
    }

    #[inline(always)]
    pub(super) fn faces<L: Single>(&self, numbers: &[u32]) -> [L; RECORD] {
        let numbers = &numbers[..L::WIDTH];
        L::transposed(|lane| &self.faces[numbers[lane] as usize % CAPACITY])
    }

    #[inline(always)]
    pub(super) fn lines<L: Single>(&self, numbers: &[u32]) -> [L; RECORD] {
        let numbers = &numbers[..L::WIDTH];
        L::transposed(|lane| &self.lines[numbers[lane] as usize % CAPACITY])
    }

    /// Of rays that are spread over lanes: origins, and by how much boxes are grown.
    #[inline(always)]
    pub(super) fn spread_origins<L: Single>(&self, numbers: &[u32]) -> [L; 4] {
        L::spread_halves(|ray| &self.slabs[numbers[ray] as usize % CAPACITY].halves()[0])
    }

    /// Shears, t for each unit along the fastest axis, and t beyond which hits are wanted.
    #[inline(always)]
    pub(super) fn spread_shears<L: Single>(&self, numbers: &[u32]) -> [L; 4] {
        L::spread_halves(|ray| &self.faces[numbers[ray] as usize % CAPACITY].halves()[0])
    }

    /// What origins' rounding left out, and the bits of departures.
    #[inline(always)]
    pub(super) fn spread_departures<L: Single>(&self, numbers: &[u32]) -> [L; 4] {
        L::spread_halves(|ray| &self.faces[numbers[ray] as usize % CAPACITY].halves()[1])
    }

    /// d, a and 1/a.
    #[inline(always)]
    pub(super) fn spread_lines<L: Single>(&self, numbers: &[u32]) -> ([L; 4], L) {
        let halves = |ray: usize| self.lines[numbers[ray] as usize % CAPACITY].halves();
        let [inverse_a, ..] = L::spread_halves(|ray| &halves(ray)[1]);
        (L::spread_halves(|ray| &halves(ray)[0]), inverse_a)
    }

    /// Writes down one ray of them. Each field by itself: a ray that was made as a whole was copied by wide loads of what had
    /// only just been stored, where a sixth of the samples of rays alone fell (2026-11). Whole walks became no faster.
    #[inline(always)]
    pub(super) fn write_ray(&self, number: usize, ray: &mut Ray) {
        let (slab, face, line) = (&self.slabs[number].0, &self.faces[number].0, &self.lines[number].0);
        let [x, y, z, padding, a, b, c, _] = *slab;
        let origin = [x, y, z];
        for axis in 0..3 {
            let padded = if self.class.backwards[axis] { -padding } else { padding };
            ray.near_origin[axis] = origin[axis] + padded;
            ray.far_origin[axis] = origin[axis] - padded;
            ray.origin[axis] = origin[axis];
            ray.origin_low[axis] = face[LOW + axis];
            ray.direction[axis] = line[axis];
        }
        ray.inverse = [a, b, c];
        ray.backwards = self.class.backwards;
        ray.axes = axes_from(self.class.third);
        ray.shear = [face[0], face[1]];
        ray.t_per_z = face[T_PER_Z];
        ray.a = line[3];
        ray.padding = padding;
        ray.t_min = face[T_MIN];
        ray.departure = face[DEPARTURE].to_bits();
    }

    #[cold]
    pub(super) fn exact(&self, number: usize) -> exact::Line {
        let mut ray = Ray::NONE;
        self.write_ray(number, &mut ray);
        ray.exact()
    }

    /// Whether there is nothing more to find for a ray.
    #[inline(always)]
    pub(super) fn is_done<const ANY: bool>(&self, number: usize) -> bool {
        ANY && self.nearest[number].spot != Spot::NOTHING
    }

    /// Takes a hit of a ray in if it is nearer, or if any will do.
    #[inline(always)]
    pub(super) fn offer<const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        number: usize,
        (t, error, spot): (f32, f32, Spot),
    ) {
        if self.is_done::<ANY>(number) {
            return;
        }
        let nearest = self.nearest[number];
        if nearest.yields_to::<ANY>(hierarchy, || self.exact(number), (t, error, spot)) {
            self.keep::<ANY>(number, Nearest { t, error, spot });
        }
    }

    /// Takes in what a ray meets of a primitive for which f32 cannot tell.
    #[cold]
    pub(super) fn offer_exact<const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        number: usize,
        spot: Spot,
    ) {
        if let Some(found) = self.exact(number).meets::<DEPARTING>(hierarchy, spot) {
            self.offer::<ANY>(hierarchy, number, found);
        }
    }

    /// Keeps what was found for a ray.
    #[inline(always)]
    pub(super) fn keep<const ANY: bool>(&mut self, number: usize, nearest: Nearest) {
        self.nearest[number] = nearest;
        self.slabs[number].0[END] = if self.is_done::<ANY>(number) { DEAD } else { nearest.end() };
    }

    /// t and id as [`super::super::Ends`] has them.
    pub(super) fn end<const ANY: bool>(&self, hierarchy: &Hierarchy, number: usize) -> (f32, u32) {
        let nearest = &self.nearest[number];
        if self.is_done::<ANY>(number) { (DEAD, NOTHING) } else { (nearest.t, nearest.spot.id(hierarchy)) }
    }
}

/// What slab tests need of as many rays as there are lanes.
pub(super) struct BoxLanes<L> {
    pub(super) origin: Vector<L>,
    pub(super) padding: L,
    pub(super) slabs: Slabs<L>,
    pub(super) end: L,
}
