//! Files that other programs write: what NFF, OBJ, MTL and PLY say, and what of it ends in the scene.

use crate::support::Folder;
use glam::Vec3;
use wavelane::load::{Loaded, load};
use wavelane::scene::{Dielectric, Fresnel, Light, Material, Projection, Rgb, Scene, Triangle};

fn loaded(files: &[(&str, &str)]) -> Loaded {
    let folder = Folder::new();
    for (name, content) in files {
        folder.write(name, content);
    }
    load(&folder.file(files[0].0)).unwrap_or_else(|error| panic!("{error}"))
}

fn scene(files: &[(&str, &str)]) -> Scene {
    loaded(files).scene
}

fn messages(loaded: &Loaded) -> Vec<&str> {
    loaded.warnings.iter().map(|warning| warning.message.as_str()).collect()
}

#[test]
fn nff_words_may_stand_on_any_line() {
    let tidy = "b 0.1 0.2 0.3\nv\nfrom 1 2 3\nat 0 0 0\nup 0 0 1\nangle 30\nhither 1\nresolution 64 48\nl 1 1 1\nl 2 2 2 0.5 0.6 0.7\nf 1 0.5 0.25 0.8 0.4 10 0 1\ns 0 0 0 1\np 3\n0 0 0\n1 0 0\n0 1 0\n";
    let wrapped: String = tidy.split_whitespace().map(|word| format!("{word} # comment\r\n\t ")).collect();
    let scene = scene(&[("a.nff", tidy)]);
    assert_eq!(scene, self::scene(&[("a.nff", &wrapped)]));
    assert_eq!(
        (scene.image.width, scene.image.height, scene.image.background),
        (64, 48, Rgb::new(0.1, 0.2, 0.3))
    );
    assert_eq!(scene.camera.eye, Vec3::new(1.0, 2.0, 3.0));
    assert_eq!(scene.camera.projection, Projection::PerspectiveAngle { vertical_degrees: 30.0 });
    assert_eq!((scene.render.samples, scene.render.max_depth), (1, 4));
}

#[test]
fn nff_fills_become_materials() {
    let scene = scene(&[(
        "a.nff",
        "f 1 0.5 0.25 0.8 0.4 10 0 1.5\ns 0 0 0 1\nf 1 0.5 0.25 0.8 0.4 10 0.5 0\ns 0 0 0 -2\n",
    )]);
    let opaque = Material {
        diffuse: Rgb::new(0.8, 0.4, 0.2),
        specular: Rgb::splat(0.4),
        shininess: 10.0,
        mirror: Rgb::splat(0.4),
        ..Material::default()
    };
    let clear = Dielectric {
        ior: 1.0,
        absorption: Rgb::ZERO,
        transmission: Rgb::new(0.5, 0.25, 0.125),
        fresnel: Fresnel::Fixed,
    };
    assert_eq!(scene.materials, [opaque, Material { dielectric: Some(clear), ..opaque }]);
    assert_eq!(scene.geometry.spheres[1].radius, 2.0);
}

#[test]
fn nff_lights_without_a_colour_share_the_light() {
    let scene = scene(&[("a.nff", "l 1 0 0\nl 2 0 0 1 0 0\nl 3 0 0\nl 4 0 0\n")]);
    let colors: Vec<Rgb> = scene
        .lights
        .iter()
        .map(|light| match light {
            Light::Point { intensity, .. } | Light::Directional { intensity, .. } => *intensity,
        })
        .collect();
    assert_eq!(colors, [Rgb::splat(0.5), Rgb::X, Rgb::splat(0.5), Rgb::splat(0.5)], "1/√4");
}

#[test]
fn nff_ids_follow_the_file_and_dropped_shapes_keep_theirs() {
    let loaded = loaded(&[(
        "a.nff",
        "f 1 1 1 1 0 1 0 0\np 3\n0 0 0\n1 0 0\n0 1 0\np 3\n0 0 0\n1 1 1\n2 2 2\ns 0 0 0 1\npp 4\n0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1 0 0 0 1\np 3\n0 0 0\n0 0 0\n1 1 1\ns 0 0 0 -1\ns 0 0 0 -1\n",
    )]);
    let geometry = &loaded.scene.geometry;
    assert_eq!(geometry.triangles.iter().map(|t| t.id.0).collect::<Vec<_>>(), [0]);
    assert_eq!(geometry.spheres.iter().map(|s| s.id.0).collect::<Vec<_>>(), [2, 5, 6]);
    assert_eq!(geometry.polygons.iter().map(|p| p.id.0).collect::<Vec<_>>(), [3]);
    assert_eq!(geometry.polygons[0].normals, Some(0..4));
    let counts: Vec<u64> = loaded.warnings.iter().map(|warning| warning.count).collect();
    assert_eq!(counts, [2, 2], "one warning for two shapes without area, one for two negative radii");
}

const SQUARE: &str = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\n";

#[test]
fn obj_indices_may_be_negative_and_lines_continued() {
    let plain = scene(&[("a.obj", &format!("{SQUARE}vn 0 0 1\nf 1//1 2//1 3//1 4//1\n"))]);
    let ahead = scene(&[("a.obj", &format!("f 1//1 2//1 3//1 4//1\n{SQUARE}vn 0 0 1\n"))]);
    assert_eq!(ahead, plain, "vertices may come after the face that uses them");
    for faces in ["f -4//-1 -3//-1 -2//-1 -1//-1\n", "f 1/1/1 2/1/1\\\n 3/1/1 \\\r\n4/7/1 # a square\n"] {
        let scene = scene(&[("a.obj", &format!("{SQUARE}vt 0 0\nvn 0 0 1\n{faces}"))]);
        assert_eq!(scene, plain, "{faces}");
    }
    let corners: Vec<_> = plain.geometry.triangles.iter().map(|triangle| triangle.vertices).collect();
    assert_eq!(corners, [[0, 1, 2], [0, 2, 3]]);
    assert!(plain.geometry.triangles.iter().all(|triangle| triangle.normals.is_some()));
}

#[test]
fn obj_vertices_and_faces_keep_the_order_of_the_file() {
    let materials = "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\nnewmtl red\nKd 0.5 0 0\n";
    let faces = "o a\nusemtl red\nf 4 2 3\nusemtl blue\nf 3 2 5\no b\nusemtl red\nf 2 5 4\n";
    let scene = scene(&[("a.obj", &format!("mtllib a.mtl\nv 9 9 9\n{SQUARE}{faces}")), ("a.mtl", materials)]);
    let seen = |triangle: &Triangle| {
        (triangle.vertices, scene.materials[triangle.material.0 as usize].diffuse.to_array())
    };
    let (red, blue) = ([0.5, 0.0, 0.0], [0.0, 0.0, 1.0]);
    let seen: Vec<_> = scene.geometry.triangles.iter().map(seen).collect();
    assert_eq!(seen, [([3, 1, 2], red), ([2, 1, 4], blue), ([1, 4, 3], red)]);
    assert_eq!(scene.geometry.vertices[0], Vec3::splat(9.0), "though no face uses it");
}

#[test]
fn obj_faces_without_normals_get_none_from_their_neighbours() {
    let scene = scene(&[(
        "a.obj",
        &format!("{SQUARE}vn 1 0 1\nf 1//1 2//1 3//1\nf 1 3 4\nf 1//1 3 4\nf 1//1 2//1 4//1\n"),
    )]);
    let normals: Vec<bool> = scene.geometry.triangles.iter().map(|t| t.normals.is_some()).collect();
    assert_eq!(normals, [true, false, false, true]);
}

#[test]
fn obj_vertex_colours_and_weights_are_read_past() {
    let scene = scene(&[("a.obj", "v 0 0 0 1 0.5 0\nv 2 0 0 2\nv 0 1 0\nf 1 2 3\n")]);
    assert_eq!(scene.geometry.vertices, [Vec3::ZERO, Vec3::X, Vec3::Y]);
}

#[test]
fn a_mesh_alone_is_framed_lit_and_grey() {
    let scene = scene(&[("a.obj", "v -1 -1 0\nv 1 -1 0\nv -1 1 0\nf 1 2 3\n")]);
    // The diagonal of the bounding box is √8.
    let extent = 8.0_f32.sqrt();
    let near = |found: Vec3, expected: Vec3| {
        assert!((found - expected).length() < 1e-6, "{found} is not {expected}");
    };
    near(scene.camera.eye, Vec3::new(0.45, 0.35, 0.75) * extent);
    near(scene.camera.target, Vec3::ZERO);
    assert_eq!(scene.camera.projection, Projection::PerspectiveAngle { vertical_degrees: 45.0 });
    match *scene.lights.as_slice() {
        [Light::Point { position, intensity }] => {
            near(position, Vec3::new(-1.0, 2.0, 1.5) * extent);
            assert_eq!(intensity, Rgb::ONE);
        }
        _ => panic!("one point light expected, found {:?}", scene.lights),
    }
    assert_eq!(scene.materials[0].diffuse, Rgb::splat(0.7));
    assert_eq!(scene.geometry.triangles[0].material.0, 0);
}

#[test]
fn mtl_materials_follow_their_illum() {
    let coefficients = "Ka 0.1 0.2 0.3\nKd 0.4\nKs 0.5 0.25 0\nNs 30\nNi 1.25\nTf 1 0.5 0.5\n";
    let of = |illum: &str| {
        let loaded = loaded(&[
            ("a.obj", "mtllib my materials.mtl\nusemtl the one\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
            ("my materials.mtl", &format!("newmtl other\nnewmtl the one\n{coefficients}{illum}")),
        ]);
        let material = loaded.scene.geometry.triangles[0].material.0 as usize;
        (loaded.scene.materials[material], loaded.warnings.len())
    };
    let matte =
        Material { ambient: Rgb::new(0.1, 0.2, 0.3), diffuse: Rgb::splat(0.4), ..Material::default() };
    let shiny = Material { specular: Rgb::new(0.5, 0.25, 0.0), shininess: 30.0, ..matte };
    let mirror = Material { mirror: shiny.specular, ..shiny };
    let glass =
        |ior, transmission, fresnel| Some(Dielectric { ior, absorption: Rgb::ZERO, transmission, fresnel });
    let tf = Rgb::new(1.0, 0.5, 0.5);
    let remaining = Rgb::new(0.5, 0.375, 0.5);
    for (illum, expected, warnings) in [
        ("", shiny, 0),
        ("illum 0", matte, 0),
        ("illum 1", matte, 0),
        ("illum 2", shiny, 0),
        ("illum 3", mirror, 0),
        ("illum 4", Material { dielectric: glass(1.0, tf, Fresnel::Fixed), ..mirror }, 0),
        ("illum 5", mirror, 1),
        ("illum 6", Material { dielectric: glass(1.25, remaining, Fresnel::Fixed), ..mirror }, 0),
        ("illum 7", Material { dielectric: glass(1.25, tf, Fresnel::Schlick), ..shiny }, 0),
        ("d 0.5\nmap_Kd a.png\nd 0.4\nTr 0.1", shiny, 3),
    ] {
        assert_eq!(of(illum), (expected, warnings), "{illum}");
    }
}

#[test]
fn mtl_what_is_not_modelled_is_named() {
    let loaded = loaded(&[
        ("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\nl 1 2\n"),
        ("a.mtl", "newmtl m\nKd 1 1 1\nd 0.5\nmap_Kd a.png\nnewmtl n\nd 0.5\n"),
    ]);
    let expected = [
        "`d` is not modelled and left out",
        "`map_Kd` is not modelled and left out",
        "`l` is not modelled and left out; only faces (`f`) are shown",
    ];
    assert_eq!(messages(&loaded), expected);
    assert_eq!(loaded.warnings[0].count, 2);
}

const PLY_HEADER: &str = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n";

/// A square of two triangles, in a PLY of one of the three encodings.
fn ply(encoding: &str) -> Vec<u8> {
    let mut bytes = format!("ply\nformat {encoding} 1.0\ncomment a test\n{PLY_HEADER}").into_bytes();
    let vertices = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.5], [0.0, 1.0, 0.5]];
    let faces = [[0_i32, 1, 2], [0, 2, 3]];
    if encoding == "ascii" {
        vertices.iter().for_each(|[x, y, z]| bytes.extend(format!("{x} {y} {z} 7\n").bytes()));
        faces.iter().for_each(|[a, b, c]| bytes.extend(format!("3 {a} {b} {c}\n").bytes()));
        return bytes;
    }
    let big = encoding == "binary_big_endian";
    for vertex in vertices {
        vertex.iter().for_each(|x| bytes.extend(if big { x.to_be_bytes() } else { x.to_le_bytes() }));
        bytes.push(7);
    }
    for face in faces {
        bytes.push(3);
        face.iter().for_each(|x| bytes.extend(if big { x.to_be_bytes() } else { x.to_le_bytes() }));
    }
    bytes
}

#[test]
fn ply_is_read_in_all_its_encodings() {
    let folder = Folder::new();
    for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
        let scene = load(&folder.write("a.ply", ply(encoding))).unwrap().scene;
        let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.5], [0.0, 1.0, 0.5]].map(Vec3::from);
        assert_eq!(scene.geometry.vertices, square, "{encoding}");
        let corners: Vec<_> = scene.geometry.triangles.iter().map(|triangle| triangle.vertices).collect();
        assert_eq!(corners, [[0, 1, 2], [0, 2, 3]], "{encoding}");
        assert!(scene.geometry.triangles.iter().all(|triangle| triangle.normals.is_none()));
    }
}

#[test]
fn a_ply_cut_anywhere_is_refused() {
    let folder = Folder::new();
    for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
        let bytes = ply(encoding);
        // The last digit and line feed of an ascii file may be missing without anyone's knowing.
        let whole = if encoding == "ascii" { bytes.len() - 1 } else { bytes.len() };
        for length in 0..whole {
            let path = folder.write("a.ply", &bytes[..length]);
            assert!(load(&path).is_err(), "{encoding} cut after {length} of {} bytes", bytes.len());
        }
    }
}

#[test]
fn ply_normals_are_vertex_normals() {
    let scene = scene(&[(
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\nproperty float nx\nproperty float ny\nproperty float nz\nelement face 1\nproperty list uint ushort vertex_index\nproperty int flags\nend_header\n0 0 0 0 0 2\n1 0 0 0 0 2\n0 1 0 1 0 2\n3 0 1 2 9\n",
    )]);
    assert_eq!(scene.geometry.normals, [Vec3::Z * 2.0, Vec3::Z * 2.0, Vec3::new(1.0, 0.0, 2.0)]);
    assert_eq!(scene.geometry.triangles[0].normals, Some([0, 1, 2]));
}

#[test]
fn toml_meshes_are_scaled_turned_and_moved_and_rounded_once() {
    let mesh = "v 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 2 3\n";
    let scene = scene(&[
        (
            "a.toml",
            "[material.m]\n[[mesh]]\nfile = \"a.obj\"\nmaterial = \"m\"\nscale = 3\nrotate = [0, 0, 90]\ntranslate = [1, 0, 0]\n",
        ),
        ("a.obj", mesh),
    ]);
    // In f64: 3 · 0.1 is 0.30000000000000004, which rounds to the f32 next to 0.3; 0.1 in f32 first would end elsewhere.
    let length = (3.0_f64 * 0.1) as f32;
    let expected = [
        Vec3::new(1.0, length, 0.0),
        Vec3::new((1.0 - 3.0 * 0.1_f64) as f32, 0.0, 0.0),
        Vec3::new(1.0, 0.0, length),
    ];
    assert_eq!(scene.geometry.vertices, expected);
}

#[test]
fn toml_meshes_bring_their_materials_or_are_given_one() {
    let obj = ("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n");
    let mtl = ("a.mtl", "newmtl red\nKd 1 0 0\n");
    let own = scene(&[("a.toml", "[[mesh]]\nfile = \"a.obj\"\n"), obj, mtl]);
    assert_eq!(own.materials[own.geometry.triangles[0].material.0 as usize].diffuse, Rgb::X);
    // A material given in the scene goes before the file's own, which then need not be there.
    let given = scene(&[
        ("a.toml", "[material.blue]\ndiffuse = [0, 0, 1]\n[[mesh]]\nfile = \"a.obj\"\nmaterial = \"blue\"\n"),
        obj,
    ]);
    assert_eq!(given.materials[given.geometry.triangles[0].material.0 as usize].diffuse, Rgb::Z);
}

#[test]
fn toml_ids_count_spheres_triangles_polygons_and_meshes() {
    let scene = scene(&[
        (
            "a.toml",
            r#"
            mesh = [{ file = "a.obj", material = "m" }, { file = "a.obj", material = "m", translate = [0, 0, 1] }]
            polygon = [{ vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], material = "m" }]
            triangle = [{ vertices = [[0, 0, 0], [1, 0, 0], [2, 0, 0]], material = "m" },
                        { vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], material = "m" }]
            sphere = [{ center = [0, 0, 0], radius = 1, material = "m" }]
            material.m.diffuse = 0.5
            "#,
        ),
        ("a.obj", &format!("{SQUARE}f 1 2 3 4\n")),
    ]);
    let geometry = &scene.geometry;
    assert_eq!(geometry.spheres[0].id.0, 0);
    assert_eq!(geometry.triangles.iter().map(|t| t.id.0).collect::<Vec<_>>(), [2, 4, 5, 6, 7]);
    assert_eq!(geometry.polygons[0].id.0, 3);
}

#[test]
fn what_is_not_said_has_its_default() {
    let scene =
        scene(&[("a.toml", "[[light]]\nposition = [1, 2, 3]\n[material.m]\n[material.glass]\nior = 1.5\n")]);
    let render = scene.render;
    assert_eq!((render.max_depth, render.min_weight, render.samples, render.seed), (8, 0.0, 1, 1));
    assert_eq!(render.sampling, wavelane::scene::Sampling::Regular);
    assert_eq!((scene.image.background, scene.ambient), (Rgb::ZERO, Rgb::ZERO));
    assert_eq!(scene.lights, [Light::Point { position: Vec3::new(1.0, 2.0, 3.0), intensity: Rgb::ONE }]);
    let glass =
        Dielectric { ior: 1.5, absorption: Rgb::ZERO, transmission: Rgb::ONE, fresnel: Fresnel::Schlick };
    let plain = Material {
        ambient: Rgb::ZERO,
        diffuse: Rgb::ZERO,
        specular: Rgb::ZERO,
        shininess: 1.0,
        mirror: Rgb::ZERO,
        dielectric: None,
        casts_shadow: true,
    };
    assert_eq!(scene.materials, [Material { dielectric: Some(glass), ..plain }, plain]);
}

#[test]
fn polygons_may_leave_their_plane_by_a_thousandth_and_are_warned_about_before() {
    // Raising one corner of a unit square by h takes its neighbours h/2 off the plane; the extent is √2.
    let off_plane = |share: f64| {
        let height = share * 2.0 * 2.0_f64.sqrt();
        let folder = Folder::new();
        let toml = format!(
            "[material.m]\n[[polygon]]\nvertices = [[0, 0, 0], [1, 0, 0], [1, 1, {height}], [0, 1, 0]]\nmaterial = \"m\"\n"
        );
        load(&folder.write("a.toml", toml)).ok().map(|loaded| loaded.warnings.len())
    };
    let warned = 8.0 / f64::from(1 << 24);
    for (share, expected) in [
        (0.0, Some(0)),
        (0.98 * warned, Some(0)),
        (1.02 * warned, Some(1)),
        (0.98e-3, Some(1)),
        (1.02e-3, None),
    ] {
        assert_eq!(off_plane(share), expected, "{share:e} of the extent off the plane");
    }
}

#[test]
fn the_largest_image_is_2_to_the_31_pixels() {
    assert_eq!(scene(&[("a.toml", "[image]\nsize = [65536, 32768]\n")]).image.height, 32768);
}

#[test]
fn names_may_hold_a_number_sign_and_comments_any_bytes() {
    let folder = Folder::new();
    folder.write(
        "a.obj",
        b"# caf\xe9\nmtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl Mat #1\nf 1 2 3 # first\n",
    );
    folder.write("a.mtl", b"newmtl Mat #1\nKd 1 0 0 # r\xf6t\nnewmtl Mat #2\nKd 0 1 0\n");
    let scene = load(&folder.file("a.obj")).unwrap().scene;
    assert_eq!(scene.materials[scene.geometry.triangles[0].material.0 as usize].diffuse, Rgb::X);
}

#[test]
fn an_empty_scene_is_legal() {
    for (name, content) in [("a.toml", ""), ("a.nff", "# nothing\n")] {
        let scene = scene(&[(name, content)]);
        assert_eq!((scene.geometry.primitive_count(), scene.lights.len()), (0, 0));
        assert_eq!(crate::support::render_whole(&scene).image.pixels[0], [0.0; 3]);
    }
}

#[test]
fn a_byte_order_mark_and_carriage_returns_are_read_past() {
    let toml = "\u{feff}[material.m]\r\ndiffuse = 1\r\n[[sphere]]\r\ncenter = [0, 0, 0]\r\nradius = 1\r\nmaterial = \"m\"\r\n";
    assert_eq!(scene(&[("a.toml", toml)]).geometry.spheres.len(), 1);
}
