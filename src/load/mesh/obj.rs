//! Wavefront OBJ: vertices, normals, faces, and which material they are made of.

use super::Mesh;
use super::lines::{LogicalLine, LogicalLines};
use super::mtl::{self, Library};
use crate::load::error::{InputError, Place, Warnings};
use crate::load::number;
use crate::load::suggest::did_you_mean;
use crate::load::text::Text;
use crate::scene::widened;
use glam::DVec3;
use std::path::Path;

pub(super) fn read(path: &Path, wants_materials: bool, warnings: &mut Warnings) -> Result<Mesh, InputError> {
    let text = Text::read_lossy(path)?;
    let mut reader = Reader {
        text: &text,
        wants_materials,
        warnings,
        mesh: Mesh::new(path),
        library: Library::default(),
        material: None,
        corners: Vec::new(),
        normals: Vec::new(),
        ahead: Vec::new(),
    };
    let mut lines = LogicalLines::new(&text.content);
    while let Some(line) = lines.next() {
        reader.line(line)?;
    }
    reader.check_ahead()?;
    if reader.mesh.face_count() == 0 {
        let message = "the file has no faces (`f`), so there is nothing to see";
        return Err(InputError::refused(path, Place::File, message));
    }
    reader.mesh.materials = reader.library.into_materials();
    Ok(reader.mesh)
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

fn out_of_range(element: Element, index: i64, count: usize) -> String {
    let (one, many) = match element {
        Element::Vertex => ("vertex", "vertices"),
        Element::Normal => ("normal", "normals"),
    };
    match index {
        0 => format!("{one} 0 is out of range; indices count from 1"),
        _ => format!("{one} {index} is out of range; there are {count} {many}"),
    }
}

struct Reader<'a> {
    text: &'a Text,
    wants_materials: bool,
    warnings: &'a mut Warnings,
    mesh: Mesh,
    library: Library,
    /// The latest `usemtl`.
    material: Option<u32>,
    /// Vertices of the face being read, counted from 0.
    corners: Vec<u32>,
    /// Its normals, as many where each of its corners has one.
    normals: Vec<u32>,
    /// Corners that refer to lines still to come.
    ahead: Vec<Ahead>,
}

impl Reader<'_> {
    fn line(&mut self, line: &LogicalLine<'_>) -> Result<(), InputError> {
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
                let [x, y, z, w, ..] = self.numbers(arguments)?;
                // Only as the fourth and last number it is a weight.
                let weight = if arguments.len() == 4 { w } else { 1.0 };
                if weight == 0.0 {
                    return Err(self.text.error(arguments[3].1, "the weight w of a vertex must not be 0"));
                }
                let position = DVec3::new(x, y, z) / weight;
                for coordinate in position.to_array() {
                    number::check(coordinate).map_err(error)?;
                }
                self.mesh.bounds = widened(self.mesh.bounds, position);
                self.mesh.positions.push(position);
            }
            "vn" => {
                if arguments.len() != 3 {
                    return Err(error(format!(
                        "a normal (`vn`) has three numbers; this one has {}",
                        arguments.len()
                    )));
                }
                let [x, y, z, ..] = self.numbers(arguments)?;
                self.mesh.normals.push(DVec3::new(x, y, z));
            }
            "f" => self.face(offset, arguments)?,
            "mtllib" if self.wants_materials => self.library(line, offset)?,
            "usemtl" if self.wants_materials => {
                let name = line.rest(&self.text.content);
                self.material = self.library.index(name);
                if self.material.is_none() {
                    let meant = did_you_mean(name, self.library.names());
                    let name = number::shortened(name);
                    return Err(error(format!(
                        "unknown material `{name}`; no material library (`mtllib`) before this line has it{meant}"
                    )));
                }
            }
            // Texture coordinates, names of objects and groups, smoothing and the choice of materials made elsewhere.
            "vt" | "vp" | "o" | "g" | "s" | "mg" | "maplib" | "usemap" | "mtllib" | "usemtl" | "bevel"
            | "c_interp" | "d_interp" | "lod" | "shadow_obj" | "trace_obj" => {}
            "l" | "p" | "cstype" | "deg" | "bmat" | "step" | "curv" | "curv2" | "surf" | "parm" | "trim"
            | "hole" | "scrv" | "sp" | "end" | "con" | "ctech" | "stech" | "call" | "csh" => {
                self.text.warn(self.warnings, keyword, offset, || {
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

    /// The numbers of a line, no more than a vertex may have; 0 for those that it lacks.
    fn numbers(&self, words: &[(&str, usize)]) -> Result<[f64; 7], InputError> {
        let mut numbers = [0.0; 7];
        for (number, &(word, offset)) in numbers.iter_mut().zip(words) {
            *number = number::parse(word).map_err(|message| self.text.error(offset, message))?;
        }
        Ok(numbers)
    }

    fn face(&mut self, offset: usize, corners: &[(&str, usize)]) -> Result<(), InputError> {
        if corners.len() < 3 {
            let message = format!("a face needs at least 3 corners; this one has {}", corners.len());
            return Err(self.text.error(offset, message));
        }
        self.corners.clear();
        self.normals.clear();
        for &(word, offset) in corners {
            self.corner(word, offset)?;
        }
        let have_normals = self.normals.len() == self.corners.len();
        self.mesh.add_face(&self.corners, have_normals.then_some(&self.normals), self.material);
        Ok(())
    }

    /// A corner `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    fn corner(&mut self, word: &str, offset: usize) -> Result<(), InputError> {
        let mut parts = word.split('/');
        let vertex = parts.next().unwrap_or_default();
        let normal = parts.nth(1).filter(|normal| !normal.is_empty());
        let Some(vertex) = vertex.parse().ok().filter(|_| parts.next().is_none()) else {
            return Err(self.malformed(word, offset));
        };
        let vertex = self.index(vertex, Element::Vertex, offset)?;
        self.corners.push(vertex);
        if let Some(normal) = normal {
            let Ok(normal) = normal.parse() else { return Err(self.malformed(word, offset)) };
            let normal = self.index(normal, Element::Normal, offset)?;
            self.normals.push(normal);
        }
        Ok(())
    }

    /// What an index means, counted from 0.
    fn index(&mut self, index: i64, element: Element, offset: usize) -> Result<u32, InputError> {
        let count = self.count(element);
        let face = self.mesh.face_count() + 1;
        // Negative indices count back from the latest element.
        let from_0 = match index {
            1.. => usize::try_from(index - 1).ok(),
            _ => usize::try_from(index.unsigned_abs())
                .ok()
                .filter(|&back| back > 0)
                .and_then(|back| count.checked_sub(back)),
        };
        let Some(from_0) = from_0 else {
            let message = out_of_range(element, index, count);
            return Err(self.text.error(offset, format!("face {face}: {message}")));
        };
        if from_0 >= count {
            self.ahead.push(Ahead { offset, face, element, index });
        }
        // More vertices than 32 bits count are refused when they are put into the scene.
        Ok(u32::try_from(from_0).unwrap_or(u32::MAX))
    }

    fn malformed(&self, word: &str, offset: usize) -> InputError {
        let face = self.mesh.face_count() + 1;
        let word = number::shortened(word);
        let message = format!("face {face}: expected a corner like 3, 3/1, 3//2 or 3/1/2, found `{word}`");
        self.text.error(offset, message)
    }

    fn count(&self, element: Element) -> usize {
        match element {
            Element::Vertex => self.mesh.positions.len(),
            Element::Normal => self.mesh.normals.len(),
        }
    }

    /// Refuses the first corner whose vertex or normal never came.
    fn check_ahead(&self) -> Result<(), InputError> {
        let is_missing = |ahead: &&Ahead| {
            usize::try_from(ahead.index).is_ok_and(|index| index > self.count(ahead.element))
        };
        self.ahead.iter().find(is_missing).map_or(Ok(()), |&Ahead { offset, face, element, index }| {
            let message = out_of_range(element, index, self.count(element));
            Err(self.text.error(offset, format!("face {face}: {message}")))
        })
    }

    fn library(&mut self, line: &LogicalLine<'_>, offset: usize) -> Result<(), InputError> {
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
            mtl::read(&path, &mut self.library, self.warnings)?;
        }
        Ok(())
    }
}
