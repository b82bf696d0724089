//! What a campaign counts, and how it shows it.

use super::aims::Aim;
use super::solids::KINDS;
use std::collections::BTreeMap;
use std::fmt;
use std::ops::AddAssign;

/// Of one kind of surface and one aim; or summed up.
#[derive(Clone, Copy, Default)]
pub(super) struct Cell {
    /// From inside.
    pub(super) rays: u64,
    pub(super) in_packets: u64,
    /// That met nothing.
    pub(super) leaks: u64,
    /// That nothing was said to be in the way of.
    pub(super) not_occluded: u64,
    /// From inside and outside, that were tried against every face on its own.
    pub(super) counted: u64,
    /// Of these, from where every ray meets the surface once.
    pub(super) star: u64,
    /// Of those, that met it more than once.
    pub(super) doubles: u64,
    /// That met it an even number of times from inside, or an odd one from outside.
    pub(super) wrong_parity: u64,
    /// Of which the hierarchy found another face than is nearest, or none.
    pub(super) lost: u64,
}

impl AddAssign for Cell {
    fn add_assign(&mut self, other: Self) {
        self.rays += other.rays;
        self.in_packets += other.in_packets;
        self.leaks += other.leaks;
        self.not_occluded += other.not_occluded;
        self.counted += other.counted;
        self.star += other.star;
        self.doubles += other.doubles;
        self.wrong_parity += other.wrong_parity;
        self.lost += other.lost;
    }
}

impl Cell {
    pub(super) fn failures(&self) -> u64 {
        self.leaks + self.not_occluded + self.doubles + self.wrong_parity + self.lost
    }
}

/// All that was counted of an engine.
pub(super) struct Tally {
    cells: Vec<Cell>,
    /// The first rays that failed, in words, by what went wrong.
    examples: BTreeMap<&'static str, Vec<String>>,
}

/// Of one way to fail.
const MOST_EXAMPLES: usize = 4;

impl Tally {
    pub(super) fn new() -> Self {
        Self { cells: vec![Cell::default(); KINDS.len() * Aim::ALL.len()], examples: BTreeMap::new() }
    }

    pub(super) fn cell(&mut self, kind: usize, aim: Aim) -> &mut Cell {
        &mut self.cells[kind * Aim::ALL.len() + aim as usize]
    }

    pub(super) fn add_example(&mut self, what: &'static str, example: impl FnOnce() -> String) {
        let examples = self.examples.entry(what).or_default();
        if examples.len() < MOST_EXAMPLES {
            examples.push(example());
        }
    }

    /// Lines.
    pub(super) fn examples(&self) -> String {
        let lines = self
            .examples
            .iter()
            .flat_map(|(what, examples)| examples.iter().map(move |example| format!("{what}: {example}\n")));
        lines.collect()
    }

    pub(super) fn sum(&self) -> Cell {
        let mut sum = Cell::default();
        self.cells.iter().for_each(|cell| sum += *cell);
        sum
    }
}

impl AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        for (mine, other) in self.cells.iter_mut().zip(other.cells) {
            *mine += other;
        }
        for (what, others) in other.examples {
            let examples = self.examples.entry(what).or_default();
            examples.extend(others);
            examples.truncate(MOST_EXAMPLES);
        }
    }
}

/// A Markdown table.
impl fmt::Display for Tally {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            to,
            "| solid | aimed at | rays | in packets | leaks | not occluded | fewer than | counted | once | more than once | wrong parity | lost |"
        )?;
        writeln!(to, "|---|---|---|---|---|---|---|---|---|---|---|---|")?;
        for (kind, cells) in KINDS.iter().zip(self.cells.chunks(Aim::ALL.len())) {
            for (aim, cell) in Aim::ALL.iter().zip(cells).filter(|(_, cell)| cell.rays > 0) {
                writeln!(to, "| {} | {} {cell}", kind.0, aim.name())?;
            }
        }
        write!(to, "| all | all {}", self.sum())
    }
}

impl fmt::Display for Cell {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { rays, in_packets, leaks, not_occluded, counted, star, doubles, wrong_parity, lost } = self;
        let share = 100.0 * *in_packets as f64 / (*rays).max(1) as f64;
        // With 95 % confidence, if there was none among so many.
        let bound = match (*rays, leaks) {
            (1.., 0) => format!("{:.1e}", 3.0 / *rays as f64),
            _ => String::new(),
        };
        write!(
            to,
            "| {rays} | {share:.0} % | {leaks} | {not_occluded} | {bound} | {counted} | {star} | {doubles} | {wrong_parity} | {lost} |"
        )
    }
}
