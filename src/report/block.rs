//! What a report is made of, whether it is printed or put on a page.

use super::table::Table;

/// A piece of a report.
pub(crate) enum Block {
    /// A paragraph without line breaks.
    Words(String),
    /// A table.
    Table(Table),
}

/// For a terminal: a blank line between blocks, and none at the end.
pub(crate) fn text(blocks: &[Block]) -> String {
    let text = |block: &Block| match block {
        Block::Words(words) => wrapped(words),
        Block::Table(table) => table.lines().trim_end().to_owned(),
    };
    blocks.iter().map(text).collect::<Vec<_>>().join("\n\n")
}

/// Lines of at most 120 characters, but for longer words.
fn wrapped(words: &str) -> String {
    const LONGEST: usize = 120;
    let mut text = String::new();
    let mut length = 0;
    for word in words.split(' ') {
        let more = word.chars().count();
        if length > 0 && length + 1 + more > LONGEST {
            text.push('\n');
            length = 0;
        } else if length > 0 {
            text.push(' ');
            length += 1;
        }
        text += word;
        length += more;
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paragraphs_are_wrapped_between_words() {
        let words = "nine char ".repeat(20);
        let text = wrapped(words.trim_end());
        assert!(text.lines().count() == 2 && text.lines().all(|line| line.len() <= 120), "{text}");
        assert_eq!(text.replace('\n', " "), words.trim_end());
        assert_eq!(wrapped(&"x".repeat(130)).len(), 130);
    }

    #[test]
    fn blocks_are_a_blank_line_apart() {
        let mut table = Table::new(1, ["a", "b"]);
        table.push(vec!["c".into(), "1".into()]);
        assert_eq!(text(&[Block::Words("Words.".into()), Block::Table(table)]), "Words.\n\na  b\nc  1");
    }
}
