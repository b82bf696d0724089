//! Traces the rays of a case with every engine, width and query, in packets and alone, and says what was not as wanted.

use super::case::{Aimed, Case, Faces, REFERENCE_ULPS, Shape, Wanted, Within, scene};
use crate::support::Folder;
use std::cell::OnceCell;
use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter};
use std::sync::atomic::AtomicBool;
use wavelane::lanes::Width;
use wavelane::load::{Place, load};
use wavelane::prepare::Prepared;
use wavelane::rays::RaySet;
use wavelane::reference::Tracer;
use wavelane::scene::Scene;
use wavelane::trace::{Hits, Query, RayColumns, ReferenceRun, Run};

/// Rays of a packet, and so of a run of rows in which all walk together or each alone.
const RUN: usize = 64;
/// As many rays of a case, at most, are traced as packets.
const MOST_PACKETS: usize = 512;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Engine {
    Reference,
    Wavefront(Width),
}

/// In which company a ray is traced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Company {
    /// As the case lists them.
    Listed,
    /// Beside a ray the other way, so that the two cannot walk together.
    Alone,
    /// As 64 equal rays, which do.
    Packet,
}

/// What one engine says of one ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Answer {
    /// +∞ on a miss.
    pub(super) t: f32,
    pub(super) id: u32,
    pub(super) occluded: bool,
}

impl Display for Answer {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.id {
            Hits::MISS => write!(f, "closest: a miss")?,
            id => write!(f, "closest: {id} at t = {:?}", self.t)?,
        }
        write!(f, "; any: {}", if self.occluded { "occluded" } else { "a miss" })
    }
}

impl Answer {
    pub(super) fn has_same_bits(self, other: Self) -> bool {
        (self.t.to_bits(), self.id, self.occluded) == (other.t.to_bits(), other.id, other.occluded)
    }
}

impl Case {
    /// Panics with all that is wrong.
    pub(super) fn check(&self) {
        let (shapes, rays) = ((self.shapes)(), (self.rays)());
        assert!(!rays.is_empty(), "case {} has rays", self.number);
        let scene = scene(&shapes);
        let engines = Engines::new(&scene, 1);
        let mut wrong = Complaints::default();
        for engine in ENGINES {
            let listed = engines.answers(&rays, engine, Company::Listed);
            for company in [Company::Listed, Company::Alone, Company::Packet] {
                let step = if company == Company::Packet { rays.len().div_ceil(MOST_PACKETS) } else { 1 };
                let asked: Vec<Aimed> = rays.iter().step_by(step).cloned().collect();
                let found = engines.answers(&asked, engine, company);
                for (index, found) in (0..rays.len()).step_by(step).zip(found) {
                    let (ray, listed) = (&rays[index], listed[index]);
                    let what = judge(ray, &shapes, engine, found).or_else(|| {
                        (!found.has_same_bits(listed)).then(|| format!("as among the others: {listed}"))
                    });
                    if let Some(what) = what {
                        wrong.add(index, ray, (engine, company), (found.to_string(), what));
                    }
                }
            }
        }
        wrong_faces(&scene, &rays, &mut wrong);
        wrong_widths(&engines, &rays, &mut wrong);
        assert!(wrong.0.is_empty(), "case {}, {}: {wrong}", self.number, self.name);
    }
}

/// What was found, which rays and engines found it, and what was wanted.
#[derive(Default)]
struct Complaints(BTreeMap<(usize, String), String>);

impl Complaints {
    fn add(
        &mut self,
        index: usize,
        ray: &Aimed,
        (engine, company): (Engine, Company),
        (found, wanted): (String, String),
    ) {
        let departure = ray.departure.map(|departure| format!(" leaving {departure:?}")).unwrap_or_default();
        let what =
            format!("ray {index} {:?}{departure}\n    found {found}\n    wanted {wanted}\n    by", ray.row);
        let by = self.0.entry((index, what)).or_default();
        *by += &format!(" {engine:?} {company:?},");
    }
}

impl Display for Complaints {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        const MOST: usize = 12;
        write!(f, "{} wrong", self.0.len())?;
        for ((_, what), by) in self.0.iter().take(MOST) {
            write!(f, "\n  {what}{}", by.trim_end_matches(','))?;
        }
        Ok(())
    }
}

pub(super) const ENGINES: [Engine; 5] = [
    Engine::Reference,
    Engine::Wavefront(Width::One),
    Engine::Wavefront(Width::Four),
    Engine::Wavefront(Width::Eight),
    Engine::Wavefront(Width::Sixteen),
];

/// A scene made ready for whichever engine is asked.
pub(super) struct Engines<'a> {
    scene: &'a Scene,
    tracer: OnceCell<Tracer<'a>>,
    prepared: OnceCell<Prepared<'a>>,
    pool: rayon::ThreadPool,
}

impl<'a> Engines<'a> {
    pub(super) fn new(scene: &'a Scene, threads: usize) -> Self {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        Self { scene, tracer: OnceCell::new(), prepared: OnceCell::new(), pool }
    }

    /// What an engine says, by rows.
    pub(super) fn hits(&self, rays: &RaySet, engine: Engine, query: Query) -> Hits {
        static NEVER: AtomicBool = AtomicBool::new(false);
        match engine {
            Engine::Reference => {
                let tracer = self.tracer.get_or_init(|| Tracer::new(self.scene, &NEVER));
                let mut run = ReferenceRun::new(tracer, rays, query);
                run.pass(&self.pool);
                run.hits().clone()
            }
            Engine::Wavefront(width) => {
                let prepared =
                    self.prepared.get_or_init(|| self.pool.install(|| Prepared::new(self.scene)).unwrap());
                let columns = RayColumns::new(prepared, rays);
                let mut run = Run::new(prepared, &columns, query);
                run.pass(width, &self.pool);
                run.hits()
            }
        }
    }

    /// What an engine says of rays by both queries. Of 64 equal rays all have to say the same.
    pub(super) fn answers(&self, rays: &[Aimed], engine: Engine, company: Company) -> Vec<Answer> {
        let set = rows(rays, company);
        let stride = set.len() / rays.len();
        let [closest, any] = [Query::Closest, Query::Any].map(|query| self.hits(&set, engine, query));
        let answer =
            |row: usize| Answer { t: closest.t[row], id: closest.id[row], occluded: any.t[row] == 0.0 };
        let of_ray = |index: usize| {
            let first = answer(index * stride);
            if company == Company::Packet {
                let mut all = (index * stride..(index + 1) * stride).map(answer);
                assert!(all.all(|other| other.has_same_bits(first)), "64 equal rays, {:?}", rays[index]);
            }
            first
        };
        (0..rays.len()).map(of_ray).collect()
    }
}

/// As many rows for each ray as its company takes, the ray first.
fn rows(rays: &[Aimed], company: Company) -> RaySet {
    let departing = rays.iter().filter(|ray| ray.departure.is_some()).count();
    assert!(departing == 0 || departing == rays.len(), "all of a case's rays leave a primitive, or none");
    let (copies, opposites) = match company {
        Company::Listed => (1, 0),
        Company::Alone => (1, 1),
        Company::Packet => (RUN, 0),
    };
    let mut set = RaySet::default();
    for ray in rays {
        let [ox, oy, oz, t_min, dx, dy, dz, t_max] = ray.row;
        let opposite = [ox, oy, oz, t_min, -dx, -dy, -dz, t_max];
        set.rows.extend(std::iter::repeat_n(ray.row, copies));
        set.rows.extend(std::iter::repeat_n(opposite, opposites));
        let starts = ray.start().into_iter();
        set.starts.extend(starts.flat_map(|start| std::iter::repeat_n(start, copies + opposites)));
    }
    set
}

/// What was wanted, if something else was found.
fn judge(ray: &Aimed, shapes: &[Shape], engine: Engine, found: Answer) -> Option<String> {
    if found.occluded != (found.id != Hits::MISS) {
        return Some("both queries to agree".to_owned());
    }
    let is_near = |t: f64, within: Within| {
        let true_t = t as f32;
        let ulp = f64::from(true_t) - f64::from(true_t.next_down());
        let (found_t, off) = (f64::from(found.t), (f64::from(found.t) - t).abs());
        let [low, high] = match (engine, within) {
            (_, Within::Absolute(most)) => [t - most, t + most],
            (Engine::Reference, _) => [t - REFERENCE_ULPS * ulp, t + REFERENCE_ULPS * ulp],
            (_, Within::Ulps(most)) => [t - most * ulp, t + most * ulp],
            (_, Within::Roundings(most)) => {
                let bound = most * shapes[found.id as usize].t_per_rounding(ray);
                [t - bound, t + bound]
            }
            (_, Within::Between(low, high)) => [low, high],
        };
        let is_within = found_t >= low && found_t <= high;
        is_within
            .then_some(())
            .ok_or_else(|| format!("t = {t:?}, {low:?} to {high:?}; off by {off:.3e}, {:.1} ulp", off / ulp))
    };
    let is_hit = found.id != Hits::MISS;
    match ray.wanted {
        Wanted::Anything => None,
        Wanted::Miss => is_hit.then(|| "a miss".to_owned()),
        Wanted::Something => (!is_hit).then(|| "a hit of something".to_owned()),
        Wanted::SomethingAt { t, .. } if !is_hit => Some(format!("a hit of something at t = {t:?}")),
        Wanted::SomethingAt { t, within } => is_near(t, within).err(),
        Wanted::Hit { id, t, .. } if found.id != id => Some(format!("{id} at t = {t:?}")),
        Wanted::Hit { t, within, .. } => is_near(t, within).err(),
        Wanted::Free { truly, .. } if engine == Engine::Reference && is_hit != truly => {
            Some(format!("in f64 {}", if truly { "a hit" } else { "a miss" }))
        }
        Wanted::Free { .. } if !is_hit => None,
        Wanted::Free { id, t, why, .. } if found.id != id => {
            Some(format!("a miss or {id} at t = {t:?}: {why}"))
        }
        Wanted::Free { t, within, .. } => is_near(t, within).err(),
    }
}

/// Each primitive as a scene of its own, which keeps its id and its scale.
fn one_by_one(scene: &Scene) -> impl Iterator<Item = Scene> {
    let geometry = &scene.geometry;
    let mut empty = scene.clone();
    empty.geometry.spheres.clear();
    empty.geometry.triangles.clear();
    empty.geometry.polygons.clear();
    let count = geometry.primitive_count();
    (0..count).map(move |index| {
        let mut alone = empty.clone();
        let in_triangles = index.checked_sub(geometry.spheres.len());
        let in_polygons = in_triangles.and_then(|index| index.checked_sub(geometry.triangles.len()));
        match (in_triangles, in_polygons) {
            (_, Some(index)) => alone.geometry.polygons.push(geometry.polygons[index].clone()),
            (Some(index), None) => alone.geometry.triangles.push(geometry.triangles[index]),
            (None, None) => alone.geometry.spheres.push(geometry.spheres[index]),
        }
        alone
    })
}

/// How many of a scene's primitives each ray hits, by engines, when it meets them one by one.
pub(super) fn counted_one_by_one(scene: &Scene, rays: &[Aimed]) -> [Vec<usize>; ENGINES.len()] {
    let set = rows(rays, Company::Listed);
    let mut counts = ENGINES.map(|_| vec![0; rays.len()]);
    for alone in one_by_one(scene) {
        let alone = Engines::new(&alone, 1);
        for (engine, counts) in ENGINES.into_iter().zip(&mut counts) {
            let found = alone.hits(&set, engine, Query::Closest);
            counts.iter_mut().zip(found.id).for_each(|(count, id)| *count += usize::from(id != Hits::MISS));
        }
    }
    counts
}

fn wrong_faces(scene: &Scene, rays: &[Aimed], wrong: &mut Complaints) {
    if rays.iter().all(|ray| ray.faces == Faces::NotCounted) {
        return;
    }
    for (engine, counts) in ENGINES.into_iter().zip(counted_one_by_one(scene, rays)) {
        for (index, (ray, count)) in rays.iter().zip(counts).enumerate() {
            let is_wrong = match ray.faces {
                Faces::NotCounted => false,
                Faces::Exactly(wanted) => count != wanted,
                Faces::Even => count % 2 != 0,
            };
            if is_wrong {
                let what = (format!("{count} faces, tried one by one"), format!("{:?}", ray.faces));
                wrong.add(index, ray, (engine, Company::Listed), what);
            }
        }
    }
}

/// All widths say the same, to the bit.
fn wrong_widths(engines: &Engines<'_>, rays: &[Aimed], wrong: &mut Complaints) {
    let at = |width| engines.answers(rays, Engine::Wavefront(width), Company::Listed);
    let narrow = at(Width::One);
    for width in Width::ALL.into_iter().skip(1) {
        for (index, (one, other)) in narrow.iter().zip(at(width)).enumerate() {
            if !one.has_same_bits(other) {
                let what = (other.to_string(), format!("as in one lane: {one}"));
                wrong.add(index, &rays[index], (Engine::Wavefront(width), Company::Listed), what);
            }
        }
    }
}

/// A scene file of a material `m` and these tables is refused at a line and a column with such a message.
#[track_caller]
pub(super) fn refused(tables: &str, message: &str) {
    let folder = Folder::new();
    let path = folder.write("scene.toml", format!("[material.m]\ndiffuse = 1\n{tables}"));
    let error = load(&path).expect_err("it is refused");
    assert!(matches!(error.place, Place::At { .. }), "{error}");
    assert!(error.message.contains(message), "{error}");
}

/// Such a scene file is read; what is warned about, each with its count.
pub(super) fn warned(tables: &str) -> (Scene, Vec<(String, u64)>) {
    let folder = Folder::new();
    let path = folder.write("scene.toml", format!("[material.m]\ndiffuse = 1\n{tables}"));
    let loaded = load(&path).unwrap();
    let warnings = loaded.warnings.into_iter().map(|warning| (warning.message, warning.count)).collect();
    (loaded.scene, warnings)
}
