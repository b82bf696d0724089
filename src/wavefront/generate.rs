//! Primary rays from samples.

use super::column::round_vector;
use super::queue::RayQueue;
use super::tiles::Sample;
use crate::film::SamplePattern;
use crate::lanes::{Double, Vector};
use crate::prepare::View;
use crate::traverse::LaneUse;

/// Makes a ray of each sample. In f64, so that a ray is off by one rounding and not by several.
pub(super) fn generate<D: Double>(
    view: &View,
    pattern: &SamplePattern,
    samples: &[Sample],
    rays: &mut RayQueue,
    lanes: &mut LaneUse,
) {
    rays.clear();
    rays.set_len(samples.len());
    let basis = [view.u, view.v, view.w].map(|axis| Vector::<D>::splat(axis.to_array()));
    let [u, v, w] = basis;
    let eye = Vector::splat(view.eye.to_array());
    let one = D::splat(1.0);
    let last_row = view.pixels[1] - 1.0;
    for (first, chunk) in (0..).step_by(D::WIDTH).zip(samples.chunks(D::WIDTH)) {
        lanes.add(D::WIDTH, chunk.len());
        let mut points = [[0.0; 8]; 2];
        for (lane, sample) in chunk.iter().enumerate() {
            let [xi, eta] = pattern.position(sample.x, sample.y, sample.s);
            points[0][lane] = f64::from(sample.x) + xi;
            points[1][lane] = (last_row - f64::from(sample.y)) + eta;
        }
        let [x, y] = [0, 1].map(|axis| {
            D::splat(view.low[axis])
                + D::splat(view.extent[axis]) * D::load(&points[axis]) / D::splat(view.pixels[axis])
        });
        let offset = u * x + v * y;
        let (origin, direction) = match view.distance {
            Some(distance) => (eye, (offset - w * D::splat(distance)).normalized(one)),
            None => (eye + offset, -w),
        };
        round_vector(origin, &mut rays.origin, first);
        round_vector(direction, &mut rays.direction, first);
    }
}
