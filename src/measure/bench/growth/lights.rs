//! As many lights as wanted, made of those that a scene has.

use crate::math::sin_cos_degrees;
use crate::scene::{Light, Scene};
use glam::DVec3;

/// Degrees. However often something is turned by it, it never comes back to where it was, and goes evenly all around.
const GOLDEN_ANGLE: f64 = 137.507_764_050_037_85;

/// A scene's lights, as often as it takes for there to be `count`; none of none.
///
/// At first they are where the scene has them. When repeated for the k-th time they are turned by k golden angles about the
/// vertical, the camera's, through the middle of the geometry, so that rays to them go other ways; only what is on that axis
/// or shines along it stays. All are dimmed alike, so that their sum is about what the scene's is.
pub(super) fn repeated(scene: &Scene, count: usize) -> Vec<Light> {
    let own = scene.lights.len();
    let vertical = Vertical::of(scene);
    let share = own as f32 / count as f32;
    let lights = scene.lights.iter().cycle().take(count).enumerate().map(|(index, &light)| {
        // Turned by nothing, a position would still be rounded.
        let turned =
            if index < own { light } else { vertical.turned(light, GOLDEN_ANGLE * (index / own) as f64) };
        dimmed(turned, share)
    });
    lights.collect()
}

/// What lights are turned about; world space.
struct Vertical {
    /// A point on it.
    middle: DVec3,
    /// Unit.
    up: DVec3,
}

impl Vertical {
    fn of(scene: &Scene) -> Self {
        let middle = scene.geometry.bounds().map_or(DVec3::ZERO, |(low, high)| (low + high) / 2.0);
        Self { middle, up: scene.camera.up.as_dvec3().normalize_or(DVec3::Y) }
    }

    fn turned(&self, light: Light, degrees: f64) -> Light {
        let (sin, cos) = sin_cos_degrees(degrees);
        let turned = |way: DVec3| {
            let along = way.dot(self.up) * self.up;
            let across = way - along;
            along + cos * across + sin * self.up.cross(across)
        };
        match light {
            Light::Point { position, intensity } => {
                let position = self.middle + turned(position.as_dvec3() - self.middle);
                Light::Point { position: position.as_vec3(), intensity }
            }
            Light::Directional { direction, intensity } => {
                Light::Directional { direction: turned(direction.as_dvec3()).as_vec3(), intensity }
            }
        }
    }
}

fn dimmed(mut light: Light, share: f32) -> Light {
    let (Light::Point { intensity, .. } | Light::Directional { intensity, .. }) = &mut light;
    *intensity *= share;
    light
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::{StandardScene, generate};
    use crate::scene::Rgb;

    fn intensity(light: &Light) -> Rgb {
        let (Light::Point { intensity, .. } | Light::Directional { intensity, .. }) = light;
        *intensity
    }

    #[test]
    fn there_are_as_many_as_wanted_and_the_scene_s_own_are_among_them() {
        for which in StandardScene::ALL {
            let scene = generate(which, 100).unwrap();
            assert_eq!(repeated(&scene, scene.lights.len()), scene.lights);
            for count in [1, 2, 4, 8, 16] {
                let lights = repeated(&scene, count);
                assert_eq!(lights.len(), count);
                let share = scene.lights.len() as f32 / count as f32;
                for (light, &own) in lights.iter().zip(&scene.lights) {
                    assert_eq!(*light, dimmed(own, share));
                }
            }
        }
    }

    #[test]
    fn none_are_made_of_none() {
        let mut scene = generate(StandardScene::Gears, 100).unwrap();
        scene.lights.clear();
        assert_eq!(repeated(&scene, 16), []);
    }

    #[test]
    fn no_two_shine_from_one_place_and_all_from_one_height() {
        for which in StandardScene::ALL {
            let scene = generate(which, 100).unwrap();
            let Vertical { middle, up } = Vertical::of(&scene);
            let ways: Vec<DVec3> = repeated(&scene, 16)
                .iter()
                .map(|light| match *light {
                    Light::Point { position, .. } => position.as_dvec3() - middle,
                    Light::Directional { direction, .. } => direction.as_dvec3(),
                })
                .collect();
            let own = scene.lights.len();
            for (index, way) in ways.iter().enumerate() {
                assert!((way.dot(up) - ways[index % own].dot(up)).abs() < 1e-5, "{index} of {which:?}");
                assert!((way.length() - ways[index % own].length()).abs() < 1e-5, "{index} of {which:?}");
                let apart = ways[..index].iter().map(|other| way.distance(*other));
                assert!(apart.fold(f64::MAX, f64::min) > 0.1, "{index} of {which:?}");
            }
        }
    }

    /// By the right hand: from x over y, where z is up.
    #[test]
    fn they_are_turned_about_the_middle() {
        let vertical = Vertical { middle: DVec3::new(1.0, 2.0, 3.0), up: DVec3::Z };
        let [position, direction] = [[5.0, 2.0, 7.0], [1.0, 0.0, -1.0]].map(glam::Vec3::from);
        let intensity = Rgb::ONE;
        assert_eq!(
            vertical.turned(Light::Point { position, intensity }, 90.0),
            Light::Point { position: glam::Vec3::new(1.0, 6.0, 7.0), intensity }
        );
        assert_eq!(
            vertical.turned(Light::Directional { direction, intensity }, 90.0),
            Light::Directional { direction: glam::Vec3::new(0.0, 1.0, -1.0), intensity }
        );
    }

    #[test]
    fn their_sum_is_about_the_scene_s() {
        for which in StandardScene::ALL {
            let scene = generate(which, 100).unwrap();
            let sum = |lights: &[Light]| lights.iter().map(intensity).sum::<Rgb>();
            for rounds in 1..5 {
                let lights = repeated(&scene, rounds * scene.lights.len());
                assert!(sum(&lights).abs_diff_eq(sum(&scene.lights), 1e-5), "{rounds} of {which:?}");
            }
        }
    }
}
