//! Concave corners: two faces with a common edge, and light and rays close to it.

use super::{Place, U, aimed, each_ray, engines};
use crate::support::scene;
use glam::{DVec2, DVec3, Vec3};
use std::f64::consts::PI;
use wavelane::ray_tree::{RayTree, Shadow};
use wavelane::render::Engine;
use wavelane::scene::Scene;

/// Two faces that meet along the x axis of the case's own axes: the first in the plane z = 0 towards +y, the second turned
/// up from it by an angle. Both reach from −1 to 1 along the edge and 1 away from it, at least in their middle.
#[derive(Clone, Copy, Debug)]
struct Corner {
    kind: &'static str,
    place: Place,
    degrees: f64,
}

impl Corner {
    /// No nearer to the edge there is only one answer: 16u of the coordinates. The plane of a quadrilateral whose corners have
    /// been rounded does not hold the edge but passes it as near, so that the planes meet at that over the sine of the angle
    /// between them.
    fn least(self) -> f64 {
        let rounding = 16.0 * U * (f64::from(self.place.offset) + 2.0);
        let is_bent = self.kind == "polygon" && self.place.turned;
        if is_bent { rounding / self.radians().sin() } else { rounding }
    }

    fn radians(self) -> f64 {
        self.degrees.to_radians()
    }

    /// A point at a distance from the edge, at an angle from the first face.
    fn point(along: f64, distance: f64, radians: f64) -> Vec3 {
        DVec3::new(along, distance * radians.cos(), distance * radians.sin()).as_vec3()
    }

    /// Lights: between the faces; behind the second; behind the first. What is lit, is wholly lit.
    fn scene(self) -> Scene {
        let face = |radians: f64| {
            let corners: &[[f64; 2]] = match self.kind {
                "triangle" => &[[-1.0, 0.0], [1.0, 0.0], [0.0, 2.0]],
                _ => &[[-1.0, 0.0], [1.0, 0.0], [1.0, 1.0], [-1.0, 1.0]],
            };
            let corners: Vec<Vec3> = corners.iter().map(|&[x, away]| Self::point(x, away, radians)).collect();
            self.place.face(self.kind, &corners, "mirror")
        };
        let angle = self.radians();
        let light =
            |radians| format!("[[light]]\nposition = {}\n", self.place.text(Self::point(0.02, 0.4, radians)));
        scene(&format!(
            "[image]\nsize = [1, 1]\n[render]\nmax_depth = 3\n[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\n\
             fov = 1\n{}{}{}[material.mirror]\ndiffuse = 1\nmirror = 1\n{}{}",
            light(angle / 2.0),
            light(angle.midpoint(PI)),
            light((angle - PI) / 2.0),
            face(0.0),
            face(angle)
        ))
    }

    /// Both faces as the scene has them.
    fn faces(scene: &Scene) -> [Face; 2] {
        let of = |corners: Vec<u32>| {
            let [a, b, c] =
                [0, 1, 2].map(|index| scene.geometry.vertices[corners[index] as usize].as_dvec3());
            let edge = (b - a).normalize();
            let away = ((c - a) - (c - a).dot(edge) * edge).normalize();
            Face { middle: a.midpoint(b), edge, away }
        };
        let triangles = scene.geometry.triangles.iter().map(|triangle| triangle.vertices.to_vec());
        let polygons = scene.geometry.polygons.iter().map(|polygon| polygon.vertices.clone().collect());
        let faces: Vec<Face> = triangles.chain(polygons).map(of).collect();
        [faces[0], faces[1]]
    }
}

#[derive(Clone, Copy, Debug)]
struct Face {
    /// Of the common edge.
    middle: DVec3,
    /// Along it, unit.
    edge: DVec3,
    /// Within the face, away from it, unit.
    away: DVec3,
}

impl Face {
    /// Along the edge, and away from it.
    fn coordinates(&self, point: DVec3) -> DVec2 {
        DVec2::new((point - self.middle).dot(self.edge), (point - self.middle).dot(self.away))
    }

    fn normal(&self) -> DVec3 {
        self.edge.cross(self.away)
    }

    /// Whether a ray meets the face; none where that is not at least so far from the edge, or near the other edges.
    fn meets(&self, origin: DVec3, direction: DVec3, least: f64) -> Option<bool> {
        let t = (self.middle - origin).dot(self.normal()) / direction.dot(self.normal());
        let at = self.coordinates(origin + t * direction);
        if t > 0.0 && at.y > least && at.x.abs() < 0.3 && at.y < 0.7 {
            Some(true)
        } else if t < 0.0 || at.y < -least {
            Some(false)
        } else {
            None
        }
    }
}

/// How many lights and how many rays were judged.
#[derive(Debug, Default)]
struct Judged {
    lights: usize,
    rays: usize,
}

/// Judges every hit that is far enough from the edge.
fn judge(corner: Corner, faces: &[Face; 2], ray: &RayTree, engine: Engine, judged: &mut Judged) {
    let least = corner.least();
    each_ray(ray, 0, &mut |ray, depth| {
        let Some(hit) = &ray.hit else { return };
        let own = hit.primitive.0 as usize;
        let (own_face, other_face) = (&faces[own], &faces[1 - own]);
        let at = own_face.coordinates(hit.point.into());
        if at.y < least || at.x.abs() > 0.3 {
            return;
        }
        let place = format!("at {at}, depth {depth}: {corner:?}, {engine:?}");
        // A ray that gets behind the faces is on its own.
        let is_up = DVec3::from(hit.geometric_normal).dot(own_face.normal()) > 0.0;
        assert_eq!(is_up, own == 0, "behind the faces {place}");
        // As rounding has it, the point may be behind either face.
        let start = own_face.middle + at.x * own_face.edge + at.y * own_face.away;
        let expected = match own {
            0 => [Shadow::Visible, Shadow::Hidden, Shadow::NotTraced],
            _ => [Shadow::Visible, Shadow::NotTraced, Shadow::Hidden],
        };
        let found = [0, 1, 2].map(|light| hit.lights[light].shadow);
        assert_eq!(found, expected, "lights {place}");
        judged.lights += 3;
        let Some(child) = &ray.reflect else { return };
        let Some(expected) = other_face.meets(start, child.direction.into(), least) else { return };
        let found = child.hit.as_ref().map(|hit| hit.primitive.0 as usize);
        let expected = expected.then_some(1 - own);
        assert_eq!(found, expected, "reflected {place}");
        judged.rays += 1;
    });
}

fn check(corner: Corner) -> Judged {
    let scene = corner.scene();
    let faces = Corner::faces(&scene);
    let mut judged = Judged::default();
    for engine in engines() {
        for away in [3e-1, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7] {
            for along in [-0.113, 0.0, 0.0371] {
                for of_face in [0.0, corner.radians()] {
                    // An eye between the faces, and one a little nearer to the face that it looks at.
                    for between in [0.5, 0.3] {
                        let angle = of_face + (corner.radians() / 2.0 - of_face) * 2.0 * between;
                        let target = Corner::point(along, away, of_face);
                        let eye = target + Corner::point(0.01, 0.5, angle);
                        let (eye, target) = (corner.place.point(eye), corner.place.point(target));
                        let ray = aimed(&scene, engine, eye, target);
                        judge(corner, &faces, &ray, engine, &mut judged);
                    }
                }
            }
        }
    }
    judged
}

/// Case 54: Concave corner: no leak and no acne outside 16u of the coordinates from the seam, for lights and for mirrors.
#[test]
fn case_54_concave_corner() {
    for kind in ["triangle", "polygon"] {
        for degrees in [90.0, 1.0, 179.99] {
            for (turned, offset) in [(false, 0.0), (true, 0.0), (true, 37.0)] {
                let corner = Corner { kind, place: Place { turned, offset }, degrees };
                let judged = check(corner);
                assert!(judged.lights > 100 && judged.rays > 50, "{judged:?}: {corner:?}");
            }
        }
    }
}
