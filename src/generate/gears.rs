//! Gears that mesh, in a lattice: layers of spur gears, each turning against its four neighbours.
//!
//! A gear is a closed solid of 98 polygons: front and back are concave, with 96 corners, and each of its 24 teeth has four
//! rectangles around. Every other gear is turned by half a tooth. 24 is a multiple of 4, so a tooth faces each of the four
//! neighbours, or a gap does, and teeth meet gaps.

use crate::math::sin_cos_degrees;
use crate::scene::{
    Camera, Dielectric, Fresnel, Geometry, GeometryProblem, ImageSettings, Light, Material, MaterialId,
    Projection, RenderSettings, Rgb, Scene,
};
use glam::{DVec2, Vec3};

const TEETH: u32 = 24;
/// Front, back, and four sides a tooth.
const FACES: usize = 2 + 4 * TEETH as usize;

// Lengths in distances between neighbouring axes: 0.5 is the pitch radius.
const TIP: f64 = 0.54;
const ROOT: f64 = 0.45;
const THICKNESS: f64 = 0.4;
/// From layer to layer.
const RISE: f64 = 0.6;
/// Half the width of a tooth at its root and at its tip, degrees around the axis; a tooth and a gap are 15°.
const HALF_ROOT: f64 = 4.6;
const HALF_TIP: f64 = 2.0;

/// Where a gear is in the lattice: column, row and layer.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Place {
    x: u32,
    y: u32,
    z: u32,
}

impl Place {
    /// Three of steel or brass to each of glass, the first of glass, and no two of glass side by side.
    fn material(self) -> MaterialId {
        MaterialId(match (self.x + self.y + self.z) % 2 {
            0 => 2 * ((self.x / 2 + self.y / 2 + self.z + 1) % 2),
            _ => 1,
        })
    }
}

/// A ground and whole gears, one at least.
pub(super) fn scene(size: usize) -> Result<Scene, GeometryProblem> {
    let brass = Material {
        diffuse: Rgb::new(0.6, 0.4, 0.13),
        specular: Rgb::splat(0.2),
        shininess: 40.0,
        mirror: Rgb::splat(0.2),
        ..Material::default()
    };
    let steel = Material { diffuse: Rgb::new(0.33, 0.37, 0.42), ..brass };
    let clear = Rgb::new(0.6, 0.85, 0.75);
    let glass = Material {
        // A quarter, which is exact: NFF says both as shares of one colour.
        diffuse: clear / 4.0,
        specular: Rgb::splat(0.12),
        shininess: 100.0,
        mirror: Rgb::splat(0.12),
        dielectric: Some(Dielectric {
            ior: 1.1,
            absorption: Rgb::ZERO,
            transmission: clear,
            fresnel: Fresnel::Fixed,
        }),
        ..Material::default()
    };
    let ground = Material {
        diffuse: Rgb::new(0.42, 0.36, 0.3),
        specular: Rgb::splat(0.3),
        shininess: 20.0,
        mirror: Rgb::splat(0.3),
        ..Material::default()
    };
    let materials = vec![brass, steel, glass, ground];

    let places = lattice(size.saturating_sub(1));
    let side = places.iter().map(|place| place.x + 1).max().unwrap_or(1);
    let mut geometry = Geometry::default();
    // A material at a time, since NFF can only name the latest.
    for material in [0, 1, 2].map(MaterialId) {
        for &place in places.iter().filter(|place| place.material() == material) {
            add_gear(&mut geometry, place, side, material)?;
        }
    }
    let corners = [[3.0, 3.0, 0.0], [-3.0, 3.0, 0.0], [-3.0, -3.0, 0.0], [3.0, -3.0, 0.0]];
    geometry.add_polygon(&corners.map(Vec3::from_array), None, MaterialId(3))?;

    let light = |position: [f32; 3]| Light::Point { position: position.into(), intensity: Rgb::splat(0.5) };
    Ok(Scene {
        image: ImageSettings { width: 1024, height: 1024, background: Rgb::new(0.3, 0.5, 0.75) },
        render: RenderSettings { max_depth: 4, ..RenderSettings::default() },
        camera: Camera {
            eye: Vec3::new(-1.9, -3.3, 3.0),
            target: Vec3::new(0.0, 0.0, 0.45),
            up: Vec3::Z,
            projection: Projection::PerspectiveAngle { vertical_degrees: 38.0 },
        },
        ambient: Rgb::ZERO,
        lights: [[2.0, -4.0, 5.0], [-4.0, -2.0, 4.0], [-1.0, -5.0, 2.0], [0.5, 3.0, 6.0]].map(light).to_vec(),
        materials,
        geometry,
    })
}

/// Places for the whole number of gears that comes nearest to `faces`, in layers, about as many as a layer's side has gears.
fn lattice(faces: usize) -> Vec<Place> {
    let gears = ((faces + FACES / 2) / FACES).max(1);
    let mut side = 1_u32;
    // To the nearest cube: (s + ½)³, doubled.
    while (2 * side as usize + 1).pow(3) <= 8 * gears {
        side += 1;
    }
    let layer = |z| (0..side).flat_map(move |y| (0..side).map(move |x| Place { x, y, z }));
    (0..).flat_map(layer).take(gears).collect()
}

/// The lattice is 2 wide, whatever the number of gears, and rests on the ground with its middle over the origin.
fn add_gear(
    geometry: &mut Geometry,
    place: Place,
    side: u32,
    material: MaterialId,
) -> Result<(), GeometryProblem> {
    let scale = 2.0 / f64::from(side);
    let axis = DVec2::new(f64::from(place.x), f64::from(place.y)) - (f64::from(side) - 1.0) / 2.0;
    let bottom = f64::from(place.z) * RISE;
    let outline = outline((place.x + place.y) % 2 == 1);
    let at = |corner: DVec2, height: f64| (scale * (axis + corner).extend(height)).as_vec3();

    let front: Vec<Vec3> = outline.iter().map(|&corner| at(corner, bottom + THICKNESS)).collect();
    let back: Vec<Vec3> = outline.iter().map(|&corner| at(corner, bottom)).collect();
    for here in 0..outline.len() {
        let next = (here + 1) % outline.len();
        geometry.add_polygon(&[back[here], back[next], front[next], front[here]], None, material)?;
    }
    geometry.add_polygon(&front, None, material)?;
    let from_below: Vec<Vec3> = back.into_iter().rev().collect();
    geometry.add_polygon(&from_below, None, material)?;
    Ok(())
}

/// Corners around the axis, counter-clockwise; `turned` by half a tooth.
fn outline(turned: bool) -> Vec<DVec2> {
    let pitch = 360.0 / f64::from(TEETH);
    let tooth = |tooth: u32| {
        let middle = (f64::from(tooth) + if turned { 0.5 } else { 0.0 }) * pitch;
        [(-HALF_ROOT, ROOT), (-HALF_TIP, TIP), (HALF_TIP, TIP), (HALF_ROOT, ROOT)].map(|(off, radius)| {
            let (sin, cos) = sin_cos_degrees(middle + off);
            radius * DVec2::new(cos, sin)
        })
    };
    (0..TEETH).flat_map(tooth).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    fn gear() -> Geometry {
        let mut geometry = Geometry::default();
        add_gear(&mut geometry, Place { x: 1, y: 0, z: 2 }, 3, MaterialId(0)).unwrap();
        geometry
    }

    fn corners(geometry: &Geometry) -> impl Iterator<Item = &[Vec3]> {
        let range = |range: &std::ops::Range<u32>| range.start as usize..range.end as usize;
        geometry.polygons.iter().map(move |polygon| &geometry.vertices[range(&polygon.vertices)])
    }

    /// A dielectric has to be, and has to have its outside outside.
    #[test]
    fn a_gear_is_closed_and_its_outside_is_outside() {
        let gear = gear();
        assert_eq!(gear.polygons.len(), FACES);
        let mut edges: BTreeMap<[[u32; 3]; 2], i32> = BTreeMap::new();
        let mut volume = 0.0;
        for face in corners(&gear) {
            let key = |corner: usize| face[corner % face.len()].to_array().map(f32::to_bits);
            for corner in 0..face.len() {
                let (from, to) = (key(corner), key(corner + 1));
                *edges.entry([from, to]).or_default() += 1;
                *edges.entry([to, from]).or_default() -= 1;
            }
            // Sixth parts of the volume under each triangle of a fan; a concave face's signs come out right.
            for pair in face[1..].windows(2) {
                volume += face[0].as_dvec3().dot(pair[0].as_dvec3().cross(pair[1].as_dvec3())) / 6.0;
            }
        }
        assert!(edges.values().all(|&uses| uses == 0), "every edge is run through once each way");
        // Between the cylinders through roots and tips, in lattices 2 wide of 3 gears.
        let cylinder =
            |radius: f64| std::f64::consts::PI * radius * radius * THICKNESS * (2.0 / 3.0_f64).powi(3);
        assert!(cylinder(ROOT) < volume && volume < cylinder(TIP), "{volume}");
    }

    /// By the crossing number, independently of the engine's.
    fn is_inside(point: DVec2, outline: &[DVec2]) -> bool {
        let edges = outline.iter().zip(outline.iter().cycle().skip(1));
        let crossed = edges.filter(|(a, b)| {
            (a.y > point.y) != (b.y > point.y) && point.x < a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x)
        });
        crossed.count() % 2 == 1
    }

    #[test]
    fn neighbours_mesh_without_touching() {
        let (one, other) = (outline(false), outline(true));
        for way in [DVec2::X, DVec2::Y, -DVec2::X, -DVec2::Y] {
            let neighbour: Vec<DVec2> = other.iter().map(|&corner| corner + way).collect();
            assert!(!neighbour.iter().any(|&corner| is_inside(corner, &one)), "{way}");
            assert!(!one.iter().any(|&corner| is_inside(corner, &neighbour)), "{way}");
            let reaches_in = neighbour.iter().any(|corner| corner.length() < TIP);
            assert!(reaches_in, "teeth are between teeth, {way}");
            // Turned alike they would run into each other, so the test can see it.
            let alike = one.iter().map(|&corner| corner + way);
            assert!(alike.clone().any(|corner| is_inside(corner, &one)), "{way}");
        }
    }

    #[test]
    fn glass_gears_are_not_neighbours() {
        let places = lattice(20_000);
        for a in places.iter().filter(|place| place.material() == MaterialId(2)) {
            for b in places.iter().filter(|place| place.material() == MaterialId(2)) {
                let apart = a.x.abs_diff(b.x) + a.y.abs_diff(b.y) + a.z.abs_diff(b.z);
                assert!(apart != 1, "{a:?} and {b:?}");
            }
        }
    }
}
