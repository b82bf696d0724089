//! `compare --report`: a folder with a page.

use crate::support::{Folder, assert_plot, stderr, stdout, wavelane};
use roxmltree::{Document, ParsingOptions};
use std::path::Path;
use std::process::Output;

/// A mirror over a ground, so that there are primary, shadow and reflected rays.
const SCENE: &str = "[image]\nsize = [24, 16]\nbackground = 0.5\n[camera]\neye = [0, -6, 2]\ntarget = [0, 0, 0.5]\nup = [0, 0, 1]\nfov = 40\n[[light]]\nposition = [3, -3, 5]\n[material.m]\ndiffuse = 0.7\nmirror = 0.25\n[[sphere]]\ncenter = [0, 0, 0.5]\nradius = 0.5\nmaterial = \"m\"\n[[polygon]]\nvertices = [[-3, -3, 0], [3, -3, 0], [3, 3, 0], [-3, 3, 0]]\nmaterial = \"m\"\n";

const ALL_FILES: [&str; 9] = [
    "comparison.json",
    "engine-error.png",
    "engine.png",
    "floor-error.png",
    "hit-errors.svg",
    "index.html",
    "speed-by-kind.svg",
    "speed-over-error.svg",
    "truth.png",
];

fn compare(scene: &Path, report: &Path, more: &[&str]) -> Output {
    let [scene, report] = [scene, report].map(|path| path.to_str().unwrap());
    let options = ["--repeat", "1", "--rays", "400", "--progress", "none", "--report", report];
    wavelane(&[&["compare", scene], &options[..], more].concat())
}

#[track_caller]
fn assert_exit(output: &Output, code: i32) {
    assert_eq!(output.status.code(), Some(code), "stderr: {}", stderr(output));
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// The page and the plots are well-formed, need nothing from elsewhere, show only files that are there, and have only
/// numbers in them.
#[track_caller]
fn assert_sound(folder: &Path) -> String {
    let page = std::fs::read_to_string(folder.join("index.html")).unwrap();
    for address in ["http:", "https:", "url(", "<script", "@import", "src=\"/"] {
        assert!(!page.contains(address), "{address} in {page}");
    }
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    let parsed =
        Document::parse_with_options(&page, options).unwrap_or_else(|error| panic!("{error}\n{page}"));
    let mut shown = 0;
    for node in parsed.descendants() {
        for name in ["src", "href"].into_iter().filter_map(|name| node.attribute(name)) {
            assert!(folder.join(name).is_file(), "{name} is not there");
            shown += 1;
        }
        if node.has_tag_name("img") {
            assert!(["width", "height", "alt"].into_iter().all(|name| node.has_attribute(name)), "{node:?}");
        }
    }
    assert!(shown >= 4, "{page}");
    let words: String = parsed.descendants().filter_map(|node| node.text()).collect::<Vec<_>>().join(" ");
    for no_number in ["NaN", "inf"] {
        let is_word = |word: &str| word == no_number;
        assert!(!words.split(|letter: char| !letter.is_alphabetic()).any(is_word), "{no_number} in {words}");
    }
    for name in names(folder).iter().filter(|name| name.ends_with(".svg")) {
        assert_plot(&std::fs::read_to_string(folder.join(name)).unwrap());
    }
    page
}

#[test]
fn the_page_is_whole_and_needs_no_network() {
    let folder = Folder::new();
    let (scene, report) = (folder.write("scene.toml", SCENE), folder.file("a/b"));
    let json = folder.file("c.json");
    let output = compare(&scene, &report, &["--json", json.to_str().unwrap()]);
    assert_exit(&output, 0);
    assert!(stdout(&output).contains("× scalar"), "the tables are printed as ever: {}", stdout(&output));
    assert_eq!(names(&report), ALL_FILES);
    let page = assert_sound(&report);
    let read =
        |path: &Path| -> serde_json::Value { serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap() };
    let data = read(&report.join("comparison.json"));
    assert_eq!(data, read(&json));
    for text in ["processor", "compiler", "utc", "version", "isa"] {
        assert!(data["machine"].get(text).is_some(), "{text}");
    }
    let command = data["command"].as_str().unwrap();
    assert!(command.starts_with("wavelane compare ") && page.contains(command), "{command}");
    for name in ["truth.png", "engine.png", "engine-error.png", "floor-error.png"] {
        let picture = wavelane::film::read(&report.join(name)).unwrap();
        assert_eq!((picture.width, picture.height), (24, 16), "{name}");
    }
}

#[test]
fn what_accuracy_costs_is_a_section_with_a_plot_for_each_rung_that_there_is() {
    let triangle = |z: f32| {
        format!("[[triangle]]\nvertices = [[-2, 1, 0], [0, 1, 0], [-1, 1, {z}]]\nmaterial = \"m\"\n")
    };
    let with_mesh = format!("{SCENE}{}{}", triangle(2.0), triangle(-1.0));
    let matte = SCENE.replace("mirror = 0.25\n", "");
    let nothing = "[image]\nsize = [8, 8]\n".to_owned();
    let all = [
        "polygon-formulas.svg",
        "samples.svg",
        "sphere-formulas.svg",
        "triangle-formulas.svg",
        "weak-rays.svg",
    ];
    for (text, expected) in [(with_mesh, &all[..]), (matte, &all[..3]), (nothing, &[])] {
        let folder = Folder::new();
        let (scene, report) = (folder.write("scene.toml", text), folder.file("report"));
        assert_exit(&compare(&scene, &report, &["--rungs", "--size", "12x8"]), 0);
        let page = assert_sound(&report);
        assert!(page.contains("<h2>What accuracy costs</h2>"), "{page}");
        let found: Vec<String> =
            names(&report).into_iter().filter(|name| all.contains(&name.as_str())).collect();
        assert_eq!(found, expected);
        let shown = |name: &&&str| page.contains(&format!("href=\"{name}\""));
        assert_eq!(all.iter().filter(shown).count(), expected.len());
        // A page without rungs takes the place of one with.
        assert_exit(&compare(&scene, &report, &["--size", "12x8"]), 0);
        assert!(!names(&report).iter().any(|name| all.contains(&name.as_str())));
        assert!(!assert_sound(&report).contains("What accuracy costs"));
    }
}

/// The command that the page names is one that the program takes, and it says the same of the scene.
#[test]
fn the_command_on_the_page_compares_the_same_again() {
    let folder = Folder::new();
    let (scene, report) = (folder.write("scene.toml", SCENE), folder.file("r"));
    let data = || -> serde_json::Value {
        serde_json::from_slice(&std::fs::read(report.join("comparison.json")).unwrap()).unwrap()
    };
    assert_exit(
        &compare(&scene, &report, &["--size", "10x6", "--samples", "2", "--sampling", "jittered"]),
        0,
    );
    let first = data();
    let command = first["command"].as_str().unwrap().to_owned();
    let words: Vec<&str> = command.split(' ').skip(1).collect();
    assert_exit(&wavelane(&words), 0);
    for key in ["command", "size", "samples", "sampling", "seed", "max_depth", "frame_rays", "floor"] {
        assert_eq!(first[key], data()[key], "{key}");
    }
}

#[test]
fn odd_scenes_have_a_page_too() {
    let sphere = |center: &str| {
        format!(
            "[image]\nsize = [8, 8]\n[material.m]\n[[sphere]]\ncenter = {center}\nradius = 1\nmaterial = \"m\"\n"
        )
    };
    let bright = SCENE.replace("[[light]]", "[[light]]\nintensity = 1e18");
    for (what, text) in [
        ("nothing in it", "[image]\nsize = [8, 8]\n".to_owned()),
        ("one pixel", "[image]\nsize = [1, 1]\n".to_owned()),
        ("black, and hit", sphere("[0, 0, 0]")),
        ("nothing is hit", sphere("[0, 0, 9e9]")),
        ("lights that overflow colours", bright),
    ] {
        let folder = Folder::new();
        let (scene, report) = (folder.write("scene.toml", text), folder.file("report"));
        let output = compare(&scene, &report, &[]);
        assert!(matches!(output.status.code(), Some(0 | 4)), "{what}: {}", stderr(&output));
        assert_sound(&report);
    }
}

#[cfg(unix)]
#[test]
fn the_name_of_a_scene_cannot_become_markup() {
    let folder = Folder::new();
    let scene = folder.write("<b>&\"'\n$(x).toml", SCENE);
    assert_exit(&compare(&scene, &folder.file("report"), &[]), 0);
    let page = assert_sound(&folder.file("report"));
    assert!(page.contains("&lt;b&gt;&amp;&quot;&#39;") && !page.contains("<b>"), "{page}");
}

#[test]
fn an_earlier_page_is_replaced_and_what_else_is_there_stays() {
    let folder = Folder::new();
    let (scene, report) = (folder.write("scene.toml", SCENE), folder.file("report"));
    assert_exit(&compare(&scene, &report, &[]), 0);
    std::fs::write(report.join("notes.txt"), "mine").unwrap();
    // Without hits there is no plot of their errors.
    folder.write("scene.toml", "[image]\nsize = [8, 8]\n");
    assert_exit(&compare(&scene, &report, &[]), 0);
    let mut expected: Vec<&str> = ALL_FILES.into_iter().filter(|&name| name != "hit-errors.svg").collect();
    expected.insert(5, "notes.txt");
    assert_eq!(names(&report), expected);
    assert_sound(&report);
}

#[test]
fn files_that_are_not_of_a_report_are_not_replaced() {
    for name in ["index.html", "truth.png"] {
        let folder = Folder::new();
        let scene = folder.write("scene.toml", SCENE);
        folder.write(name, "mine");
        let output = compare(&scene, folder.path(), &[]);
        assert_exit(&output, 1);
        assert!(stderr(&output).contains(name), "{}", stderr(&output));
        assert_eq!(std::fs::read_to_string(folder.file(name)).unwrap(), "mine");
        assert_eq!(stdout(&output), "", "it is found out before the work");
    }
}

#[test]
fn a_report_that_cannot_be_written_is_found_out_before_the_work() {
    let folder = Folder::new();
    let scene = folder.write("scene.toml", SCENE);
    let file = folder.write("file", "mine");
    std::fs::create_dir_all(folder.file("taken/speed-by-kind.svg")).unwrap();
    for (report, named) in
        [(file.clone(), "file"), (file.join("within"), "within"), (folder.file("taken"), "speed-by-kind.svg")]
    {
        let output = compare(&scene, &report, &[]);
        assert_exit(&output, 1);
        assert!(stderr(&output).contains(named), "{}", stderr(&output));
        assert_eq!(stdout(&output), "");
    }
}

#[test]
fn the_json_cannot_take_the_place_of_a_file_of_the_report() {
    let folder = Folder::new();
    let (scene, report) = (folder.write("scene.toml", SCENE), folder.file("report"));
    let page = report.join("index.html");
    let output = compare(&scene, &report, &["--json", page.to_str().unwrap()]);
    assert_exit(&output, 2);
    assert!(stderr(&output).contains("index.html"), "{}", stderr(&output));
}
