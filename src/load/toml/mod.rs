//! The project's own scene format; docs/scenes.md is its specification.

mod camera;
mod material;
mod reader;
mod shapes;

use super::error::{InputError, Warnings};
use super::framing::framed;
use super::text::Text;
use crate::scene::{ImageSettings, Light, RenderSettings, Rgb, Sampling, Scene};
use glam::Vec3;
use reader::Table;
use std::path::Path;
use toml::de::DeTable;

const KEYS: [&str; 10] =
    ["image", "render", "camera", "ambient", "light", "material", "sphere", "triangle", "polygon", "mesh"];

pub(super) fn load(path: &Path, warnings: &mut Warnings) -> Result<Scene, InputError> {
    let text = Text::read(path)?;
    let document = DeTable::parse(&text.content).map_err(|error| {
        let offset = error.span().map_or(0, |span| span.start);
        text.error(offset, format!("not valid TOML: {}", error.message()))
    })?;
    let root = Table::new(&text, "a scene", 0, document.get_ref(), &KEYS)?;

    let image = image(&root)?;
    let render = render(&root)?;
    let ambient = ambient(&root)?;
    let lights = lights(&root)?;
    let mut materials = material::read(&root, warnings)?;
    let geometry = shapes::read(&root, &mut materials, warnings)?;
    let camera = match root.get("camera") {
        Some(camera) => camera::read(&camera)?,
        None => framed(path, geometry.bounds())?.camera,
    };
    Ok(Scene { image, render, camera, ambient, lights, materials: materials.list, geometry })
}

fn image(root: &Table<'_>) -> Result<ImageSettings, InputError> {
    let mut image = ImageSettings::default();
    let Some(value) = root.get("image") else { return Ok(image) };
    let table = value.table("[image]", &["size", "background"])?;
    if let Some(size) = table.get("size") {
        let sides = size.list("a list of two whole numbers, [width, height]")?;
        let [width, height] = sides.as_slice() else {
            return Err(
                size.error(format!("`size` must be [width, height]; this list has {} items", sides.len()))
            );
        };
        let (width, height) =
            (width.integer(1..=u64::from(u32::MAX))?, height.integer(1..=u64::from(u32::MAX))?);
        (image.width, image.height) =
            ImageSettings::check_size(width, height).map_err(|message| size.error(message))?;
    }
    if let Some(background) = table.get("background") {
        image.background = background.color()?;
    }
    Ok(image)
}

fn render(root: &Table<'_>) -> Result<RenderSettings, InputError> {
    let mut render = RenderSettings::default();
    let Some(value) = root.get("render") else { return Ok(render) };
    let table = value.table("[render]", &["max_depth", "min_weight", "sampling", "samples", "seed"])?;
    let integer = |key: &str, low: u32, high: u32, default: u32| match table.get(key) {
        None => Ok(default),
        Some(value) => {
            let integer = value.integer(u64::from(low)..=u64::from(high))?;
            Ok(u32::try_from(integer).unwrap_or(high))
        }
    };
    render.max_depth = integer("max_depth", 0, RenderSettings::MAX_DEPTH, render.max_depth)?;
    render.samples = integer("samples", 1, RenderSettings::MAX_SAMPLES, render.samples)?;
    render.seed = integer("seed", 0, u32::MAX, render.seed)?;
    if let Some(value) = table.get("min_weight") {
        render.min_weight = value.not_negative()?;
    }
    if let Some(value) = table.get("sampling") {
        render.sampling = value.one_of(&Sampling::NAMES)?;
    }
    Ok(render)
}

fn ambient(root: &Table<'_>) -> Result<Rgb, InputError> {
    let Some(value) = root.get("ambient") else { return Ok(Rgb::ZERO) };
    let table = value.table("[ambient]", &["intensity"])?;
    table.get("intensity").map_or(Ok(Rgb::ZERO), |intensity| intensity.color())
}

fn lights(root: &Table<'_>) -> Result<Vec<Light>, InputError> {
    let Some(value) = root.get("light") else { return Ok(Vec::new()) };
    let tables = value.tables("[[light]]", &["position", "direction", "intensity"])?;
    tables.iter().map(light).collect()
}

fn light(table: &Table<'_>) -> Result<Light, InputError> {
    let intensity = table.get("intensity").map_or(Ok(Rgb::ONE), |value| value.color())?;
    match (table.get("position"), table.get("direction")) {
        (Some(position), None) => Ok(Light::Point { position: position.vector()?, intensity }),
        (None, Some(value)) => match value.vector()? {
            Vec3::ZERO => {
                Err(value.error("a light's `direction` must not be zero; give the way its light travels"))
            }
            direction => Ok(Light::Directional { direction, intensity }),
        },
        (None, None) => Err(table.error("a [[light]] needs a `position` or a `direction`")),
        (Some(_), Some(value)) => {
            Err(value.error("a [[light]] has a `position` or a `direction`, not both; remove one"))
        }
    }
}
