//! Haines' Neutral File Format, 3.9, as its SPD scenes use it. Read by words, not by lines: numbers may wrap.

use super::error::{InputError, Warnings};
use super::framing::framed;
use super::number::{rounded, rounded_3};
use super::suggest::{did_you_mean, listed};
use super::text::Text;
use super::words::{Word, Words};
use crate::scene::{
    Camera, CameraProblem, Dielectric, Fresnel, Geometry, ImageSettings, Light, Material, MaterialId,
    Projection, RenderSettings, Rgb, Scene,
};
use glam::{DVec3, Vec3};
use std::path::Path;

const ENTITIES: [&str; 14] =
    ["v", "from", "at", "up", "angle", "hither", "resolution", "b", "l", "f", "s", "p", "pp", "c"];

/// NFF has no word for it; the format's own tracers stop about here.
const MAX_DEPTH: u32 = 4;

pub(super) fn load(path: &Path, warnings: &mut Warnings) -> Result<Scene, InputError> {
    let text = Text::read_lossy(path)?;
    let mut reader = Reader {
        text: &text,
        words: Words::new(&text),
        warnings,
        image: ImageSettings::default(),
        view: ViewEntities::default(),
        lights: Vec::new(),
        materials: Vec::new(),
        geometry: Geometry::default(),
    };
    while let Some(entity) = reader.words.next() {
        reader.entity(entity)?;
    }
    reader.into_scene()
}

struct Reader<'a> {
    text: &'a Text,
    words: Words<'a>,
    warnings: &'a mut Warnings,
    image: ImageSettings,
    view: ViewEntities,
    /// Position, and colour where one is given.
    lights: Vec<(Vec3, Option<Rgb>)>,
    materials: Vec<Material>,
    geometry: Geometry,
}

/// What follows `v`.
#[derive(Default)]
struct ViewEntities {
    /// Where the view began.
    offset: Option<usize>,
    from: Option<(Vec3, usize)>,
    at: Option<Vec3>,
    up: Option<(Vec3, usize)>,
    angle: Option<(f32, usize)>,
}

impl Reader<'_> {
    fn entity(&mut self, entity: Word<'_>) -> Result<(), InputError> {
        let offset = entity.offset;
        match entity.text {
            "v" => self.view.offset = Some(offset),
            "from" => self.view.from = Some((self.vector("from x y z")?, offset)),
            "at" => self.view.at = Some(self.vector("at x y z")?),
            "up" => self.view.up = Some((self.vector("up x y z")?, offset)),
            "angle" => self.view.angle = Some((self.number("angle in degrees")?, offset)),
            "hither" => drop(self.words.number("hither distance")?),
            "resolution" => {
                let (width, height) =
                    (self.words.count("resolution width")?, self.words.count("resolution height")?);
                let size = ImageSettings::check_size(width, height);
                (self.image.width, self.image.height) =
                    size.map_err(|message| self.text.error(offset, message))?;
            }
            "b" => self.image.background = self.vector("background r g b")?,
            "l" => {
                let position = self.vector("light x y z")?;
                let color = if self.a_number_follows() { Some(self.vector("light r g b")?) } else { None };
                self.lights.push((position, color));
            }
            "f" => self.fill()?,
            "s" => self.sphere(offset)?,
            "p" => self.polygon(offset, false)?,
            "pp" => self.polygon(offset, true)?,
            "c" => {
                return Err(self.text.error(
                    offset,
                    "a cone or cylinder (`c`) cannot be rendered yet; replace it by polygons or leave it out",
                ));
            }
            other => {
                let message = format!(
                    "unknown entity `{}`{}; an NFF file consists of {}",
                    super::number::shortened(other),
                    did_you_mean(other, ENTITIES),
                    listed(ENTITIES)
                );
                return Err(self.text.error(offset, message));
            }
        }
        Ok(())
    }

    fn number(&mut self, what: &str) -> Result<f32, InputError> {
        Ok(rounded(self.words.number(what)?))
    }

    fn vector(&mut self, what: &str) -> Result<Vec3, InputError> {
        Ok(rounded_3(self.words.vector(what)?))
    }

    fn not_negative(&mut self, what: &str) -> Result<f64, InputError> {
        let offset = self.words.peek().map_or(0, |word| word.offset);
        match self.words.number(what)? {
            value if value < 0.0 => Err(self
                .text
                .error(offset, format!("this number is {value}; it must not be negative ({what})"))),
            value => Ok(value),
        }
    }

    fn a_number_follows(&self) -> bool {
        self.words.peek().is_some_and(|word| word.text.parse::<f64>().is_ok())
    }

    fn fill(&mut self) -> Result<(), InputError> {
        let color = DVec3::new(
            self.not_negative("fill r")?,
            self.not_negative("fill g")?,
            self.not_negative("fill b")?,
        );
        let (kd, ks) = (self.not_negative("fill Kd")?, self.not_negative("fill Ks")?);
        let shine = self.not_negative("fill Shine")?;
        let transmittance = self.not_negative("fill T")?;
        let ior = self.not_negative("fill index of refraction")?;
        let dielectric = (transmittance > 0.0).then(|| Dielectric {
            ior: if ior == 0.0 { 1.0 } else { rounded(ior) },
            absorption: Rgb::ZERO,
            transmission: rounded_3(transmittance * color),
            fresnel: Fresnel::Fixed,
        });
        self.materials.push(Material {
            diffuse: rounded_3(kd * color),
            specular: Rgb::splat(rounded(ks)),
            shininess: rounded(shine),
            mirror: Rgb::splat(rounded(ks)),
            dielectric,
            ..Material::default()
        });
        Ok(())
    }

    /// The latest fill.
    fn material(&mut self, offset: usize) -> MaterialId {
        if self.materials.is_empty() {
            self.text.warn(self.warnings, "no fill", offset, || {
                "no fill (`f`) comes before this; it is shown in grey".to_owned()
            });
            self.materials.push(Material::grey());
        }
        MaterialId(u32::try_from(self.materials.len() - 1).unwrap_or(u32::MAX))
    }

    fn sphere(&mut self, offset: usize) -> Result<(), InputError> {
        let (center, radius) = (self.vector("sphere x y z")?, self.number("sphere radius")?);
        if radius < 0.0 {
            self.text.warn(self.warnings, "negative radius", offset, || {
                "a negative radius means a sphere seen from inside only; it is seen from both sides here"
                    .to_owned()
            });
        }
        let material = self.material(offset);
        let added = self.geometry.add_sphere(center, radius.abs(), material);
        added.map_err(|problem| self.text.error(offset, problem.to_string()))
    }

    fn polygon(&mut self, offset: usize, has_normals: bool) -> Result<(), InputError> {
        let count = self.words.count("number of vertices")?;
        let (mut vertices, mut normals) = (Vec::new(), Vec::new());
        for _ in 0..count {
            vertices.push(self.vector("vertex x y z")?);
            if has_normals {
                normals.push(self.vector("normal x y z")?);
            }
        }
        let material = self.material(offset);
        let added = match *vertices {
            [_, _, _] => {
                let add = || {
                    let corners = first_three(self.geometry.add_vertices(vertices)?);
                    let normals = match has_normals {
                        true => Some(first_three(self.geometry.add_normals(normals)?)),
                        false => None,
                    };
                    self.geometry.add_triangle(corners, normals, material)
                };
                add()
            }
            _ => self.geometry.add_polygon(&vertices, has_normals.then_some(&normals), material),
        };
        self.text.added(offset, added, self.warnings)
    }

    fn into_scene(self) -> Result<Scene, InputError> {
        let camera = match self.view.offset.or(self.view.from.map(|(_, offset)| offset)) {
            None => framed(&self.text.path, self.geometry.bounds())?.camera,
            Some(offset) => self.camera(offset)?,
        };
        let grey = 1.0 / (self.lights.len() as f64).sqrt();
        let light = |(position, color): (Vec3, Option<Rgb>)| Light::Point {
            position,
            intensity: color.unwrap_or(rounded_3(DVec3::splat(grey))),
        };
        Ok(Scene {
            image: self.image,
            render: RenderSettings { max_depth: MAX_DEPTH, ..RenderSettings::default() },
            camera,
            ambient: Rgb::ZERO,
            lights: self.lights.into_iter().map(light).collect(),
            materials: self.materials,
            geometry: self.geometry,
        })
    }

    fn camera(&self, offset: usize) -> Result<Camera, InputError> {
        let missing = |name: &str| {
            self.text.error(offset, format!("the view (`v`) lacks `{name}`; it takes from, at, up and angle"))
        };
        let (eye, from_offset) = self.view.from.ok_or_else(|| missing("from"))?;
        let target = self.view.at.ok_or_else(|| missing("at"))?;
        let (up, up_offset) = self.view.up.ok_or_else(|| missing("up"))?;
        let (vertical_degrees, angle_offset) = self.view.angle.ok_or_else(|| missing("angle"))?;
        let projection = Projection::PerspectiveAngle { vertical_degrees };
        let camera = Camera { eye, target, up, projection };
        camera.check().map_err(|problem| {
            let offset = match problem {
                CameraProblem::NoDirection => from_offset,
                CameraProblem::UpAlongView => up_offset,
                _ => angle_offset,
            };
            // NFF has its own words for eye, target and fov.
            let message =
                problem.to_string().replace("eye and target", "from and at").replace("fov", "angle");
            self.text.error(offset, message)
        })?;
        Ok(camera)
    }
}

fn first_three(first: u32) -> [u32; 3] {
    [first, first + 1, first + 2]
}
