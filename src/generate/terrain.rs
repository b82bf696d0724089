//! A landscape of triangles: mountains around a lake, four balls of glass, and the sun.
//!
//! The height is a sum of octaves of noise, each of twice the frequency of the one before and lower, sharpened
//! into ridges (Musgrave, Kolb and Mace, "The Synthesis and Rendering of Eroded Fractal Terrains", 1989). It is a function
//! of the place alone: a larger size is the same landscape in smaller triangles.

use super::rounded;
use crate::random::random_unit;
use crate::scene::{
    Camera, Dielectric, Fresnel, Geometry, GeometryProblem, ImageSettings, Light, Material, MaterialId,
    Projection, RenderSettings, Rgb, Scene,
};
use glam::{DVec2, DVec3, Vec3};

const OCTAVES: u32 = 10;
const WATER_LEVEL: f64 = 0.1;
/// Where the noise has a valley with a lake, and mountains behind it.
const VIEW: DVec2 = DVec2::new(2.3, 3.7);
/// Four balls and a lake.
const EXTRAS: usize = 5;

// In the order of `materials`.
const GRASS: MaterialId = MaterialId(0);
const ROCK: MaterialId = MaterialId(1);
const SNOW: MaterialId = MaterialId(2);
const WATER: MaterialId = MaterialId(3);
const GLASS: MaterialId = MaterialId(4);

/// Five primitives and a grid of cells of two triangles, one cell at least.
pub(super) fn scene(size: usize) -> Result<Scene, GeometryProblem> {
    let mut geometry = Geometry::default();
    for (center, radius) in [
        ([-0.18, -0.42, 0.42], 0.13),
        ([0.04, -0.36, 0.33], 0.08),
        ([-0.32, -0.3, 0.28], 0.07),
        ([-0.06, -0.56, 0.27], 0.06),
    ] {
        geometry.add_sphere(DVec3::from(center).as_vec3(), rounded(radius), GLASS)?;
    }
    add_land(&mut geometry, size.saturating_sub(EXTRAS))?;
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let corners = corners.map(|[x, y]| DVec3::new(x, y, WATER_LEVEL).as_vec3());
    geometry.add_polygon(&corners, None, WATER)?;
    Ok(Scene {
        image: ImageSettings { width: 1024, height: 1024, background: Rgb::new(0.42, 0.6, 0.85) },
        render: RenderSettings { max_depth: 8, min_weight: 1.0 / 512.0, ..RenderSettings::default() },
        camera: Camera {
            eye: Vec3::new(-0.6, -1.55, 0.9),
            target: Vec3::new(0.0, 0.0, 0.05),
            up: Vec3::Z,
            projection: Projection::PerspectiveAngle { vertical_degrees: 40.0 },
        },
        ambient: Rgb::new(0.2, 0.24, 0.3),
        lights: vec![Light::Directional {
            direction: Vec3::new(1.0, 0.55, -0.75),
            intensity: Rgb::new(1.0, 0.95, 0.85),
        }],
        materials: materials(),
        geometry,
    })
}

fn materials() -> Vec<Material> {
    let matte =
        |color: [f32; 3]| Material { ambient: color.into(), diffuse: color.into(), ..Material::default() };
    let shiny = Material { specular: Rgb::splat(0.5), shininess: 200.0, ..Material::default() };
    vec![
        matte([0.2, 0.3, 0.1]),
        matte([0.36, 0.3, 0.25]),
        matte([0.85, 0.87, 0.92]),
        Material { diffuse: Rgb::new(0.03, 0.09, 0.12), mirror: Rgb::splat(0.55), ..shiny },
        Material {
            dielectric: Some(Dielectric {
                ior: 1.5,
                absorption: Rgb::new(0.8, 0.3, 0.2),
                transmission: Rgb::ONE,
                fresnel: Fresnel::Schlick,
            }),
            ..shiny
        },
    ]
}

/// Adds a grid of two triangles a cell.
fn add_land(geometry: &mut Geometry, count: usize) -> Result<(), GeometryProblem> {
    let (columns, rows) = grid(count / 2);
    let heights = (0..=rows).flat_map(|row| (0..=columns).map(move |column| (row, column)));
    let corners: Vec<DVec3> = heights
        .map(|(row, column)| {
            let place = DVec2::new(column as f64 / columns as f64, row as f64 / rows as f64) * 2.0 - 1.0;
            place.extend(height(place))
        })
        .collect();
    for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
        let corner = |right: usize, up: usize| corners[(row + up) * (columns + 1) + column + right];
        let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
        // The cells' diagonals alternate, so that no direction stands out.
        let triangles = if (row + column) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
        for triangle in triangles {
            let first = geometry.add_vertices(triangle.map(DVec3::as_vec3))?;
            geometry.add_triangle([first, first + 1, first + 2], None, cover(triangle))?;
        }
    }
    Ok(())
}

/// Columns and rows whose product comes nearest to the number of cells, of those that are nearly square.
fn grid(cells: usize) -> (usize, usize) {
    let root = cells.isqrt().max(1);
    let rows = |columns: usize| ((cells + columns / 2) / columns).max(1);
    let miss = |columns: &usize| (columns * rows(*columns)).abs_diff(cells);
    let columns = (3 * root / 4 + 1..=root).rev().min_by_key(miss).unwrap_or(root);
    (columns, rows(columns))
}

/// What grows on a triangle: nothing where it is steep, snow where it is high.
fn cover([a, b, c]: [DVec3; 3]) -> MaterialId {
    let normal = (b - a).cross(c - a);
    let height = (a.z + b.z + c.z) / 3.0;
    if normal.z < 0.62 * normal.length() {
        ROCK
    } else if height > 0.3 {
        SNOW
    } else if height > 0.16 {
        ROCK
    } else {
        GRASS
    }
}

/// World height at a place in [−1, 1]².
fn height(place: DVec2) -> f64 {
    // Turned by an angle of cosine 0.8 and sine 0.6 from octave to octave, so that their lattices do not fall together.
    let (mut at, mut amplitude, mut sum, mut weight) = (1.4 * place + VIEW, 1.0, 0.0, 1.0);
    for octave in 0..OCTAVES {
        let ridge = 1.0 - (2.0 * noise(at, octave) - 1.0).abs();
        // Valleys are smooth: where the coarser octaves are low, the finer ones add little.
        weight *= ridge;
        sum += amplitude * weight;
        weight = (2.0 * weight).min(1.0);
        amplitude *= 0.45;
        at = 2.0 * DVec2::new(0.8 * at.x - 0.6 * at.y, 0.6 * at.x + 0.8 * at.y);
    }
    0.34 * sum - 0.2
}

/// Random values at the points of the unit lattice, in [0, 1), joined smoothly.
fn noise(at: DVec2, octave: u32) -> f64 {
    let corner = at.floor();
    let value = |right: f64, up: f64| {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a whole number of a few thousand at most; its sign is as good a bit as any"
        )]
        let word = |coordinate: f64| coordinate as i32 as u32;
        random_unit([octave, word(corner.x + right), word(corner.y + up)])
    };
    let share = at - corner;
    let share = share * share * share * (share * (6.0 * share - 15.0) + 10.0);
    let along = |up: f64| value(0.0, up) + share.x * (value(1.0, up) - value(0.0, up));
    along(0.0) + share.y * (along(1.0) - along(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_is_nearly_square_and_near_its_size() {
        for cells in (1..200).chain([497, 4_997, 49_997, 499_997, 4_999_997]) {
            let (columns, rows) = grid(cells);
            assert!(columns <= rows && 2 * columns + 1 >= rows, "{columns} x {rows} for {cells}");
            // The nearest number of rows leaves half a row; large grids have many numbers of columns to choose from.
            let most = if cells < 1000 { columns / 2 } else { cells / 500 };
            assert!((columns * rows).abs_diff(cells) <= most, "{columns} x {rows} for {cells}");
        }
    }

    #[test]
    fn noise_joins_its_lattice_without_steps() {
        for k in 0..400 {
            let at = DVec2::new(0.017 * f64::from(k) - 3.0, 0.013 * f64::from(k));
            for way in [DVec2::X, DVec2::Y] {
                let step = (noise(at + 1e-6 * way, 3) - noise(at, 3)).abs();
                // The steepest is the quintic's slope of 15/8 over a difference of 1.
                assert!(step < 2e-6, "{step} at {at}");
            }
        }
        assert_eq!(
            noise(DVec2::new(-2.0, 5.0), 3),
            random_unit([3, 0xFFFF_FFFE, 5]),
            "a point of the lattice"
        );
    }

    #[test]
    fn the_balls_float_over_land_and_water() {
        let scene = scene(1000).unwrap();
        for ball in &scene.geometry.spheres {
            for k in 0..64 {
                let (sin, cos) = crate::math::sin_cos_degrees(f64::from(k) * 360.0 / 64.0);
                for share in [0.0, 0.5, 1.0] {
                    let radius = f64::from(ball.radius);
                    let off = share * radius * DVec2::new(cos, sin);
                    let bottom = f64::from(ball.center.z) - radius * (1.0 - share * share).sqrt();
                    let below = height(ball.center.as_dvec3().truncate() + off).max(WATER_LEVEL);
                    assert!(bottom > below, "{ball:?}: {bottom} over {below}");
                }
            }
        }
    }
}
