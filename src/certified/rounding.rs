//! How far a primitive would have to be moved for another answer to be right.
//!
//! An engine in f32 takes each point relative to the ray's origin o and turns it into the ray's frame, which rounds some times by
//! u = 2⁻²⁴ of the distance: its answer is the true one for a primitive whose points are moved by so many times u·L, L the largest
//! distance of its points from o. Moved by δ,
//!
//! - an outline or a limb passes the ray on either side if it is no farther from it than δ,
//! - a plane is met at t ± δ/(|d|·cos θ), θ the angle of the ray to its normal, and no nearer or farther than its corners, t of a
//!   corner being told along the axis i in which the ray is fastest, ± δ/|dᵢ|,
//! - a sphere is met between where lines at l − δ and l + δ from its centre meet it, l being the ray's own distance.
//!
//! These are distances in f64, off by some 2⁻⁵⁰·L: a 2⁻²⁴th of what they are compared with. What is decided exactly is decided
//! elsewhere; here it is told how near.

use super::sphere::Ball;
use super::{BAND, Line, Seen, polygon, triangle};
use crate::rays::Departure;
use glam::DVec3;

/// 2⁻²⁴, half the distance from 1 to the next number of f32.
const U: f64 = 1.0 / (1 << 24) as f64;

/// The start of a ray on a surface is known to 2⁻⁴⁸ of its coordinates, and what is nearer than 2⁻⁴⁶ of them and of a primitive's touches
/// that primitive: the contract of departures.
const TOUCHING: f64 = 1.0 / (1_u64 << 46) as f64;
/// Nearer to edge-on, the angle counts no more.
const LEAST_COSINE: f64 = 1.0 / (1 << 20) as f64;

/// What a primitive is.
pub(super) enum Shape {
    Sphere(Ball),
    Triangle([DVec3; 3]),
    Polygon(Box<[DVec3]>),
}

impl Shape {
    fn corners(&self) -> &[DVec3] {
        match self {
            Self::Sphere(_) => &[],
            Self::Triangle(corners) => corners,
            Self::Polygon(corners) => corners,
        }
    }

    /// Not unit; Newell's.
    fn normal(&self) -> DVec3 {
        let corners = self.corners();
        let spanned = corners.windows(2).map(|edge| (edge[0] - corners[0]).cross(edge[1] - corners[0]));
        spanned.sum()
    }
}

/// How far from t = 0 a crossing at t may be and yet touch the surface that the ray starts on.
pub(super) fn start(line: &Line, shape: &Shape, t: f64) -> f64 {
    let (normal, extent) = match shape {
        Shape::Sphere((center, radius)) => {
            (line.origin + t * line.direction - *center, center.abs().max_element() + radius)
        }
        face => {
            let extent = face.corners().iter().map(|corner| corner.abs().max_element()).fold(0.0, f64::max);
            (face.normal(), extent)
        }
    };
    let speed = line.direction.length();
    let cosine = (normal.normalize_or_zero().dot(line.direction / speed)).abs().max(LEAST_COSINE);
    TOUCHING * (extent + line.origin.abs().max_element()) / (cosine * speed)
}

/// A primitive as a ray sees it, in lengths along and across the ray.
pub(super) struct View {
    /// u·L, with the ray's own rounding, u·|o| for its origin, as if there were [`BAND`] of them.
    unit: f64,
    /// The same for t: of a triangle's plane, what a rounding of its corners makes of its tilt is s²/h more, s the longest edge and h
    /// the height above it.
    unit_of_t: f64,
    /// Of the direction.
    speed: f64,
    /// From the outline or the limb; below 0 outside of it.
    inside_by: f64,
    kind: Kind,
}

enum Kind {
    /// `along` is the share of the direction that is along its fastest axis.
    Face {
        middle: f64,
        cosine: f64,
        corners: [f64; 2],
        along: f64,
    },
    Sphere {
        middle: f64,
        off_center: f64,
        radius: f64,
    },
    FarSide {
        middle: f64,
        off_center: f64,
        radius: f64,
    },
    Never,
}

/// Where a primitive may be met once it is moved, in t: its near side, and a sphere's far one.
pub(super) type Sides = [Option<[f64; 2]>; 2];

impl View {
    pub(super) fn new(line: &Line, shape: &Shape, departure: Option<Departure>) -> Self {
        let speed = line.direction.length();
        let direction = line.direction / speed;
        let seen = |point: DVec3| {
            let from_origin = point - line.origin;
            let along = from_origin.dot(direction);
            (from_origin - along * direction, along)
        };
        let (farthest, inside_by, kind, needle) = match shape {
            Shape::Sphere((center, radius)) => {
                let (aside, middle) = seen(*center);
                let (off_center, radius) = (aside.length(), *radius);
                let kind = match departure {
                    None => Kind::Sphere { middle, off_center, radius },
                    Some(Departure { inward: true, .. }) => Kind::FarSide { middle, off_center, radius },
                    Some(_) => Kind::Never,
                };
                ((*center - line.origin).length() + radius, radius - off_center, kind, 0.0)
            }
            face => {
                let corners = face.corners();
                let farthest =
                    corners.iter().map(|&corner| (corner - line.origin).length()).fold(0.0, f64::max);
                let sight: Vec<DVec3> = corners.iter().map(|&corner| seen(corner).0).collect();
                let next = sight.iter().cycle().skip(1);
                let to_edge =
                    sight.iter().zip(next).map(|(&a, &b)| to_segment(a, b)).fold(f64::INFINITY, f64::min);
                let axis = direction.abs().max_position();
                let alongs =
                    corners.iter().map(|corner| (corner[axis] - line.origin[axis]) / direction[axis]);
                let ends = alongs.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], along| {
                    [least.min(along), most.max(along)]
                });
                let normal = face.normal().normalize_or_zero();
                let cosine = normal.dot(direction);
                let middle = normal.dot(corners[0] - line.origin) / cosine;
                let kind = match departure {
                    None => Kind::Face {
                        middle,
                        cosine: cosine.abs(),
                        corners: ends,
                        along: direction[axis].abs(),
                    },
                    Some(_) => Kind::Never,
                };
                let is_inside = match face {
                    Shape::Triangle(corners) => triangle::meet(line, corners).seen == Seen::Inside,
                    _ => polygon::meet(line, corners).seen == Seen::Inside,
                };
                (farthest, if is_inside { to_edge } else { -to_edge }, kind, needle(face))
            }
        };
        let unit = U * (farthest + line.origin.length() / BAND);
        Self { unit, unit_of_t: unit + U * needle, speed, inside_by, kind }
    }

    /// How far the ray passes inside of the outline or the limb, in units of u·L; below 0 outside of it.
    pub(super) fn inside_by(&self) -> f64 {
        self.inside_by / self.unit
    }

    /// Where the primitive may be met if it is moved by so many roundings, and whether it still has to be.
    pub(super) fn sides(&self, roundings: f64) -> (Sides, bool) {
        let off = roundings * self.unit;
        let is_sure = self.inside_by > off;
        if self.inside_by < -off && !matches!(self.kind, Kind::FarSide { .. }) {
            return ([None; 2], false);
        }
        let t = |[from, to]: [f64; 2]| Some([from / self.speed, to / self.speed]);
        match self.kind {
            Kind::Never => ([None; 2], false),
            Kind::Face { middle, cosine, corners: [least, most], along } => {
                let slack = roundings * self.unit_of_t / cosine;
                // Edge-on, these are no numbers, which max and min pass over.
                let [least, most] = [least - off / along, most + off / along];
                let from = (middle - slack).max(least).min(most);
                let to = (middle + slack).min(most).max(least);
                ([t([from, to]), None], is_sure)
            }
            Kind::Sphere { middle, off_center, radius } => {
                let [shortest, longest] = chord(off_center, radius, off);
                (
                    [t([middle - longest, middle - shortest]), t([middle + shortest, middle + longest])],
                    is_sure,
                )
            }
            // The start is on the sphere: twice the way to the middle, if the line passes the sphere by rounding too.
            Kind::FarSide { middle, off_center, radius } => {
                let [shortest, longest] = chord(off_center, radius, off);
                let [low, high] = [shortest.min(middle), longest.max(middle)];
                ([None, t([middle + low, middle + high])], middle > off)
            }
        }
    }
}

/// Half the chord of a line moved outward and inward, less or more the move along the line.
fn chord(off_center: f64, radius: f64, off: f64) -> [f64; 2] {
    let half = |off_center: f64| ((radius - off_center) * (radius + off_center)).max(0.0).sqrt();
    [half(off_center + off) - off, half((off_center - off).max(0.0)) + off]
}

/// From 0 to the segment between two points.
fn to_segment(a: DVec3, b: DVec3) -> f64 {
    let along = b - a;
    let length_squared = along.length_squared();
    let share = if length_squared > 0.0 { (-a.dot(along) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
    (a + share * along).length()
}

/// s²/h of a triangle; polygons bring the normal with them.
fn needle(face: &Shape) -> f64 {
    let Shape::Triangle([a, b, c]) = face else { return 0.0 };
    let longest = (*b - *a).length().max((*c - *b).length()).max((*a - *c).length());
    longest.powi(3) / (*b - *a).cross(*c - *a).length()
}
