//! The words of a text, one after the other, wherever its lines break; `#` begins a comment.

use super::error::InputError;
use super::number;
use super::text::Text;
use glam::DVec3;

/// A word and the byte offset where it begins.
#[derive(Clone, Copy)]
pub(super) struct Word<'a> {
    pub(super) text: &'a str,
    pub(super) offset: usize,
}

/// A place between two words of a text.
pub(super) struct Words<'a> {
    source: &'a Text,
    offset: usize,
}

impl<'a> Words<'a> {
    pub(super) fn new(source: &'a Text) -> Self {
        Self { source, offset: 0 }
    }

    pub(super) fn peek(&self) -> Option<Word<'a>> {
        let content = self.source.content.as_str();
        let mut offset = self.offset;
        loop {
            let rest = content.get(offset..)?;
            offset += rest.len() - rest.trim_start().len();
            let rest = content.get(offset..)?;
            if !rest.starts_with('#') {
                let length = rest.find(|c: char| c.is_whitespace() || c == '#').unwrap_or(rest.len());
                return (length > 0).then(|| Word { text: &rest[..length], offset });
            }
            offset += rest.find('\n').unwrap_or(rest.len());
        }
    }

    pub(super) fn next(&mut self) -> Option<Word<'a>> {
        let word = self.peek()?;
        self.offset = word.offset + word.text.len();
        Some(word)
    }

    /// The next word as a number; `what` names it in messages.
    pub(super) fn number(&mut self, what: &str) -> Result<f64, InputError> {
        match self.next() {
            Some(word) => number::parse(word.text)
                .map_err(|message| self.source.error(word.offset, format!("{message} ({what})"))),
            None => Err(self.source.error(
                self.source.content.trim_end().len(),
                format!("the file ends where a number is expected ({what}); is it cut off?"),
            )),
        }
    }

    pub(super) fn vector(&mut self, what: &str) -> Result<DVec3, InputError> {
        Ok(DVec3::new(self.number(what)?, self.number(what)?, self.number(what)?))
    }

    /// The next word as a whole number that is not negative.
    pub(super) fn count(&mut self, what: &str) -> Result<u64, InputError> {
        let offset = self.peek().map_or(0, |word| word.offset);
        let value = self.number(what)?;
        if value < 0.0 || value.fract() != 0.0 {
            return Err(self
                .source
                .error(offset, format!("expected a whole number ({what}), found {value}")));
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole, and 0 to 1e18")]
        let value = value as u64;
        Ok(value)
    }
}
