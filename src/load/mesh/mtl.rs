//! MTL material libraries.

use super::lines::{LogicalLine, LogicalLines};
use crate::load::error::{InputError, Place, Warnings};
use crate::load::number::{self, rounded, rounded_3};
use crate::load::text::Text;
use crate::scene::{Dielectric, Fresnel, Material, Rgb};
use glam::DVec3;
use std::collections::HashMap;
use std::path::Path;

/// The materials of all libraries that an OBJ file names.
#[derive(Default)]
pub(super) struct Library {
    materials: Vec<Material>,
    /// A later material of the same name takes its place.
    by_name: HashMap<String, u32>,
}

impl Library {
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.by_name.keys().map(String::as_str)
    }

    /// The place of a material among all of them.
    pub(super) fn index(&self, name: &str) -> Option<u32> {
        self.by_name.get(name).copied()
    }

    pub(super) fn into_materials(self) -> Vec<Material> {
        self.materials
    }
}

/// A material as its lines say.
struct Definition {
    name: String,
    /// Ka, Kd and Ks.
    ambient: DVec3,
    diffuse: DVec3,
    specular: DVec3,
    /// Tf.
    filter: DVec3,
    /// Ns.
    shininess: f64,
    /// Ni.
    ior: f64,
    illum: u8,
}

impl Definition {
    fn new(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            ambient: DVec3::ZERO,
            diffuse: DVec3::ZERO,
            specular: DVec3::ZERO,
            filter: DVec3::ONE,
            shininess: 1.0,
            ior: 1.0,
            illum: 2,
        }
    }
}

/// Adds the materials of a file.
pub(super) fn read(path: &Path, library: &mut Library, warnings: &mut Warnings) -> Result<(), InputError> {
    let text = Text::read_lossy(path)?;
    let mut definitions: Vec<Definition> = Vec::new();
    let mut lines = LogicalLines::new(&text.content);
    while let Some(line) = lines.next() {
        let Some(&(keyword, offset)) = line.words.first() else { continue };
        if keyword == "newmtl" {
            if line.words.len() < 2 {
                return Err(text.error(offset, "`newmtl` needs the name of a material"));
            }
            definitions.push(Definition::new(line.rest(&text.content)));
        } else if let Some(definition) = definitions.last_mut() {
            define(definition, &text, line, warnings)?;
        } else {
            let keyword = number::shortened(keyword);
            return Err(text.error(offset, format!("`{keyword}` stands before the first `newmtl`")));
        }
    }
    for definition in definitions {
        let index = u32::try_from(library.materials.len()).unwrap_or(u32::MAX);
        library.materials.push(modelled(&definition, path, warnings));
        library.by_name.insert(definition.name, index);
    }
    Ok(())
}

/// Takes in a line, or says what is not modelled.
fn define(
    definition: &mut Definition,
    text: &Text,
    line: &LogicalLine<'_>,
    warnings: &mut Warnings,
) -> Result<(), InputError> {
    let Some((&(keyword, offset), arguments)) = line.words.split_first() else { return Ok(()) };
    let not_negative = |&(word, offset): &(&str, usize)| match number::parse(word) {
        Err(message) => Err(text.error(offset, format!("{keyword}: {message}"))),
        Ok(value) if value < 0.0 => {
            Err(text.error(offset, format!("{keyword} is {value}; it must not be negative")))
        }
        Ok(value) => Ok(value),
    };
    let color = || match arguments {
        // One number stands for grey.
        [grey] => Ok(DVec3::splat(not_negative(grey)?)),
        [r, g, b] => Ok(DVec3::new(not_negative(r)?, not_negative(g)?, not_negative(b)?)),
        _ => {
            let count = arguments.len();
            let message = format!("{keyword} needs r g b, or one number for grey; this line has {count}");
            Err(text.error(offset, message))
        }
    };
    let number = || match arguments {
        [argument] => Ok((not_negative(argument)?, argument.1)),
        _ => {
            let message = format!("{keyword} needs one number; this line has {}", arguments.len());
            Err(text.error(offset, message))
        }
    };
    match keyword {
        "Ka" => definition.ambient = color()?,
        "Kd" => definition.diffuse = color()?,
        "Ks" => definition.specular = color()?,
        "Tf" => definition.filter = color()?,
        "Ns" => (definition.shininess, _) = number()?,
        "Ni" => match number()? {
            (0.0, offset) => {
                return Err(text.error(offset, "Ni is 0; an index of refraction must be greater than 0"));
            }
            (ior, _) => definition.ior = ior,
        },
        "illum" => {
            let (value, offset) = number()?;
            definition.illum = (0..=10).find(|&illum| f64::from(illum) == value).ok_or_else(|| {
                text.error(offset, format!("illum is {value}; it must be a whole number from 0 to 10"))
            })?;
        }
        other => {
            let name = number::shortened(other);
            text.warn(warnings, other, offset, || format!("`{name}` is not modelled and left out"));
        }
    }
    Ok(())
}

/// The Whitted model's reading of an MTL material, by its `illum`.
fn modelled(definition: &Definition, path: &Path, warnings: &mut Warnings) -> Material {
    let &Definition { ref name, ambient, diffuse, specular, filter, shininess, ior, illum } = definition;
    let mut warn = |what: &str| {
        let kind = format!("illum {illum}");
        warnings.add(&kind, path, || {
            (Place::Element(format!("material {name}")), format!("illum {illum}: {what}"))
        });
    };
    match illum {
        5 => warn("its Fresnel effect is not modelled; the mirror is Ks at every angle"),
        8 | 9 => warn("reflection is traced here though this illum asks not to"),
        10 => warn("shadows on invisible surfaces are not modelled; it is shown as illum 2"),
        _ => {}
    }
    let glass = |ior: f32, transmission: DVec3, fresnel: Fresnel| {
        Some(Dielectric { ior, absorption: Rgb::ZERO, transmission: rounded_3(transmission), fresnel })
    };
    let matte = Material { ambient: rounded_3(ambient), diffuse: rounded_3(diffuse), ..Material::default() };
    let shiny = Material { specular: rounded_3(specular), shininess: rounded(shininess), ..matte };
    let mirror = Material { mirror: rounded_3(specular), ..shiny };
    match illum {
        0 | 1 => matte,
        3 | 5 | 8 => mirror,
        4 | 9 => Material { dielectric: glass(1.0, filter, Fresnel::Fixed), ..mirror },
        6 => Material {
            dielectric: glass(
                rounded(ior),
                (DVec3::ONE - specular).max(DVec3::ZERO) * filter,
                Fresnel::Fixed,
            ),
            ..mirror
        },
        7 => Material { dielectric: glass(rounded(ior), filter, Fresnel::Schlick), ..shiny },
        _ => shiny,
    }
}
