//! `[material.NAME]`.

use super::reader::{Table, Value};
use crate::load::error::{InputError, Warnings};
use crate::load::number::shortened;
use crate::load::suggest::did_you_mean;
use crate::scene::{Dielectric, Fresnel, Material, MaterialId, Rgb};
use std::collections::BTreeMap;

const KEYS: [&str; 10] = [
    "ambient",
    "diffuse",
    "specular",
    "shininess",
    "mirror",
    "ior",
    "absorption",
    "transmission",
    "fresnel",
    "casts_shadow",
];

/// Materials and the names that shapes call them by.
#[derive(Default)]
pub(super) struct Materials {
    pub(super) list: Vec<Material>,
    by_name: BTreeMap<String, MaterialId>,
}

impl Materials {
    /// The material that a value names.
    pub(super) fn named(&self, value: &Value<'_>) -> Result<MaterialId, InputError> {
        let name = value.string()?;
        match self.by_name.get(name) {
            Some(&id) => Ok(id),
            None => {
                let meant = did_you_mean(name, self.by_name.keys().map(String::as_str));
                let name = shortened(name);
                Err(value.error(format!(
                    "unknown material \"{name}\"; no [material.{name}] is in this file{meant}"
                )))
            }
        }
    }

    /// Adds materials that have no name here, and returns the id of the first.
    pub(super) fn append(&mut self, more: Vec<Material>) -> MaterialId {
        let first = material_id(self.list.len());
        self.list.extend(more);
        first
    }
}

fn material_id(index: usize) -> MaterialId {
    MaterialId(u32::try_from(index).unwrap_or(u32::MAX))
}

pub(super) fn read(root: &Table<'_>, warnings: &mut Warnings) -> Result<Materials, InputError> {
    let mut materials = Materials::default();
    let Some(value) = root.get("material") else { return Ok(materials) };
    for entry in value.any_table("[material.NAME]")?.entries() {
        let id = material_id(materials.list.len());
        materials.list.push(material(&entry.table("[material.NAME]", &KEYS)?, warnings)?);
        materials.by_name.insert(entry.key().to_owned(), id);
    }
    Ok(materials)
}

fn material(table: &Table<'_>, warnings: &mut Warnings) -> Result<Material, InputError> {
    let coefficient =
        |key: &str, default: f32| table.get(key).map_or(Ok(Rgb::splat(default)), |value| value.coefficient());
    let boolean = |key: &str| table.get(key).map_or(Ok(true), |value| value.boolean());
    let shininess = table.get("shininess").map_or(Ok(1.0), |value| value.not_negative())?;
    let (absorption, transmission) = (coefficient("absorption", 0.0)?, coefficient("transmission", 1.0)?);
    let fresnel = if boolean("fresnel")? { Fresnel::Schlick } else { Fresnel::Fixed };
    let dielectric = match table.get("ior") {
        Some(value) => {
            let ior = value.float()?;
            if ior <= 0.0 {
                return Err(value.error(format!("`ior` is {ior}; it must be greater than 0")));
            }
            Some(Dielectric { ior, absorption, transmission, fresnel })
        }
        None => None,
    };
    if dielectric.is_none() {
        for value in ["absorption", "transmission", "fresnel"].into_iter().filter_map(|key| table.get(key)) {
            let message =
                format!("`{}` has no effect without `ior`, which makes a material transparent", value.key());
            value.warn(warnings, &message);
        }
    }
    Ok(Material {
        ambient: coefficient("ambient", 0.0)?,
        diffuse: coefficient("diffuse", 0.0)?,
        specular: coefficient("specular", 0.0)?,
        shininess,
        mirror: coefficient("mirror", 0.0)?,
        dielectric,
        casts_shadow: boolean("casts_shadow")?,
    })
}
