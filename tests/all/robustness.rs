//! No holes and no acne, at any scale: what rounding must not do to a picture.

use crate::support::{STILL_LIFE, ball, pictures, render_region, render_with, scaled, scene, wavefront};
use glam::Vec3;
use wavelane::film::{Image, Region};
use wavelane::render::Engine;

#[test]
fn a_scene_looks_the_same_at_every_scale() {
    for engine in [Engine::Reference, wavefront()] {
        let expected = render_with(&scene(STILL_LIFE), engine).image;
        for exponent in [-30, -20, 20, 30] {
            let image = render_with(&scaled(scene(STILL_LIFE), exponent), engine).image;
            assert!(image == expected, "scaled by 2^{exponent}, {engine:?}");
        }
    }
}

#[test]
fn the_picture_does_not_depend_on_threads_or_crop() {
    let scene =
        scene(&STILL_LIFE.replace("[image]", "[render]\nsampling = \"jittered\"\nsamples = 2\n[image]"));
    let region = Region { x0: 13, y0: 7, x1: 50, y1: 41 };
    for engine in [Engine::Reference, wavefront()] {
        let whole = render_with(&scene, engine).image;
        for threads in [1, 2, 5] {
            let part = render_region(&scene, engine, region, threads).image;
            for (y, x) in (0..part.height).flat_map(|y| (0..part.width).map(move |x| (y, x))) {
                let expected = whole.pixels[whole.index(x + region.x0, y + region.y0)];
                let found = part.pixels[part.index(x, y)];
                assert_eq!(found, expected, "pixel ({x}, {y}) on {threads} threads, {engine:?}");
            }
        }
    }
}

/// Nothing of the background is seen from inside a closed ball, whatever edges the rays of a fine grid pass by.
#[test]
fn no_ray_leaves_a_closed_mesh() {
    for (center, radius) in [(Vec3::ZERO, 1.0), (Vec3::ZERO, 1e-6), (Vec3::new(1000.0, -2000.0, 500.0), 1.0)]
    {
        for quads in [false, true] {
            let [x, y, z] = center.to_array();
            for target in [[1.0, 0.0, 0.0], [0.0, -1.0, 0.2], [0.3, 0.4, 1.0]] {
                let target = center + radius * Vec3::from(target);
                let pictures = pictures(&format!(
                    "[image]\nsize = [200, 200]\nbackground = 1\n[camera]\neye = [{x}, {y}, {z}]\ntarget = {:?}\nup = [0.1, 0.9, 0.3]\nfov = 100\n[material.m]\n{}",
                    target.to_array(),
                    ball(center, radius, quads)
                ));
                for (engine, image) in pictures {
                    let holes = image.pixels.iter().filter(|pixel| **pixel != [0.0; 3]).count();
                    assert_eq!(holes, 0, "ball at {center} of radius {radius}, quads {quads}, {engine}");
                }
            }
        }
    }
}

/// Rays that fall exactly on the seams and corners of a tiled plane; tiles of both senses, polygons beside triangles.
#[test]
fn no_ray_falls_between_tiles() {
    let mut tiles = String::new();
    for (x, y) in (0..8).flat_map(|x| (0..8).map(move |y| (x, y))) {
        let corners = [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)].map(|(x, y)| format!("[{x}, {y}, 0]"));
        let [a, b, c, d] = &corners;
        // Blocks of four alike, so that every seam between two of a kind and two kinds is there.
        tiles += &match (x / 2 + 2 * (y / 2)) % 3 {
            0 => format!("[[polygon]]\nvertices = [{a}, {b}, {c}, {d}]\nmaterial = \"m\"\n"),
            1 => format!("[[polygon]]\nvertices = [{d}, {c}, {b}, {a}]\nmaterial = \"m\"\n"),
            _ => format!(
                "[[triangle]]\nvertices = [{a}, {b}, {c}]\nmaterial = \"m\"\n[[triangle]]\nvertices = [{a}, {c}, {d}]\nmaterial = \"m\"\n"
            ),
        };
    }
    // The middles of 14 × 14 pixels of half a unit, from (1, 1) to (7.5, 7.5): lattice points and the middles between.
    let pictures = pictures(&format!(
        "[image]\nsize = [14, 14]\nbackground = 1\n[camera]\nkind = \"orthographic\"\neye = [4.25, 4.25, 3]\ntarget = [4.25, 4.25, 0]\nup = [0, 1, 0]\nheight = 7\n[material.m]\n{tiles}"
    ));
    for (engine, image) in pictures {
        let holes = image.pixels.iter().filter(|pixel| **pixel != [0.0; 3]).count();
        assert_eq!(holes, 0, "{engine}: {:?}", image.pixels);
    }
}

/// On a convex solid every point that faces the light is lit: a dark one has shadowed itself or its neighbour.
#[test]
fn no_face_of_a_convex_solid_shadows_itself_or_its_neighbour() {
    for (center, radius) in [(Vec3::ZERO, 1.0), (Vec3::ZERO, 1e-6), (Vec3::new(1000.0, -2000.0, 500.0), 1.0)]
    {
        for quads in [false, true] {
            let eye = (center + radius * Vec3::new(1.0, 3.0, 2.0)).to_array();
            let pictures = pictures(&format!(
                "[image]\nsize = [240, 240]\nbackground = 1\n[camera]\neye = {eye:?}\ntarget = {:?}\nup = [0, 0, 1]\nfov = 32\n\
                 [[light]]\nposition = {eye:?}\n[material.m]\ndiffuse = 1\n{}",
                center.to_array(),
                ball(center, radius, quads)
            ));
            // The light is at the eye, so whatever is seen faces the light.
            for (engine, image) in pictures {
                let dark = image.pixels.iter().filter(|pixel| **pixel == [0.0; 3]).count();
                assert_eq!(dark, 0, "ball at {center} of radius {radius}, quads {quads}, {engine}");
                assert!(image.pixels.iter().any(|pixel| pixel[0] < 1.0), "the ball is in view");
            }
        }
    }
}

/// A light that lies in a surface lights what is before that surface, without speckles.
#[test]
fn a_light_on_a_surface_is_not_hidden_by_it() {
    let toml = |light: &str| {
        format!(
            "[image]\nsize = [60, 60]\n[camera]\nkind = \"orthographic\"\neye = [0, 0, 2.9]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nheight = 4\n\
             {light}[material.m]\ndiffuse = 1\n\
             [[polygon]]\nvertices = [[-9, -9, 0.1], [9, -9, 0.3], [9, 9, 0.3], [-9, 9, 0.1]]\nmaterial = \"m\"\n\
             [[polygon]]\nvertices = [[-9, -9, 3], [9, -9, 3], [9, 9, 3], [-9, 9, 3]]\nmaterial = \"m\"\n"
        )
    };
    let lit = |image: &Image| image.pixels.iter().filter(|pixel| pixel[0] > 0.0).count();
    for (engine, image) in pictures(&toml("[[light]]\nposition = [0.7, 0.3, 3]\n")) {
        assert_eq!(lit(&image), 3600, "{engine}");
    }
    for (engine, image) in pictures(&toml("[[light]]\nposition = [0.7, 0.3, 3.1]\n")) {
        assert_eq!(lit(&image), 0, "behind it, it is hidden, {engine}");
    }
}

/// A small triangle in the plane of a polygon, both tilted so that no f64 holds the plane; the polygon is much larger,
/// so its distance is rounded much more coarsely.
#[test]
fn a_shape_on_a_large_one_is_seen_whole_and_not_shadowed_by_it() {
    for size in [1.0, 1e3, 1e6, 1e9] {
        let looking = "[image]\nsize = [60, 60]\n[camera]\nkind = \"orthographic\"\neye = [10, 10.3, 10.7]\ntarget = [0, 0, 0]\nup = [0, 0, 1]\nheight = 1\n";
        let shapes = format!(
            "[[triangle]]\nvertices = [[1, -1, 0], [0, 1, -1], [-1, 0, 1]]\nmaterial = \"small\"\n\
             [[polygon]]\nvertices = [[{size}, -{size}, 0], [0, {size}, -{size}], [-{size}, 0, {size}]]\nmaterial = \"large\"\n"
        );
        let lit = pictures(&format!(
            "{looking}[[light]]\nposition = [8, 9, 10]\n[material.small]\ndiffuse = 1\n[material.large]\ndiffuse = 0.5\n{shapes}"
        ));
        for (engine, lit) in lit.into_iter().filter(|(engine, _)| tells_apart(engine, size)) {
            let wrong = lit.pixels.iter().filter(|pixel| pixel[0] < 0.9).count();
            assert_eq!(wrong, 0, "pixels that show the large one, or a shadow, at size {size}, {engine}");
        }
        // As panes of one plane: the ray that leaves the first does not meet the second.
        let panes = pictures(&format!(
            "{}[material.small]\nior = 1.5\nfresnel = false\ntransmission = 0.5\n[material.large]\nior = 1.5\nfresnel = false\ntransmission = 0.5\n{shapes}",
            looking.replace("size = [60, 60]", "size = [60, 60]\nbackground = 1")
        ));
        for (engine, panes) in panes.into_iter().filter(|(engine, _)| tells_apart(engine, size)) {
            let wrong = panes.pixels.iter().filter(|pixel| **pixel != [0.5; 3]).count();
            assert_eq!(wrong, 0, "panes at size {size}, {engine}");
        }
    }
}

/// The wavefront engine takes hits for coincident that agree to 32 bits. Where a polygon is 2²⁰ times as far across as t is
/// long, the rounding of f64 is seen at that place, and a pixel here or there shows the larger one.
fn tells_apart(engine: &str, size: f64) -> bool {
    engine == "reference" || size < 1e6
}

/// A sphere, a triangle and a square that are nearly all that there is, seen from so near above that f32 cannot tell on which
/// side of them the eye is.
#[test]
fn the_ground_is_seen_from_close_above_however_large_it_is() {
    for (size, height) in [(1e4, 0.01), (1e6, 1.0), (1e6, 0.01), (1e7, 0.01), (1e9, 1.0)] {
        let grounds = [
            format!("[[sphere]]\ncenter = [0, -{size}, 0]\nradius = {size}\n"),
            format!(
                "[[triangle]]\nvertices = [[-{size}, 0, -{size}], [{size}, 0, -{size}], [0, 0, {size}]]\n"
            ),
            format!(
                "[[polygon]]\nvertices = [[-{size}, 0, -{size}], [{size}, 0, -{size}], [{size}, 0, {size}], [-{size}, 0, {size}]]\n"
            ),
        ];
        for ground in grounds {
            // All rays fall steeply enough to meet the sphere as they meet the plane that touches it.
            let pictures = pictures(&format!(
                "[image]\nsize = [64, 64]\nbackground = 1\n[camera]\neye = [0.3, {height}, -{height}]\ntarget = [0.3, 0, 0]\nup = [0, 1, 0]\nfov = 60\n\
                 [[light]]\ndirection = [0, -1, 0]\n[material.m]\ndiffuse = 0.5\n{ground}material = \"m\"\n"
            ));
            for (engine, image) in pictures {
                let wrong = image.pixels.iter().filter(|pixel| (pixel[0] - 0.5).abs() > 1e-3).count();
                assert_eq!(wrong, 0, "{engine}, from {height} above\n{ground}");
            }
        }
    }
}

/// A closed room, seen from inside at 1/100 of a degree a pixel where two walls meet, with a light outside that shines along
/// one of them: shadow rays start next to the edge and pass it closely.
#[test]
fn no_light_comes_through_the_inner_edge_of_a_room() {
    // Three times a rotation, in whole numbers: the four corners of a wall lie in a plane.
    let turn = glam::Mat3::from_cols_array(&[2.0, 1.0, 2.0, -2.0, 2.0, 1.0, 1.0, 2.0, -2.0]);
    let corners: [Vec3; 8] = std::array::from_fn(|at| {
        turn * Vec3::from([0, 1, 2].map(|axis| if at >> axis & 1 == 1 { 1.0 } else { -1.0 }))
    });
    let walls = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let eye = turn * Vec3::new(0.1, 0.2, -0.3);
    for (edge, light) in
        [([5, 7], [3.0, 0.2, 0.999]), ([3, 7], [3.0, 0.999, 0.1]), ([6, 7], [0.2, 5.0, 0.99])]
    {
        let light = turn * Vec3::from(light);
        let [from, to] = edge.map(|corner| corners[corner]);
        for quads in [false, true] {
            let walls: String = walls
                .iter()
                .map(|&[a, b, c, d]| match quads {
                    true => face("polygon", &[a, b, c, d].map(|corner| corners[corner])),
                    false => [[a, b, c], [a, c, d]]
                        .map(|face_corners| face("triangle", &face_corners.map(|corner| corners[corner])))
                        .concat(),
                })
                .collect();
            for share in [0.1, 0.5, 0.8] {
                let target = from.lerp(to, share).to_array();
                let pictures = pictures(&format!(
                    "[image]\nsize = [64, 64]\nbackground = 1\n[camera]\neye = {:?}\ntarget = {target:?}\nup = [0.1, 0.9, 0.3]\nfov = 0.64\n\
                     [[light]]\nposition = {:?}\n[material.m]\ndiffuse = 1\n{walls}",
                    eye.to_array(),
                    light.to_array()
                ));
                for (engine, image) in pictures {
                    let lit = image.pixels.iter().filter(|pixel| **pixel != [0.0; 3]).count();
                    assert_eq!(lit, 0, "{engine}, quads {quads}, edge {edge:?} at {share}");
                }
            }
        }
    }
}

fn face(kind: &str, corners: &[Vec3]) -> String {
    let corners: Vec<String> = corners.iter().map(|corner| format!("{:?}", corner.to_array())).collect();
    format!("[[{kind}]]\nvertices = [{}]\nmaterial = \"m\"\n", corners.join(", "))
}

/// A convex solid hides no light from itself and sees nothing of itself, where light leaves its face at whatever small angle.
#[test]
fn a_convex_solid_does_not_meet_itself_at_grazing_angles() {
    let turn = glam::Mat3::from_cols_array(&[2.0, 1.0, 2.0, -2.0, 2.0, 1.0, 1.0, 2.0, -2.0]);
    let world = |x: f32, y: f32, z: f32| (turn * Vec3::new(x, y, z)).to_array();
    let corners: [Vec3; 8] = std::array::from_fn(|at| {
        turn * Vec3::from([0, 1, 2].map(|axis| if at >> axis & 1 == 1 { 1.0 } else { -1.0 }))
    });
    let walls = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    for quads in [false, true] {
        let walls: String = walls
            .iter()
            .map(|&[a, b, c, d]| match quads {
                true => face("polygon", &[a, b, c, d].map(|corner| corners[corner])),
                false => [[a, b, c], [a, c, d]]
                    .map(|face_corners| face("triangle", &face_corners.map(|corner| corners[corner])))
                    .concat(),
            })
            .collect();
        for exponent in [8, 12, 16, 18, 20] {
            // The rise from the face x = 1 for each unit along it.
            let rise = 0.5_f32.powi(exponent);
            let image = "[image]\nsize = [300, 300]\nbackground = 1\n[render]\nmax_depth = 1\n";
            let shone_on = pictures(&format!(
                "{image}[camera]\nkind = \"orthographic\"\neye = {:?}\ntarget = {:?}\nup = {:?}\nheight = 5.99\n\
                 [[light]]\nposition = {:?}\n[material.m]\ndiffuse = 1e9\n{walls}",
                world(5.0, 0.0, 0.0),
                world(1.0, 0.0, 0.0),
                world(0.0, 0.0, 1.0),
                world(1.0 + 5.0 * rise, 0.2, 5.0),
            ));
            for (engine, image) in shone_on {
                let dark = image.pixels.iter().filter(|pixel| **pixel == [0.0; 3]).count();
                assert_eq!(dark, 0, "shadows, {engine}, quads {quads}, rising by 2^-{exponent}");
            }
            if exponent <= 16 {
                let mirroring = pictures(&format!(
                    "{image}[camera]\nkind = \"orthographic\"\neye = {:?}\ntarget = {:?}\nup = {:?}\nheight = {}\n\
                     [material.m]\nmirror = 1\n{walls}",
                    world(1.0 + 4.0 * rise, 0.3, -4.0),
                    world(1.0, 0.1, 0.0),
                    world(1.0, 0.0, 0.0),
                    5.4 * rise
                ));
                for (engine, image) in mirroring {
                    let dark = image.pixels.iter().filter(|pixel| **pixel != [1.0; 3]).count();
                    assert_eq!(dark, 0, "mirrors, {engine}, quads {quads}, falling by 2^-{exponent}");
                }
            }
        }
    }
}
