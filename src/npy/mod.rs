//! NumPy's NPY format: one array of numbers a file, little-endian f32 or u32 in C order.
//!
//! Read are versions 1, 2 and 3, written is version 1. Source of the layout: NumPy's format specification,
//! "numpy.lib.format". Messages speak of NumPy, since it is what such files are written with.

mod header;

use bytemuck::Pod;
use header::Header;
use std::borrow::Cow;
use std::io::{self, Write};

const MAGIC: &[u8] = b"\x93NUMPY";

/// A type of number that files may hold.
pub(crate) trait Element: Pod {
    /// The format's code for it.
    const DESCR: &'static str;
    /// NumPy's name for it.
    const NAME: &'static str;
    /// Its bytes in little-endian order, or from that order.
    fn little_endian(self) -> Self;
}

impl Element for f32 {
    const DESCR: &'static str = "<f4";
    const NAME: &'static str = "float32";

    fn little_endian(self) -> Self {
        Self::from_bits(self.to_bits().to_le())
    }
}

impl Element for u32 {
    const DESCR: &'static str = "<u4";
    const NAME: &'static str = "uint32";

    fn little_endian(self) -> Self {
        self.to_le()
    }
}

/// The array of a file.
#[derive(Debug, PartialEq)]
pub(crate) struct Array<'a, T: Element> {
    /// How many numbers there are along each axis.
    pub(crate) shape: Vec<usize>,
    /// The product of the shape of them, the last index running fastest. They are the file's own bytes where those are
    /// aligned, as in all files that NumPy writes.
    pub(crate) values: Cow<'a, [T]>,
}

impl<T: Element> Array<'_, T> {
    /// The rows of an array of shape (N, `WIDTH`).
    ///
    /// # Errors
    /// Another shape.
    pub(crate) fn rows<const WIDTH: usize>(&self) -> Result<&[[T; WIDTH]], String> {
        if !matches!(*self.shape, [_, width] if width == WIDTH) {
            let shape = shape_text(&self.shape);
            let hint = match self.shape.as_slice() {
                [length] if length % WIDTH == 0 => format!(" (try .reshape(-1, {WIDTH}))"),
                _ => String::new(),
            };
            return Err(format!("the array's shape is {shape}; it must be (N, {WIDTH}){hint}"));
        }
        Ok(self.values.as_chunks().0)
    }
}

/// The array in the bytes of a file.
///
/// # Errors
/// What is wrong and what would be right.
pub(crate) fn read<T: Element>(bytes: &[u8]) -> Result<Array<'_, T>, String> {
    let (header, data) = split(bytes)?;
    let Header { descr, fortran_order, shape } = Header::parse(header)?;
    if descr != T::DESCR {
        return Err(wrong_type::<T>(&descr));
    }
    if fortran_order {
        return Err("the array is in Fortran order; save np.ascontiguousarray(array)".into());
    }
    check_length::<T>(&shape, data.len())?;
    Ok(Array { shape, values: values(data) })
}

/// Writes an array; `values` are as many as the product of the `shape`.
///
/// # Errors
/// What the writer says.
pub(crate) fn write<T: Element>(shape: &[usize], values: &[T], writer: &mut impl Write) -> io::Result<()> {
    debug_assert_eq!(shape.iter().product::<usize>(), values.len(), "the shape {shape:?} is of these values");
    let mut header =
        format!("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}", T::DESCR, shape_text(shape));
    // Magic, version and length take 10 bytes; the data begin at a multiple of 64, after a line feed.
    while (10 + header.len() + 1) % 64 != 0 {
        header.push(' ');
    }
    header.push('\n');
    writer.write_all(MAGIC)?;
    writer.write_all(&[1, 0])?;
    writer.write_all(&u16::try_from(header.len()).map_err(io::Error::other)?.to_le_bytes())?;
    writer.write_all(header.as_bytes())?;
    if cfg!(target_endian = "little") {
        return writer.write_all(bytemuck::cast_slice(values));
    }
    values.iter().try_for_each(|value| writer.write_all(bytemuck::bytes_of(&value.little_endian())))
}

/// A shape as Python writes it.
pub(crate) fn shape_text(shape: &[usize]) -> String {
    match shape {
        [length] => format!("({length},)"),
        _ => format!("({})", shape.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")),
    }
}

/// The text of the header, and the data.
fn split(bytes: &[u8]) -> Result<(&[u8], &[u8]), String> {
    const CUT_OFF: &str = "the NPY file ends inside its header; it is cut off";
    if bytes.is_empty() {
        return Err("the file is empty; np.save writes an NPY file".into());
    }
    if bytes.starts_with(b"PK") {
        return Err(
            "this is an archive of arrays, as np.savez writes it; save this array with np.save".into()
        );
    }
    let Some(rest) = bytes.strip_prefix(MAGIC) else {
        let message =
            if MAGIC.starts_with(bytes) { CUT_OFF } else { "this is not an NPY file; np.save writes one" };
        return Err(message.into());
    };
    let (length, rest) = match *rest {
        [1, 0, a, b, ref rest @ ..] => (usize::from(u16::from_le_bytes([a, b])), rest),
        [2 | 3, 0, a, b, c, d, ref rest @ ..] => (u32::from_le_bytes([a, b, c, d]) as usize, rest),
        [1..=3, 0, ..] | [] | [_] => return Err(CUT_OFF.into()),
        [major, minor, ..] => {
            return Err(format!(
                "this is NPY version {major}.{minor}; versions 1.0, 2.0 and 3.0 can be read"
            ));
        }
    };
    rest.split_at_checked(length).ok_or_else(|| CUT_OFF.into())
}

/// Refuses data that are not as long as the shape says.
fn check_length<T: Element>(shape: &[usize], found: usize) -> Result<(), String> {
    let text = || format!("an array of shape {} in {}", shape_text(shape), T::NAME);
    let bytes = match shape.contains(&0) {
        true => Some(0),
        false => shape.iter().try_fold(size_of::<T>(), |bytes, &length| bytes.checked_mul(length)),
    };
    let expected = bytes.ok_or_else(|| format!("{} is larger than any memory", text()))?;
    if found < expected {
        return Err(format!("{} takes {expected} bytes and the file has {found}; it is cut off", text()));
    }
    if found > expected {
        let surplus = found - expected;
        return Err(format!("{surplus} bytes follow {}; a file holds one array and nothing else", text()));
    }
    Ok(())
}

fn values<T: Element>(data: &[u8]) -> Cow<'_, [T]> {
    match bytemuck::try_cast_slice(data) {
        Ok(values) if cfg!(target_endian = "little") => Cow::Borrowed(values),
        _ => {
            let value = |bytes| bytemuck::pod_read_unaligned::<T>(bytes).little_endian();
            Cow::Owned(data.chunks_exact(size_of::<T>()).map(value).collect())
        }
    }
}

fn wrong_type<T: Element>(descr: &str) -> String {
    let found = match type_name(descr) {
        Some(name) if descr.starts_with('>') => format!("big-endian {name}"),
        Some(name) => name,
        None => {
            format!("of a type '{}'", descr.chars().take(32).flat_map(char::escape_debug).collect::<String>())
        }
    };
    // NumPy's name for the type means the order of the machine, which is not always the file's.
    let wanted = if descr.starts_with('>') { format!("\"{}\"", T::DESCR) } else { format!("np.{}", T::NAME) };
    format!("the array's numbers are {found}; they must be {}: convert with .astype({wanted})", T::NAME)
}

/// NumPy's name of a type code such as `<f8`, where it is one of numbers.
fn type_name(descr: &str) -> Option<String> {
    let kind = match descr.chars().nth(1)? {
        'f' => "float",
        'i' => "int",
        'u' => "uint",
        'c' => "complex",
        _ => return None,
    };
    let bytes: u8 = descr.get(2..)?.parse().ok()?;
    Some(format!("{kind}{}", u32::from(bytes) * 8))
}

#[cfg(test)]
mod tests;
