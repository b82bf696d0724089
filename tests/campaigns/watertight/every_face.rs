//! Every face of a surface tried on its own: how often rays meet it, and what they meet first.

use super::aims::Shot;
use super::body::Body;
use super::tracing::{Engine, Met, Target, ray_set};
use wavelane::trace::Hits;

/// All faces that each ray meets, each face having been a scene of its own. Nothing is shared but the formula: not the
/// hierarchy, not the scale, which follows from a scene's largest coordinate.
pub(super) fn met(body: &Body, shots: &[Shot], engine: Engine, pool: &rayon::ThreadPool) -> Vec<Vec<Met>> {
    let rays = ray_set(shots);
    let mut all = vec![Vec::new(); shots.len()];
    for id in 0..body.faces.len() {
        let scene = body.scene_of_faces(&[id]);
        let hits = Target::new(&scene, engine, pool).closest(&rays);
        for (row, met) in all.iter_mut().enumerate() {
            if hits.id[row] != Hits::MISS {
                met.push(Met { id: id as u32, t: hits.t[row] });
            }
        }
    }
    all
}

/// Whether what a hierarchy found is the nearest of all faces that the ray meets: one of them with the very same t, the one
/// that is found where no other faces are, and none is nearer by more than rounding explains.
pub(super) fn is_nearest(
    body: &Body,
    shot: &Shot,
    (found, met): (Met, &[Met]),
    engine: Engine,
    pool: &rayon::ThreadPool,
) -> bool {
    let [only] = met else {
        return if met.is_empty() {
            found.id == Hits::MISS
        } else {
            is_nearest_of_many(body, shot, (found, met), engine, pool)
        };
    };
    found == *only
}

fn is_nearest_of_many(
    body: &Body,
    shot: &Shot,
    (found, met): (Met, &[Met]),
    engine: Engine,
    pool: &rayon::ThreadPool,
) -> bool {
    let ids: Vec<usize> = met.iter().map(|met| met.id as usize).collect();
    let scene = body.scene_of_faces(&ids);
    let hits = Target::new(&scene, engine, pool).closest(&ray_set(&[*shot]));
    let alone = Met { id: ids.get(hits.id[0] as usize).map_or(Hits::MISS, |&id| id as u32), t: hits.t[0] };
    let error = |met: &Met| body.faces[met.id as usize].error_of_t(shot.row);
    let is_behind = |other: &Met| f64::from(found.t) - f64::from(other.t) > error(&found) + error(other);
    met.contains(&found) && alone == found && !met.iter().any(is_behind)
}
