//! Triangles on their own: cases 14, 17 to 20, 22 and 24.

use super::case::{Aimed, Case, Faces, Shape, Within, plane_t, ray};
use super::run::warned;
use super::solids::{Made, cube_faces};
use Shape::Triangle;
use Within::{Absolute, Between, Roundings, Ulps};
use glam::DVec3;

hard_cases! {
    case_14_crack_of_a_fused_multiply_add: FUSED_CRACK,
    case_17_ray_in_the_plane: IN_PLANE,
    case_18_no_absolute_epsilon: SMALL_DETERMINANT,
    case_19_zero_area: ZERO_AREA,
    case_20_needle_across: NEEDLE_ACROSS,
    case_20_needle_along: NEEDLE_ALONG,
    case_20_needle_tip: NEEDLE_TIP,
    case_22_underflow_beside_a_unit: UNDERFLOW,
    case_22_underflow_alone: UNDERFLOW_ALONE,
    case_24_huge_extents_of_triangles: HUGE_TRIANGLES,
    case_24_huge_extents_of_polygons: HUGE_POLYGONS,
}

/// Of A and B the doubled area W = B_x·A_y − B_y·A_x is 0, but −2⁻²⁴ if one product is not rounded: then both triangles are
/// missed, and of the other sense both hit. U and V are 2.0005. Before the eye in one sense, behind it in the other.
const FUSED_CRACK: Case = Case {
    number: 14,
    name: "crack of a fused multiply-add",
    shapes: || {
        let s = 1.0 + 1.0 / 4096.0;
        let pair = |z: f32| ([s, s, z], [-s, -s, z], [-1.0, 1.0, z], [1.0, -1.0, z]);
        let ((a, b, c, d), (e, f, g, h)) = (pair(1.0), pair(-1.0));
        vec![Triangle([a, b, c]), Triangle([b, a, d]), Triangle([e, g, f]), Triangle([f, h, e])]
    },
    rays: || {
        let along = |z: f32| ray([0.0; 3], [0.0, 0.0, z]).hits_something_at(1.0, Ulps(0.0));
        [1.0, -1.0].map(|z| along(z).on_faces(Faces::Exactly(1))).into()
    },
};

const IN_PLANE: Case = Case {
    number: 17,
    name: "ray in the triangle's plane",
    // In z = 0, and in y = z, whose coordinates along the rays are exact too.
    shapes: || {
        vec![
            Triangle([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]),
            Triangle([[4.0, 0.0, 0.0], [5.0, 0.0, 0.0], [4.0, 1.0, 1.0]]),
        ]
    },
    rays: || {
        let origins = [[-1.0, 0.25, 0.0], [-1.0, 0.0, 0.0], [0.25, 0.25, 0.0], [3.0, 0.25, 0.25], [4.25; 3]];
        let along = origins.map(|origin| ray(origin, [1.0, 0.0, 0.0]));
        let across = [ray([0.25, -1.0, 0.0], [0.0, 1.0, 0.0]), ray([1.0, 0.0, 0.0], [-1.0, 1.0, 0.0])];
        let aslant = [ray([4.25, -1.0, -1.0], [0.0, 1.0, 1.0]), ray([4.0, 0.0, 0.0], [0.0, 2.0, 2.0])];
        along.into_iter().chain(across).chain(aslant).map(Aimed::misses).collect()
    },
};

/// In the corner at the origin of a plane z = 0; a unit triangle elsewhere sets the scale of the scene.
fn corner(leg: f32) -> Shape {
    Triangle([[0.0; 3], [leg, 0.0, 0.0], [0.0, leg, 0.0]])
}

fn unit_triangle_elsewhere() -> Shape {
    Triangle([[5.0, 0.0, 0.0], [6.0, 0.0, 0.0], [5.0, 1.0, 0.0]])
}

/// The determinant is the doubled area, 10⁻⁸ and less.
const SMALL_DETERMINANT: Case = Case {
    number: 18,
    name: "absolute epsilon of a determinant",
    shapes: || vec![corner(1e-4), unit_triangle_elsewhere()],
    rays: || {
        let down = |x: f32, y: f32| ray([x, y, 1.0], [0.0, 0.0, -1.0]);
        vec![
            down(2e-5, 2e-5).hits(0, 1.0, Ulps(0.0)),
            down(9e-5, 5e-6).hits(0, 1.0, Ulps(0.0)),
            down(6e-5, 6e-5).misses(),
            ray([2e-5, 2e-5, 1.0], [0.0, 0.0, -1e-4]).hits(0, 1e4, Ulps(2.0)),
        ]
    },
};

/// Three points of a line, and a ray at them.
const LINE: [[f32; 3]; 3] = [
    [-1_113.454_6, -79.049_614, -56.243_19],
    [-1_113.454_6, -87.092_27, -56.243_19],
    [-1_113.454_6, -79.209_015, -56.243_19],
];

const ZERO_AREA: Case = Case {
    number: 19,
    name: "zero area",
    shapes: || vec![Triangle(LINE), unit_triangle_elsewhere()],
    rays: || {
        let origin = [-1_081.479_2, 99.999_954, 87.770_11];
        vec![ray(origin, [-32.107_3, -183.355_87, -144.607_64]).misses()]
    },
};

#[test]
fn case_19_zero_area_is_left_out_and_counted() {
    let of = |corners: [[f32; 3]; 3]| format!("[[triangle]]\nvertices = {corners:?}\nmaterial = \"m\"\n");
    let point = [[1.5, -2.0, 0.1]; 3];
    let whole = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let (scene, warnings) = warned(&[LINE, whole, point, LINE].map(of).concat());
    assert_eq!(warnings, [("this shape has no area and is left out".to_owned(), 3)]);
    let ids: Vec<u32> = scene.geometry.triangles.iter().map(|triangle| triangle.id.0).collect();
    assert_eq!(ids, [1], "what is left out keeps its number");
}

/// 11 long and 9·10⁻⁶ high, from 500 away at 0.52°: the rounding of its place, 6u·L = 1.8·10⁻⁴, is twenty times its height.
fn needle() -> Vec<Shape> {
    vec![Triangle([[120.3, -45.2, 210.7], [131.5, -44.8, 210.8], [130.1, -44.84999, 210.7875]])]
}

const WITHIN_ROUNDING: &str = "it passes the edges by less than 6uL";

/// Across the needle all corners are 500 away, to 10⁻⁵. Whether the ray passes inside and where were found in fractions.
const NEEDLE_ACROSS: Case = Case {
    number: 20,
    name: "needle, across",
    shapes: needle,
    rays: || {
        let hits = [
            (
                [149.041_24, -498.6929, 1.817_740_4],
                [-0.036_151_655, 0.907_747_6, 0.417_954_98],
                499.999_998_790_045_14,
            ),
            (
                [147.730_18, -498.74, 1.806_273_8],
                [-0.036_151_666, 0.907_748_16, 0.417_954_5],
                500.000_000_808_834,
            ),
            (
                [146.834_44, -498.7724, 1.797_887_7],
                [-0.036_151_707, 0.907_749, 0.417_955_28],
                499.999_995_165_919_36,
            ),
            (
                [147.4696, -498.7494, 1.803_602_7],
                [-0.036_151_66, 0.907_748_34, 0.417_955_2],
                499.999_999_699_947_35,
            ),
        ];
        let misses = [
            ([146.683_47, -498.777_62, 1.796_614_5], [-0.036_151_69, 0.907_748_64, 0.417_955_13]),
            ([147.054_98, -498.764_34, 1.799_886_1], [-0.036_151_71, 0.907_748_64, 0.417_955_22]),
        ];
        let near = Absolute(1e-3);
        let hits =
            hits.map(|(origin, direction, t)| ray(origin, direction).may_miss(0, t, near, WITHIN_ROUNDING));
        let misses =
            misses.map(|(origin, direction)| ray(origin, direction).may_hit(0, 500.0, near, WITHIN_ROUNDING));
        hits.into_iter().chain(misses).collect()
    },
};

/// Six faces at a tip that the ray goes through exactly. So narrow a face has hardly any volume for a start to be off its plane by: f64
/// decides on which side of it the ray starts, which must not let the faces disagree about an edge that only f32 has the ray pass.
const NEEDLE_TIP: Case = Case {
    number: 20,
    name: "needle, its tip",
    shapes: || {
        let tips = [[0.247_399, -0.396_876_34, -0.174_099_6], [-0.247_298_21, 0.397_252_44, 0.178_936_03]];
        let ring = [
            [0.002_624_029_8, 0.001_090_639_2, 0.003_994_258],
            [0.000_469_158_67, -0.000_858_657_35, 0.005_359_513],
            [-0.002_166_82, -0.001_715_719_9, 0.003_593_705],
            [-0.002_650_435_3, -0.001_008_027, 0.001_324_125],
            [-0.000_458_962_55, 0.001_180_346_6, -0.000_527_628_3],
            [0.001_961_101_3, 0.002_098_236_5, 0.000_798_799_4],
        ];
        let side = |(tip, at): (usize, usize)| Triangle([tips[tip], ring[at], ring[(at + 1) % 6]]);
        (0..6).flat_map(|at| [side((0, at)), side((1, at))]).collect()
    },
    rays: || {
        let to_tip =
            ray([-0.103_964_37, 0.166_944_5, 0.077_743_77], [-0.143_333_84, 0.230_307_94, 0.101_192_266]);
        vec![to_tip.hits_something_at(1.0, Ulps(1.0)).on_faces(Faces::Exactly(1))]
    },
};

/// Along it no f32 can tell where on the needle it is met: t stays between those of its corners, 11.2 apart, and no bound is
/// better.
const NEEDLE_ALONG: Case = Case {
    number: 20,
    name: "needle, along",
    shapes: needle,
    rays: || {
        let hits = [
            (
                ([-371.063_02, -60.888_38, 202.173_54], [0.999_341_3, 0.031_970_173, 0.017_201_273]),
                (500.000_527_534_208_86, Between(491.687_08, 502.894_21)),
            ),
            (
                ([-370.691, -60.875_103, 202.176_86], [0.999_340_24, 0.031_970_15, 0.017_201_276]),
                (499.999_252_281_594_7, Between(491.315_36, 502.522_5)),
            ),
            (
                ([-374.473_63, -61.010_178, 202.143_08], [0.999_341_1, 0.031_970_143, 0.017_201_28]),
                (500.000_235_043_555, Between(495.099_98, 506.307_11)),
            ),
        ];
        let missed = ray([-369.850_65, -60.845_097, 202.184_37], [0.999_340_4, 0.031_970_177, 0.017_201_265]);
        let rays = hits.map(|((origin, direction), (t, corners))| {
            ray(origin, direction).may_miss(0, t, corners, WITHIN_ROUNDING)
        });
        let missed = missed.may_hit(0, 496.1, Between(490.4, 501.8), WITHIN_ROUNDING);
        rays.into_iter().chain([missed]).collect()
    },
};

const SMALL_LEGS: [f32; 6] = [1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15];

/// Legs of 10⁻¹⁰ to 10⁻¹⁵, which is 2⁻⁵⁰, beside a triangle of 1: doubled areas down to 10⁻³⁰, and times t down to 10⁻⁴⁵.
const UNDERFLOW: Case = Case {
    number: 22,
    name: "underflow, beside a unit",
    shapes: || {
        let small = SMALL_LEGS.map(|leg| {
            // Each a little above the one before, and tilted: z falls by as much as y grows.
            Triangle([[0.0, 0.0, leg], [leg, 0.0, leg], [0.0, leg, 0.0]])
        });
        small.into_iter().chain([unit_triangle_elsewhere()]).collect()
    },
    rays: || {
        let rays = SMALL_LEGS.into_iter().zip(0..).flat_map(|(leg, id)| {
            let down = |z: f32| ray([leg / 4.0, leg / 4.0, z], [0.0, 0.0, -1.0]);
            // Down to z = ¾ of a leg. From 1 away all of them are at one t, as far as 32 bits tell.
            [down(4.0 * leg).hits(id, 3.25 * f64::from(leg), Ulps(16.0)), down(1.0).hits(0, 1.0, Ulps(16.0))]
        });
        rays.collect()
    },
};

/// The same without a companion: the scene itself is as small.
const UNDERFLOW_ALONE: Case = Case {
    number: 22,
    name: "underflow, alone",
    shapes: || vec![corner(1e-12)],
    rays: || {
        let down = |z: f32| ray([2.5e-13, 2.5e-13, z], [0.0, 0.0, -1.0]);
        let near = [1e-13_f32, 1e-12, 1e-6, 1.0, 1e6];
        let hits = near.map(|z| down(z).hits(0, f64::from(z), Ulps(4.0)));
        hits.into_iter().chain([ray([6e-13, 6e-13, 1.0], [0.0, 0.0, -1.0]).misses()]).collect()
    },
};

const HUGE_TRIANGLES: Case = Case {
    number: 24,
    name: "huge extents, of triangles",
    shapes: || Made::Triangles.shapes(&cube_faces(1, huge)),
    rays: rays_at_huge_box,
};

const HUGE_POLYGONS: Case = Case {
    number: 24,
    name: "huge extents, of polygons",
    shapes: || Made::Polygons.shapes(&cube_faces(1, huge)),
    rays: rays_at_huge_box,
};

/// ±5.89·10¹¹ in x and y, from 0 to 1.2·10⁵ in z.
fn huge(point: DVec3) -> DVec3 {
    DVec3::new(5.890_75e11 * point.x, 5.890_75e11 * point.y, 6e4 * (point.z + 1.0))
}

/// From 500 above the top. All of its corners are at one height, so t has no other rounding than that of 1 / d_z.
fn rays_at_huge_box() -> Vec<Aimed> {
    let down = |x: f32, y: f32, [dx, dy]: [f32; 2]| ray([x, y, 120_500.0], [dx, dy, -1.0]);
    let mut rays = Vec::new();
    for (x, y) in [(0.0, 0.0), (17.0, -3.5), (1e6, 2e9), (-5.8e11, 5.8e11), (3e11, 3e11)] {
        for slope in [[0.0, 0.0], [0.3, 0.2], [-0.9, 0.95]] {
            rays.push(down(x, y, slope).hits_something_at(500.0, Ulps(2.0)));
        }
        // Fast along x: 5·10⁵ on, t is the mean of corners that are 10¹² apart.
        let top = [[0.0, 0.0, 1.2e5], [1.0, 0.0, 1.2e5], [0.0, 1.0, 1.2e5]];
        let aslant = ray([x, y, 120_500.0], [1.0, 0.0, -1e-3]);
        let t = plane_t(&aslant, top);
        rays.push(aslant.hits_something_at(t, Roundings(6.0)));
    }
    rays
}
