//! No ray gets out of a closed surface, wherever it is aimed, and none meets a surface twice where it is once.
//!
//! Random rays do not find cracks; aimed ones find them at once (Schirra, "How Reliable Are Practical Point-in-Polygon
//! Strategies?", 2008). So rays go to edges, to corners, along seams and through lattices, from points that are certainly
//! inside: `flat` and `body` prove that with f64 and bounds on what f32 may be wrong about, `starts` finds them, `aims` shoots.
//! `every_face` tries the faces one by one, to count all hits of a ray and to hold the hierarchy to the nearest.

mod aims;
mod angular;
mod body;
mod every_face;
mod flat;
mod random;
mod round;
mod solid;
mod solids;
mod starts;
mod tally;
mod tracing;

use aims::{Aim, Order, Shot};
use body::{Body, Pose};
use every_face::{is_nearest, met};
use random::Random;
use solids::KINDS;
use starts::Starts;
use std::num::NonZeroUsize;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use tally::{Cell, Tally};
use tracing::{Engine, Met, Target, ray_set};
use wavelane::lanes::Width;
use wavelane::trace::Hits;

/// How far surfaces lie from the origin, in their shortest edges.
const OFFSETS: [f64; 6] = [0.0, 1.0, 16.0, 256.0, 4096.0, 65536.0];
/// Rays from inside a surface before another is made: they, and what they hit, take up memory.
const MOST_RAYS_OF_A_BODY: u64 = 1 << 19;
/// Rays of a surface that is not a lattice go through few corners along axes, so more of them show nothing new.
const MOST_ON_LINES: u64 = 1 << 10;
/// Of so many pairs of ray and face, at most, those are rays of a body, an aim and a side that are tried against every face.
const PAIRS: usize = 20_000;
const MOST_COUNTED: usize = 512;
/// The reference gets one ray in so many.
const REFERENCE_SHARE: usize = 64;

/// A surface of each kind at each offset, over and over, each of another shape and size.
struct Campaign {
    rays_of_a_body: u64,
    bodies: u64,
}

/// By the wavefront engine, and by the reference.
type Tallies = [Tally; 2];

#[test]
fn no_ray_gets_out_of_a_closed_surface() {
    let campaign = Campaign::new(crate::ray_budget(10_000_000));
    let [wavefront, reference] = campaign.run();
    for (name, tally) in [("wavefront", &wavefront), ("reference", &reference)] {
        println!("\n{name}, {} bodies:\n\n{tally}", campaign.bodies);
    }
    for tally in [&wavefront, &reference] {
        let sum = tally.sum();
        assert_eq!(sum.failures(), 0, "among them:\n{}", tally.examples());
    }
    let sum = wavefront.sum();
    assert!(
        sum.in_packets > sum.rays / 10 && sum.in_packets < sum.rays * 9 / 10,
        "both ways to walk are walked"
    );
    assert!(sum.star > sum.counted / 5, "much of what is counted is counted exactly");
}

impl Campaign {
    fn new(rays: u64) -> Self {
        let round = (KINDS.len() * OFFSETS.len()) as u64;
        let rounds = rays.div_ceil(round * MOST_RAYS_OF_A_BODY);
        let bodies = rounds * round;
        Self { rays_of_a_body: rays.div_ceil(bodies), bodies }
    }

    /// Each thread takes body after body.
    fn run(&self) -> Tallies {
        let threads = thread::available_parallelism().map_or(1, NonZeroUsize::get);
        let (next, sums) = (AtomicU64::new(0), Mutex::new([Tally::new(), Tally::new()]));
        thread::scope(|scope| {
            for _ in 0..threads {
                scope.spawn(|| {
                    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
                    loop {
                        let number = next.fetch_add(1, Ordering::Relaxed);
                        if number >= self.bodies {
                            break;
                        }
                        let found = pool.install(|| self.shoot_at(number, &pool));
                        for (sum, found) in sums.lock().unwrap().iter_mut().zip(found) {
                            *sum += found;
                        }
                    }
                });
            }
        });
        sums.into_inner().unwrap()
    }

    fn shoot_at(&self, number: u64, pool: &rayon::ThreadPool) -> Tallies {
        let random = &mut Random::new(&[number]);
        let kind = number as usize % KINDS.len();
        let offset = OFFSETS[number as usize / KINDS.len() % OFFSETS.len()];
        let pose = Pose { size: random.between(-10.0, 10.0).round().exp2(), offset };
        let (name, make) = KINDS[kind];
        let body = Body::place(&format!("{name} {number}"), &make(random), pose, random);
        let starts = Starts::inside(&body, random);
        let mut tallies = [Tally::new(), Tally::new()];
        let mut wavefront = Target::new(&body.scene, Engine::Wavefront(Width::BEST), pool);
        let reference = Target::new(&body.scene, Engine::Reference, pool);
        for (at, aim) in (0..).zip(Aim::ALL) {
            let width = Width::ALL[(number as usize + at) % Width::ALL.len()];
            wavefront.set_width(width);
            let count = self.rays_of(&body, aim).div_ceil(2) as usize;
            let mut shots = aims::inside(&body, &starts, (aim, Order::Coherent), count, random);
            shots.extend(aims::inside(&body, &starts, (aim, Order::Shuffled), count, random));
            let counted = (PAIRS / body.faces.len()).clamp(1, MOST_COUNTED);
            let lines = aims::outside(&body, aim, counted, random);
            let few = thinned(&shots, counted);
            let fewer = thinned(&shots, shots.len() / REFERENCE_SHARE);
            let engines = [
                (&wavefront, Engine::Wavefront(width), &shots, counted),
                (&reference, Engine::Reference, &fewer, counted.div_ceil(8)),
            ];
            for (tally, (target, engine, shots, counted)) in tallies.iter_mut().zip(engines) {
                let mut judge = Judge { body: &body, target, engine, pool, cell: Cell::default(), tally };
                judge.all_are_caught(shots);
                judge.each_is_counted(&few[..counted.min(few.len())], 1);
                judge.each_is_counted(&lines[..counted.min(lines.len())], 0);
                let cell = judge.cell;
                tally.add(kind, aim, cell);
            }
        }
        tallies
    }

    /// In a lattice all aims get as many; elsewhere there are few lines.
    fn rays_of(&self, body: &Body, aim: Aim) -> u64 {
        let even = self.rays_of_a_body / Aim::ALL.len() as u64;
        let on_lines = if body.lattice.is_some() { even } else { even.min(MOST_ON_LINES) };
        match aim {
            Aim::Lattice => on_lines,
            _ => (self.rays_of_a_body - on_lines).div_ceil(Aim::ALL.len() as u64 - 1),
        }
    }
}

/// So many of them, evenly taken.
fn thinned(shots: &[Shot], count: usize) -> Vec<Shot> {
    shots.iter().step_by((shots.len() / count.max(1)).max(1)).take(count).copied().collect()
}

/// Counts what an engine does to rays.
struct Judge<'a> {
    body: &'a Body,
    target: &'a Target<'a>,
    engine: Engine,
    pool: &'a rayon::ThreadPool,
    cell: Cell,
    tally: &'a mut Tally,
}

impl Judge<'_> {
    /// From inside.
    fn all_are_caught(&mut self, shots: &[Shot]) {
        let traced = self.target.trace(&ray_set(shots));
        self.cell.rays += shots.len() as u64;
        self.cell.in_packets += traced.in_packets;
        for (row, shot) in shots.iter().enumerate() {
            let found = traced.found(row);
            if found.id == Hits::MISS {
                self.cell.leaks += 1;
                self.report("leak", shot, found, &[]);
            }
            if !traced.is_occluded[row] {
                self.cell.not_occluded += 1;
                self.report("not occluded", shot, found, &[]);
            }
        }
    }

    /// How often rays meet the surface has to leave this remainder when halved, and what the hierarchy finds has to be the nearest.
    fn each_is_counted(&mut self, shots: &[Shot], parity: usize) {
        let traced = self.target.trace(&ray_set(shots));
        let all = met(self.body, shots, self.engine, self.pool);
        self.cell.counted += shots.len() as u64;
        for (row, (shot, met)) in shots.iter().zip(&all).enumerate() {
            let found = traced.found(row);
            self.cell.star += u64::from(shot.is_star);
            if shot.is_star && met.len() > 1 {
                self.cell.doubles += 1;
                self.report("more than once", shot, found, met);
            }
            if met.len() % 2 != parity {
                self.cell.wrong_parity += 1;
                self.report("wrong parity", shot, found, met);
            }
            let is_right = is_nearest(self.body, shot, (found, met), self.engine, self.pool);
            if !is_right || traced.is_occluded[row] == met.is_empty() {
                self.cell.lost += 1;
                self.report("lost", shot, found, met);
            }
        }
    }

    fn report(&mut self, what: &'static str, shot: &Shot, found: Met, met: &[Met]) {
        let Self { body, engine, .. } = self;
        self.tally.add_example(what, || {
            format!("{:?} finds {found:?}, {engine:?}; each face alone: {met:?}; {}", shot.row, body.name)
        });
    }
}
