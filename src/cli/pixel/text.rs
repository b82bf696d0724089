//! Two trees of rays in words.

use super::number::{in_ulps, shortest, significant};
use crate::film::SamplePattern;
use crate::measure::{HitDecision, Match, Quantity, Reading, Row, TreeComparison};
use crate::ray_tree::{PixelTree, Shadow};
use crate::rays::RayCounts;
use crate::rays::RayKind;
use crate::scene::{Rgb, Scene};

/// Deeper rays are indented as these are, so that lines stay on the screen; their headings tell the depth.
const DEEPEST_INDENT: u32 = 8;

/// All rows, each with what differs marked.
pub(super) fn rows(comparison: &TreeComparison, scene: &Scene) -> String {
    let mut text = String::new();
    for (index, row) in comparison.rows.iter().enumerate() {
        if (row.quantity, row.ray) == (Quantity::Ray, RayKind::Primary) || row.sample.is_none() {
            text += &heading(row, scene);
        }
        let mut marks = String::new();
        if comparison.first_difference == Some(index) {
            marks += "  ◀ first difference";
        }
        if comparison.parting == Some(index) {
            marks += "  ◀ the trees part here";
        }
        text += &lines(row, &marks);
        if let (Quantity::LocalLight, Some(why)) = (row.quantity, childless(comparison, index, scene)) {
            text += &format!("{}{why}\n", indent(row.depth + 1));
        }
    }
    text
}

/// Of a sample, or of the pixel.
fn heading(row: &Row, scene: &Scene) -> String {
    let count = SamplePattern::new(&scene.render).count();
    match row.sample {
        None => "\npixel\n".to_owned(),
        Some(_) if count == 1 => "\n".to_owned(),
        Some(sample) => format!("\nsample {sample} of 0 to {}\n", count - 1),
    }
}

/// A row in one line where both agree or only one has it, else in two.
fn lines(row: &Row, marks: &str) -> String {
    if row.quantity == Quantity::Ray {
        return format!("{}{}{marks}\n", indent(row.depth), ray(row));
    }
    let label = format!("{}{:<12}", indent(row.depth + 1), label(row.quantity));
    let line = |kind: &str, reading: &Reading| format!("{label}{kind}  {}", words(reading, Digits::Columns));
    match (&row.reference, &row.engine, row.r#match) {
        (Some(_), Some(engine), Match::Same) => format!("{label}{}\n", words(engine, Digits::Few)),
        (Some(reference), Some(engine), how) => {
            let blank = " ".repeat(label.chars().count());
            let ulps = match how {
                Match::Off { ulps } => format!("  {}", in_ulps(ulps)),
                _ => String::new(),
            };
            format!(
                "{}\n{blank}f32  {}{ulps}{marks}\n",
                line("f64", reference),
                words(engine, Digits::Columns)
            )
        }
        (Some(reference), None, _) => line("f64", reference) + "\n",
        (None, Some(engine), _) => line("f32", engine) + "\n",
        (None, None, _) => String::new(),
    }
}

fn indent(depth: u32) -> String {
    "  ".repeat(depth.min(DEEPEST_INDENT) as usize)
}

fn ray(row: &Row) -> String {
    let alone = match (row.reference, row.engine) {
        (Some(Reading::Traced(true)), Some(Reading::Traced(false))) => ", of the reference alone",
        (Some(Reading::Traced(false)), Some(Reading::Traced(true))) => ", of the engine alone",
        _ => "",
    };
    match row.ray {
        RayKind::Primary => format!("primary ray{alone}"),
        RayKind::Reflect | RayKind::Refract | RayKind::Shadow => {
            format!("{} ray, depth {}{alone}", kind(row.ray), row.depth)
        }
    }
}

fn kind(ray: RayKind) -> &'static str {
    match ray {
        RayKind::Primary => "primary",
        RayKind::Reflect => "reflected",
        RayKind::Refract => "refracted",
        RayKind::Shadow => "shadow",
    }
}

fn label(quantity: Quantity) -> String {
    let label = match quantity {
        Quantity::Ray => "ray",
        Quantity::Origin => "origin",
        Quantity::Direction => "direction",
        Quantity::Weight => "weight",
        Quantity::Hit => "hits",
        Quantity::T => "t",
        Quantity::Point => "point",
        Quantity::GeometricNormal => "normal",
        Quantity::ShadingNormal => "shading n.",
        Quantity::Attenuation => "attenuation",
        Quantity::Light(light) => return format!("light {light}"),
        Quantity::LightAdds(_) => "  adds",
        Quantity::LocalLight => "local light",
        Quantity::Colour | Quantity::PixelColour => "colour",
    };
    label.to_owned()
}

/// How numbers are written.
#[derive(Clone, Copy)]
enum Digits {
    /// As few as tell one f32 from another.
    Few,
    /// In columns, to be compared with the line above or below.
    Columns,
}

fn words(reading: &Reading, digits: Digits) -> String {
    let number = |value: f64| match digits {
        Digits::Few => shortest(value),
        Digits::Columns => format!("{:<14}", significant(value)),
    };
    let text = match *reading {
        Reading::Vector(vector) => vector.map(number).join(" "),
        Reading::Number(value) => number(value),
        Reading::Hit(None) => "nothing: the background".to_owned(),
        Reading::Hit(Some(hit)) => format!("{} {}, {}", hit.kind.name(), hit.primitive.0, way(hit)),
        Reading::Light(Shadow::NotTraced) => {
            "not traced: behind the surface, or it could add nothing".to_owned()
        }
        Reading::Light(shadow) => shadow_word(shadow).to_owned(),
        Reading::Traced(true) => "traced".to_owned(),
        Reading::Traced(false) => "not traced".to_owned(),
    };
    text.trim_end().to_owned()
}

/// Why a surface that mirrors or refracts has no children in the engine's tree, if the limit of depth is why.
fn childless(comparison: &TreeComparison, index: usize, scene: &Scene) -> Option<String> {
    let row = &comparison.rows[index];
    if row.depth < scene.render.max_depth {
        return None;
    }
    let hit = comparison.rows[..index].iter().rev().find(|row| row.quantity == Quantity::Hit)?;
    let Some(Reading::Hit(Some(HitDecision { material, .. }))) = hit.engine else { return None };
    let material = scene.materials.get(material.0 as usize)?;
    let sends_on = material.mirror != Rgb::ZERO || material.dielectric.is_some();
    sends_on.then(|| format!("no further rays: max_depth is {}", scene.render.max_depth))
}

/// How many rays there were.
pub(super) fn rays(trees: [&PixelTree; 2]) -> String {
    let [reference, engine] = trees.map(PixelTree::rays);
    let counted = |rays: RayCounts| {
        format!(
            "{} primary, {} shadow, {} reflected, {} refracted",
            rays.primary, rays.shadow, rays.reflect, rays.refract
        )
    };
    match reference == engine {
        true => format!("rays: {}", counted(reference)),
        false => format!("rays: f64 {}; f32 {}", counted(reference), counted(engine)),
    }
}

/// In a line, whether the trees are the same, or where and how they part.
pub(super) fn verdict(comparison: &TreeComparison) -> String {
    let colours = colours(comparison);
    match comparison.parting.and_then(|index| comparison.rows.get(index)) {
        None => format!("same tree; {colours}"),
        Some(row) => format!("the trees part {}: {}; {colours}", place(comparison, row), parting(row)),
    }
}

fn colours(comparison: &TreeComparison) -> String {
    let pixel = comparison.rows.iter().find(|row| row.quantity == Quantity::PixelColour);
    match pixel.map(|row| (row.r#match, row.reference, row.engine)) {
        Some((Match::Off { .. }, Some(Reading::Vector(reference)), Some(Reading::Vector(engine)))) => {
            let channels = reference.iter().zip(engine).map(|(a, b)| (a - b).abs());
            format!("colours differ by {:.1e}", channels.fold(0.0, f64::max))
        }
        _ => "colours agree to f32".to_owned(),
    }
}

fn place(comparison: &TreeComparison, row: &Row) -> String {
    let has_samples = comparison.rows.iter().any(|row| row.sample > Some(0));
    match row.sample.filter(|_| has_samples) {
        Some(sample) => format!("in sample {sample} at depth {}", row.depth),
        None => format!("at depth {}", row.depth),
    }
}

/// What the engine decided otherwise.
fn parting(row: &Row) -> String {
    let ray = kind(row.ray);
    match (row.reference, row.engine) {
        (Some(Reading::Hit(reference)), Some(Reading::Hit(engine))) => other_hit(ray, reference, engine),
        (Some(Reading::Light(reference)), Some(Reading::Light(engine))) => {
            let light = label(row.quantity);
            format!("{light} is {} instead of {}", shadow_word(engine), shadow_word(reference))
        }
        (_, Some(Reading::Traced(true))) => format!("the engine traces a {ray} ray, the reference none"),
        _ => format!("the reference traces a {ray} ray, the engine none"),
    }
}

fn other_hit(ray: &str, reference: Option<HitDecision>, engine: Option<HitDecision>) -> String {
    let name = |hit: HitDecision| format!("{} {}", hit.kind.name(), hit.primitive.0);
    match (reference, engine) {
        (Some(reference), Some(engine)) if reference.primitive == engine.primitive => {
            format!("the {ray} ray is {} {} instead of {} it", way(engine), name(engine), way(reference))
        }
        _ => {
            let name = |hit: Option<HitDecision>| hit.map_or("nothing".to_owned(), name);
            format!("the {ray} ray hits {} instead of {}", name(engine), name(reference))
        }
    }
}

fn way(hit: HitDecision) -> &'static str {
    if hit.entering { "entering" } else { "leaving" }
}

fn shadow_word(shadow: Shadow) -> &'static str {
    match shadow {
        Shadow::Visible => "visible",
        Shadow::Hidden => "hidden",
        Shadow::NotTraced => "not traced",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ray_tree::{PrimitiveKind, RayTree, TreeHit, TreeLight};
    use crate::scene::{
        Camera, Geometry, ImageSettings, Material, MaterialId, PrimitiveId, Projection, RenderSettings,
    };
    use glam::Vec3;

    fn empty_scene() -> Scene {
        Scene {
            image: ImageSettings::default(),
            render: RenderSettings::default(),
            camera: Camera {
                eye: Vec3::Z,
                target: Vec3::ZERO,
                up: Vec3::Y,
                projection: Projection::OrthographicHeight { height: 1.0 },
            },
            ambient: Rgb::ZERO,
            lights: Vec::new(),
            materials: vec![Material { mirror: Rgb::ONE, ..Material::default() }],
            geometry: Geometry::default(),
        }
    }

    fn missing(x: f64) -> RayTree {
        RayTree {
            origin: [x, 0.0, 1.0],
            direction: [0.0, 0.0, -1.0],
            weight: [1.0; 3],
            hit: None,
            reflect: None,
            refract: None,
            colour: [0.5; 3],
        }
    }

    fn hitting(x: f64) -> RayTree {
        let hit = TreeHit {
            kind: PrimitiveKind::Triangle,
            primitive: PrimitiveId(17),
            material: MaterialId(0),
            entering: false,
            t: 1.0,
            point: [x, 0.0, 0.0],
            geometric_normal: [0.0, 0.0, 1.0],
            shading_normal: [0.0, 0.0, 1.0],
            attenuation: [1.0; 3],
            lights: vec![TreeLight { shadow: Shadow::Hidden, adds: [0.0; 3] }],
            local_light: [0.0; 3],
        };
        RayTree { hit: Some(hit), colour: [0.25; 3], ..missing(x) }
    }

    fn compared(reference: RayTree, engine: RayTree) -> TreeComparison {
        let [reference, engine] =
            [reference, engine].map(|ray| PixelTree { colour: ray.colour, samples: vec![ray] });
        TreeComparison::new(&reference, &engine)
    }

    #[test]
    fn what_differs_first_and_where_the_trees_part_is_marked_once_each() {
        let comparison = compared(missing(1.0 / 3.0), hitting(0.5));
        let mut scene = empty_scene();
        scene.render.max_depth = 0;
        let expected = "
primary ray
  origin      f64   0.333333333    0              1.00000000
              f32   0.500000000    0              1.00000000  1.4e6 ulp  ◀ first difference
  direction   0 0 -1
  weight      1 1 1
  hits        f64  nothing: the background
              f32  triangle 17, leaving  ◀ the trees part here
  t           f32   1.00000000
  point       f32   0.500000000    0              0
  normal      f32   0              0              1.00000000
  light 0     f32  hidden
  local light f32   0              0              0
  no further rays: max_depth is 0
  colour      f64   0.500000000    0.500000000    0.500000000
              f32   0.250000000    0.250000000    0.250000000  4.2e6 ulp

pixel
  colour      f64   0.500000000    0.500000000    0.500000000
              f32   0.250000000    0.250000000    0.250000000  4.2e6 ulp
";
        assert_eq!(rows(&comparison, &scene), expected);
    }

    #[test]
    fn the_verdict_says_what_was_decided_otherwise() {
        let with = |reflect: Option<RayTree>| RayTree { reflect: reflect.map(Box::new), ..hitting(0.0) };
        let differently = |change: fn(&mut TreeHit)| {
            let mut ray = hitting(0.0);
            ray.hit.as_mut().map(change).unwrap();
            ray
        };
        let agree = "colours agree to f32";
        for (reference, engine, expected) in [
            (missing(0.0), missing(0.0), format!("same tree; {agree}")),
            (
                missing(0.0),
                RayTree { colour: [0.5, 0.5, 0.625], ..missing(0.0) },
                "same tree; colours differ by 1.2e-1".to_owned(),
            ),
            (
                with(Some(missing(0.0))),
                with(Some(hitting(0.0))),
                format!(
                    "the trees part at depth 1: the reflected ray hits triangle 17 instead of nothing; {agree}"
                ),
            ),
            (
                with(Some(missing(0.0))),
                with(None),
                format!(
                    "the trees part at depth 1: the reference traces a reflected ray, the engine none; {agree}"
                ),
            ),
            (
                hitting(0.0),
                differently(|hit| hit.entering = true),
                format!(
                    "the trees part at depth 0: the primary ray is entering triangle 17 instead of leaving it; {agree}"
                ),
            ),
            (
                hitting(0.0),
                differently(|hit| hit.lights[0].shadow = Shadow::NotTraced),
                format!("the trees part at depth 0: light 0 is not traced instead of hidden; {agree}"),
            ),
        ] {
            assert_eq!(verdict(&compared(reference, engine)), expected);
        }
    }
}
