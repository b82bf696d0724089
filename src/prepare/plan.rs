//! What a scene needs, decided once. The loop over the stages consumes this very object, and `explain` prints it.

use crate::scene::{Geometry, Material, MaterialId, Rgb, Sampling, Scene};
use serde::Serialize;

/// What a scene needs of the engine. Materials that no primitive uses count for nothing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Plan {
    /// Spheres that can be hit; with none there is no sphere test.
    pub spheres: usize,
    /// Triangles, likewise.
    pub triangles: usize,
    /// Polygons, likewise.
    pub polygons: usize,
    /// Lights; with none there are no shadow rays.
    pub lights: usize,
    /// Some light adds to some surface.
    pub local_light: bool,
    /// Some surface has highlights: powers are taken.
    pub highlights: bool,
    /// Some triangle or polygon has a normal at each vertex.
    pub vertex_normals: bool,
    /// Some primitive does not cast shadows.
    pub shadowless: bool,
    /// Some surface mirrors, and rays of depth 1 are wanted.
    pub reflection: bool,
    /// Some surface refracts, and rays of depth 1 are wanted.
    pub refraction: bool,
    /// Some dielectric absorbs: exponentials are taken.
    pub absorption: bool,
    /// The deepest ray; 0 where no surface reflects or refracts.
    pub max_depth: u32,
    /// Rays of less weight are not traced.
    pub min_weight: f32,
    /// Samples a pixel.
    pub samples: u32,
    /// Samples lie where random numbers say.
    pub random_numbers: bool,
}

impl Plan {
    /// Looks at a scene.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let used = used_materials(scene);
        let any = |property: &dyn Fn(&Material) -> bool| used.iter().any(|material| property(material));
        let geometry = &scene.geometry;
        let dielectric = any(&|material| material.dielectric.is_some());
        let reflects = dielectric || any(&|material| material.mirror != Rgb::ZERO);
        let is_deep = scene.render.max_depth > 0;
        let (reflection, refraction) = (reflects && is_deep, dielectric && is_deep);
        let lights = if geometry.primitive_count() == 0 { 0 } else { scene.lights.len() };
        Self {
            spheres: geometry.spheres.len(),
            triangles: geometry.triangles.len(),
            polygons: geometry.polygons.len(),
            lights,
            local_light: lights > 0
                && any(&|material| material.diffuse != Rgb::ZERO || material.specular != Rgb::ZERO),
            highlights: lights > 0 && any(&|material| material.specular != Rgb::ZERO),
            vertex_normals: has_vertex_normals(geometry),
            shadowless: any(&|material| !material.casts_shadow),
            reflection,
            refraction,
            absorption: any(&|material| {
                material.dielectric.is_some_and(|dielectric| dielectric.absorption != Rgb::ZERO)
            }),
            max_depth: if reflection || refraction { scene.render.max_depth } else { 0 },
            min_weight: scene.render.min_weight,
            samples: scene.render.samples * scene.render.samples,
            random_numbers: scene.render.samples > 1 && scene.render.sampling != Sampling::Regular,
        }
    }
}

fn has_vertex_normals(geometry: &Geometry) -> bool {
    geometry.triangles.iter().any(|triangle| triangle.normals.is_some())
        || geometry.polygons.iter().any(|polygon| polygon.normals.is_some())
}

/// Materials of primitives that can be hit.
fn used_materials(scene: &Scene) -> Vec<&Material> {
    let mut is_used = vec![false; scene.materials.len()];
    for (_, MaterialId(index)) in scene.geometry.materials() {
        is_used[index as usize] = true;
    }
    scene
        .materials
        .iter()
        .zip(is_used)
        .filter(|(_, is_used)| *is_used)
        .map(|(material, _)| material)
        .collect()
}
