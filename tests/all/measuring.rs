//! `compare` and `bench`: tables and reports of speed beside error.

use crate::support::{Folder, STILL_LIFE, assert_plot, stderr, stdout, wavelane};
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

/// A picture so small that the truth of very many samples takes a moment.
const TINY: [&str; 8] = ["--size", "16x12", "--repeat", "1", "--threads", "2", "--max-depth", "4"];

#[test]
fn compare_measures_what_accuracy_costs_where_it_is_asked_to() {
    let folder = Folder::new();
    // A second triangle on an edge of the first, so that rays can be aimed at what they share.
    let second =
        "[[triangle]]\nvertices = [[-0.5, 0.25, 0], [0.2, 0.9, 0.1], [-1, 0.5, 1]]\nmaterial = \"matte\"\n";
    let path = scene(&folder, "scene.toml", &format!("{STILL_LIFE}{second}"));
    assert!(report(&[&["compare", &path], &TINY[..]].concat()).get("rungs").is_none());

    let arguments = [&["compare", &path, "--rungs"], &TINY[..]].concat();
    let found = report(&arguments);
    let rungs = &found["rungs"];
    let kinds: Vec<_> = rungs["kernels"].as_array().unwrap().iter().map(|of| &of["rays"]).collect();
    assert_eq!(kinds, ["primary", "shadow", "reflect", "refract"]);
    for kernels in rungs["kernels"].as_array().unwrap() {
        for (primitive, formulas) in [("boxes", 3), ("sphere", 3), ("triangle", 2), ("polygon", 2)] {
            if (primitive, &kernels["rays"]) == ("polygon", &serde_json::json!("shadow")) {
                assert!(kernels[primitive].is_null(), "they rise from the one there is: {kernels}");
                continue;
            }
            let formulas_found = kernels[primitive]["formulas"].as_array().unwrap();
            assert_eq!(formulas_found.len(), formulas, "{kernels}");
            for formula in formulas_found {
                assert!(formula["seconds"]["median"].as_f64().unwrap() > 0.0, "{formula}");
                assert_eq!(formula["seconds"]["runs"], 1);
            }
        }
    }
    assert!(rungs["leaks"]["edge_rays"].as_u64().unwrap() > 0, "{}", rungs["leaks"]);
    assert!(rungs["box_corners"]["true_hits"].as_u64().unwrap() > 0, "{}", rungs["box_corners"]);
    let frames = rungs["min_weight"]["frames"].as_array().unwrap();
    assert_eq!(
        frames[0]["rays"], found["frame_rays"],
        "all rays of the frame at its own size and one sample"
    );
    assert_eq!(rungs["samples"]["size"], serde_json::json!([16, 12]));
    assert!(rungs["samples"]["patterns"][1]["slope"].as_f64().unwrap() < 0.0);
    assert!(found["command"].as_str().unwrap().contains(" --rungs"));

    let text = table(&wavelane(&arguments));
    // Sentences are broken where the lines end.
    let after: Vec<&str> = text.split("normal p50").nth(1).unwrap().split_whitespace().collect();
    let after = after.join(" ");
    for word in [
        "spheres, refract rays",
        "triangles, primary rays",
        "polygons, reflect rays",
        "boxes, reflect rays",
        "True hits left out: of",
        "Corners of boxes: rays",
        "are no choices",
        "watertight, the engine's",
        "Leaks: of",
        "min_weight",
    ] {
        assert!(after.contains(word), "{word} in\n{text}");
    }
    for pattern in ["1/4096 ", "regular", "random", "jittered", "8 x 8", "slope"] {
        assert!(after.contains(pattern), "{pattern} in\n{text}");
    }
}

#[test]
fn what_a_scene_has_not_has_no_rung() {
    let folder = Folder::new();
    let path = scene(&folder, "empty.toml", EMPTY);
    let arguments = ["compare", &path, "--rungs", "--size", "8x8", "--repeat", "1"];
    let found = report(&arguments);
    let rungs = &found["rungs"];
    assert_eq!(rungs["kernels"], serde_json::json!([]));
    assert!(rungs["leaks"].is_null() && rungs["min_weight"].is_null(), "{rungs}");
    for pattern in rungs["samples"]["patterns"].as_array().unwrap() {
        assert!(pattern["slope"].is_null() && pattern["pictures"][7]["rms"] == 0.0, "{pattern}");
    }
    let text = table(&wavelane(&arguments));
    assert!(!text.contains("formula") && !text.contains("Leaks"), "{text}");
    assert!(text.contains("The engine's own error, at one sample a pixel, is 0."), "{text}");
}

#[test]
fn the_rungs_say_how_far_they_are() {
    let folder = Folder::new();
    let path = scene(&folder, "scene.toml", STILL_LIFE);
    let output = wavelane(&[&["compare", &path, "--rungs", "--progress", "json"], &TINY[..]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let lines: Vec<Value> = stderr(&output).lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let of_rungs: Vec<&Value> = lines.iter().filter(|line| line.get("steps of rungs").is_some()).collect();
    let percents: Vec<u64> = of_rungs.iter().map(|line| line["percent"].as_u64().unwrap()).collect();
    assert!(percents.is_sorted() && percents.len() > 5 && percents.last() == Some(&100), "{percents:?}");
    let last = of_rungs.last().unwrap();
    assert_eq!(last["steps of rungs"], last["total"]);
    // Of each kind of rays five steps; leaks between triangles and polygons, corners of boxes, weak rays, samples.
    assert_eq!(last["total"], 4 * 5 + 2 + 2 + 1 + 2 + 3);
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
    let growth = found["growth"].as_array().unwrap();
    let over: Vec<_> = growth.iter().map(|of| of["over"].as_str().unwrap()).collect();
    assert_eq!(over, ["primitives", "primitives", "pixels", "threads", "samples", "lights", "levels"]);
    // There may be one thread, and so one point.
    for growth in growth.iter().filter(|growth| growth["over"] != "threads") {
        assert!(growth["frame_exponent"].is_number(), "{growth}");
        assert_eq!(growth["build_exponent"].is_number(), growth["over"] == "primitives", "{growth}");
    }
    let of_points = |growth: &Value, of: fn(&Value) -> &Value| {
        let points = growth["points"].as_array().unwrap().iter();
        points.map(|point| of(point).as_u64().unwrap()).collect::<Vec<_>>()
    };
    let [samples, lights, levels] = &growth[4..] else { panic!("{growth:?}") };
    assert_eq!(of_points(samples, |point| &point["count"]), [1, 4, 16]);
    assert_eq!(of_points(samples, |point| &point["rays"]["primary"]), [256, 4 * 256, 16 * 256]);
    assert_eq!(of_points(lights, |point| &point["count"]), [1, 2, 4, 8, 16]);
    assert!(of_points(lights, |point| &point["rays"]["shadow"]).is_sorted_by(|a, b| a < b), "{lights}");
    assert_eq!(of_points(levels, |point| &point["count"]), [1, 2, 3, 5, 9, 17]);
    assert!(of_points(levels, |point| &point["rays"]["reflect"])[..3].is_sorted_by(|a, b| a < b), "{levels}");
    let folder = Folder::new();
    let plot = folder.file("growth.svg").into_os_string().into_string().unwrap();
    let text = table(&wavelane(&[&arguments[..], &["--plot", &plot]].concat()));
    for series in ["samples 1 4 16 ", "lights 1 2 4 8 16 ", "levels 1 2 3 5 9 17 "] {
        assert!(text.contains(series), "{series} in\n{text}");
    }
    let svg = std::fs::read_to_string(&plot).unwrap();
    assert_plot(&svg);
    for over in ["primitives", "pixels", "threads", "samples a pixel", "lights", "levels of rays"] {
        assert_eq!(svg.matches(&format!("\nSeconds over {over}\n")).count(), 1, "{over} in\n{svg}");
    }
    for line in ["\nterrain n^", "\nterrain, build n^", "\ntetrahedra n^", "\ntetrahedra, build n^"] {
        assert!(svg.contains(line), "{line} in\n{svg}");
    }
}

#[test]
fn a_plot_of_growth_that_cannot_be_written_is_found_out_before_the_work() {
    let folder = Folder::new();
    let at = |name: &str| folder.file(name).into_os_string().into_string().unwrap();
    let (path, baseline) = (scene(&folder, "scene.svg", STILL_LIFE), scene(&folder, "a.svg", "{}"));
    let (same, other) = (at("folder.svg/../scene.svg"), at("b.svg"));
    std::fs::create_dir(at("folder.svg")).unwrap();
    let ending = "the name of a plot ends in .svg";
    let taken = "another file of this command has this name; choose another";
    for (arguments, code, said) in [
        (&["--plot", "a.png"][..], 2, format!("a.png: {ending}")),
        (&["--plot", "-"], 2, format!("-: {ending}")),
        (&["--plot", &path], 2, format!("{path}: {taken}")),
        (&["--plot", &same], 2, format!("{same}: {taken}")),
        (&["--plot", &baseline, "--baseline", &baseline], 2, format!("{baseline}: {taken}")),
        (&["--plot", &other, "--json", &other], 2, format!("--json {other}: {taken}")),
        (
            &["--plot", &at("absent/a.svg")],
            1,
            format!("{}: cannot be written: there is no", at("absent/a.svg")),
        ),
        (
            &["--plot", &at("folder.svg")],
            1,
            format!("{}: cannot be written: it is a folder", at("folder.svg")),
        ),
    ] {
        let output = wavelane(&[&["bench", &path], arguments].concat());
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).starts_with(&said), "{arguments:?} says {}", stderr(&output));
        assert_eq!(stdout(&output), "");
    }
    assert_eq!(folder.names(), ["a.svg", "folder.svg", "scene.svg"]);
}

#[test]
fn bench_leaves_out_what_nothing_grows_with() {
    let folder = Folder::new();
    let path = scene(&folder, "empty.toml", EMPTY);
    let plot = folder.file("growth.SVG").into_os_string().into_string().unwrap();
    let found = report(&["bench", &path, "--repeat", "1", "--plot", &plot]);
    let over: Vec<_> = found["growth"].as_array().unwrap().iter().map(|of| &of["over"]).collect();
    assert_eq!(over, ["pixels", "threads", "samples"]);
    let svg = std::fs::read_to_string(&plot).unwrap();
    assert_plot(&svg);
    assert_eq!(svg.matches("Seconds over ").count(), 3, "{svg}");
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

#[test]
fn of_each_kind_about_as_many_rays_are_looked_at_as_asked_for() {
    let folder = Folder::new();
    let path = scene(&folder, "scene.toml", STILL_LIFE);
    let found = report(&["compare", &path, "--repeat", "1", "--rays", "256", "--size", "128x128"]);
    for kind in ["primary", "shadow", "reflect", "refract"] {
        let (frame, recorded) = (&found["frame_rays"][kind], &found["recorded_rays"][kind]);
        assert!(frame.as_u64().unwrap() > 256, "{kind}: {frame}");
        assert_eq!(recorded, 256, "{kind}");
        assert!(
            found["engines"][1]["hits"][kind]["hits"].as_u64().unwrap() > 0,
            "{kind}, from all over the frame"
        );
    }
}

#[test]
fn progress_comes_to_its_end() {
    let folder = Folder::new();
    let path = scene(&folder, "empty.toml", EMPTY);
    let last = |arguments: &[&str]| {
        let output = wavelane(&[arguments, &["--progress", "json"]].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let last: Value = serde_json::from_str(stderr(&output).lines().last().unwrap()).unwrap();
        last["percent"].as_u64()
    };
    assert_eq!(last(&["compare", &path, "--repeat", "1"]), Some(100));
    assert_eq!(last(&["bench", &path, "--repeat", "1"]), Some(100));
    let picture = folder.file("a.png").into_os_string().into_string().unwrap();
    let rays = folder.file("rays").into_os_string().into_string().unwrap();
    assert_eq!(last(&["render", &path, "-o", &picture, "--record-rays", &rays]), Some(100));
    let primary = folder.file("rays/primary.npy").into_os_string().into_string().unwrap();
    assert_eq!(last(&["trace", &path, "--rays", &primary, "--repeat", "2"]), Some(100));
}

#[test]
fn a_baseline_of_impossible_numbers_is_refused() {
    let folder = Folder::new();
    let path = scene(&folder, "scene.toml", STILL_LIFE);
    let run = ["bench", &path, "--repeat", "1", "--threads", "1", "--size", "16x16"];
    let now = report(&run);
    for number in [0.0, -1.0, 5e-324, 1e308] {
        let mut changed = now.clone();
        changed["scenes"][0]["simd"]["mrays_per_second"]["primary"]["median"] = number.into();
        let baseline = scene(&folder, "changed.json", &changed.to_string());
        let output = wavelane(&[&run[..], &["--baseline", &baseline]].concat());
        assert_eq!(output.status.code(), Some(3), "{number}: {}", stderr(&output));
        assert!(stderr(&output).contains("which no measurement comes to"), "{}", stderr(&output));
    }
}
