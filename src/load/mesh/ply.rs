//! PLY, ascii and binary, read by `ply-rs-bw`.

use super::Mesh;
use crate::load::error::{InputError, Place};
use crate::load::number;
use crate::load::text::read_bytes;
use crate::scene::widened;
use glam::DVec3;
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{ElementDef, Property, PropertyAccess, PropertyAccessResult, PropertyType};
use std::path::Path;

pub(super) fn read(path: &Path) -> Result<Mesh, InputError> {
    let bytes = read_bytes(path)?;
    let mut reader = Reader::new(bytes.as_slice());
    let header = Parser::<Ignored>::new().read_header(&mut reader).map_err(|error| refused(path, &error))?;
    let mut vertices = Vec::new();
    let mut faces = Vec::new();
    for (name, element) in &header.elements {
        check_element(path, name, element)?;
        let failed = |error| refused(path, &error);
        match name.as_str() {
            "vertex" => {
                vertices = Parser::<Vertex>::new()
                    .read_payload_for_element(&mut reader, element, &header)
                    .map_err(failed)?;
            }
            "face" => {
                faces = Parser::<Face>::new()
                    .read_payload_for_element(&mut reader, element, &header)
                    .map_err(failed)?;
            }
            _ => {
                let parser = Parser::<Ignored>::new();
                parser.read_payload_for_element(&mut reader, element, &header).map_err(failed)?;
            }
        }
    }
    let has_normals = header
        .elements
        .get("vertex")
        .is_some_and(|vertex| ["nx", "ny", "nz"].iter().all(|name| vertex.properties.contains_key(*name)));
    if faces.is_empty() {
        return Err(InputError::refused(
            path,
            Place::File,
            "the file has no faces, so there is nothing to see",
        ));
    }
    mesh(path, vertices, &faces, has_normals)
}

fn mesh(path: &Path, vertices: Vec<Vertex>, faces: &[Face], has_normals: bool) -> Result<Mesh, InputError> {
    let mut mesh = Mesh::new(path);
    for (index, vertex) in vertices.into_iter().enumerate() {
        let numbers = vertex.position.iter().chain(&vertex.normal);
        numbers.copied().try_for_each(|value| number::check(value).map(drop)).map_err(|message| {
            InputError::refused(path, Place::Element(format!("vertex {}", index + 1)), message)
        })?;
        mesh.bounds = widened(mesh.bounds, DVec3::from(vertex.position));
        mesh.positions.push(DVec3::from(vertex.position));
        if has_normals {
            mesh.normals.push(DVec3::from(vertex.normal));
        }
    }
    let count = mesh.positions.len();
    let mut corners = Vec::new();
    for (index, face) in faces.iter().enumerate() {
        let error =
            |message| InputError::refused(path, Place::Element(format!("face {}", index + 1)), message);
        if face.corners.len() < 3 {
            return Err(error(format!(
                "a face needs at least 3 corners; this one has {}",
                face.corners.len()
            )));
        }
        let corner = |&corner: &i64| match u32::try_from(corner) {
            Ok(index) if (index as usize) < count => Ok(index),
            _ => Err(error(format!(
                "vertex {corner} is out of range; the file has {count} vertices, counted from 0"
            ))),
        };
        corners.clear();
        for index in face.corners.iter().map(corner) {
            corners.push(index?);
        }
        mesh.add_face(&corners, has_normals.then_some(&corners), None);
    }
    Ok(mesh)
}

/// Refuses a header that lacks what a mesh needs, before any of its data is read.
fn check_element(path: &Path, name: &str, element: &ElementDef) -> Result<(), InputError> {
    let refused = |message: String| Err(InputError::refused(path, Place::File, message));
    let is_list = |property: &str| {
        element.properties.get(property).map(|def| matches!(def.data_type, PropertyType::List(..)))
    };
    match name {
        "vertex" => match ["x", "y", "z"].into_iter().find(|name| is_list(name) != Some(false)) {
            Some(missing) => refused(format!("the header gives vertices no number `{missing}`")),
            None => Ok(()),
        },
        "face" => match INDEX_NAMES.into_iter().find(|name| is_list(name) == Some(true)) {
            None => refused("the header gives faces no list `vertex_indices`".to_owned()),
            Some(_) => Ok(()),
        },
        "tristrips" => {
            refused("triangle strips (`tristrips`) cannot be read; write the mesh as faces".to_owned())
        }
        _ => Ok(()),
    }
}

const INDEX_NAMES: [&str; 2] = ["vertex_indices", "vertex_index"];

fn refused(path: &Path, error: &ParseError) -> InputError {
    // The library's messages go on over several lines, repeat what they read and name states of its grammar.
    let whole = error.to_string();
    let mut message = whole.lines().next().unwrap_or_default().trim_end_matches('.').to_owned();
    for (theirs, ours) in [
        ("Couldn't read element line", "this line does not hold the numbers that the header announces"),
        ("Couldn't parse line", "this line is no line of a PLY header"),
    ] {
        if message.contains(theirs) {
            message = ours.to_owned();
        }
    }
    let place = match error.line() {
        Some(line) => {
            message = message.replacen(&format!("Line {line}: "), "", 1);
            Place::At { line, column: 1 }
        }
        None => Place::File,
    };
    InputError::refused(path, place, format!("this is not a PLY file that can be read: {message}"))
}

#[derive(Default)]
struct Vertex {
    position: [f64; 3],
    normal: [f64; 3],
}

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let slot = match name {
            "x" => &mut self.position[0],
            "y" => &mut self.position[1],
            "z" => &mut self.position[2],
            "nx" => &mut self.normal[0],
            "ny" => &mut self.normal[1],
            "nz" => &mut self.normal[2],
            _ => return PropertyAccessResult::Ignored,
        };
        let value = match property {
            Property::Float(value) => f64::from(value),
            Property::Double(value) => value,
            Property::Char(value) => f64::from(value),
            Property::UChar(value) => f64::from(value),
            Property::Short(value) => f64::from(value),
            Property::UShort(value) => f64::from(value),
            Property::Int(value) => f64::from(value),
            Property::UInt(value) => f64::from(value),
            _ => return PropertyAccessResult::UnsupportedType,
        };
        *slot = value;
        PropertyAccessResult::Set
    }
}

#[derive(Default)]
struct Face {
    corners: Vec<i64>,
}

impl PropertyAccess for Face {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if !INDEX_NAMES.contains(&name) {
            return PropertyAccessResult::Ignored;
        }
        self.corners = match property {
            Property::ListChar(list) => list.into_iter().map(i64::from).collect(),
            Property::ListUChar(list) => list.into_iter().map(i64::from).collect(),
            Property::ListShort(list) => list.into_iter().map(i64::from).collect(),
            Property::ListUShort(list) => list.into_iter().map(i64::from).collect(),
            Property::ListInt(list) => list.into_iter().map(i64::from).collect(),
            Property::ListUInt(list) => list.into_iter().map(i64::from).collect(),
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

/// An element that is read past.
struct Ignored;

impl PropertyAccess for Ignored {
    fn new() -> Self {
        Self
    }
}
