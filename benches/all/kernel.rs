//! The kernels: 64 rays against 64 primitives, which all lie in the first cache.

use crate::random::Random;
use criterion::{Criterion, Throughput};
use glam::{Vec3, vec3};
use std::cell::{LazyCell, OnceCell};
use std::hint::black_box;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use wavelane::kernel_bench::{Column, RAYS, Rays, Shapes, meet};
use wavelane::lanes::Width;
use wavelane::load::load;
use wavelane::rays::Stretch;
use wavelane::reference::Tracer;
use wavelane::scene::{Geometry, MaterialId, Scene};

/// Rays of a packet, 8 × 8, and as many primitives.
const SIDE: usize = 8;
const COUNT: usize = RAYS;
const _: () = assert!(SIDE * SIDE == COUNT);

/// No coordinate of a primitive is larger.
const EXTENT: f32 = 4.0;

pub(crate) fn benches(criterion: &mut Criterion) {
    let directions = directions();
    let rays = Rays::new(&directions.map(|direction| [[0.0; 3], direction.to_array()]), EXTENT);
    for (kind, shapes) in
        [("sphere", spheres()), ("triangle", triangles()), ("polygon", polygons()), ("box", boxes())]
    {
        let truth = LazyCell::new(|| Truth::new(&directions, &shapes));
        let mut group = criterion.benchmark_group(format!("kernel/{kind}"));
        group.throughput(Throughput::Elements((COUNT * COUNT) as u64));
        for width in Width::ALL {
            let checked = OnceCell::new();
            let mut nearest = [f32::INFINITY; COUNT];
            group.bench_function(format!("f32x{}", width.lanes()), |bencher| {
                checked.get_or_init(|| {
                    let pairs = meet(width, &rays, &shapes, &mut nearest);
                    truth.assert_found(pairs, &nearest);
                });
                bencher.iter(|| {
                    nearest = [f32::INFINITY; COUNT];
                    meet(width, black_box(&rays), black_box(&shapes), &mut nearest)
                });
            });
        }
    }
}

/// What the f64 reference finds, a primitive at a time.
struct Truth {
    /// Pairs of ray and primitive that hit.
    pairs: u64,
    /// The nearest t of each ray.
    nearest: [f64; COUNT],
}

impl Truth {
    fn new(directions: &[Vec3; COUNT], shapes: &Shapes) -> Self {
        let stop = AtomicBool::new(false);
        let (mut pairs, mut nearest) = (0, [f64::INFINITY; COUNT]);
        for scene in scenes(shapes) {
            let tracer = Tracer::new(&scene, &stop);
            for (direction, nearest) in directions.iter().zip(&mut nearest) {
                let met = tracer.closest(&Stretch {
                    origin: glam::DVec3::ZERO,
                    direction: direction.as_dvec3(),
                    t_min: 0.0,
                    t_max: f64::INFINITY,
                    departure: None,
                });
                if let Some(met) = met {
                    pairs += 1;
                    *nearest = nearest.min(met.t);
                }
            }
        }
        assert!(0 < pairs && pairs < (COUNT * COUNT) as u64, "some pairs hit, and some miss");
        Self { pairs, nearest }
    }

    fn assert_found(&self, pairs: u64, nearest: &Column) {
        assert_eq!(pairs, self.pairs, "pairs that hit");
        for (&found, &truth) in nearest.iter().zip(&self.nearest) {
            let found = f64::from(found);
            assert!(found == truth || (found - truth).abs() <= 1e-5 * truth, "t = {found}, in truth {truth}");
        }
    }
}

/// Scenes of one primitive each; boxes have twelve triangles, which a ray from outside meets where it enters.
fn scenes(shapes: &Shapes) -> Vec<Scene> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/sphereflake.toml");
    let scene = load(&path).unwrap_or_else(|error| panic!("{error}")).scene;
    let material = MaterialId(0);
    let with = |add: &dyn Fn(&mut Geometry)| {
        let mut scene = Scene { geometry: Geometry::default(), ..scene.clone() };
        add(&mut scene.geometry);
        scene
    };
    let add_triangle = |geometry: &mut Geometry, corners: [Vec3; 3]| {
        let first = geometry.add_vertices(corners).unwrap();
        geometry.add_triangle([first, first + 1, first + 2], None, material).unwrap();
    };
    match shapes {
        Shapes::Spheres(spheres) => spheres
            .iter()
            .map(|&(center, radius)| with(&|to| to.add_sphere(center.into(), radius, material).unwrap()))
            .collect(),
        Shapes::Triangles(triangles) => {
            triangles.iter().map(|corners| with(&|to| add_triangle(to, corners.map(Vec3::from)))).collect()
        }
        Shapes::Polygons(polygons) => polygons
            .iter()
            .map(|(corners, _)| {
                let corners: Vec<Vec3> = corners.iter().copied().map(Vec3::from).collect();
                with(&|to| {
                    to.add_polygon(&corners, None, material).unwrap();
                })
            })
            .collect(),
        Shapes::Boxes(boxes) => boxes
            .iter()
            .map(|corners| {
                with(&|to| {
                    for face in faces(corners.map(Vec3::from)) {
                        add_triangle(to, face);
                    }
                })
            })
            .collect(),
    }
}

/// The twelve triangles of a box.
fn faces(corners: [Vec3; 2]) -> Vec<[Vec3; 3]> {
    let mut faces = Vec::new();
    for axis in 0..3 {
        for side in corners {
            let corner = |high: [usize; 2]| {
                let mut corner = side;
                corner[(axis + 1) % 3] = corners[high[0]][(axis + 1) % 3];
                corner[(axis + 2) % 3] = corners[high[1]][(axis + 2) % 3];
                corner
            };
            faces.push([corner([0, 0]), corner([1, 0]), corner([1, 1])]);
            faces.push([corner([0, 0]), corner([1, 1]), corner([0, 1])]);
        }
    }
    faces
}

/// Of rays from the origin through a square at z = 1, one a cell, a little off its middle.
fn directions() -> [Vec3; COUNT] {
    let random = Random::new(1);
    std::array::from_fn(|ray| {
        let [x, y] = random.pair(ray, 0).map(|off| off as f32);
        let (column, row) = ((ray % SIDE) as f32, (ray / SIDE) as f32);
        vec3(within((column + x) / SIDE as f32), within((row + y) / SIDE as f32), 1.0)
    })
}

/// From [0, 1) to the square's side.
fn within(share: f32) -> f32 {
    0.2 + 0.4 * share
}

/// Where a primitive lies: anywhere in what the rays see, from z = 2 to 4; and as far as it may reach from there, so that it
/// looks as large from anywhere.
fn place(index: usize) -> (Vec3, f32) {
    let random = Random::new(2);
    let ([x, y], [depth, _]) = (random.pair(index, 0), random.pair(index, 1));
    let z = 2.0 + 2.0 * depth as f32;
    (vec3(z * within(x as f32), z * within(y as f32), z), 0.08 * z)
}

/// From −1 to 1, three numbers for each `which`.
fn offset(index: usize, which: u32) -> Vec3 {
    let random = Random::new(3);
    let ([x, y], [z, _]) = (random.pair(index, 2 * which), random.pair(index, 2 * which + 1));
    vec3(x as f32, y as f32, z as f32) * 2.0 - 1.0
}

fn spheres() -> Shapes {
    let sphere = |index| {
        let (center, reach) = place(index);
        (center.to_array(), reach)
    };
    Shapes::Spheres((0..COUNT).map(sphere).collect())
}

fn triangles() -> Shapes {
    let triangle = |index| {
        let (center, reach) = place(index);
        [0, 1, 2].map(|corner| (center + offset(index, corner) * reach * 2.0).to_array())
    };
    Shapes::Triangles((0..COUNT).map(triangle).collect())
}

/// Stars of five points, which are concave.
fn polygons() -> Shapes {
    let polygon = |index| {
        let (center, reach) = place(index);
        let normal = (offset(index, 0) + vec3(0.0, 0.0, 2.0)).normalize();
        let u = normal.any_orthonormal_vector() * reach;
        let v = normal.cross(u);
        let corner = |corner: u8| {
            let (sine, cosine) = (f32::from(corner) * std::f32::consts::TAU / 10.0).sin_cos();
            let size = if corner.is_multiple_of(2) { 1.5 } else { 0.75 };
            (center + (u * cosine + v * sine) * size).to_array()
        };
        ((0..10).map(corner).collect(), normal.to_array())
    };
    Shapes::Polygons((0..COUNT).map(polygon).collect())
}

fn boxes() -> Shapes {
    let each = |index| {
        let (center, reach) = place(index);
        let half = (offset(index, 0) * 0.5 + 1.0) * reach * 0.7;
        [(center - half).to_array(), (center + half).to_array()]
    };
    Shapes::Boxes((0..COUNT).map(each).collect())
}
