//! What is asked of the engines about rays: what they meet first, and whether anything is in their way.

use super::aims::Shot;
use std::sync::atomic::AtomicBool;
use wavelane::lanes::Width;
use wavelane::prepare::Prepared;
use wavelane::rays::RaySet;
use wavelane::reference::Tracer;
use wavelane::scene::Scene;
use wavelane::trace::{Hits, Query, RayColumns, ReferenceRun, Run};

/// An engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Engine {
    Wavefront(Width),
    Reference,
}

/// A scene, ready for an engine, and a pool of one thread to trace on.
pub(super) struct Target<'a> {
    ready: Ready<'a>,
    pool: &'a rayon::ThreadPool,
}

enum Ready<'a> {
    Wavefront(Box<Prepared<'a>>, Width),
    Reference(Box<Tracer<'a>>),
}

/// What rays meet.
pub(super) struct Traced {
    pub(super) closest: Hits,
    /// Whether anything is in the way.
    pub(super) is_occluded: Vec<bool>,
    pub(super) in_packets: u64,
}

/// What a ray meets first: the id of a face, and t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Met {
    pub(super) id: u32,
    pub(super) t: f32,
}

impl Traced {
    pub(super) fn found(&self, row: usize) -> Met {
        Met { id: self.closest.id[row], t: self.closest.t[row] }
    }
}

pub(super) fn ray_set(shots: &[Shot]) -> RaySet {
    RaySet { rows: shots.iter().map(|shot| shot.row).collect(), ..RaySet::default() }
}

impl<'a> Target<'a> {
    pub(super) fn new(scene: &'a Scene, engine: Engine, pool: &'a rayon::ThreadPool) -> Self {
        static STOP: AtomicBool = AtomicBool::new(false);
        let ready = match engine {
            Engine::Wavefront(width) => {
                Ready::Wavefront(Box::new(Prepared::new(scene).expect("there are few primitives")), width)
            }
            Engine::Reference => Ready::Reference(Box::new(Tracer::new(scene, &STOP))),
        };
        Self { ready, pool }
    }

    pub(super) fn closest(&self, rays: &RaySet) -> Hits {
        match &self.ready {
            Ready::Wavefront(prepared, width) => {
                let columns = RayColumns::new(prepared, rays);
                let mut run = Run::new(prepared, &columns, Query::Closest);
                run.pass(*width, self.pool);
                run.hits()
            }
            Ready::Reference(tracer) => by_reference(tracer, rays, Query::Closest, self.pool),
        }
    }

    /// Both queries.
    pub(super) fn trace(&self, rays: &RaySet) -> Traced {
        let is_occluded = |any: &Hits| any.t.iter().map(|t| t.is_finite()).collect();
        match &self.ready {
            Ready::Wavefront(prepared, width) => {
                let columns = RayColumns::new(prepared, rays);
                let [mut closest, mut any] =
                    [Query::Closest, Query::Any].map(|query| Run::new(prepared, &columns, query));
                closest.pass(*width, self.pool);
                any.pass(*width, self.pool);
                Traced {
                    closest: closest.hits(),
                    is_occluded: is_occluded(&any.hits()),
                    in_packets: closest.in_packets(),
                }
            }
            Ready::Reference(tracer) => Traced {
                closest: by_reference(tracer, rays, Query::Closest, self.pool),
                is_occluded: is_occluded(&by_reference(tracer, rays, Query::Any, self.pool)),
                in_packets: 0,
            },
        }
    }
}

fn by_reference(tracer: &Tracer<'_>, rays: &RaySet, query: Query, pool: &rayon::ThreadPool) -> Hits {
    let mut run = ReferenceRun::new(tracer, rays, query);
    run.pass(pool);
    run.hits().clone()
}
