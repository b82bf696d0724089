//! Haines' Neutral File Format, for what it has words for.

use super::number::{Digits, Triple};
use super::shapes::{Shape, in_order, listed, run};
use crate::scene::{
    Dielectric, Fresnel, Light, MAX_COORDINATE, Material, MaterialId, Projection, RenderSettings, Rgb, Scene,
};
use glam::Vec3;
use std::io::{self, Write};

/// What a loader takes NFF to mean, which has no word for it.
const MAX_DEPTH: u32 = 4;

/// A scene that NFF can say.
pub(super) struct Document<'a> {
    scene: &'a Scene,
    vertical_degrees: f32,
    /// World position and intensity.
    lights: Vec<(Vec3, Rgb)>,
    /// One a material.
    fills: Vec<Fill>,
}

/// `f r g b Kd Ks Shine T ior`.
#[derive(Clone, Copy)]
struct Fill {
    color: Rgb,
    /// Kd.
    diffuse_share: f64,
    /// Ks, also that of the mirrored ray.
    specular: f32,
    shininess: f32,
    /// T; 0 is opaque.
    transmission_share: f64,
    ior: f32,
}

impl<'a> Document<'a> {
    /// # Errors
    /// The first thing that NFF cannot say.
    pub(super) fn new(scene: &'a Scene) -> Result<Self, String> {
        Self::said(scene).map_err(|what| format!("NFF cannot say {what}; write a .toml file"))
    }

    fn said(scene: &'a Scene) -> Result<Self, String> {
        let fills = scene.materials.iter().map(Fill::of).collect::<Result<_, _>>()?;
        check_shapes(scene)?;
        let lights = scene.lights.iter().map(point_light).collect::<Result<_, _>>()?;
        if scene.ambient != Rgb::ZERO {
            return Err("ambient light".to_owned());
        }
        let Projection::PerspectiveAngle { vertical_degrees } = scene.camera.projection else {
            return Err("a camera without an angle of view".to_owned());
        };
        check_settings(&scene.render)?;
        Ok(Self { scene, vertical_degrees, lights, fills })
    }

    pub(super) fn write(&self, writer: &mut impl Write) -> io::Result<()> {
        let Scene { image, camera, .. } = self.scene;
        writeln!(writer, "b {}\nv", words(image.background))?;
        writeln!(writer, "from {}\nat {}", words(camera.eye), words(camera.target))?;
        writeln!(writer, "up {}\nangle {}", words(camera.up), Digits(self.vertical_degrees))?;
        writeln!(writer, "hither 0\nresolution {} {}", image.width, image.height)?;
        for &(position, intensity) in &self.lights {
            writeln!(writer, "l {} {}", words(position), words(intensity))?;
        }
        self.write_shapes(writer)
    }

    /// A shape is made of the latest fill. What was left out has the one that it comes after, or the first.
    fn write_shapes(&self, writer: &mut impl Write) -> io::Result<()> {
        let mut fills = self.fills.iter();
        let mut fill_in = |material: MaterialId, writer: &mut _| {
            let written = self.fills.len() - fills.len();
            let missing = (material.0 as usize + 1).saturating_sub(written);
            fills.by_ref().take(missing).try_for_each(|fill| fill.write(writer))
        };
        for shape in in_order(&self.scene.geometry) {
            fill_in(shape.material().unwrap_or(MaterialId(0)), writer)?;
            self.write_shape(shape, writer)?;
        }
        fill_in(MaterialId(u32::MAX), writer)
    }

    fn write_shape(&self, shape: Shape<'_>, writer: &mut impl Write) -> io::Result<()> {
        let geometry = &self.scene.geometry;
        match shape {
            Shape::Sphere(sphere) => writeln!(writer, "s {} {}", words(sphere.center), Digits(sphere.radius)),
            Shape::Triangle(triangle) => {
                let normals = triangle.normals.map(|normals| listed(&geometry.normals, normals));
                let normals = normals.as_ref().map(<[Vec3; 3]>::as_slice);
                write_polygon(&listed(&geometry.vertices, triangle.vertices), normals, writer)
            }
            Shape::Polygon(polygon) => {
                let normals = polygon.normals.clone().map(|normals| run(&geometry.normals, normals));
                write_polygon(run(&geometry.vertices, polygon.vertices.clone()), normals, writer)
            }
            Shape::LeftOut => write_polygon(&[Vec3::ZERO; 3], None, writer),
        }
    }
}

fn words(vector: Vec3) -> Triple<'static> {
    Triple(vector, " ")
}

fn write_polygon(vertices: &[Vec3], normals: Option<&[Vec3]>, writer: &mut impl Write) -> io::Result<()> {
    match normals {
        None => {
            writeln!(writer, "p {}", vertices.len())?;
            vertices.iter().try_for_each(|&vertex| writeln!(writer, "{}", words(vertex)))
        }
        Some(normals) => {
            writeln!(writer, "pp {}", vertices.len())?;
            let mut corners = vertices.iter().zip(normals);
            corners.try_for_each(|(&vertex, &normal)| writeln!(writer, "{} {}", words(vertex), words(normal)))
        }
    }
}

fn point_light(light: &Light) -> Result<(Vec3, Rgb), String> {
    match *light {
        Light::Point { position, intensity } => Ok((position, intensity)),
        Light::Directional { .. } => Err("a directional light".to_owned()),
    }
}

fn check_settings(settings: &RenderSettings) -> Result<(), String> {
    let &RenderSettings { max_depth, min_weight, sampling, samples, seed } = settings;
    let implied = RenderSettings::default();
    if max_depth != MAX_DEPTH {
        return Err(format!("that rays are followed to depth {max_depth}, not {MAX_DEPTH}"));
    }
    if min_weight != implied.min_weight {
        return Err("a weight below which no ray is followed".to_owned());
    }
    if (sampling, samples, seed) != (implied.sampling, implied.samples, implied.seed) {
        return Err("how many samples a pixel has and where they lie".to_owned());
    }
    Ok(())
}

fn check_shapes(scene: &Scene) -> Result<(), String> {
    let mut latest = 0;
    for shape in in_order(&scene.geometry) {
        if matches!(shape, Shape::Polygon(polygon) if polygon.vertices.len() == 3) {
            return Err("a polygon of three corners, which it takes for a triangle".to_owned());
        }
        if let Some(MaterialId(material)) = shape.material() {
            if material < latest {
                return Err(
                    "that a primitive is made of an earlier material than the one before it".to_owned()
                );
            }
            latest = material;
        }
    }
    Ok(())
}

impl Fill {
    fn of(material: &Material) -> Result<Self, String> {
        let &Material { diffuse, specular, shininess, mirror, dielectric, .. } = material;
        if material.ambient != Rgb::ZERO {
            return Err("a material's share of ambient light".to_owned());
        }
        if !material.casts_shadow {
            return Err("a material that casts no shadow".to_owned());
        }
        match dielectric {
            Some(Dielectric { fresnel: Fresnel::Schlick, .. }) => {
                return Err("a dielectric of Schlick's reflectance".to_owned());
            }
            Some(Dielectric { absorption, .. }) if absorption != Rgb::ZERO => {
                return Err("absorption".to_owned());
            }
            _ => {}
        }
        if mirror != specular || specular != Rgb::splat(specular.x) {
            return Err("a mirror whose share is not grey, or not that of its highlight".to_owned());
        }
        let opaque = Self {
            color: diffuse,
            diffuse_share: 1.0,
            specular: specular.x,
            shininess,
            transmission_share: 0.0,
            ior: 0.0,
        };
        match dielectric {
            None => Ok(opaque),
            Some(Dielectric { ior, transmission, .. }) => opaque.letting_through(ior, transmission),
        }
    }

    /// Diffuse reflection, which is all of its colour so far, and transmission have to be shares of one colour.
    fn letting_through(self, ior: f32, transmission: Rgb) -> Result<Self, String> {
        let diffuse = self.color;
        let ratio = |of: Rgb, to: Rgb| f64::from(of.max_element()) / f64::from(to.max_element());
        let diffuse_in_transmission = Self {
            color: transmission,
            diffuse_share: ratio(diffuse, transmission),
            transmission_share: 1.0,
            ior,
            ..self
        };
        let transmission_in_diffuse = Self { transmission_share: ratio(transmission, diffuse), ior, ..self };
        let the_same = Self { transmission_share: 1.0, ior, ..self };
        let says_both = |fill: &Self| {
            let share = |share: f64| (share * fill.color.as_dvec3()).as_vec3();
            // A share of 0 would say that it is opaque; a share of black is no number.
            fill.diffuse_share <= MAX_COORDINATE
                && fill.transmission_share <= MAX_COORDINATE
                && fill.transmission_share > 0.0
                && share(fill.diffuse_share) == diffuse
                && share(fill.transmission_share) == transmission
        };
        let fills = [diffuse_in_transmission, transmission_in_diffuse, the_same];
        fills.into_iter().find(says_both).ok_or_else(|| {
            "a dielectric whose diffuse reflection and transmission are not shares of one colour".to_owned()
        })
    }

    fn write(&self, writer: &mut impl Write) -> io::Result<()> {
        let Self { color, diffuse_share, specular, shininess, transmission_share, ior } = *self;
        let [specular, shininess, ior] = [specular, shininess, ior].map(Digits);
        // A loader rounds the colour's product with a share, not the colour: fewer digits would show where the share is not 1.
        let color =
            match [diffuse_share, transmission_share].iter().all(|&share| share == 0.0 || share == 1.0) {
                true => words(color).to_string(),
                false => color.as_dvec3().to_array().map(|channel| channel.to_string()).join(" "),
            };
        writeln!(writer, "f {color} {diffuse_share} {specular} {shininess} {transmission_share} {ior}")
    }
}
