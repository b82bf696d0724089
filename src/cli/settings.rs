//! The options that take the place of a scene's settings, which several commands have.

use crate::scene::{ImageSettings, RenderSettings, Sampling, Scene};
use clap::ValueEnum;

#[derive(Debug, clap::Args)]
pub(super) struct SceneSettings {
    /// Size of the image, pixels [default: the scene's]
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<(u32, u32)>,
    /// Where the samples of a pixel lie [default: the scene's]
    #[arg(long, value_enum)]
    sampling: Option<SamplingName>,
    /// n × n samples a pixel, 1–64 [default: the scene's]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(RenderSettings::MAX_SAMPLES)))]
    samples: Option<u32>,
    /// What random samples start from [default: the scene's]
    #[arg(long, value_name = "N")]
    seed: Option<u32>,
    /// The deepest ray, 0–64; primary rays are depth 0 [default: the scene's]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(..=i64::from(RenderSettings::MAX_DEPTH)))]
    max_depth: Option<u32>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum SamplingName {
    Regular,
    Random,
    Jittered,
}

fn size(word: &str) -> Result<(u32, u32), String> {
    let sides = word.split_once(['x', 'X']).and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    let (width, height) = sides.ok_or("a size is written like 800x600")?;
    ImageSettings::check_size(width, height)
}

impl SceneSettings {
    /// The command line's settings take the place of the scene's.
    pub(super) fn apply(&self, scene: &mut Scene) {
        let (image, render) = (&mut scene.image, &mut scene.render);
        if let Some((width, height)) = self.size {
            (image.width, image.height) = (width, height);
        }
        if let Some(sampling) = self.sampling {
            render.sampling = match sampling {
                SamplingName::Regular => Sampling::Regular,
                SamplingName::Random => Sampling::Random,
                SamplingName::Jittered => Sampling::Jittered,
            };
        }
        render.samples = self.samples.unwrap_or(render.samples);
        render.seed = self.seed.unwrap_or(render.seed);
        render.max_depth = self.max_depth.unwrap_or(render.max_depth);
    }
}
