//! Tables: for a terminal, with columns as wide as what is in them; for a page, see [`html`](super::html). Words stand to the
//! left, numbers to the right.

use crate::measure::Spread;

/// Rows of cells; the first row is the heading, and rows may end early.
pub(crate) struct Table {
    pub(super) rows: Vec<Vec<String>>,
    /// Columns of words, the first ones.
    pub(super) words: usize,
}

impl Table {
    pub(crate) fn new<'a>(words: usize, heading: impl IntoIterator<Item = &'a str>) -> Self {
        Self { rows: vec![heading.into_iter().map(str::to_owned).collect()], words }
    }

    pub(crate) fn push(&mut self, row: Vec<String>) {
        self.rows.push(row);
    }

    /// A line a row.
    pub(crate) fn lines(&self) -> String {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let cells = |column: usize| self.rows.iter().filter_map(move |row| row.get(column));
        let widths: Vec<usize> = (0..columns)
            .map(|column| cells(column).map(|cell| cell.chars().count()).max().unwrap_or(0))
            .collect();
        let line = |row: &Vec<String>| {
            let cells = row.iter().zip(&widths).enumerate().map(|(column, (cell, &width))| {
                if column < self.words { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
            });
            format!("{}\n", cells.collect::<Vec<_>>().join("  ").trim_end())
        };
        self.rows.iter().map(line).collect()
    }
}

/// What stands where there is no number.
pub(crate) const NONE: &str = "–";

/// A number, where there is one, with three significant digits or so; without an exponent where that is readable.
pub(crate) fn number(value: f64) -> String {
    let size = value.abs();
    if value.is_nan() {
        NONE.into()
    } else if size.is_infinite() {
        if value > 0.0 { "∞".into() } else { "-∞".into() }
    } else if size == 0.0 {
        "0".into()
    } else if !(1e-3..1e6).contains(&size) {
        format!("{value:.1e}")
    } else if size < 1e-2 {
        format!("{value:.5}")
    } else if size < 0.1 {
        format!("{value:.4}")
    } else if size < 1.0 {
        format!("{value:.3}")
    } else if size < 10.0 {
        format!("{value:.2}")
    } else if size < 100.0 {
        format!("{value:.1}")
    } else {
        format!("{value:.0}")
    }
}

/// The same, where there may be none.
pub(crate) fn maybe(value: Option<f64>) -> String {
    value.map_or_else(|| NONE.into(), number)
}

/// The middle of repeats, where there are any.
pub(super) fn median(spread: Option<Spread>) -> Option<f64> {
    spread.map(|spread| spread.median)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_as_wide_as_what_is_in_them() {
        let mut table = Table::new(1, ["engine", "s"]);
        table.push(vec!["scalar".into(), "12.5".into()]);
        table.push(vec!["é".into(), NONE.into()]);
        assert_eq!(table.lines(), "engine     s\nscalar  12.5\né          –\n");
    }

    #[test]
    fn numbers_have_a_sane_count_of_digits() {
        for (value, text) in [
            (0.0, "0"),
            (1e-7, "1.0e-7"),
            (0.001234, "0.00123"),
            (0.01236, "0.0124"),
            (0.1234, "0.123"),
            (1.236, "1.24"),
            (12.36, "12.4"),
            (123_456.7, "123457"),
            (1.5e7, "1.5e7"),
            (-2.5, "-2.50"),
            (f64::NAN, NONE),
            (f64::INFINITY, "∞"),
        ] {
            assert_eq!(number(value), text);
        }
        assert_eq!(maybe(None), NONE);
    }
}
