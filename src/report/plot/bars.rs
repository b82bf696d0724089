//! Bars in groups, each with its number on top.

use super::axis::Axis;
use super::canvas::{self, Anchor, Mark, PlotError, WIDTH};
use super::labels::{Area, LINE};
use super::palette::Colour;
use crate::report::table::number;

/// A plot of bars that stand on 0.
pub(crate) struct Bars {
    pub(crate) y: Axis,
    /// What stands side by side in each group.
    pub(crate) series: Vec<(String, Colour)>,
    pub(crate) groups: Vec<Group>,
}

/// Bars that stand together.
pub(crate) struct Group {
    pub(crate) name: String,
    /// For each series; finite.
    pub(crate) values: Vec<Option<f64>>,
}

impl Bars {
    /// Draws it.
    ///
    /// # Errors
    /// What the library says.
    pub(crate) fn draw(&self) -> Result<String, PlotError> {
        const HEIGHT: i32 = 320;
        const WIDEST: i32 = 34;
        let frame = Area { left: 66, top: 2 * LINE + 14, right: WIDTH - 20, bottom: HEIGHT - 30 };
        canvas::draw((WIDTH, HEIGHT), frame, |canvas| {
            canvas.y_axis(&self.y)?;
            let items: Vec<_> =
                self.series.iter().map(|(name, colour)| (Mark::Full, *colour, name.as_str())).collect();
            canvas.legend(&items)?;
            let count = |length: usize| i32::try_from(length).unwrap_or(1).max(1);
            let (groups, series) = (count(self.groups.len()), count(self.series.len()));
            let slot = (frame.right - frame.left) / groups;
            // A bar's room is left free between groups.
            let bar = (slot / (series + 1)).clamp(3, WIDEST);
            for (group, index) in self.groups.iter().zip(0..) {
                let middle = frame.left + index * slot + slot / 2;
                canvas.words(&group.name, (middle, frame.bottom + LINE), Anchor::Middle, Colour::INK)?;
                let mut left = middle - bar * series / 2;
                for (value, (_, colour)) in group.values.iter().zip(&self.series) {
                    if let Some(value) = *value {
                        let top = canvas.y(&self.y, value);
                        let area = Area { left: left + 1, top, right: left + bar - 1, bottom: frame.bottom };
                        canvas.rectangle(&area, *colour)?;
                        let above = (left + bar / 2, top - LINE / 2);
                        canvas.words(&short(value), above, Anchor::Middle, Colour::INK)?;
                    }
                    left += bar;
                }
            }
            canvas.line(&[(frame.left, frame.bottom), (frame.right, frame.bottom)], Colour::INK, 1)
        })
    }
}

/// Two digits or so, which is what fits on a bar.
fn short(value: f64) -> String {
    match value {
        9.95.. => format!("{value:.0}"),
        0.095.. => format!("{value:.1}"),
        _ => number(value),
    }
}
