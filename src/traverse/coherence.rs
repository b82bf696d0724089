//! Whether rays are alike enough to walk together.

/// Rays that walk together agree in the signs of their directions and in the axis along which they are fastest, and their
/// slopes against that axis lie within this of each other. Beyond it a packet visits so many nodes for the sake of a few
/// rays that single rays are sooner done.
pub(super) const WIDEST_SLOPES: f32 = 0.5;
