//! The whole tree of a pixel's rays, copied out of the queues as the stages fill them. It is what an engineer asks for who
//! wants to know why one pixel is as it is; a picture keeps none.

use super::level::Level;
use super::queue::{ChildQueue, HitQueue, NormalQueue, ShadowQueue, SurfaceQueue};
use super::trail::{self, Keep};
use super::worker::{TileGrid, Worker};
use crate::film::Region;
use crate::lanes::Single;
use crate::prepare::bvh::Kind;
use crate::prepare::{Prepared, Scale};
use crate::ray_tree::{PixelTree, PrimitiveKind, RayTree, TreeHit, TreeLight, TreeTooLarge};
use crate::scene::{MaterialId, PrimitiveId};
use crate::signature::Shadow;
use crate::traverse::{NOTHING, RUN};
use std::sync::atomic::AtomicBool;

/// Trees of a level's rays, row by row; none once their parent has taken them.
pub(super) type Trees = Vec<Option<RayTree>>;

/// Traces one pixel, x and y from the full image's top left: first to see how large its tree is, then to keep it. Means
/// nothing once it was told to stop.
pub(crate) fn pixel_tree<F: Single>(
    prepared: &Prepared<'_>,
    [x, y]: [u32; 2],
    stop: &AtomicBool,
) -> Result<PixelTree, TreeTooLarge> {
    // All samples in one batch, so that depth 0 holds them all at the end.
    let batch = (prepared.plan.samples as usize).next_multiple_of(RUN);
    let grid = TileGrid::new(Region { x0: x, y0: y, x1: x + 1, y1: y + 1 }, prepared, batch);
    let mut worker = Worker::new(prepared, batch, Keep::Colours, stop);
    let pixels = worker.tile::<F>(&grid, 0);
    PixelTree::check_size(&worker.statistics.rays, prepared.scene.lights.len())?;
    let mut worker = Worker::new(prepared, batch, Keep::Trees, stop);
    worker.tile::<F>(&grid, 0);
    let colour = pixels.colours.first().map_or([0.0; 3], |colour| colour.map(f64::from));
    Ok(PixelTree { colour, samples: worker.primary_trees() })
}

/// Begins the tree of each ray of a batch, with what it hit.
pub(super) fn begin(
    prepared: &Prepared<'_>,
    level: &mut Level,
    first_ray: usize,
    hits: &HitQueue,
    surfaces: &SurfaceQueue,
    normals: &NormalQueue,
) {
    let Some(mut trees) = level.trees.take() else { return };
    let units = WorldUnits::of(prepared.scale);
    trees.truncate(first_ray);
    trees.extend((first_ray..first_ray + hits.len()).map(|ray| Some(begun(level, ray, &units))));
    for row in 0..surfaces.len() {
        let ray = surfaces.ray[row] as usize;
        if let Some(tree) = &mut trees[ray] {
            let t = hits.t[ray - first_ray];
            tree.hit = Some(hit(prepared, level, surfaces, normals, row, t));
        }
    }
    level.trees = Some(trees);
}

/// A ray that hits nothing so far, and then sees the background.
fn begun(level: &Level, ray: usize, units: &WorldUnits) -> RayTree {
    let record = level.rays.get(ray);
    let weight = match level.departures.len() {
        0 => [1.0; 3],
        _ => level.departures.get(ray).weight,
    };
    RayTree {
        origin: units.position(record.origin),
        direction: record.direction.map(f64::from),
        weight: weight.map(f64::from),
        hit: None,
        reflect: None,
        refract: None,
        colour: level.radiance.get(ray).radiance.map(f64::from),
    }
}

fn hit(
    prepared: &Prepared<'_>,
    level: &Level,
    surfaces: &SurfaceQueue,
    normals: &NormalQueue,
    row: usize,
    t: f32,
) -> TreeHit {
    let units = WorldUnits::of(prepared.scale);
    let surface = surfaces.get(row);
    let id = surface.departure >> 1;
    let (kind, _) = prepared.directory.find(id);
    let shading_normal =
        if normals.len() == 0 { surface.geometric_normal } else { normals.get(row).shading_normal };
    let attenuation =
        if prepared.plan.absorption { level.attenuations.get(row).attenuation } else { [1.0; 3] };
    TreeHit {
        kind: match kind {
            Kind::Sphere => PrimitiveKind::Sphere,
            Kind::Triangle => PrimitiveKind::Triangle,
            Kind::Polygon => PrimitiveKind::Polygon,
        },
        primitive: PrimitiveId(id),
        material: MaterialId(surface.material),
        // A ray that stays inside came from inside.
        entering: surface.departure & 1 == 0,
        t: units.length(t),
        point: units.position(surface.position),
        geometric_normal: surface.geometric_normal.map(f64::from),
        shading_normal: shading_normal.map(f64::from),
        attenuation: attenuation.map(f64::from),
        lights: Vec::new(),
        local_light: [0.0; 3],
    }
}

/// Notes which surfaces see a light, and what it adds to them.
pub(super) fn add_light(level: &mut Level, shadows: &ShadowQueue) {
    let Some(trees) = &mut level.trees else { return };
    for (row, (shadow, shadow_row)) in trail::verdicts(shadows, level.trails.len()).enumerate() {
        let adds = match shadow {
            Shadow::Visible => shadows.get(shadow_row).light,
            Shadow::Hidden | Shadow::NotTraced => [0.0; 3],
        };
        let light = TreeLight { shadow, adds: adds.map(f64::from) };
        let ray = level.pending.ray[row] as usize;
        if let Some(hit) = trees[ray].as_mut().and_then(|tree| tree.hit.as_mut()) {
            hit.lights.push(light);
        }
    }
}

/// Gives the surfaces of a batch their light and their children.
pub(super) fn resolve(level: &mut Level, deeper: Option<&mut Trees>) {
    let Some(trees) = &mut level.trees else { return };
    let mut deeper = deeper;
    let mut child_of = |children: &ChildQueue, row: usize| {
        let deeper = deeper.as_mut().filter(|_| children.len() > 0)?;
        let child = children.row[row];
        // Rays that were stopped have no tree.
        deeper.get_mut(child as usize).filter(|_| child != NOTHING)?.take().map(Box::new)
    };
    for row in 0..level.pending.len() {
        let ray = level.pending.ray[row] as usize;
        let Some(tree) = &mut trees[ray] else { continue };
        tree.reflect = child_of(&level.reflected, row);
        tree.refract = child_of(&level.refracted, row);
        tree.colour = level.radiance.get(ray).radiance.map(f64::from);
        if let Some(hit) = &mut tree.hit {
            hit.local_light = level.pending.get(row).light.map(f64::from);
        }
    }
}

/// From the engine's scale to the world's; exact, since the factor is a power of two.
struct WorldUnits {
    world_from_scene: f64,
}

impl WorldUnits {
    fn of(scale: Scale) -> Self {
        Self { world_from_scene: 1.0 / f64::from(scale.factor()) }
    }

    fn length(&self, scene: f32) -> f64 {
        f64::from(scene) * self.world_from_scene
    }

    fn position(&self, scene: [f32; 3]) -> [f64; 3] {
        scene.map(|coordinate| self.length(coordinate))
    }
}
