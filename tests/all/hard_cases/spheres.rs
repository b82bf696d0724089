//! Spheres: cases 1 to 12 but for 6, which is one of secondary rays.
//!
//! Unless a row says otherwise: t = (−b ∓ √(b² − a·c)) / a in sixty decimal digits, a = d·d, b = (o − c)·d, c = |o − c|² − r².

use super::case::{Aimed, Case, Shape, Within, ray};
use super::run::refused;
use Shape::Sphere;
use Within::{Roundings, Ulps};

hard_cases! {
    case_1_far_sphere: FAR_SPHERE,
    case_2_tangent: TANGENT,
    case_3_giant_ground: GIANT_GROUND,
    case_4_giant_ground_close: GIANT_GROUND_CLOSE,
    case_5_grazing_chord_from_the_surface: GRAZING_CHORD,
    case_5_grazing_chord_of_a_ray_from_nowhere: GRAZING_CHORD_FROM_NOWHERE,
    case_7_directions_of_any_length: ANY_LENGTH,
    case_8_largest_coordinates: LARGEST,
    case_9_tiny_sphere: TINY,
    case_10_bounds_of_a_sphere: BOUNDS,
    case_11_far_coordinates: FAR_COORDINATES,
    case_12_concentric_shells: SHELLS,
    case_12_concentric_shells_from_between: BETWEEN_SHELLS,
}

/// Of a unit sphere at the origin.
fn unit_sphere() -> Vec<Shape> {
    vec![Sphere([0.0; 3], 1.0)]
}

/// √(1 − ½²), half the chord at half the radius off the axis.
const HALF_CHORD: f64 = 0.866_025_403_784_438_6;

const FAR_SPHERE: Case = Case {
    number: 1,
    name: "far sphere",
    shapes: unit_sphere,
    rays: || {
        let far = |distance: f32| {
            let towards = ray([0.0, 0.5, -distance], [0.0, 0.0, 1.0]);
            let t = |side: f64| f64::from(distance) + side * HALF_CHORD;
            // From the middle of the chord on there is its far end.
            [towards.clone().hits(0, t(-1.0), Ulps(2.0)), towards.beyond(distance).hits(0, t(1.0), Ulps(2.0))]
        };
        [100.0, 1e3, 2e3, 3e3, 4099.0, 4100.0, 8e3, 65536.0, 1e6].into_iter().flat_map(far).collect()
    },
};

const TANGENT: Case = Case {
    number: 2,
    name: "tangent ± 1 ulp",
    shapes: unit_sphere,
    rays: || {
        let at_height = |y: f32| ray([0.0, y, -4.0], [0.0, 0.0, 1.0]);
        let (above, below) = (1.0_f32.next_up(), 1.0_f32.next_down());
        vec![
            at_height(1.0).hits(0, 4.0, Ulps(0.0)),
            at_height(-1.0).hits(0, 4.0, Ulps(0.0)),
            at_height(above).misses(),
            at_height(-above).misses(),
            at_height(below).hits(0, 3.999_654_733_022_143_5, Ulps(2.0)),
            at_height(below).beyond(4.0).hits(0, 4.000_345_266_977_856, Ulps(2.0)),
        ]
    },
};

/// A ball of 10⁶ whose top is the origin.
fn ground() -> Vec<Shape> {
    vec![Sphere([0.0, -1e6, 0.0], 1e6)]
}

const GIANT_GROUND: Case = Case {
    number: 3,
    name: "giant ground",
    shapes: ground,
    rays: || {
        let down = ray([0.0, 1.0, -5.0], [0.0, -0.6, 0.8]);
        vec![down.hits(0, 1.666_677_804_087_973_7, Ulps(4.0))]
    },
};

const GIANT_GROUND_CLOSE: Case = Case {
    number: 4,
    name: "giant ground, close",
    shapes: ground,
    rays: || {
        let down = ray([0.3, 1e-3, -5.0], [0.0, -0.6, 0.8]);
        vec![down.hits(0, 0.001_687_563_763_204_360_4, Ulps(4.0))]
    },
};

/// The chord that begins on the sphere: one root is 0, and the other −2·(o·d) / (d·d) in fractions.
const GRAZING_T: f64 = 1.999_999_929_475_752e-4;

fn grazing() -> Aimed {
    ray([0.0, 0.0, 1.0], [1.0, 0.0, -1e-4])
}

const GRAZING_CHORD: Case = Case {
    number: 5,
    name: "grazing chord from the surface",
    shapes: unit_sphere,
    rays: || {
        vec![grazing().leaving(0, true).hits(0, GRAZING_T, Ulps(4.0)), grazing().leaving(0, false).misses()]
    },
};

/// The same ray without word of where it starts: that its first root is 0 has to come out of the numbers.
const GRAZING_CHORD_FROM_NOWHERE: Case = Case {
    number: 5,
    name: "grazing chord from the surface, of a ray that starts on nothing",
    shapes: unit_sphere,
    rays: || vec![grazing().hits(0, GRAZING_T, Ulps(4.0))],
};

const ANY_LENGTH: Case = Case {
    number: 7,
    name: "directions of any length",
    shapes: unit_sphere,
    rays: || {
        let along = |z: f32| ray([0.0, 0.5, -4100.0], [0.0, 0.0, z]);
        // (4100 − √¾) over the f32 nearest to each length.
        let hits = [
            (1e3, 4.099_133_974_596_215),
            (1e-20, 4.099_134_104_680_094_5e23),
            (1.0 / (1_u64 << 50) as f32, 4.615_214_560_133_315e18),
            ((1_u64 << 50) as f32, 3.640_762_335_695_96e-12),
            (1e30, 4.099_133_912_914_636e-27),
            (1e38, 4.099_134_105_651_397_7e-35),
        ];
        // Beyond what f32 can hold a hit stays a hit, at the largest number.
        let beyond = [1e-38, 1e-40, f32::from_bits(1)];
        let most = f64::from(f32::MAX);
        let hits = hits.into_iter().map(|(length, t)| along(length).hits(0, t, Ulps(2.0)));
        hits.chain(beyond.map(|length| along(length).hits(0, most, Ulps(0.0)))).collect()
    },
};

const LARGEST: Case = Case {
    number: 8,
    name: "overflow: at the largest coordinates that are accepted",
    shapes: || vec![Sphere([0.0; 3], 5e17)],
    rays: || {
        vec![
            ray([0.0, 0.0, -1e18], [0.0, 0.0, 1.0]).hits(0, 4.999_999_921_533_747e17, Ulps(2.0)),
            ray([3e17, 0.0, -1e18], [0.0, 0.0, 1.0]).hits(0, 5.999_999_905_840_497e17, Ulps(2.0)),
            ray([6e17, 0.0, -1e18], [0.0, 0.0, 1.0]).misses(),
            // Farther out is no ray.
            ray([0.0, 0.0, -3e19], [0.0, 0.0, 1.0]).misses(),
            ray([0.0, 0.0, f32::MAX], [0.0, 0.0, -1.0]).misses(),
        ]
    },
};

#[test]
fn case_8_overflow_is_refused() {
    let most = "a number must be at most 1e18 in magnitude; this one is";
    refused("[[sphere]]\ncenter = [0, 0, 0]\nradius = 1e19\nmaterial = \"m\"\n", &format!("{most} 1e19"));
    refused("[[sphere]]\ncenter = [0, 0, -3e19]\nradius = 1\nmaterial = \"m\"\n", &format!("{most} -3e19"));
    refused("[[sphere]]\ncenter = [0, 0, 0]\nradius = 1e39\nmaterial = \"m\"\n", &format!("{most} 1e39"));
}

const TINY: Case = Case {
    number: 9,
    name: "tiny sphere",
    // Beside one of 1, which sets the scale of the scene.
    shapes: || vec![Sphere([0.0; 3], 1e-5), Sphere([5.0, 0.0, 0.0], 1.0)],
    rays: || {
        let at = |x: f32| ray([x, 0.0, -1.0], [0.0, 0.0, 1.0]);
        vec![
            at(0.0).hits(0, 0.999_990_000_000_252_6, Ulps(2.0)),
            at(5e-6).hits(0, 0.999_991_339_746_180_9, Ulps(2.0)),
            at(1.001e-5).misses(),
        ]
    },
};

const BOUNDS: Case = Case {
    number: 10,
    name: "bounds of a sphere",
    // The one of 0.2, many times, so that it is in other leaves than the one of 0.4 that is nearer.
    shapes: || {
        let small = std::iter::repeat_n(Sphere([8_388_608.0, 0.0, 0.0], 0.2), 20);
        let others = (1..20_u8).map(|step| Sphere([8_388_608.0 - f32::from(step) * 9.0, 3.0, 0.0], 0.5));
        small.chain([Sphere([8_388_608.0, 0.0, 0.0], 0.4)]).chain(others).collect()
    },
    rays: || {
        let back = ray([8_388_700.0, 0.0, 0.0], [-1.0, 0.0, 0.0]);
        vec![
            back.clone().hits(20, 91.599_999_994_039_54, Ulps(2.0)),
            back.clone().beyond(91.7).hits(0, 91.799_999_997_019_77, Ulps(2.0)),
            // Both centres' box ends at 8388609 after rounding, but no sphere reaches so far.
            ray([8_388_700.0, 0.45, 0.0], [-1.0, 0.0, 0.0]).misses(),
        ]
    },
};

/// |δl| ≤ 6u·|o − c|: within 6u·10⁴ = 3.6·10⁻³ of the limb a unit sphere 10⁴ away may be hit or missed.
const FAR_COORDINATES: Case = Case {
    number: 11,
    name: "far coordinates",
    shapes: || vec![Sphere([800_000.0, 0.0, 0.0], 1.0), Sphere([0.0, 0.0, 1e4], 1.0)],
    rays: || {
        let along_x = |y: f32| ray([796_800.0, y, 0.0], [1.0, 0.0, 0.0]);
        let along_z = |x: f32| ray([x, 0.0, 0.0], [0.0, 0.0, 1.0]);
        let aslant = |x: f32| ray([0.0; 3], [x, 0.0, 1.0]);
        let near = [
            (along_x(0.0), 3199.0),
            (along_x(0.5), 3_199.133_974_596_215_5),
            (along_x(0.9), 3_199.564_110_056_418_5),
            (along_x(0.99), 3_199.858_932_707_131_3),
            (along_x(0.998), 3_199.936_786_484_003_7),
        ];
        let far = [
            (along_z(0.85), 9_999.473_217_350_827),
            (along_z(0.9), 9_999.564_110_056_419),
            (along_z(0.95), 9_999.687_750_063_811),
            (along_z(0.99), 9_999.858_932_707_131),
            (along_z(0.996), 9_999.910_646_678_027),
            (aslant(8.5e-5), 9_999.473_145_054_01),
            (aslant(9.5e-5), 9_999.687_659_931_451),
            (aslant(9.9e-5), 9_999.858_834_395_807),
            (aslant(9.96e-5), 9_999.910_547_702_095),
        ];
        let near = near.into_iter().map(|(ray, t)| ray.hits(0, t, Roundings(6.0)));
        let far = far.into_iter().map(|(ray, t)| ray.hits(1, t, Roundings(6.0)));
        let misses = [along_x(1.002), along_z(1.004), aslant(1.004e-4)].map(Aimed::misses);
        near.chain(far).chain(misses).collect()
    },
};

/// A shell of 1 and one 4.0054·10⁻⁵ farther out, the f32 nearest to 1 + 4·10⁻⁵: 336 ulp.
fn shells() -> Vec<Shape> {
    vec![Sphere([0.0; 3], 1.0), Sphere([0.0; 3], 1.0 + 4e-5)]
}

const SHELLS: Case = Case {
    number: 12,
    name: "concentric shells",
    shapes: shells,
    rays: || {
        let (straight, aslant) =
            (ray([0.0, 0.0, -3.0], [0.0, 0.0, 1.0]), ray([0.3, -0.2, -3.0], [-0.05, 0.1, 1.0]));
        vec![
            straight.clone().hits(1, 1.999_959_945_678_711, Ulps(2.0)),
            straight.clone().beyond(1.99997).hits(0, 2.0, Ulps(2.0)),
            straight.clone().beyond(2.5).hits(0, 4.0, Ulps(2.0)),
            straight.beyond(4.00001).hits(1, 4.000_040_054_321_289, Ulps(2.0)),
            aslant.clone().hits(1, 2.019_962_058_780_654_6, Ulps(2.0)),
            aslant.clone().beyond(2.01998).hits(0, 2.020_002_527_987_936, Ulps(2.0)),
            aslant.clone().beyond(3.0).hits(0, 3.975_059_200_997_630_4, Ulps(2.0)),
            aslant.beyond(3.97507).hits(1, 3.975_099_670_204_911_7, Ulps(2.0)),
        ]
    },
};

/// From the poles, where coordinates are exact: the gap is r₁ − 1 to the bit.
const BETWEEN_SHELLS: Case = Case {
    number: 12,
    name: "concentric shells, from one to the other",
    shapes: shells,
    rays: || {
        let outer = 1.0_f32 + 4e-5;
        let gap = f64::from(outer) - 1.0;
        let up = |z: f32| ray([0.0, 0.0, z], [0.0, 0.0, 1.0]);
        vec![
            up(-outer).leaving(1, true).hits(0, gap, Ulps(2.0)),
            up(1.0).leaving(0, false).hits(1, gap, Ulps(2.0)),
            up(-1.0).leaving(0, true).hits(0, 2.0, Ulps(2.0)),
            up(outer).leaving(1, false).misses(),
        ]
    },
};
