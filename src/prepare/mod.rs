//! Makes a scene ready for the wavefront engine: geometry in structure of arrays under one hierarchy, a camera, and the
//! plan of what the scene needs.
//!
//! Everything is scaled by a power of two so that the largest coordinate lies in [1, 2): the same picture, to the bit, at
//! any scale of the scene that is a power of two, and products of coordinates that neither overflow nor vanish.

mod blocks;
pub(crate) mod bvh;
mod directory;
mod hierarchy;
mod plan;
mod scale;
mod sources;
mod view;

pub(crate) use blocks::{BLOCK, TOUCHING_OF_UNIT_SPHERE, TriangleBlock, count_there};
pub(crate) use directory::{Directory, material_of};
pub(crate) use hierarchy::{Hierarchy, Place};
pub use plan::Plan;
pub(crate) use scale::Scale;
pub(crate) use view::View;

use crate::scene::Scene;
use thiserror::Error;

/// A scene made ready.
pub struct Prepared<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) scale: Scale,
    pub(crate) view: View,
    pub(crate) hierarchy: Hierarchy,
    pub(crate) directory: Directory,
    pub(crate) plan: Plan,
}

/// Why a scene cannot be made ready.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum PrepareError {
    /// The engine numbers rays' departures and leaves in words of 32 bits.
    #[error(
        "the wavefront engine has room for 2^{} primitives, and the scene numbers {count}; use --engine reference",
        Directory::LIMIT.ilog2()
    )]
    TooMany {
        /// One more than the largest id.
        count: u64,
    },
}

impl<'a> Prepared<'a> {
    /// Builds the hierarchy, on the threads of the current pool; the result is the same for any number of them.
    ///
    /// # Errors
    /// More primitives than the engine can number.
    pub fn new(scene: &'a Scene) -> Result<Self, PrepareError> {
        let directory = Directory::new(&scene.geometry)?;
        let scale = Scale::of(scene);
        Ok(Self {
            scene,
            scale,
            view: View::new(&scene.camera, &scene.image, scale),
            hierarchy: Hierarchy::new(scene, scale),
            directory,
            plan: Plan::new(scene),
        })
    }
}
