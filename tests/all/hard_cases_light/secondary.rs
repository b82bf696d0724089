//! Rays that start on surfaces, and normals that are not the surface's own.

use super::{Place, U, aimed, each_ray, engines, rounding_of};
use crate::support::{Folder, ball, render_with, scene};
use glam::{DVec3, Vec3};
use std::sync::atomic::AtomicBool;
use wavelane::lanes::Width;
use wavelane::load::load;
use wavelane::prepare::Prepared;
use wavelane::rays::{Departure, RaySet, Start};
use wavelane::reference::Tracer;
use wavelane::render::Engine;
use wavelane::scene::{PrimitiveId, Scene};
use wavelane::trace::{Hits, Query, RayColumns, ReferenceRun, Run};

/// What rays hit, by every engine.
fn traced(scene: &Scene, rays: &RaySet) -> Vec<(Engine, Hits)> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let (stop, prepared) = (AtomicBool::new(false), Prepared::new(scene).unwrap());
    let tracer = Tracer::new(scene, &stop);
    let mut reference = ReferenceRun::new(&tracer, rays, Query::Closest);
    reference.pass(&pool);
    let by_reference = (Engine::Reference, reference.hits().clone());
    let columns = RayColumns::new(&prepared, rays);
    let wavefront = Width::ALL.map(|width| {
        let mut run = Run::new(&prepared, &columns, Query::Closest);
        run.pass(width, &pool);
        (Engine::wavefront(width), run.hits())
    });
    [by_reference].into_iter().chain(wavefront).collect()
}

/// Case 6: Leaving the surface: the event says on which side a ray is, and not the sign of a root that is 0 but for rounding.
/// A ray that leaves a ball outward never meets it, whatever the direction as it was rounded; inward, it meets the far side,
/// at −2(o − c)·d / d·d.
#[test]
fn case_6_leaving_the_surface() {
    for (center, radius) in [
        (Vec3::ZERO, 1.0),
        (Vec3::ZERO, 1e-5),
        (Vec3::new(1000.0, -2000.0, 500.0), 0.25),
        (Vec3::Y * 1e6, 1e6),
    ] {
        let scene = scene(&format!(
            "[image]\nsize = [1, 1]\n[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nfov = 45\n[material.m]\n\
             [[sphere]]\ncenter = {:?}\nradius = {radius:e}\nmaterial = \"m\"\n",
            center.to_array()
        ));
        let mut rays = RaySet::default();
        let mut expected = Vec::new();
        for normal in
            [Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.6, 0.48, -0.64), Vec3::X, Vec3::new(-0.28, 0.96, 0.0)]
        {
            let exact = center.as_dvec3() + f64::from(radius) * normal.as_dvec3().normalize();
            let origin = exact.as_vec3();
            let origin_low = (exact - origin.as_dvec3()).as_vec3().to_array();
            let tangent = normal.cross(Vec3::new(0.3, 0.5, 0.7)).normalize();
            for lean in [1.0, 1e-2, 1e-4, 1e-6, 1e-9, 0.0, -1e-9, -1e-7] {
                let outward = tangent + lean * normal;
                for (direction, inward) in [(outward, false), (tangent - lean.max(1e-4) * normal, true)] {
                    let [ox, oy, oz] = origin.to_array();
                    let [dx, dy, dz] = direction.to_array();
                    rays.rows.push([ox, oy, oz, 0.0, dx, dy, dz, f32::INFINITY]);
                    let departure = Departure { from: PrimitiveId(0), inward };
                    rays.starts.push(Start { origin_low, departure });
                    let direction = direction.as_dvec3();
                    let far = -2.0 * (exact - center.as_dvec3()).dot(direction) / direction.length_squared();
                    expected.push(inward.then_some(far));
                }
            }
        }
        for (engine, hits) in traced(&scene, &rays) {
            for (row, expected) in expected.iter().enumerate() {
                let at = format!("{:?} from {center} {radius}, {engine:?}", rays.rows[row]);
                match expected {
                    None => assert_eq!(hits.id[row], Hits::MISS, "{at}"),
                    Some(far) => {
                        assert_eq!(hits.id[row], 0, "{at}");
                        // In f32 the start is off by u of the coordinates; that is so much of t.
                        let coordinates = f64::from(center.abs().max_element() + radius);
                        let tolerance = 8.0 * U * (coordinates + far);
                        assert!(
                            (f64::from(hits.t[row]) - far).abs() <= tolerance,
                            "{} for {far}: {at}",
                            hits.t[row]
                        );
                    }
                }
            }
        }
    }
}

/// 6: A ray that starts exactly on a face, which it is not said to leave, meets it at t = 0 and nowhere else: no hit. Corners are whole
/// numbers and starts eighths of the way between them, so nothing is rounded but the normal's length.
#[test]
fn case_6_a_start_exactly_on_a_face_is_no_hit() {
    let spans = [
        ([5, -2, 7], [-3, 6, 9]),
        ([1, 2, 2], [-2, -1, 2]),
        ([3, 0, 0], [0, 0, -4]),
        ([7, -11, 3], [2, 5, -13]),
        ([0, 1, 1], [1, 0, 0]),
    ];
    let l_shape: [[f32; 2]; 6] = [[0.0, 0.0], [8.0, 0.0], [8.0, 2.0], [2.0, 2.0], [2.0, 8.0], [0.0, 8.0]];
    let holds = |u: i8, v: i8| (u <= 8 && v <= 2) || (u <= 2 && v <= 8);
    let mut starts = 0;
    for ((u, v), is_polygon) in spans.into_iter().flat_map(|span| [(span, false), (span, true)]) {
        let [u, v] = [u, v].map(|vector| Vec3::from(vector.map(|component: i8| f32::from(component))));
        let place = |[along_u, along_v]: [f32; 2]| {
            Vec3::new(1.0, 2.0, -3.0) + (along_u / 8.0) * u + (along_v / 8.0) * v
        };
        let corners = if is_polygon {
            l_shape.map(place).to_vec()
        } else {
            [[0.0, 0.0], [8.0, 0.0], [0.0, 8.0]].map(place).to_vec()
        };
        let upright = Place { turned: false, offset: 0.0 };
        let face = upright.face(if is_polygon { "polygon" } else { "triangle" }, &corners, "m");
        let scene = scene(&format!(
            "[image]\nsize = [1, 1]\n[camera]\neye = [0, 0, 99]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nfov = 45\n[material.m]\n{face}"
        ));
        let normal = u.cross(v).normalize();
        let mut rays = RaySet::default();
        for (along_u, along_v) in (0..=8_i8).flat_map(|u| (0..=8_i8).map(move |v| (u, v))) {
            if !(if is_polygon { holds(along_u, along_v) } else { along_u + along_v <= 8 }) {
                continue;
            }
            let [ox, oy, oz] = place([f32::from(along_u), f32::from(along_v)]).to_array();
            for turn in 0..24_u8 {
                let (sin, cos) = (0.7 + 0.26 * f32::from(turn)).sin_cos();
                let height = [1.0, 0.1, -0.01, -1.0][usize::from(turn % 4)];
                let direction = cos * u.normalize() + sin * u.cross(normal).normalize() + height * normal;
                let [dx, dy, dz] = direction.to_array();
                rays.rows.push([ox, oy, oz, 0.0, dx, dy, dz, f32::INFINITY]);
            }
        }
        starts += rays.len();
        for (engine, hits) in traced(&scene, &rays) {
            for (row, id) in rays.rows.iter().zip(&hits.id) {
                assert_eq!(*id, Hits::MISS, "{row:?} on {corners:?}, {engine:?}");
            }
        }
    }
    assert!(starts > 8000, "{starts} rays");
}

/// Mirrors around which nothing is, near the origin and seen from 10⁴ away, show the background: what is black has met itself.
/// Returns at how many pixels that happens where the primary ray's hit is certain, and where it is not.
fn self_hits(name: &str, shapes: &str, center: Vec3, radius: f32) -> [usize; 2] {
    let mut hits = [0; 2];
    for direction in [Vec3::new(0.48, 0.64, 0.6), Vec3::new(-0.2, 0.3, 0.93), Vec3::X] {
        let scene = scene(&format!(
            "[image]\nsize = [96, 96]\nbackground = 1\n[render]\nmax_depth = 1\n[camera]\neye = {:?}\ntarget = {:?}\n\
             up = [0.1, 0.2, 0.9]\nfov = {:e}\n[material.m]\nmirror = 1\n{shapes}",
            (1e4 * direction).to_array(),
            center.to_array(),
            (2.1 * radius / 1e4).to_degrees()
        ));
        let stop = AtomicBool::new(false);
        let tracer = Tracer::new(&scene, &stop);
        for engine in engines() {
            let rendered = render_with(&scene, engine);
            assert!(rendered.rays.reflect > 200, "{} mirrored by the {name}", rendered.rays.reflect);
            for (y, x) in (0..96).flat_map(|y| (0..96).map(move |x| (y, x))) {
                if rendered.image.pixels[rendered.image.index(x, y)] != [1.0; 3] {
                    let is_certain = engine == Engine::Reference || tracer.primary_hit(x, y, 0).is_certain;
                    hits[usize::from(!is_certain)] += 1;
                }
            }
        }
    }
    hits
}

/// Name, scene text, middle and size.
fn mirrors() -> Vec<(&'static str, String, Vec3, f32)> {
    let tilted = Place { turned: true, offset: 0.0 };
    let corners = [Vec3::new(-1.0, -0.8, 0.1), Vec3::new(1.1, -0.7, -0.2), Vec3::new(0.1, 0.9, 0.3)];
    let square = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.2));
    let center = Vec3::new(0.1, 0.2, -0.1);
    let spheres = [1.0, 0.1, 0.01, 1e-3].map(|radius| ("sphere", sphere(center, radius), center, radius));
    let others = [
        ("triangle", tilted.face("triangle", &corners, "m"), center, 1.0),
        ("polygon", tilted.face("polygon", &square, "m"), center, 1.0),
        ("ball of triangles", ball(center, 1.0, false), center, 1.0),
        ("ball of quadrilaterals", ball(center, 1.0, true), center, 1.0),
    ];
    spheres.into_iter().chain(others).collect()
}

fn sphere(center: Vec3, radius: f32) -> String {
    format!("[[sphere]]\ncenter = {:?}\nradius = {radius:e}\nmaterial = \"m\"\n", center.to_array())
}

/// Case 50: o + t·d far away: a start that is found from so far off is on its surface all the same. Where f32 meets the outline of a
/// closed mesh that the ray passes by, it meets the faces on both sides of the edge, and beyond the edge the plane of the one that is
/// turned away may be the nearer: that is then what is seen, from inside. So it is at no more than one pixel in 10⁴, and only
/// where the primary ray's own hit is not certain; a sphere, a triangle and a polygon never see themselves.
#[test]
fn case_50_a_start_found_from_far_away() {
    for (name, shapes, center, radius) in mirrors() {
        let [certain, outline] = self_hits(name, &shapes, center, radius);
        let pixels = 3 * engines().count() * 96 * 96;
        let most = if name.starts_with("ball") { pixels / 10_000 } else { 0 };
        assert_eq!(certain, 0, "self-hits of the {name} of radius {radius}");
        assert!(outline <= most, "{outline} self-hits along the outline of the {name} of radius {radius}");
    }
}

/// A ball of 16 × 8 quadrilaterals, cut in two, with the ball's own normals at its corners.
fn smooth_ball() -> String {
    let (sectors, rings) = (16, 8);
    let mut obj = String::new();
    for (ring, sector) in (0..=rings).flat_map(|ring| (0..sectors).map(move |sector| (ring, sector))) {
        let polar = std::f64::consts::PI * f64::from(ring) / f64::from(rings);
        let azimuth = std::f64::consts::TAU * f64::from(sector) / f64::from(sectors);
        let (x, y, z) = (polar.sin() * azimuth.cos(), polar.sin() * azimuth.sin(), polar.cos());
        obj += &format!("v {x:.9} {y:.9} {z:.9}\nvn {x:.9} {y:.9} {z:.9}\n");
    }
    for (ring, sector) in (0..rings).flat_map(|ring| (0..sectors).map(move |sector| (ring, sector))) {
        let at = |down: i32, right: i32| (ring + down) * sectors + (sector + right) % sectors + 1;
        let [a, b, c, d] = [at(0, 0), at(1, 0), at(1, 1), at(0, 1)];
        for [a, b, c] in [[a, b, c], [a, c, d]] {
            obj += &format!("f {a}//{a} {b}//{b} {c}//{c}\n");
        }
    }
    obj
}

/// Case 55: Shadow terminator: where the light grazes, the edge of light and dark on a coarse ball follows its faces, since a
/// face that looks away from the light is dark whatever its vertex normals say. That is the model's answer and not rounding,
/// so it is compared with the true ball's and reported, and the engines are held to agree on it. It stays near the true
/// edge: within a face, the ball's normal is not farther from the face's than half the face's diagonal.
#[test]
fn case_55_shadow_terminator() {
    let folder = Folder::new();
    folder.write("ball.obj", smooth_ball());
    for degrees in [80.0_f64, 90.0, 100.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let of = |shape: &str| {
            let toml = format!(
                "[image]\nsize = [128, 128]\n[camera]\nkind = \"orthographic\"\neye = [0, -5, 0]\ntarget = [0, 0, 0]\nup = [0, 0, 1]\n\
                 height = 2\n[[light]]\ndirection = [{}, {}, -0.1]\n[material.m]\ndiffuse = 1\n{shape}material = \"m\"\n",
                -sin, cos
            );
            load(&folder.write("scene.toml", toml)).unwrap().scene
        };
        let coarse = of("[[mesh]]\nfile = \"ball.obj\"\n");
        let truth = render_with(&of("[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n"), Engine::Reference).image;
        let to_light = DVec3::new(sin, -cos, 0.1).normalize();
        let mut counts = Vec::new();
        for engine in engines() {
            let image = render_with(&coarse, engine).image;
            let [mut darker, mut lighter, mut farthest] = [0.0; 3];
            for (row, column) in (0..128).flat_map(|row| (0..128).map(move |column| (row, column))) {
                let at = |index: u32| (f64::from(index) + 0.5) / 64.0 - 1.0;
                let (x, z) = (at(column), -at(row));
                let depth = 1.0 - x * x - z * z;
                if depth < 0.05 {
                    continue; // the outlines differ too
                }
                let index = image.index(column, row);
                let (is_lit, should_be) = (image.pixels[index][0] > 0.0, truth.pixels[index][0] > 0.0);
                if is_lit != should_be {
                    let from_edge = DVec3::new(x, -depth.sqrt(), z).dot(to_light).asin().to_degrees().abs();
                    farthest = f64::max(farthest, from_edge);
                    if should_be { darker += 1.0 } else { lighter += 1.0 }
                }
            }
            counts.push((darker, lighter));
            if engine == Engine::Reference {
                eprintln!(
                    "light at {degrees}°: {darker} pixels darker than the ball, {lighter} lighter, up to {farthest:.1}° from its edge"
                );
            }
            let half_diagonal = 22.5 / 2.0_f64.sqrt();
            assert!(farthest < half_diagonal, "{farthest}° from the edge, light at {degrees}°, {engine:?}");
        }
        assert!(counts[0].0 > 20.0, "the coarse ball's edge shows: {counts:?}");
        let close = |a: f64, b: f64| (a - b).abs() <= 2.0;
        let agree =
            counts.iter().all(|&(darker, lighter)| close(darker, counts[0].0) && close(lighter, counts[0].1));
        assert!(agree, "pixels that are darker and lighter, by engine: {counts:?}");
    }
}

/// Case 56: Reflection below the facet: vertex normals lean 60° over, and a mirrored ray still leaves on the side that it came
/// from. Where the facet's normal is one of the axes, r·n ≥ 0 to the bit; where it is rounded itself, to 2u.
#[test]
fn case_56_reflection_below_the_facet() {
    let folder = Folder::new();
    for turned in [false, true] {
        let place = Place { turned, offset: 0.0 };
        for azimuth in [0.0_f32, 100.0, 180.0, 250.0] {
            let (sin, cos) = azimuth.to_radians().sin_cos();
            let leaning = place.direction(Vec3::new(0.866_025_4 * cos, 0.866_025_4 * sin, 0.5)).to_array();
            let corners =
                [[-5.0, -5.0], [5.0, -5.0], [0.0, 5.0]].map(|[x, y]| place.point(Vec3::new(x, y, 0.0)));
            let [[a, b, c], [nx, ny, nz]] =
                [corners.map(|corner| corner.to_array()), [leaning, leaning, leaning]];
            let line = |[x, y, z]: [f32; 3]| format!("{x} {y} {z}");
            let vertices = [a, b, c].map(|corner| format!("v {}\n", line(corner))).concat();
            assert!(nx == ny && ny == nz);
            folder.write("leaning.obj", format!("{vertices}vn {}\nf 1//1 2//1 3//1\n", line(nx)));
            let toml = "[image]\nsize = [1, 1]\nbackground = 1\n[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nfov = 1\n\
                        [material.m]\nmirror = 0.5\nior = 1.5\n[[mesh]]\nfile = \"leaning.obj\"\nmaterial = \"m\"\n";
            let scene = load(&folder.write("scene.toml", toml)).unwrap().scene;
            let facet = place.direction(Vec3::Z).as_dvec3();
            for engine in engines() {
                let least = if turned { 2.0 * rounding_of(engine) } else { 0.0 };
                // From above the facet, down to a thousandth of a degree.
                for degrees in [90.0_f32, 45.0, 10.0, 1.0, 0.1, 1e-2, 1e-3] {
                    for side in [1.0, -1.0] {
                        let (sin, cos) = degrees.to_radians().sin_cos();
                        let eye = place.point(Vec3::new(side * cos, 0.1 * cos, sin));
                        let ray = aimed(&scene, engine, eye, Vec3::ZERO);
                        let mut rays = 0;
                        each_ray(&ray, 0, &mut |ray, _| {
                            let Some(hit) = &ray.hit else { return };
                            let up = DVec3::from(hit.geometric_normal);
                            assert!(up.dot(facet) > 0.0, "it is seen from above");
                            let at = format!("{azimuth}°, {degrees}°, turned {turned}, {engine:?}: {ray:?}");
                            let reflected = ray.reflect.as_ref().expect("a mirrored ray");
                            assert!(DVec3::from(reflected.direction).dot(up) >= -least, "{at}");
                            assert!(reflected.hit.is_none(), "{at}");
                            if let Some(refracted) = &ray.refract {
                                assert!(DVec3::from(refracted.direction).dot(up) <= least, "{at}");
                            }
                            rays += 1;
                        });
                        assert_eq!(rays, 1, "the facet is met at {degrees}°, {engine:?}");
                    }
                }
            }
        }
    }
}
