//! How rays are aimed.

use super::body::Body;
use super::starts::{Start, Starts};
use crate::random::Random;
use glam::DVec3;

/// What rays are aimed at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Aim {
    /// Nothing.
    Random,
    /// Points of edges.
    Edge,
    /// Corners.
    Corner,
    /// Along the edges between two strips or two kinds of faces, at multiples of 1/2, 1/4, … 1/256.
    Seam,
    /// Along axes through corners; in a lattice, along axes and to points of it, all in small whole numbers and halves.
    Lattice,
    /// From within the plane of a face, at points of its edges and at its corners.
    Beside,
}

impl Aim {
    pub(super) const ALL: [Self; 6] =
        [Self::Random, Self::Edge, Self::Corner, Self::Seam, Self::Lattice, Self::Beside];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Random => "random",
            Self::Edge => "edges",
            Self::Corner => "corners",
            Self::Seam => "seams",
            Self::Lattice => "lattice",
            Self::Beside => "in planes",
        }
    }
}

/// Whether neighbours in a list are alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    /// All from near one start, sorted by direction.
    Coherent,
    /// As they come.
    Shuffled,
}

/// A ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shot {
    /// Origin, `t_min`, direction, `t_max`.
    pub(super) row: [f32; 8],
    /// It meets the surface once.
    pub(super) is_star: bool,
}

impl Shot {
    fn new(start: Start, direction: DVec3) -> Self {
        let [ox, oy, oz] = start.at.as_vec3().to_array();
        let [dx, dy, dz] = direction.as_vec3().to_array();
        Self { row: [ox, oy, oz, 0.0, dx, dy, dz, f32::INFINITY], is_star: start.is_star }
    }
}

/// Whether a body has starts for such rays from inside.
pub(super) fn is_possible(body: &Body, starts: &Starts, aim: Aim) -> bool {
    match aim {
        Aim::Beside => !starts.beside.is_empty(),
        Aim::Lattice => body.lattice.is_some() || !starts.lines.is_empty(),
        Aim::Random | Aim::Edge | Aim::Corner | Aim::Seam => true,
    }
}

/// Rays from inside.
pub(super) fn inside(
    body: &Body,
    starts: &Starts,
    (aim, order): (Aim, Order),
    count: usize,
    random: &mut Random,
) -> Vec<Shot> {
    let common = starts.any(random);
    let shots = (0..count).map(|at| {
        let start = if order == Order::Coherent { common } else { starts.any(random) };
        let start = start.nearby(random);
        let share = at as f64 / count as f64;
        let shot = match (aim, body.lattice) {
            (Aim::Lattice, Some(lattice)) => on_lattice(lattice, random),
            (Aim::Lattice, None) => {
                let line = starts.lines[random.below(starts.lines.len())].nearby(random);
                Shot::new(line.start, line.direction)
            }
            (Aim::Beside, _) => beside(body, starts, random),
            (Aim::Random, _) => Shot::new(start, random.direction()),
            _ => Shot::new(start, target(body, aim, share, random) - start.at),
        };
        of_any_length(shot, random)
    });
    in_order(shots.collect(), order)
}

/// Rays from outside, far enough that all of their line lies before them that the surface may be on.
pub(super) fn outside(body: &Body, aim: Aim, count: usize, random: &mut Random) -> Vec<Shot> {
    let shots = (0..count).map(|at| {
        let outward = random.direction();
        let start = body.middle + body.diameter * random.between(1.0, 4.0) * outward;
        let start = start.as_vec3().as_dvec3();
        let share = at as f64 / count as f64;
        let (start, direction) = match (aim, body.lattice) {
            (Aim::Lattice, Some((first, cell, cells))) => {
                let mut start = first + cell * half_steps(random, 0, 2 * cells);
                let (axis, sign) = (random.below(3), random.sign());
                start[axis] -= sign * cell * (2 * cells) as f64;
                (start, sign * DVec3::AXES[axis])
            }
            (Aim::Lattice, None) => {
                let mut start = body.corners[random.below(body.corners.len())];
                let (axis, sign) = (random.below(3), random.sign());
                start[axis] -= sign * 2.0 * body.diameter;
                (start.as_vec3().as_dvec3(), sign * DVec3::AXES[axis])
            }
            (Aim::Random, _) => {
                (start, body.middle + 0.5 * body.diameter * random.unit() * random.direction() - start)
            }
            _ => (start, target(body, aim, share, random) - start),
        };
        of_any_length(Shot::new(Start::exactly(start, false), direction), random)
    });
    shots.collect()
}

/// A point of the surface; `share` says how much of a list of rays came before.
fn target(body: &Body, aim: Aim, share: f64, random: &mut Random) -> DVec3 {
    let on = |edge: [usize; 2], share: f64| body.corners[edge[0]].lerp(body.corners[edge[1]], share);
    match aim {
        Aim::Corner | Aim::Lattice => body.corners[random.below(body.corners.len())],
        Aim::Seam => on(body.seams[(share * body.seams.len() as f64) as usize], random.dyadic()),
        Aim::Edge | Aim::Random | Aim::Beside => {
            let edge = body.edges[random.below(body.edges.len())];
            on(edge, random.share_of_an_edge())
        }
    }
}

/// From a point of a lattice, or from the middle of cells or of their sides, at least half a cell inside, along an axis or to
/// another such point. No rounding anywhere: f32 holds all these numbers. A cube is seen whole from there.
fn on_lattice((first, cell, cells): (DVec3, f64, usize), random: &mut Random) -> Shot {
    let at = half_steps(random, 1, 2 * cells - 1);
    let direction = if random.chance(0.5) {
        DVec3::AXES[random.below(3)] * random.sign()
    } else {
        let mut target = half_steps(random, 0, 2 * cells);
        target[random.below(3)] = if random.chance(0.5) { 0.0 } else { cells as f64 };
        target - at
    };
    Shot::new(Start::exactly(first + cell * at, true), direction)
}

fn half_steps(random: &mut Random, least: usize, most: usize) -> DVec3 {
    // Whole numbers more often than halves.
    let whole = random.chance(0.5);
    DVec3::from([(); 3].map(|()| {
        let halves = least + random.below(most - least + 1);
        let halves = if whole { (halves / 2 * 2).max(least.next_multiple_of(2)) } else { halves };
        halves as f64 / 2.0
    }))
}

/// In the plane of a face, as far as f32 can tell.
fn beside(body: &Body, starts: &Starts, random: &mut Random) -> Shot {
    let beside = starts.beside[random.below(starts.beside.len())].nearby(body, random);
    let corners = &body.faces[beside.face].corners;
    let from = random.below(corners.len());
    let share = if random.chance(0.3) { 0.0 } else { random.share_of_an_edge() };
    let target = corners[from].lerp(corners[(from + 1) % corners.len()], share);
    Shot::new(beside.start, target - beside.start.at)
}

/// Directions need not be unit vectors: one in four is made longer or shorter by a power of two.
fn of_any_length(shot: Shot, random: &mut Random) -> Shot {
    let factor = if random.chance(0.25) { random.between(-20.0, 20.0).round().exp2() } else { 1.0 };
    let mut shot = shot;
    for component in &mut shot.row[4..7] {
        *component *= factor as f32;
    }
    shot
}

fn in_order(mut shots: Vec<Shot>, order: Order) -> Vec<Shot> {
    if order == Order::Coherent {
        shots.sort_by_key(|shot| {
            let [_, _, _, _, x, y, z, _] = shot.row;
            let size = x.abs().max(y.abs()).max(z.abs());
            let fastest = [x, y, z].iter().position(|component| component.abs() == size);
            let is_negative = [x, y, z].map(|component| component < 0.0);
            // Slopes within half of each other may walk together.
            (fastest, is_negative, [x, y, z].map(|component| (component / size * 2.0).floor() as i32))
        });
    }
    shots
}
