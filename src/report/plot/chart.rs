//! Points and lines over two axes, linear or logarithmic, with labels beside them and lines to hold them against.

use super::axis::Axis;
use super::canvas::{self, Anchor, Canvas, Mark, PlotError, WIDTH};
use super::labels::{self, Area, LINE, text_width};
use super::palette::Colour;

/// A plot of points or lines.
pub(crate) struct Chart {
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    pub(crate) series: Vec<Series>,
    pub(crate) rules: Vec<Rule>,
    pub(crate) guides: Vec<Guide>,
}

/// Points that belong together.
pub(crate) struct Series {
    pub(crate) points: Vec<Point>,
    pub(crate) colour: Colour,
    pub(crate) mark: Mark,
    /// Whether a line goes through them, in their order.
    pub(crate) is_line: bool,
}

/// Numbers on the axes, both finite, and what is written beside them.
pub(crate) struct Point {
    pub(crate) x: f64,
    pub(crate) y: f64,
    /// How far y may be off, to either side.
    pub(crate) y_spread: f64,
    /// Empty for none.
    pub(crate) label: String,
}

/// An upright line at a number, with words on top of it.
pub(crate) struct Rule {
    pub(crate) x: f64,
    pub(crate) label: String,
    pub(crate) colour: Colour,
}

/// A faint line from one pair of numbers on the axes to another, with words at its end.
pub(crate) struct Guide {
    pub(crate) from: (f64, f64),
    pub(crate) to: (f64, f64),
    pub(crate) label: String,
}

impl Chart {
    /// Draws it.
    ///
    /// # Errors
    /// What the library says.
    pub(crate) fn draw(&self) -> Result<String, PlotError> {
        const HEIGHT: i32 = 400;
        let frame = Area { left: 66, top: 2 * LINE + 14, right: WIDTH - 20, bottom: HEIGHT - 52 };
        canvas::draw((WIDTH, HEIGHT), frame, |canvas| self.draw_on(canvas, 0))
    }

    /// Draws it where there may be something else too. With so many pixels of room right of the frame, that is where labels go:
    /// no line runs through them there.
    pub(super) fn draw_on(&self, canvas: &Canvas<'_>, label_room: i32) -> Result<(), PlotError> {
        canvas.y_axis(&self.y)?;
        self.draw_rules(canvas)?;
        canvas.x_axis(&self.x)?;
        for guide in &self.guides {
            let ends = [guide.from, guide.to].map(|(x, y)| (canvas.x(&self.x, x), canvas.y(&self.y, y)));
            canvas.line(&ends, Colour::MUTED, 1)?;
        }
        for series in &self.series {
            self.draw_series(canvas, series)?;
        }
        self.draw_labels(canvas, label_room)
    }

    /// All that is written beside points and lines.
    pub(super) fn labels(&self) -> impl Iterator<Item = &str> {
        let points = self.series.iter().flat_map(|series| &series.points).map(|point| &point.label);
        let labels = points.chain(self.guides.iter().map(|guide| &guide.label));
        labels.map(String::as_str).filter(|label| !label.is_empty())
    }

    /// Labels stand above the frame, in the lower of two rows where there is room.
    fn draw_rules(&self, canvas: &Canvas<'_>) -> Result<(), PlotError> {
        let frame = canvas.frame;
        let mut taken: Vec<Area> = vec![];
        for rule in &self.rules {
            let x = canvas.x(&self.x, rule.x);
            let half = text_width(&rule.label) / 2;
            let middle = x.clamp(half, (canvas.width - half).max(half));
            let row = |row: i32| {
                let bottom = frame.top - 5 - row * (LINE + 1);
                Area { left: middle - half, top: bottom - LINE, right: middle + half, bottom }
            };
            let is_free = |area: &Area| !taken.iter().any(|other| other.overlaps(area));
            let area = [row(0), row(1)].into_iter().find(is_free).unwrap_or_else(|| row(0));
            canvas.line(&[(x, area.bottom), (x, frame.bottom)], rule.colour, 1)?;
            let at = (middle, i32::midpoint(area.top, area.bottom));
            canvas.words(&rule.label, at, Anchor::Middle, rule.colour)?;
            taken.push(area);
        }
        Ok(())
    }

    fn draw_series(&self, canvas: &Canvas<'_>, series: &Series) -> Result<(), PlotError> {
        let at = |x: f64, y: f64| (canvas.x(&self.x, x), canvas.y(&self.y, y));
        if series.is_line && series.points.len() > 1 {
            let points: Vec<_> = series.points.iter().map(|point| at(point.x, point.y)).collect();
            canvas.line(&points, series.colour, 2)?;
        }
        for point in &series.points {
            let [low, high] = [-1.0, 1.0].map(|side| at(point.x, point.y + side * point.y_spread));
            if low.1 - high.1 > 1 {
                canvas.line(&[low, high], series.colour, 2)?;
            }
            canvas.mark(at(point.x, point.y), series.mark, series.colour)?;
        }
        Ok(())
    }

    fn draw_labels(&self, canvas: &Canvas<'_>, room: i32) -> Result<(), PlotError> {
        let points = self.series.iter().flat_map(|series| &series.points);
        let points = points.map(|point| ((point.x, point.y), &point.label, Colour::INK));
        let guides = self.guides.iter().map(|guide| (guide.to, &guide.label, Colour::MUTED));
        let all = points.chain(guides).map(|((x, y), label, colour)| {
            let mark = (canvas.x(&self.x, x), canvas.y(&self.y, y));
            (mark, label.clone(), colour)
        });
        // Points without a label come last: they take room, and get none.
        let (named, others): (Vec<_>, Vec<_>) = all.partition(|(_, label, _)| !label.is_empty());
        let marks: Vec<_> = named.iter().map(|&(mark, ..)| mark).collect();
        let others: Vec<_> = others.iter().map(|&(mark, ..)| mark).collect();
        let names: Vec<String> = named.iter().map(|(_, name, _)| name.clone()).collect();
        let frame = canvas.frame;
        let leftmost = marks.iter().map(|&(x, _)| x).min().filter(|_| room > 0);
        let within = Area { left: leftmost.unwrap_or(frame.left), right: frame.right + room, ..frame };
        let places = labels::place(&marks, &others, &names, &within);
        for (((x, y), name, colour), place) in named.into_iter().zip(&places) {
            let Area { left, top, right, bottom } = place.area;
            let middle = i32::midpoint(top, bottom);
            if place.needs_line {
                let (near, end) = if left > x { (x + 5, left - 3) } else { (x - 5, right + 3) };
                canvas.line(&[(near, y), (end, middle)], Colour::MUTED, 1)?;
            }
            // The estimate of a width is rough: words begin on the side of their mark.
            let (at, anchor) = if left > x { (left, Anchor::Left) } else { (right, Anchor::Right) };
            canvas.words(&name, (at, middle), anchor, colour)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines() -> Chart {
        // Errors that fall with the square root of the seconds, and faster.
        let series = [("random", -0.5, 0), ("jittered", -0.75, 1), ("regular", -0.7, 3)];
        let series: Vec<Series> = series
            .into_iter()
            .map(|(name, slope, lanes)| {
                let point = |step: i32| {
                    let seconds = 0.01 * f64::from(step * step);
                    let label = if step == 8 { name.to_owned() } else { String::new() };
                    Point { x: seconds, y: 0.01 * seconds.powf(slope), y_spread: 0.0, label }
                };
                let points = (1..=8).map(point).collect();
                Series { points, colour: Colour::LANES[lanes], mark: Mark::Full, is_line: true }
            })
            .collect();
        let points = || series.iter().flat_map(|series| &series.points);
        Chart {
            x: Axis::log("seconds", points().map(|point| point.x)),
            y: Axis::log("RMSE", points().map(|point| point.y)),
            rules: vec![],
            guides: vec![],
            series,
        }
    }

    #[test]
    fn lines_go_through_all_of_their_points() {
        let svg = lines().draw().unwrap();
        let lines: Vec<&str> =
            svg.split("<polyline").skip(1).filter_map(|rest| rest.split("/>").next()).collect();
        let curves = lines.iter().filter(|line| line.matches(',').count() == 8);
        assert_eq!((curves.count(), svg.matches("<circle").count()), (3, 24), "{svg}");
        for name in ["random", "jittered", "regular"] {
            assert_eq!(svg.matches(name).count(), 1);
        }
    }

    #[test]
    fn a_chart_without_points_is_still_drawn() {
        let chart = Chart {
            x: Axis::log("x", []),
            y: Axis::linear("y", []),
            series: vec![],
            rules: vec![],
            guides: vec![],
        };
        assert!(chart.draw().unwrap().ends_with("</svg>\n"));
    }

    /// Two rules at one place: their words stand in two rows.
    #[test]
    fn words_of_rules_do_not_cover_each_other() {
        let rule = |label: &str| Rule { x: 1.0, label: label.into(), colour: Colour::MUTED };
        let chart = Chart { rules: vec![rule("one"), rule("two")], series: vec![], ..lines() };
        let svg = chart.draw().unwrap();
        let row = |label: &str| {
            let tag = svg.split("<text").find(|text| text.contains(&format!(">\n{label}\n"))).unwrap();
            let y = tag.split(" y=\"").nth(1).unwrap().split('"').next().unwrap();
            y.parse::<i32>().unwrap()
        };
        assert!(row("one") - row("two") >= LINE, "{} {}", row("one"), row("two"));
    }
}
