//! A data-oriented Whitted ray tracer for the CPU.
//!
//! Data flows one way:
//!
//! ```text
//! load  →  scene  →  prepare  →  wavefront (traverse (kernel (lanes)))  →  film
//! ```
//!
//! - [`load`] reads a scene file and ends in a [`scene::Scene`] or in an error that names file, line and column;
//! - [`mod@generate`] makes the standard scenes of a benchmark instead, and [`mod@save`] writes a scene to a file;
//! - [`scene`] is plain data in the user's units;
//! - [`prepare`] makes of it what the engine runs on: geometry in structure of arrays under one tree, and the plan of what the
//!   scene needs;
//! - [`wavefront`] traces it: rays in queues, worked through in stages. `traverse` walks them through the tree, `kernel` has
//!   the tests of rays against primitives, a formula a file, and [`lanes`] makes width a type;
//! - [`mod@reference`] traces it in scalar f64, from the textbook: the truth that the engine is checked against;
//! - [`mod@trace`] gives recorded [`rays`] to any engine on their own, and takes the time;
//! - [`certified`] says with certainty what a ray meets, and judges the answers of all of them;
//! - [`film`] holds sample positions, pixels and picture files;
//! - [`mod@render`] puts these together, [`measure`] compares the results, and `report` shows them; [`ray_tree`] is what both
//!   engines can say of how a pixel came to its colour.
//!
//! ```no_run
//! use std::sync::atomic::AtomicBool;
//! use wavelane::{film, lanes, load, render};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scene = load::load("scenes/glass.toml".as_ref())?.scene;
//! let options = render::RenderOptions {
//!     engine: render::Engine::wavefront(lanes::Width::BEST),
//!     region: film::Region::whole(scene.image.width, scene.image.height),
//!     threads: 0,
//!     on_progress: &|_| {},
//!     stop: &AtomicBool::new(false),
//! };
//! let rendered = render::render(&scene, &options)?;
//! film::write(&rendered.image, "glass.png".as_ref(), film::BitDepth::Eight)?;
//! # Ok(())
//! # }
//! ```

#[cfg(test)]
mod boundary_cases;
pub mod certified;
pub mod cli;
pub mod film;
pub mod generate;
mod kernel;
pub mod lanes;
pub mod load;
mod math;
pub mod measure;
mod npy;
pub mod prepare;
mod random;
pub mod ray_tree;
pub mod rays;
pub mod reference;
pub mod render;
mod report;
pub mod save;
pub mod scene;
mod signature;
pub mod trace;
mod traverse;
pub mod wavefront;
mod whole_file;

#[doc(hidden)]
pub use kernel::bench as kernel_bench;
