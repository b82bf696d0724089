//! Folders of NPY arrays: what becomes of their rows, and that nothing else is read.

use crate::support::{Folder, npy_floats, npy_indices, stderr, stdout, wavelane};
use glam::Vec3;
use wavelane::load::load;
use wavelane::scene::{Light, Rgb};

const CORNERS: [[f32; 3]; 4] = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.5], [-1.0, 1.0, 0.5]];

/// Two triangles, one without area between them, and two spheres.
fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("vertices.npy", npy_floats(&CORNERS));
    folder.write("triangles.npy", npy_indices(&[[0, 1, 2], [1, 1, 3], [0, 2, 3]]));
    folder.write("spheres.npy", npy_floats(&[[0.0, 0.0, 2.0, 0.25], [1.0, 2.0, 3.0, 0.5]]));
    folder
}

#[test]
fn ids_count_triangles_then_spheres_and_a_triangle_without_area_keeps_its_number() {
    let folder = folder();
    let loaded = load(folder.path()).unwrap();
    let geometry = &loaded.scene.geometry;
    let triangles: Vec<_> = geometry.triangles.iter().map(|t| (t.id.0, t.vertices)).collect();
    assert_eq!(triangles, [(0, [0, 1, 2]), (2, [0, 2, 3])]);
    let spheres: Vec<_> = geometry.spheres.iter().map(|s| (s.id.0, s.center, s.radius)).collect();
    assert_eq!(spheres, [(3, Vec3::new(0.0, 0.0, 2.0), 0.25), (4, Vec3::new(1.0, 2.0, 3.0), 0.5)]);
    assert_eq!(geometry.vertices, CORNERS.map(Vec3::from));
    let warnings: Vec<String> = loaded.warnings.iter().map(ToString::to_string).collect();
    let file = folder.file("triangles.npy");
    let expected = format!("{}: row 1: warning: this triangle has no area and is left out", file.display());
    assert_eq!(warnings, [expected]);
}

#[test]
fn triangles_alone_are_the_scene_of_the_same_mesh_alone() {
    let folder = folder();
    std::fs::remove_file(folder.file("spheres.npy")).unwrap();
    let corner = |[x, y, z]: [f32; 3]| format!("v {x} {y} {z}\n");
    let obj = CORNERS.map(corner).concat() + "f 1 2 3\nf 2 2 4\nf 1 3 4\n";
    let mesh = load(&folder.write("a.obj", obj)).unwrap().scene;
    assert_eq!(load(folder.path()).unwrap().scene, mesh);
}

#[test]
fn spheres_alone_are_framed_with_their_radius_lit_and_grey() {
    let folder = Folder::new();
    folder.write("spheres.npy", npy_floats(&[[1.0, 2.0, 3.0, 0.5]]));
    let scene = load(folder.path()).unwrap().scene;
    // A cube of side 1 around the centre, whose diagonal is √3.
    let at = |offset: [f32; 3]| Vec3::new(1.0, 2.0, 3.0) + Vec3::from(offset) * 3.0_f32.sqrt();
    let near = |found: Vec3, expected: Vec3| {
        assert!((found - expected).length() < 1e-6, "{found} is not {expected}");
    };
    near(scene.camera.eye, at([0.45, 0.35, 0.75]));
    near(scene.camera.target, at([0.0; 3]));
    let [Light::Point { position, intensity: Rgb::ONE }] = *scene.lights.as_slice() else {
        panic!("one white point light expected, found {:?}", scene.lights);
    };
    near(position, at([-1.0, 2.0, 1.5]));
    assert_eq!(scene.materials.len(), 1);
    assert_eq!(scene.materials[0].diffuse, Rgb::splat(0.7));
    assert_eq!(scene.geometry.spheres[0].material.0, 0);
}

#[test]
fn arrays_of_no_rows_are_an_empty_scene() {
    let folder = Folder::new();
    folder.write("vertices.npy", npy_floats::<3>(&[]));
    folder.write("triangles.npy", npy_indices(&[]));
    folder.write("spheres.npy", npy_floats::<4>(&[]));
    assert_eq!(load(folder.path()).unwrap().scene.geometry.primitive_count(), 0);
}

#[test]
fn a_folder_is_checked_and_rendered_as_a_file_is() {
    let folder = folder();
    let (path, picture) = (folder.path().to_str().unwrap(), folder.file("a.npy"));
    let output = wavelane(&["check", path]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let expected = "2 spheres, 2 triangles, 0 polygons, 1 light, 1 material, 512 x 512 pixels\n";
    assert_eq!(stdout(&output), format!("{path}: {expected}"));
    assert!(stderr(&output).contains("triangles.npy: row 1: warning:"), "{}", stderr(&output));
    let output = wavelane(&["render", path, "-o", picture.to_str().unwrap(), "--size", "16x16"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let image = wavelane::film::read(&picture).unwrap();
    assert!(image.pixels.iter().any(|&pixel| pixel[0] > 0.1), "something is seen and lit");
}

#[test]
fn a_folder_with_any_byte_changed_or_missing_ends_in_a_scene_or_a_message() {
    let folder = folder();
    for name in ["vertices.npy", "triangles.npy", "spheres.npy"] {
        let whole = std::fs::read(folder.file(name)).unwrap();
        for position in 0..whole.len() {
            folder.write(name, &whole[..position]);
            assert!(load(folder.path()).is_err(), "{name} cut after {position} bytes");
            for flipped in [0x01, 0x02, 0x80, 0xff] {
                let mut changed = whole.clone();
                changed[position] ^= flipped;
                folder.write(name, &changed);
                if let Ok(loaded) = load(folder.path()) {
                    let geometry = &loaded.scene.geometry;
                    assert!(geometry.vertices.iter().all(|vertex| vertex.is_finite()));
                    assert!(geometry.spheres.iter().all(|sphere| sphere.radius > 0.0));
                    assert!(geometry.triangles.iter().flat_map(|t| t.vertices).all(|corner| corner < 4));
                }
            }
        }
        folder.write(name, whole);
    }
}
