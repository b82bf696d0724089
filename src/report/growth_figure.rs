//! The plot of a benchmark: how cost grows, a panel for each thing that it grows with.

use super::benched::exponent;
use super::plot::panels::{Panel, Panels};
use super::plot::{Axis, Chart, Colour, Guide, Mark, PlotError, Point, Series};
use crate::measure::Spread;
use crate::measure::bench::{BenchReport, Growth, GrowthPoint};

/// All of it, an SVG that stands alone.
pub(crate) fn growth_figure(report: &BenchReport) -> Result<String, PlotError> {
    let machine = &report.machine;
    let notes = vec![
        format!(
            "{}, threads: {}, built for {}",
            machine.processor.as_deref().unwrap_or("unknown processor"),
            report.threads,
            machine.isa,
        ),
        "Medians, a bar as long as their median absolute deviation to either side, and the power of the count that they follow."
            .into(),
        "Grey lines are linear: of slope 1, and of −1 where threads share the work. Pictures for samples, lights and levels have \
         half the sides."
            .into(),
    ];
    Panels {
        title: "How cost grows".into(),
        notes,
        legend: vec![(Mark::Full, "a frame, traced and shaded"), (Mark::Open, "building")],
        panels: panels(&report.growth),
    }
    .draw()
}

/// Of scenes, in turns. The fourth is that of the standard set which has all panels.
const COLOURS: [Colour; 5] =
    [Colour::LANES[1], Colour::LIMIT, Colour::TRUTH, Colour::LANES[3], Colour::LANES[2]];

/// In the order in which things that grow come first; none where nothing was measured.
fn panels(growth: &[Growth]) -> Vec<Panel> {
    let (overs, scenes) = (firsts(growth, |growth| growth.over), firsts(growth, |growth| &growth.scene));
    let panel = |over: &str| {
        let lines = growth.iter().filter(|growth| growth.over == over).flat_map(|growth| {
            let scene = scenes.iter().position(|&scene| scene == growth.scene).unwrap_or(0);
            lines(growth, COLOURS[scene % COLOURS.len()])
        });
        panel(over, lines.collect())
    };
    overs.into_iter().filter_map(panel).collect()
}

/// Each once.
fn firsts<'a>(growth: &'a [Growth], of: fn(&'a Growth) -> &'a str) -> Vec<&'a str> {
    let mut firsts = vec![];
    for name in growth.iter().map(of) {
        if !firsts.contains(&name) {
            firsts.push(name);
        }
    }
    firsts
}

fn panel(over: &str, series: Vec<Series>) -> Option<Panel> {
    if series.is_empty() {
        return None;
    }
    let guides: Vec<Guide> = guide(&series, if over == "threads" { -1 } else { 1 }).into_iter().collect();
    let points = || series.iter().flat_map(|series| &series.points);
    let x = Axis::close_log("", points().map(|point| point.x));
    let seconds = points().map(|point| point.y + point.y_spread).chain(points().map(|point| point.y));
    let y = Axis::log("", seconds.chain(guides.iter().map(|guide| guide.to.1)));
    let what = match over {
        "samples" => "samples a pixel",
        "levels" => "levels of rays",
        other => other,
    };
    let chart = Chart { x, y, series, rules: vec![], guides };
    Some(Panel { heading: format!("Seconds over {what}"), chart })
}

/// For the frame, and for building where that was measured.
fn lines(growth: &Growth, colour: Colour) -> impl Iterator<Item = Series> {
    let name = short(&growth.scene);
    let frame = line(growth, |point| point.frame_seconds, named(&name, growth.frame_exponent));
    let build = format!("{name}, build");
    let build = line(growth, |point| point.build_seconds, named(&build, growth.build_exponent));
    let series = |mark| move |points| Series { points, colour, mark, is_line: true };
    frame.map(series(Mark::Full)).into_iter().chain(build.map(series(Mark::Open)))
}

/// Points with the name at the last; none without points.
fn line(growth: &Growth, of: fn(&GrowthPoint) -> Option<Spread>, label: String) -> Option<Vec<Point>> {
    let plotted = growth.points.iter().filter_map(|point| {
        let Spread { median, median_absolute_deviation, .. } = of(point)?;
        let is_on_axes = point.count > 0 && median > 0.0 && median.is_finite();
        let (x, y_spread) = (point.count as f64, median_absolute_deviation);
        is_on_axes.then_some(Point { x, y: median, y_spread, label: String::new() })
    });
    let mut points: Vec<Point> = plotted.collect();
    points.last_mut()?.label = label;
    Some(points)
}

fn named(name: &str, power: Option<f64>) -> String {
    power.map_or_else(|| name.to_owned(), |_| format!("{name} {}", exponent(power).replace('-', "−")))
}

/// The end of a name that is too long to stand beside a line, from the name of a folder or a file on.
fn short(name: &str) -> String {
    const MOST: usize = 16;
    // Markup has no way to say control characters.
    let said = |character: char| if character.is_control() { '\u{fffd}' } else { character };
    let letters: Vec<char> = name.chars().map(said).collect();
    let Some(left_out) = letters.len().checked_sub(MOST).filter(|&left_out| left_out > 0) else {
        return letters.into_iter().collect();
    };
    let end = &letters[left_out..];
    let folder = end.iter().position(|&letter| letter == '/').unwrap_or(0);
    format!("…{}", end[folder..].iter().collect::<String>())
}

/// A line of a slope over all counts: upwards from the lowest start of others, or downwards from the highest.
fn guide(series: &[Series], slope: i8) -> Option<Guide> {
    let slope = f64::from(slope);
    let starts = series.iter().filter_map(|series| series.points.first());
    let start = starts.min_by(|a, b| (slope * a.y).total_cmp(&(slope * b.y)))?;
    let last = series.iter().flat_map(|series| &series.points).map(|point| point.x).fold(start.x, f64::max);
    let to = (last, start.y * (last / start.x).powf(slope));
    (last > start.x).then(|| Guide {
        from: (start.x, start.y),
        to,
        label: format!("n^{slope}").replace('-', "−"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::Better;
    use crate::rays::RayCounts;

    /// Seconds to build and of the frame by count, below 0 for what is not measured.
    fn growth(over: &'static str, scene: &str, points: &[(u64, f64, f64)], power: Option<f64>) -> Growth {
        let seconds = |seconds: f64| Spread::of(vec![seconds], Better::Less).filter(|_| seconds >= 0.0);
        let point = |&(count, build, frame): &(u64, f64, f64)| GrowthPoint {
            count,
            rays: RayCounts::default(),
            build_seconds: seconds(build),
            frame_seconds: seconds(frame),
        };
        Growth {
            over,
            scene: scene.to_owned(),
            points: points.iter().map(point).collect(),
            build_exponent: power,
            frame_exponent: power,
        }
    }

    /// Headings with the labels in them.
    fn words(panels: &[Panel]) -> Vec<(&str, Vec<String>)> {
        let labels = |panel: &Panel| {
            let points = panel.chart.series.iter().filter_map(|series| series.points.last());
            let guides = panel.chart.guides.iter().map(|guide| guide.label.clone());
            points.map(|point| point.label.clone()).chain(guides).collect()
        };
        panels.iter().map(|panel| (panel.heading.as_str(), labels(panel))).collect()
    }

    fn draw(panels: Vec<Panel>) -> String {
        Panels { title: "t".into(), notes: vec![], legend: vec![(Mark::Full, "m")], panels }.draw().unwrap()
    }

    #[test]
    fn a_panel_for_each_thing_and_a_line_for_each_scene_and_time() {
        let (both, frame) = ([(10, 0.1, 1.0), (100, 1.0, 2.0)], [(1, -1.0, 1.0), (2, -1.0, 0.5)]);
        let panels = panels(&[
            growth("primitives", "a", &both, Some(1.0)),
            growth("primitives", "b", &both, Some(0.5)),
            growth("threads", "a", &frame, Some(-1.0)),
            growth("samples", "a", &frame, None),
        ]);
        let primitives = ["a n^1.00", "a, build n^1.00", "b n^0.50", "b, build n^0.50", "n^1"];
        let expected: [(&str, &[&str]); 3] = [
            ("Seconds over primitives", &primitives),
            ("Seconds over threads", &["a n^−1.00", "n^−1"]),
            ("Seconds over samples a pixel", &["a", "n^1"]),
        ];
        let expected =
            expected.map(|(heading, labels)| (heading, labels.iter().map(|&it| it.into()).collect()));
        assert_eq!(words(&panels), expected);
        let colours: Vec<_> = panels[0].chart.series.iter().map(|series| series.colour).collect();
        assert_eq!(colours, [COLOURS[0], COLOURS[0], COLOURS[1], COLOURS[1]]);

        let svg = draw(panels);
        assert_eq!(svg.matches("<circle").count(), 2 * (4 + 1 + 1) + 1, "marks, and that of the legend");
        assert_eq!(svg.matches("prefers-color-scheme: dark").count(), 1);
    }

    /// Others are held against a line through the lowest start, or for threads through the highest.
    #[test]
    fn a_guide_starts_where_a_line_does() {
        let two = |over| {
            let [low, high] = [0.1, 1.0].map(|start| [(1, -1.0, start), (8, -1.0, start)]);
            let growth = [growth(over, "low", &low, None), growth(over, "high", &high, None)];
            let Guide { from, to, .. } = panels(&growth).remove(0).chart.guides.remove(0);
            (from, to)
        };
        assert_eq!(two("lights"), ((1.0, 0.1), (8.0, 0.1 * 8.0)));
        assert_eq!(two("threads"), ((1.0, 1.0), (8.0, 0.125)));
    }

    #[test]
    fn what_has_no_points_has_no_panel() {
        let zeros = [(0, 1.0, 1.0), (1, 0.0, 0.0), (2, -1.0, -1.0)];
        let growth = [growth("pixels", "a", &[], None), growth("lights", "a", &zeros, None)];
        assert!(panels(&growth).is_empty());
        let svg = draw(vec![]);
        assert!(svg.ends_with("</svg>\n") && !svg.contains("NaN"), "{svg}");
    }

    #[test]
    fn odd_numbers_are_drawn_too() {
        let odd: [&[(u64, f64, f64)]; 5] = [
            &[(1, 1.0, 1.0)],
            &[(5, 2.0, 2.0), (5, 2.0, 2.0)],
            &[(1, 0.5, 0.5), (2, 0.5, 0.5), (4, 0.5, 0.5)],
            &[(1, 1e-300, 1e300), (u64::MAX, 1e300, 1e-300)],
            &[(7, -1.0, 5e-324)],
        ];
        for points in odd {
            for over in ["primitives", "threads"] {
                let panels = panels(&[growth(over, "a", points, None)]);
                assert_eq!(panels.len(), 1);
                let is_one_count = points.iter().all(|point| point.0 == points[0].0);
                assert_eq!(panels[0].chart.guides.is_empty(), is_one_count, "{points:?}");
                let svg = draw(panels);
                assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
            }
        }
    }

    /// All lines that the standard set has end in one column; there is room for their names above each other.
    #[test]
    fn labels_of_many_lines_do_not_cover_each_other() {
        let points = [(1000, 1.0, 1.0), (10_000, 1.0, 1.0)];
        let scenes = ["sphereflake", "tetrahedra", "gears", "terrain", "glass"];
        let svg = draw(panels(&scenes.map(|scene| growth("primitives", scene, &points, Some(0.0)))));
        let row = |text: &str| text.split(" y=\"").nth(1)?.split('"').next()?.parse::<i32>().ok();
        let labels = svg.split("<text").filter(|text| text.contains("\n") && text.contains("n^"));
        let mut rows: Vec<i32> = labels.filter_map(row).collect();
        rows.sort_unstable();
        assert_eq!(rows.len(), 11, "{svg}");
        assert!(rows.windows(2).all(|pair| pair[1] - pair[0] >= 15), "{rows:?}");
    }

    #[test]
    fn of_a_long_name_the_end_is_said() {
        for (name, said) in [
            ("sphereflake", "sphereflake"),
            ("scenes/glass.toml", "…/glass.toml"),
            ("scenes/a/room.toml", "…/a/room.toml"),
            ("a-very-long-name-of-a-scene.toml", "…-of-a-scene.toml"),
            ("a\nb", "a\u{fffd}b"),
            ("", ""),
        ] {
            assert_eq!(short(name), said);
        }
    }
}
