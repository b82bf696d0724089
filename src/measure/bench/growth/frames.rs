//! Frames of one scene, of more and more of one thing: the scene is changed, and rendered again.

use super::super::super::race::Race;
use super::super::super::{Better, Spread};
use super::super::scene::BenchOptions;
use super::GrowthPoint;
use super::lights::repeated;
use crate::lanes::Width;
use crate::prepare::Plan;
use crate::render::RenderError;
use crate::scene::Scene;

/// Quarters of the picture's sides that pixels grow over.
const QUARTERS: [u32; 4] = [1, 2, 4, 8];

/// Quarters of the sides of pictures that samples, lights and levels grow over: the most samples are then as many as those of
/// the largest picture that pixels grow to.
const SMALL: u32 = 2;

/// n of n × n samples a pixel.
const SAMPLES: [u32; 3] = [1, 2, 4];

/// Numbers of lights.
const LIGHTS: [u32; 5] = [1, 2, 4, 8, 16];

/// Depths of the deepest ray.
const DEPTHS: [u32; 6] = [0, 1, 2, 4, 8, 16];

/// Of all growth, at most.
pub(super) fn points(pool: &rayon::ThreadPool) -> u64 {
    let settings = QUARTERS.len() + SAMPLES.len() + LIGHTS.len() + DEPTHS.len();
    (settings + thread_counts(pool).len()) as u64
}

/// Pictures from a quarter of the scene's sides to twice.
pub(super) fn over_pixels(
    scene: &Scene,
    options: &BenchOptions<'_>,
) -> Result<Vec<GrowthPoint>, RenderError> {
    let points = QUARTERS.into_iter().map(|quarters| {
        let scene = with_quarters(scene, quarters);
        let pixels = u64::from(scene.image.width) * u64::from(scene.image.height);
        frame(pixels, &scene, options)
    });
    points.collect()
}

/// 1, 2, 4 threads and so on, up to those of the pool.
pub(super) fn over_threads(
    scene: &Scene,
    options: &BenchOptions<'_>,
) -> Result<Vec<GrowthPoint>, RenderError> {
    let points = thread_counts(options.pool).into_iter().map(|count| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build()?;
        point(count as u64, scene, &pool, options)
    });
    points.collect()
}

/// Samples a pixel.
pub(super) fn over_samples(
    scene: &Scene,
    options: &BenchOptions<'_>,
) -> Result<Vec<GrowthPoint>, RenderError> {
    let points = SAMPLES.into_iter().map(|n| frame(u64::from(n * n), &with_samples(scene, n), options));
    points.collect()
}

/// Numbers of lights; none where no light adds to anything.
pub(super) fn over_lights(
    scene: &Scene,
    options: &BenchOptions<'_>,
) -> Result<Vec<GrowthPoint>, RenderError> {
    if !Plan::new(scene).local_light {
        leave_out(LIGHTS.len(), options);
        return Ok(Vec::new());
    }
    let points = LIGHTS.into_iter().map(|count| frame(u64::from(count), &with_lights(scene, count), options));
    points.collect()
}

/// Levels of rays: primary rays are one, and those of the largest depth the last; none where nothing reflects or refracts.
///
/// Rays may double from level to level, so what is deeper than the scene asks for is left out where they grow steeply.
pub(super) fn over_levels(
    scene: &Scene,
    options: &BenchOptions<'_>,
) -> Result<Vec<GrowthPoint>, RenderError> {
    let mut points = Vec::new();
    if Plan::new(&with_depth(scene, 1)).reflection {
        for depth in DEPTHS {
            if depth > scene.render.max_depth && is_steep(&points) {
                break;
            }
            let scene = with_depth(scene, depth);
            points.push(frame(u64::from(depth) + 1, &scene, options)?);
        }
    }
    leave_out(DEPTHS.len() - points.len(), options);
    Ok(points)
}

/// Whether the last point has more than twice the rays of the one before. Depths double, so where rays grow by a factor a level
/// the next point has more than four times as many again.
fn is_steep(points: &[GrowthPoint]) -> bool {
    let [.., before, last] = points else { return false };
    last.rays.total() > 2 * before.rays.total()
}

/// 1, 2, 4 and so on, up to those of the pool.
fn thread_counts(pool: &rayon::ThreadPool) -> Vec<usize> {
    let most = pool.current_num_threads();
    let powers = (0..usize::BITS).map(|power| 1 << power).take_while(|&count| count < most);
    powers.chain([most]).collect()
}

/// With sides of so many quarters of their pixels, one at least.
fn with_quarters(scene: &Scene, quarters: u32) -> Scene {
    let mut scene = scene.clone();
    for side in [&mut scene.image.width, &mut scene.image.height] {
        *side = (side.saturating_mul(quarters) / 4).max(1);
    }
    scene
}

fn with_samples(scene: &Scene, n: u32) -> Scene {
    let mut scene = with_quarters(scene, SMALL);
    scene.render.samples = n;
    scene
}

fn with_lights(scene: &Scene, count: u32) -> Scene {
    let mut scene = with_quarters(scene, SMALL);
    scene.lights = repeated(&scene, count as usize);
    scene
}

fn with_depth(scene: &Scene, depth: u32) -> Scene {
    let mut scene = with_quarters(scene, SMALL);
    scene.render.max_depth = depth;
    scene
}

/// Where the geometry stays as it is, and so what it takes to make it ready.
fn frame(count: u64, scene: &Scene, options: &BenchOptions<'_>) -> Result<GrowthPoint, RenderError> {
    let point = point(count, scene, options.pool, options)?;
    Ok(GrowthPoint { build_seconds: None, ..point })
}

fn point(
    count: u64,
    scene: &Scene,
    pool: &rayon::ThreadPool,
    options: &BenchOptions<'_>,
) -> Result<GrowthPoint, RenderError> {
    let &BenchOptions { repeat, stop, on_step, .. } = options;
    let frames = Race { scene, widths: &[Width::BEST], repeat, pool, stop, on_step }.frames()?;
    let [frames] = frames.as_slice() else { return Err(RenderError::Stopped) };
    Ok(GrowthPoint {
        count,
        rays: frames.last.rays,
        build_seconds: Spread::of(frames.prepare_seconds.clone(), Better::Less),
        frame_seconds: frames.trace_seconds,
    })
}

/// The steps of points that are not measured.
fn leave_out(points: usize, options: &BenchOptions<'_>) {
    for _ in 0..points as u64 * Race::steps(1, options.repeat) {
        (options.on_step)();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::{StandardScene, generate};
    use crate::rays::RayCounts;
    use crate::scene::{
        Dielectric, Fresnel, Geometry, ImageSettings, Material, MaterialId, RenderSettings, Rgb,
    };
    use glam::Vec3;
    use std::sync::atomic::AtomicBool;

    fn scene() -> Scene {
        let mut scene = generate(StandardScene::Sphereflake, 20).unwrap();
        (scene.image.width, scene.image.height) = (30, 9);
        scene
    }

    /// Of half the sides, in whole pixels.
    fn small() -> Scene {
        let scene = scene();
        Scene { image: ImageSettings { width: 15, height: 4, ..scene.image }, ..scene }
    }

    #[test]
    fn pictures_have_quarters_of_the_sides_and_a_pixel_at_least() {
        let mut scene = scene();
        for (quarters, width, height) in [(1, 7, 2), (2, 15, 4), (4, 30, 9), (8, 60, 18)] {
            let image = with_quarters(&scene, quarters).image;
            assert_eq!(image, ImageSettings { width, height, ..scene.image });
        }
        scene.image.height = 1;
        assert_eq!(with_quarters(&scene, 1).image.height, 1);
    }

    #[test]
    fn nothing_changes_but_the_size_and_what_grows() {
        for n in SAMPLES {
            let render = RenderSettings { samples: n, ..small().render };
            assert_eq!(with_samples(&scene(), n), Scene { render, ..small() });
        }
        for depth in DEPTHS {
            let render = RenderSettings { max_depth: depth, ..small().render };
            assert_eq!(with_depth(&scene(), depth), Scene { render, ..small() });
        }
        for count in LIGHTS {
            let changed = with_lights(&scene(), count);
            assert_eq!(changed.lights.len(), count as usize);
            assert_eq!(Scene { lights: scene().lights, ..changed }, small());
        }
    }

    #[test]
    fn rays_are_steep_where_they_more_than_double() {
        let point = |primary: u64| GrowthPoint {
            count: 1,
            rays: RayCounts { primary, ..RayCounts::default() },
            build_seconds: None,
            frame_seconds: None,
        };
        for (rays, steep) in
            [(&[][..], false), (&[9], false), (&[1, 9, 18], false), (&[9, 19], true), (&[1, 9, 10], false)]
        {
            let points: Vec<_> = rays.iter().map(|&rays| point(rays)).collect();
            assert_eq!(is_steep(&points), steep, "{rays:?}");
        }
    }

    /// Inside two spheres of glass, from which rays double almost at each hit.
    #[test]
    fn where_rays_grow_steeply_none_go_deeper_than_the_scene_s() {
        let mut geometry = Geometry::default();
        for radius in [1.0, 2.0] {
            geometry.add_sphere(Vec3::ZERO, radius, MaterialId(0)).unwrap();
        }
        let dielectric = Dielectric {
            ior: 1.0,
            absorption: Rgb::ZERO,
            transmission: Rgb::splat(0.5),
            fresnel: Fresnel::Fixed,
        };
        let glass = Material { mirror: Rgb::splat(0.5), dielectric: Some(dielectric), ..Material::default() };
        let mut scene = Scene::unlit(geometry, vec![glass]);
        (scene.image.width, scene.image.height) = (4, 4);
        for (own, levels) in [(0, &[1, 2][..]), (4, &[1, 2, 3, 5]), (8, &[1, 2, 3, 5, 9])] {
            scene.render.max_depth = own;
            let options = BenchOptions {
                pool: &rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap(),
                repeat: 1,
                rays: 1,
                scratch: "".as_ref(),
                on_step: &|| {},
                stop: &AtomicBool::new(false),
            };
            let points = over_levels(&scene, &options).unwrap();
            let found: Vec<u64> = points.iter().map(|point| point.count).collect();
            assert_eq!(found, levels, "{points:?}");
        }
    }
}
