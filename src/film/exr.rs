//! OpenEXR: linear f32 RGB, not clamped.

use super::Image;
use exr::prelude::*;
use std::io::{self, Cursor, Seek, Write};

pub(super) fn write(picture: &Image, writer: &mut (impl Write + Seek)) -> io::Result<()> {
    let (width, height) = (picture.width as usize, picture.height as usize);
    let pixel = |position: Vec2<usize>| {
        let [r, g, b] = picture.pixels[position.y() * width + position.x()];
        (r, g, b)
    };
    // Rows in increasing order make the bytes a function of the picture; the faster encodings leave the order of their
    // blocks open, and a parallel writer then writes them as they are done.
    let layer = Layer::new(
        (width, height),
        LayerAttributes::default(),
        Encoding::SMALL_LOSSLESS,
        SpecificChannels::rgb(pixel),
    );
    exr::prelude::Image::from_layer(layer).write().to_unbuffered(writer).map_err(io::Error::other)
}

pub(super) fn read(bytes: &[u8]) -> std::result::Result<Image, String> {
    let decoded = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            |size: Vec2<usize>, _channels: &_| (size.width(), vec![[0.0_f32; 3]; size.area()]),
            |(width, pixels): &mut (usize, Vec<[f32; 3]>), at, (r, g, b, _a): (f32, f32, f32, f32)| {
                pixels[at.y() * *width + at.x()] = [r, g, b];
            },
        )
        .first_valid_layer()
        .all_attributes()
        .from_unbuffered(Cursor::new(bytes))
        .map_err(|error| format!("this is not an EXR with channels R, G and B that can be read: {error}"))?;
    let size = decoded.layer_data.size;
    let side = |length: usize| u32::try_from(length).map_err(|_| "the picture is too large".to_owned());
    Ok(Image {
        width: side(size.width())?,
        height: side(size.height())?,
        pixels: decoded.layer_data.channel_data.pixels.1,
    })
}
