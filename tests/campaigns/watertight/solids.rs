//! Which closed surfaces are shot at.

use super::angular::{cube, l_prism, lattice, star_prism, u_prism};
use super::bunny::{self, bunny};
use super::random::Random;
use super::round::{bumpy_globe, globe_of_both, icosphere, needle, torus};
use super::solid::{Made, Solid};

/// A kind of closed surface: its name, and how one is made.
pub(super) type Kind = (&'static str, fn(&mut Random) -> Solid);

use Made::{Polygons, Triangles};

/// Of triangles, of polygons, and of both.
pub(super) const KINDS: [Kind; 17] = [
    ("bumpy globe", bumpy_globe),
    ("icosphere", |_| icosphere()),
    ("torus", |_| torus()),
    ("needles", needle),
    ("cube, triangles", |_| cube(|_| Triangles)),
    ("lattice, triangles", |_| lattice(24, |_| Triangles)),
    ("cube, polygons", |_| cube(|_| Polygons)),
    ("L-prism", |_| l_prism(Polygons)),
    ("U-prism", |_| u_prism(Polygons)),
    ("star prism", |random| star_prism(random, Polygons, Polygons)),
    ("lattice, polygons", |_| lattice(12, |_| Polygons)),
    ("cube, both", |random| {
        let of_triangles = 1 + random.below(62);
        cube(|side| if of_triangles >> side & 1 == 1 { Triangles } else { Polygons })
    }),
    ("U-prism, sides triangles", |_| u_prism(Triangles)),
    ("star prism, caps triangles", |random| star_prism(random, Triangles, Polygons)),
    ("globe, both", |_| globe_of_both()),
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
