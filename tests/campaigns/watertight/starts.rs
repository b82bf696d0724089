//! Where rays start: at points that are certainly inside.

use super::body::Body;
use super::random::Random;
use glam::DVec3;

/// A point that f32 holds.
#[derive(Clone, Copy)]
pub(super) struct Start {
    pub(super) at: DVec3,
    /// Every ray from here meets the surface once.
    pub(super) is_star: bool,
}

/// A ray along an axis that goes exactly through a corner.
#[derive(Clone, Copy)]
pub(super) struct Line {
    pub(super) start: Start,
    pub(super) direction: DVec3,
}

/// Of one body.
pub(super) struct Starts {
    /// By thirds: near a point in the middle, anywhere, near a wall.
    pub(super) points: Vec<Start>,
    /// None of a lattice, whose points are its own.
    pub(super) lines: Vec<Line>,
}

const POINTS: usize = 24;
const LINES: usize = 64;

impl Starts {
    pub(super) fn inside(body: &Body, random: &mut Random) -> Self {
        let mut points: Vec<Start> = body.middles.iter().filter_map(|&middle| start(body, middle)).collect();
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
                start(body, point)
            });
            points.extend(found);
        }
        let lines = if body.lattice.is_some() { Vec::new() } else { lines(body, random) };
        Self { points, lines }
    }

    pub(super) fn any(&self, random: &mut Random) -> Start {
        self.points[random.below(self.points.len())]
    }
}

fn start(body: &Body, point: DVec3) -> Option<Start> {
    let at = point.as_vec3().as_dvec3();
    body.is_certainly_inside(at).then(|| Start { at, is_star: body.is_star_shaped_about(at) })
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
        let start = start(body, corner - direction * (body.diameter * random.between(-12.0, -1.0).exp2()))?;
        Some(Line { start, direction })
    };
    // To find out what is inside takes as long as there are faces.
    let count = LINES.min(1 + 1_000_000 / body.faces.len());
    (0..4 * count).filter_map(|_| guess(random)).take(count).collect()
}
