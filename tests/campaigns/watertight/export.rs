//! Surfaces of triangles and the rays from inside them, as files for other tracers.
//!
//! `WAVELANE_CAMPAIGN_FOLDER` names a folder for them. Of each surface it gets a folder with `vertices.npy` (f32, n × 3),
//! `triangles.npy` (u32, n × 3) and, by what they are aimed at, `rays-AIM.npy` (f32, n × 8: origin, t_min, direction, t_max).

use super::aims::{Aim, Shot};
use super::body::Body;
use std::fs;
use std::path::PathBuf;

/// Where the files of a surface go.
pub(super) struct Export {
    folder: PathBuf,
}

impl Export {
    /// None where no files are asked for, or the surface is not of triangles alone.
    pub(super) fn new(body: &Body, number: u64) -> Option<Self> {
        let folder = PathBuf::from(std::env::var_os("WAVELANE_CAMPAIGN_FOLDER")?).join(number.to_string());
        let geometry = &body.scene.geometry;
        if !geometry.polygons.is_empty() {
            return None;
        }
        fs::create_dir_all(&folder).unwrap();
        let export = Self { folder };
        let vertices = geometry.vertices.iter().flat_map(glam::Vec3::to_array);
        export.write("vertices", ("<f4", 3), vertices.flat_map(f32::to_le_bytes).collect());
        let triangles = geometry.triangles.iter().flat_map(|triangle| triangle.vertices);
        export.write("triangles", ("<u4", 3), triangles.flat_map(u32::to_le_bytes).collect());
        Some(export)
    }

    pub(super) fn rays(&self, aim: Aim, shots: &[Shot]) {
        let numbers = shots.iter().flat_map(|shot| shot.row);
        let name = format!("rays-{}", aim.name().replace(' ', "-"));
        self.write(&name, ("<f4", 8), numbers.flat_map(f32::to_le_bytes).collect());
    }

    /// As the NPY format, version 1.0, wants it: <https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html>.
    fn write(&self, name: &str, (kind, columns): (&str, usize), values: Vec<u8>) {
        let rows = values.len() / (4 * columns);
        let header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({rows}, {columns}), }}");
        let mut bytes = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
        bytes.extend(format!("{header:<117}\n").into_bytes());
        bytes.extend(values);
        fs::write(self.folder.join(name).with_extension("npy"), bytes).unwrap();
    }
}
