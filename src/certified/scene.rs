//! A ray and a scene, every primitive tried.

use super::rounding::{self, Shape};
use super::{Enclosure, Limb, Line, Method, Seen, Surd, polygon, sphere, triangle};
use crate::rays::{Departure, Stretch};
use crate::scene::{PrimitiveId, Scene};
use std::cmp::Ordering;

/// The judge of a scene.
pub struct Judge {
    /// In order of id.
    pub(super) primitives: Vec<Primitive>,
}

/// A primitive as the scene has it, in f64.
pub(super) struct Primitive {
    pub(super) id: PrimitiveId,
    pub(super) casts_shadow: bool,
    pub(super) shape: Shape,
}

/// Where a ray crosses a primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The primitive.
    pub id: PrimitiveId,
    /// The ray's parameter.
    pub t: Enclosure,
    /// How surely it is crossed.
    pub place: Place,
    /// What it took.
    pub by: Method,
    root: Root,
}

/// How surely a primitive is crossed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Strictly inside of its outline, strictly beyond `t_min`.
    Inside,
    /// Exactly on its edge, its corner or its limb: either answer is right.
    Boundary,
    /// So near to the start of a ray that starts on a surface that it may touch that surface there: nearer than 2⁻⁴⁶ of the
    /// coordinates, seen at the angle of the ray, which is what such a start is known to. Either answer is right.
    Start,
}

/// Which of its roots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Root {
    /// Of a face, or a sphere's nearer one.
    First,
    /// Of a sphere.
    Second,
    /// Of the sphere that the ray starts on.
    FarSide,
}

/// What a ray may meet first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Closest {
    /// What is first under one rule or another about boundaries, in order of t, of equal ones of id: everything up to the first
    /// primitive that is crossed strictly inside, and what is met at exactly its t.
    pub candidates: Vec<Crossing>,
    /// Whether there may be nothing to meet: nothing is crossed strictly inside.
    pub may_miss: bool,
}

/// Whether something that casts a shadow is in the way of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Occlusion {
    /// There is nothing.
    Free,
    /// Only boundaries, or what may touch the start: either answer is right.
    Boundary,
    /// Something is crossed strictly inside.
    Occluded,
}

impl Closest {
    /// The one right answer, if there is one: the primitive, or the miss. Of primitives met at exactly one t it is that of the
    /// smallest id.
    #[must_use]
    pub fn only(&self) -> Option<Option<PrimitiveId>> {
        match self.candidates.first() {
            None => Some(None),
            Some(first) if first.place == Place::Inside => {
                Some(self.candidates.iter().map(|crossing| crossing.id).min())
                    .filter(|_| self.candidates.iter().all(|crossing| crossing.place == Place::Inside))
            }
            Some(_) => None,
        }
    }

    /// Whether an answer is right: boundaries may be taken for in or out, and of what is crossed strictly inside at one t the smallest
    /// id is to be seen.
    #[must_use]
    pub fn admits(&self, id: Option<PrimitiveId>) -> bool {
        let Some(id) = id else { return self.may_miss };
        let smallest_inside = self
            .candidates
            .iter()
            .filter(|crossing| crossing.place == Place::Inside)
            .map(|crossing| crossing.id)
            .min();
        self.candidates.iter().any(|crossing| {
            crossing.id == id && (crossing.place != Place::Inside || smallest_inside == Some(id))
        })
    }

    /// Whether more than one boundary is met at once, as where faces share an edge.
    #[must_use]
    pub fn is_shared_boundary(&self) -> bool {
        self.candidates.iter().filter(|crossing| crossing.place == Place::Boundary).count() > 1
    }
}

impl Judge {
    /// Of a scene as it is.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let geometry = &scene.geometry;
        let vertex = |index: u32| geometry.vertices[index as usize].as_dvec3();
        let spheres = geometry.spheres.iter().map(|sphere| {
            (sphere.id, sphere.material, Shape::Sphere((sphere.center.as_dvec3(), f64::from(sphere.radius))))
        });
        let triangles = geometry
            .triangles
            .iter()
            .map(|triangle| (triangle.id, triangle.material, Shape::Triangle(triangle.vertices.map(vertex))));
        let polygons = geometry.polygons.iter().map(|polygon| {
            (polygon.id, polygon.material, Shape::Polygon(polygon.vertices.clone().map(vertex).collect()))
        });
        let mut primitives: Vec<Primitive> = spheres
            .chain(triangles)
            .chain(polygons)
            .map(|(id, material, shape)| {
                let casts_shadow = scene.materials[material.0 as usize].casts_shadow;
                Primitive { id, casts_shadow, shape }
            })
            .collect();
        primitives.sort_by_key(|primitive| primitive.id);
        Self { primitives }
    }

    /// Every crossing at `t_min` < t < `t_max`, in order of id.
    #[must_use]
    pub fn crossings(&self, stretch: &Stretch) -> Vec<Crossing> {
        let line = Line { origin: stretch.origin, direction: stretch.direction };
        self.primitives.iter().flat_map(|primitive| primitive.crossings(&line, stretch)).collect()
    }

    /// What a ray may meet first.
    #[must_use]
    pub fn closest(&self, stretch: &Stretch) -> Closest {
        let line = Line { origin: stretch.origin, direction: stretch.direction };
        let crossings = self.crossings(stretch);
        let compare = |a: &Crossing, b: &Crossing| self.compare(&line, a, b);
        let inside = crossings.iter().filter(|crossing| crossing.place == Place::Inside);
        let end =
            inside.reduce(|first, next| if compare(next, first) == Ordering::Less { next } else { first });
        let Some(end) = end.copied() else {
            let mut candidates = crossings;
            candidates.sort_by(compare);
            return Closest { candidates, may_miss: true };
        };
        let mut candidates = crossings;
        candidates.retain(|crossing| self.compare(&line, crossing, &end) != Ordering::Greater);
        candidates.sort_by(|a, b| self.compare(&line, a, b));
        Closest { candidates, may_miss: false }
    }

    /// Whether something that casts a shadow is in the way of a ray, which ends at `t_max` exactly.
    #[must_use]
    pub fn occluded(&self, stretch: &Stretch) -> Occlusion {
        let line = Line { origin: stretch.origin, direction: stretch.direction };
        let casters = self.primitives.iter().filter(|primitive| primitive.casts_shadow);
        let mut found = Occlusion::Free;
        for crossing in casters.flat_map(|primitive| primitive.crossings(&line, stretch)) {
            if crossing.place == Place::Inside {
                return Occlusion::Occluded;
            }
            found = Occlusion::Boundary;
        }
        found
    }

    pub(super) fn primitive(&self, id: PrimitiveId) -> Option<&Primitive> {
        let index = self.primitives.binary_search_by_key(&id, |primitive| primitive.id).ok()?;
        Some(&self.primitives[index])
    }

    /// In order of t; exactly, where enclosures overlap.
    fn compare(&self, line: &Line, a: &Crossing, b: &Crossing) -> Ordering {
        if a.t.high < b.t.low {
            return Ordering::Less;
        }
        if a.t.low > b.t.high {
            return Ordering::Greater;
        }
        let exact = |crossing: &Crossing| {
            self.primitive(crossing.id).map(|primitive| primitive.exact_t(line, crossing.root))
        };
        match (exact(a), exact(b)) {
            (Some(a), Some(b)) => a.compare(&b),
            _ => Ordering::Equal,
        }
    }
}

impl Primitive {
    fn crossings(&self, line: &Line, stretch: &Stretch) -> Vec<Crossing> {
        match stretch.departure.filter(|departure| departure.from == self.id) {
            Some(Departure { inward, .. }) => self.far_side(line, stretch, inward).into_iter().collect(),
            None => {
                let all = self.line_crossings(line).into_iter().flatten();
                all.filter_map(|crossing| self.on_stretch(line, stretch, crossing)).collect()
            }
        }
    }

    /// A plane is never met again, a sphere on its far side by a ray that goes inside.
    fn far_side(&self, line: &Line, stretch: &Stretch, inward: bool) -> Option<Crossing> {
        let Shape::Sphere(ball) = &self.shape else { return None };
        let t = sphere::exact_far_side(line, ball);
        let is_met =
            inward && t.sign() == Ordering::Greater && t.compare_f64(stretch.t_max) == Ordering::Less;
        is_met.then(|| Crossing {
            id: self.id,
            t: t.enclosure(),
            place: Place::Inside,
            by: Method::Fractions,
            root: Root::FarSide,
        })
    }

    fn line_crossings(&self, line: &Line) -> [Option<Crossing>; 2] {
        let id = self.id;
        let face = |meeting: super::FaceMeeting| {
            let place = if meeting.seen == Seen::Inside { Place::Inside } else { Place::Boundary };
            let crossing = meeting.t.map(|t| Crossing { id, t, place, by: meeting.by, root: Root::First });
            [crossing, None]
        };
        match &self.shape {
            Shape::Triangle(corners) => face(triangle::meet(line, corners)),
            Shape::Polygon(corners) => face(polygon::meet(line, corners)),
            Shape::Sphere(ball) => {
                let meeting = sphere::meet(line, ball);
                let place = if meeting.limb == Limb::Crossed { Place::Inside } else { Place::Boundary };
                let crossing = |t, root| Crossing { id, t, place, by: meeting.by, root };
                match meeting.roots {
                    None => [None, None],
                    Some([t, _]) if meeting.limb == Limb::Touched => [Some(crossing(t, Root::First)), None],
                    Some([near, far]) => {
                        [Some(crossing(near, Root::First)), Some(crossing(far, Root::Second))]
                    }
                }
            }
        }
    }

    /// A crossing of the line if it is one of the stretch.
    fn on_stretch(&self, line: &Line, stretch: &Stretch, mut crossing: Crossing) -> Option<Crossing> {
        if self.compare_f64(line, &crossing, stretch.t_max) != Ordering::Less {
            return None;
        }
        if stretch.departure.is_some() {
            let start = rounding::start(line, &self.shape, crossing.t.middle());
            if crossing.t.distance(0.0) <= start {
                crossing.place = Place::Start;
                return Some(crossing);
            }
        }
        (self.compare_f64(line, &crossing, stretch.t_min) == Ordering::Greater).then_some(crossing)
    }

    fn compare_f64(&self, line: &Line, crossing: &Crossing, number: f64) -> Ordering {
        let Enclosure { low, high } = crossing.t;
        if high < number {
            Ordering::Less
        } else if low > number {
            Ordering::Greater
        } else {
            self.exact_t(line, crossing.root).compare_f64(number)
        }
    }

    fn exact_t(&self, line: &Line, root: Root) -> Surd {
        match (&self.shape, root) {
            (Shape::Triangle(corners), _) => triangle::exact_t(line, corners),
            (Shape::Polygon(corners), _) => polygon::exact_t(line, corners),
            (Shape::Sphere(ball), Root::FarSide) => sphere::exact_far_side(line, ball),
            (Shape::Sphere(ball), _) => {
                let [near, far] = sphere::exact_roots(line, ball);
                if root == Root::Second { far } else { near }
            }
        }
    }
}
