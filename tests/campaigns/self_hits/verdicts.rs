//! What geometry says of a ray that starts on a surface: whether it meets a body, and where.
//!
//! Signs are decided without rounding (`exact`). What is left open is what rounding of the start itself decides, 2⁻⁴⁸ of its
//! coordinates, and silhouettes of bodies that are met from a distance, within what f32 can tell of them.

use super::bodies::{Body, Face};
use super::exact::{side, slope};
use glam::DVec3;
use std::cmp::Ordering::{self, Equal, Greater, Less};
use wavelane::rays::Stretch;
use wavelane::scene::PrimitiveId;

/// The start of a ray is known to 2⁻⁴⁸ of its coordinates: what is no farther than this share of them is on a surface.
pub(super) const ON: f64 = 1.0 / (1_u64 << 47) as f64;

/// What is farther than this share is not. Between the two, engines may differ.
pub(super) const OFF: f64 = 1.0 / (1_u64 << 44) as f64;

/// How far f32 may see a silhouette from where it is, as the engine's documentation derives it: 6 roundings of the farthest
/// distance in the test, √3 of it in the direction, √3 of the coordinates in the start.
fn band(origin: DVec3, farthest: f64) -> f64 {
    (7.75 * farthest + 1.75 * origin.abs().max_element()) / f64::from(1 << 24)
}

/// What geometry says of a ray and a body, from t = 0, which is no hit, on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Verdict {
    /// It does not meet it.
    Never,
    /// It meets it, and f32 may see that between these t.
    Meets([f64; 2]),
    /// A start on an edge, or a silhouette within rounding: no answer is wrong.
    Unclear,
}

/// What is known of a start.
struct Start<'a> {
    ray: &'a Stretch,
    from: PrimitiveId,
    inward: bool,
}

impl Body {
    /// What geometry says of a ray that starts on a primitive of this or another body.
    pub(super) fn verdict(&self, ray: &Stretch) -> Verdict {
        let departure = ray.departure.expect("secondary rays start on a primitive");
        let start = Start { ray, from: departure.from, inward: departure.inward };
        let verdict = match self {
            Self::Flat(face) => start.against_face(face),
            Self::Sphere { id, center, radius } => start.against_sphere(*id, *center, *radius),
            Self::Solid(faces) => start.against_solid(faces),
        };
        // Near the end of a segment, which is rounded, no answer is wrong.
        const END: f64 = 1.0 / (1 << 9) as f64;
        match verdict {
            Verdict::Meets([least, _]) if least > ray.t_max * (1.0 + END) => Verdict::Never,
            Verdict::Meets([_, most]) if most > ray.t_max * (1.0 - END) => Verdict::Unclear,
            other => other,
        }
    }
}

impl Start<'_> {
    fn coordinates(&self, extent: f64) -> f64 {
        extent + self.ray.origin.abs().max_element()
    }

    fn against_face(&self, face: &Face) -> Verdict {
        if face.id == self.from {
            return Verdict::Never; // a line meets a plane once
        }
        let height = face.height(self.ray.origin);
        let slope = slope(self.ray.direction, face.normal);
        let coordinates = self.coordinates(face.extent());
        if height.abs() <= ON * coordinates {
            return Verdict::Never; // at t = 0 if at all
        }
        let leaves = if height > 0.0 { slope != Less } else { slope != Greater };
        if leaves {
            return Verdict::Never;
        }
        if height.abs() <= OFF * coordinates {
            return Verdict::Unclear;
        }
        let t = -height * face.length / face.normal.dot(self.ray.direction);
        let speed = self.ray.direction.length();
        let at = self.ray.origin + t * self.ray.direction;
        let farthest = face.corners.iter().map(|corner| corner.distance(self.ray.origin)).fold(0.0, f64::max);
        let depth = face.depth_in_outline(at);
        let cosine = height.abs() / (t * speed);
        let band = band(self.ray.origin, farthest) / cosine;
        match depth {
            depth if depth > band => Verdict::Meets([t - band / speed, t + band / speed]),
            depth if depth < -band => Verdict::Never,
            _ => Verdict::Unclear,
        }
    }

    fn against_sphere(&self, id: PrimitiveId, center: DVec3, radius: f64) -> Verdict {
        let Stretch { origin, direction, .. } = *self.ray;
        let from_center = origin - center;
        let coordinates = self.coordinates(center.abs().max_element() + radius);
        let towards = side(direction, origin, center);
        let speed = direction.length();
        let middle = -from_center.dot(direction) / speed;
        if id == self.from {
            if !self.inward {
                return Verdict::Never;
            }
            // The height of the far side over the start's tangent plane.
            let height = 2.0 * middle * (middle / radius);
            return if towards == Less && height > OFF * coordinates {
                let t = 2.0 * middle / speed;
                let off = band(origin, 2.0 * radius) * radius / (middle * speed);
                Verdict::Meets([t - off, t + off])
            } else {
                Verdict::Unclear
            };
        }
        let height = from_center.length() - radius;
        if height > ON * coordinates && towards != Less {
            return Verdict::Never;
        }
        if height <= OFF * coordinates {
            // It touches: away from it nothing is met.
            return if towards == Less { Verdict::Unclear } else { Verdict::Never };
        }
        let off = (from_center + direction * (middle / speed)).length();
        let band = band(origin, from_center.length() + radius);
        if off < radius - band {
            let half_chord = |off: f64| ((radius - off) * (radius + off)).max(0.0).sqrt();
            let t = [off - band, off + band].map(|off| (middle - half_chord(off.max(0.0))) / speed);
            Verdict::Meets([t[0] - band / speed, t[1] + band / speed])
        } else if off > radius + band {
            Verdict::Never
        } else {
            Verdict::Unclear
        }
    }

    /// Whether rounding of the start, or of a direction along the surface, decides on which side of its own face the ray
    /// passes the face's edge.
    fn runs_along(&self, own: &Face, faces: &[Face]) -> bool {
        let Stretch { origin, direction, .. } = *self.ray;
        if slope(direction, own.normal) != if self.inward { Less } else { Greater } {
            return true;
        }
        let rounding = OFF * self.coordinates(own.extent());
        let off_per_t = own.normal.dot(direction).abs() / own.length;
        let edges = faces.iter().filter(|face| face.id != own.id && slope(direction, face.normal) == Greater);
        let edges = edges.map(|face| {
            let depth = -face.height(origin);
            (depth * face.length / face.normal.dot(direction), depth)
        });
        let nearest = edges.min_by(|(a, _), (b, _)| a.total_cmp(b));
        // A start on the edge itself is another matter.
        nearest.is_some_and(|(t, depth)| depth > rounding && off_per_t * t <= rounding)
    }

    fn against_solid(&self, faces: &[Face]) -> Verdict {
        let Stretch { origin, direction, .. } = *self.ray;
        let own = faces.iter().find(|face| face.id == self.from);
        match own {
            Some(own) if self.runs_along(own, faces) => return Verdict::Unclear,
            Some(_) if !self.inward => return Verdict::Never,
            _ => {}
        }
        let rounding = OFF * self.coordinates(faces.iter().map(Face::extent).fold(0.0, f64::max));
        let corners = faces.iter().flat_map(|face| &face.corners);
        let farthest = corners.map(|corner| corner.distance(origin)).fold(0.0, f64::max);
        let mut passage = Passage::new(band(origin, farthest));
        let mut starts_inside = true;
        // Away from the face that it touches and runs along most nearly, a unit of t.
        let mut least_speed = f64::INFINITY;
        for face in faces {
            let (height, slope) = (face.height(origin), slope(direction, face.normal));
            let speed = face.normal.dot(direction) / face.length;
            let is_on = face.id == self.from || height.abs() <= rounding * (ON / OFF);
            if own.is_none() && slope != Less && (is_on || height > 0.0) {
                // Away from a face that it touches or is outside of; a body that it passes along may be met or not.
                let passes_along = is_on && speed * farthest / direction.length() <= rounding;
                return if passes_along { Verdict::Unclear } else { Verdict::Never };
            }
            if slope == Greater && height.abs() <= rounding {
                return Verdict::Unclear; // it starts on the edge that it leaves by
            }
            starts_inside &= is_on || height < 0.0;
            if is_on {
                least_speed = least_speed.min(speed.abs());
            } else {
                passage.cut(slope, height, speed);
            }
        }
        if least_speed * passage.first() <= rounding {
            Verdict::Unclear
        } else if own.is_some() || starts_inside {
            // From within there is a wall in every direction.
            passage.leaves()
        } else {
            passage.enters()
        }
    }
}

/// The stretch of a ray that is inside all half-spaces of a solid: as it is, with its faces moved outward by a band, and inward.
struct Passage {
    moved: [f64; 3],
    entry: [f64; 3],
    exit: [f64; 3],
}

impl Passage {
    fn new(band: f64) -> Self {
        Self { moved: [0.0, band, -band], entry: [0.0; 3], exit: [f64::INFINITY; 3] }
    }

    /// Cuts by a face that the ray starts above by `height` and leaves by `speed` a unit of t.
    fn cut(&mut self, slope: Ordering, height: f64, speed: f64) {
        let Self { moved, entry, exit } = self;
        for (place, outward) in moved.iter().enumerate() {
            let height = height - outward;
            let t = -height / speed;
            match slope {
                Greater => exit[place] = exit[place].min(t),
                Less => entry[place] = entry[place].max(t),
                Equal if height > 0.0 => exit[place] = f64::NEG_INFINITY,
                Equal => {}
            }
        }
    }

    /// t of the first face.
    fn first(&self) -> f64 {
        if self.entry[0] > 0.0 { self.entry[0] } else { self.exit[0] }
    }

    /// Of a ray that starts inside.
    fn leaves(&self) -> Verdict {
        let [_, later, earlier] = self.exit;
        Verdict::Meets([earlier.max(0.0), later])
    }

    /// Of one that starts outside.
    fn enters(&self) -> Verdict {
        let [_, earlier, later] = self.entry;
        let [_, of_larger, of_smaller] = self.exit;
        if later < of_smaller {
            Verdict::Meets([earlier, later])
        } else if earlier > of_larger {
            Verdict::Never
        } else {
            Verdict::Unclear
        }
    }
}
