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
            let codes = coded(channels, |channel| u8::try_from(table.code(channel)).unwrap_or(u8::MAX));
            encoder.write_image(&codes, width, height, ExtendedColorType::Rgb8)
        }
        BitDepth::Sixteen => {
            let table = Codes::of_16_bits();
            let codes = coded(channels, |channel| table.code(channel));
            encoder.write_image(bytemuck::cast_slice(&codes), width, height, ExtendedColorType::Rgb16)
        }
    };
    written.map_err(io::Error::other)
}

/// Many side by side, which is sooner done than one after the other into a list that grows.
fn coded<T: Copy + Default + Send>(channels: &[f32], code: impl Fn(f32) -> T + Sync) -> Vec<T> {
    const AT_ONCE: usize = 1 << 14;
    let mut codes = vec![T::default(); channels.len()];
    codes.par_chunks_mut(AT_ONCE).zip(channels.par_chunks(AT_ONCE)).for_each(|(codes, channels)| {
        for (to, &channel) in codes.iter_mut().zip(channels) {
            *to = code(channel);
        }
    });
    codes
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::collection::vec;
    use proptest::prelude::*;

    fn written(image: &Image, depth: BitDepth, threads: usize) -> Vec<u8> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut bytes = Vec::new();
        pool.install(|| write(image, depth, &mut bytes)).unwrap();
        bytes
    }

    proptest! {
        #[test]
        fn what_is_written_reads_back_as_its_codes(
            width in 1_u32..40,
            channels in vec(prop_oneof![0.0_f32..1.0, Just(0.5), any::<f32>()], 3 * 40..2000),
        ) {
            let height = u32::try_from(channels.len()).unwrap() / 3 / width;
            let (pixels, _) = channels.as_chunks();
            let pixels = pixels[..(width * height) as usize].to_vec();
            let image = Image { width, height, pixels };
            for (depth, table, max_code) in [
                (BitDepth::Eight, Codes::of_8_bits(), f32::from(u8::MAX)),
                (BitDepth::Sixteen, Codes::of_16_bits(), f32::from(u16::MAX)),
            ] {
                let decoded = read(&written(&image, depth, 2)).unwrap();
                let coded = |pixel: &[f32; 3]| pixel.map(|channel| f32::from(table.code(channel)) / max_code);
                prop_assert_eq!((decoded.width, decoded.height), (width, height));
                prop_assert_eq!(decoded.pixels, image.pixels.iter().map(coded).collect::<Vec<_>>());
            }
        }
    }

    #[test]
    fn the_file_does_not_depend_on_the_number_of_threads() {
        let [width, height] = [331, 257];
        let level = |step: u32| f32::from(u16::try_from(step % 1009).unwrap()) / 1000.0;
        let pixels = (0..width * height)
            .map(|at| [level(at), level(at / width), level(at.wrapping_mul(at) / 7)])
            .collect();
        let image = Image { width, height, pixels };
        for depth in [BitDepth::Eight, BitDepth::Sixteen] {
            let alone = written(&image, depth, 1);
            for threads in 2..=5 {
                assert!(written(&image, depth, threads) == alone, "{threads} threads, {depth:?}");
            }
        }
    }
}
