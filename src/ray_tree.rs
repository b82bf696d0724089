//! The tree of rays of one pixel, with all that every ray met: what both engines can say of how they came to a colour.
//!
//! Positions and lengths are in world space and directions have the world's axes, whatever the engine keeps them in;
//! colours are linear RGB. An f32 engine's numbers are widened, which changes none.

use crate::rays::RayCounts;
use crate::scene::{MaterialId, PrimitiveId};
use crate::signature;
use serde::Serialize;
use thiserror::Error;

pub use crate::signature::Shadow;

/// Everything that was traced for a pixel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PixelTree {
    /// The mean of what the samples see.
    pub colour: [f64; 3],
    /// A primary ray a sample, in order.
    pub samples: Vec<RayTree>,
}

/// A ray that was traced, and its descendants. A generation is one level of JSON, so that readers with a limit of 128
/// levels can read the deepest tree.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RayTree {
    /// Start.
    pub origin: [f64; 3],
    /// Unit length, to the rounding of what it is kept in.
    pub direction: [f64; 3],
    /// Share of what the ray sees that reaches the eye.
    pub weight: [f64; 3],
    /// Where it ends; none on a miss.
    pub hit: Option<TreeHit>,
    /// The mirrored ray, if one was traced.
    pub reflect: Option<Box<RayTree>>,
    /// The refracted ray, if one was traced.
    pub refract: Option<Box<RayTree>>,
    /// What arrives along the ray.
    pub colour: [f64; 3],
}

/// Where a ray meets a surface, and what light does there.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TreeHit {
    /// What is hit.
    pub kind: PrimitiveKind,
    /// Which one.
    pub primitive: PrimitiveId,
    /// Its index among the scene's materials.
    pub material: MaterialId,
    /// Whether the ray comes from outside.
    pub entering: bool,
    /// Along the ray, in units of its direction.
    pub t: f64,
    /// The point on the surface.
    pub point: [f64; 3],
    /// n_g, unit, on the side that the ray comes from.
    pub geometric_normal: [f64; 3],
    /// n_s, unit, on the side that the ray comes from.
    pub shading_normal: [f64; 3],
    /// Beer's law: of all light that leaves the surface along the ray.
    pub attenuation: [f64; 3],
    /// In file order.
    pub lights: Vec<TreeLight>,
    /// Ambient light and what the visible lights add.
    pub local_light: [f64; 3],
}

/// What a light does at a hit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TreeLight {
    /// Whether it is seen.
    pub shadow: Shadow,
    /// What it adds to the local light; 0 unless it is visible.
    pub adds: [f64; 3],
}

/// A kind of primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum PrimitiveKind {
    /// A sphere.
    Sphere,
    /// A triangle.
    Triangle,
    /// A polygon.
    Polygon,
}

impl PrimitiveKind {
    /// The word for it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Sphere => "sphere",
            Self::Triangle => "triangle",
            Self::Polygon => "polygon",
        }
    }
}

/// A tree that takes too much memory, and more than anybody reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error(
    "the pixel's tree has {entries} entries, one a ray and one for each light of each ray, and at most {} are kept; fewer \
     --samples or a smaller --max-depth make it smaller",
    PixelTree::MOST_ENTRIES
)]
pub struct TreeTooLarge {
    /// What it would have.
    pub entries: u64,
}

impl PixelTree {
    /// Rays, and lights of each ray, of the largest tree that is kept: some 100 MB.
    pub const MOST_ENTRIES: u64 = 1 << 18;

    /// Whether a tree of these rays can be kept.
    pub(crate) fn check_size(rays: &RayCounts, lights: usize) -> Result<(), TreeTooLarge> {
        let entries = (rays.primary + rays.reflect + rays.refract).saturating_mul(1 + lights as u64);
        if entries > Self::MOST_ENTRIES { Err(TreeTooLarge { entries }) } else { Ok(()) }
    }

    /// How many rays of each kind it has.
    #[must_use]
    pub fn rays(&self) -> RayCounts {
        let mut counts = RayCounts { primary: self.samples.len() as u64, ..RayCounts::default() };
        self.samples.iter().for_each(|ray| ray.count_into(&mut counts));
        counts
    }

    /// The same number for trees whose rays hit the same primitives and whose hits see the same lights: what a render's
    /// [`PixelRecord`](crate::render::PixelRecord) has.
    #[must_use]
    pub fn signature(&self) -> u64 {
        self.samples.iter().fold(0, |samples, ray| signature::with_sample(samples, ray.signature()))
    }
}

impl RayTree {
    /// Counts the rays that this one gave rise to.
    fn count_into(&self, counts: &mut RayCounts) {
        let lights = self.hit.iter().flat_map(|hit| &hit.lights);
        counts.shadow += lights.filter(|light| light.shadow != Shadow::NotTraced).count() as u64;
        counts.reflect += u64::from(self.reflect.is_some());
        counts.refract += u64::from(self.refract.is_some());
        for child in [&self.reflect, &self.refract].into_iter().flatten() {
            child.count_into(counts);
        }
    }

    fn signature(&self) -> u64 {
        let Some(hit) = &self.hit else { return signature::miss() };
        let lights = hit.lights.iter().fold(0, |lights, light| signature::with_light(lights, light.shadow));
        let [reflected, refracted] =
            [&self.reflect, &self.refract].map(|child| child.as_ref().map_or(0, |child| child.signature()));
        signature::hit(hit.primitive, lights, reflected, refracted)
    }
}
