//! The rung of `min_weight`: what it buys not to trace rays that carry little light, and what that costs.

use super::table::{Table, or_none, short};
use super::{RungOptions, median, rendered, shrunk};
use crate::film::Image;
use crate::measure::{Difference, Distance};
use crate::prepare::Plan;
use crate::rays::RayCounts;
use crate::render::{Engine, RenderError, Rendered};
use crate::scene::Scene;
use serde::Serialize;
use std::fmt::{self, Display, Formatter};

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
    /// To trace all rays, round by round.
    pub seconds: Vec<f64>,
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
        for round in 0..options.rounds() {
            options.step("frames without weak rays", 1 + round, steps)?;
            for (place, limit) in LIMITS.into_iter().enumerate() {
                scene.render.min_weight = limit;
                let frame = rendered(&scene, Engine::wavefront(options.width), options)?;
                if frames.len() == place {
                    frames.push(MinWeightFrame::new(limit, &frame, &truth));
                }
                frames[place].seconds.push(frame.trace_seconds);
            }
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
            seconds: Vec::new(),
            rays: frame.rays,
            rms: difference.map_or(f64::INFINITY, |difference| difference.rms),
            pixels_over: difference.map_or(0, |difference| difference.pixels_over),
        }
    }
}

impl Display for MinWeightRung {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let [width, height] = self.size;
        writeln!(f, "without weak rays, {width} x {height} pixels, one sample each")?;
        let mut table = Table::new(&[
            "min_weight",
            "seconds",
            "over 0",
            "Mrays",
            "RMSE",
            "pixels over 1/255",
            "% of pixels",
        ]);
        let first = self.frames.first().and_then(|frame| median(&frame.seconds));
        for frame in &self.frames {
            let seconds = median(&frame.seconds);
            let speedup = first.zip(seconds).filter(|(_, seconds)| *seconds > 0.0);
            table.add([
                match frame.min_weight {
                    0.0 => "0".to_owned(),
                    limit => format!("1/{}", 1.0 / limit),
                },
                or_none(seconds, short),
                or_none(speedup.map(|(first, seconds)| first / seconds), short),
                short(frame.rays.total() as f64 / 1e6),
                short(frame.rms),
                frame.pixels_over.to_string(),
                short(100.0 * frame.pixels_over as f64 / (f64::from(width) * f64::from(height))),
            ]);
        }
        write!(f, "{table}")
    }
}
