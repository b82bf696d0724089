//! Scene files that are written are read back as the same scene, whatever is in it, or are refused.

use crate::support::{Folder, STILL_LIFE, scene};
use glam::Vec3;
use proptest::prelude::*;
use wavelane::load::load;
use wavelane::save::{SaveError, save};
use wavelane::scene::{
    Camera, Dielectric, Fresnel, Geometry, ImageSettings, Light, Material, MaterialId, Projection,
    RenderSettings, Rgb, Sampling, Scene, Window,
};

/// A number of a scene, of any magnitude that one may have.
fn any_number() -> impl Strategy<Value = f32> {
    use prop::num::f32::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
    let any = POSITIVE | NEGATIVE | NORMAL | SUBNORMAL | ZERO;
    let scenic = any.prop_filter("too large for a scene", |number| number.abs() <= 1e18);
    // The middle one is read as its neighbour by way of f64.
    prop_oneof![8 => scenic, 1 => Just(7.038_531e-26_f32), 4 => (-100..100_i8).prop_map(f32::from)]
}

fn any_vector() -> impl Strategy<Value = Vec3> {
    [any_number(), any_number(), any_number()].prop_map(Vec3::from_array)
}

fn coefficient() -> impl Strategy<Value = Rgb> {
    prop_oneof![any_vector().prop_map(Vec3::abs), any_number().prop_map(|grey| Rgb::splat(grey.abs()))]
}

fn positive() -> impl Strategy<Value = f32> {
    any_number().prop_map(|number| number.abs().max(f32::MIN_POSITIVE))
}

fn window() -> impl Strategy<Value = Window> {
    (any_number(), any_number(), any_number(), any_number()).prop_map(|(left, right, bottom, top)| Window {
        left,
        right,
        bottom,
        top,
    })
}

fn camera() -> impl Strategy<Value = Camera> {
    let projection = prop_oneof![
        (0.001..179.9_f32).prop_map(|vertical_degrees| Projection::PerspectiveAngle { vertical_degrees }),
        (window(), positive())
            .prop_map(|(window, distance)| Projection::PerspectiveWindow { window, distance }),
        positive().prop_map(|height| Projection::OrthographicHeight { height }),
        window().prop_map(|window| Projection::OrthographicWindow { window }),
    ];
    let near = || [-9.0..9.0_f32, -9.0..9.0, -9.0..9.0].prop_map(Vec3::from_array);
    (near(), near(), near(), projection)
        .prop_map(|(eye, target, up, projection)| Camera { eye, target, up, projection })
        .prop_filter("not a camera", |camera| camera.check().is_ok())
}

fn light() -> impl Strategy<Value = Light> {
    (any_vector(), coefficient(), any::<bool>()).prop_map(|(vector, intensity, is_point)| {
        match is_point || vector == Vec3::ZERO {
            true => Light::Point { position: vector, intensity },
            false => Light::Directional { direction: vector, intensity },
        }
    })
}

fn material() -> impl Strategy<Value = Material> {
    let fresnel = prop_oneof![Just(Fresnel::Schlick), Just(Fresnel::Fixed)];
    let dielectric = (positive(), coefficient(), coefficient(), fresnel).prop_map(
        |(ior, absorption, transmission, fresnel)| Dielectric { ior, absorption, transmission, fresnel },
    );
    let coefficients = [coefficient(), coefficient(), coefficient(), coefficient()];
    (coefficients, any_number(), prop::option::of(dielectric), any::<bool>()).prop_map(
        |([ambient, diffuse, specular, mirror], shininess, dielectric, casts_shadow)| Material {
            ambient,
            diffuse,
            specular,
            shininess: shininess.abs(),
            mirror,
            dielectric,
            casts_shadow,
        },
    )
}

/// A material that NFF can say: one grey for highlight and mirror; one colour to be diffuse and let through.
fn nff_material() -> impl Strategy<Value = Material> {
    let color = [1e-3..1e3_f32, 1e-3..1e3_f32, 1e-3..1e3_f32].prop_map(Vec3::from_array);
    let share = prop::sample::select(vec![0.0, 0.25, 1.0, 8.0_f32]);
    let dielectric = (color, share, positive());
    (coefficient(), positive(), positive(), prop::option::of(dielectric)).prop_map(
        |(diffuse, grey, shininess, dielectric)| {
            let (specular, mirror) = (Rgb::splat(grey), Rgb::splat(grey));
            let opaque = Material { diffuse, specular, mirror, shininess, ..Material::default() };
            let Some((transmission, share, ior)) = dielectric else { return opaque };
            let (absorption, fresnel) = (Rgb::ZERO, Fresnel::Fixed);
            let dielectric = Dielectric { ior, absorption, transmission, fresnel };
            Material { diffuse: share * transmission, dielectric: Some(dielectric), ..opaque }
        },
    )
}

/// A primitive, before it has a number.
#[derive(Clone, Debug)]
enum Shape {
    Sphere(Vec3, f32),
    Triangle([Vec3; 3]),
    /// On a plane of constant z.
    Polygon(Vec<Vec3>),
    /// It gets a number, and is left out.
    WithoutArea {
        among_polygons: bool,
    },
}

impl Shape {
    /// Where TOML has it.
    fn kind(&self) -> u32 {
        match self {
            Self::Sphere(..) => 0,
            Self::Triangle(_) | Self::WithoutArea { among_polygons: false } => 1,
            Self::Polygon(_) | Self::WithoutArea { among_polygons: true } => 2,
        }
    }
}

fn shape(corners: std::ops::Range<usize>) -> impl Strategy<Value = Shape> {
    let corner = || (any_number(), any_number());
    let flat = |(corners, z): (Vec<(f32, f32)>, f32)| {
        Shape::Polygon(corners.into_iter().map(|(x, y)| Vec3::new(x, y, z)).collect())
    };
    prop_oneof![
        (any_vector(), positive()).prop_map(|(center, radius)| Shape::Sphere(center, radius)),
        [any_vector(), any_vector(), any_vector()].prop_map(Shape::Triangle),
        (prop::collection::vec(corner(), corners), any_number()).prop_map(flat),
        any::<bool>().prop_map(|among_polygons| Shape::WithoutArea { among_polygons }),
    ]
}

/// Every other triangle and polygon has normals where there are to be any: its own corners, which do as well as others.
fn geometry(shapes: &[(Shape, MaterialId)], normals: bool) -> Geometry {
    let mut geometry = Geometry::default();
    for (index, (shape, material)) in shapes.iter().enumerate() {
        let has_normals = normals && index % 2 == 0;
        match shape {
            Shape::Sphere(center, radius) => geometry.add_sphere(*center, *radius, *material).unwrap(),
            Shape::Triangle(corners) => {
                let three = |first: u32| [first, first + 1, first + 2];
                let vertices = three(geometry.add_vertices(*corners).unwrap());
                let normals = has_normals.then(|| three(geometry.add_normals(*corners).unwrap()));
                geometry.add_triangle(vertices, normals, *material).map(drop).unwrap();
            }
            Shape::Polygon(corners) => {
                let normals = has_normals.then_some(&corners[..]);
                geometry.add_polygon(corners, normals, *material).map(drop).unwrap();
            }
            Shape::WithoutArea { .. } => {
                geometry.add_polygon(&[Vec3::ONE; 4], None, *material).map(drop).unwrap();
            }
        }
    }
    geometry
}

prop_compose! {
    /// Any scene that TOML can say.
    fn toml_scene()(
        (width, height, background) in (1..5000_u32, 1..5000_u32, any_vector()),
        (max_depth, min_weight, samples, seed) in (0..=64_u32, any_number(), 1..=64_u32, any::<u32>()),
        sampling in prop::sample::select(Sampling::NAMES.map(|(_, sampling)| sampling).to_vec()),
        (camera, ambient, lights) in (camera(), any_vector(), prop::collection::vec(light(), 0..4)),
        materials in prop::collection::vec(material(), 1..13),
        mut shapes in prop::collection::vec((shape(3..7), any::<prop::sample::Index>()), 0..12),
    ) -> Scene {
        shapes.sort_by_key(|(shape, _)| shape.kind());
        let id = |index: prop::sample::Index| MaterialId(index.index(materials.len()) as u32);
        let shapes: Vec<_> = shapes.into_iter().map(|(shape, index)| (shape, id(index))).collect();
        let min_weight = min_weight.abs();
        Scene {
            image: ImageSettings { width, height, background },
            render: RenderSettings { max_depth, min_weight, sampling, samples, seed },
            camera,
            ambient,
            lights,
            geometry: geometry(&shapes, false),
            materials,
        }
    }
}

prop_compose! {
    /// Any scene that NFF can say: in any order, but materials do not come again.
    fn nff_scene()(
        scene in toml_scene(),
        vertical_degrees in 0.001..179.9_f32,
        lights in prop::collection::vec((any_vector(), any_vector()), 0..4),
        materials in prop::collection::vec(nff_material(), 1..13),
        shapes in prop::collection::vec(shape(4..7), 0..12),
        mut indices in prop::collection::vec(any::<prop::sample::Index>(), 12),
    ) -> Scene {
        let render = RenderSettings { max_depth: 4, ..RenderSettings::default() };
        let projection = Projection::PerspectiveAngle { vertical_degrees };
        indices.sort_by_key(|index| index.index(materials.len()));
        let ids = indices.iter().map(|index| MaterialId(index.index(materials.len()) as u32));
        let shapes: Vec<_> = shapes.into_iter().zip(ids).collect();
        Scene {
            render,
            camera: Camera { projection, ..scene.camera },
            ambient: Rgb::ZERO,
            lights: lights.into_iter().map(|(position, intensity)| Light::Point { position, intensity }).collect(),
            geometry: geometry(&shapes, true),
            materials,
            ..scene
        }
    }
}

/// A primitive as it is seen: number, material, centre and radius or corners, normals.
type Seen = (u32, u32, f32, Vec<Vec3>, Vec<Vec3>);

/// All that is seen of a geometry. Which vertices share a place is not, nor are those that nothing uses.
fn seen(geometry: &Geometry) -> Vec<Seen> {
    let at = |column: &[Vec3], places: &mut dyn Iterator<Item = u32>| -> Vec<Vec3> {
        places.map(|place| column[place as usize]).collect()
    };
    let spheres = geometry
        .spheres
        .iter()
        .map(|sphere| (sphere.id.0, sphere.material.0, sphere.radius, vec![sphere.center], Vec::new()));
    let triangles = geometry.triangles.iter().map(|triangle| {
        let corners = at(&geometry.vertices, &mut triangle.vertices.into_iter());
        let normals = at(&geometry.normals, &mut triangle.normals.into_iter().flatten());
        (triangle.id.0, triangle.material.0, 0.0, corners, normals)
    });
    let polygons = geometry.polygons.iter().map(|polygon| {
        let corners = at(&geometry.vertices, &mut polygon.vertices.clone());
        let normals = at(&geometry.normals, &mut polygon.normals.clone().into_iter().flatten());
        (polygon.id.0, polygon.material.0, 0.0, corners, normals)
    });
    spheres.chain(triangles).chain(polygons).collect()
}

/// Writes a scene, and reads it back.
fn there_and_back(scene: &Scene, name: &str) -> Result<Scene, SaveError> {
    let folder = Folder::new();
    let path = folder.file(name);
    save(scene, &path)?;
    let loaded = load(&path);
    let text = || std::fs::read_to_string(&path).unwrap();
    Ok(loaded.unwrap_or_else(|error| panic!("{error}\nin\n{}", text())).scene)
}

#[track_caller]
fn assert_same(found: &Scene, expected: &Scene) {
    assert_eq!(seen(&found.geometry), seen(&expected.geometry));
    assert_eq!(found.geometry.numbered_count(), expected.geometry.numbered_count());
    let without_geometry = |scene: &Scene| Scene { geometry: Geometry::default(), ..scene.clone() };
    assert_eq!(without_geometry(found), without_geometry(expected));
}

proptest! {
    #[test]
    fn any_scene_comes_back_from_toml(scene in toml_scene()) {
        assert_same(&there_and_back(&scene, "scene.toml").unwrap(), &scene);
    }

    #[test]
    fn a_scene_of_what_nff_has_words_for_comes_back_from_nff(scene in nff_scene()) {
        assert_same(&there_and_back(&scene, "scene.nff").unwrap(), &scene);
    }

    /// Two colours are shares of one, or they are not.
    #[test]
    fn a_dielectric_comes_back_from_nff_or_is_refused(
        scene in nff_scene(),
        diffuse in coefficient(),
        transmission in coefficient(),
    ) {
        let fresnel = Fresnel::Fixed;
        let dielectric = Some(Dielectric { ior: 1.5, absorption: Rgb::ZERO, transmission, fresnel });
        let glass = Material { diffuse, dielectric, ..Material::default() };
        let scene = Scene { materials: vec![glass; scene.materials.len()], ..scene };
        match there_and_back(&scene, "scene.nff") {
            Ok(found) => assert_same(&found, &scene),
            Err(refused) => prop_assert!(refused.to_string().contains("shares of one colour"), "{refused}"),
        }
    }
}

#[test]
fn what_shares_vertices_comes_back_though_it_shares_none_then() {
    let folder = Folder::new();
    folder.write("a.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n");
    let mesh = load(&folder.file("a.ply")).unwrap().scene;
    assert_eq!(mesh.geometry.vertices.len(), 4);
    let found = there_and_back(&mesh, "scene.toml").unwrap();
    assert_eq!(found.geometry.vertices.len(), 6);
    assert_same(&found, &mesh);
}

/// A scene that NFF can say, with one thing changed.
fn refusal(name: &str, change: impl FnOnce(&mut Scene)) -> String {
    let mut scene = scene(
        "[render]\nmax_depth = 4\n[camera]\neye = [0, -5, 1]\ntarget = [0, 0, 0]\nup = [0, 0, 1]\nfov = 40\n[material.a]\ndiffuse = 0.5\n[material.b]\nspecular = 0.5\nmirror = 0.5\nior = 1.5\nfresnel = false\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"a\"\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 2\nmaterial = \"b\"\n",
    );
    there_and_back(&scene, "scene.nff").unwrap();
    change(&mut scene);
    match there_and_back(&scene, name) {
        Err(SaveError::CannotSay { path, what }) => {
            assert!(path.ends_with(name) && !path.exists());
            what
        }
        other => panic!("{other:?}"),
    }
}

/// Said as the user reads it, for a look at how it reads.
#[test]
fn what_a_format_cannot_say_is_refused() {
    let dielectric = |scene: &mut Scene, change: fn(&mut Dielectric)| {
        change(scene.materials[1].dielectric.as_mut().unwrap());
    };
    let triangle = |scene: &mut Scene, normals| {
        let first = scene.geometry.add_vertices([Vec3::ZERO, Vec3::X, Vec3::Y]).unwrap();
        scene.geometry.add_normals([Vec3::Z; 3]).unwrap();
        let added = scene.geometry.add_triangle([first, first + 1, first + 2], normals, MaterialId(1));
        added.unwrap();
    };
    let nff = |change: &dyn Fn(&mut Scene)| refusal("scene.nff", change);
    let toml = |change: &dyn Fn(&mut Scene)| refusal("scene.toml", change);
    let said = [
        nff(&|scene| scene.camera.projection = Projection::OrthographicHeight { height: 1.0 }),
        nff(&|scene| scene.render.samples = 2),
        nff(&|scene| scene.render.min_weight = 0.1),
        nff(&|scene| scene.render.max_depth = 5),
        nff(&|scene| scene.ambient = Rgb::ONE),
        nff(&|scene| scene.lights.push(Light::Directional { direction: Vec3::X, intensity: Rgb::ONE })),
        nff(&|scene| scene.materials[0].ambient = Rgb::ONE),
        nff(&|scene| scene.materials[0].casts_shadow = false),
        nff(&|scene| scene.materials[0].mirror = Rgb::ONE),
        nff(&|scene| (scene.materials[0].mirror, scene.materials[0].specular) = (Rgb::X, Rgb::X)),
        nff(&|scene| dielectric(scene, |dielectric| dielectric.fresnel = Fresnel::Schlick)),
        nff(&|scene| dielectric(scene, |dielectric| dielectric.absorption = Rgb::ONE)),
        nff(&|scene| scene.materials[1].diffuse = Rgb::X),
        nff(&|scene| {
            scene.geometry.add_sphere(Vec3::ZERO, 3.0, MaterialId(0)).unwrap();
        }),
        nff(&|scene| {
            let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
            scene.geometry.add_polygon(&corners, None, MaterialId(1)).map(drop).unwrap();
        }),
        toml(&|scene| triangle(scene, Some([0, 1, 2]))),
        toml(&|scene| {
            triangle(scene, None);
            scene.geometry.add_sphere(Vec3::ZERO, 1.0, MaterialId(0)).unwrap();
        }),
        toml(&|scene| {
            scene.geometry.add_polygon(&[Vec3::ZERO; 4], None, MaterialId(0)).map(drop).unwrap();
            scene.geometry.add_sphere(Vec3::ZERO, 1.0, MaterialId(0)).unwrap();
        }),
    ];
    insta::assert_snapshot!(said.join("\n"));
}

#[test]
fn a_file_is_short_and_says_what_is_not_the_default() {
    let folder = Folder::new();
    let path = folder.file("scene.toml");
    save(&scene(STILL_LIFE), &path).unwrap();
    insta::assert_snapshot!(std::fs::read_to_string(&path).unwrap());
}
