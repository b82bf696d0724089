//! What every plot is drawn on: an SVG with a frame in it, axes, titles and a legend. The only place that names the library.

use super::axis::Axis;
use super::labels::{Area, LINE, text_width};
use super::palette::Colour;
use plotters::backend::SVGBackend;
use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, IntoDrawingArea};
use plotters::element::{Circle, PathElement, Rectangle, Text};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontTransform, IntoFont, RGBColor, ShapeStyle, TextStyle};
use std::fmt::Display;
use thiserror::Error;

/// A plot that cannot be drawn; the library's own words.
#[derive(Debug, Error)]
#[error("a plot cannot be drawn: {0}")]
pub(crate) struct PlotError(String);

/// Pixels from the left and from the top.
pub(super) type Pixel = (i32, i32);

/// Width of a plot on a page, pixels.
pub(super) const WIDTH: i32 = 720;

pub(super) struct Canvas<'a> {
    area: DrawingArea<SVGBackend<'a>, Shift>,
    /// Where data are drawn.
    pub(super) frame: Area,
    /// Of all of it, pixels.
    pub(super) width: i32,
}

/// Which end of the words is at the point that they are given.
#[derive(Clone, Copy)]
pub(super) enum Anchor {
    Left,
    Middle,
    Right,
}

/// How a mark is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mark {
    /// A filled circle.
    Full,
    /// An open circle.
    Open,
    /// A short vertical stroke.
    Stroke,
}

/// Draws a plot of a width and a height and with a frame, and returns the text of the SVG.
pub(super) fn draw(
    (width, height): Pixel,
    frame: Area,
    draw: impl FnOnce(&Canvas<'_>) -> Result<(), PlotError>,
) -> Result<String, PlotError> {
    let mut text = String::new();
    let size = (width.unsigned_abs(), height.unsigned_abs());
    let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
    let canvas = Canvas { area, frame, width };
    draw(&canvas)?;
    canvas.area.present().map_err(failed)?;
    drop(canvas);
    Ok(text)
}

fn failed(error: impl Display) -> PlotError {
    PlotError(error.to_string())
}

fn style(colour: Colour, width: u32) -> ShapeStyle {
    let [red, green, blue] = colour.on_white();
    ShapeStyle { stroke_width: width, ..RGBColor(red, green, blue).filled() }
}

impl Canvas<'_> {
    /// Draws on a part of it, where pixels count from the part's corner.
    pub(super) fn part(
        &self,
        part: &Area,
        frame: Area,
        draw: impl FnOnce(&Canvas<'_>) -> Result<(), PlotError>,
    ) -> Result<(), PlotError> {
        let width = part.right - part.left;
        let area = self.area.clone().shrink((part.left, part.top), (width, part.bottom - part.top));
        draw(&Canvas { area, frame, width })
    }

    pub(super) fn line(&self, points: &[Pixel], colour: Colour, width: u32) -> Result<(), PlotError> {
        let line = ShapeStyle { filled: false, ..style(colour, width) };
        self.area.draw(&PathElement::new(points.to_vec(), line)).map_err(failed)
    }

    pub(super) fn rectangle(&self, area: &Area, colour: Colour) -> Result<(), PlotError> {
        let corners = [(area.left, area.top), (area.right, area.bottom)];
        self.area.draw(&Rectangle::new(corners, style(colour, 0))).map_err(failed)
    }

    pub(super) fn mark(&self, (x, y): Pixel, mark: Mark, colour: Colour) -> Result<(), PlotError> {
        match mark {
            Mark::Full => self.area.draw(&Circle::new((x, y), 5, style(colour, 1))).map_err(failed),
            Mark::Open => {
                let ring = ShapeStyle { filled: false, ..style(colour, 2) };
                self.area.draw(&Circle::new((x, y), 4, ring)).map_err(failed)
            }
            Mark::Stroke => self.line(&[(x, y - 6), (x, y + 6)], colour, 2),
        }
    }

    /// Words whose middle line is at the point.
    pub(super) fn words(
        &self,
        text: &str,
        at: Pixel,
        anchor: Anchor,
        colour: Colour,
    ) -> Result<(), PlotError> {
        self.text(text, at, anchor, colour, FontTransform::None)
    }

    fn text(
        &self,
        text: &str,
        at: Pixel,
        anchor: Anchor,
        colour: Colour,
        turn: FontTransform,
    ) -> Result<(), PlotError> {
        if text.is_empty() {
            return Ok(());
        }
        let horizontal = match anchor {
            Anchor::Left => HPos::Left,
            Anchor::Middle => HPos::Center,
            Anchor::Right => HPos::Right,
        };
        let [red, green, blue] = colour.on_white();
        let ink = RGBColor(red, green, blue);
        let font = ("sans-serif", FONT_SIZE).into_font().transform(turn);
        let style = TextStyle::from(font).color(&ink).pos(Pos::new(horizontal, VPos::Center));
        self.area.draw(&Text::new(text, at, style)).map_err(failed)
    }

    /// The column of a number.
    pub(super) fn x(&self, axis: &Axis, value: f64) -> i32 {
        self.frame.left + pixels(axis.fraction(value), self.frame.right - self.frame.left)
    }

    /// The row of a number.
    pub(super) fn y(&self, axis: &Axis, value: f64) -> i32 {
        self.frame.bottom - pixels(axis.fraction(value), self.frame.bottom - self.frame.top)
    }

    /// The axis below the frame: a line, broken behind zero on a logarithmic axis, strokes, numbers and the title.
    pub(super) fn x_axis(&self, axis: &Axis) -> Result<(), PlotError> {
        let Area { left, right, bottom, .. } = self.frame;
        let [from, to] = axis
            .broken_between()
            .map_or([left; 2], |at| [at.start, at.end].map(|fraction| left + pixels(fraction, right - left)));
        self.line(&[(left, bottom), (from, bottom)], Colour::INK, 1)?;
        self.line(&[(to, bottom), (right, bottom)], Colour::INK, 1)?;
        if from < to {
            for x in [from, to] {
                self.line(&[(x - 3, bottom + 5), (x + 3, bottom - 5)], Colour::INK, 1)?;
            }
        }
        for (tick, text) in axis.ticks() {
            let x = self.x(axis, tick);
            self.line(&[(x, bottom), (x, bottom + 4)], Colour::INK, 1)?;
            self.words(&text, (x, bottom + 14), Anchor::Middle, Colour::INK)?;
        }
        self.words(&axis.title, (i32::midpoint(left, right), bottom + 36), Anchor::Middle, Colour::INK)
    }

    /// The axis left of the frame: numbers, lines across to read along, and the title.
    pub(super) fn y_axis(&self, axis: &Axis) -> Result<(), PlotError> {
        let Area { left, top, right, bottom } = self.frame;
        for (tick, text) in axis.ticks() {
            let y = self.y(axis, tick);
            self.line(&[(left, y), (right, y)], Colour::GRID, 1)?;
            self.words(&text, (left - 8, y), Anchor::Right, Colour::INK)?;
        }
        let middle = i32::midpoint(top, bottom);
        self.text(&axis.title, (14, middle), Anchor::Middle, Colour::INK, FontTransform::Rotate270)
    }

    /// Marks and what they stand for, in a row along the top.
    pub(super) fn legend(&self, items: &[(Mark, Colour, &str)]) -> Result<(), PlotError> {
        let (mut x, y) = (self.frame.left + 6, LINE);
        for &(mark, colour, name) in items {
            self.mark((x, y), mark, colour)?;
            self.words(name, (x + 11, y), Anchor::Left, Colour::INK)?;
            x += 11 + text_width(name) + 18;
        }
        Ok(())
    }
}

/// The library draws words at their size over 1.24.
const FONT_SIZE: f64 = 12.0 * 1.24;

fn pixels(fraction: f64, of: i32) -> i32 {
    #[expect(clippy::cast_possible_truncation, reason = "a pixel of the frame")]
    let pixels = (fraction * f64::from(of)).round() as i32;
    pixels
}
