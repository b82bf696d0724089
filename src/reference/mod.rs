//! The truth that everything else is checked against: a scalar, recursive f64 ray tracer written from the formulas.
//!
//! Whitted, "An Improved Illumination Model for Shaded Display", 1980, with Blinn-Phong highlights, Schlick's
//! reflectance and Beer's law. It reads the scene and the film's sample positions and shares no arithmetic with any
//! other engine, so that a mistake has to be made twice to go unseen.
//!
//! To judge an engine in single precision, it also says how near such an engine can come ([`Precision::F32Queues`]), where
//! it has to see what the truth is ([`Tracer::primary_hit`]), and whether it decided alike all the way
//! ([`Tracer::signature`]). To find out where it did not, [`Tracer::tree`] shows everything that a pixel's rays met.
//!
//! - `camera`: from a point of the image to a ray
//! - `shape`: where a ray meets a sphere, a triangle or a polygon, and what the surface is like there
//! - `hierarchy`: the same answers without trying every primitive
//! - `certainty`: whether an engine in f32 could honestly see another primitive
//! - `optics`: mirror and refraction directions, and the shares of light that take them
//! - `pair`: questions about one ray and one primitive
//! - `precision`: what rays and hits are kept in, f64 or f32
//! - `query`: questions about single rays
//! - `record`: what is kept of a tree of rays besides its light
//! - `tracer`: the recursion that puts these together

mod camera;
mod certainty;
mod hierarchy;
mod in_plane;
#[cfg(test)]
mod judged;
mod optics;
mod pair;
mod precision;
mod query;
mod ray;
mod record;
mod shape;
mod tracer;

pub use certainty::PrimaryHit;
pub(crate) use pair::PairTruth;
pub use precision::Precision;
pub use query::Met;
pub use tracer::Tracer;
