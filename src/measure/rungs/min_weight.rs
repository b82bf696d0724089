//! The rung of `min_weight`: what it buys not to trace rays that carry little light, and what that costs.

use super::{RungOptions, rendered, shrunk};
use crate::film::Image;
use crate::measure::{Better, Difference, Distance, Spread};
use crate::prepare::Plan;
use crate::rays::RayCounts;
use crate::render::{Engine, RenderError, Rendered};
use crate::scene::Scene;
use serde::Serialize;

/// Frames of one scene, each without the rays whose weight is below a limit.
#[derive(Clone, Debug, Serialize)]
pub struct MinWeightRung {
    /// Columns and rows: the scene's picture, made smaller if it has very many pixels.
    pub size: [u32; 2],
    /// Limit by limit, from none.
    pub frames: Vec<MinWeightFrame>,
}

/// A frame without the rays whose weight is below a limit.
#[derive(Clone, Debug, Serialize)]
pub struct MinWeightFrame {
    /// The limit.
    pub min_weight: f32,
    /// To trace all rays; of the rounds.
    pub seconds: Option<Spread>,
    /// Rays traced.
    pub rays: RayCounts,
    /// Root of the mean of the squared differences of all channels from the reference's picture with all rays, linear.
    pub rms: f64,
    /// Pixels with a channel that differs by more than [`Distance::LIMIT`].
    pub pixels_over: u64,
}

/// Limits that are tried: none, and powers of two around those that scenes ask for.
const LIMITS: [f32; 6] = [0.0, 1.0 / 4096.0, 1.0 / 1024.0, 1.0 / 256.0, 1.0 / 64.0, 1.0 / 16.0];

/// Pixels of the frame, at most. With its samples, one a pixel, this bounds what the reference takes for trees of rays that
/// only their depth ends.
const PIXELS: u32 = 1 << 18;

impl MinWeightRung {
    /// Renders a scene at each limit by the wavefront engine, in turn, and once by the reference, with one sample a pixel; none for a scene in which
    /// nothing is reflected or refracted.
    ///
    /// # Errors
    /// What keeps a scene from being rendered.
    pub fn measure(scene: &Scene, options: &RungOptions<'_>) -> Result<Option<Self>, RenderError> {
        let plan = Plan::new(scene);
        if !plan.reflection && !plan.refraction {
            return Ok(None);
        }
        let steps = 1 + options.rounds();
        options.step("all rays by the reference", 0, steps)?;
        let mut scene = shrunk(scene, PIXELS);
        (scene.render.samples, scene.render.min_weight) = (1, 0.0);
        let truth = rendered(&scene, Engine::Reference, options)?.image;
        let mut frames: Vec<MinWeightFrame> = Vec::new();
        let mut seconds = LIMITS.map(|_| Vec::new());
        for round in 0..options.rounds() {
            options.step("frames without weak rays", 1 + round, steps)?;
            for (place, limit) in LIMITS.into_iter().enumerate() {
                scene.render.min_weight = limit;
                let frame = rendered(&scene, Engine::wavefront(options.width), options)?;
                if frames.len() == place {
                    frames.push(MinWeightFrame::new(limit, &frame, &truth));
                }
                seconds[place].push(frame.trace_seconds);
            }
        }
        for (frame, seconds) in frames.iter_mut().zip(seconds) {
            frame.seconds = Spread::of(seconds, Better::Less);
        }
        Ok(Some(Self { size: [scene.image.width, scene.image.height], frames }))
    }
}

impl MinWeightFrame {
    fn new(min_weight: f32, frame: &Rendered, truth: &Image) -> Self {
        // Both have the scene's size.
        let difference = Difference::between(truth, &frame.image, Distance::LIMIT);
        Self {
            min_weight,
            seconds: None,
            rays: frame.rays,
            rms: difference.map_or(f64::INFINITY, |difference| difference.rms),
            pixels_over: difference.map_or(0, |difference| difference.pixels_over),
        }
    }
}
