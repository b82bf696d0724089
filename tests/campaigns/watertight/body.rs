//! A closed surface in its place: corners rounded to f32, a scene of it, and points that are certainly inside.

use super::flat::Flat;
use super::solid::{Face, Solid};
use crate::random::Random;
use glam::{DQuat, DVec3, Vec3};
use wavelane::scene::{
    Added, Camera, Geometry, GeometryProblem, ImageSettings, Material, MaterialId, Projection,
    RenderSettings, Rgb, Scene,
};

/// Where a surface is and how large.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pose {
    /// What a length of 1 becomes.
    pub(super) size: f64,
    /// How far it is moved, in shortest edges.
    pub(super) offset: f64,
}

/// A closed surface whose corners are f32.
pub(super) struct Body {
    pub(super) scene: Scene,
    pub(super) corners: Vec<DVec3>,
    pub(super) edges: Vec<[usize; 2]>,
    /// Edges between strips, or between a triangle and a polygon; all edges where there are no such.
    pub(super) seams: Vec<[usize; 2]>,
    /// By id.
    pub(super) faces: Vec<Flat>,
    made_of: Vec<Face>,
    /// Points inside that lie far from the surface.
    pub(super) middles: Vec<DVec3>,
    /// Of the box around it.
    pub(super) diameter: f64,
    pub(super) middle: DVec3,
    /// Of a lattice, its first corner, the length of its cells, and how many there are in a row.
    pub(super) lattice: Option<(DVec3, f64, usize)>,
    /// For messages.
    pub(super) name: String,
}

impl Body {
    /// Turns, sizes and moves a surface, and rounds its corners. Where rounding leaves polygons too bent to be accepted, it is
    /// not turned.
    pub(super) fn place(name: &str, solid: &Solid, pose: Pose, random: &mut Random) -> Self {
        let turn = random.turn();
        let towards = random.direction();
        if solid.lattice.is_none()
            && let Some(body) = Self::try_place(name, solid, pose, (turn, towards))
        {
            return body;
        }
        let upright = Self::try_place(name, solid, pose, (DQuat::IDENTITY, towards));
        upright.expect("faces in coordinate planes stay plane")
    }

    fn try_place(name: &str, solid: &Solid, pose: Pose, (turn, towards): (DQuat, DVec3)) -> Option<Self> {
        let [edges, seams] = solid.edges().expect("the surface is closed");
        let lengths = edges.iter().map(|&[from, to]| solid.corners[from].distance(solid.corners[to]));
        let shift = pose.offset * lengths.fold(f64::INFINITY, f64::min) * towards;
        // A lattice stays one.
        let shift = if solid.lattice.is_some() { shift.round() } else { shift };
        let placed = |point: &DVec3| pose.size * (turn * *point + shift);
        let corners: Vec<Vec3> = solid.corners.iter().map(|corner| placed(corner).as_vec3()).collect();
        let geometry = geometry(&corners, &solid.faces).ok()?;
        let corners: Vec<DVec3> = corners.iter().map(|corner| corner.as_dvec3()).collect();
        let faces = solid.faces.iter().map(|face| {
            Flat::new(face.corners.iter().map(|&corner| corners[corner]).collect(), face.is_polygon)
        });
        let (low, high) = geometry.bounds().expect("there are faces");
        Some(Self {
            faces: faces.collect(),
            made_of: solid.faces.clone(),
            scene: scene_of(geometry),
            seams: if seams.is_empty() { edges.clone() } else { seams },
            edges,
            corners,
            middles: solid.inside.iter().map(placed).collect(),
            diameter: low.distance(high),
            middle: 0.5 * (low + high),
            lattice: solid.lattice.map(|cells| (pose.size * shift, pose.size, cells)),
            name: format!("{name}, {pose:?}, turned by {turn}, moved towards {towards}"),
        })
    }

    /// A scene of some faces, in this order.
    pub(super) fn scene_of_faces(&self, ids: &[usize]) -> Scene {
        let (mut corners, mut faces) = (Vec::new(), Vec::new());
        for &id in ids {
            let first = corners.len();
            corners.extend(self.faces[id].corners.iter().map(|corner| corner.as_vec3()));
            faces.push(Face { corners: (first..corners.len()).collect(), ..self.made_of[id].clone() });
        }
        scene_of(geometry(&corners, &faces).expect("they were accepted before"))
    }

    /// How far around a point all is inside, and so far from the surface that no f32 tracer need be wrong about it; none
    /// where the point itself is not.
    pub(super) fn room_around(&self, point: DVec3) -> Option<f64> {
        let mut room = f64::INFINITY;
        for face in &self.faces {
            room = room.min(face.clearance(point, room));
            if room <= 0.0 {
                return None;
            }
        }
        let turns = self.faces.iter().map(|face| face.solid_angle(point)).sum::<f64>();
        ((turns / (4.0 * std::f64::consts::PI) - 1.0).abs() < 0.1).then_some(room)
    }

    /// Whether every ray from within some reach of a point meets the surface once, however corners are rounded.
    pub(super) fn is_star_shaped_about(&self, point: DVec3, reach: f64) -> bool {
        self.faces.iter().all(|face| face.is_seen_from_inside(point, reach))
    }
}

/// Triangles share their corners, polygons have their own.
fn geometry(corners: &[Vec3], faces: &[Face]) -> Result<Geometry, GeometryProblem> {
    let mut geometry = Geometry::default();
    let first = geometry.add_vertices(corners.iter().copied())?;
    let material = MaterialId(0);
    for face in faces {
        let added = match face.corners[..] {
            [a, b, c] if !face.is_polygon => {
                geometry.add_triangle([a, b, c].map(|corner| first + corner as u32), None, material)?
            }
            _ => {
                let corners: Vec<Vec3> = face.corners.iter().map(|&corner| corners[corner]).collect();
                geometry.add_polygon(&corners, None, material)?
            }
        };
        assert_ne!(added, Added::WithoutArea, "a face that rounding left nothing of");
    }
    Ok(geometry)
}

fn scene_of(geometry: Geometry) -> Scene {
    Scene {
        image: ImageSettings::default(),
        render: RenderSettings::default(),
        camera: Camera {
            eye: Vec3::ZERO,
            target: Vec3::NEG_Z,
            up: Vec3::Y,
            projection: Projection::PerspectiveAngle { vertical_degrees: 45.0 },
        },
        ambient: Rgb::ZERO,
        lights: Vec::new(),
        materials: vec![Material::grey()],
        geometry,
    }
}
