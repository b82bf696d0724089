//! Numbers that belong to the picture as a whole.

use super::Rgb;

/// The largest magnitude a number of a scene may have: its square, and the sum of three squares, stay finite in f32.
pub const MAX_COORDINATE: f64 = 1e18;

/// The largest image, in pixels.
pub const MAX_PIXELS: u64 = 1 << 31;

/// Size of the picture and what lies behind everything.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageSettings {
    /// Pixels from left to right, nx.
    pub width: u32,
    /// Pixels from top to bottom, ny.
    pub height: u32,
    /// What a ray returns that hits nothing.
    pub background: Rgb,
}

impl Default for ImageSettings {
    fn default() -> Self {
        Self { width: 512, height: 512, background: Rgb::ZERO }
    }
}

impl ImageSettings {
    /// Says what is wrong with a size, if anything is.
    ///
    /// # Errors
    /// An image of no pixels, or of more than [`MAX_PIXELS`].
    pub fn check_size(width: u64, height: u64) -> Result<(u32, u32), String> {
        match (u32::try_from(width), u32::try_from(height)) {
            (Ok(w), Ok(h)) if w > 0 && h > 0 && u64::from(w) * u64::from(h) <= MAX_PIXELS => Ok((w, h)),
            _ if width == 0 || height == 0 => {
                Err(format!("an image of {width} x {height} has no pixels; both numbers must be at least 1"))
            }
            _ => Err(format!("an image of {width} x {height} has more than 2^31 pixels; make it smaller")),
        }
    }
}

/// How rays are spread over a pixel and how deep they are followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RenderSettings {
    /// Rays deeper than this are not spawned; primary rays are depth 0.
    pub max_depth: u32,
    /// Rays whose weight is below this are not spawned.
    pub min_weight: f32,
    /// Where in the pixel the samples lie.
    pub sampling: Sampling,
    /// n: a pixel has n × n samples.
    pub samples: u32,
    /// What the random numbers start from.
    pub seed: u32,
}

impl RenderSettings {
    /// The deepest `max_depth`.
    pub const MAX_DEPTH: u32 = 64;
    /// The largest n.
    pub const MAX_SAMPLES: u32 = 64;
}

impl Default for RenderSettings {
    fn default() -> Self {
        Self { max_depth: 8, min_weight: 0.0, sampling: Sampling::Regular, samples: 1, seed: 1 }
    }
}

/// Where in a pixel its n × n samples lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sampling {
    /// At the centres of n × n equal cells.
    Regular,
    /// Anywhere, independently.
    Random,
    /// At a random place in each of n × n equal cells.
    Jittered,
}

impl Sampling {
    /// Each with the word that scene files and the command line use.
    pub const NAMES: [(&'static str, Self); 3] =
        [("regular", Self::Regular), ("random", Self::Random), ("jittered", Self::Jittered)];

    /// The word for it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Regular => "regular",
            Self::Random => "random",
            Self::Jittered => "jittered",
        }
    }
}
