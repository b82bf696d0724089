//! What f32 cannot tell: which of two hits is the nearer, whether a ray that starts next to a surface meets it, and whether one
//! that leaves a surface passes an edge inside or outside.
//!
//! A kernel's t comes with a bound on its error. Hits whose t lie farther apart than their errors are in the order of
//! their t; for the others t is computed again in f64. So the nearest hit is the nearest in f64, in whatever order
//! primitives are visited. Of surfaces that coincide each rounds its own t: those that agree to 32 bits are at one t, and
//! the smallest id is seen.

use super::in_plane::{Outline, Part};
use crate::kernel::UNIT_ROUNDOFF;
use crate::prepare::{BLOCK, Hierarchy};
use glam::DVec3;

/// Where a primitive lies in the hierarchy, in a word: the kind in the 2 low bits, the lane in the next 2, the block or
/// polygon above.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Spot(pub(super) u32);

const SPHERE: u32 = 0;
const TRIANGLE: u32 = 1;
const POLYGON: u32 = 2;

const _: () = assert!(BLOCK <= 4);

#[expect(
    clippy::cast_possible_truncation,
    reason = "blocks and polygons are numbered below 2²⁸, lanes below 4"
)]
impl Spot {
    /// None.
    pub(super) const NOTHING: Self = Self(super::NOTHING);

    #[inline(always)]
    pub(super) fn sphere(block: usize, lane: usize) -> Self {
        Self((block as u32) << 4 | (lane as u32) << 2 | SPHERE)
    }

    #[inline(always)]
    pub(super) fn triangle(block: usize, lane: usize) -> Self {
        Self((block as u32) << 4 | (lane as u32) << 2 | TRIANGLE)
    }

    #[inline(always)]
    pub(super) fn polygon(index: usize) -> Self {
        Self((index as u32) << 4 | POLYGON)
    }

    /// The id of the primitive there.
    #[inline(always)]
    pub(super) fn id(self, hierarchy: &Hierarchy) -> u32 {
        if self == Self::NOTHING {
            return super::NOTHING;
        }
        let (index, lane) = self.place();
        match self.0 & 3 {
            SPHERE => hierarchy.spheres[index].ids[lane],
            TRIANGLE => hierarchy.triangles[index].ids[lane],
            _ => hierarchy.polygons[index].id,
        }
    }

    #[inline(always)]
    fn place(self) -> (usize, usize) {
        ((self.0 >> 4) as usize, (self.0 >> 2 & 3) as usize)
    }

    /// The primitive there, in f64.
    fn shape(self, hierarchy: &Hierarchy) -> Shape {
        let (index, lane) = self.place();
        let point = |columns: [f32; 3]| DVec3::from(columns.map(f64::from));
        match self.0 & 3 {
            SPHERE => {
                let block = &hierarchy.spheres[index];
                Shape::Sphere {
                    center: point(block.centers.map(|column| column[lane])),
                    radius: f64::from(block.radii[lane]),
                    id: block.ids[lane],
                }
            }
            TRIANGLE => {
                let vertices = hierarchy.triangles[index].vertices;
                Shape::Triangle(vertices.map(|vertex| point(vertex.map(|column| column[lane]))))
            }
            _ => {
                let face = &hierarchy.polygons[index];
                let run = face.first_corner as usize..(face.first_corner + face.edges) as usize;
                let corner = |corner| point([0, 1, 2].map(|axis| hierarchy.corners[axis][corner]));
                Shape::Polygon(run.map(corner).collect())
            }
        }
    }
}

/// A primitive in f64.
enum Shape {
    Sphere { center: DVec3, radius: f64, id: u32 },
    Triangle([DVec3; 3]),
    Polygon(Vec<DVec3>),
}

/// The nearest hit of a ray so far, or where hits end to be of interest.
#[derive(Clone, Copy)]
pub(super) struct Nearest {
    pub(super) t: f32,
    pub(super) error: f32,
    pub(super) spot: Spot,
}

impl Nearest {
    /// Hits are wanted before this t.
    #[inline(always)]
    pub(super) fn before(t: f32) -> Self {
        Self { t, error: 0.0, spot: Spot::NOTHING }
    }

    /// Nothing beyond this t can be nearer.
    #[inline(always)]
    pub(super) fn end(&self) -> f32 {
        self.t + self.error
    }

    /// Whether a hit takes its place; if ANY, whether it is before the end. In f64 where f32 cannot tell.
    #[inline(always)]
    pub(super) fn yields_to<const ANY: bool>(
        &self,
        hierarchy: &Hierarchy,
        line: impl FnOnce() -> Line,
        (t, error, spot): (f32, f32, Spot),
    ) -> bool {
        if ANY {
            let is_beyond = t - error >= self.t;
            t + error < self.t || (!is_beyond && line().is_before_light(hierarchy, spot, t, self.t))
        } else if t + error < self.t - self.error {
            true
        } else if t - error > self.t + self.error {
            false
        } else if self.spot == Spot::NOTHING {
            t < self.t
        } else {
            line().is_nearer(hierarchy, (spot, t), (self.spot, self.t))
        }
    }
}

/// Error of a t that was computed in f64 and rounded to f32, as a share of it.
pub(super) const ROUNDED: f32 = 2.0 * UNIT_ROUNDOFF;

/// A ray in f64.
#[derive(Clone, Copy)]
pub(super) struct Line {
    origin: DVec3,
    direction: DVec3,
    departure: u32,
    /// Hits are wanted beyond this.
    t_min: f32,
}

/// A hit in f64.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Hit {
    t: f64,
    /// Of the angle between the ray and the normal.
    cosine: f64,
}

/// Seen more nearly edge-on than this, a surface that a light lies on is a line.
const LEAST_COSINE: f64 = 1.0 / (1 << 12) as f64;

/// What is no farther from a surface than this share of the coordinates touches it: the start of a ray is known to 2⁻⁴⁸ of
/// them, and f64 rounds some tens of times by 2⁻⁵³.
const TOUCHING: f64 = 1.0 / (1_u64 << 45) as f64;

/// How far f32 may take a face to be from where it is, in roundings of its farthest corner's distance: half of what still counts as
/// rounding (`certified::BAND`).
const OFF_PLANE: f64 = 4.0;

impl Line {
    /// `origin_low` is what the origin's rounding to f32 left out.
    pub(super) fn new([origin, origin_low, direction]: [[f32; 3]; 3], departure: u32, t_min: f32) -> Self {
        let [origin, origin_low, direction] =
            [origin, origin_low, direction].map(|vector| DVec3::from(vector.map(f64::from)));
        Self { origin: origin + origin_low, direction, departure, t_min }
    }

    /// What a ray, which starts on a primitive if DEPARTING, meets of one for which f32 cannot tell: t, how far it may be off, and
    /// where.
    #[cold]
    pub(super) fn meets<const DEPARTING: bool>(
        &self,
        hierarchy: &Hierarchy,
        spot: Spot,
    ) -> Option<(f32, f32, Spot)> {
        let t =
            if DEPARTING { self.departs_to(hierarchy, spot) } else { self.meets_beyond(hierarchy, spot) }?;
        Some((t, t * ROUNDED, spot))
    }

    /// Where a ray meets a surface beyond `t_min`, next to which it starts there. Whether the ray passes inside of a face's edges is
    /// asked as the kernels ask it: faces that share an edge decide that alike.
    #[cold]
    fn meets_beyond(&self, hierarchy: &Hierarchy, spot: Spot) -> Option<f32> {
        match spot.shape(hierarchy) {
            Shape::Sphere { center, radius, .. } => {
                self.sphere(center, radius).into_iter().find_map(|hit| self.beyond_t_min(hit.t))
            }
            Shape::Triangle(vertices) => self.meets_face_beyond(&vertices),
            Shape::Polygon(corners) => self.meets_face_beyond(&corners),
        }
    }

    fn meets_face_beyond(&self, corners: &[DVec3]) -> Option<f32> {
        let Hit { t, cosine } = self.face(corners);
        let outline = Outline::new(self.origin, self.direction, corners);
        let slack = TOUCHING * (extent_of(corners.iter().copied()) + self.origin.abs().max_element());
        match outline.part_beyond(f64::from(self.t_min), slack) {
            Part::StartsOn if outline.is_foot_inside() => self.beyond_t_min(t),
            Part::StartsOn | Part::Passed => None,
            Part::Met(edge_t) => {
                // No later than the plane, as well as f32 tells where that is: seen edge-on, anywhere. A plane that even so is
                // passed, as of a bent polygon, says nothing.
                let reach = extent_of(corners.iter().map(|&corner| corner - self.origin));
                let rounding = OFF_PLANE * f64::from(UNIT_ROUNDOFF) * reach;
                let latest = t + rounding / (cosine * self.direction.length());
                let is_late = edge_t > latest && latest > f64::from(self.t_min);
                let edge_t = if is_late { latest } else { edge_t };
                self.beyond_t_min(t).or_else(|| self.beyond_t_min(edge_t)).or(Some(self.t_min.next_up()))
            }
        }
    }

    /// A t rounded, if hits are wanted there.
    fn beyond_t_min(&self, t: f64) -> Option<f32> {
        let t = rounded(t);
        (t > self.t_min).then_some(t)
    }

    /// Where a ray that leaves a surface meets another. What the start touches, as far as f64 can tell and polygons are flat, it
    /// meets at t = 0, which is no hit.
    #[cold]
    fn departs_to(&self, hierarchy: &Hierarchy, spot: Spot) -> Option<f32> {
        let bend = hierarchy.bend(self.departure >> 1) + hierarchy.bend(spot.id(hierarchy));
        let departs_to_face = |corners: &[DVec3]| {
            let t =
                self.beyond_rounding(self.face(corners), 0.0, extent_of(corners.iter().copied()), bend)?;
            self.is_in(corners).then_some(t)
        };
        match spot.shape(hierarchy) {
            Shape::Sphere { center, radius, .. } => {
                let extent = center.abs().max_element() + radius;
                self.sphere(center, radius)
                    .into_iter()
                    .find_map(|hit| self.beyond_rounding(hit, LEAST_COSINE, extent, bend))
            }
            Shape::Triangle(vertices) => departs_to_face(&vertices),
            Shape::Polygon(corners) => departs_to_face(&corners),
        }
    }

    /// t of a hit that is farther from the start than the rounding of f64 in both, and than polygons are bent. A plane is as
    /// far from the start at whatever angle the ray goes; a sphere bends away from its tangent, so its cosine is bounded.
    fn beyond_rounding(&self, hit: Hit, least_cosine: f64, extent: f64, bend: f64) -> Option<f32> {
        let coordinates = extent + self.origin.abs().max_element();
        let height = hit.t * hit.cosine.max(least_cosine) * self.direction.length();
        let t = rounded(hit.t);
        (height > TOUCHING * coordinates + bend && t > 0.0).then_some(t)
    }

    /// A point as seen along the ray; see `kernel::RaySpace`.
    fn see(&self, point: DVec3) -> [f64; 2] {
        let third = self.direction.abs().max_position();
        let from_origin = point - self.origin;
        let along = from_origin[third] / self.direction[third];
        [(third + 1) % 3, (third + 2) % 3].map(|axis| from_origin[axis] - self.direction[axis] * along)
    }

    /// Whether the ray passes inside of the edges between corners; see `kernel`'s `crosses`.
    fn is_in(&self, corners: &[DVec3]) -> bool {
        let next = corners.iter().cycle().skip(1);
        let crossed = corners.iter().zip(next).filter(|&(&from, &to)| {
            let (from, to) = (self.see(from), self.see(to));
            let turn = cross(from, to);
            match (from[1] < 0.0, to[1] < 0.0) {
                (true, false) => turn > 0.0,
                (false, true) => turn < 0.0,
                _ => false,
            }
        });
        crossed.count() % 2 == 1
    }

    /// Whether the first of two hits is the one to be seen. Each is a place and the t that the kernel found.
    #[cold]
    pub(super) fn is_nearer(&self, hierarchy: &Hierarchy, new: (Spot, f32), old: (Spot, f32)) -> bool {
        let key = |(spot, t): (Spot, f32)| {
            (to_32_bits(self.hit(hierarchy, spot, f64::from(t)).t), spot.id(hierarchy))
        };
        let ((new_t, new_id), (old_t, old_id)) = (key(new), key(old));
        new_t < old_t || (new_t == old_t && new_id < old_id)
    }

    /// Whether a hit is before the end of the segment to a light. The segment's direction was rounded to f32, so a surface
    /// that the light lies on is met at the end give or take that.
    #[cold]
    fn is_before_light(&self, hierarchy: &Hierarchy, spot: Spot, t: f32, t_max: f32) -> bool {
        if t_max == f32::INFINITY {
            return true;
        }
        if self.departure == super::NOWHERE {
            // A stretch that was given as such, not the way to a light.
            return t < t_max;
        }
        let hit = self.hit(hierarchy, spot, f64::from(t));
        let rounding = 2.0 * f64::from(UNIT_ROUNDOFF) / hit.cosine.max(LEAST_COSINE);
        hit.t < f64::from(t_max) * (1.0 - rounding)
    }

    fn hit(&self, hierarchy: &Hierarchy, spot: Spot, t: f64) -> Hit {
        match spot.shape(hierarchy) {
            Shape::Sphere { center, radius, id } => {
                let [near, far] = self.sphere(center, radius);
                if self.departure >> 1 == id {
                    // One root is the start itself, at 0, and the other is their sum.
                    return Hit { t: near.t + far.t, ..far };
                }
                if (near.t - t).abs() <= (far.t - t).abs() { near } else { far }
            }
            Shape::Triangle(vertices) => self.kept_beyond(self.face(&vertices), t),
            Shape::Polygon(corners) => self.kept_beyond(self.face(&corners), t),
        }
    }

    /// The t that was found for a face whose plane, by rounding, seems to be met before where hits are wanted: see [`Part::Met`].
    fn kept_beyond(&self, hit: Hit, t: f64) -> Hit {
        if self.beyond_t_min(hit.t).is_some() { hit } else { Hit { t, ..hit } }
    }

    /// Both roots of the quadratic, the nearer first; see `kernel::sphere`. That of smaller magnitude is taken from their
    /// product, (|o − c|² − r²)/a, which keeps the digits that a difference would lose: of a start on the sphere it is 0.
    fn sphere(&self, center: DVec3, radius: f64) -> [Hit; 2] {
        let from_center = self.origin - center;
        let a = self.direction.length_squared();
        let closest_t = -from_center.dot(self.direction) / a;
        let closest = from_center + closest_t * self.direction;
        let half_squared = radius * radius - closest.length_squared();
        let half_t = if half_squared > 0.0 { (half_squared / a).sqrt() } else { 0.0 };
        let cosine = half_t * a.sqrt() / radius;
        let distance = from_center.length();
        let product = (distance - radius) * (distance + radius) / a;
        let roots = if half_t == 0.0 || closest_t == 0.0 {
            [closest_t - half_t, closest_t + half_t]
        } else if closest_t > 0.0 {
            let larger = closest_t + half_t;
            [product / larger, larger]
        } else {
            let larger = closest_t - half_t;
            [larger, product / larger]
        };
        roots.map(|t| Hit { t, cosine })
    }

    /// Where the line meets the plane of a face, by the one normal that every question to `exact` is answered with: seen
    /// edge-on, another normal's last bit would be another t.
    fn face(&self, corners: &[DVec3]) -> Hit {
        let point = self.point_of_plane(corners);
        // Of a length that loses nothing: a start that is exactly in the plane is at height 0.
        let normal = double_area(corners);
        let (mut low, mut high) = (corners[0], corners[0]);
        for &corner in corners {
            (low, high) = (low.min(corner), high.max(corner));
        }
        // No point of the face is before its box or beyond: what a plane seen nearly edge-on is kept between, and what keeps
        // the order of hits from contradicting that of boxes.
        let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
        for axis in (0..3).filter(|&axis| self.direction[axis] != 0.0) {
            let one = (low[axis] - self.origin[axis]) / self.direction[axis];
            let other = (high[axis] - self.origin[axis]) / self.direction[axis];
            let (near, far) = if one < other { (one, other) } else { (other, one) };
            (enter, leave) = (if near > enter { near } else { enter }, if far < leave { far } else { leave });
        }
        let slope = normal.dot(self.direction);
        let t = normal.dot(point - self.origin) / slope;
        let t = if t <= leave { t } else { leave };
        let t = if t >= enter { t } else { enter };
        Hit { t, cosine: slope.abs() / (normal.length() * self.direction.length()) }
    }

    /// The corner that a face's plane goes through. Of three any will do, and the nearest to where the ray starts is at height 0 if it
    /// starts there; more may not be quite in a plane, and then it is the first.
    fn point_of_plane(&self, corners: &[DVec3]) -> DVec3 {
        let distance = |corner: DVec3| corner.distance_squared(self.origin);
        let nearer = |one, other| if distance(other) < distance(one) { other } else { one };
        match *corners {
            [a, b, c] => nearer(nearer(a, b), c),
            _ => corners[0],
        }
    }
}

/// Newell's normal, as long as twice the area.
fn double_area(corners: &[DVec3]) -> DVec3 {
    corners.windows(2).fold(DVec3::ZERO, |sum, edge| sum + (edge[0] - corners[0]).cross(edge[1] - corners[0]))
}

#[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
fn rounded(t: f64) -> f32 {
    t as f32
}

/// Twice the signed area of the triangle (foot of the ray, a, b).
fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn extent_of(points: impl Iterator<Item = DVec3>) -> f64 {
    points.fold(0.0, |extent, point| {
        let largest = point.abs().max_element();
        if largest > extent { largest } else { extent }
    })
}

/// Rounded to 32 significant bits: far finer than f32, and far coarser than the rounding of f64.
fn to_32_bits(t: f64) -> f64 {
    const DROPPED: u32 = 53 - 32;
    f64::from_bits((t.to_bits() + (1 << (DROPPED - 1))) >> DROPPED << DROPPED)
}
