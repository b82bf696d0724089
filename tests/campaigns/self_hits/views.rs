//! Where eyes and lights are: far and near, along the normal and along the surface, on faces and on edges.

use super::settings::Setting;
use crate::random::Random;
use glam::DVec3;
use wavelane::scene::{
    Camera, Dielectric, Fresnel, ImageSettings, Light, Material, Projection, RenderSettings, Rgb, Sampling,
    Scene,
};

/// Pixels of a side.
const SIDE: u32 = 20;

/// Where the eye is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Eye {
    /// 2 to 10⁴ sizes from what it looks at, on the side that the normal points to.
    Outside,
    /// Within a closed body.
    Inside,
    /// Within one, close above the face that it looks along, to the edge.
    AtEdge,
}

/// A frame of a setting: eye, lights and glass at random.
pub(super) fn scene(setting: &Setting, eye: Eye, random: &mut Random) -> Scene {
    let camera = camera(setting, eye, random);
    Scene {
        image: ImageSettings { width: SIDE, height: SIDE, background: Rgb::ZERO },
        render: RenderSettings {
            max_depth: 7,
            sampling: Sampling::Random,
            seed: random.whole(0, 1 << 30) as u32,
            ..RenderSettings::default()
        },
        lights: lights(setting, eye, &camera, random),
        camera,
        ambient: Rgb::ZERO,
        materials: vec![glass(random)],
        geometry: setting.geometry.clone(),
    }
}

/// Sends on half by either way, at whatever angle.
fn glass(random: &mut Random) -> Material {
    let half = Rgb::splat(0.5);
    let dielectric = Dielectric {
        ior: *random.pick(&[0.7, 1.0, 1.1, 1.5, 2.4]),
        absorption: Rgb::ZERO,
        transmission: half,
        fresnel: Fresnel::Fixed,
    };
    Material { diffuse: half, mirror: half, dielectric: Some(dielectric), ..Material::default() }
}

/// Unit, at any angle to a normal, down to 89.99°.
fn tilted(normal: DVec3, random: &mut Random) -> DVec3 {
    let cosine = if random.one_in(2) { random.between(0.05, 1.0) } else { random.log_between(1.75e-4, 1.0) };
    let along = along(normal, random);
    normal * cosine + along * (1.0 - cosine * cosine).sqrt()
}

/// Unit, in the plane.
fn along(normal: DVec3, random: &mut Random) -> DVec3 {
    normal.cross(random.direction()).normalize()
}

fn camera(setting: &Setting, eye: Eye, random: &mut Random) -> Camera {
    let Setting { aim: (aim, normal), size, to_edge, .. } = *setting;
    let inside = setting.inside(random);
    let position = match (eye, to_edge) {
        (Eye::Outside, _) => aim + tilted(normal, random) * size * random.log_between(2.0, 1e4),
        (Eye::AtEdge, Some(to_edge)) if random.one_in(2) => {
            // Mirrored at the face, rays go on to the other face.
            let distance = (inside - aim).dot(-to_edge).max(1e-3 * size);
            aim - to_edge * distance - normal * distance * random.log_between(1e-6, 1.0)
        }
        _ => inside,
    };
    let distance = position.distance(aim);
    // What the picture is across: from a view of everything down to some roundings of a coordinate.
    let rounding = aim.abs().max_element() / f64::from(1 << 24);
    let across = match random.whole(0, 2) {
        0 if eye == Eye::AtEdge => rounding * random.between(2.0, 32.0),
        0 => 1.5 * size,
        1 => distance * 1.7e-4 * f64::from(SIDE), // a hundredth of a degree a pixel
        _ => size * random.log_between(2.0_f64.powi(-24), 1.0),
    };
    let projection = if random.one_in(4) {
        Projection::OrthographicHeight { height: across as f32 }
    } else {
        let degrees = (2.0 * (0.5 * across / distance).atan()).to_degrees();
        Projection::PerspectiveAngle { vertical_degrees: degrees.min(150.0) as f32 }
    };
    Camera {
        eye: position.as_vec3(),
        target: aim.as_vec3(),
        up: along((aim - position).normalize(), random).as_vec3(),
        projection,
    }
}

/// At the eye, anywhere near and far, in no place, inside, and close above the surface that the eye looks at, beyond its edge.
fn lights(setting: &Setting, eye: Eye, camera: &Camera, random: &mut Random) -> Vec<Light> {
    let Setting { aim: (aim, normal), size, center, .. } = *setting;
    let towards = setting.to_edge.filter(|_| eye == Eye::AtEdge).unwrap_or_else(|| along(normal, random));
    let off = if eye == Eye::Outside { normal } else { -normal };
    let intensity = Rgb::ONE;
    let point = |position: DVec3| Light::Point { position: position.as_vec3(), intensity };
    let around = random.direction();
    let shallow = |random: &mut Random| towards + off * random.log_between(1e-6, 1e-1);
    vec![
        Light::Point { position: camera.eye, intensity },
        point(center + around * size * random.log_between(2.0, 1e3)),
        Light::Directional { direction: random.direction().as_vec3(), intensity },
        Light::Directional { direction: -shallow(random).as_vec3(), intensity },
        point(aim + shallow(random) * size * random.log_between(2.0, 1e3)),
        point(setting.inside(random)),
    ]
}
