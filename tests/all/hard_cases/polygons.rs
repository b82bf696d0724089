//! Planar polygons: cases 35 to 41.

use super::case::{Aimed, Case, Faces, Shape, Within, ray, scene};
use super::outline::{SPLIT, STAR, is_on_edge, winding_number};
use super::run::{Company, ENGINES, Engines, counted_one_by_one, refused, warned};
use super::solids::{Made, Placing, aimed_at, cube_faces, rounded, seams, turned};
use Shape::Polygon;
use Within::{Absolute, Ulps};
use glam::DVec3;

hard_cases! {
    case_35_closed_box_of_polygons: BOX_AT_ORIGIN,
    case_35_closed_box_of_polygons_small: SMALL_BOX,
    case_35_closed_box_of_polygons_far: FAR_BOX,
    case_36_vertex_level_with_the_point: LEVEL_VERTICES,
    case_39_bow_tie: BOW_TIE,
    case_40_non_planar_quad_1e_7: BENT_LEAST,
    case_40_non_planar_quad_1e_4: BENT,
    case_41_projection_tie: PROJECTION_TIE,
}

/// From within at corners and edges: a hit, of one face; lines from outside: as often in as out.
fn rays_at_box(place: Placing) -> Vec<Aimed> {
    let targets = seams(&cube_faces(1, place));
    let inside = [[0.0, 0.0, 0.0], [0.3, -0.2, 0.9], [-0.99, 0.99, 0.98], [0.5, 0.5, -0.5]];
    let outside = [[4.0, 0.3, -0.2], [-1.5, 3.0, 2.5], [0.1, 0.2, -7.0]];
    let from = |origins: &[[f64; 3]]| -> Vec<Aimed> {
        let origins = origins.iter().map(|&origin| rounded(place(DVec3::from(origin))));
        origins.flat_map(|origin| targets.iter().map(move |&target| aimed_at(origin, target))).collect()
    };
    let inside = from(&inside).into_iter().map(|ray| ray.hits_something().on_faces(Faces::Exactly(1)));
    inside.chain(from(&outside).into_iter().map(|ray| ray.unasked().on_faces(Faces::Even))).collect()
}

fn box_of_polygons(place: Placing) -> Vec<Shape> {
    Made::Polygons.shapes(&cube_faces(1, place))
}

const BOX_AT_ORIGIN: Case = Case {
    number: 35,
    name: "closed box of polygons",
    shapes: || box_of_polygons(turned),
    rays: || rays_at_box(turned),
};

/// 10⁻³ beside (1, 1, 1): its corners are 10⁻⁷ off, its faces so much bent.
fn small(point: DVec3) -> DVec3 {
    1e-3 * turned(point) + DVec3::ONE
}

const SMALL_BOX: Case = Case {
    number: 35,
    name: "closed box of polygons, 10⁻³ at 1",
    shapes: || box_of_polygons(small),
    rays: || rays_at_box(small),
};

fn far(point: DVec3) -> DVec3 {
    turned(point) + DVec3::new(1000.0, -1000.0, 1000.0)
}

const FAR_BOX: Case = Case {
    number: 35,
    name: "closed box of polygons, 1 at 1000",
    shapes: || box_of_polygons(far),
    rays: || rays_at_box(far),
};

/// 10⁻³ at 1000 has corners that are 3·10⁻⁵ off: what is left of the faces is not planar, or by chance it is.
#[test]
fn case_35_what_rounding_leaves_nothing_of_is_refused() {
    let lost = cube_faces(1, |point| 1e-3 * turned(point) + DVec3::new(1000.3, -999.7, 1000.1));
    let tables: String =
        lost.iter().map(|face| format!("[[polygon]]\nvertices = {face:?}\nmaterial = \"m\"\n")).collect();
    refused(&tables, "the polygon is not planar");
}

/// A star with two level edges, in a plane across each axis, from both sides, and at all halves of the lattice that its corners
/// are on. Aslant too, with steps that f32 holds to the bit.
const LEVEL_VERTICES: Case = Case {
    number: 36,
    name: "vertex level with the point",
    shapes: || (0..3).map(|axis| Polygon(STAR.map(|point| level(axis, point, 0.0)).to_vec())).collect(),
    rays: || {
        let mut rays = Vec::new();
        for (x, y) in (-1..=33).flat_map(|x| (-1..=33).map(move |y| (x, y))) {
            if is_on_edge(&STAR, [x, y]) {
                continue;
            }
            let inside = winding_number(&STAR, [x, y]) != 0;
            let [x, y] = [x, y].map(|half| f32::from(half) / 2.0);
            for (axis, way) in (0..3).flat_map(|axis| [4.0, -4.0_f32].map(|way| (axis, way))) {
                for [slope_x, slope_y] in [[0.0, 0.0], [0.5, -0.25], [-0.0625, 0.125]] {
                    let direction = level_way(axis, [slope_x, slope_y], way.signum());
                    let origin = level_at(axis, [x - 4.0 * slope_x, y - 4.0 * slope_y], -way);
                    let ray = ray(origin, direction);
                    rays.push(if inside { ray.hits(axis as u32, 4.0, Ulps(0.0)) } else { ray.misses() });
                }
            }
        }
        rays
    },
};

/// A point in the plane across an axis, 64 up the plane's own axes for each axis, so that no ray meets two planes.
fn level(axis: usize, [x, y]: [i16; 2], height: f32) -> [f32; 3] {
    level_at(axis, [x, y].map(|whole| f32::from(whole / 2) + f32::from(whole % 2) / 2.0), height)
}

fn level_at(axis: usize, [x, y]: [f32; 2], height: f32) -> [f32; 3] {
    let up = 64.0 * axis as f32;
    let mut point = [height - 64.0; 3];
    (point[(axis + 1) % 3], point[(axis + 2) % 3]) = (x + up, y + up);
    point
}

fn level_way(axis: usize, [x, y]: [f32; 2], way: f32) -> [f32; 3] {
    let mut direction = [way; 3];
    (direction[(axis + 1) % 3], direction[(axis + 2) % 3]) = (x, y);
    direction
}

/// A concave polygon of twelve corners in two parts along a chord: where the whole is hit one part is, and else none, at
/// points all over, on the chord and on the outline.
#[test]
fn case_37_partition() {
    let flat = |corners: &[[i16; 2]], tilt: f32| {
        Polygon(corners.iter().map(|&[x, y]| [f32::from(x), f32::from(y), tilt * f32::from(x + y)]).collect())
    };
    let [whole, one, other] = SPLIT;
    let mut points: Vec<[f32; 2]> = (0..=160_u8)
        .flat_map(|i| (0..=140_u8).map(move |j| [i, j].map(|k| f32::from(k) / 8.0 - 1.0)))
        .collect();
    // On the chord, from its first corner to its last, in steps that f32 rounds.
    let ([x0, y0], [x1, y1]) = (one[0].map(f32::from), one[one.len() - 1].map(f32::from));
    points.extend(
        (0..4000_u16).map(|k| f32::from(k) / 3999.0).map(|s| [x0 + s * (x1 - x0), y0 + s * (y1 - y0)]),
    );
    for tilt in [0.0, 0.25] {
        let whole = scene(&[flat(whole, tilt)]);
        let parts = scene(&[flat(one, tilt), flat(other, tilt)]);
        for direction in [[0.0, 0.0, -1.0], [0.31, -0.17, -0.9], [0.9, 0.5, -0.3]] {
            let start = |[x, y]: [f32; 2]| {
                let z = tilt * (x + y);
                [x - 8.0 * direction[0], y - 8.0 * direction[1], z - 8.0 * direction[2]]
            };
            let rays: Vec<Aimed> = points.iter().map(|&point| ray(start(point), direction)).collect();
            let [of_whole, of_parts] = [&whole, &parts].map(|scene| counted_one_by_one(scene, &rays));
            for (engine, (of_whole, of_parts)) in ENGINES.iter().zip(of_whole.iter().zip(&of_parts)) {
                let wrong = (0..rays.len()).find(|&index| of_whole[index] != of_parts[index]);
                if let Some(index) = wrong {
                    let (found, wanted) = (of_parts[index], of_whole[index]);
                    panic!(
                        "case 37, partition, {engine:?}: {:?}: found {found} parts, wanted {wanted}",
                        rays[index].row
                    );
                }
                assert!(of_whole.iter().sum::<usize>() > 5000, "rays hit it");
            }
        }
    }
}

/// Corners twice, the first one again at the end, corners along an edge, and a hole by way of a slit that is walked twice.
#[test]
fn case_38_dirty_input() {
    let clean: [[i16; 2]; 5] = [[0, 0], [8, 0], [8, 8], [4, 3], [0, 8]];
    let dirty: [&[[i16; 2]]; 5] = [
        &[[0, 0], [0, 0], [8, 0], [8, 8], [8, 8], [8, 8], [4, 3], [0, 8]],
        &[[0, 0], [8, 0], [8, 8], [4, 3], [0, 8], [0, 0]],
        &[[0, 0], [1, 0], [2, 0], [6, 0], [8, 0], [8, 3], [8, 8], [4, 3], [0, 8], [0, 1]],
        // There and back again along a line inside, and along one outside.
        &[[0, 0], [3, 2], [0, 0], [8, 0], [8, 8], [4, 3], [0, 8]],
        &[[0, 0], [8, 0], [12, 5], [8, 0], [8, 8], [4, 3], [0, 8]],
    ];
    // Planes that f32 holds to the bit, and a way to look at them that leaves their numbers as they are.
    type Plane = (fn(f32, f32) -> [f32; 3], [f32; 3]);
    let planes: [Plane; 3] = [
        (|x, y| [x, y, 1.0], [0.0, 0.0, -4.0]),
        (|x, y| [x, 0.5 * x - 0.25 * y, y], [0.0, 4.0, 0.0]),
        (|x, y| [x, y, 4.0 - y], [0.0, 0.0, 8.0]),
    ];
    for (plane, straight) in planes {
        let of = |corners: &[[i16; 2]]| {
            scene(&[Polygon(
                corners.iter().map(|corner| corner.map(f32::from)).map(|[x, y]| plane(x, y)).collect(),
            )])
        };
        let quarters = (-8..=40_i16).flat_map(|x| (-8..=40_i16).map(move |y| [x, y]));
        let clean_in_quarters = clean.map(|corner| corner.map(|whole| 4 * whole));
        let rays: Vec<Aimed> = quarters
            .flat_map(|quarters| {
                let [x, y] = quarters.map(|k| f32::from(k) / 4.0);
                let point = plane(x, y);
                let start = [0, 1, 2].map(|axis| point[axis] - straight[axis]);
                // Aslant, corners along an edge are rounded each for itself, so what is on that edge is free to be inside.
                let aslant = [[-3.0, 2.0, 11.0], [4.1, -9.0, 5.3]]
                    .map(|origin| aimed_at(origin, DVec3::from(point.map(f64::from))))
                    .into_iter()
                    .filter(move |_| !is_on_edge(&clean_in_quarters, quarters));
                [ray(start, straight)].into_iter().chain(aslant).collect::<Vec<_>>()
            })
            .collect();
        let clean = of(&clean);
        for (index, dirty) in dirty.iter().enumerate() {
            let dirty = of(dirty);
            for engine in ENGINES {
                let [wanted, found] = [&clean, &dirty]
                    .map(|scene| Engines::new(scene, 1).answers(&rays, engine, Company::Listed));
                for (ray, (wanted, found)) in rays.iter().zip(wanted.into_iter().zip(found)) {
                    let same = wanted.has_same_bits(found);
                    assert!(
                        same,
                        "case 38, dirty input {index}, {engine:?}: {:?}: found {found}, wanted {wanted}",
                        ray.row
                    );
                }
            }
        }
    }
}

#[test]
fn case_38_a_hole_by_a_slit() {
    let slit: [[i16; 2]; 10] =
        [[0, 0], [16, 0], [16, 16], [0, 16], [0, 0], [4, 4], [4, 12], [12, 12], [12, 4], [4, 4]];
    let scene = scene(&[Polygon(slit.iter().map(|&[x, y]| [f32::from(x), f32::from(y), 0.0]).collect())]);
    let points = (1..32_u8).flat_map(|i| (1..32_u8).map(move |j| [i, j].map(|k| f32::from(k) / 2.0)));
    // Off the rim of the hole and off the slit.
    let points: Vec<[f32; 2]> = points
        .filter(|&[x, y]| {
            let from_middle = (x - 8.0).abs().max((y - 8.0).abs());
            from_middle != 4.0 && !(x == y && x <= 4.0)
        })
        .collect();
    let rays: Vec<Aimed> = points.iter().map(|&[x, y]| ray([x, y, 1.0], [0.0, 0.0, -1.0])).collect();
    for engine in ENGINES {
        let found = Engines::new(&scene, 1).answers(&rays, engine, Company::Listed);
        for (&[x, y], found) in points.iter().zip(found) {
            let in_hole = (x - 8.0).abs().max((y - 8.0).abs()) < 4.0;
            assert_eq!(found.occluded, !in_hole, "case 38, hole, {engine:?}: at ({x}, {y}): found {found}");
        }
    }
}

#[test]
fn case_38_all_on_a_line_is_left_out() {
    let (scene, warnings) = warned(
        "[[polygon]]\nvertices = [[0, 0, 0], [1, 2, 3], [2, 4, 6], [0.5, 1, 1.5]]\nmaterial = \"m\"\n",
    );
    assert_eq!(warnings, [("this shape has no area and is left out".to_owned(), 1)]);
    assert_eq!(scene.geometry.primitive_count(), 0);
}

/// Of unequal wings: inside is where a line crosses the boundary an odd number of times, so both wings are.
const BOW_TIE: Case = Case {
    number: 39,
    name: "bow-tie",
    shapes: || vec![Polygon(vec![[0.0; 3], [3.0, 3.0, 0.0], [3.0, 0.0, 0.0], [0.0, 1.0, 0.0]])],
    rays: || {
        // The edges cross at x = y = ¾.
        let down = |x: f32, y: f32| ray([x, y, 1.0], [0.0, 0.0, -1.0]);
        let [left, right] = [down(0.25, 0.5), down(2.0, 1.0)].map(|ray| ray.hits(0, 1.0, Ulps(0.0)));
        let [above, below] = [down(0.75, 1.5), down(0.75, 0.25)].map(Aimed::misses);
        vec![left, right, above, below]
    },
};

/// Of equal wings, of opposite senses, the sum of the areas is 0: there is no normal, and so no plane.
#[test]
fn case_39_bow_tie_of_equal_wings_is_left_out() {
    let (scene, warnings) =
        warned("[[polygon]]\nvertices = [[0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0]]\nmaterial = \"m\"\n");
    assert_eq!(warnings, [("this shape has no area and is left out".to_owned(), 1)]);
    assert_eq!(scene.geometry.primitive_count(), 0);
}

/// 3 × 3 unit squares with one of the corners that four share raised.
fn bent(height: f32) -> Vec<Vec<[f32; 3]>> {
    let corner = |i: u8, j: u8| [f32::from(i), f32::from(j), if [i, j] == [1, 2] { height } else { 0.0 }];
    let squares = (0..3_u8).flat_map(|i| (0..3_u8).map(move |j| (i, j)));
    squares
        .map(|(i, j)| vec![corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)])
        .collect()
}

/// t is that of some point between the lowest and the highest corner.
fn rays_at_bent(height: f32) -> Vec<Aimed> {
    let inner = seams(&bent(height))
        .into_iter()
        .filter(|point| [point.x, point.y].into_iter().all(|at| at > 0.0 && at < 3.0));
    let origins = [[1.1, 1.7, 4.0], [-3.0, 8.0, 5.0], [1.5, 2.5, -9.0], [30.0, 1.2, 3.0_f32]];
    let mut rays = Vec::new();
    for (target, origin) in inner.flat_map(|target| origins.map(|origin| (target, origin))) {
        let ray = aimed_at(origin, target);
        let unit = ray.direction().z.abs();
        let within = f64::from(height) / unit + 6.0 * f64::from(f32::EPSILON / 2.0) * 40.0 / unit;
        rays.push(
            ray.hits_something_at(f64::from(origin[2].abs()) / unit, Absolute(within))
                .on_faces(Faces::Exactly(1)),
        );
    }
    rays
}

const BENT_LEAST: Case = Case {
    number: 40,
    name: "non-planar quad, by 10⁻⁷",
    shapes: || Made::Polygons.shapes(&bent(1e-7)),
    rays: || rays_at_bent(1e-7),
};

const BENT: Case = Case {
    number: 40,
    name: "non-planar quad, by 10⁻⁴",
    shapes: || Made::Polygons.shapes(&bent(1e-4)),
    rays: || rays_at_bent(1e-4),
};

#[test]
fn case_40_non_planar_quads_are_warned_about_and_refused() {
    let raised = |height: f32| {
        format!(
            "[[polygon]]\nvertices = [[0, 0, 0], [1, 0, 0], [1, 1, {height:?}], [0, 1, 0]]\nmaterial = \"m\"\n"
        )
    };
    assert!(warned(&raised(1e-7)).1.is_empty(), "as flat as f32 makes them");
    let (_, warnings) = warned(&raised(1e-4));
    assert!(warnings.len() == 1 && warnings[0].0.contains("not quite planar"), "{warnings:?}");
    refused(&raised(1e-2), "the polygon is not planar");
}

/// Normals (1, 1, 0)/√2 and (1, 1, 1)/√3, whose largest components are equal: hit from before and behind, missed from within
/// the plane.
const PROJECTION_TIE: Case = Case {
    number: 41,
    name: "projection tie, edge-on",
    shapes: || {
        vec![
            Polygon(vec![[1.0, 0.0, -1.0], [0.0, 1.0, -1.0], [0.0, 1.0, 1.0], [1.0, 0.0, 1.0]]),
            Polygon(vec![[13.0, 10.0, 10.0], [10.0, 13.0, 10.0], [10.0, 10.0, 13.0]]),
        ]
    },
    rays: || {
        let mut rays = Vec::new();
        for back in [1.0, -1.0_f32] {
            let [at, to] = [0.5 - back, back];
            rays.push(ray([at, at, 0.25], [to, to, 0.0]).hits(0, 1.0, Ulps(2.0)));
            let at = 11.0 - back;
            rays.push(ray([at; 3], [to; 3]).hits(1, 1.0, Ulps(2.0)));
        }
        let in_plane = [
            ray([2.0, -1.0, 0.25], [-1.0, 1.0, 0.0]),
            ray([2.0, -1.0, -1.0], [-1.0, 1.0, 0.0]),
            ray([0.5, 0.5, -3.0], [0.0, 0.0, 1.0]),
            ray([2.0, -1.0, -1.5], [-1.0, 1.0, 1.0]),
            ray([13.0, 13.0, 7.0], [-1.0, -1.0, 2.0]),
            ray([9.0, 12.0, 12.0], [2.0, -1.0, -1.0]),
            ray([14.0, 9.0, 10.0], [-1.0, 1.0, 0.0]),
        ];
        rays.extend(in_plane.map(Aimed::misses));
        rays
    },
};
