//! Rows of percentiles: from the middle to the largest of many errors, along a logarithmic axis.

use super::axis::Axis;
use super::canvas::{self, Anchor, Mark, PlotError, WIDTH};
use super::labels::{Area, LINE};
use super::palette::Colour;
use crate::measure::Percentiles;

/// A plot of rows.
pub(crate) struct Ranges {
    pub(crate) x: Axis,
    pub(crate) groups: Vec<Group>,
}

/// Rows under a heading.
pub(crate) struct Group {
    pub(crate) heading: String,
    pub(crate) rows: Vec<(String, Percentiles)>,
}

const ROW: i32 = 22;
const HEADING: i32 = 30;
const COLOUR: Colour = Colour::LANES[2];

impl Ranges {
    /// Draws it.
    ///
    /// # Errors
    /// What the library says.
    pub(crate) fn draw(&self) -> Result<String, PlotError> {
        let top = 2 * LINE;
        let rows = |group: &Group| i32::try_from(group.rows.len()).unwrap_or(0) * ROW;
        let bottom = top + self.groups.iter().map(|group| HEADING + rows(group)).sum::<i32>() + ROW / 2;
        let frame = Area { left: 96, top, right: WIDTH - 20, bottom };
        canvas::draw((WIDTH, bottom + 52), frame, |canvas| {
            let legend = [(Mark::Full, "median"), (Mark::Open, "99th percentile"), (Mark::Stroke, "largest")];
            canvas.legend(&legend.map(|(mark, name)| (mark, COLOUR, name)))?;
            canvas.x_axis(&self.x)?;
            let mut y = top;
            for group in &self.groups {
                canvas.words(&group.heading, (8, y + HEADING / 2), Anchor::Left, Colour::MUTED)?;
                y += HEADING;
                for (tick, _) in self.x.ticks() {
                    let x = canvas.x(&self.x, tick);
                    canvas.line(&[(x, y), (x, y + rows(group))], Colour::GRID, 1)?;
                }
                for (name, Percentiles { p50, p99, max }) in &group.rows {
                    let middle = y + ROW / 2;
                    canvas.words(name, (frame.left - 12, middle), Anchor::Right, Colour::INK)?;
                    let [p50, p99, max] = [*p50, *p99, *max].map(|value| (canvas.x(&self.x, value), middle));
                    canvas.line(&[p50, max], COLOUR, 1)?;
                    canvas.mark(max, Mark::Stroke, COLOUR)?;
                    canvas.mark(p99, Mark::Open, COLOUR)?;
                    canvas.mark(p50, Mark::Full, COLOUR)?;
                    y += ROW;
                }
            }
            Ok(())
        })
    }
}
