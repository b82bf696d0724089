//! Hard cases of light at the boundary between two media, for the tests of both engines: what the formulas give for numbers
//! that f32 holds, computed apart from both in decimals of sixty digits and rounded once.
//!
//! With η the index of refraction of the side the ray comes from over that of the other and c the cosine of incidence,
//! k = 1 − η²(1 − c²) is the square of the refracted cosine, or not positive under total internal reflection. Schlick's
//! reflectance is R0 + (1 − R0)(1 − c')⁵, c' being c or √k, whichever is on the rarer side. u is 2⁻⁵³.

use glam::DVec3;

/// Rounding of f64.
pub(crate) const U: f64 = f64::EPSILON / 2.0;

/// A ray (√(1 − c²), 0, −c) that meets the plane z = 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Case {
    pub(crate) ior: f32,
    pub(crate) entering: bool,
    pub(crate) cos_incident: f32,
    pub(crate) cos_refracted_squared: f64,
    pub(crate) reflectance: f64,
}

/// What an engine makes of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Answer {
    pub(crate) cos_incident: f64,
    /// Shares of reflection and of refraction, of a medium that transmits all.
    pub(crate) shares: [f64; 2],
    /// Cosine and direction; none under total internal reflection.
    pub(crate) refracted: Option<(f64, DVec3)>,
}

const IN: bool = true;
const OUT: bool = false;

const fn case(
    ior: f32,
    entering: bool,
    cos_incident: f32,
    cos_refracted_squared: f64,
    reflectance: f64,
) -> Case {
    Case { ior, entering, cos_incident, cos_refracted_squared, reflectance }
}

/// 44 and 45 in the first lines of each index: from head-on to along the surface. 43 in the last four: the critical angle of
/// 1.5, two f32 to either side.
#[rustfmt::skip]
pub(crate) const CASES: &[Case] = &[
    case(0.3, IN, 1.0, 1.0, 0.289_940_813_209_558_33),
    case(0.3, IN, 0.96, 0.128_888_500_354_945_5, 0.366_774_082_098_563_3),
    case(0.3, IN, 0.5, -7.333_332_671_059_542, 1.0),
    case(0.3, IN, 1.0e-6, -10.111_110_228_068_279, 1.0),
    case(0.3, OUT, 1.0, 1.0, 0.289_940_813_209_558_33),
    case(0.3, OUT, 0.96, 0.992_943_995_731_353_5, 0.289_940_885_919_814_1),
    case(0.3, OUT, 0.5, 0.932_499_994_635_581_9, 0.312_130_162_796_759_65),
    case(0.3, OUT, 0.0001, 0.909_999_993_747_442_6, 0.999_645_041_414_388_5),
    case(0.3, OUT, 1.0e-6, 0.909_999_992_847_532_5, 0.999_996_449_711_175_6),
    case(0.3, OUT, 0.0, 0.909_999_992_847_442_5, 1.0),
    case(1.0, IN, 1.0, 1.0, 0.0),
    case(1.0, IN, 0.96, 0.921_599_958_801_27, 1.024_002_746_584_978e-7),
    case(1.0, IN, 0.5, 0.25, 0.031_25),
    case(1.0, IN, 0.0001, 9.999_999_494_757_51e-9, 0.999_500_100_002_626_5),
    case(1.0, IN, 1.0e-6, 9.999_999_949_504_854e-13, 0.999_995_000_010_012_6),
    case(1.0, IN, 0.0, 0.0, 1.0),
    case(1.5, IN, 1.0, 1.0, 0.04),
    case(1.5, IN, 0.96, 0.965_155_537_245_008_9, 0.040_000_098_304_263_675),
    case(1.5, IN, 0.5, 0.666_666_666_666_666_6, 0.07),
    case(1.5, IN, 0.0001, 0.555_555_559_999_999_7, 0.999_520_096_002_521_5),
    case(1.5, IN, 1.0e-6, 0.555_555_555_556, 0.999_995_200_009_612_1),
    case(1.5, IN, 0.0, 0.555_555_555_555_555_6, 1.0),
    case(1.5, OUT, 1.0, 1.0, 0.04),
    case(1.5, OUT, 0.96, 0.823_599_907_302_857_5, 0.040_006_492_547_912_03),
    case(1.5, OUT, 0.5, -0.6875, 1.0),
    case(1.5, OUT, 1.0e-6, -1.249_999_999_997_75, 1.0),
    case(2.4, IN, 1.0, 1.0, 0.169_550_186_598_249_86),
    case(2.4, IN, 0.96, 0.986_388_882_818_046, 0.169_550_271_636_538_85),
    case(2.4, IN, 0.5, 0.869_791_677_014_694_6, 0.195_501_743_267_054_55),
    case(2.4, IN, 0.0001, 0.826_388_904_422_370_5, 0.999_584_858_140_461_6),
    case(2.4, IN, 1.0e-6, 0.826_388_902_686_433_2, 0.999_995_847_759_248),
    case(2.4, IN, 0.0, 0.826_388_902_686_259_5, 1.0),
    case(2.4, OUT, 1.0, 1.0, 0.169_550_186_598_249_86),
    case(2.4, OUT, 0.96, 0.548_415_726_806_623_8, 0.170_526_465_082_958_16),
    case(2.4, OUT, 0.5, -3.320_000_343_322_760_7, 1.0),
    case(2.4, OUT, 1.0e-6, -4.760_000_457_757_921, 1.0),
    case(4.0, IN, 1.0, 1.0, 0.36),
    case(4.0, IN, 0.96, 0.995_099_997_425_079_4, 0.360_000_065_536_175_8),
    case(4.0, IN, 0.5, 0.953_125, 0.38),
    case(4.0, IN, 0.0001, 0.937_500_000_624_999_9, 0.999_680_064_001_681),
    case(4.0, IN, 1.0e-6, 0.937_500_000_000_062_5, 0.999_996_800_006_408_1),
    case(4.0, IN, 0.0, 0.9375, 1.0),
    case(4.0, OUT, 1.0, 1.0, 0.36),
    case(4.0, OUT, 0.5, -11.0, 1.0),
    case(4.0, OUT, 1.0e-6, -14.999_999_999_984, 1.0),
    case(1.5, OUT, 0.745_355_9, -2.964_945_613_470_604e-7, 1.0),
    case(1.5, OUT, 0.745_355_96, -9.657_452_082_478_812e-8, 1.0),
    case(1.5, OUT, 0.745_356, 1.033_455_356_846_957_3e-7, 0.998_457_916_575_792_2),
    case(1.5, OUT, 0.745_356_1, 3.032_656_081_813_911_4e-7, 0.997_359_571_022_501_5),
];

impl Case {
    /// The ray's direction, unit to rounding.
    pub(crate) fn direction(&self) -> DVec3 {
        let cos = f64::from(self.cos_incident);
        DVec3::new((1.0 - cos * cos).sqrt(), 0.0, -cos)
    }

    /// Over the index of the other side.
    fn ratio(&self) -> f64 {
        if self.entering { 1.0 / f64::from(self.ior) } else { f64::from(self.ior) }
    }

    /// 43 to 45. k is right to 4u(1 + η²), and whether the reflection is total to that; the reflectance to what it makes of
    /// the cosine; refraction follows Snell's law to 6u and keeps the direction's length to 4u; nothing is lost between the
    /// shares.
    #[track_caller]
    pub(crate) fn check(&self, answer: &Answer) {
        let ratio = self.ratio();
        let k_bound = 4.0 * U * (1.0 + ratio * ratio);
        let k = self.cos_refracted_squared;
        let at = format!("{self:?}: {answer:?}");
        assert_eq!(answer.cos_incident, f64::from(self.cos_incident), "{at}");
        assert!(answer.shares.iter().all(|share| (0.0..=1.0).contains(share)), "{at}");
        assert!((answer.shares[0] + answer.shares[1] - 1.0).abs() <= 4.0 * U, "{at}");
        let Some((cos_refracted, direction)) = answer.refracted else {
            assert!(k <= k_bound && answer.shares == [1.0, 0.0], "{at}");
            return;
        };
        assert!(k >= -k_bound && (cos_refracted * cos_refracted - k).abs() <= k_bound, "{at}");
        assert!((direction.length() - 1.0).abs() <= 4.0 * U && direction.z <= 0.0, "{at}");
        let [outer, inner] = [1.0, f64::from(self.ior)];
        let [here, there] = if self.entering { [outer, inner] } else { [inner, outer] };
        let residual = here * self.direction().cross(DVec3::Z) - there * direction.cross(DVec3::Z);
        assert!(residual.length() <= 6.0 * U * here.max(there), "Snell's residual {residual}, {at}");
        let rarer_is_here = self.entering == (self.ior >= 1.0);
        let (cos_rarer, cos_bound) = if rarer_is_here {
            (answer.cos_incident, U)
        } else {
            (cos_refracted, k_bound / (2.0 * cos_refracted))
        };
        let bound = 5.0 * (1.0 - cos_rarer).powi(4) * cos_bound + 6.0 * U;
        assert!((answer.shares[0] - self.reflectance).abs() <= bound, "{at}");
    }
}

/// 43: cosines around the critical angle of 1.5, √5/3, one f64 after another, ascending, with what rounds nothing of k:
/// 9/4·(c² − 5/9) as a difference of squares, (c − √5/3)(c + √5/3), √5/3 in two parts.
pub(crate) fn around_critical() -> Vec<(f64, f64)> {
    const ROOT_HIGH: f64 = 0.745_355_992_499_929_9;
    const ROOT_LOW: f64 = 7.933_327_962_885_121_5e-19;
    let mut cos = ROOT_HIGH;
    for _ in 0..40 {
        cos = cos.next_down();
    }
    (0..80)
        .map(|_| {
            cos = cos.next_up();
            (cos, 2.25 * ((cos - ROOT_HIGH) - ROOT_LOW) * (cos + ROOT_HIGH))
        })
        .collect()
}

/// 42: (3, 8, 18) normalised in f32 is longer than 1.
pub(crate) fn too_long_a_normal() -> DVec3 {
    let normal = glam::Vec3::new(3.0, 8.0, 18.0).normalize();
    assert!(normal.as_dvec3().length_squared() > 1.0);
    normal.as_dvec3()
}
