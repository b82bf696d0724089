//! Which closed surfaces are shot at.

use super::angular::{column_on_a_slab, cube, l_prism, lattice, star_prism, u_prism};
use super::bunny::{self, bunny};
use super::round::{bumpy_globe, globe_of_both, icosphere, needle, torus};
use super::solid::Made::{Polygons, Triangles};
use super::solid::Solid;
use crate::random::Random;

/// A kind of closed surface: its name, and how one is made.
pub(super) type Kind = (&'static str, fn(&mut Random) -> Solid);

/// Of triangles, of polygons, and of both.
pub(super) const KINDS: [Kind; 18] = [
    ("bumpy globe", |random| bumpy_globe(random).stretched(random)),
    ("icosphere", |random| icosphere().stretched(random)),
    ("torus", |random| torus().stretched(random)),
    ("needles", needle),
    ("cube, triangles", |random| cube(|_| Triangles).stretched(random)),
    ("lattice, triangles", |_| lattice(24, |_| Triangles)),
    ("cube, polygons", |random| cube(|_| Polygons).stretched(random)),
    ("L-prism", |random| l_prism(Polygons).stretched(random)),
    ("U-prism", |random| u_prism(Polygons).stretched(random)),
    ("star prism", |random| star_prism(random, Polygons, Polygons).stretched(random)),
    ("column on a slab", |random| column_on_a_slab().stretched(random)),
    ("lattice, polygons", |_| lattice(12, |_| Polygons)),
    ("cube, both", |random| {
        let of_triangles = 1 + random.below(62);
        cube(|side| if of_triangles >> side & 1 == 1 { Triangles } else { Polygons }).stretched(random)
    }),
    ("U-prism, sides triangles", |random| u_prism(Triangles).stretched(random)),
    ("star prism, caps triangles", |random| star_prism(random, Triangles, Polygons).stretched(random)),
    ("globe, both", |random| globe_of_both().stretched(random)),
    ("lattice, both", |_| {
        lattice(12, |at| if at.iter().sum::<usize>() % 2 == 0 { Polygons } else { Triangles })
    }),
    ("bunny", bunny),
];

/// How many of them there are here: all but the bunny, where there is no file of it.
pub(super) fn count() -> usize {
    if bunny::file().is_none() {
        eprintln!("WAVELANE_SCENES names no folder with bunny.obj: the bunny is not shot at");
        return KINDS.len() - 1;
    }
    KINDS.len()
}
