//! The standard scenes of a benchmark, of any size: made from the definitions of their geometry, and the same numbers on
//! every machine, since nothing but + − × ÷ √ and integers decides them.
//!
//! A file a scene. Four have their namesakes in Haines, "A Proposal for Standard Graphics Environments", 1987, and are made
//! here from the geometry's definition; `glass` is this project's. Each looks alike at every size: a larger one is finer,
//! or has more in it. Sizes count primitives, and what a primitive is does not change with the size, so that time over size
//! can be compared.

mod gears;
mod glass;
mod sphereflake;
mod terrain;
mod tetrahedra;

use crate::scene::{GeometryProblem, Scene};

/// A scene that can be made in any size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StandardScene {
    /// Mirror spheres on mirror spheres over a ground; spheres.
    Sphereflake,
    /// Sierpinski's tetrahedron; triangles alone.
    Tetrahedra,
    /// A lattice of gears that mesh, some of them of glass; concave polygons.
    Gears,
    /// Mountains, a lake and four balls of glass; triangles, and a few of the other kinds.
    Terrain,
    /// Balls of glass, some of them hollow, and mirror balls on a chequered ground; spheres.
    Glass,
}

impl StandardScene {
    /// Each of them.
    pub const ALL: [Self; 5] = [Self::Sphereflake, Self::Tetrahedra, Self::Gears, Self::Terrain, Self::Glass];

    /// The word that names it on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Sphereflake => "sphereflake",
            Self::Tetrahedra => "tetrahedra",
            Self::Gears => "gears",
            Self::Terrain => "terrain",
            Self::Glass => "glass",
        }
    }

    /// What is in it, in a line.
    #[must_use]
    pub fn description(self) -> &'static str {
        match self {
            Self::Sphereflake => "mirror spheres on mirror spheres; reflection and shadows of three lights",
            Self::Tetrahedra => "Sierpinski's tetrahedron of triangles; camera and shadow rays alone",
            Self::Gears => "gears that mesh, of concave polygons with 96 corners; reflection and refraction",
            Self::Terrain => "a landscape of triangles, a lake, balls of glass; sunlight",
            Self::Glass => "balls of glass and mirrors on a chequered ground; refraction and absorption",
        }
    }
}

/// Makes a scene of about `size` primitives: as near as its construction comes, and never fewer than it needs to be itself.
///
/// # Errors
/// More primitives or vertices than a scene has numbers for, which takes a `size` of more than 10⁹.
pub fn generate(which: StandardScene, size: usize) -> Result<Scene, GeometryProblem> {
    match which {
        StandardScene::Sphereflake => sphereflake::scene(size),
        StandardScene::Tetrahedra => tetrahedra::scene(size),
        StandardScene::Gears => gears::scene(size),
        StandardScene::Terrain => terrain::scene(size),
        StandardScene::Glass => glass::scene(size),
    }
}

/// Where something is computed, it is in f64; where it enters a scene, it is rounded once.
#[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
fn rounded(value: f64) -> f32 {
    value as f32
}

/// Whether the `index`-th of `count` things is among `chosen` that are spread evenly over them.
fn is_chosen(index: usize, chosen: usize, count: usize) -> bool {
    (index + 1) * chosen / count > index * chosen / count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_are_chosen_as_asked_and_evenly() {
        for (chosen, count) in [(0, 7), (3, 7), (7, 7), (1, 1000), (999, 1000), (2, 6)] {
            let places: Vec<usize> = (0..count).filter(|&index| is_chosen(index, chosen, count)).collect();
            assert_eq!(places.len(), chosen);
            let gaps = places.windows(2).map(|pair| pair[1] - pair[0]);
            assert!(gaps.clone().max() <= gaps.min().map(|gap| gap + 1), "{places:?}");
        }
    }
}
