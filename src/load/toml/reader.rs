//! Values of a TOML document, each read with the place to point at when it is not what is wanted.

use crate::load::error::{InputError, Warnings};
use crate::load::number::{self, rounded_3};
use crate::load::suggest::{did_you_mean, listed};
use crate::load::text::Text;
use crate::scene::Rgb;
use glam::{DVec3, Vec3};
use std::ops::RangeInclusive;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A table whose keys are all known.
#[derive(Clone, Copy)]
pub(super) struct Table<'a> {
    text: &'a Text,
    /// As messages call it, such as `[camera]`.
    name: &'a str,
    offset: usize,
    table: &'a DeTable<'a>,
}

/// A value, its key, and the place of both.
#[derive(Clone, Copy)]
pub(super) struct Value<'a> {
    text: &'a Text,
    key: &'a str,
    key_offset: usize,
    value: &'a Spanned<DeValue<'a>>,
}

impl<'a> Table<'a> {
    /// Refuses a key that is not among `keys`.
    pub(super) fn new(
        text: &'a Text,
        name: &'a str,
        offset: usize,
        table: &'a DeTable<'a>,
        keys: &[&str],
    ) -> Result<Self, InputError> {
        let unknown = table.iter().filter(|(key, _)| !keys.contains(&key.get_ref().as_ref()));
        if let Some((key, _)) = unknown.min_by_key(|(key, _)| key.span().start) {
            let word = key.get_ref();
            let message = format!(
                "unknown key `{}` in {name}{}; known keys are {}",
                number::shortened(word),
                did_you_mean(word, keys.iter().copied()),
                listed(keys.iter().copied())
            );
            return Err(text.error(key.span().start, message));
        }
        Ok(Self { text, name, offset, table })
    }

    pub(super) fn get(&self, key: &str) -> Option<Value<'a>> {
        self.table.get_key_value(key).map(|(key, value)| self.value(key, value))
    }

    /// The value of a key that must be there.
    pub(super) fn require(&self, key: &str) -> Result<Value<'a>, InputError> {
        self.get(key).ok_or_else(|| self.error(format!("{} needs a key `{key}`", self.name)))
    }

    /// All keys and values.
    pub(super) fn entries(&self) -> impl Iterator<Item = Value<'a>> {
        self.table.iter().map(|(key, value)| self.value(key, value))
    }

    pub(super) fn offset(&self) -> usize {
        self.offset
    }

    pub(super) fn text(&self) -> &'a Text {
        self.text
    }

    /// Refuses the table as a whole.
    pub(super) fn error(&self, message: impl Into<String>) -> InputError {
        self.text.error(self.offset, message)
    }

    fn value(
        &self,
        key: &'a Spanned<std::borrow::Cow<'a, str>>,
        value: &'a Spanned<DeValue<'a>>,
    ) -> Value<'a> {
        Value { text: self.text, key: key.get_ref(), key_offset: key.span().start, value }
    }
}

impl<'a> Value<'a> {
    pub(super) fn key(&self) -> &'a str {
        self.key
    }

    /// Refuses the value.
    pub(super) fn error(&self, message: impl Into<String>) -> InputError {
        self.text.error(self.offset(), message)
    }

    /// Where the value begins; a table that a header opens begins at the header.
    pub(super) fn offset(&self) -> usize {
        self.value.span().start
    }

    fn wrong_type(&self, wanted: &str) -> InputError {
        let found = match self.value.get_ref() {
            DeValue::String(_) => "a string",
            DeValue::Integer(_) => "a whole number",
            DeValue::Float(_) => "a decimal number",
            DeValue::Boolean(_) => "a truth value",
            DeValue::Datetime(_) => "a date",
            DeValue::Array(_) => "a list",
            DeValue::Table(_) => "a table",
        };
        self.error(format!("`{}` must be {wanted}; this is {found}", self.key))
    }

    pub(super) fn number(&self) -> Result<f64, InputError> {
        self.number_or("a number")
    }

    fn number_or(&self, wanted: &str) -> Result<f64, InputError> {
        let parsed = match self.value.get_ref() {
            // Radices other than ten hold no more digits than u64; a decimal integer may be of any length.
            DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str().parse().ok(),
            DeValue::Integer(integer) => {
                u64::from_str_radix(integer.as_str(), integer.radix()).ok().map(|value| value as f64)
            }
            DeValue::Float(float) => float.as_str().parse().ok(),
            _ => return Err(self.wrong_type(wanted)),
        };
        let value = parsed.ok_or_else(|| self.wrong_type(wanted))?;
        number::check(value).map_err(|message| self.error(format!("`{}`: {message}", self.key)))
    }

    pub(super) fn float(&self) -> Result<f32, InputError> {
        self.number().map(number::rounded)
    }

    /// A number that is not negative.
    pub(super) fn not_negative(&self) -> Result<f32, InputError> {
        match self.float()? {
            value if value < 0.0 => {
                Err(self.error(format!("`{}` is {value}; it must not be negative", self.key)))
            }
            value => Ok(value),
        }
    }

    pub(super) fn integer(&self, range: RangeInclusive<u64>) -> Result<u64, InputError> {
        let (low, high) = (*range.start(), *range.end());
        let wanted = format!("a whole number from {low} to {high}");
        let DeValue::Integer(integer) = self.value.get_ref() else { return Err(self.wrong_type(&wanted)) };
        match u64::from_str_radix(integer.as_str(), integer.radix()) {
            Ok(value) if range.contains(&value) => Ok(value),
            _ => Err(self.error(format!("`{}` is {integer}; it must be {wanted}", self.key))),
        }
    }

    pub(super) fn boolean(&self) -> Result<bool, InputError> {
        self.value.get_ref().as_bool().ok_or_else(|| self.wrong_type("true or false"))
    }

    pub(super) fn string(&self) -> Result<&'a str, InputError> {
        match self.value.get_ref() {
            DeValue::String(string) => Ok(string),
            _ => Err(self.wrong_type("a string")),
        }
    }

    /// One of some words, each of which stands for something.
    pub(super) fn one_of<T: Copy>(&self, words: &[(&str, T)]) -> Result<T, InputError> {
        let word = self.string()?;
        let names = || words.iter().map(|(name, _)| *name);
        words.iter().find(|(name, _)| *name == word).map(|(_, meaning)| *meaning).ok_or_else(|| {
            let meant = did_you_mean(word, names());
            let word = number::shortened(word);
            self.error(format!("`{}` is \"{word}\"; it must be one of {}{meant}", self.key, listed(names())))
        })
    }

    /// A list; its items keep the key's name.
    pub(super) fn list(&self, wanted: &str) -> Result<Vec<Self>, InputError> {
        let DeValue::Array(items) = self.value.get_ref() else { return Err(self.wrong_type(wanted)) };
        Ok(items.iter().map(|value| Self { value, ..*self }).collect())
    }

    pub(super) fn numbers<const N: usize>(&self) -> Result<[f64; N], InputError> {
        let wanted = format!("a list of {N} numbers");
        let items = self.list(&wanted)?;
        let items: [Self; N] = items.try_into().map_err(|items: Vec<Self>| {
            self.error(format!("`{}` must be {wanted}; this list has {}", self.key, items.len()))
        })?;
        let mut numbers = [0.0; N];
        for (number, item) in numbers.iter_mut().zip(&items) {
            *number = item.number()?;
        }
        Ok(numbers)
    }

    pub(super) fn vector(&self) -> Result<Vec3, InputError> {
        self.numbers().map(|numbers| rounded_3(DVec3::from(numbers)))
    }

    /// Three numbers, or one for grey.
    pub(super) fn color(&self) -> Result<Rgb, InputError> {
        match self.value.get_ref() {
            DeValue::Array(_) => self.vector(),
            _ => self
                .number_or("a colour: [r, g, b], or one number for grey")
                .map(number::rounded)
                .map(Rgb::splat),
        }
    }

    /// A colour without negative channels.
    pub(super) fn coefficient(&self) -> Result<Rgb, InputError> {
        let color = self.color()?;
        if color.min_element() < 0.0 {
            return Err(self.error(format!(
                "`{}` has the channel {}; none may be negative",
                self.key,
                color.min_element()
            )));
        }
        Ok(color)
    }

    /// A table of known keys; `name` is what messages call it.
    pub(super) fn table(&self, name: &'a str, keys: &[&str]) -> Result<Table<'a>, InputError> {
        match self.value.get_ref() {
            DeValue::Table(table) => Table::new(self.text, name, self.offset(), table, keys),
            _ => Err(self.error(format!("`{}` must be a table; write {name}", self.key))),
        }
    }

    /// A table whose keys are the user's own names.
    pub(super) fn any_table(&self, name: &'a str) -> Result<Table<'a>, InputError> {
        match self.value.get_ref() {
            DeValue::Table(table) => Ok(Table { text: self.text, name, offset: self.offset(), table }),
            _ => Err(self.error(format!("`{}` must hold tables; write {name}", self.key))),
        }
    }

    /// Tables of known keys, as `[[name]]` or as a list of inline tables.
    pub(super) fn tables(&self, name: &'a str, keys: &[&str]) -> Result<Vec<Table<'a>>, InputError> {
        match self.value.get_ref() {
            DeValue::Array(_) => self.list(name)?.iter().map(|item| item.table(name, keys)).collect(),
            _ => Err(self.text.error(
                self.key_offset,
                format!("`{}` may appear many times; write {name} with two brackets", self.key),
            )),
        }
    }

    /// Warns about the value.
    pub(super) fn warn(&self, warnings: &mut Warnings, message: &str) {
        self.text.warn(warnings, message, self.offset(), || message.to_owned());
    }
}
