//! The catalogue of hard cases: what goes wrong in ray tracers by rounding, each as a row of a table. docs/hard-cases.md lists
//! them all and says what each engine reaches.
//!
//! A case is plain data: shapes, rays, and where each ray ends. True values stand in the tables; they were computed in sixty
//! decimal digits, or in fractions, from the f32 numbers of the case. Every case runs with the reference and with the wavefront engine at every
//! width, asks both queries, and traces each ray among the others, alone, and as a packet of 64.
//!
//! - `case`: what a case is made of
//! - `run`: traces it
//! - `spheres`, `triangles`, `boxes`, `polygons`, `platform`: the tables

/// A test for each case, and the list of all of them.
macro_rules! hard_cases {
    ($($test:ident: $case:ident,)+) => {
        pub(super) const CASES: &[&crate::hard_cases::case::Case] = &[$(&$case),+];
        $(#[test]
        fn $test() {
            $case.check();
        })+
    };
}

mod boxes;
mod case;
mod coincident;

mod meshes;
mod no_rays;
mod outline;
mod platform;
mod polygons;
mod run;
mod solids;
mod spheres;
mod triangles;
