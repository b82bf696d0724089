//! A number that tells one tree of rays from another: which primitive each ray hit and which lights each hit found
//! visible, and nothing else. Where two engines agree on it, no decision parts their colours, only rounding and what
//! mirrors and lenses make of it.
//!
//! With wrapping 64-bit arithmetic and [`mix`],
//!
//! ```text
//! node(miss) = mix(0x9E3779B97F4A7C15)
//! node(hit)  = mix(mix(mix(mix(id + 1) + lights) + 3·reflected) + 5·refracted)
//! lights     = h over the lights in file order: from h = 0, h = mix(4·h + code)
//! signature  = h over the samples of the pixel: from h = 0, h = mix(h + node)
//! ```
//!
//! with the nodes of both children, 0 for a child that was not spawned, and [`Shadow`]'s codes. A hit's lights are known
//! when it is shaded and its children only later, so an engine without recursion keeps id and lights and folds children
//! into parents from the deepest rays up.

use crate::scene::PrimitiveId;
use serde::Serialize;

/// What became of a hit's question for one light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Shadow {
    /// A shadow ray reached the light.
    Visible = 1,
    /// A shadow ray was stopped.
    Hidden = 2,
    /// The light could add nothing, so no shadow ray was traced.
    NotTraced = 3,
}

/// The node of a ray that hits nothing.
pub(crate) fn miss() -> u64 {
    mix(0x9E37_79B9_7F4A_7C15)
}

/// The node of a ray that hits a primitive, from those of its children: 0 for one that was not spawned.
pub(crate) fn hit(id: PrimitiveId, lights: u64, reflected: u64, refracted: u64) -> u64 {
    let itself = mix(mix(u64::from(id.0) + 1).wrapping_add(lights));
    mix(mix(itself.wrapping_add(reflected.wrapping_mul(3))).wrapping_add(refracted.wrapping_mul(5)))
}

/// The lights of a hit so far, at first 0, and the next one in file order.
pub(crate) fn with_light(lights: u64, next: Shadow) -> u64 {
    mix(lights.wrapping_mul(4).wrapping_add(next as u64))
}

/// The samples of a pixel so far, at first 0, and the node of the next one's primary ray.
pub(crate) fn with_sample(samples: u64, node: u64) -> u64 {
    mix(samples.wrapping_add(node))
}

/// The finaliser of splitmix64: Steele, Lea and Flood, "Fast Splittable Pseudorandom Number Generators", 2014, with the
/// constants of Stafford's variant 13, as Vigna's splitmix64.c has them.
fn mix(mut x: u64) -> u64 {
    x ^= x >> 30;
    x = x.wrapping_mul(0xBF58_476D_1CE4_E5B9);
    x ^= x >> 27;
    x = x.wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ (x >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_miss_is_the_first_number_of_splitmix64() {
        // Its state starts at 0 and grows by the golden ratio; the number is in many places, splitmix64.c's own output.
        assert_eq!(miss(), 0xE220_A839_7B1D_CDAF);
    }

    /// Worked out from the definition outside this program.
    #[test]
    fn nodes_follow_the_definition() {
        let lights =
            with_light(with_light(with_light(0, Shadow::Visible), Shadow::Hidden), Shadow::NotTraced);
        assert_eq!(lights, 0x7E25_2437_3D8F_E685);
        let leaf = hit(PrimitiveId(0), 0, 0, 0);
        assert_eq!(leaf, 0x683B_5FC0_CA80_3DC3);
        let root = hit(PrimitiveId(41), lights, leaf, miss());
        assert_eq!(root, 0xDD74_C5A6_417A_1350);
        assert_eq!(with_sample(with_sample(0, root), miss()), 0x5A9F_11C9_5F7A_E08A);
    }

    #[test]
    fn children_do_not_change_places() {
        let node = |reflected, refracted| hit(PrimitiveId(1), 0, reflected, refracted);
        assert_ne!(node(miss(), 0), node(0, miss()));
    }
}
