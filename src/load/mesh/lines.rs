//! The lines of OBJ and MTL files as they are meant: continued ones joined, comments cut off.

/// A line with its continuations joined and its comment cut off.
#[derive(Default)]
pub(super) struct LogicalLine<'a> {
    /// Each with the byte offset where it begins.
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

/// The lines of a file that say something, one after the other in the memory of one.
pub(super) struct LogicalLines<'a> {
    content: &'a str,
    /// Where the next line of the file begins.
    offset: usize,
    line: LogicalLine<'a>,
}

impl<'a> LogicalLines<'a> {
    pub(super) fn new(content: &'a str) -> Self {
        Self { content, offset: 0, line: LogicalLine::default() }
    }

    pub(super) fn next(&mut self) -> Option<&LogicalLine<'a>> {
        while self.offset < self.content.len() {
            self.line.words.clear();
            while self.take_line_of_file() {}
            if !self.line.words.is_empty() {
                return Some(&self.line);
            }
        }
        None
    }

    /// Adds the words of the next line of the file, and says whether it goes on in the one after.
    fn take_line_of_file(&mut self) -> bool {
        let offset = self.offset;
        let raw = self.content[offset..].split_inclusive('\n').next().unwrap_or_default();
        self.offset += raw.len();
        let line = raw.trim_end();
        // A name may hold a #, which begins a comment elsewhere.
        let first = line.split_whitespace().next().unwrap_or_default();
        let is_name = ["newmtl", "usemtl", "mtllib", "o", "g"].contains(&first);
        let code = if is_name { line } else { line.split('#').next().unwrap_or_default() };
        let (code, continues) = match code.trim_end().strip_suffix('\\') {
            Some(code) => (code, true),
            None => (code, false),
        };
        let words = code.split_whitespace();
        self.line
            .words
            .extend(words.map(|word| (word, offset + (word.as_ptr().addr() - raw.as_ptr().addr()))));
        self.line.end = offset + code.len();
        continues
    }
}
