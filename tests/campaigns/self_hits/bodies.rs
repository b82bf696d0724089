//! What stands in the scenes: flat faces, spheres and convex solids, of which `verdicts` can say what meets them.

use super::exact::{side, slope};
use super::verdicts::{OFF, ON};
use glam::DVec3;
use std::cmp::Ordering::{Greater, Less};
use std::ops::Range;
use wavelane::rays::Stretch;
use wavelane::scene::{Geometry, PrimitiveId};

/// The plane of a triangle or polygon.
#[derive(Clone, Debug)]
pub(super) struct Face {
    pub(super) id: PrimitiveId,
    pub(super) corners: Vec<DVec3>,
    /// Outward, without rounding where corners lie on a grid of 20 bits; not unit.
    pub(super) normal: DVec3,
    pub(super) length: f64,
}

/// What is met or left as one.
#[derive(Clone, Debug)]
pub(super) enum Body {
    /// A triangle or a polygon alone; of other bodies' rays it is taken to be convex.
    Flat(Face),
    Sphere {
        id: PrimitiveId,
        center: DVec3,
        radius: f64,
    },
    /// Closed and convex.
    Solid(Vec<Face>),
}

impl Face {
    /// All triangles and polygons with ids in a range.
    pub(super) fn all(geometry: &Geometry, ids: Range<u32>) -> Vec<Self> {
        let corner = |index: u32| geometry.vertices[index as usize].as_dvec3();
        let triangles =
            geometry.triangles.iter().map(|triangle| (triangle.id, triangle.vertices.map(corner).to_vec()));
        let polygons = geometry
            .polygons
            .iter()
            .map(|polygon| (polygon.id, polygon.vertices.clone().map(corner).collect::<Vec<_>>()));
        let all = triangles.chain(polygons).filter(|(id, _)| ids.contains(&id.0));
        all.map(|(id, corners)| Self::new(id, corners)).collect()
    }

    fn new(id: PrimitiveId, corners: Vec<DVec3>) -> Self {
        let first = corners[0];
        // Of a face that is not convex, any three corners but one inward turn give the direction; the sum gives the side.
        let sum: DVec3 = corners.windows(2).map(|edge| (edge[0] - first).cross(edge[1] - first)).sum();
        let two = (corners[1] - first).cross(corners[2] - first);
        let normal = if two.dot(sum) < 0.0 { -two } else { two };
        Self { id, length: normal.length(), corners, normal }
    }

    /// Height above the plane.
    pub(super) fn height(&self, point: DVec3) -> f64 {
        self.normal.dot(point - self.corners[0]) / self.length
    }

    pub(super) fn extent(&self) -> f64 {
        self.corners.iter().map(|corner| corner.abs().max_element()).fold(0.0, f64::max)
    }

    /// How far inside the outline a point of the plane is; of a convex face.
    pub(super) fn depth_in_outline(&self, point: DVec3) -> f64 {
        let next = self.corners.iter().cycle().skip(1);
        let depths = self.corners.iter().zip(next).map(|(&from, &to)| {
            let inward = self.normal.cross(to - from).normalize();
            inward.dot(point - from)
        });
        depths.fold(f64::INFINITY, f64::min)
    }
}

impl Body {
    /// Whether no corner lies outside any face, decided without rounding.
    pub(super) fn is_convex(faces: &[Face]) -> bool {
        let corners = || faces.iter().flat_map(|face| &face.corners);
        faces
            .iter()
            .all(|face| corners().all(|&corner| side(face.normal, corner, face.corners[0]) != Greater))
    }

    pub(super) fn holds(&self, id: PrimitiveId) -> bool {
        match self {
            Self::Sphere { id: own, .. } => *own == id,
            Self::Flat(face) => face.id == id,
            Self::Solid(faces) => faces.iter().any(|face| face.id == id),
        }
    }

    /// Whether a ray can meet this primitive of the body: from inside by going along with its normal alone, from outside
    /// against it.
    pub(super) fn allows(&self, ray: &Stretch, id: PrimitiveId) -> bool {
        let Self::Solid(faces) = self else { return true };
        let Some(face) = faces.iter().find(|face| face.id == id) else { return false };
        let highest = faces
            .iter()
            .map(|face| face.height(ray.origin) / (face.extent() + ray.origin.abs().max_element()))
            .fold(f64::NEG_INFINITY, f64::max);
        let slope = slope(ray.direction, face.normal);
        // Into its own solid a ray goes from within, even if its start was put beside its face.
        let goes_inside = ray.departure.is_some_and(|start| start.inward && self.holds(start.from));
        match highest {
            _ if goes_inside => slope == Greater,
            highest if highest <= ON => slope == Greater,
            highest if highest > OFF => slope == Less,
            _ => true,
        }
    }
}
