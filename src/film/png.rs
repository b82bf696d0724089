//! PNG: clamped to [0, 1] and sRGB, 8 or 16 bits a channel.

use super::srgb::Codes;
use super::{BitDepth, Image};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, ImageFormat};
use rayon::prelude::*;
use std::io::{self, Write};

/// Converts on the threads of the pool that it is called in; the bytes do not depend on them.
///
/// The compression is one made for PNG, on one thread: docs/performance.md, "Reading and writing files".
pub(super) fn write(image: &Image, depth: BitDepth, writer: &mut impl Write) -> io::Result<()> {
    let channels = image.pixels.as_flattened();
    let encoder = PngEncoder::new_with_quality(writer, CompressionType::Fast, FilterType::Paeth);
    let (width, height) = (image.width, image.height);
    let written = match depth {
        BitDepth::Eight => {
            let table = Codes::of_8_bits();
            let code = |&channel: &f32| u8::try_from(table.code(channel)).unwrap_or(u8::MAX);
            let codes: Vec<u8> = channels.par_iter().map(code).collect();
            encoder.write_image(&codes, width, height, ExtendedColorType::Rgb8)
        }
        BitDepth::Sixteen => {
            let table = Codes::of_16_bits();
            let codes: Vec<u16> = channels.par_iter().map(|&channel| table.code(channel)).collect();
            encoder.write_image(bytemuck::cast_slice(&codes), width, height, ExtendedColorType::Rgb16)
        }
    };
    written.map_err(io::Error::other)
}

/// sRGB values 0–1; an alpha channel is left aside, grey is spread over the channels.
pub(super) fn read(bytes: &[u8]) -> Result<Image, String> {
    let decoded = image::load_from_memory_with_format(bytes, ImageFormat::Png)
        .map_err(|error| format!("this is not a PNG that can be read: {error}"))?;
    // 8-bit codes become 16-bit ones by × 257, so dividing by 65535 is exact for both.
    let codes = decoded.into_rgb16();
    let (width, height) = codes.dimensions();
    let unit = |code: u16| f32::from(code) / f32::from(u16::MAX);
    Ok(Image { width, height, pixels: codes.pixels().map(|pixel| pixel.0.map(unit)).collect() })
}
