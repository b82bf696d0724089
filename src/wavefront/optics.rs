//! Mirror and refraction directions, and the shares of light that take them, in lanes.

use crate::lanes::{Double, Vector};

/// d − 2(d·n)n; of either side's normal. Each component is off by at most 11·2⁻⁵³, for unit vectors.
#[inline(always)]
pub(super) fn mirrored<D: Double>(direction: Vector<D>, normal: Vector<D>) -> Vector<D> {
    let twice = direction.dot(normal) * D::splat(2.0);
    direction - normal * twice
}

/// How light meets the boundary between two media.
pub(super) struct Boundary<D: Double> {
    /// Index of refraction of the side the ray comes from, over that of the other.
    ratio: D,
    pub(super) cos_incident: D,
    /// 0 under total internal reflection.
    pub(super) cos_refracted: D,
    pub(super) is_total: D::Mask,
}

impl<D: Double> Boundary<D> {
    /// `normal` is on the side the ray comes from; `ior` is that of the inside relative to the outside.
    #[inline(always)]
    pub(super) fn new(direction: Vector<D>, normal: Vector<D>, ior: D, entering: D::Mask) -> Self {
        let (zero, one) = (D::splat(0.0), D::splat(1.0));
        let ratio = D::select(entering, one / ior, ior);
        let cos_incident = (-direction.dot(normal)).max(zero).min(one);
        // Snell's law: sin θ' = ratio · sin θ.
        let cos_squared = one - ratio * ratio * (one - cos_incident * cos_incident);
        let cos_refracted = cos_squared.max(zero).sqrt();
        Self { ratio, cos_incident, cos_refracted, is_total: cos_squared.le(zero) }
    }

    /// The refracted direction, unit to 4·2⁻⁵³; means nothing under total internal reflection. Along the surface it is off by
    /// 24·2⁻⁵³ of the larger of 1 and the ratio; how steep it is, near the critical angle, by what the rounding of
    /// the cosine's square makes of the cosine, at most 2⁻²⁵ of that.
    #[inline(always)]
    pub(super) fn refracted(&self, direction: Vector<D>, normal: Vector<D>) -> Vector<D> {
        let along_surface = (direction + normal * self.cos_incident) * self.ratio;
        (along_surface - normal * self.cos_refracted).normalized(D::splat(1.0))
    }

    /// Schlick, "An Inexpensive BRDF Model for Physically-Based Rendering", 1994. The cosine is that on the rarer side,
    /// which makes the reflectance reach 1 where total internal reflection begins. Off by at most 16·2⁻⁵³, and by 5(1 − c)⁴ times
    /// what the cosine c is off.
    #[inline(always)]
    pub(super) fn reflectance(&self, ior: D, entering: D::Mask) -> D {
        let one = D::splat(1.0);
        let outer_is_rarer = ior.ge(one);
        let comes_from_rarer = (entering & outer_is_rarer) | (!entering & !outer_is_rarer);
        let cos_rarer = D::select(comes_from_rarer, self.cos_incident, self.cos_refracted);
        let root = (ior - one) / (ior + one);
        let r0 = root * root;
        let x = one - cos_rarer;
        let x_squared = x * x;
        let reflectance = r0 + (one - r0) * (x_squared * x_squared * x);
        D::select(self.is_total, one, reflectance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::boundary_cases::{self, Answer, CASES, Case, U};
    use crate::lanes::{Job, Lanes, Mask, Single, Width};
    use glam::DVec3;

    /// A ray, a normal on its side, an index, and whether the ray enters.
    type Question = (DVec3, DVec3, f32, bool);

    /// Questions in lanes, as many at once as there are lanes.
    struct Ask<'a>(&'a [Question]);

    impl Job for Ask<'_> {
        type Output = Vec<Answer>;

        fn run<F: Single>(self) -> Vec<Answer> {
            self.0.chunks(F::Double::WIDTH).flat_map(in_lanes::<F::Double>).collect()
        }
    }

    fn in_lanes<D: Double>(questions: &[Question]) -> Vec<Answer> {
        let column = |value: &dyn Fn(&Question) -> f64| {
            let mut column = [0.0; 8];
            for (lane, question) in column.iter_mut().zip(questions) {
                *lane = value(question);
            }
            D::load(&column)
        };
        let [dx, dy, dz] = [0, 1, 2].map(|axis| column(&|question| question.0[axis]));
        let [nx, ny, nz] = [0, 1, 2].map(|axis| column(&|question| question.1[axis]));
        let ior = column(&|question| f64::from(question.2));
        let entering = column(&|question| f64::from(u8::from(question.3))).gt(D::splat(0.0));
        let (direction, normal) = (Vector::new(dx, dy, dz), Vector::new(nx, ny, nz));
        let boundary = Boundary::new(direction, normal, ior, entering);
        let reflectance = boundary.reflectance(ior, entering);
        let refracted = boundary.refracted(direction, normal);
        let lanes = [
            boundary.cos_incident,
            boundary.cos_refracted,
            reflectance,
            refracted.x,
            refracted.y,
            refracted.z,
        ];
        let lanes = lanes.map(|lanes| {
            let mut column = [0.0; 8];
            lanes.store(&mut column);
            column
        });
        let total = boundary.is_total.bits();
        let answer = |lane: usize| {
            let [cos_incident, cos_refracted, reflectance, x, y, z] = lanes.map(|column| column[lane]);
            let is_total = total >> lane & 1 == 1;
            assert!(!is_total || cos_refracted == 0.0, "{cos_refracted} under total internal reflection");
            Answer {
                cos_incident,
                shares: [reflectance, 1.0 - reflectance],
                refracted: (!is_total).then_some((cos_refracted, DVec3::new(x, y, z))),
            }
        };
        (0..questions.len()).map(answer).collect()
    }

    #[test]
    fn cases_43_to_45_are_as_decimals_of_sixty_digits_have_them() {
        let question = |case: &Case| (case.direction(), DVec3::Z, case.ior, case.entering);
        let questions: Vec<Question> = CASES.iter().map(question).collect();
        for width in Width::ALL {
            for (case, answer) in CASES.iter().zip(width.run(Ask(&questions))) {
                case.check(&answer);
            }
        }
    }

    /// R never falls towards the critical angle, and reaches 1 as (1 − c)⁵ does: 1 − R ≤ 5c.
    #[test]
    fn case_43_the_neighbours_of_the_critical_angle() {
        let around = boundary_cases::around_critical();
        let question =
            |&(cos, _): &(f64, f64)| (DVec3::new((1.0 - cos * cos).sqrt(), 0.0, -cos), DVec3::Z, 1.5, false);
        let questions: Vec<Question> = around.iter().map(question).collect();
        for width in Width::ALL {
            let mut last = 1.0;
            for ((cos, k), found) in around.iter().zip(width.run(Ask(&questions))) {
                let cos_refracted = found.refracted.map_or(0.0, |(cos, _)| cos);
                assert!((cos_refracted * cos_refracted - k.max(0.0)).abs() <= 8.0 * U, "{cos}: {found:?}");
                assert!(k.abs() <= 8.0 * U || found.refracted.is_some() == (*k > 0.0), "{cos}: {found:?}");
                let reflectance = found.shares[0];
                assert!(1.0 - reflectance <= 5.0 * cos_refracted && reflectance <= last, "{cos}: {found:?}");
                last = reflectance;
            }
            assert!(last < 1.0);
        }
    }

    #[test]
    fn case_42_a_cosine_above_1() {
        let normal = boundary_cases::too_long_a_normal();
        for width in Width::ALL {
            for found in width.run(Ask(&[(-normal, normal, 1.5, true), (-normal, normal, 1.5, false)])) {
                assert_eq!(found.cos_incident, 1.0);
                // R0 = (0.5/2.5)².
                assert!((found.shares[0] - 0.04).abs() <= 2.0 * 0.04 * f64::EPSILON, "{found:?}");
                assert!(found.refracted.is_some_and(|(cos, _)| cos == 1.0), "{found:?}");
            }
            // And one below 0, where rounding has turned a normal away.
            let below = (DVec3::new(1.0, 0.0, 1e-9), DVec3::Z, 1.5, true);
            assert_eq!(width.run(Ask(&[below]))[0].cos_incident, 0.0);
        }
    }
}

#[cfg(test)]
mod bounds {
    use super::super::twofold::Twofold;
    use super::*;
    use glam::DVec3;
    use proptest::prelude::*;

    /// 2⁻⁵³.
    const U: f64 = f64::EPSILON / 2.0;

    /// A unit vector as f32 has it.
    fn unit() -> impl Strategy<Value = DVec3> {
        [-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64]
            .prop_map(|vector| DVec3::from(vector).normalize_or(DVec3::X).as_vec3().as_dvec3())
    }

    /// A direction and a normal that faces it, from head-on to grazing; as f32 has them.
    fn falling() -> impl Strategy<Value = [DVec3; 2]> {
        (unit(), unit(), prop_oneof![2 => 0.0..1.0f64, 1 => (-40.0..0.0f64).prop_map(f64::exp2)]).prop_map(
            |(normal, side, cosine)| {
                let along = side.reject_from(normal).normalize_or(normal.any_orthonormal_vector());
                let direction = (1.0 - cosine * cosine).max(0.0).sqrt() * along - cosine * normal;
                [direction.as_vec3().as_dvec3(), normal]
            },
        )
    }

    fn lanes(vector: DVec3) -> Vector<f64> {
        Vector::splat(vector.to_array())
    }

    fn dvec3(Vector { x, y, z }: Vector<f64>) -> DVec3 {
        DVec3::new(x, y, z)
    }

    fn dot(a: DVec3, b: DVec3) -> Twofold {
        (0..3).fold(Twofold::from(0.0), |sum, axis| sum + Twofold::from(a[axis]) * Twofold::from(b[axis]))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[test]
        fn mirrored_directions_are_within_their_bound([direction, normal] in falling()) {
            let found = dvec3(mirrored(lanes(direction), lanes(normal))).to_array();
            let cosine = dot(direction, normal);
            for (axis, found) in found.into_iter().enumerate() {
                let twice = cosine * Twofold::from(2.0) * Twofold::from(normal[axis]);
                let off = (Twofold::from(direction[axis]) - twice - Twofold::from(found)).0.abs();
                prop_assert!(off <= 11.0 * U, "off by {} of 2^-53", off / U);
            }
        }

        /// Snell's law says of the parts along the surface that one is a multiple of the other.
        #[test]
        fn refracted_directions_obey_snell_within_their_bound(
            [direction, normal] in falling(),
            ior in 0.25..4.0f32,
            entering in any::<bool>(),
        ) {
            let ior = f64::from(ior);
            // What enters has been turned to this side: of unit vectors, so that the law holds for what is tested.
            let (direction, normal) = (direction.normalize(), normal.normalize());
            if direction.dot(normal) >= 0.0 {
                return Ok(()); // what is grazing may be turned away by rounding, and is given another normal
            }
            let boundary = Boundary::new(lanes(direction), lanes(normal), ior, entering);
            let ratio = if entering { 1.0 / ior } else { ior };
            let sine = ratio * direction.cross(normal).length();
            if (sine - 1.0).abs() > 1e-12 {
                prop_assert_eq!(boundary.is_total, sine > 1.0);
            }
            if !boundary.is_total {
                let found = dvec3(boundary.refracted(lanes(direction), lanes(normal)));
                prop_assert!((found.length() - 1.0).abs() <= 4.0 * U);
                prop_assert!(found.dot(normal) <= 0.0);
                // Within 2⁻²⁵ of the critical angle the steep part is rounding, and normalising spreads it.
                if (1.0 - sine * sine) > 1e-6 {
                    let off = (found.cross(normal) - ratio * direction.cross(normal)).length();
                    prop_assert!(off <= 24.0 * U * ratio.max(1.0), "off by {} of 2^-53", off / U);
                }
            }
        }

        #[test]
        fn reflectances_are_within_their_bound(cosine in 0.0..=1.0f64, ior in 1.0..4.0f32) {
            let boundary = Boundary { ratio: 1.0, cos_incident: cosine, cos_refracted: cosine, is_total: false };
            let found = boundary.reflectance(f64::from(ior), true);
            let one = Twofold::from(1.0);
            let ior = Twofold::from(f64::from(ior));
            // R0 = ((ior − 1)/(ior + 1))²: f64 has the sum and the difference exactly.
            let root = (ior - one).divided_by((ior + one).0);
            let (r0, x) = (root * root, one - Twofold::from(cosine));
            let expected = r0 + (one - r0) * x * x * x * x * x;
            let off = (expected - Twofold::from(found)).0.abs();
            prop_assert!(off <= 16.0 * U && (0.0..=1.0).contains(&found), "off by {} of 2^-53", off / U);
        }
    }
}
