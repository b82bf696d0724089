//! `[camera]`.

use super::reader::{Table, Value};
use crate::load::error::InputError;
use crate::load::number::rounded;
use crate::scene::{Camera, CameraProblem, Projection, Window};

const KEYS: [&str; 8] = ["kind", "eye", "target", "up", "fov", "height", "window", "distance"];

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Perspective,
    Orthographic,
}

pub(super) fn read(value: &Value<'_>) -> Result<Camera, InputError> {
    let table = value.table("[camera]", &KEYS)?;
    let kind = match table.get("kind") {
        None => Kind::Perspective,
        Some(kind) => {
            kind.one_of(&[("perspective", Kind::Perspective), ("orthographic", Kind::Orthographic)])?
        }
    };
    let camera = Camera {
        eye: table.require("eye")?.vector()?,
        target: table.require("target")?.vector()?,
        up: table.require("up")?.vector()?,
        projection: projection(&table, kind)?,
    };
    camera.check().map_err(|problem| {
        let key = match problem {
            CameraProblem::NoDirection => "eye",
            CameraProblem::UpAlongView => "up",
            CameraProblem::Angle => "fov",
            CameraProblem::Height => "height",
            CameraProblem::Window => "window",
            CameraProblem::Distance => "distance",
        };
        match table.get(key) {
            Some(value) => value.error(problem.to_string()),
            None => table.error(problem.to_string()),
        }
    })?;
    Ok(camera)
}

fn projection(table: &Table<'_>, kind: Kind) -> Result<Projection, InputError> {
    let (own_key, other_key, other_kind) = match kind {
        Kind::Perspective => ("fov", "height", "orthographic"),
        Kind::Orthographic => ("height", "fov", "perspective"),
    };
    if let Some(value) = table.get(other_key) {
        return Err(value.error(format!(
            "`{other_key}` belongs to a camera of kind \"{other_kind}\"; give `{own_key}` or `window` here"
        )));
    }
    let distance = match table.get("distance") {
        None => 1.0,
        Some(value) if kind == Kind::Orthographic => {
            return Err(value.error("`distance` belongs to a camera of kind \"perspective\"; remove it"));
        }
        Some(value) => value.float()?,
    };
    match (table.get(own_key), table.get("window")) {
        (Some(_), Some(window)) => {
            Err(window.error(format!("a camera has `{own_key}` or `window`, not both; remove one")))
        }
        (None, None) => Err(table.error(format!("a camera of this kind needs `{own_key}` or `window`"))),
        (Some(value), None) => Ok(match kind {
            // The angle holds whatever the distance, which is checked and then has nothing to say.
            Kind::Perspective if distance <= 0.0 => {
                let message = CameraProblem::Distance.to_string();
                return Err(table
                    .get("distance")
                    .map_or(table.error(&message), |value| value.error(&message)));
            }
            Kind::Perspective => Projection::PerspectiveAngle { vertical_degrees: value.float()? },
            Kind::Orthographic => Projection::OrthographicHeight { height: value.float()? },
        }),
        (None, Some(window)) => {
            let [left, right, bottom, top] = window.numbers()?.map(rounded);
            let window = Window { left, right, bottom, top };
            Ok(match kind {
                Kind::Perspective => Projection::PerspectiveWindow { window, distance },
                Kind::Orthographic => Projection::OrthographicWindow { window },
            })
        }
    }
}
