//! Charts side by side in a picture that stands alone: it has a title, paper of its own, and its colours on a dark screen.

use super::canvas::{self, Anchor, Canvas, Mark, PlotError};
use super::chart::Chart;
use super::labels::{Area, LINE, text_width};
use super::palette::{Colour, dark_style};

/// A picture of charts.
pub(crate) struct Panels {
    pub(crate) title: String,
    /// What is said aside, below it.
    pub(crate) notes: Vec<String>,
    /// What marks stand for, in all of the charts.
    pub(crate) legend: Vec<(Mark, &'static str)>,
    pub(crate) panels: Vec<Panel>,
}

/// A chart under a heading; its axes may do without titles.
pub(crate) struct Panel {
    pub(crate) heading: String,
    pub(crate) chart: Chart,
}

/// Width of one of two columns.
const COLUMN: i32 = 480;
const WIDTH: i32 = 2 * COLUMN;
/// More lines than these have both columns.
const MOST_IN_COLUMN: usize = 6;
/// Left of frames: the numbers of their axes.
const LEFT: i32 = 64;
/// Below frames: the numbers, and what parts them from the next heading.
const BELOW: i32 = 40;
const LEAST_HEIGHT: i32 = 200;
/// Right of frames there is room for labels, but not more than for one of some thirty letters.
const MOST_LABEL: i32 = 240;

impl Panels {
    /// Draws it.
    ///
    /// # Errors
    /// What the library says.
    pub(crate) fn draw(&self) -> Result<String, PlotError> {
        let (areas, height) = self.areas();
        let whole = Area { left: 0, top: 0, right: WIDTH, bottom: height };
        let svg = canvas::draw((WIDTH, height), whole, |canvas| {
            canvas.rectangle(&whole, Colour::PAPER)?;
            self.draw_words(canvas)?;
            for (panel, area) in self.panels.iter().zip(&areas) {
                let (width, height) = (area.right - area.left, area.bottom - area.top);
                let label_room = self.label_room(panel);
                let right = width - label_room;
                let frame = Area { left: LEFT, top: 2 * LINE, right, bottom: height - BELOW };
                canvas.part(area, frame, |canvas| {
                    canvas.words(&panel.heading, (LEFT, LINE), Anchor::Left, Colour::INK)?;
                    panel.chart.draw_on(canvas, label_room)
                })?;
            }
            Ok(())
        })?;
        let style = format!(
            ">\n<style>\n@media screen and (prefers-color-scheme: dark) {{\n{}}}\n</style>\n",
            dark_style()
        );
        Ok(svg.replacen(">\n", &style, 1))
    }

    fn draw_words(&self, canvas: &Canvas<'_>) -> Result<(), PlotError> {
        canvas.words(&self.title, (LEFT, LINE), Anchor::Left, Colour::INK)?;
        let mut y = LINE;
        for note in &self.notes {
            y += LINE;
            canvas.words(note, (LEFT, y), Anchor::Left, Colour::MUTED)?;
        }
        let row = Area { left: 0, top: y + LINE / 3, right: WIDTH, bottom: y + 2 * LINE };
        canvas.part(&row, Area { left: LEFT, ..row }, |canvas| {
            let items: Vec<_> = self.legend.iter().map(|&(mark, name)| (mark, Colour::INK, name)).collect();
            canvas.legend(&items)
        })
    }

    /// Where panels are, row by row, and the height of all of it.
    fn areas(&self) -> (Vec<Area>, i32) {
        let words = i32::try_from(self.notes.len()).unwrap_or(0) + 4;
        let (mut left, mut top, mut bottom) = (0, words * LINE, words * LINE);
        let mut areas = vec![];
        for panel in &self.panels {
            let width = if is_wide(panel) { WIDTH } else { COLUMN };
            if left + width > WIDTH {
                (left, top) = (0, bottom);
            }
            let area = Area { left, top, right: left + width, bottom: top + height(panel) };
            (left, bottom) = (area.right, bottom.max(area.bottom));
            areas.push(area);
        }
        (areas, bottom)
    }

    /// The same for all panels of a width, so that frames stand above each other.
    fn label_room(&self, panel: &Panel) -> i32 {
        let alike = self.panels.iter().filter(|other| is_wide(other) == is_wide(panel));
        let widths = alike.flat_map(|panel| panel.chart.labels()).map(text_width);
        // A label begins right of its mark, and that is a little left of the frame's end.
        widths.max().unwrap_or(0).min(MOST_LABEL) + LINE
    }
}

fn is_wide(panel: &Panel) -> bool {
    panel.chart.series.len() > MOST_IN_COLUMN
}

/// Labels have room above each other, and some to be near their marks.
fn height(panel: &Panel) -> i32 {
    let labels = i32::try_from(panel.chart.labels().count()).unwrap_or(0);
    2 * LINE + LEAST_HEIGHT.max((labels + 1) * LINE * 3 / 2) + BELOW
}
