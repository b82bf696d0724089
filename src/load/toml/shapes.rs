//! `[[sphere]]`, `[[triangle]]`, `[[polygon]]` and `[[mesh]]`, which get their ids in this order.

use super::material::Materials;
use super::reader::{Table, Value};
use crate::load::error::{InputError, Warnings};
use crate::load::mesh::{MaterialChoice, MeshFormat, Transform};
use crate::scene::Geometry;
use glam::{DVec3, Vec3};

pub(super) fn read(
    root: &Table<'_>,
    materials: &mut Materials,
    warnings: &mut Warnings,
) -> Result<Geometry, InputError> {
    let mut geometry = Geometry::default();
    for table in tables(root, "sphere", "[[sphere]]", &["center", "radius", "material"])? {
        sphere(&table, materials, &mut geometry)?;
    }
    for table in tables(root, "triangle", "[[triangle]]", &["vertices", "material"])? {
        triangle(&table, materials, &mut geometry, warnings)?;
    }
    for table in tables(root, "polygon", "[[polygon]]", &["vertices", "material"])? {
        polygon(&table, materials, &mut geometry, warnings)?;
    }
    for table in tables(root, "mesh", "[[mesh]]", &["file", "material", "translate", "rotate", "scale"])? {
        mesh(&table, materials, &mut geometry, warnings)?;
    }
    Ok(geometry)
}

fn tables<'a>(
    root: &Table<'a>,
    key: &str,
    name: &'a str,
    keys: &[&str],
) -> Result<Vec<Table<'a>>, InputError> {
    root.get(key).map_or(Ok(Vec::new()), |value| value.tables(name, keys))
}

fn sphere(table: &Table<'_>, materials: &Materials, geometry: &mut Geometry) -> Result<(), InputError> {
    let center = table.require("center")?.vector()?;
    let radius = table.require("radius")?;
    let material = materials.named(&table.require("material")?)?;
    let added = geometry.add_sphere(center, radius.float()?, material);
    added.map_err(|problem| radius.error(problem.to_string()))
}

fn triangle(
    table: &Table<'_>,
    materials: &Materials,
    geometry: &mut Geometry,
    warnings: &mut Warnings,
) -> Result<(), InputError> {
    let value = table.require("vertices")?;
    let vertices = vertices(&value)?;
    if vertices.len() != 3 {
        return Err(value.error(format!("a triangle has 3 vertices; this one has {}", vertices.len())));
    }
    let material = materials.named(&table.require("material")?)?;
    let added = geometry
        .add_vertices(vertices)
        .and_then(|first| geometry.add_triangle([first, first + 1, first + 2], None, material));
    table.text().added(table.offset(), added, warnings)
}

fn polygon(
    table: &Table<'_>,
    materials: &Materials,
    geometry: &mut Geometry,
    warnings: &mut Warnings,
) -> Result<(), InputError> {
    let value = table.require("vertices")?;
    let vertices = vertices(&value)?;
    let material = materials.named(&table.require("material")?)?;
    table.text().added(value.offset(), geometry.add_polygon(&vertices, None, material), warnings)
}

fn vertices(value: &Value<'_>) -> Result<Vec<Vec3>, InputError> {
    value.list("a list of vertices, [[x, y, z], …]")?.iter().map(Value::vector).collect()
}

fn mesh(
    table: &Table<'_>,
    materials: &mut Materials,
    geometry: &mut Geometry,
    warnings: &mut Warnings,
) -> Result<(), InputError> {
    let vector = |key: &str| table.get(key).map_or(Ok(DVec3::ZERO), |value| value.numbers().map(DVec3::from));
    let scale = match table.get("scale") {
        None => 1.0,
        Some(value) => match value.number()? {
            0.0 => {
                return Err(
                    value.error("`scale` is 0, which leaves nothing of the mesh; give another number")
                );
            }
            scale => scale,
        },
    };
    let transform = Transform::new(scale, vector("rotate")?, vector("translate")?);
    let file = table.require("file")?;
    let name = file.string()?;
    let path = table.text().path.with_file_name(name);
    let material = match table.get("material") {
        None => None,
        Some(value) => Some(materials.named(&value)?),
    };
    let format = MeshFormat::of(&path)
        .ok_or_else(|| file.error(format!("a mesh file ends in .obj or .ply; \"{name}\" does not")))?;
    if let Err(why) = std::fs::metadata(&path) {
        return Err(file.error(format!(
            "the mesh \"{name}\" cannot be opened: {why}; its name is taken relative to the folder of this file"
        )));
    }
    let mut mesh = format.read(&path, material.is_none(), warnings)?;
    let choice = match material {
        Some(material) => MaterialChoice::Given(material),
        None if mesh.materials.is_empty() => {
            return Err(table.error(format!(
                "\"{name}\" brings no materials of its own; add a key `material` to this [[mesh]]"
            )));
        }
        None => {
            let first = materials.append(std::mem::take(&mut mesh.materials));
            MaterialChoice::Own { first, otherwise: None }
        }
    };
    mesh.add_to(geometry, &transform, choice, warnings)
}
