//! The lines of OBJ and MTL files as they are meant: continued ones joined, comments cut off.

/// A line with its continuations joined and its comment cut off.
pub(super) struct LogicalLine<'a> {
    pub(super) words: Vec<(&'a str, usize)>,
    /// Where the line, or what comes after its first word, ends.
    end: usize,
}

impl<'a> LogicalLine<'a> {
    /// What follows the first word, which may hold spaces.
    pub(super) fn rest(&self, content: &'a str) -> &'a str {
        self.words.get(1).map_or("", |&(_, offset)| content[offset..self.end].trim_end())
    }
}

/// The lines of an OBJ or MTL file that say something.
pub(super) fn logical_lines(content: &str) -> Vec<LogicalLine<'_>> {
    let mut lines: Vec<LogicalLine<'_>> = Vec::new();
    let mut continued = false;
    let mut offset = 0;
    for raw in content.split_inclusive('\n') {
        let line = raw.trim_end();
        // A name may hold a #, which begins a comment elsewhere.
        let first = line.split_whitespace().next().unwrap_or_default();
        let is_name = ["newmtl", "usemtl", "mtllib", "o", "g"].contains(&first);
        let code = if is_name { line } else { line.split('#').next().unwrap_or_default() };
        let (code, continues) = match code.trim_end().strip_suffix('\\') {
            Some(code) => (code, true),
            None => (code, false),
        };
        let words =
            code.split_whitespace().map(|word| (word, offset + (word.as_ptr().addr() - raw.as_ptr().addr())));
        let end = offset + code.len();
        match lines.last_mut() {
            Some(last) if continued => {
                last.words.extend(words);
                last.end = end;
            }
            _ => lines.push(LogicalLine { words: words.collect(), end }),
        }
        continued = continues;
        offset += raw.len();
    }
    lines.retain(|line| !line.words.is_empty());
    lines
}
