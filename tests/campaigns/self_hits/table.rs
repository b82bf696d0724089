//! Counts of rays by what they are and what they did.

use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter};
use wavelane::rays::RayKind;

/// What a row of the table is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Row {
    /// What stands in the scene.
    pub(super) setting: &'static str,
    pub(super) kind: RayKind,
    /// Whether the ray goes to the inner side of what it starts on.
    pub(super) inward: bool,
}

/// Of one row.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Counts {
    pub(super) rays: u64,
    /// Of them, those of which geometry says that they meet nothing.
    pub(super) free: u64,
    /// Hits of what the ray cannot meet: what it leaves, what it touches there, a wall from behind.
    pub(super) self_hits: u64,
    /// Of which geometry says that they meet something.
    pub(super) bound: u64,
    /// Of those, the ones that met nothing.
    pub(super) missed: u64,
}

/// Counts by row, and the first rays that went wrong.
#[derive(Default)]
pub(super) struct Table {
    rows: BTreeMap<Row, Counts>,
    pub(super) wrong: Vec<String>,
}

impl Table {
    const KEPT: usize = 12;

    pub(super) fn row(&mut self, row: Row) -> &mut Counts {
        self.rows.entry(row).or_default()
    }

    pub(super) fn note(&mut self, ray: impl FnOnce() -> String) {
        if self.wrong.len() < Self::KEPT {
            self.wrong.push(ray());
        }
    }

    pub(super) fn append(&mut self, other: Self) {
        for (row, counts) in other.rows {
            *self.row(row) += counts;
        }
        self.wrong.extend(other.wrong);
        self.wrong.truncate(Self::KEPT);
    }

    pub(super) fn total(&self) -> Counts {
        self.rows.values().fold(Counts::default(), |mut sum, &counts| {
            sum += counts;
            sum
        })
    }
}

impl std::ops::AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.rays += other.rays;
        self.free += other.free;
        self.self_hits += other.self_hits;
        self.bound += other.bound;
        self.missed += other.missed;
    }
}

impl Display for Table {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "| setting | ray | goes | rays | must meet nothing | self-hits | must meet a wall | missed |"
        )?;
        writeln!(f, "|---|---|---|---|---|---|---|---|")?;
        for (Row { setting, kind, inward }, counts) in &self.rows {
            let Counts { rays, free, self_hits, bound, missed } = counts;
            let goes = if *inward { "in" } else { "out" };
            let kind = kind.name();
            writeln!(
                f,
                "| {setting} | {kind} | {goes} | {rays} | {free} | {self_hits} | {bound} | {missed} |"
            )?;
        }
        let Counts { rays, free, self_hits, bound, missed } = self.total();
        writeln!(f, "| all | | | {rays} | {free} | {self_hits} | {bound} | {missed} |")?;
        // 0 of N: the rate lies below 3/N with 95 % confidence.
        write!(f, "3/N: self-hits {:.1e}, missed walls {:.1e}", 3.0 / rays as f64, 3.0 / bound as f64)
    }
}
