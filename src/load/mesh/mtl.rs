//! MTL material libraries, read by `tobj` after a first pass has checked their lines.

use super::lines::{LogicalLine, logical_lines};
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
    parsed: Vec<tobj::Material>,
    materials: Vec<Material>,
    /// A later material of the same name takes its place.
    by_name: HashMap<String, usize>,
}

/// What `tobj` wants to be told of materials.
type ForTobj = (Vec<tobj::Material>, HashMap<String, usize>);

impl Library {
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.by_name.keys().map(String::as_str)
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.by_name.contains_key(name)
    }

    /// The materials as the OBJ library wants them, and as a scene does; in the same order.
    pub(super) fn into_parts(self) -> (ForTobj, Vec<Material>) {
        ((self.parsed, self.by_name), self.materials)
    }
}

/// Adds the materials of a file.
pub(super) fn read(path: &Path, library: &mut Library, warnings: &mut Warnings) -> Result<(), InputError> {
    let text = Text::read_lossy(path)?;
    let mut lines = String::new();
    let mut started = false;
    for line in logical_lines(&text.content) {
        let Some(&(keyword, offset)) = line.words.first() else { continue };
        if keyword == "newmtl" {
            if line.words.len() < 2 {
                return Err(text.error(offset, "`newmtl` needs the name of a material"));
            }
            started = true;
        } else if !started {
            let keyword = number::shortened(keyword);
            return Err(text.error(offset, format!("`{keyword}` stands before the first `newmtl`")));
        }
        if let Some(checked) = checked(&text, &line, warnings)? {
            lines += &checked;
            lines += "\n";
        }
    }
    let refused = |why: &dyn std::fmt::Display| {
        InputError::refused(
            path,
            Place::File,
            format!("this is not a material library that can be read: {why}"),
        )
    };
    let (parsed, _) = tobj::load_mtl_buf(&mut lines.as_bytes()).map_err(|error| refused(&error))?;
    for material in parsed {
        let modelled = modelled(&material, path, warnings).map_err(|message| {
            InputError::refused(path, Place::Element(format!("material {}", material.name)), message)
        })?;
        library.by_name.insert(material.name.clone(), library.materials.len());
        library.materials.push(modelled);
        library.parsed.push(material);
    }
    Ok(())
}

/// A line that the library can read, or nothing where it says what is not modelled.
fn checked(
    text: &Text,
    line: &LogicalLine<'_>,
    warnings: &mut Warnings,
) -> Result<Option<String>, InputError> {
    let Some((&(keyword, offset), arguments)) = line.words.split_first() else { return Ok(None) };
    let number = |&(word, offset): &(&str, usize)| {
        number::parse(word).map_err(|message| text.error(offset, format!("{keyword}: {message}")))
    };
    let not_negative = |argument: &(&str, usize)| match number(argument)? {
        value if value < 0.0 => {
            Err(text.error(argument.1, format!("{keyword} is {value}; it must not be negative")))
        }
        value => Ok(value),
    };
    match keyword {
        "newmtl" => Ok(Some(format!("newmtl {}", line.rest(&text.content)))),
        "Ka" | "Kd" | "Ks" | "Tf" => {
            let words: Vec<&str> = arguments.iter().map(|(word, _)| *word).collect();
            // One number stands for grey.
            let [r, g, b] = match *words.as_slice() {
                [grey] => [grey; 3],
                [r, g, b] => [r, g, b],
                _ => {
                    return Err(text.error(
                        offset,
                        format!(
                            "{keyword} needs r g b, or one number for grey; this line has {}",
                            words.len()
                        ),
                    ));
                }
            };
            arguments.iter().try_for_each(|argument| not_negative(argument).map(drop))?;
            Ok(Some(format!("{keyword} {r} {g} {b}")))
        }
        "Ns" | "Ni" | "illum" => {
            let [argument] = arguments else {
                let message = format!("{keyword} needs one number; this line has {}", arguments.len());
                return Err(text.error(offset, message));
            };
            let value = not_negative(argument)?;
            if keyword == "Ni" && value == 0.0 {
                return Err(text.error(argument.1, "Ni is 0; an index of refraction must be greater than 0"));
            }
            if keyword == "illum" && !(value.fract() == 0.0 && value <= 10.0) {
                return Err(text
                    .error(argument.1, format!("illum is {value}; it must be a whole number from 0 to 10")));
            }
            let word = if keyword == "illum" { value.to_string() } else { argument.0.to_owned() };
            Ok(Some(format!("{keyword} {word}")))
        }
        other => {
            let name = number::shortened(other);
            text.warn(warnings, other, offset, || format!("`{name}` is not modelled and left out"));
            Ok(None)
        }
    }
}

/// The Whitted model's reading of an MTL material, by its `illum`.
fn modelled(material: &tobj::Material, path: &Path, warnings: &mut Warnings) -> Result<Material, String> {
    let color = |value: Option<[f64; 3]>| value.map_or(DVec3::ZERO, DVec3::from);
    let (ka, kd, ks) = (color(material.ambient), color(material.diffuse), color(material.specular));
    let tf = match material.unknown_param.get("Tf") {
        None => DVec3::ONE,
        Some(words) => {
            let numbers: Vec<f64> = words.split_whitespace().map(number::parse).collect::<Result<_, _>>()?;
            DVec3::from_slice(&numbers)
        }
    };
    let ior = rounded(material.optical_density.unwrap_or(1.0));
    let illum = material.illumination_model.unwrap_or(2);
    let mut warn = |what: &str| {
        let kind = format!("illum {illum}");
        warnings.add(&kind, path, || {
            (Place::Element(format!("material {}", material.name)), format!("illum {illum}: {what}"))
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
    let matte = Material { ambient: rounded_3(ka), diffuse: rounded_3(kd), ..Material::default() };
    let shiny =
        Material { specular: rounded_3(ks), shininess: rounded(material.shininess.unwrap_or(1.0)), ..matte };
    let mirror = Material { mirror: rounded_3(ks), ..shiny };
    Ok(match illum {
        0 | 1 => matte,
        3 | 5 | 8 => mirror,
        4 | 9 => Material { dielectric: glass(1.0, tf, Fresnel::Fixed), ..mirror },
        6 => Material {
            dielectric: glass(ior, (DVec3::ONE - ks).max(DVec3::ZERO) * tf, Fresnel::Fixed),
            ..mirror
        },
        7 => Material { dielectric: glass(ior, tf, Fresnel::Schlick), ..shiny },
        _ => shiny,
    })
}
