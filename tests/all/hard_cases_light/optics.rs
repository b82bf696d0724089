//! Mirrors, glass and absorption as rays show them, rounded where queues hold them.

use super::{Place, U, aimed, engines, length, rounding_of};
use crate::support::{render_with, scene};
use glam::{DVec3, Vec3};
use wavelane::ray_tree::RayTree;
use wavelane::render::Engine;
use wavelane::scene::Scene;

/// A face in the plane z = 0 of the place's axes, its outside up; glass.
fn glass_plane(place: Place, material: &str) -> Scene {
    let corners = [[-6.0, -6.0], [6.0, -6.0], [0.0, 6.0]].map(|[x, y]| Vec3::new(x, y, 0.0));
    scene(&format!(
        "[image]\nsize = [1, 1]\nbackground = 1\n[render]\nmax_depth = 1\n[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\n\
         up = [0, 1, 0]\nfov = 1\n[material.m]\n{material}\n{}",
        place.face("triangle", &corners, "m")
    ))
}

/// The ray that meets the plane near the place's middle, from above or from below, with a cosine of incidence of about so
/// much; none where rounding makes it miss.
fn meeting(scene: &Scene, engine: Engine, place: Place, cosine: f64, above: bool) -> Option<RayTree> {
    let up = if above { cosine } else { -cosine };
    let sine = (1.0 - cosine * cosine).sqrt();
    let eye = DVec3::new(0.6 * sine, -0.8 * sine, up).as_vec3();
    let ray = aimed(scene, engine, place.point(2.0 * eye), place.point(Vec3::ZERO));
    ray.hit.as_ref().is_some_and(|hit| hit.entering == above).then_some(ray)
}

/// 1 − η²(1 − c²) of a ray and the normal that it meets, as they are kept.
fn refracted_cosine_squared(ray: &RayTree, ior: f64) -> Option<f64> {
    let hit = ray.hit.as_ref()?;
    let cosine = -DVec3::from(ray.direction).dot(DVec3::from(hit.shading_normal));
    let ratio = if hit.entering { 1.0 / ior } else { ior };
    Some(1.0 - ratio * ratio * (1.0 - cosine.min(1.0).powi(2)))
}

const PLACES: [Place; 2] = [Place { turned: false, offset: 0.0 }, Place { turned: true, offset: 3.0 }];

/// Case 42: cos > 1: a normal that is longer than 1 once it is rounded, (3, 8, 18), seen along itself.
#[test]
fn case_42_a_normal_longer_than_1() {
    let normal = Vec3::new(3.0, 8.0, 18.0).normalize();
    let [across, along] = [normal.any_orthonormal_vector(), normal.cross(normal.any_orthonormal_vector())];
    let corners = [-across - along, across - along, along].map(|corner| format!("{:?}", corner.to_array()));
    let mut too_long = 0;
    for outside in [normal, -normal] {
        for order in [[0, 1, 2], [0, 2, 1]] {
            let scene = scene(&format!(
                "[image]\nsize = [1, 1]\nbackground = 1\n[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nfov = 1\n\
                 [material.m]\nior = 1.5\n[[triangle]]\nvertices = [{}]\nmaterial = \"m\"\n",
                order.map(|corner: usize| corners[corner].clone()).join(", ")
            ));
            for engine in engines() {
                let ray = aimed(&scene, engine, 3.0 * outside, Vec3::ZERO);
                let [reflect, refract] = [&ray.reflect, &ray.refract].map(|child| child.as_ref().unwrap());
                // R0 = (0.5/2.5)², to 2 ulp, which at 0.04 are an eighth of a rounding of 1.
                assert!((reflect.weight[0] - 0.04).abs() <= rounding_of(engine) / 8.0, "{engine:?}: {ray:?}");
                assert!((refract.weight[0] - 0.96).abs() <= 4.0 * rounding_of(engine), "{engine:?}: {ray:?}");
                assert_eq!(ray.colour, [1.0; 3], "{engine:?}");
                let normal = DVec3::from(ray.hit.as_ref().unwrap().geometric_normal);
                too_long += usize::from(-normal.dot(ray.direction.into()) > 1.0);
                let straight = DVec3::from(refract.direction) - DVec3::from(ray.direction);
                assert!(straight.length() <= 4.0 * U, "{engine:?}: {ray:?}");
            }
        }
    }
    assert!(too_long > 0, "no cosine is above 1");
}

/// Case 43: Critical angle: 200 eyes, one float after another, to both sides of it. Whether the reflection is total follows from
/// the ray and the normal as they are kept wherever their k is not within 8u of 0, and their k is within 8u of the truth's;
/// near it R reaches 1.
#[test]
fn case_43_critical_angle() {
    for place in PLACES {
        for material in ["ior = 1.5", "ior = 1.5\nfresnel = false"] {
            let scene = glass_plane(place, material);
            let [mut total, mut passed] = [0, 0];
            for step in -100..100 {
                let cosine = 5.0_f64.sqrt() / 3.0 + f64::from(step) * U;
                let truth = meeting(&scene, Engine::Reference, place, cosine, false).unwrap();
                let true_k = refracted_cosine_squared(&truth, 1.5).unwrap();
                for engine in engines() {
                    let ray = meeting(&scene, engine, place, cosine, false).unwrap();
                    let k = refracted_cosine_squared(&ray, 1.5).unwrap();
                    let at = format!("step {step}, {place:?}, {engine:?}, k = {k:e}: {ray:?}");
                    assert!((k - true_k).abs() <= 8.0 * U, "{true_k:e}: {at}");
                    assert!(k.abs() <= 4.0 * f64::EPSILON || ray.refract.is_none() == (k < 0.0), "{at}");
                    assert!(true_k.abs() <= 8.0 * U || ray.refract.is_none() == (true_k < 0.0), "{at}");
                    let reflected = ray.reflect.as_ref().map_or(0.0, |child| child.weight[0]);
                    let passes = ray.refract.as_ref().map_or(0.0, |child| child.weight[0]);
                    let is_schlick = !material.contains("false");
                    if is_schlick {
                        assert!(1.0 - reflected <= 5.0 * k.max(0.0).sqrt() + 4.0 * U, "{at}");
                    }
                    let all = if is_schlick || k < 0.0 { reflected + passes } else { passes };
                    assert!((all - 1.0).abs() <= 4.0 * U && (ray.colour[0] - 1.0).abs() <= 4.0 * U, "{at}");
                    if ray.refract.is_none() { total += 1 } else { passed += 1 }
                }
            }
            assert!(total > 200 && passed > 200, "{total} totally reflected, {passed} not");
        }
    }
}

/// Case 44: Snell at grazing, and R + T = 1: angles from head-on down to cosines of 10⁻⁶, indices from 0.3 to 4, entering and
/// leaving. What is tangential is kept to 6u, directions are unit to 4u, nothing is lost between the shares to 4u.
#[test]
fn case_44_snell_at_grazing_and_no_loss_at_any_angle() {
    for place in PLACES {
        let [mut total, mut passed] = [0, 0];
        for ior in ["0.3", "0.5", "0.75", "0.999", "1", "1.001", "1.33", "1.5", "2.4", "4"] {
            let scene = glass_plane(place, &format!("ior = {ior}"));
            let ior = f64::from(ior.parse::<f32>().unwrap());
            for above in [true, false] {
                for exponent in 0..=24 {
                    // 1, and from about 1 down to 10⁻⁶ by factors of 10^¼.
                    let cosine =
                        if exponent == 0 { 1.0 } else { 0.98 * 10.0_f64.powf(-f64::from(exponent) / 4.0) };
                    for engine in engines() {
                        let rounding = rounding_of(engine);
                        let ray = meeting(&scene, engine, place, cosine, above);
                        let Some(ray) = ray else {
                            // The eye is 2·cosine above the plane, whose corners are off by u of 9 in three axes.
                            assert!(place.turned && cosine < 16.0 * U, "{place:?} is missed at {cosine}");
                            continue;
                        };
                        let at =
                            format!("ior {ior}, above {above}, {cosine}, {place:?}, {engine:?}: {ray:?}");
                        let hit = ray.hit.as_ref().unwrap();
                        let mut sum = 0.0;
                        // Where nothing is reflected, head-on at index 1, there is no such ray.
                        if let Some(reflect) = &ray.reflect {
                            sum += reflect.weight[0];
                            assert!((length(reflect.direction) - 1.0).abs() <= 4.0 * rounding, "{at}");
                        }
                        if let Some(refract) = &ray.refract {
                            passed += 1;
                            sum += refract.weight[0];
                            assert!((length(refract.direction) - 1.0).abs() <= 4.0 * rounding, "{at}");
                            let normal = DVec3::from(hit.shading_normal);
                            let [d, t] = [ray.direction, refract.direction].map(DVec3::from);
                            let [here, there] = if hit.entering { [1.0, ior] } else { [ior, 1.0] };
                            let residual = (here * d.cross(normal) - there * t.cross(normal)).length();
                            // u of the larger index: both sides have it as a factor.
                            assert!(residual <= 6.0 * rounding * here.max(there), "{residual:e}: {at}");
                            assert!(t.dot(normal) <= 0.0, "{at}");
                        } else {
                            total += 1;
                            assert_eq!(sum, 1.0, "{at}");
                        }
                        assert!((sum - 1.0).abs() <= 4.0 * rounding, "{sum}: {at}");
                        assert!((ray.colour[0] - 1.0).abs() <= 4.0 * rounding, "{at}");
                    }
                }
            }
        }
        assert!(total > 500 && passed > 1000, "{total} totally reflected, {passed} not");
    }
}

/// The far side of a ball of glass, seen from its middle, as the only thing that shines.
fn through_a_ball(radius: f32, absorption: [f32; 3]) -> Scene {
    scene(&format!(
        "[image]\nsize = [2, 2]\n[render]\nmax_depth = 0\n[camera]\neye = [0, 0, 0]\ntarget = [0, 0, -1]\nup = [0, 1, 0]\nfov = 1\n\
         [ambient]\nintensity = 1\n[material.m]\nambient = 1\nior = 1\nabsorption = {absorption:?}\n\
         [[sphere]]\ncenter = [0, 0, 0]\nradius = {radius:e}\nmaterial = \"m\"\n"
    ))
}

/// Case 46: Beer 0·∞: what does not absorb stays 1 over the longest way that there is, and what does is gone; never a NaN. A way
/// that does not end meets nothing, and only what a ray meets from inside attenuates it.
#[test]
fn case_46_absorption_of_0_over_no_end() {
    let scene = through_a_ball(9e17, [0.0, 0.5, 1e17]);
    for engine in engines() {
        let image = render_with(&scene, engine).image;
        assert_eq!(image.pixels, [[1.0, 0.0, 0.0]; 4], "{engine:?}");
    }
    // From inside an open sheet of glass to nowhere: the reflected and the refracted ray both miss.
    let open = glass_plane(PLACES[0], "ior = 1.5\nabsorption = [0, 0.5, 1e17]");
    for engine in engines() {
        let ray = meeting(&open, engine, PLACES[0], 0.5, true).unwrap();
        assert!(ray.colour.iter().all(|channel| (channel - 1.0).abs() <= 4.0 * U), "{engine:?}: {ray:?}");
        let ray = meeting(&open, engine, PLACES[0], 0.9, false).unwrap();
        assert!((ray.colour[0] - 1.0).abs() <= 4.0 * U && ray.colour[2] == 0.0, "{engine:?}: {ray:?}");
    }
}

/// Case 47: Beer deep: e^(−σt) to (σt + 4)·4u, and where f32 has no normal numbers, to the spacing of those that it has. From
/// decimals of sixty digits, of σ as f32 holds it and t = 2.
#[test]
fn case_47_deep_absorption() {
    for (absorption, expected) in [
        (10.0, 2.061_153_622_438_558e-9),
        (40.0, 1.804_851_387_845_415_2e-35),
        (43.5, 1.645_811_431_082_273_7e-38),
        (43.7, 1.103_218_710_869_606_9e-38),
        (51.95, 7.530_133_357_747_39e-46),
        (52.0, 6.813_556_821_545_298e-46),
        (60.0, 7.667_648_073_721_999e-53),
        (1e17, 0.0),
    ] {
        let scene = through_a_ball(2.0, [absorption, 0.0, absorption]);
        let depth = 2.0 * f64::from(absorption);
        for engine in engines() {
            for pixel in render_with(&scene, engine).image.pixels {
                let [red, green, blue] = pixel.map(f64::from);
                let bound = f64::max((depth + 4.0) * 4.0 * U * expected, f64::from(f32::from_bits(1)));
                assert!((red - expected).abs() <= bound, "{red:e}, not {expected:e}, {engine:?}");
                assert_eq!((green, blue), (1.0, red), "{engine:?}");
            }
        }
    }
}
