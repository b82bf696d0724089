//! A picture as an NPY array: linear f32, (H, W, 3).

use super::Image;
use crate::npy;
use std::io::{self, Write};

pub(super) fn write(image: &Image, writer: &mut impl Write) -> io::Result<()> {
    let shape = [image.height as usize, image.width as usize, 3];
    npy::write(&shape, image.pixels.as_flattened(), writer)
}

pub(super) fn read(bytes: &[u8]) -> Result<Image, String> {
    let array = npy::read::<f32>(bytes)?;
    let &[height, width, 3] = array.shape.as_slice() else {
        let shape = npy::shape_text(&array.shape);
        return Err(format!("a picture in NPY has the shape (height, width, 3); this file's is {shape}"));
    };
    let side = |length: usize| u32::try_from(length).map_err(|_| "the picture is too large".to_owned());
    let (pixels, _) = array.values.as_chunks();
    Ok(Image { width: side(width)?, height: side(height)?, pixels: pixels.to_vec() })
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
        assert_eq!(read(&bytes), Ok(image));
    }

    #[test]
    fn what_has_not_three_channels_is_refused() {
        let mut bytes = Vec::new();
        npy::write(&[2, 2, 4], &[0.0_f32; 16], &mut bytes).unwrap();
        let message = read(&bytes).unwrap_err();
        assert!(message.ends_with("(height, width, 3); this file's is (2, 2, 4)"), "{message}");
    }
}
