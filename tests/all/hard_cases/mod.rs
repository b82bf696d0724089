//! The catalogue of hard cases: what goes wrong in ray tracers by rounding, each as a row of a table. docs/hard-cases.md lists
//! them all and says what each engine reaches.
//!
//! A case is plain data: shapes, rays, and where each ray ends. True values stand in the tables; they were computed in sixty
//! decimal digits, or in fractions, from the f32 numbers of the case. Every case runs with the reference and with the wavefront
//! engine at every width, asks both queries, and traces each ray among the others, alone, and as a packet of 64.
//!
//! - `case`: what a case is made of
//! - `run`: traces it
//! - `solids`, `outline`: shapes that several cases share
//! - `spheres`, `triangles`, `meshes`, `coincident`, `boxes`, `no_rays`, `polygons`, `platform`: the tables, and what does not
//!   fit into one

use crate::support::root;

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

/// The page's rows: number, and the tests that it names.
fn rows() -> Vec<(u32, Vec<String>)> {
    let page = std::fs::read_to_string(root().join("docs/hard-cases.md")).unwrap();
    let cells = page.lines().filter_map(|line| line.strip_prefix("| ")?.strip_suffix(" |"));
    let rows = cells.map(|line| line.split(" | ").map(str::trim).collect::<Vec<_>>());
    let numbered = rows.filter_map(|cells| Some((cells[0].parse().ok()?, cells)));
    let tests = |cells: &str| cells.split('`').skip(1).step_by(2).map(str::to_owned).collect();
    numbered.map(|(number, cells)| (number, cells.last().map_or(Vec::new(), |&last| tests(last)))).collect()
}

#[test]
fn the_page_has_every_case_in_order_and_names_its_tests() {
    let rows = rows();
    let numbers: Vec<u32> = rows.iter().map(|&(number, _)| number).collect();
    assert_eq!(numbers, (1..=59).collect::<Vec<_>>());
    for (number, tests) in rows {
        for test in tests.iter().filter(|test| test.contains("case")) {
            let is_there = match test.split_once("::") {
                Some((module, name)) => FOLDERS.iter().any(|folder| {
                    let source = root().join(format!("{folder}/{module}.rs"));
                    std::fs::read_to_string(source).is_ok_and(|source| has_test(&source, name))
                }),
                None => UNIT_TESTS
                    .iter()
                    .any(|file| has_test(&std::fs::read_to_string(root().join(file)).unwrap(), test)),
            };
            assert!(is_there, "case {number}: no test {test}");
        }
    }
}

/// Where `module::name` is looked for, and a name alone.
const FOLDERS: [&str; 2] = ["tests/all/hard_cases", "tests/all/hard_cases_light"];
const UNIT_TESTS: [&str; 2] = ["src/reference/optics.rs", "src/wavefront/optics.rs"];

/// As a function or as a row of a table.
fn has_test(source: &str, name: &str) -> bool {
    [format!("fn {name}()"), format!("    {name}: ")].iter().any(|text| source.contains(text))
}

#[test]
fn every_case_is_on_the_page() {
    let named: Vec<String> = rows().into_iter().flat_map(|(_, tests)| tests).collect();
    for module in MODULES {
        let source = root().join(format!("tests/all/hard_cases/{module}.rs"));
        let source = std::fs::read_to_string(source).unwrap();
        let words = source.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
        for name in words.filter(|word| word.starts_with("case_") || word.starts_with("cases_")) {
            let test = format!("{module}::{name}");
            assert!(named.contains(&test), "{test} is not in docs/hard-cases.md");
        }
    }
}

/// Those that hold cases.
const MODULES: [&str; 8] =
    ["spheres", "triangles", "meshes", "coincident", "boxes", "no_rays", "polygons", "platform"];
