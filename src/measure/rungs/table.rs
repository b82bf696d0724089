//! Rows of words in columns of equal width.

use std::fmt::{self, Display, Formatter};

/// What stands for a number that there is none of.
pub(super) const NONE: &str = "–";

/// A heading and rows, as words; each row as long as the heading.
pub(super) struct Table {
    rows: Vec<Vec<String>>,
}

impl Table {
    pub(super) fn new(heading: &[&str]) -> Self {
        Self { rows: vec![heading.iter().map(|&word| word.to_owned()).collect()] }
    }

    pub(super) fn add(&mut self, row: impl IntoIterator<Item = String>) {
        self.rows.push(row.into_iter().collect());
    }
}

impl Display for Table {
    /// The first column to the left, the others to the right.
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let length =
            |row: &Vec<String>, column: usize| row.get(column).map_or(0, |word| word.chars().count());
        let widths: Vec<usize> = (0..columns)
            .map(|column| self.rows.iter().map(|row| length(row, column)).max().unwrap_or(0))
            .collect();
        for row in &self.rows {
            for (column, (word, &width)) in row.iter().zip(&widths).enumerate() {
                match column {
                    0 => write!(f, "{word:<width$}")?,
                    _ => write!(f, "  {word:>width$}")?,
                }
            }
            writeln!(f)?;
        }
        Ok(())
    }
}

/// A number in a column, or what stands for none.
pub(super) fn or_none(number: Option<f64>, format: impl Fn(f64) -> String) -> String {
    number.map_or_else(|| NONE.to_owned(), format)
}

/// Two or three digits, whatever the size.
pub(super) fn short(number: f64) -> String {
    match number.abs() {
        0.0 => "0".to_owned(),
        size if !(0.01..1e5).contains(&size) => format!("{number:.1e}"),
        size if size < 1.0 => format!("{number:.3}"),
        size if size < 10.0 => format!("{number:.2}"),
        size if size < 100.0 => format!("{number:.1}"),
        _ => format!("{number:.0}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_line_up_and_the_first_stands_left() {
        let mut table = Table::new(&["what", "ns"]);
        table.add(["a".to_owned(), "1.25".to_owned()]);
        table.add(["longer".to_owned(), NONE.to_owned()]);
        assert_eq!(table.to_string(), "what      ns\na       1.25\nlonger     –\n");
    }

    #[test]
    fn numbers_keep_two_or_three_digits() {
        let words = [0.0, 1.5e-5, 0.25, 2.0, 31.42, 271.8, 3.0e7].map(short);
        assert_eq!(words, ["0", "1.5e-5", "0.250", "2.00", "31.4", "272", "3.0e7"]);
    }
}
