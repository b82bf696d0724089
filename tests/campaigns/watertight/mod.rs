//! No ray gets out of a closed surface, wherever it is aimed, and none meets a surface twice where it is once.
//!
//! Random rays do not find cracks; aimed ones find them at once (Schirra, "How Reliable Are Practical Point-in-Polygon
//! Strategies?", 2008). So rays go to edges, to corners, along seams and through lattices, from points that are certainly
//! inside: `flat` and `body` prove that with f64 and bounds on what f32 may be wrong about, `starts` finds them, `aims` shoots.
//! `every_face` tries the faces one by one, to count all hits of a ray and to hold the hierarchy to the nearest; `export` writes
//! surfaces of triangles and their rays for other tracers.

mod aims;
mod angular;
mod body;
mod bunny;
mod every_face;
mod export;
mod flat;
mod judge;
mod round;
mod solid;
mod solids;
mod starts;
mod tally;
mod tracing;

use crate::random::Random;
use aims::{Aim, Order, Shot};
use body::{Body, Pose};
use export::Export;
use judge::{Judge, Sample};
use solids::KINDS;
use starts::Starts;
use std::num::NonZeroUsize;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use tally::Tally;
use tracing::{Engine, Target};
use wavelane::lanes::Width;

/// How far surfaces lie from the origin, in their shortest edges.
const OFFSETS: [f64; 6] = [0.0, 1.0, 16.0, 256.0, 4096.0, 65536.0];
/// Rays from inside a surface before another is made: they, and what they hit, take up memory.
const MOST_RAYS_OF_A_BODY: u64 = 1 << 19;
/// Rays of a surface that is not a lattice go through few corners along axes, so more of them show nothing new.
const MOST_ON_LINES: u64 = 1 << 10;
/// Of so many pairs of ray and face, about, are the rays of a body that are tried against every face.
const PAIRS: usize = 400_000;
/// Of one aim, from one side.
const MOST_COUNTED: usize = 512;
/// The reference gets one ray in so many, and of those tried against every face one in so many; no multiple of an even count.
const REFERENCE_SHARE: usize = 64;
const REFERENCE_STEP: usize = 7;

/// A surface of each kind at each offset, over and over, each of another shape and size.
struct Campaign {
    kinds: usize,
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
    let failures = [&wavefront, &reference].map(|tally| tally.sum().failures());
    assert_eq!(failures, [0, 0], "among them:\n{}{}", wavefront.examples(), reference.examples());
    let sum = wavefront.sum();
    assert!(
        sum.in_packets > sum.rays / 10 && sum.in_packets < sum.rays * 9 / 10,
        "both ways to walk are walked"
    );
    assert!(sum.star > sum.counted / 5, "much of what is counted is counted exactly");
}

impl Campaign {
    fn new(rays: u64) -> Self {
        let kinds = solids::count();
        let round = (kinds * OFFSETS.len()) as u64;
        let rounds = rays.div_ceil(round * MOST_RAYS_OF_A_BODY);
        let bodies = rounds * round;
        Self { kinds, rays_of_a_body: rays.div_ceil(bodies), bodies }
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
        let kind = number as usize % self.kinds;
        let offset = OFFSETS[number as usize / self.kinds % OFFSETS.len()];
        let pose = Pose { size: random.between(-10.0, 10.0).round().exp2(), offset };
        let (name, make) = KINDS[kind];
        let body = Body::place(&format!("{name} {number}"), &make(random), pose, random);
        let starts = Starts::inside(&body, random);
        let export = Export::new(&body, number);
        let width = Width::ALL[number as usize % Width::ALL.len()];
        let [mut wavefront, mut reference] =
            [Engine::Wavefront(width), Engine::Reference].map(|engine| Judge {
                body: &body,
                kind,
                engine,
                target: Target::new(&body.scene, engine, pool),
                pool,
                tally: Tally::new(),
            });
        let counted = (PAIRS / body.faces.len() / (2 * Aim::ALL.len())).clamp(1, MOST_COUNTED);
        let mut samples = Vec::new();
        let aims: Vec<Aim> =
            Aim::ALL.into_iter().filter(|&aim| aims::is_possible(&body, &starts, aim)).collect();
        for &aim in &aims {
            let count = self.rays_of(&body, aim, aims.len() as u64).div_ceil(2) as usize;
            let mut shots = aims::inside(&body, &starts, (aim, Order::Coherent), count, random);
            shots.extend(aims::inside(&body, &starts, (aim, Order::Shuffled), count, random));
            if let Some(export) = &export {
                export.rays(aim, &shots);
            }
            wavefront.all_are_caught(aim, &shots);
            reference.all_are_caught(aim, &thinned(&shots, shots.len() / REFERENCE_SHARE));
            let inside = thinned(&shots, counted).into_iter();
            samples.extend(inside.map(|shot| Sample { aim, shot, is_from_inside: true }));
            let outside = aims::outside(&body, aim, counted, random).into_iter();
            samples.extend(outside.map(|shot| Sample { aim, shot, is_from_inside: false }));
        }
        wavefront.each_is_counted(&samples);
        let few: Vec<Sample> = samples.iter().step_by(REFERENCE_STEP).copied().collect();
        reference.each_is_counted(&few);
        [wavefront.tally, reference.tally]
    }

    /// In a lattice all aims get as many; elsewhere there are few lines.
    fn rays_of(&self, body: &Body, aim: Aim, aims: u64) -> u64 {
        let even = self.rays_of_a_body / aims;
        let on_lines = if body.lattice.is_some() { even } else { even.min(MOST_ON_LINES) };
        match aim {
            Aim::Lattice => on_lines,
            _ => (self.rays_of_a_body - on_lines).div_ceil(aims - 1),
        }
    }
}

/// So many of them, evenly taken.
fn thinned(shots: &[Shot], count: usize) -> Vec<Shot> {
    shots.iter().step_by((shots.len() / count.max(1)).max(1)).take(count).copied().collect()
}
