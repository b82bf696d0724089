//! Rays that were recorded, so that any engine can be given the same ones.

use super::{Departure, RayCounts, RayKind, Stretch};
use crate::scene::{MAX_COORDINATE, PrimitiveId};
use glam::DVec3;

/// Rays in world space, and what is known of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RaySet {
    /// Origin xyz, `t_min`, direction xyz, `t_max`: a hit has `t_min` < t < `t_max`, and t is the ray's parameter.
    ///
    /// Where [`Self::starts`] says on which primitive a ray starts, `t_min` is for tracers that do not ask: beyond it, rounding
    /// does not let a ray hit what it starts on.
    pub rows: Vec<[f32; 8]>,
    /// Where rays start, row by row; empty where no ray is known to start on a primitive.
    pub starts: Vec<Start>,
    /// What the engine that they were recorded from found, row by row; empty where that is not known, and for shadow rays.
    pub found: Vec<Found>,
}

/// The start of a ray on a primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// What the rounding of the origin to f32 left out, world.
    pub origin_low: [f32; 3],
    /// The primitive, and to which of its sides the ray goes.
    pub departure: Departure,
}

/// What a ray hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// The ray's parameter; infinite on a miss.
    pub t: f32,
    /// The primitive; none on a miss.
    pub id: Option<PrimitiveId>,
    /// n_s on the side that the ray comes from, unit; 0 on a miss.
    pub shading_normal: [f32; 3],
}

/// The rays of a frame, in order of their tiles, batches and depths.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecordedRays {
    sets: [RaySet; RayKind::ALL.len()],
}

impl RaySet {
    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// A ray, as exactly as it is known; none where it is no ray: where it holds what is not a number, an origin farther out
    /// than a scene may reach, or a direction that is infinite or 0. Such a ray hits nothing.
    #[must_use]
    pub fn stretch(&self, row: usize) -> Option<Stretch> {
        let numbers = self.rows[row].map(f64::from);
        let [ox, oy, oz, t_min, dx, dy, dz, t_max] = numbers;
        let (origin, direction) = (DVec3::new(ox, oy, oz), DVec3::new(dx, dy, dz));
        let is_ray = origin.abs().max_element() <= MAX_COORDINATE
            && direction.is_finite()
            && direction != DVec3::ZERO
            && !numbers.into_iter().any(f64::is_nan);
        let start = self.starts.get(row);
        is_ray.then(|| Stretch {
            origin: start.map_or(origin, |start| origin + DVec3::from(start.origin_low.map(f64::from))),
            direction,
            t_min: if start.is_some() || t_min < 0.0 { 0.0 } else { t_min },
            t_max,
            departure: start.map(|start| start.departure),
        })
    }

    /// How many rows are no rays.
    #[must_use]
    pub fn unusable(&self) -> usize {
        (0..self.len()).filter(|&row| self.stretch(row).is_none()).count()
    }

    /// About as many of them, or all where there are not more: whole runs of 64, which a packet takes at once, evenly from the
    /// first to the last.
    #[must_use]
    pub fn thinned(&self, most: usize) -> Self {
        const RUN: usize = 64;
        let runs = self.len().div_ceil(RUN);
        let kept = most.div_ceil(RUN).max(1);
        if kept >= runs {
            return self.clone();
        }
        let mut thinned = Self::default();
        for run in (0..kept).map(|index| index * runs / kept) {
            let rows = run * RUN..((run + 1) * RUN).min(self.len());
            thinned.rows.extend_from_slice(&self.rows[rows.clone()]);
            thinned.starts.extend_from_slice(self.starts.get(rows.clone()).unwrap_or_default());
            thinned.found.extend_from_slice(self.found.get(rows).unwrap_or_default());
        }
        thinned
    }

    fn append(&mut self, mut other: Self) {
        self.rows.append(&mut other.rows);
        self.starts.append(&mut other.starts);
        self.found.append(&mut other.found);
    }
}

impl RecordedRays {
    /// Those of one kind.
    #[must_use]
    pub fn of(&self, kind: RayKind) -> &RaySet {
        &self.sets[kind as usize]
    }

    pub(crate) fn of_mut(&mut self, kind: RayKind) -> &mut RaySet {
        &mut self.sets[kind as usize]
    }

    /// How many of each kind.
    #[must_use]
    pub fn counts(&self) -> RayCounts {
        let [primary, shadow, reflect, refract] = RayKind::ALL.map(|kind| self.of(kind).len() as u64);
        RayCounts { primary, shadow, reflect, refract }
    }

    /// About as many of each kind: see [`RaySet::thinned`].
    #[must_use]
    pub fn thinned(&self, most: usize) -> Self {
        Self { sets: self.sets.each_ref().map(|set| set.thinned(most)) }
    }

    pub(crate) fn append(&mut self, other: Self) {
        for (mine, other) in self.sets.iter_mut().zip(other.sets) {
            mine.append(other);
        }
    }
}
