//! What is kept of a tree of rays besides its light: nothing for a picture, a number for its signature.

use crate::scene::PrimitiveId;
use crate::signature::{self, Shadow};

/// Put together from the leaves up, as the recursion returns. The default is that of a ray that was not spawned, and of a
/// hit's lights before the first.
pub(super) trait Record: Copy + Default {
    /// Of a ray that hits nothing.
    fn miss() -> Self;
    /// Of a hit's lights so far and the next one in file order.
    fn with_light(self, next: Shadow) -> Self;
    /// Of a ray that hits a primitive, from those of its lights and of its mirrored and refracted ray.
    fn hit(id: PrimitiveId, lights: Self, children: [Self; 2]) -> Self;
}

impl Record for () {
    fn miss() {}
    fn with_light(self, _: Shadow) {}
    fn hit(_: PrimitiveId, (): Self, _: [Self; 2]) {}
}

/// As [`signature`] defines it.
impl Record for u64 {
    fn miss() -> Self {
        signature::miss()
    }

    fn with_light(self, next: Shadow) -> Self {
        signature::with_light(self, next)
    }

    fn hit(id: PrimitiveId, lights: Self, [reflected, refracted]: [Self; 2]) -> Self {
        signature::hit(id, lights, reflected, refracted)
    }
}
