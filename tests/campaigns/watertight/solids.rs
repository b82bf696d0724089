//! Which closed surfaces are shot at.

use super::angular::{cube, l_prism, lattice, star_prism, u_prism};
use super::random::Random;
use super::round::{bumpy_globe, globe_of_both, icosphere, needle, torus};
use super::solid::{Made, Solid};

/// A kind of closed surface: its name, and how one is made.
pub(super) type Kind = (&'static str, fn(&mut Random) -> Solid);

use Made::{Polygons, Triangles};

/// Of triangles, of polygons, and of both.
pub(super) const KINDS: [Kind; 16] = [
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
];
