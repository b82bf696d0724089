//! Where samples lie, what a picture is, and the files it is kept in.

mod exr;
mod format;
mod image;
mod npy;
mod png;
mod sampling;
mod srgb;

pub use format::{BitDepth, FilmError, Format, check_writable, read, write};
pub use image::{Image, Region};
pub use sampling::SamplePattern;
pub use srgb::decode_srgb;
