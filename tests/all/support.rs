//! What several tests need: scenes from text, rendered by the library; the program; temporary folders.

use glam::Vec3;
use roxmltree::Document;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::atomic::AtomicBool;
use wavelane::film::{Image, Region};
use wavelane::lanes::Width;
use wavelane::load::load;
use wavelane::measure::Difference;
use wavelane::render::{Engine, RenderOptions, Rendered, render};
use wavelane::scene::{Light, Projection, Scene, Window};

/// A folder that goes away with the value.
pub(crate) struct Folder(tempfile::TempDir);

impl Folder {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub(crate) fn path(&self) -> &Path {
        self.0.path()
    }

    pub(crate) fn file(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.file(name);
        std::fs::write(&path, content).unwrap();
        path
    }

    /// Names of all files, sorted.
    pub(crate) fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.path()).unwrap();
        let mut names: Vec<String> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

/// The scene of a TOML text.
pub(crate) fn scene(toml: &str) -> Scene {
    let folder = Folder::new();
    load(&folder.write("scene.toml", toml)).unwrap_or_else(|error| panic!("{error}\nin\n{toml}")).scene
}

/// The wavefront engine, in lanes of the width that it is used at.
pub(crate) fn wavefront() -> Engine {
    Engine::wavefront(Width::BEST)
}

pub(crate) fn render_with(scene: &Scene, engine: Engine) -> Rendered {
    render_region(scene, engine, Region::whole(scene.image.width, scene.image.height), 0)
}

pub(crate) fn render_region(scene: &Scene, engine: Engine, region: Region, threads: usize) -> Rendered {
    let stop = AtomicBool::new(false);
    render(scene, &RenderOptions { engine, region, threads, on_progress: &|_| {}, stop: &stop }).unwrap()
}

/// Renders with the reference, and sees to it that the wavefront engine agrees: what is asserted of the one then holds of
/// the other, but for a pixel in a thousand that may fall on the other side of an edge.
#[track_caller]
pub(crate) fn render_whole(scene: &Scene) -> Rendered {
    let expected = render_with(scene, Engine::Reference);
    let found = render_with(scene, wavefront());
    let over = |limit: f64| Difference::between(&expected.image, &found.image, limit).unwrap();
    let brightest = expected.image.pixels.iter().flatten().fold(1.0_f32, |a, &b| a.max(b));
    let apart = over(1e-4 * f64::from(brightest));
    let allowed = expected.image.pixels.len() as u64 / 1000;
    assert!(apart.pixels_over <= allowed, "{apart:?} between the engines");
    if apart.pixels_over == 0 {
        let (expected, found) = (expected.rays, found.rays);
        let close = |a: u64, b: u64| a.abs_diff(b) <= a.max(b) / 1000;
        let agree = expected.primary == found.primary
            && close(expected.shadow, found.shadow)
            && close(expected.reflect, found.reflect)
            && close(expected.refract, found.refract);
        assert!(agree, "rays of the engines: {expected:?}, {found:?}");
    }
    expected
}

/// The picture of a TOML text, by the reference; the wavefront engine agrees.
#[track_caller]
pub(crate) fn picture(toml: &str) -> Image {
    render_whole(&scene(toml)).image
}

/// The pictures of a TOML text by both engines, for what must hold of every pixel.
pub(crate) fn pictures(toml: &str) -> [(&'static str, Image); 2] {
    let scene = scene(toml);
    [("reference", Engine::Reference), ("wavefront", wavefront())]
        .map(|(name, engine)| (name, render_with(&scene, engine).image))
}

/// The only pixel of a TOML text's picture.
#[track_caller]
pub(crate) fn pixel(toml: &str) -> [f32; 3] {
    let image = picture(toml);
    assert_eq!((image.width, image.height), (1, 1));
    image.pixels[0]
}

/// A camera of one pixel that looks from `eye` along the line to `target`, with orthographic rays.
pub(crate) fn one_ray(eye: [f64; 3], target: [f64; 3]) -> String {
    format!(
        "[image]\nsize = [1, 1]\n[camera]\nkind = \"orthographic\"\neye = {eye:?}\ntarget = {target:?}\nup = [0.123, 0.987, 0.456]\nheight = 1e-9\n"
    )
}

#[track_caller]
pub(crate) fn assert_close(found: [f32; 3], expected: [f64; 3], tolerance: f64) {
    for channel in 0..3 {
        let difference = (f64::from(found[channel]) - expected[channel]).abs();
        assert!(difference <= tolerance, "found {found:?}, expected {expected:?}");
    }
}

/// All of it lies within the plot, or right at its edge.
#[track_caller]
pub(crate) fn assert_plot(svg: &str) {
    const SVG: &str = "http://www.w3.org/2000/svg";
    let parsed = Document::parse(svg).unwrap_or_else(|error| panic!("{error}\n{svg}"));
    let size = |name| parsed.root_element().attribute(name).unwrap().parse::<f64>().unwrap();
    let (width, height) = (size("width"), size("height"));
    assert!(parsed.descendants().any(|node| node.has_tag_name((SVG, "text"))), "{svg}");
    for node in parsed.descendants() {
        for attribute in node.attributes() {
            let end = match attribute.name() {
                "x" | "x1" | "x2" | "cx" => width,
                "y" | "y1" | "y2" | "cy" => height,
                _ => continue,
            };
            let at: f64 = attribute.value().parse().unwrap();
            assert!((0.0..=end).contains(&at), "{attribute:?} of {end}");
        }
    }
}

/// A little of everything: glass, a mirror, a triangle, a ground, two kinds of light.
pub(crate) const STILL_LIFE: &str = r#"
[image]
size = [64, 48]
background = [0.1, 0.2, 0.3]
[camera]
eye = [1.5, -4, 2]
target = [0, 0, 0.5]
up = [0, 0, 1]
fov = 40
[[light]]
position = [3, -2, 4]
[[light]]
direction = [1, 0.5, -1]
intensity = 0.3
[material.matte]
diffuse = 0.7
[material.mirror]
mirror = 0.8
[material.glass]
ior = 1.5
[[sphere]]
center = [0, 0, 0.5]
radius = 0.5
material = "glass"
[[sphere]]
center = [1, 0, 0.5]
radius = 0.5
material = "mirror"
[[triangle]]
vertices = [[-1, 1, 0], [-0.5, 0.25, 0], [-1, 0.5, 1]]
material = "matte"
[[polygon]]
vertices = [[-5, -5, 0], [5, -5, 0], [5, 5, 0], [-5, 5, 0]]
material = "matte"
"#;

/// Multiplies every length of a scene by a power of two, which rounds nothing: positions, radii, what the camera covers; and
/// by its inverse what is per unit of length, absorption.
pub(crate) fn scaled(mut scene: Scene, exponent: i32) -> Scene {
    let factor = 2.0_f32.powi(exponent);
    scene.camera.eye *= factor;
    scene.camera.target *= factor;
    let edges = |window: &mut Window| {
        let Window { left, right, bottom, top } = window;
        [left, right, bottom, top].into_iter().for_each(|edge| *edge *= factor);
    };
    match &mut scene.camera.projection {
        Projection::PerspectiveAngle { .. } => {}
        Projection::PerspectiveWindow { window, distance } => {
            edges(window);
            *distance *= factor;
        }
        Projection::OrthographicHeight { height } => *height *= factor,
        Projection::OrthographicWindow { window } => edges(window),
    }
    for light in &mut scene.lights {
        if let Light::Point { position, .. } = light {
            *position *= factor;
        }
    }
    for material in &mut scene.materials {
        if let Some(dielectric) = &mut material.dielectric {
            dielectric.absorption /= factor;
        }
    }
    for sphere in &mut scene.geometry.spheres {
        sphere.center *= factor;
        sphere.radius *= factor;
    }
    for vertex in &mut scene.geometry.vertices {
        *vertex *= factor;
    }
    scene
}

/// A closed ball of triangles or of quadrilaterals, with its corners off any grid, around a centre.
pub(crate) fn ball(center: Vec3, radius: f32, quads: bool) -> String {
    let (rings, sectors) = (7, 12);
    let point = |ring: i32, sector: i32| {
        let (polar, azimuth) = (
            std::f32::consts::PI * ring as f32 / rings as f32,
            std::f32::consts::TAU * (sector % sectors) as f32 / sectors as f32,
        );
        let turned = glam::Quat::from_euler(glam::EulerRot::XYZ, 0.3, 1.1, 0.7)
            * Vec3::new(polar.sin() * azimuth.cos(), polar.sin() * azimuth.sin(), polar.cos());
        center + radius * turned
    };
    let listed = |points: &[Vec3]| {
        let points: Vec<String> = points.iter().map(|point| format!("{:?}", point.to_array())).collect();
        points.join(", ")
    };
    let mut toml = String::new();
    for ring in 0..rings {
        for sector in 0..sectors {
            let corners = [
                point(ring, sector),
                point(ring + 1, sector),
                point(ring + 1, sector + 1),
                point(ring, sector + 1),
            ];
            if quads && ring > 0 && ring + 1 < rings {
                toml += &format!("[[polygon]]\nvertices = [{}]\nmaterial = \"m\"\n", listed(&corners));
                continue;
            }
            for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
                // At the poles one of the two has no area and is left out.
                toml += &format!(
                    "[[triangle]]\nvertices = [{}]\nmaterial = \"m\"\n",
                    listed(&[corners[a], corners[b], corners[c]])
                );
            }
        }
    }
    toml
}

/// An NPY file of float32 rows.
pub(crate) fn npy_floats<const WIDTH: usize>(rows: &[[f32; WIDTH]]) -> Vec<u8> {
    let data = rows.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
    npy("<f4", &format!("({}, {WIDTH})", rows.len()), data)
}

/// An NPY file of uint32 rows of three.
pub(crate) fn npy_indices(rows: &[[u32; 3]]) -> Vec<u8> {
    let data = rows.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
    npy("<u4", &format!("({}, 3)", rows.len()), data)
}

/// An NPY file of version 1, of a type and a shape as Python writes them.
pub(crate) fn npy(descr: &str, shape: &str, data: Vec<u8>) -> Vec<u8> {
    let header = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}");
    let header = format!("{header:<117}\n");
    let length = u16::try_from(header.len()).unwrap().to_le_bytes();
    [b"\x93NUMPY\x01\x00".to_vec(), length.to_vec(), header.into_bytes(), data].concat()
}

/// Runs the program.
pub(crate) fn wavelane(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_wavelane")).args(arguments).output().unwrap()
}

pub(crate) fn stdout(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

pub(crate) fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// The project's root.
pub(crate) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The scene in the scene format's specification, which has every key; it names a mesh bunny.obj.
pub(crate) fn specification_example() -> String {
    let page = std::fs::read_to_string(root().join("docs/scenes.md")).unwrap();
    let (_, after) = page.split_once("```toml\n").unwrap();
    after.split_once("```").unwrap().0.to_owned()
}
