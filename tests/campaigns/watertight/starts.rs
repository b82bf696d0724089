//! Where rays start: at points that are certainly inside.

use super::body::Body;
use super::flat::UNIT_ROUNDOFF;
use crate::random::Random;
use glam::DVec3;

/// A point that f32 holds, and the room around it.
#[derive(Clone, Copy)]
pub(super) struct Start {
    pub(super) at: DVec3,
    /// All within this is inside too; 0 where f32 could not tell a start there.
    reach: f64,
    /// Every ray from within reach meets the surface once.
    pub(super) is_star: bool,
}

/// A ray along an axis that goes exactly through a corner.
#[derive(Clone, Copy)]
pub(super) struct Line {
    pub(super) start: Start,
    pub(super) direction: DVec3,
}

/// A start in the plane of a face, beside it.
#[derive(Clone, Copy)]
pub(super) struct Beside {
    pub(super) start: Start,
    pub(super) face: usize,
}

/// Of one body.
pub(super) struct Starts {
    /// By thirds: near a point in the middle, anywhere, near a wall.
    pub(super) points: Vec<Start>,
    /// None of a lattice, whose points are its own.
    pub(super) lines: Vec<Line>,
    /// None of a convex body, and so of none of the lattices.
    pub(super) beside: Vec<Beside>,
}

const POINTS: usize = 24;
const LINES: usize = 64;
const BESIDE: usize = 64;

impl Starts {
    pub(super) fn inside(body: &Body, random: &mut Random) -> Self {
        let mut points: Vec<Start> =
            body.middles.iter().filter_map(|&middle| Start::new(body, middle)).collect();
        assert!(!points.is_empty(), "no point in the middle is certainly inside, {}", body.name);
        for at in points.len()..POINTS {
            let middle = body.middles[random.below(body.middles.len())];
            // Not every guess is inside; where few are, there will be fewer starts.
            let found = (0..8).find_map(|_| {
                let wall = on_a_wall(body, random);
                let point = match at % 3 {
                    0 => middle.lerp(wall.0, 0.05 * random.unit()),
                    1 => middle.lerp(wall.0, random.unit()),
                    _ => wall.0 - wall.1 * (body.diameter * random.between(-20.0, -2.0).exp2()),
                };
                Start::new(body, point)
            });
            points.extend(found);
        }
        let lines = if body.lattice.is_some() { Vec::new() } else { lines(body, random) };
        let beside = if body.lattice.is_some() { Vec::new() } else { beside(body, random) };
        Self { points, lines, beside }
    }

    pub(super) fn any(&self, random: &mut Random) -> Start {
        self.points[random.below(self.points.len())]
    }
}

impl Start {
    /// Of a lattice, where there is no doubt.
    pub(super) fn exactly(at: DVec3, is_star: bool) -> Self {
        Self { at, reach: 0.0, is_star }
    }

    fn new(body: &Body, point: DVec3) -> Option<Self> {
        let at = point.as_vec3().as_dvec3();
        let room = body.room_around(at)?;
        // The other half is for rounding.
        let reach = 0.5 * room;
        let is_in_reach = at.abs().max_element() * 4.0 * UNIT_ROUNDOFF < reach;
        let reach = if is_in_reach { reach } else { 0.0 };
        // Where not all of it sees the whole surface, a part may.
        let parts = [reach, reach / 16.0, 0.0];
        let star = parts.into_iter().find(|&reach| body.is_star_shaped_about(at, reach));
        Some(Self { at, reach: star.unwrap_or(reach), is_star: star.is_some() })
    }

    /// Another start within reach.
    pub(super) fn nearby(self, random: &mut Random) -> Self {
        let at = self.at + self.reach * random.unit() * random.direction();
        if self.reach == 0.0 { self } else { Self { at: at.as_vec3().as_dvec3(), ..self } }
    }
}

impl Beside {
    /// Another start within reach, in the same plane.
    pub(super) fn nearby(self, body: &Body, random: &mut Random) -> Self {
        let along = body.faces[self.face].normal.cross(random.direction());
        let at = self.start.at + self.start.reach * random.unit() * along;
        Self { start: Start { at: at.as_vec3().as_dvec3(), ..self.start }, ..self }
    }
}

impl Line {
    /// Another start within reach, on the same line.
    pub(super) fn nearby(self, random: &mut Random) -> Self {
        let at = self.start.at + self.direction * (self.start.reach * random.unit());
        Self { start: Start { at: at.as_vec3().as_dvec3(), ..self.start }, ..self }
    }
}

/// A point of a face, and the face's normal.
fn on_a_wall(body: &Body, random: &mut Random) -> (DVec3, DVec3) {
    let face = &body.faces[random.below(body.faces.len())];
    let first = 1 + random.below(face.corners.len() - 2);
    let [a, b, c] = [0, first, first + 1].map(|corner| face.corners[corner]);
    let (along, across) = (random.unit(), random.unit());
    (a.lerp(b.lerp(c, across), along.sqrt()), face.normal)
}

/// Along axes from inside through corners.
fn lines(body: &Body, random: &mut Random) -> Vec<Line> {
    let guess = |random: &mut Random| {
        let corner = body.corners[random.below(body.corners.len())];
        let direction = [DVec3::X, DVec3::Y, DVec3::Z][random.below(3)] * random.sign();
        let start =
            Start::new(body, corner - direction * (body.diameter * random.between(-12.0, -1.0).exp2()))?;
        Some(Line { start, direction })
    };
    let count = affordable(body, LINES);
    (0..4 * count).filter_map(|_| guess(random)).take(count).collect()
}

/// In planes of faces, not much farther from them than they are large.
fn beside(body: &Body, random: &mut Random) -> Vec<Beside> {
    let guess = |random: &mut Random| {
        let number = random.below(body.faces.len());
        let face = &body.faces[number];
        let [one, other] = [0, 1].map(|_| face.corners[random.below(face.corners.len())]);
        let away = face.normal.cross(random.direction()).normalize_or_zero();
        let away = away * face.corners[0].distance(face.corners[1]) * random.between(-6.0, 2.0).exp2();
        let start = Start::new(body, one.lerp(other, random.unit()) + away)?;
        Some(Beside { start, face: number })
    };
    let count = affordable(body, BESIDE);
    (0..8 * count).filter_map(|_| guess(random)).take(count).collect()
}

/// To find out what is inside takes as long as there are faces.
fn affordable(body: &Body, most: usize) -> usize {
    most.min(1 + 1_000_000 / body.faces.len())
}
