//! What a hard case is: shapes, rays, and where each of them ends.

use glam::{DVec3, Vec3};
use wavelane::rays::{Departure, Start};
use wavelane::scene::{
    Camera, Geometry, ImageSettings, Material, MaterialId, PrimitiveId, Projection, RenderSettings, Scene,
};

/// A row of the catalogue.
pub(super) struct Case {
    pub(super) number: u32,
    pub(super) name: &'static str,
    /// Ids count them from 0.
    pub(super) shapes: fn() -> Vec<Shape>,
    pub(super) rays: fn() -> Vec<Aimed>,
}

/// A primitive; world space.
#[derive(Clone, Debug)]
pub(super) enum Shape {
    Sphere([f32; 3], f32),
    Triangle([[f32; 3]; 3]),
    Polygon(Vec<[f32; 3]>),
}

/// A ray and what it is to find.
#[derive(Clone, Debug)]
pub(super) struct Aimed {
    /// Origin, `t_min`, direction, `t_max`.
    pub(super) row: [f32; 8],
    /// Where it starts, if it is to leave a primitive.
    pub(super) departure: Option<Departure>,
    pub(super) wanted: Wanted,
    pub(super) faces: Faces,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Wanted {
    /// This primitive, at this t.
    Hit {
        id: u32,
        t: f64,
        within: Within,
    },
    /// Any primitive, as long as there is one.
    Something,
    /// Any primitive, at this t: where several share a place.
    SomethingAt {
        t: f64,
        within: Within,
    },
    Miss,
    /// That all engines and queries agree with themselves, and the count of faces.
    Anything,
    /// A hit as given, or a miss: in f32 either is right. `truly` is which it is, and what the reference finds.
    Free {
        truly: bool,
        id: u32,
        t: f64,
        within: Within,
        why: &'static str,
    },
}

/// How far the wavefront engine's t may be from the true one. The reference is held to [`REFERENCE_ULPS`].
#[derive(Clone, Copy, Debug)]
pub(super) enum Within {
    /// Units in the last place of the true t as f32.
    Ulps(f64),
    /// Roundings, u = 2⁻²⁴, of what takes part, as they show in t: u·L / (|d|·cos θ) for faces, with L the distance of the
    /// farthest corner from the start, and u·(|o − c| + r) / (|d|·cos θ) for spheres.
    Roundings(f64),
    /// As it stands.
    Absolute(f64),
    /// From this t to that.
    Between(f64, f64),
}

/// What the reference is held to: it rounds once, to f32, and a little in f64.
pub(super) const REFERENCE_ULPS: f64 = 1.0;

/// How many faces a ray hits, each tried on its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Faces {
    NotCounted,
    Exactly(usize),
    Even,
}

/// A ray without an end.
pub(super) fn ray(origin: [f32; 3], direction: [f32; 3]) -> Aimed {
    let ([ox, oy, oz], [dx, dy, dz]) = (origin, direction);
    Aimed {
        row: [ox, oy, oz, 0.0, dx, dy, dz, f32::INFINITY],
        departure: None,
        wanted: Wanted::Miss,
        faces: Faces::NotCounted,
    }
}

impl Aimed {
    pub(super) fn beyond(mut self, t_min: f32) -> Self {
        self.row[3] = t_min;
        self
    }

    pub(super) fn before(mut self, t_max: f32) -> Self {
        self.row[7] = t_max;
        self
    }

    pub(super) fn leaving(mut self, id: u32, inward: bool) -> Self {
        self.departure = Some(Departure { from: PrimitiveId(id), inward });
        self
    }

    pub(super) fn hits(self, id: u32, t: f64, within: Within) -> Self {
        Self { wanted: Wanted::Hit { id, t, within }, ..self }
    }

    pub(super) fn hits_something(self) -> Self {
        Self { wanted: Wanted::Something, ..self }
    }

    pub(super) fn hits_something_at(self, t: f64, within: Within) -> Self {
        Self { wanted: Wanted::SomethingAt { t, within }, ..self }
    }

    pub(super) fn misses(self) -> Self {
        Self { wanted: Wanted::Miss, ..self }
    }

    pub(super) fn unasked(self) -> Self {
        Self { wanted: Wanted::Anything, ..self }
    }

    pub(super) fn may_miss(self, id: u32, t: f64, within: Within, why: &'static str) -> Self {
        Self { wanted: Wanted::Free { truly: true, id, t, within, why }, ..self }
    }

    pub(super) fn may_hit(self, id: u32, t: f64, within: Within, why: &'static str) -> Self {
        Self { wanted: Wanted::Free { truly: false, id, t, within, why }, ..self }
    }

    pub(super) fn on_faces(self, faces: Faces) -> Self {
        Self { faces, ..self }
    }

    pub(super) fn origin(&self) -> DVec3 {
        let [x, y, z, ..] = self.row.map(f64::from);
        DVec3::new(x, y, z)
    }

    pub(super) fn direction(&self) -> DVec3 {
        let [.., x, y, z, _] = self.row.map(f64::from);
        DVec3::new(x, y, z)
    }

    /// As recorded rays have it.
    pub(super) fn start(&self) -> Option<Start> {
        self.departure.map(|departure| Start { origin_low: [0.0; 3], departure })
    }
}

/// A scene of shapes in one grey material, seen from the origin.
pub(super) fn scene(shapes: &[Shape]) -> Scene {
    let mut geometry = Geometry::default();
    let grey = MaterialId(0);
    for shape in shapes {
        match shape {
            Shape::Sphere(center, radius) => {
                geometry.add_sphere(Vec3::from(*center), *radius, grey).unwrap();
            }
            Shape::Triangle(corners) => {
                let first = geometry.add_vertices(corners.map(Vec3::from)).unwrap();
                geometry.add_triangle([first, first + 1, first + 2], None, grey).unwrap();
            }
            Shape::Polygon(corners) => {
                let corners: Vec<Vec3> = corners.iter().copied().map(Vec3::from).collect();
                geometry.add_polygon(&corners, None, grey).unwrap();
            }
        }
    }
    Scene {
        image: ImageSettings::default(),
        render: RenderSettings::default(),
        camera: Camera {
            eye: Vec3::ZERO,
            target: Vec3::NEG_Z,
            up: Vec3::Y,
            projection: Projection::PerspectiveAngle { vertical_degrees: 45.0 },
        },
        ambient: Vec3::ZERO,
        lights: Vec::new(),
        materials: vec![Material::grey()],
        geometry,
    }
}

/// t at which a ray's line meets the plane of three points, by the textbook in f64: 2²⁹ times finer than f32.
pub(super) fn plane_t(ray: &Aimed, points: [[f32; 3]; 3]) -> f64 {
    let [a, b, c] = points.map(|point| DVec3::from(point.map(f64::from)));
    let normal = (b - a).cross(c - a);
    normal.dot(a - ray.origin()) / normal.dot(ray.direction())
}

impl Shape {
    /// [`Within::Roundings`]: one rounding as it shows in the t of a ray.
    pub(super) fn t_per_rounding(&self, ray: &Aimed) -> f64 {
        const U: f64 = 1.0 / (1 << 24) as f64;
        let (origin, direction) = (ray.origin(), ray.direction());
        let point = |point: &[f32; 3]| DVec3::from(point.map(f64::from));
        let of_face = |corners: &[[f32; 3]]| {
            let corners: Vec<DVec3> = corners.iter().map(point).collect();
            let next = corners.iter().cycle().skip(1);
            let normal = corners
                .iter()
                .zip(next)
                .fold(DVec3::ZERO, |sum, (from, to)| sum + (*from - corners[0]).cross(*to - corners[0]));
            let farthest = corners.iter().map(|corner| corner.distance(origin)).fold(0.0, f64::max);
            U * farthest / normal.normalize().dot(direction).abs()
        };
        match self {
            Self::Sphere(center, radius) => {
                let (from_center, radius) = (origin - point(center), f64::from(*radius));
                let unit = direction.normalize();
                let off_axis = from_center.cross(unit).length();
                let cosine = (1.0 - (off_axis / radius).powi(2)).sqrt();
                U * (from_center.length() + radius) / (direction.length() * cosine)
            }
            Self::Triangle(corners) => of_face(corners),
            Self::Polygon(corners) => of_face(corners),
        }
    }
}
