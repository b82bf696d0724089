//! NPY version 1.0: linear f32, (H, W, 3) in C order.
//!
//! Source of the layout: NumPy's format specification, "numpy.lib.format".

use super::Image;
use std::io::{self, Write};

const MAGIC: &[u8] = b"\x93NUMPY";

pub(super) fn write(image: &Image, writer: &mut impl Write) -> io::Result<()> {
    let (height, width) = (image.height, image.width);
    let mut header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({height}, {width}, 3), }}");
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
        return writer.write_all(bytemuck::cast_slice(&image.pixels));
    }
    image.pixels.as_flattened().iter().try_for_each(|channel| writer.write_all(&channel.to_le_bytes()))
}

pub(super) fn read(bytes: &[u8]) -> Result<Image, String> {
    const NOT_NPY: &str = "this is not an NPY file";
    let rest = bytes.strip_prefix(MAGIC).ok_or(NOT_NPY)?;
    let (length, rest) = match rest {
        [1, _, a, b, rest @ ..] => (usize::from(u16::from_le_bytes([*a, *b])), rest),
        [2 | 3, _, a, b, c, d, rest @ ..] => (u32::from_le_bytes([*a, *b, *c, *d]) as usize, rest),
        _ => return Err("this is an NPY file of a version other than 1, 2 or 3".into()),
    };
    let (header, data) = rest.split_at_checked(length).ok_or("the NPY file ends inside its header")?;
    let header = std::str::from_utf8(header).map_err(|_| NOT_NPY)?;
    let field = |name: &str| {
        let (_, after) = header.split_once(&format!("'{name}':"))?;
        Some(after.trim_start())
    };
    let (descr, order, shape) = (
        field("descr").ok_or(NOT_NPY)?,
        field("fortran_order").ok_or(NOT_NPY)?,
        field("shape").ok_or(NOT_NPY)?,
    );
    if !descr.starts_with("'<f4'") || !order.starts_with("False") {
        return Err("a picture in NPY is little-endian f32 ('<f4') in C order; this file is not".into());
    }
    let sides: Vec<u32> = shape
        .strip_prefix('(')
        .and_then(|shape| shape.split_once(')'))
        .map(|(shape, _)| shape.split(',').filter_map(|side| side.trim().parse().ok()).collect())
        .unwrap_or_default();
    let &[height, width, 3] = sides.as_slice() else {
        return Err(format!("a picture in NPY has the shape (height, width, 3); this file's is {sides:?}"));
    };
    let expected = u128::from(height) * u128::from(width) * 12;
    if data.len() as u128 != expected {
        return Err(format!(
            "a {width} x {height} picture has {expected} bytes of data; this file has {}",
            data.len()
        ));
    }
    let channel = |at: &[u8]| f32::from_le_bytes([at[0], at[1], at[2], at[3]]);
    let pixels = data
        .chunks_exact(12)
        .map(|at| [channel(&at[0..4]), channel(&at[4..8]), channel(&at[8..12])])
        .collect();
    Ok(Image { width, height, pixels })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_reads_back() {
        let pixels = vec![[0.0, -1.5, 1e30], [f32::INFINITY, 0.25, 3.0]];
        let image = Image { width: 1, height: 2, pixels };
        let mut bytes = Vec::new();
        write(&image, &mut bytes).unwrap();
        assert_eq!(bytes.len() % 64, 24, "the data begin at a multiple of 64");
        assert_eq!(read(&bytes), Ok(image));
    }

    #[test]
    fn a_file_cut_anywhere_is_refused() {
        let image = Image { width: 3, height: 2, pixels: vec![[0.5; 3]; 6] };
        let mut bytes = Vec::new();
        write(&image, &mut bytes).unwrap();
        for length in 0..bytes.len() {
            assert!(read(&bytes[..length]).is_err(), "cut after {length} bytes");
        }
    }
}
