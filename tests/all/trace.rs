//! `trace` and `render --record-rays`: the contract that other tracers are raced by.

use crate::support::{Folder, STILL_LIFE, npy, npy_floats, npy_indices, stderr, stdout, wavelane};
use serde_json::Value;

/// A square of two triangles in the plane z = 0, and a sphere behind it: ids 0, 1 and 2.
fn geometry(folder: &Folder) -> String {
    let square = folder.file("square");
    std::fs::create_dir(&square).unwrap();
    let corners = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0_f32]];
    std::fs::write(square.join("vertices.npy"), npy_floats(&corners)).unwrap();
    std::fs::write(square.join("triangles.npy"), npy_indices(&[[0, 1, 2], [0, 2, 3]])).unwrap();
    std::fs::write(square.join("spheres.npy"), npy_floats(&[[0.0, 0.0, -4.0, 2.0_f32]])).unwrap();
    square.into_os_string().into_string().unwrap()
}

/// Down from z = 2 with directions of length 2, and where they hit.
const RAYS: [([f32; 8], f32, u32); 7] = [
    ([0.5, -0.25, 2.0, 0.0, 0.0, 0.0, -2.0, 1e30], 1.0, 0),
    ([-0.5, 0.25, 2.0, 0.0, 0.0, 0.0, -2.0, 1e30], 1.0, 1),
    // Beside the square the sphere is seen, beyond t_min its front or its back.
    ([0.0, 0.0, 2.0, 1.0, 0.0, 0.0, -2.0, 1e30], 2.0, 2),
    ([0.0, 0.0, 2.0, 2.0, 0.0, 0.0, -2.0, 1e30], 4.0, 2),
    // Before t_max there is nothing.
    ([0.5, -0.25, 2.0, 0.0, 0.0, 0.0, -2.0, 1.0], f32::INFINITY, u32::MAX),
    ([3.0, 3.0, 2.0, 0.0, 0.0, 0.0, -2.0, 1e30], f32::INFINITY, u32::MAX),
    ([f32::NAN, 0.0, 2.0, 0.0, 0.0, 0.0, -2.0, 1e30], f32::INFINITY, u32::MAX),
];

fn rays(folder: &Folder) -> String {
    let path = folder.write("rays.npy", npy_floats(&RAYS.map(|(ray, ..)| ray)));
    path.into_os_string().into_string().unwrap()
}

/// The numbers of an NPY file of one axis, 4 bytes each.
fn column(path: &std::path::Path, descr: &str, count: usize) -> Vec<[u8; 4]> {
    let bytes = std::fs::read(path).unwrap();
    let expected = npy(descr, &format!("({count},)"), Vec::new());
    assert_eq!(bytes[..expected.len()], expected, "{path:?}");
    bytes[expected.len()..].as_chunks().0.to_vec()
}

#[test]
fn every_engine_finds_what_the_rays_hit() {
    let folder = Folder::new();
    let (geometry, rays) = (geometry(&folder), rays(&folder));
    let prefix = folder.file("out").into_os_string().into_string().unwrap();
    for (engine, lanes) in [("simd", "4"), ("simd", "8"), ("simd", "16"), ("scalar", "1"), ("reference", "1")]
    {
        for query in ["closest", "any"] {
            let mut arguments =
                vec!["trace", &geometry, "--rays", &rays, "--query", query, "--engine", engine];
            arguments.extend([
                "--repeat",
                "2",
                "--threads",
                "1",
                "--hits",
                &prefix,
                "--json",
                "-",
                "--check",
            ]);
            if engine == "simd" {
                arguments.extend(["--lanes", lanes]);
            }
            let output = wavelane(&arguments);
            assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
            assert!(stderr(&output).contains("1 of 7 rows are no rays"), "{}", stderr(&output));

            let report: Value = serde_json::from_str(&stdout(&output)).unwrap();
            let expected = serde_json::json!({
                "rays": 7, "unusable_rays": 1, "hits": 4, "query": query, "engine": engine, "threads": 1, "primitives": 3,
                "lanes": lanes.parse::<u32>().unwrap(),
            });
            for (key, value) in expected.as_object().unwrap() {
                assert_eq!(&report[key], value, "{key} of {engine}");
            }
            assert!(report["build_seconds"].as_f64().unwrap() > 0.0);
            let rate = &report["mrays_per_second"];
            assert!(rate["best"].as_f64().unwrap() >= rate["median"].as_f64().unwrap());
            assert_eq!(report["errors"]["false_hits"]["certain"], 0);
            let tests = &report["tests"];
            assert_eq!(tests.is_null(), engine == "reference");
            for kind in ["boxes", "spheres", "triangles"].into_iter().filter(|_| engine != "reference") {
                let [runs, lanes, in_use] =
                    ["per_ray", "lanes", "in_use"].map(|key| tests[kind][key].as_f64().unwrap());
                assert!(runs > 0.0 && 0.0 < in_use && in_use <= lanes, "{kind} of {engine}: {tests}");
            }

            let t = column(&folder.file("out.t.npy"), "<f4", RAYS.len()).into_iter().map(f32::from_le_bytes);
            let id =
                column(&folder.file("out.prim.npy"), "<u4", RAYS.len()).into_iter().map(u32::from_le_bytes);
            for ((t, id), (ray, expected_t, expected_id)) in t.zip(id).zip(RAYS) {
                let expected = match query {
                    "any" if expected_id == u32::MAX => (f32::INFINITY, u32::MAX),
                    "any" => (0.0, u32::MAX),
                    _ => (expected_t, expected_id),
                };
                assert_eq!((t, id), expected, "{engine} {lanes} {query}: {ray:?}");
            }
        }
    }
}

#[test]
fn what_cannot_be_framed_can_be_traced() {
    let folder = Folder::new();
    let far = folder.file("far");
    std::fs::create_dir(&far).unwrap();
    let far_out = 16_777_216.0_f32;
    std::fs::write(far.join("spheres.npy"), npy_floats(&[[far_out, far_out, far_out, 0.25]])).unwrap();
    let far = far.into_os_string().into_string().unwrap();
    assert_eq!(wavelane(&["check", &far]).status.code(), Some(3), "there is no room for an eye beside it");
    let ray = [far_out, far_out, far_out + 4.0, 0.0, 0.0, 0.0, -1.0, f32::INFINITY];
    let rays = folder.write("rays.npy", npy_floats(&[ray])).into_os_string().into_string().unwrap();
    let prefix = folder.file("out").into_os_string().into_string().unwrap();
    let output = wavelane(&["trace", &far, "--rays", &rays, "--hits", &prefix]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(column(&folder.file("out.t.npy"), "<f4", 1), [3.75_f32.to_le_bytes()]);
}

#[test]
fn what_is_no_array_of_rays_is_refused_with_what_would_be_right() {
    let folder = Folder::new();
    let geometry = geometry(&folder);
    for (name, content, message) in [
        ("empty.npy", npy_floats::<8>(&[]), "there are no rays in it"),
        ("narrow.npy", npy_floats(&[[0.0_f32; 6]; 2]), "(2, 6); it must be (N, 8)"),
        ("wide.npy", npy("<f8", "(1, 8)", vec![0; 64]), "float32"),
        ("cut.npy", npy("<f4", "(2, 8)", vec![0; 60]), "60"),
        ("text.npy", b"1 2 3".to_vec(), "NPY"),
    ] {
        let path = folder.write(name, content).into_os_string().into_string().unwrap();
        let output = wavelane(&["trace", &geometry, "--rays", &path]);
        assert_eq!(output.status.code(), Some(3), "{name}: {}", stderr(&output));
        let said = stderr(&output);
        assert!(said.starts_with(&format!("{path}: ")) && said.contains(message), "{name}: {said}");
        assert_eq!(stdout(&output), "");
    }
    let missing = wavelane(&["trace", &geometry, "--rays", "/nowhere/rays.npy"]);
    assert_eq!(missing.status.code(), Some(3), "{}", stderr(&missing));
    let usage = wavelane(&["trace", &geometry]);
    assert_eq!(usage.status.code(), Some(2), "{}", stderr(&usage));
}

#[test]
fn hits_that_cannot_be_written_are_found_out_before_the_work() {
    let folder = Folder::new();
    let (geometry, rays) = (geometry(&folder), rays(&folder));
    let output = wavelane(&["trace", &geometry, "--rays", &rays, "--hits", "/nowhere/out"]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stderr(&output).starts_with("/nowhere/out.t.npy: cannot be written"), "{}", stderr(&output));
    assert_eq!(stdout(&output), "");
}

#[test]
fn a_frame_s_rays_are_written_by_kind_and_can_be_traced() {
    let folder = Folder::new();
    let scene = folder.write("scene.toml", STILL_LIFE).into_os_string().into_string().unwrap();
    let at = |name: &str| folder.file(name).into_os_string().into_string().unwrap();
    let (picture, recorded) = (at("a.npy"), at("rays"));
    let arguments = ["render", &scene, "-o", &picture, "--record-rays", &recorded, "--json", "-"];
    let output = wavelane(&arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let report: Value = serde_json::from_str(&stdout(&output)).unwrap();
    for kind in ["primary", "shadow", "reflect", "refract"] {
        let path = at(&format!("rays/{kind}.npy"));
        let query = if kind == "shadow" { "any" } else { "closest" };
        let traced =
            wavelane(&["trace", &scene, "--rays", &path, "--query", query, "--json", "-", "--check"]);
        assert_eq!(traced.status.code(), Some(0), "{kind}: {}", stderr(&traced));
        let traced: Value = serde_json::from_str(&stdout(&traced)).unwrap();
        assert_eq!(traced["rays"], report["rays"][kind], "{kind}");
        assert!(traced["hits"].as_u64().unwrap() > 0, "{kind}");
        for wrong in ["false_hits", "false_misses", "other_primitives"] {
            assert_eq!(traced["errors"][wrong]["certain"], 0, "{kind}: {wrong}");
        }
    }

    // Of a frame without secondary rays no file of an earlier frame is left behind.
    let flat = STILL_LIFE.replace("ior = 1.5", "").replace("mirror = 0.8", "").replace("diffuse = 0.7", "");
    folder.write("scene.toml", flat);
    let output = wavelane(&arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let names: Vec<_> =
        std::fs::read_dir(folder.file("rays")).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(names, ["primary.npy"]);

    let by_reference = wavelane(&[&arguments[..], &["--engine", "reference"]].concat());
    assert_eq!(by_reference.status.code(), Some(2), "{}", stderr(&by_reference));
}

#[test]
fn the_end_of_a_stretch_is_strict_for_both_queries() {
    let folder = Folder::new();
    let geometry = geometry(&folder);
    // Down from z = 2 to the square at t = 2: just beyond, at, and just before the end.
    let ends = [2.0_f32.next_up(), 2.0, 2.0_f32.next_down()];
    let rows = ends.map(|end| [0.5, -0.25, 2.0, 0.0, 0.0, 0.0, -1.0, end]);
    let rays = folder.write("ends.npy", npy_floats(&rows)).into_os_string().into_string().unwrap();
    let prefix = folder.file("out").into_os_string().into_string().unwrap();
    for engine in ["simd", "scalar", "reference"] {
        for (query, hit) in [("closest", 2.0), ("any", 0.0_f32)] {
            let mut arguments = vec!["trace", &geometry, "--rays", &rays, "--hits", &prefix, "--repeat", "1"];
            arguments.extend(["--engine", engine, "--query", query]);
            let output = wavelane(&arguments);
            assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
            let found = column(&folder.file("out.t.npy"), "<f4", 3).into_iter().map(f32::from_le_bytes);
            assert_eq!(found.collect::<Vec<_>>(), [hit, f32::INFINITY, f32::INFINITY], "{engine} {query}");
        }
    }
}

#[test]
fn no_file_of_a_command_takes_the_place_of_another() {
    let folder = Folder::new();
    let (geometry, rays) = (geometry(&folder), rays(&folder));
    let scene = folder.write("scene.toml", STILL_LIFE).into_os_string().into_string().unwrap();
    let at = |name: &str| folder.file(name).into_os_string().into_string().unwrap();
    std::fs::create_dir(folder.file("rays")).unwrap();
    let (sub, spheres) = (at("rays"), at("square/spheres.npy"));
    let (alias, picture, recorded) = (at("rays/../scene.toml"), at("a.npy"), at("rays/primary.npy"));
    let shadows = at("rays/shadow.npy");
    std::fs::copy(&rays, folder.file("clash.t.npy")).unwrap();
    let (clash, prefix) = (at("clash.t.npy"), at("clash"));
    let cases: [&[&str]; 9] = [
        &["trace", &scene, "--rays", &rays, "--json", &alias],
        &["trace", &geometry, "--rays", &rays, "--json", &rays],
        &["trace", &geometry, "--rays", &clash, "--hits", &prefix],
        &["trace", &geometry, "--rays", &rays, "--json", &spheres],
        &["render", &scene, "-o", &picture, "--json", &alias],
        &["render", &geometry, "-o", &spheres, "--size", "8x8"],
        &["render", &scene, "-o", &recorded, "--record-rays", &sub],
        &["render", &scene, "-o", &picture, "--record-rays", &sub, "--json", &shadows],
        &["bench", &geometry, "--size", "8x8", "--repeat", "1", "--json", &spheres],
    ];
    let before: Vec<_> = [&scene, &rays, &clash, &spheres].map(|path| std::fs::read(path).unwrap()).into();
    for arguments in cases {
        let output = wavelane(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        assert!(
            stderr(&output).contains("another file of this command has this name"),
            "{}",
            stderr(&output)
        );
    }
    let after: Vec<_> = [&scene, &rays, &clash, &spheres].map(|path| std::fs::read(path).unwrap()).into();
    assert!(before == after, "something was written over");
}
