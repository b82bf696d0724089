//! Recorded rays, given to any engine on their own: what they hit, and how fast that is found.
//!
//! A frame mixes the tracing of rays with all else that a picture takes, and each engine would trace rays of its own. Here
//! every engine gets the same rays, so their speeds and their answers can be compared ray by ray.
//!
//! - `columns`: rays as the wavefront engine reads them
//! - `passes`: passes over all rays, timed
//! - `tests_made`: what they took, counted
//! - `files`: rays and hits as NPY arrays
//! - `clearance`: a `t_min` for tracers that do not know where a ray starts

mod clearance;
mod columns;
mod files;
mod passes;
mod tests_made;

pub use clearance::add_clearance;
pub use columns::RayColumns;
pub use files::{hit_files, ray_file, write_hits, write_rays};
pub use passes::{ReferenceRun, Run};
pub use tests_made::{KernelRuns, TestsMade};

use crate::rays::RayKind;

/// What is asked of rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Query {
    /// What is hit first.
    Closest,
    /// Whether anything is hit that casts a shadow.
    Any,
}

impl Query {
    /// What a frame asks of rays of a kind.
    #[must_use]
    pub fn of(kind: RayKind) -> Self {
        match kind {
            RayKind::Shadow => Self::Any,
            RayKind::Primary | RayKind::Reflect | RayKind::Refract => Self::Closest,
        }
    }

    /// As the command line has it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Closest => "closest",
            Self::Any => "any",
        }
    }
}

/// What rays hit, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Hits {
    /// The ray's parameter, +∞ on a miss. If [`Query::Any`]: 0 for an occluded ray.
    pub t: Vec<f32>,
    /// The primitive, [`Self::MISS`] on a miss and for [`Query::Any`].
    pub id: Vec<u32>,
}

impl Hits {
    /// Not the id of a primitive.
    pub const MISS: u32 = u32::MAX;

    /// Whether both say the same, to the bit.
    #[must_use]
    pub fn has_same_bits(&self, other: &Self) -> bool {
        self.id == other.id
            && bytemuck::cast_slice::<_, u32>(&self.t) == bytemuck::cast_slice::<_, u32>(&other.t)
    }

    /// How many rays hit something.
    #[must_use]
    pub fn count(&self) -> usize {
        self.t.iter().filter(|t| t.is_finite()).count()
    }
}
