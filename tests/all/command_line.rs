//! The program as its users meet it: exit codes, streams, files.

use crate::support::{Folder, stderr, stdout, wavelane};
use wavelane::film::{self, BitDepth, Image};

const SCENE: &str = "[image]\nsize = [20, 10]\nbackground = [0.1, 0.5, 2]\n[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nfov = 40\n[[light]]\nposition = [1, 2, 5]\n[material.m]\ndiffuse = 0.7\nmirror = 0.25\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"m\"\n";

struct Workplace {
    folder: Folder,
}

impl Workplace {
    fn new() -> Self {
        let folder = Folder::new();
        folder.write("scene.toml", SCENE);
        Self { folder }
    }

    fn at(&self, name: &str) -> String {
        self.folder.file(name).into_os_string().into_string().unwrap()
    }

    fn render(&self, output: &str, more: &[&str]) -> std::process::Output {
        let (scene, output) = (self.at("scene.toml"), self.at(output));
        wavelane(&[&["render", &scene, "-o", &output], more].concat())
    }

    fn picture(&self, name: &str) -> Image {
        film::read(&self.folder.file(name)).unwrap()
    }
}

#[track_caller]
fn assert_exit(output: &std::process::Output, code: i32) {
    assert_eq!(output.status.code(), Some(code), "stderr: {}", stderr(output));
}

#[test]
fn a_picture_is_written_in_each_format_and_nothing_else() {
    let place = Workplace::new();
    for name in ["a.png", "a.exr", "a.npy", "b.PNG"] {
        // A build for fewer instructions than this machine has warns, but not so.
        let output = place.render(name, &["--progress", "none"]);
        assert_exit(&output, 0);
        assert_eq!((stdout(&output), stderr(&output)), (String::new(), String::new()), "{name}");
    }
    assert_eq!(place.folder.names(), ["a.exr", "a.npy", "a.png", "b.PNG", "scene.toml"]);
    assert_eq!(place.picture("a.exr"), place.picture("a.npy"));
    assert_eq!(place.picture("a.npy").pixels[0], [0.1, 0.5, 2.0], "linear and not clamped");
    // sRGB of 0.1 is 89.03/255 and of 0.5 is 187.5/255, which the transfer function puts at 188.
    assert_eq!(place.picture("a.png").pixels[0], [89.0 / 255.0, 188.0 / 255.0, 1.0]);
}

#[test]
fn sixteen_bits_are_kept_on_request() {
    let place = Workplace::new();
    assert_exit(&place.render("a.png", &["--bits", "16"]), 0);
    // sRGB of 0.1 is 0.349190…; · 65535 is 22884.2.
    assert_eq!(place.picture("a.png").pixels[0][0], 22884.0 / 65535.0);
}

#[test]
fn the_same_picture_is_the_same_bytes() {
    let place = Workplace::new();
    for extension in ["png", "exr", "npy"] {
        let names = [format!("a.{extension}"), format!("b.{extension}")];
        assert_exit(&place.render(&names[0], &["--threads", "1"]), 0);
        assert_exit(&place.render(&names[1], &["--threads", "2"]), 0);
        let [a, b] = names.map(|name| std::fs::read(place.folder.file(&name)).unwrap());
        assert_eq!(a, b, "{extension}");
    }
}

#[test]
fn a_crop_is_written_alone() {
    let place = Workplace::new();
    assert_exit(&place.render("whole.npy", &["--size", "30x20"]), 0);
    assert_exit(&place.render("part.npy", &["--size", "30x20", "--crop", "10,5,22,13"]), 0);
    let (whole, part) = (place.picture("whole.npy"), place.picture("part.npy"));
    assert_eq!((part.width, part.height), (12, 8));
    for y in 0..8 {
        for x in 0..12 {
            assert_eq!(part.pixels[part.index(x, y)], whole.pixels[whole.index(x + 10, y + 5)]);
        }
    }
}

#[test]
fn the_command_line_goes_before_the_scene() {
    let place = Workplace::new();
    let options = [
        "--size",
        "7x5",
        "--sampling",
        "jittered",
        "--samples",
        "2",
        "--seed",
        "9",
        "--max-depth",
        "0",
        "--json",
        "-",
    ];
    let output = place.render("a.npy", &options);
    assert_exit(&output, 0);
    let report: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(report["size"], serde_json::json!([7, 5]));
    assert_eq!((&report["sampling"], &report["samples"]), (&"jittered".into(), &2.into()));
    assert_eq!((&report["rays"]["primary"], &report["rays"]["reflect"]), (&140.into(), &0.into()));
}

#[test]
fn explain_says_what_will_run() {
    let said = |scene: &str, more: &[&str]| {
        let path = crate::support::root().join("scenes").join(scene);
        let output = wavelane(&[&["explain", path.to_str().unwrap()], more].concat());
        assert_exit(&output, 0);
        stdout(&output)
    };
    let glass = said("glass.toml", &[]);
    for part in ["absorb      exponential", "RefractionQueue", "sphere, polygon", "8 spheres"] {
        assert!(glass.contains(part), "{part} is not in\n{glass}");
    }
    let isometric = said("isometric.toml", &[]);
    for part in ["absorb", "spawn", "RefractionQueue", "each further depth"] {
        assert!(!isometric.contains(part), "{part} is in\n{isometric}");
    }
    let report: serde_json::Value = serde_json::from_str(&said("glass.toml", &["--json", "-"])).unwrap();
    assert_eq!((&report["plan"]["refraction"], &report["plan"]["triangles"]), (&true.into(), &0.into()));
    assert!(glass.contains("accuracy: tests in f32, f64 where f32 cannot tell"), "{glass}");
    assert_eq!(report["accuracy"]["kernels_to_choose_from"], 1);
    assert_exit(&wavelane(&["explain", "absent.toml"]), 3);
}

#[test]
fn the_report_says_what_the_wavefront_engine_did() {
    let place = Workplace::new();
    for (options, engine, lanes) in [
        (&["--engine", "scalar"][..], "scalar", 1),
        (&["--engine", "simd", "--lanes", "4"], "simd", 4),
        (&["--lanes", "8"], "simd", 8),
    ] {
        let output = place.render("a.png", &[options, &["--json", "-", "--progress", "none"]].concat());
        assert_exit(&output, 0);
        let report: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
        assert_eq!((&report["engine"], &report["lanes"]), (&engine.into(), &lanes.into()));
        let stages = report["stages"].as_array().unwrap();
        let intersect = stages.iter().find(|stage| stage["stage"] == "intersect").unwrap();
        assert_eq!((&intersect["depth"], &intersect["rows"]), (&0.into(), &report["rays"]["primary"]));
        let in_use = intersect["lanes"]["in_use"].as_f64().unwrap();
        assert!(in_use > 0.0 && in_use <= f64::from(lanes), "{in_use} of {lanes} lanes in use");
        assert!(report["stage_seconds"]["intersect"].as_f64().unwrap() > 0.0);
        assert!(report["memory"]["queue_bytes_per_worker"].as_u64().unwrap() > 0);
    }
}

#[test]
fn the_report_says_what_ran() {
    let place = Workplace::new();
    let options = ["--engine", "reference", "--threads", "2", "--json", &place.at("report.json")];
    assert_exit(&place.render("a.png", &options), 0);
    let text = std::fs::read_to_string(place.folder.file("report.json")).unwrap();
    let report: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(
        (&report["engine"], &report["lanes"], &report["threads"]),
        (&"reference".into(), &1.into(), &2.into())
    );
    assert!(["sse2", "avx2", "avx512", "neon"].contains(&report["isa"].as_str().unwrap()));
    for kind in ["primary", "shadow", "reflect", "refract"] {
        assert!(report["rays"][kind].is_u64(), "rays.{kind} in {text}");
    }
    for phase in ["load", "prepare", "trace", "write", "total"] {
        assert!(report["seconds"][phase].as_f64().unwrap() >= 0.0, "seconds.{phase} in {text}");
    }
}

#[test]
fn the_report_says_where_it_ran() {
    let place = Workplace::new();
    let output = place.render("a.png", &["--json", "-", "--progress", "none"]);
    let report: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    let machine = report["machine"].as_object().unwrap();
    // What a system does not say is null, and not left out.
    let keys: Vec<&str> = machine.keys().map(String::as_str).collect();
    let expected = [
        "architecture",
        "cache_bytes",
        "compiler",
        "debug_assertions",
        "isa",
        "kernel",
        "logical_processors",
        "memory_bytes",
        "operating_system",
        "opt_level",
        "processor",
        "utc",
        "version",
    ];
    assert_eq!(keys, expected);
    for size in ["l1_data", "l2", "l3"] {
        assert!(machine["cache_bytes"].as_object().unwrap().contains_key(size), "{size}");
    }
    assert_eq!((&machine["isa"], &machine["version"]), (&report["isa"], &report["version"]));
    assert_eq!(machine["debug_assertions"], cfg!(debug_assertions));
}

#[test]
fn progress_goes_to_stderr_as_asked() {
    let place = Workplace::new();
    let output = place.render("a.png", &["--progress", "json", "--json", "-", "--size", "100x100"]);
    assert_exit(&output, 0);
    let lines: Vec<serde_json::Value> =
        stderr(&output).lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(lines.iter().filter(|line| line["percent"] == 100).count(), 1);
    assert!(lines.iter().all(|line| line["total"] == 10_000) && lines.len() <= 101);
    serde_json::from_str::<serde_json::Value>(&stdout(&output)).expect("stdout holds the report alone");
    assert_eq!(stderr(&place.render("a.png", &["--progress", "none"])), "");
}

#[test]
fn wrong_usage_is_2_and_says_what_was_meant() {
    let place = Workplace::new();
    for (arguments, said) in [
        (vec!["--egine", "reference"], "--engine"),
        (vec!["--engine", "referense"], "reference"),
        (vec!["--engine", "fast"], "simd"),
        (vec!["--sampling", "jitterd"], "jittered"),
        (vec!["--samples", "0"], "1..=64"),
        (vec!["--samples", "65"], "1..=64"),
        (vec!["--max-depth", "65"], "64"),
        (vec!["--threads", "0"], "1.."),
        (vec!["--size", "800"], "800x600"),
        (vec!["--size", "0x600"], "no pixels"),
        (vec!["--size", "65536x65536"], "2^31"),
        (vec!["--crop", "0,0,10"], "X0,Y0,X1,Y1"),
        (vec!["--crop", "5,0,5,10"], "X0 < X1"),
        (vec!["--crop", "0,0,21,10"], "20 x 10"),
        (vec!["--bits", "12"], "16"),
        (vec!["--lanes", "5"], "8"),
    ] {
        let output = place.render("a.png", &arguments);
        assert_exit(&output, 2);
        assert!(stderr(&output).contains(said), "{arguments:?} says {}", stderr(&output));
    }
    assert_exit(&wavelane(&["rendr"]), 2);
    assert!(stderr(&wavelane(&["rendr"])).contains("render"));
    assert_exit(&place.render("a.jpg", &[]), 2);
    assert_exit(&wavelane(&[]), 2);
    assert_exit(&wavelane(&["--help"]), 0);
    assert_eq!(place.folder.names(), ["scene.toml"], "no picture and nothing else is left");
}

/// A mirror behind a ball of glass, and two lights.
const PIXEL_SCENE: &str = r#"
[image]
size = [40, 30]
background = [0.1, 0.2, 0.3]
[render]
max_depth = 2
[camera]
eye = [0, -5, 1.5]
target = [0, 0, 0.75]
up = [0, 0, 1]
fov = 40
[ambient]
intensity = 0.2
[[light]]
position = [3, -2, 4]
[[light]]
direction = [1, 0.5, -1]
intensity = 0.3
[material.mirror]
ambient = 0.5
diffuse = 0.1
mirror = 0.8
[material.glass]
specular = 0.5
shininess = 50
ior = 1.5
absorption = [0.1, 0.1, 0.3]
[[sphere]]
center = [-0.6, 0, 0.5]
radius = 0.5
material = "glass"
[[polygon]]
vertices = [[-2, 1, 0], [2, 1, 0], [2, 1, 3], [-2, 1, 3]]
material = "mirror"
"#;

#[test]
fn a_pixel_is_shown_ray_by_ray() {
    let place = Workplace::new();
    let path = place.folder.write("pixel.toml", PIXEL_SCENE);
    let shown = |more: &[&str]| {
        let output = wavelane(&[&["render", path.to_str().unwrap(), "--pixel", "14,17"], more].concat());
        assert_exit(&output, 0);
        assert_eq!(stderr(&output), "");
        stdout(&output).replace(path.to_str().unwrap(), "pixel.toml")
    };
    let text = shown(&["--lanes", "4"]);
    insta::assert_snapshot!(text);
    let scalar = shown(&["--engine", "scalar"]);
    assert_eq!(scalar, text.replace("simd engine (4 lanes)", "scalar engine (1 lane)"));
    let sampled = shown(&["--samples", "2", "--sampling", "jittered", "--seed", "5", "--max-depth", "0"]);
    for part in ["samples: 4", "sample 0 of 0 to 3", "sample 3 of 0 to 3", "no further rays: max_depth is 0"]
    {
        assert!(sampled.contains(part), "{part} is not in\n{sampled}");
    }
    assert!(!sampled.contains("reflected ray") && sampled.ends_with("\n"), "{sampled}");
    let widest = text.lines().map(|line| line.chars().count()).max();
    assert!(widest <= Some(100), "{widest:?} columns");
    assert_eq!(place.folder.names(), ["pixel.toml", "scene.toml"]);
}

#[test]
fn the_readme_shows_a_pixel_as_it_is_printed() {
    let readme = std::fs::read_to_string(crate::support::root().join("README.md")).unwrap();
    let (_, example) = readme.split_once("```sh\nwavelane render scenes/sphereflake.toml --pixel").unwrap();
    let (options, rest) = example.split_once("\n```\n\n```text\n").unwrap();
    let (expected, _) = rest.split_once("```").unwrap();
    let options: Vec<&str> = options.split_whitespace().collect();
    let output = wavelane(&[&["render", "scenes/sphereflake.toml", "--pixel"], &options[..]].concat());
    assert_exit(&output, 0);
    assert_eq!(stdout(&output), expected);
}

#[test]
fn the_trees_of_a_pixel_are_written_as_json() {
    let place = Workplace::new();
    let (scene, json) = (place.at("scene.toml"), place.at("tree.json"));
    let arguments = ["render", &scene, "--pixel", "10,5", "--max-depth", "1", "--json"];
    let to_stdout = wavelane(&[&arguments[..], &["-"]].concat());
    assert_exit(&to_stdout, 0);
    let report: serde_json::Value = serde_json::from_str(&stdout(&to_stdout)).unwrap();
    let to_file = wavelane(&[&arguments[..], &[&json]].concat());
    assert_exit(&to_file, 0);
    assert!(stdout(&to_file).contains("same tree; "), "{}", stdout(&to_file));
    assert_eq!(std::fs::read_to_string(&json).unwrap(), stdout(&to_stdout));
    for tree in ["reference_tree", "engine_tree"] {
        let ray = &report[tree]["samples"][0];
        assert_eq!((&ray["hit"]["kind"], &ray["hit"]["primitive"]), (&"sphere".into(), &0.into()));
        assert_eq!(ray["hit"]["lights"][0]["shadow"], "visible");
        assert_eq!((&ray["reflect"]["hit"], &ray["refract"]), (&serde_json::Value::Null, &().into()));
        assert_eq!(ray["reflect"]["weight"], serde_json::json!([0.25, 0.25, 0.25]));
    }
    assert_eq!((&report["pixel"], &report["parting"]), (&serde_json::json!([10, 5]), &().into()));
    assert_eq!(report["verdict"].as_str().map(|verdict| verdict.starts_with("same tree; ")), Some(true));
}

/// Readers of JSON have limits, of 128 levels for instance.
#[test]
fn the_deepest_tree_can_be_read() {
    let place = Workplace::new();
    let mirrors = "[image]\nsize = [1, 1]\n[render]\nmax_depth = 64\n[camera]\neye = [0, 0, 0]\ntarget = [0, 0.01, 1]\nup = [0, 1, 0]\nfov = 1\n[material.m]\nmirror = 1\n[[polygon]]\nvertices = [[-9, -9, 1], [9, -9, 1], [9, 9, 1], [-9, 9, 1]]\nmaterial = \"m\"\n[[polygon]]\nvertices = [[-9, -9, -1], [9, -9, -1], [9, 9, -1], [-9, 9, -1]]\nmaterial = \"m\"\n";
    let path = place.folder.write("mirrors.toml", mirrors);
    let output = wavelane(&["render", path.to_str().unwrap(), "--pixel", "0,0", "--json", "-"]);
    assert_exit(&output, 0);
    let report: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    let mut ray = &report["engine_tree"]["samples"][0];
    for depth in 0..64 {
        assert_eq!(ray["hit"]["primitive"], depth % 2, "depth {depth}");
        ray = &ray["reflect"];
    }
    assert!(ray["hit"].is_object() && ray["reflect"].is_null(), "{ray}");
}

#[test]
fn a_pixel_takes_the_place_of_a_picture() {
    let place = Workplace::new();
    let scene = place.at("scene.toml");
    for (arguments, said) in [
        (&["--pixel", "20,0"][..], "the last 19,9"),
        (&["--pixel", "0,10"], "20 x 10 pixels"),
        (&["--pixel", "5,5", "--size", "5x9"], "the last 4,8"),
        (&["--pixel", "5"], "400,300"),
        (&["--pixel", "5,x"], "400,300"),
        (&["--pixel=-1,0"], "400,300"),
        (&["--pixel", "5,5", "-o", "a.png"], "cannot be used with"),
        (&["--pixel", "5,5", "--crop", "0,0,1,1"], "cannot be used with"),
        (&["--pixel", "5,5", "--bits", "16"], "cannot be used with"),
        (&["--pixel", "5,5", "--engine", "reference"], "simd or scalar"),
        (&["--pixel", "5,5", "--json", &scene], "choose another"),
        (&[], "--output"),
    ] {
        let output = wavelane(&[&["render", &scene], arguments].concat());
        assert_exit(&output, 2);
        assert!(stderr(&output).contains(said), "{arguments:?} says {}", stderr(&output));
        assert_eq!(stdout(&output), "");
    }
    assert_eq!(place.folder.names(), ["scene.toml"]);
}

#[test]
fn the_version_says_what_it_was_built_for() {
    let version = env!("CARGO_PKG_VERSION");
    let output = wavelane(&["--version"]);
    assert_exit(&output, 0);
    let built_for = wavelane::lanes::Isa::BUILT_FOR;
    assert_eq!(stdout(&output), format!("wavelane {version}\nbuilt for {built_for}\n"));
    assert_eq!(stdout(&wavelane(&["-V"])), format!("wavelane {version}\n"));
}

#[test]
fn bad_input_is_3_and_leaves_no_file() {
    let place = Workplace::new();
    place.folder.write("scene.toml", SCENE.replace("radius = 1", "radius = -1"));
    let output = place.render("a.png", &[]);
    assert_exit(&output, 3);
    let expected = format!("{}:16:10: the radius is -1; it must be greater than 0\n", place.at("scene.toml"));
    assert_eq!((stdout(&output), stderr(&output)), (String::new(), expected));
    assert_eq!(place.folder.names(), ["scene.toml"]);
    assert_exit(&wavelane(&["check", &place.at("scene.toml")]), 3);
    assert_exit(&wavelane(&["check", &place.at("absent.toml")]), 3);
}

#[test]
fn a_picture_that_cannot_be_written_is_1_before_any_work() {
    let place = Workplace::new();
    let output = place.render("absent/a.png", &["--size", "20000x20000", "--samples", "64"]);
    assert_exit(&output, 1);
    assert!(stderr(&output).contains("absent/a.png: cannot be written"), "{}", stderr(&output));
    std::fs::create_dir(place.folder.file("folder.png")).unwrap();
    assert_exit(&place.render("folder.png", &[]), 1);
    let output = place.render("a.png", &["--json", &place.at("absent/report.json"), "--size", "20000x20000"]);
    assert_exit(&output, 1);
    assert_exit(&place.render("a.npy", &["--json", &place.at("a.npy")]), 2);
    assert_eq!(place.folder.names(), ["folder.png", "scene.toml"]);
}

#[test]
fn check_says_what_it_found_and_warns_on_stderr() {
    let place = Workplace::new();
    let flat = "[[triangle]]\nvertices = [[0, 0, 0], [1, 1, 1], [2, 2, 2]]\nmaterial = \"m\"\n";
    let path = place.at("scene.toml");
    place.folder.write("scene.toml", format!("{SCENE}{flat}{flat}"));
    let output = wavelane(&["check", &path]);
    assert_exit(&output, 0);
    assert_eq!(
        stdout(&output),
        format!("{path}: 1 sphere, 0 triangles, 0 polygons, 1 light, 1 material, 20 x 10 pixels\n")
    );
    assert_eq!(
        stderr(&output),
        format!(
            "{path}:18:1: warning: this shape has no area and is left out (2 in all; this is the first)\n"
        )
    );
}

fn pixels(values: &[f32]) -> Image {
    Image { width: values.len() as u32, height: 1, pixels: values.iter().map(|&value| [value; 3]).collect() }
}

#[test]
fn diff_measures_and_judges_only_by_a_limit() {
    let place = Workplace::new();
    let write = |name: &str, values: &[f32]| {
        film::write(&pixels(values), &place.folder.file(name), BitDepth::Eight).unwrap();
    };
    write("a.npy", &[0.0, 0.5, 1.0, 2.0]);
    write("b.exr", &[0.0, 0.5, 1.25, 2.0]);
    write("short.npy", &[0.0]);
    let (a, b) = (place.at("a.npy"), place.at("b.exr"));

    let output = wavelane(&["diff", &a, &b]);
    assert_exit(&output, 0);
    assert_eq!(stdout(&output), "largest 2.500000e-1 at (2, 0), rms 1.250000e-1, 1 of 4 pixels over 0\n");
    assert_exit(&wavelane(&["diff", &a, &b, "--limit", "0.25"]), 0);
    let over = wavelane(&["diff", &a, &b, "--limit", "0.2", "--json", "-", "--heat", &place.at("heat.png")]);
    assert_exit(&over, 4);
    let report: serde_json::Value = serde_json::from_str(&stdout(&over)).unwrap();
    assert_eq!(
        (&report["largest"], &report["rms"], &report["pixels_over"]),
        (&0.25.into(), &0.125.into(), &1.into())
    );
    assert_eq!(place.picture("heat.png").pixels, [[0.0; 3], [0.0; 3], [1.0; 3], [0.0; 3]]);

    assert_exit(&wavelane(&["diff", &a, &a, "--limit", "0"]), 0);
    assert_exit(&wavelane(&["diff", &a, &place.at("short.npy")]), 3);
    assert_exit(&wavelane(&["diff", &a, &place.at("absent.png")]), 3);
    assert_exit(&wavelane(&["diff", &a, &place.at("scene.toml")]), 3);
    assert_exit(&wavelane(&["diff", &a, &b, "--limit", "nan"]), 2);
    place.folder.write("broken.png", "not a PNG");
    assert_exit(&wavelane(&["diff", &a, &place.at("broken.png")]), 3);
}

#[test]
fn diff_compares_a_png_with_linear_values_in_linear_light() {
    let place = Workplace::new();
    for name in ["a.png", "a.npy"] {
        film::write(&pixels(&[0.0, 0.25, 1.0]), &place.folder.file(name), BitDepth::Sixteen).unwrap();
    }
    let output = wavelane(&["diff", &place.at("a.png"), &place.at("a.npy"), "--limit", "1e-4"]);
    assert_exit(&output, 0);
}

#[cfg(unix)]
#[test]
fn an_interrupted_render_is_130_and_leaves_no_file() {
    use std::process::{Command, Stdio};
    let place = Workplace::new();
    let (scene, output) = (place.at("scene.toml"), place.at("a.png"));
    let arguments =
        ["render", &scene, "-o", &output, "--size", "1000x1000", "--samples", "16", "--progress", "json"];
    let mut child =
        Command::new(env!("CARGO_BIN_EXE_wavelane")).args(arguments).stderr(Stdio::piped()).spawn().unwrap();
    // Its first line of progress says that it is at work.
    let mut first = [0];
    std::io::Read::read_exact(child.stderr.as_mut().unwrap(), &mut first).unwrap();
    let killed = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(killed.success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(place.folder.names(), ["scene.toml"]);
}

#[cfg(unix)]
#[test]
fn a_picture_has_the_rights_of_any_new_file_and_a_link_stays_a_link() {
    use std::os::unix::fs::PermissionsExt;
    let place = Workplace::new();
    let plain = place.folder.write("plain", "");
    std::os::unix::fs::symlink(place.folder.file("target.png"), place.folder.file("link.png")).unwrap();
    place.folder.write("target.png", "old");
    assert_exit(&place.render("link.png", &[]), 0);
    assert!(place.folder.file("link.png").is_symlink());
    let mode = |path: &std::path::Path| std::fs::metadata(path).unwrap().permissions().mode();
    assert_eq!(mode(&place.folder.file("target.png")), mode(&plain));
    assert_eq!(place.picture("target.png").width, 20);
}
