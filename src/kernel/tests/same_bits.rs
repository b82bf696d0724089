//! A pair of ray and primitive has the same answer in any lane, beside any other pair.

use super::sight::{self, Sight};
use super::{aimed, point, positive, single, start, vector};
use crate::kernel::polygon::{self, Outline};
use crate::kernel::{bounds, sphere, triangle};
use crate::lanes::{Job, Mask, Single, Vector, Width};
use proptest::prelude::*;

const MOST: usize = 16;

/// Three points near each other make a primitive of each kind.
#[derive(Clone, Copy, Debug)]
struct Pair {
    ray: Sight,
    points: [[f32; 3]; 3],
    radius: f32,
    t_max: f32,
}

/// What the kernels say of sixteen pairs, a row a number; one NaN is like any other.
struct Answers<'a>(&'a [Pair]);

impl Job for Answers<'_> {
    type Output = Vec<(&'static str, [u32; MOST])>;

    fn run<F: Single>(self) -> Self::Output {
        let mut rows: Self::Output = Vec::new();
        for (chunk, pairs) in self.0.chunks(F::WIDTH).enumerate() {
            let answers = answers::<F>(pairs);
            if chunk == 0 {
                rows = answers.iter().map(|(what, _)| (*what, [0; MOST])).collect();
            }
            for ((_, row), (_, bits)) in rows.iter_mut().zip(answers) {
                row[chunk * F::WIDTH..][..F::WIDTH].copy_from_slice(&bits[..F::WIDTH]);
            }
        }
        rows
    }
}

fn answers<F: Single>(pairs: &[Pair]) -> Vec<(&'static str, [u32; MOST])> {
    let number = |lanes: F| {
        let mut row = [0.0; MOST];
        lanes.store(&mut row);
        row.map(|number| if number.is_nan() { f32::NAN.to_bits() } else { number.to_bits() })
    };
    let truth = |mask: F::Mask| -> [u32; MOST] { std::array::from_fn(|lane| mask.bits() >> lane & 1) };
    let zero = F::splat(0.0);
    let rays: Vec<Sight> = pairs.iter().map(|pair| pair.ray).collect();
    let (space, line) = (sight::space::<F>(&rays), sight::line::<F>(&rays));
    let axes = rays[0].axes();
    let points: [Vector<F>; 3] = [0, 1, 2].map(|at| sight::vectors(pairs, |pair| pair.points[at]));
    let turned = points.map(|Vector { x, y, z }| axes.map(|axis| [x, y, z][axis]));

    let mut answers = Vec::new();
    let triangle = triangle::meet(&space, turned);
    answers.push(("triangle t", number(triangle.t(&space))));
    answers.push(("triangle inside", truth(triangle.inside(zero))));
    answers.push(("triangle volume", number(triangle.volume)));

    let radius: F = sight::lanes(pairs, |pair| pair.radius);
    let sphere = sphere::meet(&line, points[0], radius * radius, zero);
    answers.push(("sphere closest t", number(sphere.closest_t)));
    answers.push(("sphere half t", number(sphere.half_t)));
    answers.push(("sphere meets", truth(sphere.meets)));
    answers.push(("sphere far side", number(sphere.far_side())));
    let (t, hit) = sphere.nearest(zero);
    answers.push(("sphere nearest t", number(t)));
    answers.push(("sphere nearest hit", truth(hit)));
    answers.push(("sphere touches", truth(sphere.touches(&line, radius))));

    let mut outline = Outline::<F>::new();
    let seen = turned.map(|point| space.see(point));
    for edge in 0..3 {
        outline.add_edge(&seen[edge], &seen[(edge + 1) % 3], zero);
    }
    let corner_ts = [outline.least_z * space.t_per_z, outline.largest_z * space.t_per_z];
    let plane = [points[0], points[1].cross(points[2])];
    let meeting = polygon::meet_plane(&line, plane, corner_ts, zero);
    answers.push(("polygon odd", truth(outline.odd)));
    answers.push(("polygon least z", number(outline.least_z)));
    answers.push(("polygon largest z", number(outline.largest_z)));
    answers.push(("polygon t", number(meeting.t)));
    answers.push(("polygon meets", truth(meeting.meets)));
    answers.push(("polygon height", number(meeting.height)));

    let boxes: Vec<[[f32; 3]; 2]> = pairs
        .iter()
        .map(|Pair { points: [a, b, c], .. }| {
            let fold =
                |which: fn(f32, f32) -> f32| [0, 1, 2].map(|axis| which(which(a[axis], b[axis]), c[axis]));
            [fold(f32::min), fold(f32::max)]
        })
        .collect();
    let [near, far] = sight::planes(&rays, &boxes);
    let t_max = sight::lanes(pairs, |pair| pair.t_max);
    let (enter, meets) = bounds::enter(&sight::slabs(&rays, 2.0), near, far, zero, t_max);
    answers.push(("box enter", number(enter)));
    answers.push(("box meets", truth(meets)));
    answers
}

fn pair() -> impl Strategy<Value = Pair> {
    let size = positive(-20.0..1.0);
    let shape = (point(), size, [vector(-1.0..1.0), vector(-1.0..1.0), vector(-1.0..1.0)]);
    let t_max = prop_oneof![2 => Just(f32::INFINITY), 1 => 0.0..4.0_f32, 1 => Just(-1.0)];
    (shape, t_max, -0.5..1.5).prop_flat_map(|((center, size, offsets), t_max, share)| {
        let corners = offsets.map(|offset| center + offset * size);
        let target = corners[0].lerp(corners[1], share);
        let ray = start(center).prop_flat_map(move |from| aimed(from, target));
        ray.prop_map(move |ray| Pair {
            ray,
            points: corners.map(|corner| corner.as_vec3().to_array()),
            radius: single(size),
            t_max,
        })
    })
}

/// The same ray with its components in the order of another's, so that both can be in one vector.
fn along(ray: Sight, third: usize) -> Sight {
    let by = (ray.third() + 3 - third) % 3;
    let turn = |vector: [f32; 3]| [0, 1, 2].map(|axis| vector[(axis + by) % 3]);
    // Of equal components the first counts, which may be another one now.
    let turned = Sight { origin: turn(ray.origin), direction: turn(ray.direction) };
    if turned.third() == third { turned } else { Sight { origin: ray.origin, direction: unit(third) } }
}

fn unit(axis: usize) -> [f32; 3] {
    let mut direction = [0.0; 3];
    direction[axis] = -1.0;
    direction
}

fn assert_same_at_every_width(pairs: &[Pair]) -> Result<(), TestCaseError> {
    let expected = Width::One.run(Answers(pairs));
    for width in Width::ALL {
        let found = width.run(Answers(pairs));
        for ((what, expected), (_, found)) in expected.iter().zip(found) {
            prop_assert_eq!(*expected, found, "{} at {:?}", what, width);
        }
    }
    Ok(())
}

proptest! {
    #[test]
    fn several_rays_meet_one_primitive_as_each_does_alone(
        pairs in prop::collection::vec(pair(), MOST),
    ) {
        let first = pairs[0];
        let pairs: Vec<Pair> =
            pairs.iter().map(|pair| Pair { ray: along(pair.ray, first.ray.third()), ..first }).collect();
        assert_same_at_every_width(&pairs)?;
    }

    #[test]
    fn one_ray_meets_several_primitives_as_each_alone(pairs in prop::collection::vec(pair(), MOST)) {
        let ray = pairs[0].ray;
        let pairs: Vec<Pair> = pairs.iter().map(|pair| Pair { ray, ..*pair }).collect();
        assert_same_at_every_width(&pairs)?;
    }
}
