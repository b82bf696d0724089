//! Every kind of bad input, and the message that the user gets. The messages are kept in a snapshot, to be read whole.

use crate::support::{Folder, npy, npy_floats, npy_indices};
use std::fmt::Write;
use wavelane::load::load;

const MATERIAL: &str = "[material.matte]\ndiffuse = 0.5\n";

/// The message for a file, with the folder's name left out; panics where the file is accepted.
fn message(files: &[(&str, &[u8])]) -> String {
    let folder = Folder::new();
    for (name, content) in files {
        folder.write(name, content);
    }
    match load(&folder.file(files[0].0)) {
        Ok(_) => panic!("{} was accepted:\n{}", files[0].0, String::from_utf8_lossy(files[0].1)),
        Err(error) => error.to_string().replace(&format!("{}/", folder.path().display()), ""),
    }
}

/// A heading for each case, and its message.
fn messages(name: &str, cases: &[(&str, &str)]) -> String {
    let mut all = String::new();
    for (what, content) in cases {
        writeln!(all, "# {what}\n{}\n", message(&[(name, content.as_bytes())])).unwrap();
    }
    all
}

fn sphere(lines: &str) -> String {
    format!("{MATERIAL}[[sphere]]\n{lines}\n")
}

fn camera(lines: &str) -> String {
    format!("[camera]\n{lines}\n")
}

const EYE: &str = "eye = [0, 0, 5]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\n";

#[test]
fn toml() {
    let polygon =
        |vertices: &str| format!("{MATERIAL}[[polygon]]\nvertices = {vertices}\nmaterial = \"matte\"\n");
    let cases = [
        ("not TOML", "[image\nsize = 3".to_owned()),
        ("cut off in a list", "[image]\nsize = [3,".to_owned()),
        ("the same key twice", "[image]\nsize = [3, 3]\nsize = [4, 4]".to_owned()),
        ("unknown table", "[imag]\nsize = [3, 3]".to_owned()),
        ("unknown key", "[image]\nsze = [3, 3]".to_owned()),
        ("unknown key like no other", sphere("wibble = 3")),
        ("unknown key of a material", "[material.m]\n\n  difuse = 1".to_owned()),
        ("unknown material", sphere("center = [0, 0, 0]\nradius = 1\nmaterial = \"mate\"")),
        ("missing key", sphere("center = [0, 0, 0]\nmaterial = \"matte\"")),
        ("one bracket", "[sphere]\ncenter = [0, 0, 0]".to_owned()),
        ("wrong type", sphere("center = \"here\"\nradius = 1\nmaterial = \"matte\"")),
        ("two coordinates", sphere("center = [0, 0]\nradius = 1\nmaterial = \"matte\"")),
        ("NaN", sphere("center = [0, nan, 0]\nradius = 1\nmaterial = \"matte\"")),
        ("infinite", sphere("center = [0, 0, -inf]\nradius = 1\nmaterial = \"matte\"")),
        ("beyond f64", sphere("center = [0, 0, 1e999]\nradius = 1\nmaterial = \"matte\"")),
        ("over 1e18", sphere("center = [0, 0, 0]\nradius = 1.1e18\nmaterial = \"matte\"")),
        ("radius 0", sphere("center = [0, 0, 0]\nradius = 0\nmaterial = \"matte\"")),
        ("negative radius", sphere("center = [0, 0, 0]\nradius = -1\nmaterial = \"matte\"")),
        ("radius that is 0 in f32", sphere("center = [0, 0, 0]\nradius = 1e-60\nmaterial = \"matte\"")),
        ("two vertices", polygon("[[0, 0, 0], [1, 0, 0]]")),
        ("not planar", polygon("[[0, 0, 0], [1, 0, 0], [1, 1, 0.01], [0, 1, 0]]")),
        (
            "triangle of four",
            format!(
                "{MATERIAL}[[triangle]]\nvertices = [[0,0,0],[1,0,0],[1,1,0],[0,1,0]]\nmaterial = \"matte\""
            ),
        ),
        ("eye at target", camera("eye = [1, 2, 3]\ntarget = [1, 2, 3]\nup = [0, 1, 0]\nfov = 45")),
        ("up along the view", camera("eye = [0, 0, 5]\ntarget = [0, 0, 0]\nup = [0, 0, -2]\nfov = 45")),
        ("up is zero", camera("eye = [0, 0, 5]\ntarget = [0, 0, 0]\nup = [0, 0, 0]\nfov = 45")),
        ("camera without up", camera("eye = [0, 0, 5]\ntarget = [0, 0, 0]\nfov = 45")),
        ("camera without angle", camera(EYE)),
        ("angle of 180", camera(&format!("{EYE}fov = 180"))),
        ("angle and window", camera(&format!("{EYE}fov = 45\nwindow = [-1, 1, -1, 1]"))),
        ("window turned round", camera(&format!("{EYE}window = [1, -1, -1, 1]"))),
        ("distance 0", camera(&format!("{EYE}window = [-1, 1, -1, 1]\ndistance = 0"))),
        ("unknown kind", camera(&format!("{EYE}kind = \"ortographic\"\nheight = 1"))),
        ("height of a perspective camera", camera(&format!("{EYE}height = 1"))),
        ("height 0", camera(&format!("{EYE}kind = \"orthographic\"\nheight = 0"))),
        ("no pixels", "[image]\nsize = [0, 100]".to_owned()),
        ("more than 2^31 pixels", "[image]\nsize = [65536, 32769]".to_owned()),
        ("half a pixel", "[image]\nsize = [10.5, 100]".to_owned()),
        ("negative size", "[image]\nsize = [-10, 100]".to_owned()),
        ("max_depth 65", "[render]\nmax_depth = 65".to_owned()),
        ("samples 0", "[render]\nsamples = 0".to_owned()),
        ("samples 65", "[render]\nsamples = 65".to_owned()),
        ("seed of 33 bits", "[render]\nseed = 4294967296".to_owned()),
        ("unknown sampling", "[render]\nsampling = \"jitterd\"".to_owned()),
        ("negative min_weight", "[render]\nmin_weight = -0.1".to_owned()),
        ("ior 0", "[material.m]\nior = 0".to_owned()),
        ("negative ior", "[material.m]\nior = -1.5".to_owned()),
        ("negative absorption", "[material.m]\nior = 1.5\nabsorption = [0, -0.1, 0]".to_owned()),
        ("negative shininess", "[material.m]\nshininess = -1".to_owned()),
        ("colour of two numbers", "[material.m]\ndiffuse = [1, 1]".to_owned()),
        ("light without place", "[[light]]\nintensity = 1".to_owned()),
        ("light with both", "[[light]]\nposition = [0, 0, 0]\ndirection = [0, 0, 1]".to_owned()),
        ("light without direction", "[[light]]\ndirection = [0, 0, 0]".to_owned()),
        ("mesh that is not there", "[[mesh]]\nfile = \"absent.obj\"".to_owned()),
        ("mesh of another kind", "[[mesh]]\nfile = \"scene.toml\"".to_owned()),
        ("too small to be framed", sphere("center = [1e6, 1e6, 1e6]\nradius = 1e-3\nmaterial = \"matte\"")),
        ("mesh of scale 0", "[[mesh]]\nfile = \"a.obj\"\nscale = 0".to_owned()),
    ];
    let cases: Vec<(&str, &str)> = cases.iter().map(|(what, content)| (*what, content.as_str())).collect();
    insta::assert_snapshot!(messages("scene.toml", &cases));
}

#[test]
fn nff() {
    let cases = [
        ("cone", "f 1 1 1 1 0 1 0 0\n  c 0 0 0 1\n0 0 1 1\n"),
        ("unknown entity", "f 1 1 1 1 0 1 0 0\nsphere 0 0 0 1\n"),
        ("word for a number", "s 0 0 zero 1\n"),
        ("NaN", "s 0 0 nan 1\n"),
        ("over 1e18", "l 1e19 0 0\n"),
        ("radius 0", "f 1 1 1 1 0 1 0 0\ns 0 0 0 0\n"),
        ("cut off in a polygon", "p 3\n0 0 0\n1 0 0\n0 1"),
        ("polygon of two vertices", "p 2\n0 0 0\n1 0 0\n"),
        ("polygon of a half vertex", "p 3.5\n"),
        ("polygon of very many vertices", "p 1e15\n0 0 0\n"),
        ("not planar", "p 4\n0 0 0\n1 0 0\n1 1 0.1\n0 1 0\n"),
        ("from is at", "v\nfrom 1 1 1\nat 1 1 1\nup 0 0 1\nangle 45\n"),
        ("up along the view", "v\nfrom 0 0 1\nat 0 0 0\nup 0 0 1\nangle 45\n"),
        ("angle of 0", "v\nfrom 0 0 1\nat 0 0 0\nup 0 1 0\nangle 0\n"),
        ("view without up", "v\nfrom 0 0 1\nat 0 0 0\nangle 45\n"),
        ("no pixels", "resolution 0 0\n"),
        ("negative index of refraction", "f 1 1 1 1 0 1 0.5 -1.5\n"),
        ("binary", "s 0 0 0 1\n\u{0}\u{1}\n"),
    ];
    insta::assert_snapshot!(messages("scene.nff", &cases));
}

#[test]
fn obj() {
    const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let with = |lines: &str| format!("{TRIANGLE}{lines}\n");
    let cases = [
        ("index out of range", with("f 1 2 4")),
        ("index 0", with("f 0 1 2")),
        ("negative index out of range", with("f -1 -2 -4")),
        ("normal out of range", with("f 1//1 2//1 3//1")),
        ("face of two corners", with("f 1 2")),
        ("corner that is no index", with("f 1 2 x")),
        ("word for a number", with("v 1 2 three\nf 1 2 3")),
        ("two coordinates", with("v 1 2\nf 1 2 3")),
        ("NaN", with("v 1 nan 2\nf 1 2 3")),
        ("over 1e18", with("v 1 1e30 2\nf 1 2 3")),
        ("over 1e18 by its weight", with("v 1 1 1 1e-30\nf 1 2 3")),
        ("unknown keyword", with("vertex 1 2 3")),
        ("unknown material", with("usemtl red\nf 1 2 3")),
        ("library that is not there", with("mtllib absent.mtl\nf 1 2 3")),
        ("no faces", with("")),
        ("binary", with("\u{0}\u{1}\u{2}")),
    ];
    let cases: Vec<(&str, &str)> = cases.iter().map(|(what, content)| (*what, content.as_str())).collect();
    insta::assert_snapshot!(messages("mesh.obj", &cases));
}

#[test]
fn mtl() {
    let cases = [
        ("before newmtl", "Kd 1 1 1\n"),
        ("two channels", "newmtl m\nKd 1 1\n"),
        ("word for a number", "newmtl m\nKs 1 1 x\n"),
        ("spectral", "newmtl m\nKd spectral a.rfl\n"),
        ("negative", "newmtl m\nKd 1 1 -1\n"),
        ("NaN", "newmtl m\nNs nan\n"),
        ("ior 0", "newmtl m\nillum 7\nNi 0\n"),
        ("illum 11", "newmtl m\nillum 11\n"),
        ("newmtl without a name", "newmtl\n"),
    ];
    let mut all = String::new();
    for (what, content) in cases {
        let obj: &[u8] = b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        writeln!(all, "# {what}\n{}\n", message(&[("mesh.obj", obj), ("a.mtl", content.as_bytes())]))
            .unwrap();
    }
    insta::assert_snapshot!(all);
}

#[test]
fn ply() {
    const START: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    let with = |lines: &str| format!("{START}{lines}");
    let cases = [
        ("not PLY", "plyy\n".to_owned()),
        ("cut off in the header", "ply\nformat ascii 1.0\nelement ver".to_owned()),
        ("index out of range", with("0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n")),
        ("negative index", with("0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n")),
        ("face of two corners", with("0 0 0\n1 0 0\n0 1 0\n2 0 1\n")),
        ("NaN", with("0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n")),
        ("over 1e18", with("0 0 0\n1 0 0\n0 1e20 0\n3 0 1 2\n")),
        ("word for a number", with("0 0 0\n1 zero 0\n0 1 0\n3 0 1 2\n")),
        ("cut off", with("0 0 0\n1 0 0\n")),
        ("no faces", START.replace("face 1", "face 0") + "0 0 0\n1 0 0\n0 1 0\n"),
        ("no z", START.replace("property float z\n", "")),
        ("no list of corners", START.replace("vertex_indices", "corners")),
        ("very many vertices", START.replace("vertex 3", "vertex 99999999999")),
    ];
    let cases: Vec<(&str, &str)> = cases.iter().map(|(what, content)| (*what, content.as_str())).collect();
    insta::assert_snapshot!(messages("mesh.ply", &cases));
}

#[test]
fn folder() {
    const CORNERS: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let vertices = |rows: &[[f32; 3]]| vec![("vertices.npy", npy_floats(rows))];
    let with_vertex =
        |vertex| [vertices(&[CORNERS[0], vertex]), vec![("triangles.npy", npy_indices(&[]))]].concat();
    let with_triangles = |file| [vertices(&CORNERS), vec![("triangles.npy", file)]].concat();
    let sphere = |radius| vec![("spheres.npy", npy_floats(&[[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, radius]]))];
    let cases = [
        ("nothing in it", vec![]),
        ("vertices alone", vertices(&CORNERS)),
        ("triangles alone", vec![("triangles.npy", npy_indices(&[]))]),
        ("index out of range", with_triangles(npy_indices(&[[0, 1, 2], [0, 1, 3]]))),
        ("index -1", with_triangles(npy_indices(&[[0, 1, u32::MAX]]))),
        ("int64 triangles", with_triangles(npy("<i8", "(1, 3)", vec![0; 24]))),
        (
            "float64 vertices",
            vec![("vertices.npy", npy("<f8", "(1, 3)", vec![0; 24])), ("triangles.npy", vec![])],
        ),
        ("triangles of four corners", with_triangles(npy("<u4", "(1, 4)", vec![0; 16]))),
        ("triangles in one row", with_triangles(npy("<u4", "(6,)", vec![0; 24]))),
        ("triangles cut off", with_triangles(npy("<u4", "(2, 3)", vec![0; 20]))),
        ("empty file", with_triangles(vec![])),
        ("NaN", with_vertex([0.0, f32::NAN, 0.0])),
        ("infinite", with_vertex([0.0, 0.0, f32::NEG_INFINITY])),
        ("over 1e18", with_vertex([1.1e18, 0.0, 0.0])),
        ("radius 0", sphere(0.0)),
        ("negative radius", sphere(-1.0)),
        ("radius NaN", sphere(f32::NAN)),
        ("spheres without radius", vec![("spheres.npy", npy_floats(&[[0.0, 0.0, 0.0]]))]),
        ("too small to be framed", vec![("spheres.npy", npy_floats(&[[1e6, 1e6, 1e6, 1e-3]]))]),
    ];
    let mut all = String::new();
    for (what, files) in cases {
        let folder = Folder::new();
        for (name, content) in files {
            folder.write(name, content);
        }
        let message = load(folder.path()).expect_err(what).to_string();
        writeln!(all, "# {what}\n{}\n", message.replace(&folder.path().display().to_string(), "FOLDER"))
            .unwrap();
    }
    insta::assert_snapshot!(all);
}

#[test]
fn any_file() {
    let folder = Folder::new();
    std::fs::create_dir(folder.file("folder.toml")).unwrap();
    folder.write("latin1.toml", b"# caf\xe9\n");
    folder.write("words.txt", "");
    folder.write("none", "");
    let mut all = String::new();
    for name in ["absent.toml", "absent.obj", "folder.toml", "latin1.toml", "words.txt", "none"] {
        let error = load(&folder.file(name)).unwrap_err().to_string();
        writeln!(all, "{}", error.replace(&format!("{}/", folder.path().display()), "")).unwrap();
    }
    insta::assert_snapshot!(all);
}

/// Where a file is cut, or a byte of it changed, there is a scene or a message, and never a panic.
#[test]
fn damaged_files_end_in_a_scene_or_a_message() {
    let toml = crate::support::specification_example().into_bytes();
    let nff = b"b 0.1 0.2 0.3\nv\nfrom 1 2 3\nat 0 0 0\nup 0 0 1\nangle 30\nhither 1\nresolution 64 48\nl 1 1 1\nf 1 0.5 0.25 0.8 0.4 10 0.1 1\ns 0 0 0 1\npp 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n".to_vec();
    let obj =
        b"mtllib a.mtl\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 1 0\nvn 0 0 1\nusemtl m\nf 1//1 2//1 3//-1 4//1\n"
            .to_vec();
    let mtl = b"newmtl m\nKa 1 1 1\nKd 0.5\nKs 1 1 1\nNs 10\nNi 1.5\nTf 1 1 1\nillum 7\nd 1\n".to_vec();
    let ply = b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n".to_vec();
    let folder = Folder::new();
    folder.write("b.obj", &obj);
    folder.write("bunny.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    for (damaged, entry, content) in [
        ("a.toml", "a.toml", toml),
        ("a.nff", "a.nff", nff),
        ("a.obj", "a.obj", obj),
        ("a.mtl", "b.obj", mtl.clone()),
        ("a.ply", "a.ply", ply),
    ] {
        folder.write("a.mtl", &mtl);
        for position in 0..content.len() {
            folder.write(damaged, &content[..position]);
            let _ = load(&folder.file(entry));
            // A fixed sequence of bytes, some of them likely to matter.
            let byte =
                [0, b'-', b'9', b'e', b' ', b'\n', b'"', b'[', 0xff][(position * 7 + content.len()) % 9];
            let mut changed = content.clone();
            changed[position] = byte;
            folder.write(damaged, &changed);
            let _ = load(&folder.file(entry));
        }
    }
}
