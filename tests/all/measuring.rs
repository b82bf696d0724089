//! `compare` and `bench`: tables and reports of speed beside error.

use crate::support::{Folder, STILL_LIFE, stderr, stdout, wavelane};
use serde_json::Value;
use std::process::Output;

fn scene(folder: &Folder, name: &str, toml: &str) -> String {
    folder.write(name, toml).into_os_string().into_string().unwrap()
}

/// Runs the program, which exits with 0; its report.
#[track_caller]
fn report(arguments: &[&str]) -> Value {
    let output = wavelane(&[arguments, &["--json", "-", "--progress", "none"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    serde_json::from_str(&stdout(&output)).unwrap()
}

/// No table says that something is no number, or infinite.
#[track_caller]
fn table(output: &Output) -> String {
    assert_eq!(output.status.code(), Some(0), "{}", stderr(output));
    let text = stdout(output);
    assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
    text
}

const EMPTY: &str =
    "[image]\nsize = [16, 16]\n[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nfov = 40\n";

#[test]
fn compare_puts_every_engine_s_speed_beside_its_error() {
    let folder = Folder::new();
    let path = scene(&folder, "scene.toml", STILL_LIFE);
    let found = report(&["compare", &path, "--repeat", "2", "--threads", "2"]);
    let engines = found["engines"].as_array().unwrap();
    let names: Vec<_> =
        engines.iter().map(|of| (of["engine"].as_str().unwrap(), of["lanes"].as_u64().unwrap())).collect();
    assert_eq!(names, [("reference", 1), ("scalar", 1), ("simd", 4), ("simd", 8), ("simd", 16)]);
    assert_eq!(found["pixels"], 64 * 48);
    assert_eq!(found["recorded_rays"], found["frame_rays"], "there are few");
    for engine in engines {
        assert!(engine["frame_seconds"]["median"].as_f64().unwrap() > 0.0);
        for kind in ["primary", "shadow", "reflect", "refract"] {
            assert!(engine["mrays_per_second"][kind]["median"].as_f64().unwrap() > 0.0, "{kind}");
        }
    }
    for engine in &engines[1..] {
        assert_eq!(engine["same_bits_as_scalar"], true);
        assert!(engine["image"]["rms"].as_f64().unwrap() > 0.0, "f32 rounds");
        let hits = &engine["hits"];
        for kind in ["primary", "shadow", "reflect", "refract"] {
            assert_eq!(hits[kind]["rays"], found["frame_rays"][kind]);
            for wrong in ["false_hits", "false_misses", "other_primitives"] {
                assert_eq!(hits[kind][wrong]["certain"], 0, "{kind}: {wrong}");
            }
        }
        assert!(hits["primary"]["t_ulps"]["max"].as_f64().unwrap() > 0.0);
        assert!(hits["primary"]["t_backward"]["max"].as_f64().unwrap() < 8.0, "{hits}");
        assert!(hits["shadow"]["t_ulps"].is_null());
    }
    assert!(found["floor"]["rms"].as_f64().unwrap() > 0.0);
    assert!(found["machine"]["isa"].is_string());

    let text = table(&wavelane(&["compare", &path, "--repeat", "1"]));
    for word in ["reference", "f32 floor", "scalar", "RMSE", "false misses", "equal bits", "normal p50"] {
        assert!(text.contains(word), "{word} in\n{text}");
    }
}

#[test]
fn a_comparison_of_nothing_has_no_strange_numbers() {
    let folder = Folder::new();
    let path = scene(&folder, "empty.toml", EMPTY);
    table(&wavelane(&["compare", &path, "--repeat", "1"]));
    let found = report(&["compare", &path, "--repeat", "1"]);
    assert_eq!(found["engines"][1]["hits"]["primary"]["hits"], 0);
    assert!(found["engines"][1]["hits"]["primary"]["t_ulps"].is_null());
    table(&wavelane(&["bench", &path, "--repeat", "1"]));
}

#[test]
fn bench_measures_phases_stages_rays_memory_and_growth() {
    let arguments =
        ["bench", "--only", "terrain,tetrahedra", "--sizes", "40,300", "--size", "32x32", "--repeat", "1"];
    let found = report(&arguments);
    assert_eq!(found["format"], 1);
    let scenes = found["scenes"].as_array().unwrap();
    assert_eq!(scenes.len(), 4);
    for scene in scenes {
        assert_eq!(scene["size"], serde_json::json!([32, 32]));
        for phase in ["load", "trace", "shade"] {
            assert!(scene["seconds"][phase].as_f64().unwrap() > 0.0, "{phase} of {scene}");
        }
        for phase in ["build", "write"] {
            assert!(scene["seconds"][phase]["median"].as_f64().unwrap() > 0.0, "{phase} of {scene}");
        }
        assert!(scene["simd"]["lanes"].as_u64().unwrap() > scene["scalar"]["lanes"].as_u64().unwrap());
        assert!(scene["memory"]["bytes_per_primitive"].as_f64().unwrap() > 0.0);
        let stages: Vec<_> = scene["simd"]["stages"]
            .as_array()
            .unwrap()
            .iter()
            .map(|of| of["stage"].as_str().unwrap())
            .collect();
        assert_eq!(
            stages,
            ["generate", "intersect", "surface", "absorb", "illuminate", "occlude", "spawn", "resolve"]
        );
        assert!(scene["errors"]["primary"]["hits"].as_u64().unwrap() > 0, "{scene}");
    }
    let over: Vec<_> =
        found["growth"].as_array().unwrap().iter().map(|of| of["over"].as_str().unwrap()).collect();
    assert_eq!(over, ["primitives", "primitives", "pixels", "threads"]);
    for growth in &found["growth"].as_array().unwrap()[..3] {
        assert!(growth["frame_exponent"].is_number(), "{growth}");
    }
    table(&wavelane(&arguments));
}

/// A baseline as it would be if its rates had been so many times those of now, and its times as many times shorter.
fn faster(mut report: Value, times: f64) -> String {
    let scale = |value: &mut Value, times: f64| {
        for key in ["median", "best"] {
            value[key] = (value[key].as_f64().unwrap() * times).into();
        }
    };
    for scene in report["scenes"].as_array_mut().unwrap() {
        scale(&mut scene["seconds"]["build"], 1.0 / times);
        scale(&mut scene["simd"]["frame_seconds"], 1.0 / times);
        for (_, rate) in scene["simd"]["mrays_per_second"].as_object_mut().unwrap() {
            scale(rate, times);
        }
    }
    report.to_string()
}

#[test]
fn bench_fails_where_it_is_slower_than_its_baseline_by_more_than_it_may() {
    let folder = Folder::new();
    let path = scene(&folder, "scene.toml", STILL_LIFE);
    let run = ["bench", &path, "--repeat", "2", "--threads", "1"];
    let now = report(&run);
    // The factors are so large that no noise makes up for them.
    let baselines = [("quicker.json", 1e4, Some(4)), ("slower.json", 1e-4, Some(0))];
    for (name, times, code) in baselines {
        let baseline = scene(&folder, name, &faster(now.clone(), times));
        let output = wavelane(&[&run[..], &["--baseline", &baseline, "--fail-if-slower", "5%"]].concat());
        assert_eq!(output.status.code(), code, "{}", stderr(&output));
        assert!(stdout(&output).contains("times slower"), "{}", stdout(&output));
        let unlimited = wavelane(&[&run[..], &["--baseline", &baseline]].concat());
        assert_eq!(unlimited.status.code(), Some(0), "{}", stderr(&unlimited));
    }
}

#[test]
fn what_cannot_be_a_baseline_is_refused_before_the_work() {
    let folder = Folder::new();
    let path = scene(&folder, "scene.toml", STILL_LIFE);
    let other_format = r#"{"format": 999, "scenes": []}"#;
    let other_threads = r#"{"format": 1, "threads": 77, "scenes": [], "machine": {"processor": null, "isa": "sse2", "version": "0"}}"#;
    for (name, content, message) in [
        ("format.json", other_format, "its format is 999"),
        ("threads.json", other_threads, "use --threads 77"),
        ("other.json", r#"{"rays": 3}"#, "not a report of `wavelane bench --json`"),
        ("text.json", "hello", "not a report of `wavelane bench --json`"),
    ] {
        let baseline = scene(&folder, name, content);
        let output = wavelane(&["bench", &path, "--baseline", &baseline, "--threads", "1"]);
        assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
        assert!(
            stderr(&output).starts_with(&format!("{baseline}: ")) && stderr(&output).contains(message),
            "{}",
            stderr(&output)
        );
    }
    let missing = wavelane(&["bench", &path, "--baseline", "/nowhere/a.json"]);
    assert_eq!(missing.status.code(), Some(3), "{}", stderr(&missing));
    for wrong in ["5", "-5%", "x%", "NaN%"] {
        let output =
            wavelane(&["bench", &path, "--baseline", "a.json", &format!("--fail-if-slower={wrong}")]);
        assert_eq!(output.status.code(), Some(2), "{wrong}: {}", stderr(&output));
    }
    let without = wavelane(&["bench", &path, "--fail-if-slower", "5%"]);
    assert_eq!(without.status.code(), Some(2), "{}", stderr(&without));
}
