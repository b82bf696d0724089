//! What got slower since an earlier report.

use super::super::Spread;
use super::BenchReport;
use crate::rays::RayKind;
use serde::Deserialize;
use std::collections::BTreeMap;
use thiserror::Error;

/// What is read of an earlier report.
#[derive(Clone, Debug, Deserialize)]
pub struct Baseline {
    threads: usize,
    machine: BaselineMachine,
    scenes: Vec<BaselineScene>,
}

#[derive(Clone, Debug, Deserialize)]
struct BaselineMachine {
    processor: Option<String>,
    isa: String,
    version: String,
}

#[derive(Clone, Debug, Deserialize)]
struct BaselineScene {
    scene: String,
    primitives: usize,
    size: [u32; 2],
    samples: u32,
    max_depth: u32,
    seconds: BaselineSeconds,
    simd: BaselineEngine,
}

#[derive(Clone, Debug, Deserialize)]
struct BaselineSeconds {
    build: Option<Measured>,
}

#[derive(Clone, Debug, Deserialize)]
struct BaselineEngine {
    frame_seconds: Option<Measured>,
    mrays_per_second: BTreeMap<String, Option<Measured>>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
struct Measured {
    median: f64,
    best: f64,
}

/// Why a report cannot be a baseline.
#[derive(Debug, Error)]
pub enum BaselineError {
    /// It is something else.
    #[error("this is not a report of `wavelane bench --json`: {0}")]
    NotAReport(#[from] serde_json::Error),
    /// Its numbers mean something else.
    #[error(
        "its format is {found}, and this program's is {}: what they say cannot be compared; make a new baseline",
        BenchReport::FORMAT
    )]
    Format {
        /// Of the file.
        found: u32,
    },
    /// No measurement comes to such a number.
    #[error("it says {number} of {scene}, which no measurement comes to; make a new baseline")]
    Number {
        /// A median or a best.
        number: f64,
        /// The scene.
        scene: String,
    },
    /// It was measured in another way.
    #[error(
        "it was measured with {found} threads, and this run has {wanted}; use --threads {found}, or make a new baseline"
    )]
    Threads {
        /// Of the file.
        found: usize,
        /// Of the run.
        wanted: usize,
    },
}

/// One number, before and after.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// Name and primitives of the scene.
    pub scene: String,
    /// What was measured, with its unit.
    pub what: String,
    /// The baseline's median.
    pub before: f64,
    /// The run's.
    pub after: f64,
    /// How many times slower the median is; below 1 where it is faster.
    pub slower: f64,
    /// The same of the best of the repeats, which other work on the machine disturbs least.
    pub best_slower: f64,
}

impl Change {
    /// Whether it got slower by more than a share, by its median and by its best.
    #[must_use]
    pub fn is_slower(&self, share: f64) -> bool {
        self.slower > 1.0 + share && self.best_slower > 1.0 + share
    }
}

impl Baseline {
    /// Reads a report.
    ///
    /// # Errors
    /// Something else than a report, one of another format, or of another number of threads.
    pub fn parse(text: &str, threads: usize) -> Result<Self, BaselineError> {
        #[derive(Deserialize)]
        struct Format {
            format: u32,
        }
        let Format { format: found } = serde_json::from_str(text)?;
        if found != BenchReport::FORMAT {
            return Err(BaselineError::Format { found });
        }
        let baseline: Self = serde_json::from_str(text)?;
        for scene in &baseline.scenes {
            let all = scene.simd.mrays_per_second.values().copied();
            let all = all.chain([scene.seconds.build, scene.simd.frame_seconds]).flatten();
            let numbers = all.flat_map(|measured| [measured.median, measured.best]);
            if let Some(number) = numbers.into_iter().find(|number| !(1e-9..=1e9).contains(number)) {
                return Err(BaselineError::Number { number, scene: scene.scene.clone() });
            }
        }
        if baseline.threads != threads {
            return Err(BaselineError::Threads { found: baseline.threads, wanted: threads });
        }
        Ok(baseline)
    }

    /// What makes a comparison doubtful, in words.
    #[must_use]
    pub fn doubts(&self, report: &BenchReport) -> Vec<String> {
        let (before, now) = (&self.machine, &report.machine);
        let isa = now.isa.to_string();
        let mut doubts = Vec::new();
        if before.processor != now.processor {
            let name = |processor: &Option<String>| processor.clone().unwrap_or_else(|| "unknown".into());
            doubts.push(format!(
                "the baseline is of another processor ({}, not {})",
                name(&before.processor),
                name(&now.processor)
            ));
        }
        if before.isa != isa {
            doubts.push(format!("the baseline was built for {}, and this program for {isa}", before.isa));
        }
        if before.version != now.version {
            doubts
                .push(format!("the baseline is of version {}, and this is {}", before.version, now.version));
        }
        let missing = report.scenes.iter().filter(|scene| self.scene(scene).is_none());
        doubts.extend(missing.map(|scene| {
            format!(
                "{} with {} primitives is not in the baseline in this form",
                scene.scene, scene.primitives
            )
        }));
        let is_run = |before: &BaselineScene| {
            let is_it =
                |now: &super::SceneBench| self.scene(now).is_some_and(|found| std::ptr::eq(found, before));
            report.scenes.iter().any(is_it)
        };
        let left_out = self.scenes.iter().filter(|before| !is_run(before));
        doubts.extend(left_out.map(|before| {
            let BaselineScene { scene, primitives, .. } = before;
            format!("{scene} with {primitives} primitives of the baseline was not measured in this run")
        }));
        doubts
    }

    fn scene(&self, now: &super::SceneBench) -> Option<&BaselineScene> {
        self.scenes.iter().find(|before| {
            before.scene == now.scene
                && before.primitives == now.primitives
                && before.size == now.size
                && (before.samples, before.max_depth) == (now.samples, now.max_depth)
        })
    }

    /// Everything that both have measured.
    #[must_use]
    pub fn changes(&self, report: &BenchReport) -> Vec<Change> {
        let mut changes = Vec::new();
        for now in &report.scenes {
            let Some(before) = self.scene(now) else { continue };
            let mut add =
                |what: String, before: Option<Measured>, after: Option<Spread>, more_is_better: bool| {
                    let Some((before, after)) = before.zip(after) else { return };
                    let slower = |before: f64, after: f64| {
                        if more_is_better { before / after } else { after / before }
                    };
                    if before.median > 0.0 && before.best > 0.0 && after.median > 0.0 {
                        changes.push(Change {
                            scene: format!("{} {}", now.scene, now.primitives),
                            what,
                            before: before.median,
                            after: after.median,
                            slower: slower(before.median, after.median),
                            best_slower: slower(before.best, after.best),
                        });
                    }
                };
            add("build s".into(), before.seconds.build, now.seconds.build, false);
            add("frame s".into(), before.simd.frame_seconds, now.simd.frame_seconds, false);
            for kind in RayKind::ALL {
                let old = before.simd.mrays_per_second.get(kind.name()).copied().flatten();
                let new = now.simd.mrays_per_second.get(&kind).copied().flatten();
                add(format!("{} Mrays/s", kind.name()), old, new, true);
            }
        }
        changes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slower_is_what_is_slower_in_the_median_and_at_best() {
        let change = |slower, best_slower| Change {
            scene: "any 1".into(),
            what: "frame s".into(),
            before: 1.0,
            after: slower,
            slower,
            best_slower,
        };
        for (slower, best_slower, expected) in [
            (1.06, 1.06, true),
            (1.06, 1.04, false),
            (1.04, 1.06, false),
            (0.9, 1.2, false),
            (1.05, 1.05, false),
        ] {
            assert_eq!(change(slower, best_slower).is_slower(0.05), expected, "{slower} {best_slower}");
        }
    }
}
