//! Rays against boxes, spheres, triangles and polygons in f32 lanes, a formula a file.
//!
//! A kernel does not know what its lanes are: one ray against several primitives, or several rays against one. Both do the
//! same arithmetic for each pair, so the hits are the same bits however rays are grouped.
//!
//! What a hit looks like — its exact place, its normal — is not computed here but once a ray, in `wavefront::surface`. What the engine does not
//! use, but is measured against, is in `textbook`.

pub mod bench;
pub(crate) mod bounds;
pub(crate) mod polygon;
mod ray_space;
pub(crate) mod sphere;
#[cfg(test)]
pub(crate) mod tests;
pub(crate) mod textbook;
pub(crate) mod triangle;

pub(crate) use ray_space::{RaySpace, Seen, axes_along, axes_from, cross, crosses, unclear_area};

/// Rounding of f32: half the distance from 1 to the next number.
pub(crate) const UNIT_ROUNDOFF: f32 = 1.0 / (1 << 24) as f32;
