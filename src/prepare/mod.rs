//! What the engine traces, made from the scene.

#[cfg_attr(not(test), expect(dead_code, reason = "the engine that traces it follows"))]
pub(crate) mod bvh;
