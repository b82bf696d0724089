//! The pass over an OBJ file that finds what the library would trip over.
//!
//! The library says neither where nor what it trips over, makes normals up for corners without one, panics on some short
//! lines and knows no continued lines. So this pass walks the logical lines, refuses what is wrong with its place, and
//! hands on plain lines only: all vertices and normals, then faces of `v` or `v//vn` and material names.

use super::lines::{LogicalLine, logical_lines};
use super::mtl::{self, Library};
use crate::load::error::{InputError, Warnings};
use crate::load::number;
use crate::load::suggest::did_you_mean;
use crate::load::text::Text;
use crate::scene::widened;
use glam::DVec3;

/// What the library gets to read, and what it would not say.
pub(super) struct Checked {
    /// Without material libraries, which have been read into `library`.
    pub(super) lines: String,
    pub(super) library: Library,
    /// Whether each face names a normal at each of its corners.
    pub(super) faces_have_normals: Vec<bool>,
    /// Of all vertices, used or not.
    pub(super) bounds: Option<(DVec3, DVec3)>,
}

pub(super) fn check(
    text: &Text,
    wants_materials: bool,
    warnings: &mut Warnings,
) -> Result<Checked, InputError> {
    let mut pass = Pass {
        text,
        wants_materials,
        library: Library::default(),
        bounds: None,
        vertex_lines: String::new(),
        face_lines: String::new(),
        vertices: 0,
        normals: 0,
        faces_have_normals: Vec::new(),
        ahead: Vec::new(),
    };
    for line in logical_lines(&text.content) {
        pass.add(&line, warnings)?;
    }
    pass.check_ahead()?;
    Ok(Checked {
        lines: pass.vertex_lines + &pass.face_lines,
        library: pass.library,
        faces_have_normals: pass.faces_have_normals,
        bounds: pass.bounds,
    })
}

/// A corner that refers to a vertex or normal which the file does not have yet.
struct Ahead {
    offset: usize,
    face: usize,
    element: Element,
    index: i64,
}

#[derive(Clone, Copy)]
enum Element {
    Vertex,
    Normal,
}

fn out_of_range(element: Element, index: i64, count: i64) -> String {
    let (one, many) = match element {
        Element::Vertex => ("vertex", "vertices"),
        Element::Normal => ("normal", "normals"),
    };
    match index {
        0 => format!("{one} 0 is out of range; indices count from 1"),
        _ => format!("{one} {index} is out of range; there are {count} {many}"),
    }
}

/// The pass under way.
struct Pass<'a> {
    text: &'a Text,
    wants_materials: bool,
    library: Library,
    bounds: Option<(DVec3, DVec3)>,
    vertex_lines: String,
    face_lines: String,
    vertices: i64,
    normals: i64,
    faces_have_normals: Vec<bool>,
    /// Corners that refer to lines still to come.
    ahead: Vec<Ahead>,
}

impl Pass<'_> {
    fn add(&mut self, line: &LogicalLine<'_>, warnings: &mut Warnings) -> Result<(), InputError> {
        let Some((&(keyword, offset), arguments)) = line.words.split_first() else { return Ok(()) };
        let error = |message: String| self.text.error(offset, message);
        match keyword {
            "v" => {
                // After x, y, z a file may have w, or a colour.
                if !matches!(arguments.len(), 3 | 4 | 6 | 7) {
                    let message =
                        format!("a vertex (`v`) has three coordinates; this one has {}", arguments.len());
                    return Err(error(message));
                }
                // Of these only the weight w has a say in where the vertex is.
                let kept = if arguments.len() == 4 { 4 } else { 3 };
                let numbers = self.numbers("v", arguments, kept)?;
                let weight = if kept == 4 { numbers[3] } else { 1.0 };
                if weight == 0.0 {
                    return Err(self.text.error(arguments[3].1, "the weight w of a vertex must not be 0"));
                }
                let position = DVec3::from_slice(&numbers) / weight;
                for coordinate in position.to_array() {
                    number::check(coordinate).map_err(error)?;
                }
                self.bounds = widened(self.bounds, position);
                self.vertices += 1;
            }
            "vn" => {
                if arguments.len() != 3 {
                    return Err(error(format!(
                        "a normal (`vn`) has three numbers; this one has {}",
                        arguments.len()
                    )));
                }
                self.numbers("vn", arguments, 3)?;
                self.normals += 1;
            }
            "f" => self.face(offset, arguments)?,
            "mtllib" if self.wants_materials => self.library(line, offset, warnings)?,
            "usemtl" if self.wants_materials => {
                let name = line.rest(&self.text.content);
                if !self.library.has(name) {
                    let meant = did_you_mean(name, self.library.names());
                    let name = number::shortened(name);
                    return Err(error(format!(
                        "unknown material `{name}`; no material library (`mtllib`) before this line has it{meant}"
                    )));
                }
                self.face_lines += &format!("usemtl {name}\n");
            }
            // Texture coordinates, names of objects and groups, smoothing and the choice of materials made elsewhere.
            "vt" | "vp" | "o" | "g" | "s" | "mg" | "maplib" | "usemap" | "mtllib" | "usemtl" | "bevel"
            | "c_interp" | "d_interp" | "lod" | "shadow_obj" | "trace_obj" => {}
            "l" | "p" | "cstype" | "deg" | "bmat" | "step" | "curv" | "curv2" | "surf" | "parm" | "trim"
            | "hole" | "scrv" | "sp" | "end" | "con" | "ctech" | "stech" | "call" | "csh" => {
                self.text.warn(warnings, keyword, offset, || {
                    format!("`{keyword}` is not modelled and left out; only faces (`f`) are shown")
                });
            }
            other => {
                let known = ["v", "vn", "vt", "f", "mtllib", "usemtl", "o", "g", "s"];
                let meant = did_you_mean(other, known);
                return Err(error(format!("unknown keyword `{}`{meant}", number::shortened(other))));
            }
        }
        Ok(())
    }

    /// Checks numbers and hands on the first of them.
    fn numbers(
        &mut self,
        keyword: &str,
        words: &[(&str, usize)],
        kept: usize,
    ) -> Result<Vec<f64>, InputError> {
        let number = |&(word, offset): &(&str, usize)| {
            number::parse(word).map_err(|message| self.text.error(offset, message))
        };
        let numbers = words.iter().map(number).collect::<Result<Vec<f64>, _>>()?;
        let kept: Vec<&str> = words.iter().take(kept).map(|(word, _)| *word).collect();
        self.vertex_lines += &format!("{keyword} {}\n", kept.join(" "));
        Ok(numbers)
    }

    fn face(&mut self, offset: usize, corners: &[(&str, usize)]) -> Result<(), InputError> {
        if corners.len() < 3 {
            let message = format!("a face needs at least 3 corners; this one has {}", corners.len());
            return Err(self.text.error(offset, message));
        }
        let corners: Vec<(i64, Option<i64>)> =
            corners.iter().map(|&(word, offset)| self.corner(word, offset)).collect::<Result<_, _>>()?;
        let have_normals = corners.iter().all(|(_, normal)| normal.is_some());
        let mut line = "f".to_owned();
        for (vertex, normal) in corners {
            match normal.filter(|_| have_normals) {
                Some(normal) => line += &format!(" {vertex}//{normal}"),
                None => line += &format!(" {vertex}"),
            }
        }
        self.face_lines += &line;
        self.face_lines += "\n";
        self.faces_have_normals.push(have_normals);
        Ok(())
    }

    fn count(&self, element: Element) -> i64 {
        match element {
            Element::Vertex => self.vertices,
            Element::Normal => self.normals,
        }
    }

    /// Refuses the first corner whose vertex or normal never came.
    fn check_ahead(&self) -> Result<(), InputError> {
        let missing = self.ahead.iter().find(|ahead| ahead.index > self.count(ahead.element));
        missing.map_or(Ok(()), |&Ahead { offset, face, element, index }| {
            let message = out_of_range(element, index, self.count(element));
            Err(self.text.error(offset, format!("face {face}: {message}")))
        })
    }

    /// Vertex and normal of a corner `v`, `v/vt`, `v//vn` or `v/vt/vn`, counted from 1.
    fn corner(&mut self, word: &str, offset: usize) -> Result<(i64, Option<i64>), InputError> {
        let face = self.faces_have_normals.len() + 1;
        let text = self.text;
        let error = |message: String| text.error(offset, format!("face {face}: {message}"));
        let malformed = || {
            error(format!(
                "expected a corner like 3, 3/1, 3//2 or 3/1/2, found `{}`",
                number::shortened(word)
            ))
        };
        let parts: Vec<&str> = word.split('/').collect();
        let (vertex, normal) = match *parts.as_slice() {
            [vertex] | [vertex, _] | [vertex, _, ""] => (vertex, None),
            [vertex, _, normal] => (vertex, Some(normal)),
            _ => return Err(malformed()),
        };
        let mut index = |word: &str, element: Element| {
            let index: i64 = word.parse().map_err(|_| malformed())?;
            let count = self.count(element);
            // Negative indices count back from the latest element.
            let from_1 = if index < 0 { count + 1 + index } else { index };
            if from_1 < 1 {
                return Err(error(out_of_range(element, index, count)));
            }
            if from_1 > count {
                self.ahead.push(Ahead { offset, face, element, index });
            }
            Ok(from_1)
        };
        let vertex = index(vertex, Element::Vertex)?;
        let normal = normal.map(|normal| index(normal, Element::Normal)).transpose()?;
        Ok((vertex, normal))
    }

    fn library(
        &mut self,
        line: &LogicalLine<'_>,
        offset: usize,
        warnings: &mut Warnings,
    ) -> Result<(), InputError> {
        let name = line.rest(&self.text.content);
        if name.is_empty() {
            return Err(self.text.error(offset, "`mtllib` needs the name of a material library"));
        }
        // One name with spaces, or several names.
        let whole = self.text.path.with_file_name(name);
        let names = if whole.is_file() { vec![name] } else { name.split_whitespace().collect() };
        for name in names {
            let path = self.text.path.with_file_name(name);
            if let Err(why) = std::fs::metadata(&path) {
                return Err(self.text.error(
                    offset,
                    format!(
                        "the material library `{name}` cannot be opened: {why}; its name is taken relative to the \
                         folder of this file"
                    ),
                ));
            }
            mtl::read(&path, &mut self.library, warnings)?;
        }
        Ok(())
    }
}
