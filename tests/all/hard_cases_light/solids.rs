//! Glass solids, looked at exactly along what their faces share.

use super::{Place, U, aimed, each_ray, engines};
use crate::support::scene;
use glam::{DVec3, Vec3};
use std::collections::BTreeSet;
use wavelane::ray_tree::RayTree;
use wavelane::render::Engine;
use wavelane::scene::Scene;

/// What the faces of a solid are made of.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Faces {
    Triangles,
    Polygons,
    /// Every other one.
    Mixed,
}

/// A convex solid around the origin of its own axes.
struct Solid {
    name: &'static str,
    corners: Vec<Vec3>,
    /// Counter-clockwise as seen from outside.
    faces: Vec<Vec<usize>>,
}

impl Solid {
    fn new(name: &'static str, corners: Vec<Vec3>, faces: Vec<Vec<usize>>) -> Self {
        let outward = |mut face: Vec<usize>| {
            let [a, b, c] = [corners[face[0]], corners[face[1]], corners[face[2]]];
            if (b - a).cross(c - a).dot(a) < 0.0 {
                face.reverse();
            }
            face
        };
        let faces = faces.into_iter().map(outward).collect();
        Self { name, corners, faces }
    }

    fn cube() -> Self {
        let corners = (0..8).map(|index| {
            let side = |bit: usize| if index >> bit & 1 == 1 { 1.0 } else { -1.0 };
            Vec3::new(side(0), side(1), side(2))
        });
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        Self::new("cube", corners.collect(), faces.map(Vec::from).to_vec())
    }

    fn prism() -> Self {
        let ends = [-0.75, 1.0]
            .map(|y| [[-1.0, -0.75], [1.125, -0.5], [0.25, 1.0]].map(|[x, z]| Vec3::new(x, y, z)));
        let faces: [&[usize]; 5] = [&[0, 1, 2], &[3, 4, 5], &[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]];
        Self::new("prism", ends.concat(), faces.map(Vec::from).to_vec())
    }

    /// An icosahedron whose faces are cut in four and brought to the sphere.
    fn icosphere() -> Self {
        let golden = (1.0 + 5.0_f32.sqrt()) / 2.0;
        let mut corners = Vec::new();
        for [a, b] in [[-1.0, -golden], [1.0, -golden], [-1.0, golden], [1.0, golden]] {
            corners.extend([Vec3::new(0.0, a, b), Vec3::new(a, b, 0.0), Vec3::new(b, 0.0, a)]);
        }
        let corners: Vec<Vec3> = corners.into_iter().map(Vec3::normalize).collect();
        let is_edge = |a: usize, b: usize| a != b && corners[a].distance(corners[b]) < 1.1;
        let mut triangles = Vec::new();
        for (a, b) in (0..12).flat_map(|a| (0..a).map(move |b| (a, b))) {
            triangles.extend(
                (0..b).filter(|&c| is_edge(a, b) && is_edge(b, c) && is_edge(a, c)).map(|c| [a, b, c]),
            );
        }
        assert_eq!(triangles.len(), 20);
        let (mut cut, mut faces) = (corners.clone(), Vec::new());
        for [a, b, c] in triangles {
            let middle = |cut: &mut Vec<Vec3>, a: usize, b: usize| {
                let middle = (corners[a] + corners[b]).normalize();
                let known = cut.iter().position(|&corner| corner == middle);
                known.unwrap_or_else(|| {
                    cut.push(middle);
                    cut.len() - 1
                })
            };
            let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(a, b)| middle(&mut cut, a, b));
            faces.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]].map(Vec::from));
        }
        assert_eq!((cut.len(), faces.len()), (42, 80));
        Self::new("icosphere", cut, faces)
    }

    fn scene(&self, faces: Faces, place: Place, material: &str) -> Scene {
        let mut shapes = String::new();
        for (index, face) in self.faces.iter().enumerate() {
            let corners: Vec<Vec3> = face.iter().map(|&corner| self.corners[corner]).collect();
            if faces == Faces::Polygons || (faces == Faces::Mixed && index % 2 == 1) {
                shapes += &place.face("polygon", &corners, "glass");
            } else {
                for pair in corners[1..].windows(2) {
                    shapes += &place.face("triangle", &[corners[0], pair[0], pair[1]], "glass");
                }
            }
        }
        scene(&format!(
            "[image]\nsize = [1, 1]\nbackground = 1\n[render]\nmax_depth = 64\n[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\n\
             up = [0, 1, 0]\nfov = 1\n[material.glass]\nfresnel = false\n{material}\n{shapes}"
        ))
    }

    /// Where to look: corners, middles of edges, and another place on them; at most about so many.
    fn targets(&self, most: usize) -> Vec<Vec3> {
        let edges: BTreeSet<[usize; 2]> = self
            .faces
            .iter()
            .flat_map(|face| (0..face.len()).map(|index| [face[index], face[(index + 1) % face.len()]]))
            .map(|[a, b]| [a.min(b), a.max(b)])
            .collect();
        let on_edges = edges.into_iter().flat_map(|[a, b]| {
            let (a, b) = (self.corners[a], self.corners[b]);
            [0.5, 0.3].map(|share| a + share * (b - a))
        });
        let targets: Vec<Vec3> = self.corners.iter().copied().chain(on_edges).collect();
        targets.iter().copied().step_by(targets.len().div_ceil(most)).collect()
    }

    /// Normal and distance from the origin of each face.
    fn planes(&self, place: Place) -> Vec<(DVec3, f64)> {
        let of = |face: &Vec<usize>| {
            let [a, b, c] = [0, 1, 2].map(|index| place.point(self.corners[face[index]]).as_dvec3());
            let normal = (b - a).cross(c - a).normalize();
            (normal, normal.dot(a))
        };
        self.faces.iter().map(of).collect()
    }
}

/// Directions to look from: of no account to the solids; along axes, so that faces of the cube are seen edge-on; along
/// diagonals.
const FROM: [Vec3; 6] = [
    Vec3::new(3.1, -4.3, 2.7),
    Vec3::new(-1.7, 0.9, 4.9),
    Vec3::new(0.0, 0.0, 5.0),
    Vec3::new(-5.0, 0.0, 0.0),
    Vec3::new(3.0, 3.0, 0.0),
    Vec3::new(-3.0, 3.0, 3.0),
];

/// Where a line enters what is between the planes, each moved outward by so much, and where it leaves it; not after it enters if it
/// passes by.
fn chord(planes: &[(DVec3, f64)], origin: DVec3, direction: DVec3, outward: f64) -> [f64; 2] {
    let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
    for &(normal, distance) in planes {
        let (height, slope) = (distance + outward - normal.dot(origin), normal.dot(direction));
        if slope == 0.0 {
            if height < 0.0 {
                return [0.0; 2];
            }
        } else if slope < 0.0 {
            enter = enter.max(height / slope);
        } else {
            leave = leave.min(height / slope);
        }
    }
    [enter, leave]
}

fn each_look(most: usize, mut look: impl FnMut(&Solid, Faces, Place, Vec<[Vec3; 2]>)) {
    for solid in [Solid::cube(), Solid::prism(), Solid::icosphere()] {
        for faces in [Faces::Triangles, Faces::Polygons, Faces::Mixed] {
            for (turned, offset) in [(false, 0.0), (true, 0.0), (true, 37.0)] {
                let place = Place { turned, offset };
                let targets = solid.targets(most).into_iter();
                let lines = targets.flat_map(|target| FROM.map(|from| [target + from, target]));
                let lines = lines.map(|line| line.map(|point| place.point(point))).collect();
                look(&solid, faces, place, lines);
            }
        }
    }
}

/// What glass of index 1 that absorbs shows of how long the way through it was.
#[derive(Default)]
struct Ways {
    /// e^(−a·s) between those of the shortest and of the longest way that moving each face by 16u of the coordinates makes. No face
    /// counted alone, that would absorb for ever.
    as_long_as_they_are: usize,
    /// All the way from the eye to where it touches the solid.
    up_to_the_solid: usize,
}

fn ways(silhouettes: bool) -> Ways {
    let mut ways = Ways::default();
    each_look(24, |solid, faces, place, lines| {
        let absorption = 0.5;
        let scene = solid.scene(faces, place, &format!("ior = 1\nabsorption = {absorption}"));
        let planes = solid.planes(place);
        let slack = 16.0 * U * f64::from(place.offset + 2.0);
        for [eye, target] in lines {
            let (origin, direction) = (eye.as_dvec3(), (target - eye).as_dvec3().normalize());
            let [inner, outer] = [-slack, slack].map(|outward| chord(&planes, origin, direction, outward));
            let [least, most] = [inner, outer].map(|[enter, leave]| (leave - enter).max(0.0));
            if (least == 0.0) != silhouettes {
                continue;
            }
            for engine in engines() {
                let found = aimed(&scene, engine, eye, target).colour[0];
                let is_between = |[shortest, longest]: [f64; 2]| {
                    let [high, low] = [shortest, longest].map(|length| (-absorption * length).exp());
                    (low - 8.0 * U..=high + 8.0 * U).contains(&found)
                };
                if is_between([least, most]) {
                    ways.as_long_as_they_are += 1;
                } else if is_between(outer) || (silhouettes && most > 1e-3 && is_between([0.0, outer[1]])) {
                    // Of a ray that goes along a face it cannot be told where it leaves.
                    ways.up_to_the_solid += 1;
                } else {
                    panic!(
                        "{found}, not after {inner:?} or {outer:?}, from {eye} to {target}, {} of {faces:?}, {place:?}, {engine:?}",
                        solid.name
                    );
                }
            }
        }
    });
    ways
}

/// Case 48: Glass silhouette edge: where a ray passes exactly through an edge or a corner, it is inside as long as geometry says.
/// Edges of the outline, where it may be inside not at all, are the next test's.
#[test]
fn case_48_the_way_through_an_edge_is_as_long_as_it_is() {
    let ways = ways(false);
    assert_eq!(ways.up_to_the_solid, 0);
    assert!(ways.as_long_as_they_are > 1000);
}

/// 48, exactly along the outline, where the ray meets the faces that it enters and leaves by at one t. Of these the smallest id is seen,
/// as the image model says; if it is the face that the ray leaves by, all the way before it was through glass. Every eighth such
/// ray at most.
#[test]
fn case_48_the_way_along_the_outline_is_nothing_or_up_to_it() {
    let ways = ways(true);
    let looks = ways.as_long_as_they_are + ways.up_to_the_solid;
    assert!(looks > 1000 && ways.up_to_the_solid * 8 <= looks, "{} of {looks}", ways.up_to_the_solid);
}

/// Case 47: Beer deep, away from the origin: what a way absorbs depends on its length and not on where it lies. e^(−a·s) to
/// (a·s + 4)·4u, and to what the direction's rounding, u of the eye's distance, makes of s at faces seen at 60° or less.
#[test]
fn case_47_absorption_does_not_depend_on_where_the_way_lies() {
    // Of triangles alone, whose planes are those of their corners as rounded.
    let (solid, absorption) = (Solid::icosphere(), 3.0);
    for (turned, offset) in [(false, 0.0), (true, 0.0), (true, 37.0), (true, 1024.0), (true, 16_384.0)] {
        let place = Place { turned, offset };
        let scene = solid.scene(Faces::Triangles, place, &format!("ior = 1\nabsorption = {absorption}"));
        let planes = solid.planes(place);
        let targets = [Vec3::new(0.1, 0.2, -0.3), Vec3::new(-0.37, 0.05, 0.11), Vec3::new(0.31, -0.29, 0.2)];
        for (target, from) in targets.into_iter().flat_map(|target| FROM.map(|from| (target, from))) {
            let [eye, target] = [target + from, target].map(|point| place.point(point));
            let direction = (target - eye).as_dvec3().normalize();
            let [enter, leave] = chord(&planes, eye.as_dvec3(), direction, 0.0);
            let s = leave - enter;
            let expected = (-absorption * s).exp();
            let bound = (absorption * s + 4.0) * 4.0 * U + absorption * 16.0 * 6.0 * U;
            for engine in engines() {
                let found = aimed(&scene, engine, eye, target).colour[0];
                let off = (found - expected).abs() / expected;
                let [off, bound] = [off / U, bound / U];
                assert!(
                    off <= bound,
                    "{off:.0}u, {bound:.0}u allowed: {place:?}, from {eye} to {target}, {engine:?}"
                );
            }
        }
    }
}

/// 47 and 48 of a ball, which is entered by one root and left by the other.
#[test]
fn case_47_absorption_of_a_ball_does_not_depend_on_where_it_lies() {
    let (radius, absorption) = (0.75_f32, 3.0);
    for offset in [0.0, 37.0, 1024.0, 16_384.0] {
        let place = Place { turned: true, offset };
        let center = place.point(Vec3::ZERO);
        let scene = scene(&format!(
            "[image]\nsize = [1, 1]\nbackground = 1\n[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nfov = 1\n\
             [material.glass]\nior = 1\nfresnel = false\nabsorption = {absorption}\n\
             [[sphere]]\ncenter = {:?}\nradius = {radius}\nmaterial = \"glass\"\n",
            center.to_array()
        ));
        for (across, from) in [0.0, 0.3, 0.6].into_iter().flat_map(|across| FROM.map(|from| (across, from))) {
            let target = Vec3::new(0.3, -0.2, 0.1).normalize() * across;
            let [eye, target] = [target + from, target].map(|point| place.point(point));
            let (origin, direction) = (eye.as_dvec3(), (target - eye).as_dvec3().normalize());
            let past = (center.as_dvec3() - origin).reject_from_normalized(direction).length();
            let s = 2.0 * (f64::from(radius).powi(2) - past * past).sqrt();
            let expected = (-absorption * s).exp();
            let bound = (absorption * s + 4.0) * 4.0 * U + absorption * 16.0 * 6.0 * U;
            for engine in engines() {
                let ray = aimed(&scene, engine, eye, target);
                let off = (ray.colour[0] - expected).abs() / expected;
                assert!(off <= bound, "{:.0}u off at {offset}, {engine:?}: {ray:?}", off / U);
            }
        }
    }
}

/// What a tree of rays through one solid says of pairs.
struct Pairs<'a> {
    planes: &'a [(DVec3, f64)],
    slack: f64,
    what: String,
}

impl Pairs<'_> {
    /// Whether a point is on an edge or a corner.
    fn is_shared(&self, point: [f64; 3]) -> bool {
        let touches =
            |(normal, distance): &&(DVec3, f64)| (normal.dot(point.into()) - distance).abs() <= self.slack;
        self.planes.iter().filter(touches).count() > 1
    }

    /// Whether the way from one point to another runs along a face.
    fn is_along_a_face(&self, from: [f64; 3], to: [f64; 3]) -> bool {
        let holds = |(normal, distance): &(DVec3, f64), point: [f64; 3]| {
            (normal.dot(point.into()) - distance).abs() <= self.slack
        };
        self.planes.iter().any(|plane| holds(plane, from) && holds(plane, to))
    }

    /// A ray that is inside meets a face from inside and a ray that is outside one from outside, or none. But on an edge of the
    /// outline two faces are met at one t: the one with the smaller id is seen, and the other, at no distance from it, is not;
    /// and a ray along a face is on either side of it.
    fn check(&self, ray: &RayTree, outside: bool) {
        let at_start = self.is_shared(ray.origin);
        let Some(hit) = &ray.hit else {
            assert!(outside || at_start, "inside: {}\n{ray:?}", self.what);
            return;
        };
        if self.is_along_a_face(ray.origin, hit.point) {
            return;
        }
        if hit.entering != outside {
            assert!(at_start || self.is_shared(hit.point), "outside is {outside}: {}\n{ray:?}", self.what);
            return;
        }
        if let Some(child) = &ray.reflect {
            self.check(child, outside);
        }
        if let Some(child) = &ray.refract {
            self.check(child, !outside);
        }
    }
}

/// Case 48: Glass silhouette edge: faces are entered and left in pairs, and no pixel is black. Light that is not absorbed, split
/// nowhere and the same all around is the same through any glass.
#[test]
fn case_48_glass_is_entered_and_left_in_pairs() {
    let (mut looks, mut trapped) = (0, 0);
    each_look(12, |solid, faces, place, lines| {
        let planes = solid.planes(place);
        let slack = 16.0 * U * f64::from(place.offset + 2.0);
        for ior in ["1", "1.25", "1.5", "0.7"] {
            let scene = solid.scene(faces, place, &format!("ior = {ior}"));
            for &[eye, target] in &lines {
                for engine in engines() {
                    let what = format!(
                        "{} of {faces:?}, {place:?}, ior {ior}, from {eye} to {target}, {engine:?}",
                        solid.name
                    );
                    let ray = aimed(&scene, engine, eye, target);
                    Pairs { planes: &planes, slack, what: what.clone() }.check(&ray, true);
                    let (mut deepest, mut absorbed) = (0, false);
                    each_ray(&ray, 0, &mut |ray, depth| {
                        deepest = deepest.max(depth);
                        absorbed |= ray.hit.as_ref().is_some_and(|hit| hit.attenuation != [1.0; 3]);
                    });
                    assert!(!absorbed, "{what}");
                    looks += 1;
                    if deepest == 64 {
                        // Reflected totally at every face that it comes to.
                        trapped += usize::from(engine == Engine::Reference);
                        assert_eq!(ray.colour, [0.0; 3], "{what}");
                    } else {
                        assert_eq!(ray.colour, [1.0; 3], "{what}");
                    }
                }
            }
        }
    });
    assert!(trapped * 5 * 20 < looks, "{trapped} of {looks} are trapped");
}
