//! Rays as the wavefront engine reads them.

use super::{Hits, Query};
use crate::prepare::Prepared;
use crate::rays::RaySet;
use crate::traverse::{DEAD, Ends, NOTHING, NOWHERE, RUN, Rays};
use std::ops::Range;

/// Rays in columns and in the scene's scale, in whole runs of them. Both scale and the length of a direction are brought to the
/// size of 1 by powers of two, so what is found is found for the very rays that were given.
pub struct RayColumns {
    origin: [Vec<f32>; 3],
    origin_low: [Vec<f32>; 3],
    direction: [Vec<f32>; 3],
    departure: Vec<u32>,
    t_min: Vec<f32>,
    t_max: Vec<f32>,
    /// t in world space for each unit of t here.
    world_per_t: Vec<f64>,
    count: usize,
}

/// Where rays end, row by row of the rays.
pub(super) struct EndColumns {
    pub(super) t: Vec<f32>,
    pub(super) id: Vec<u32>,
}

/// A ray of the engine.
#[derive(Clone, Copy)]
struct Row {
    origin: [f32; 3],
    origin_low: [f32; 3],
    direction: [f32; 3],
    departure: u32,
    t_min: f32,
    t_max: f32,
    world_per_t: f64,
}

impl Row {
    const NONE: Self = Self {
        origin: [0.0; 3],
        origin_low: [0.0; 3],
        direction: [0.0, 0.0, 1.0],
        departure: NOWHERE,
        t_min: 0.0,
        t_max: DEAD,
        world_per_t: 1.0,
    };

    /// None for what is no ray, or cannot hit.
    fn new(rays: &RaySet, row: usize, scale: f32) -> Option<Self> {
        let stretch = rays.stretch(row).filter(|stretch| stretch.t_min < stretch.t_max)?;
        let [ox, oy, oz, _, dx, dy, dz, _] = rays.rows[row];
        let length = power_of_two_above(dx.abs().max(dy.abs()).max(dz.abs()));
        let world_per_t = 1.0 / (f64::from(scale) * length);
        #[expect(clippy::cast_possible_truncation, reason = "a power of two changes no digit of an f32")]
        let t = |world: f64| (world / world_per_t) as f32;
        #[expect(clippy::cast_possible_truncation, reason = "a power of two changes no digit of an f32")]
        let direction = [dx, dy, dz].map(|component| (f64::from(component) / length) as f32);
        let start = rays.starts.get(row);
        let row = Self {
            origin: [ox, oy, oz].map(|coordinate| coordinate * scale),
            origin_low: start.map_or([0.0; 3], |start| start.origin_low.map(|low| low * scale)),
            direction,
            departure: start
                .map_or(NOWHERE, |start| start.departure.from.0 << 1 | u32::from(start.departure.inward)),
            t_min: t(stretch.t_min),
            t_max: t(stretch.t_max),
            world_per_t,
        };
        // A scene so small beside a ray's distance that its scale takes the ray out of f32 cannot be hit by it.
        row.origin.iter().all(|coordinate| coordinate.is_finite()).then_some(row)
    }
}

/// The least power of two that is not below a number > 0.
fn power_of_two_above(number: f32) -> f64 {
    let number = f64::from(number);
    let below = f64::from_bits(number.to_bits() & !((1 << 52) - 1));
    if below < number { 2.0 * below } else { below }
}

impl RayColumns {
    /// Takes rays over for a scene.
    #[must_use]
    pub fn new(prepared: &Prepared<'_>, rays: &RaySet) -> Self {
        let count = rays.len();
        let scale = prepared.scale.factor();
        let mut rows: Vec<Row> = Vec::with_capacity(count.next_multiple_of(RUN));
        let mut last = Row::NONE;
        for row in 0..count {
            // What is no ray goes where its neighbour goes, and hits nothing, as the rows do that only fill up.
            rows.push(Row::new(rays, row, scale).unwrap_or(Row { t_max: DEAD, ..last }));
            last = rows[row];
        }
        rows.resize(count.next_multiple_of(RUN), Row { t_max: DEAD, ..last });
        let vector =
            |of: fn(&Row) -> [f32; 3]| [0, 1, 2].map(|axis| rows.iter().map(|row| of(row)[axis]).collect());
        let departs = !rays.starts.is_empty();
        let if_departing = |departs: bool| if departs { rows.len() } else { 0 };
        let mut this = Self {
            origin: vector(|row| row.origin),
            origin_low: Default::default(),
            direction: vector(|row| row.direction),
            departure: rows.iter().take(if_departing(departs)).map(|row| row.departure).collect(),
            t_min: rows.iter().take(if_departing(!departs)).map(|row| row.t_min).collect(),
            t_max: rows.iter().map(|row| row.t_max).collect(),
            world_per_t: rows.iter().map(|row| row.world_per_t).collect(),
            count,
        };
        if departs {
            this.origin_low = vector(|row| row.origin_low);
        }
        this
    }

    /// Rows that were given.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// As many rows as it takes to fill the last run.
    pub(crate) fn filled(&self) -> usize {
        self.t_max.len()
    }

    /// All rays.
    pub(crate) fn rays(&self) -> Rays<'_> {
        Rays {
            origin: self.origin.each_ref().map(Vec::as_slice),
            origin_low: self.origin_low.each_ref().map(Vec::as_slice),
            direction: self.direction.each_ref().map(Vec::as_slice),
            departure: &self.departure,
            t_min: &self.t_min,
            count: self.count,
        }
    }

    /// Where hits end to be of interest.
    pub(super) fn t_max(&self) -> &[f32] {
        &self.t_max
    }

    /// Sets ends to what rays have before they are traced.
    pub(super) fn begin(&self, rows: &Range<usize>, ends: &mut Ends<'_>) {
        ends.t.copy_from_slice(&self.t_max[rows.clone()]);
        ends.id.fill(NOTHING);
    }

    /// What ends say, in world space.
    pub(super) fn hits(&self, query: Query, ends: &EndColumns) -> Hits {
        let rows = 0..self.count;
        match query {
            Query::Closest => Hits {
                t: rows.clone().map(|row| self.world_t(row, ends)).collect(),
                id: ends.id[rows].to_vec(),
            },
            Query::Any => {
                let is_occluded = |row: usize| self.t_max[row] >= 0.0 && ends.t[row] < 0.0;
                Hits {
                    t: rows.map(|row| if is_occluded(row) { 0.0 } else { f32::INFINITY }).collect(),
                    id: vec![Hits::MISS; self.count],
                }
            }
        }
    }

    fn world_t(&self, row: usize, ends: &EndColumns) -> f32 {
        if ends.id[row] == NOTHING {
            return f32::INFINITY;
        }
        #[expect(clippy::cast_possible_truncation, reason = "a power of two changes no digit of an f32")]
        let t = (f64::from(ends.t[row]) * self.world_per_t[row]) as f32;
        // A hit stays one, however short its ray's direction.
        t.min(f32::MAX)
    }
}
