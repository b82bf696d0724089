//! The project's own format, as docs/scenes.md specifies it.

use super::number::{Digits, Triple};
use super::shapes::{Shape, in_order, listed, run};
use crate::scene::{
    Camera, Dielectric, Fresnel, Light, Material, MaterialId, Projection, Rgb, Scene, Window,
};
use glam::Vec3;
use std::fmt::{self, Display, Formatter};
use std::io::{self, Write};

/// A scene that TOML can say.
pub(super) struct Document<'a>(&'a Scene);

impl<'a> Document<'a> {
    /// # Errors
    /// The first thing that TOML cannot say.
    pub(super) fn new(scene: &'a Scene) -> Result<Self, String> {
        let mut kinds_so_far = 0;
        for shape in in_order(&scene.geometry) {
            if shape.has_vertex_normals() {
                return Err("TOML cannot say vertex normals; they come with a mesh alone".to_owned());
            }
            let kind = match shape {
                Shape::Sphere(_) => 0,
                Shape::LeftOut => kinds_so_far.max(1),
                Shape::Triangle(_) => 1,
                Shape::Polygon(_) => 2,
            };
            if kind < kinds_so_far {
                return Err(
                    "TOML cannot say that triangles or polygons are numbered before spheres, or polygons before \
                     triangles; number spheres first, then triangles, then polygons"
                        .to_owned(),
                );
            }
            kinds_so_far = kind;
        }
        Ok(Self(scene))
    }

    pub(super) fn write(&self, writer: &mut impl Write) -> io::Result<()> {
        let Scene { image, render, camera, ambient, lights, materials, .. } = self.0;
        writeln!(writer, "[image]\nsize = [{}, {}]", image.width, image.height)?;
        writeln!(writer, "background = {}\n", Color(image.background))?;
        writeln!(writer, "[render]\nmax_depth = {}", render.max_depth)?;
        writeln!(writer, "min_weight = {}", Digits(render.min_weight))?;
        writeln!(writer, "sampling = \"{}\"", render.sampling.name())?;
        writeln!(writer, "samples = {}\nseed = {}\n", render.samples, render.seed)?;
        write_camera(camera, writer)?;
        writeln!(writer, "[ambient]\nintensity = {}\n", Color(*ambient))?;
        for light in lights {
            write_light(light, writer)?;
        }
        for (index, material) in materials.iter().enumerate() {
            writeln!(writer, "[material.{}]", self.name(index))?;
            write_material(material, writer)?;
        }
        self.write_shapes(writer)
    }

    /// A loader lists materials by their names, so the names have to be in the order of the numbers.
    fn name(&self, material: usize) -> impl Display {
        let digits = self.0.materials.len().saturating_sub(1).to_string().len();
        format!("m{material:0digits$}")
    }

    fn write_shapes(&self, writer: &mut impl Write) -> io::Result<()> {
        let Scene { geometry, materials, .. } = self.0;
        let names: Vec<_> = (0..materials.len()).map(|material| self.name(material)).collect();
        let mut polygons_have_begun = false;
        for shape in in_order(geometry) {
            let MaterialId(material) = shape.material().unwrap_or(MaterialId(0));
            let Some(name) = names.get(material as usize) else { continue };
            polygons_have_begun |= matches!(shape, Shape::Polygon(_));
            match shape {
                Shape::Sphere(sphere) => {
                    let (center, radius) = (Vector(sphere.center), Digits(sphere.radius));
                    write!(writer, "[[sphere]]\ncenter = {center}\nradius = {radius}\n")?;
                }
                Shape::Triangle(triangle) => {
                    let vertices = listed(&geometry.vertices, triangle.vertices);
                    write!(writer, "[[triangle]]\nvertices = {}\n", Vectors(&vertices))?;
                }
                Shape::Polygon(polygon) => {
                    let vertices = run(&geometry.vertices, polygon.vertices.clone());
                    write!(writer, "[[polygon]]\nvertices = {}\n", Vectors(vertices))?;
                }
                Shape::LeftOut => {
                    let kind = if polygons_have_begun { "polygon" } else { "triangle" };
                    write!(writer, "[[{kind}]]\nvertices = {}\n", Vectors(&[Vec3::ZERO; 3]))?;
                }
            }
            writeln!(writer, "material = \"{name}\"")?;
        }
        Ok(())
    }
}

fn write_camera(camera: &Camera, writer: &mut impl Write) -> io::Result<()> {
    let kind = match camera.projection {
        Projection::PerspectiveAngle { .. } | Projection::PerspectiveWindow { .. } => "perspective",
        Projection::OrthographicHeight { .. } | Projection::OrthographicWindow { .. } => "orthographic",
    };
    writeln!(writer, "[camera]\nkind = \"{kind}\"")?;
    writeln!(writer, "eye = {}\ntarget = {}", Vector(camera.eye), Vector(camera.target))?;
    writeln!(writer, "up = {}", Vector(camera.up))?;
    let window = |Window { left, right, bottom, top }| {
        let [left, right, bottom, top] = [left, right, bottom, top].map(Digits);
        format!("window = [{left}, {right}, {bottom}, {top}]")
    };
    match camera.projection {
        Projection::PerspectiveAngle { vertical_degrees } => {
            writeln!(writer, "fov = {}\n", Digits(vertical_degrees))
        }
        Projection::PerspectiveWindow { window: covered, distance } => {
            writeln!(writer, "{}\ndistance = {}\n", window(covered), Digits(distance))
        }
        Projection::OrthographicHeight { height } => writeln!(writer, "height = {}\n", Digits(height)),
        Projection::OrthographicWindow { window: covered } => writeln!(writer, "{}\n", window(covered)),
    }
}

fn write_light(light: &Light, writer: &mut impl Write) -> io::Result<()> {
    let (key, vector, intensity) = match *light {
        Light::Point { position, intensity } => ("position", position, intensity),
        Light::Directional { direction, intensity } => ("direction", direction, intensity),
    };
    writeln!(writer, "[[light]]\n{key} = {}\nintensity = {}\n", Vector(vector), Color(intensity))
}

/// The keys whose values are not what they are by default.
fn write_material(material: &Material, writer: &mut impl Write) -> io::Result<()> {
    let plain = Material::default();
    let mut color = |key: &str, color: Rgb, default: Rgb| match color == default {
        true => Ok(()),
        false => writeln!(writer, "{key} = {}", Color(color)),
    };
    color("ambient", material.ambient, plain.ambient)?;
    color("diffuse", material.diffuse, plain.diffuse)?;
    color("specular", material.specular, plain.specular)?;
    color("mirror", material.mirror, plain.mirror)?;
    if let Some(Dielectric { absorption, transmission, .. }) = material.dielectric {
        color("absorption", absorption, Rgb::ZERO)?;
        color("transmission", transmission, Rgb::ONE)?;
    }
    if let Some(Dielectric { ior, fresnel, .. }) = material.dielectric {
        writeln!(writer, "ior = {}", Digits(ior))?;
        if fresnel == Fresnel::Fixed {
            writeln!(writer, "fresnel = false")?;
        }
    }
    if material.shininess != plain.shininess {
        writeln!(writer, "shininess = {}", Digits(material.shininess))?;
    }
    if !material.casts_shadow {
        writeln!(writer, "casts_shadow = false")?;
    }
    writeln!(writer)
}

struct Vector(Vec3);

impl Display for Vector {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "[{}]", Triple(self.0, ", "))
    }
}

struct Vectors<'a>(&'a [Vec3]);

impl Display for Vectors<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        for (index, &vector) in self.0.iter().enumerate() {
            write!(f, "{}{}", if index == 0 { "[" } else { ", " }, Vector(vector))?;
        }
        write!(f, "]")
    }
}

/// One number where it is grey.
struct Color(Rgb);

impl Display for Color {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.0 == Rgb::splat(self.0.x) {
            true => write!(f, "{}", Digits(self.0.x)),
            false => write!(f, "{}", Vector(self.0)),
        }
    }
}
