//! A bounding volume hierarchy: the answers of trying every primitive, sooner.
//!
//! Built top down by the binned surface area heuristic: Wald, "On Fast Construction of SAH-based Bounding Volume
//! Hierarchies", 2007. Plain on purpose; tests hold it against trying every primitive.

use super::ray::Ray;
use super::shape::{Meeting, Primitive};
use glam::DVec3;
use std::ops::Range;

pub(super) struct Hierarchy {
    /// In the order of the leaves.
    primitives: Vec<Primitive>,
    nodes: Vec<Node>,
    /// Largest magnitude of a coordinate.
    extent: f64,
}

/// The closest hit of a ray.
#[derive(Clone, Copy)]
pub(super) struct Hit<'a> {
    pub(super) t: f64,
    pub(super) primitive: &'a Primitive,
}

struct Node {
    bounds: Bounds,
    children: Children,
}

enum Children {
    /// A run of primitives.
    Leaf(Range<usize>),
    /// The left child is the next node; this is the right one.
    Inner { right: usize, axis: usize },
}

const LEAF_SIZE: usize = 4;
const BINS: usize = 16;
/// From here on halves are split by count, which bounds the depth by this and the logarithm of the count.
const DEPTH_OF_HALVING: usize = 40;
const STACK_SIZE: usize = DEPTH_OF_HALVING + 33;

/// Rounding of the slab test and of the primitive's own test, as a share of the coordinates that take part: a box grown
/// by this never hides a hit.
const ROUNDING: f64 = 1.0 / (1_u64 << 47) as f64;

/// Whether two surfaces are met at one t, as far as the rounding of either can tell.
fn are_equal(a: &Meeting, b: &Meeting) -> bool {
    (a.t - b.t).abs() <= a.uncertainty.max(b.uncertainty)
}

/// Seen nearly edge-on, the plane of a polygon that rounding has bent is met where nothing of the polygon is, and which hit is
/// nearer would turn on which is looked at first.
fn meeting_within_bounds(primitive: &Primitive, ray: &Ray) -> Option<Meeting> {
    let meeting = primitive.intersect(ray)?;
    let t = primitive.within_bounds(ray, meeting.t);
    // What has been decided about the start stays so.
    Some(if t > ray.t_min { Meeting { t, ..meeting } } else { meeting })
}

impl Hierarchy {
    pub(super) fn new(primitives: Vec<Primitive>) -> Self {
        let items = primitives.into_iter().map(|primitive| {
            let (low, high) = primitive.bounds();
            Item { bounds: Bounds { low, high }, primitive }
        });
        let mut items: Vec<Item> = items.collect();
        let mut nodes = Vec::new();
        if !items.is_empty() {
            build(&mut items, 0, 0, &mut nodes);
        }
        let extent = nodes
            .first()
            .map_or(0.0, |root: &Node| root.bounds.low.abs().max(root.bounds.high.abs()).max_element());
        Self { primitives: items.into_iter().map(|item| item.primitive).collect(), nodes, extent }
    }

    /// The hit of smallest t > 0; of equal ones that of the smallest id. Surfaces that coincide are met at one t, but each
    /// rounds it in its own way, so what differs by no more than rounding counts as equal.
    pub(super) fn closest(&self, ray: &Ray) -> Option<Hit<'_>> {
        // Whatever may equal the nearest is still looked at: the coarsest surface at the worst angle included.
        let scale = (self.extent + ray.origin.abs().max_element()) / ray.direction.abs().max_element();
        let slack = 2.0 * ROUNDING * scale / Meeting::LEAST_COSINE;
        let mut nearest: Option<Meeting> = None;
        let mut candidates: Vec<(Meeting, &Primitive)> = Vec::new();
        self.visit(ray, self.padding(ray), f64::INFINITY, |primitive| {
            let Some(meeting) = meeting_within_bounds(primitive, ray) else {
                return nearest.map_or(f64::INFINITY, |nearest| nearest.t + slack);
            };
            let nearest = match nearest {
                Some(nearest) if nearest.t <= meeting.t => nearest,
                _ => {
                    candidates.retain(|(candidate, _)| are_equal(candidate, &meeting));
                    *nearest.insert(meeting)
                }
            };
            if are_equal(&meeting, &nearest) {
                candidates.push((meeting, primitive));
            }
            nearest.t + slack
        });
        let first = candidates.into_iter().min_by_key(|(_, primitive)| primitive.id);
        first.map(|(meeting, primitive)| Hit { t: meeting.t, primitive })
    }

    /// Whether something that casts a shadow lies at 0 < t < `end`, apart from surfaces that the end is on, if it may be
    /// `off_surface` from those: a length.
    pub(super) fn occluded(&self, ray: &Ray, end: f64, off_surface: f64) -> bool {
        let is_before_end =
            |meeting: Meeting| meeting.t < end && (end - meeting.t) * meeting.approach >= off_surface;
        let mut occluded = false;
        self.visit(ray, self.padding(ray), end, |primitive| {
            occluded |=
                primitive.casts_shadow && meeting_within_bounds(primitive, ray).is_some_and(is_before_end);
            if occluded { f64::NEG_INFINITY } else { end }
        });
        occluded
    }

    /// Largest magnitude of a coordinate.
    pub(super) fn extent(&self) -> f64 {
        self.extent
    }

    /// Covers the rounding of the slab test and of the primitives' own.
    fn padding(&self, ray: &Ray) -> f64 {
        ROUNDING * (self.extent + ray.origin.abs().max_element())
    }

    /// Calls `test` for primitives whose box, grown by `padding`, the ray meets before `end`; `test` returns the new end.
    pub(super) fn visit<'a>(
        &'a self,
        ray: &Ray,
        padding: f64,
        mut end: f64,
        mut test: impl FnMut(&'a Primitive) -> f64,
    ) {
        let slabs = Slabs::new(ray, padding);
        let mut stack = [0; STACK_SIZE];
        let mut waiting = usize::from(!self.nodes.is_empty());
        while waiting > 0 {
            waiting -= 1;
            let index = stack[waiting];
            let node = &self.nodes[index];
            if !slabs.meet(&node.bounds, end) {
                continue;
            }
            match &node.children {
                Children::Leaf(run) => {
                    for primitive in &self.primitives[run.clone()] {
                        end = test(primitive);
                    }
                }
                Children::Inner { right, axis } => {
                    let (near, far) =
                        if slabs.backwards[*axis] { (*right, index + 1) } else { (index + 1, *right) };
                    stack[waiting] = far;
                    stack[waiting + 1] = near;
                    waiting += 2;
                }
            }
        }
    }
}

/// What the slab test needs of a ray: Kay and Kajiya, "Ray Tracing Complex Scenes", 1986.
struct Slabs {
    origin: DVec3,
    inverse: DVec3,
    backwards: [bool; 3],
    padding: DVec3,
}

impl Slabs {
    fn new(ray: &Ray, padding: f64) -> Self {
        let backwards = ray.direction.to_array().map(f64::is_sign_negative);
        Self { origin: ray.origin, inverse: ray.direction.recip(), backwards, padding: DVec3::splat(padding) }
    }

    /// Whether the ray is inside the box for some 0 ≤ t ≤ `end`.
    fn meet(&self, bounds: &Bounds, end: f64) -> bool {
        let to_low = (bounds.low - self.padding - self.origin) * self.inverse;
        let to_high = (bounds.high + self.padding - self.origin) * self.inverse;
        let (mut enter, mut leave) = (0.0_f64, end);
        for axis in 0..3 {
            let (near, far) = if self.backwards[axis] {
                (to_high[axis], to_low[axis])
            } else {
                (to_low[axis], to_high[axis])
            };
            // A ray within a face of the box has 0 · ∞ here; min and max pass over the NaN, so the slab excludes nothing.
            enter = enter.max(near);
            leave = leave.min(far);
        }
        enter <= leave
    }
}

#[derive(Clone, Copy)]
struct Bounds {
    low: DVec3,
    high: DVec3,
}

impl Bounds {
    const EMPTY: Self = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };

    fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    fn middle(self) -> DVec3 {
        0.5 * self.low + 0.5 * self.high
    }

    fn half_area(self) -> f64 {
        let size = (self.high - self.low).max(DVec3::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

struct Item {
    bounds: Bounds,
    primitive: Primitive,
}

/// Appends the node over `items`, which begin at primitive `first`, and all nodes below it.
fn build(items: &mut [Item], first: usize, depth: usize, nodes: &mut Vec<Node>) {
    let bounds = items.iter().fold(Bounds::EMPTY, |bounds, item| bounds.union(item.bounds));
    let index = nodes.len();
    nodes.push(Node { bounds, children: Children::Leaf(first..first + items.len()) });
    if items.len() <= LEAF_SIZE {
        return;
    }
    let (axis, middle) = split(items, depth);
    let (left, right) = items.split_at_mut(middle);
    build(left, first, depth + 1, nodes);
    let right_index = nodes.len();
    build(right, first + middle, depth + 1, nodes);
    nodes[index].children = Children::Inner { right: right_index, axis };
}

/// Reorders items into two groups that are not empty, and returns the axis that parts them and the size of the first.
fn split(items: &mut [Item], depth: usize) -> (usize, usize) {
    let (low, high) = items.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), item| {
        let middle = item.bounds.middle();
        (low.min(middle), high.max(middle))
    });
    let axis = (high - low).max_position();
    if depth < DEPTH_OF_HALVING && high[axis] > low[axis] {
        let scale = BINS as f64 / (high[axis] - low[axis]);
        let bin = |item: &Item| {
            let position = (item.bounds.middle()[axis] - low[axis]) * scale;
            // The rightmost middle falls on the end of the last bin.
            (0..BINS - 1).find(|&bin| position < (bin + 1) as f64).unwrap_or(BINS - 1)
        };
        if let Some(cut) = cheapest_cut(items, &bin) {
            return (axis, partition(items, |item| bin(item) < cut));
        }
    }
    let half = items.len() / 2;
    items.select_nth_unstable_by(half, |a, b| a.bounds.middle()[axis].total_cmp(&b.bounds.middle()[axis]));
    (axis, half)
}

/// The number of bins that go left for the least sum of area times count.
fn cheapest_cut(items: &[Item], bin: &impl Fn(&Item) -> usize) -> Option<usize> {
    let mut bins = [(Bounds::EMPTY, 0_usize); BINS];
    for item in items {
        let (bounds, count) = &mut bins[bin(item)];
        (*bounds, *count) = (bounds.union(item.bounds), *count + 1);
    }
    let cost = |bins: &[(Bounds, usize)]| {
        let (bounds, count) =
            bins.iter().fold((Bounds::EMPTY, 0), |(bounds, count), bin| (bounds.union(bin.0), count + bin.1));
        (count > 0).then(|| bounds.half_area() * count as f64)
    };
    (1..BINS)
        .filter_map(|cut| Some((cut, cost(&bins[..cut])? + cost(&bins[cut..])?)))
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(cut, _)| cut)
}

/// Moves the items that `goes_left` to the front, and returns how many.
fn partition(items: &mut [Item], goes_left: impl Fn(&Item) -> bool) -> usize {
    let mut left = 0;
    for index in 0..items.len() {
        if goes_left(&items[index]) {
            items.swap(left, index);
            left += 1;
        }
    }
    left
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Geometry, Material, MaterialId};
    use glam::Vec3;
    use proptest::prelude::*;

    /// Coordinates on a coarse grid make ties, flat boxes and rays within faces common.
    fn point() -> impl Strategy<Value = Vec3> {
        let coordinate = prop_oneof![(-8..=8_i8).prop_map(|i| f32::from(i) / 4.0), -2.0..2.0_f32];
        [coordinate.clone(), coordinate.clone(), coordinate].prop_map(Vec3::from)
    }

    prop_compose! {
        fn geometry()(
            spheres in prop::collection::vec((point(), 0.01..0.5_f32), 0..60),
            triangles in prop::collection::vec([point(), point(), point()], 0..60),
            squares in prop::collection::vec((point(), 0.1..1.0_f32), 0..20),
        ) -> Geometry {
            let mut geometry = Geometry::default();
            for (center, radius) in spheres {
                geometry.add_sphere(center, radius, MaterialId(0)).unwrap();
            }
            for corners in triangles {
                let first = geometry.add_vertices(corners).unwrap();
                geometry.add_triangle([first, first + 1, first + 2], None, MaterialId(0)).unwrap();
            }
            for (corner, side) in squares {
                let corners = [Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y, Vec3::Y].map(|to| corner + side * to);
                geometry.add_polygon(&corners, None, MaterialId(0)).unwrap();
            }
            geometry
        }
    }

    /// Trying every primitive: the smallest t, and the smallest id among those that equal it.
    fn closest_of_all(hierarchy: &Hierarchy, ray: &Ray) -> Option<(f64, u32)> {
        let all = hierarchy.primitives.iter();
        let hits: Vec<(u32, Meeting)> = all
            .filter_map(|primitive| Some((primitive.id.0, meeting_within_bounds(primitive, ray)?)))
            .collect();
        let nearest = hits.iter().map(|&(_, meeting)| meeting).min_by(|a, b| a.t.total_cmp(&b.t))?;
        let equal = hits.into_iter().filter(|(_, meeting)| are_equal(meeting, &nearest));
        equal.min_by_key(|&(id, _)| id).map(|(id, meeting)| (meeting.t, id))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(400))]
        #[test]
        fn gives_the_answers_of_trying_every_primitive(
            geometry in geometry(),
            rays in prop::collection::vec((point(), point()), 50),
        ) {
            let hierarchy = Hierarchy::new(Primitive::all(&geometry, &[Material::grey()]));
            for (origin, direction) in rays.into_iter().filter(|(_, direction)| *direction != Vec3::ZERO) {
                let ray = Ray::new(origin.as_dvec3(), direction.as_dvec3(), None);
                let expected = closest_of_all(&hierarchy, &ray);
                prop_assert_eq!(hierarchy.closest(&ray).map(|hit| (hit.t, hit.primitive.id.0)), expected);
                prop_assert_eq!(hierarchy.occluded(&ray, 1.0, 0.0), expected.is_some_and(|(t, _)| t < 1.0));
            }
        }
    }

    #[test]
    fn primitives_in_one_place_do_not_deepen_it_without_end() {
        let mut geometry = Geometry::default();
        for step in 0..20_000_u16 {
            // Each sphere a fraction of the one before, so that a cut by area parts one from the rest.
            let center = Vec3::X * 0.9_f32.powi(i32::from(step).min(300));
            geometry.add_sphere(center, 1e-30, MaterialId(0)).unwrap();
        }
        let hierarchy = Hierarchy::new(Primitive::all(&geometry, &[Material::grey()]));
        let ray = Ray::new(DVec3::new(2.0, 0.0, 0.0), DVec3::NEG_X, None);
        assert_eq!(hierarchy.closest(&ray).map(|hit| hit.primitive.id.0), Some(0));
    }
}
