//! Plots as SVG: nothing in them but shapes and words, in whatever sans-serif type the reader has.
//!
//! - `chart`: points and lines over two axes; `bars`: bars in groups; `ranges`: rows of percentiles
//! - `panels`: several charts in a picture that stands alone
//! - `axis`: where a number lies; `labels`: where words go; `palette`: colours
//! - `canvas`: draws all of it

mod axis;
pub(super) mod bars;
mod canvas;
mod chart;
mod labels;
mod palette;
pub(super) mod panels;
pub(super) mod ranges;

pub(super) use axis::Axis;
pub(super) use canvas::{Mark, PlotError};
pub(super) use chart::{Chart, Guide, Point, Rule, Series};
pub(super) use palette::{Colour, dark_style};
