//! All primitives under one tree.

use super::Scale;
use super::blocks::{BLOCK, PolygonFace, SphereBlock, TriangleBlock, touch_distance};
use super::bvh::{self, Bounds, Child, Costs, Kind, Leaf, Node, Tree, Unpacked};
use super::sources::{Order, Sources, bounds_of};
use crate::lanes::prefetch;
use crate::scene::{Geometry, Scene, polygon_normal};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// A tree of wide nodes over blocks of spheres and triangles and over polygons.
pub(crate) struct Hierarchy {
    /// The root first.
    pub(crate) nodes: Vec<Node>,
    pub(crate) spheres: Vec<SphereBlock>,
    pub(crate) triangles: Vec<TriangleBlock>,
    pub(crate) polygons: Vec<PolygonFace>,
    /// x, y and z of the polygons' corners. After its last corner a polygon has its first again, and then as often as
    /// it takes for lanes to read on.
    pub(crate) corners: [Vec<f32>; 3],
    /// Unit, outward, of the scene's polygons in their order; in f64 for what follows a hit.
    pub(crate) polygon_normals: Vec<DVec3>,
    /// By id in increasing order, how far the corners of the scene's polygons lie off their planes.
    pub(crate) bends: Vec<(u32, f64)>,
    /// Largest magnitude of a coordinate.
    pub(crate) extent: f32,
    /// By id, whether a primitive lets light pass; empty where none does.
    pub(crate) shadowless: Vec<bool>,
    /// Wide nodes on the longest way down.
    pub(crate) depth: u32,
    /// What a random ray is expected to cost, in visits of a node.
    pub(crate) cost: f64,
}

/// What a slot of a node leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// A node.
    Node(usize),
    /// A block of spheres.
    Spheres(usize),
    /// A block of triangles.
    Triangles(usize),
    /// Polygons: the first, and how many.
    Polygons(usize, usize),
}

/// What the steps of a traversal cost, in visits of a node; measured with one ray at a time.
///
/// As many spheres or triangles as a block holds are a leaf. To part them where their boxes would cost less takes blocks that
/// are not full: for the half more of memory that spheres then had, and for building 1.3 times as long (triangles: a tenth
/// more, 1.15 times), rays were 0.98 and 0.99 times as fast (six sets of rays, 2026-11-23).
///
/// What a node's memory costs was chosen so that rays are as fast as with none: then spheres take a fifth fewer nodes, and
/// triangles a twentieth (four sets of rays, 2026-11-23).
const COSTS: Costs = Costs {
    node: 1.0,
    node_memory: 4.0,
    block: [0.8, 0.9, 0.9],
    room: [BLOCK as f32, BLOCK as f32, 8.0],
    largest_leaf: 4,
    stays_whole: [true, true, false],
};

/// Bytes that memory gives at a time. Nothing that is asked for before it is read fills more than four of them.
const LINE: usize = 64;
const _: () = assert!(size_of::<Node>() <= 4 * LINE && BLOCK * size_of::<PolygonFace>() <= 4 * LINE);

/// Lanes may read so far beyond a polygon's last corner.
const CORNERS_BEYOND: usize = 16;

/// Polygons of a leaf are at most [`BLOCK`]; their count fits beside the index of the first.
const COUNT_BITS: u32 = 2;
const _: () = assert!(BLOCK == COSTS.largest_leaf as usize && BLOCK <= 1 << COUNT_BITS);

impl Hierarchy {
    pub(super) fn new(scene: &Scene, scale: Scale) -> Self {
        let geometry = &scene.geometry;
        let sources = Sources { geometry, scale };
        let items = (0..geometry.primitive_count()).into_par_iter().map(|index| sources.item(index));
        let Tree { nodes, leaves, order, root: _, bounds, depth, cost } = bvh::build(items, &COSTS);
        let extent = largest_coordinate(bounds);
        let order = Order { order: &order, sources };
        let [of_spheres, of_triangles, of_polygons] = &leaves;
        let mut this = Self {
            nodes,
            spheres: of_spheres.par_iter().map(|&leaf| order.spheres(leaf)).collect(),
            triangles: of_triangles.par_iter().map(|&leaf| order.triangles(leaf, extent)).collect(),
            polygons: Vec::new(),
            corners: Default::default(),
            polygon_normals: vec![DVec3::Z; geometry.polygons.len()],
            bends: geometry.polygons.iter().map(|polygon| (polygon.id.0, 0.0)).collect(),
            extent,
            shadowless: shadowless(scene),
            depth,
            cost,
        };
        if !of_polygons.is_empty() {
            this.add_polygons(of_polygons, order);
        }
        this
    }

    /// Where a slot leads; none for a slot that is not used.
    #[inline(always)]
    pub(crate) fn place(child: Child) -> Option<Place> {
        match child.unpack() {
            Unpacked::Empty => None,
            Unpacked::Inner(node) => Some(Place::Node(node as usize)),
            Unpacked::Leaf(Kind::Sphere, block) => Some(Place::Spheres(block as usize)),
            Unpacked::Leaf(Kind::Triangle, block) => Some(Place::Triangles(block as usize)),
            Unpacked::Leaf(Kind::Polygon, run) => {
                let count = (run & ((1 << COUNT_BITS) - 1)) + 1;
                Some(Place::Polygons((run >> COUNT_BITS) as usize, count as usize))
            }
        }
    }

    /// Asks for the memory of what a slot leads to, without a branch on what that is.
    #[inline(always)]
    pub(crate) fn prefetch(&self, child: Child) {
        // The word of polygons has their count below the index of the first: a fraction of a face too far does no harm.
        const SIZES: [usize; 4] = [
            size_of::<Node>(),
            size_of::<SphereBlock>(),
            size_of::<TriangleBlock>(),
            size_of::<PolygonFace>() >> COUNT_BITS,
        ];
        /// Where the last line begins of what begins with a line.
        const fn last_line(size: usize) -> usize {
            (size - 1) / LINE * LINE
        }
        const LAST: [usize; 4] = [
            last_line(size_of::<Node>()),
            last_line(size_of::<SphereBlock>()),
            last_line(size_of::<TriangleBlock>()),
            last_line(BLOCK * size_of::<PolygonFace>()),
        ];
        let bases = [
            self.nodes.as_ptr().cast::<u8>(),
            self.spheres.as_ptr().cast(),
            self.triangles.as_ptr().cast(),
            self.polygons.as_ptr().cast(),
        ];
        let (kind, index) = child.parts();
        let first = bases[kind].wrapping_add(SIZES[kind] * index);
        // To ask for one line twice costs less than to fetch one that nobody reads.
        for line in [0, LINE, 2 * LINE, 3 * LINE] {
            prefetch(first.wrapping_add(LAST[kind].min(line)));
        }
    }

    #[inline(always)]
    pub(crate) fn casts_shadow(&self, id: u32) -> bool {
        !self.shadowless.get(id as usize).copied().unwrap_or(false)
    }

    /// How far a primitive is from the surface that is taken for it: a polygon's corners from its plane.
    pub(crate) fn bend(&self, id: u32) -> f64 {
        self.bends.binary_search_by_key(&id, |bend| bend.0).map_or(0.0, |index| self.bends[index].1)
    }

    /// Memory of everything that a ray reads.
    pub(crate) fn bytes(&self) -> HierarchyBytes {
        HierarchyBytes {
            nodes: size_of_val(self.nodes.as_slice()),
            spheres: size_of_val(self.spheres.as_slice()),
            triangles: size_of_val(self.triangles.as_slice()),
            polygons: size_of_val(self.polygons.as_slice())
                + size_of_val(self.polygon_normals.as_slice())
                + size_of_val(self.bends.as_slice())
                + self.corners.iter().map(|column| size_of_val(column.as_slice())).sum::<usize>(),
        }
    }

    /// Appends the polygons of all their leaves, and has the nodes say where each leaf's begin and how many they are.
    fn add_polygons(&mut self, leaves: &[Leaf], order: Order<'_>) {
        let words: Vec<u32> = leaves
            .iter()
            .map(|&leaf| {
                let first = u32::try_from(self.polygons.len()).unwrap_or(u32::MAX);
                for source in order.of(leaf, Kind::Polygon) {
                    self.add_polygon(source, order.sources.geometry, order.sources.scale);
                }
                first << COUNT_BITS | (leaf.count - 1)
            })
            .collect();
        for child in self.nodes.iter_mut().flat_map(|node| &mut node.children) {
            if let Unpacked::Leaf(Kind::Polygon, leaf) = child.unpack() {
                *child = Child::leaf(Kind::Polygon, words[leaf as usize]);
            }
        }
    }

    fn add_polygon(&mut self, source: usize, geometry: &Geometry, scale: Scale) {
        let polygon = &geometry.polygons[source];
        let corners: Vec<Vec3> =
            polygon.vertices.clone().map(|index| scale.position(geometry.vertices[index as usize])).collect();
        let first = self.corners[0].len();
        for (axis, column) in self.corners.iter_mut().enumerate() {
            column.extend(corners.iter().map(|corner| corner[axis]));
            column.extend(std::iter::repeat_n(corners[0][axis], CORNERS_BEYOND));
        }
        let wide: Vec<DVec3> = corners.iter().map(|corner| corner.as_dvec3()).collect();
        // What has no plane was left out of the scene.
        let normal = polygon_normal(&wide).unwrap_or(DVec3::Z);
        self.polygon_normals[source] = normal;
        let heights = wide.iter().map(|&corner| normal.dot(corner - wide[0]).abs());
        let bend = heights.fold(0.0, f64::max);
        self.bends[source].1 = bend;
        let bounds = bounds_of(&corners);
        let size = (bounds.high - bounds.low).length();
        let next = corners.iter().cycle().skip(1);
        let longest_edge = corners.iter().zip(next).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
        self.polygons.push(PolygonFace {
            normal: normal.as_vec3().to_array(),
            point: corners[0].to_array(),
            size,
            longest_edge,
            slack: touch_distance(size) + 2.0 * rounded(bend),
            id: polygon.id.0,
            first_corner: u32::try_from(first).unwrap_or(u32::MAX),
            edges: polygon.vertices.end - polygon.vertices.start,
            source: u32::try_from(source).unwrap_or(u32::MAX),
        });
    }
}

/// Bytes of the parts of a [`Hierarchy`].
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct HierarchyBytes {
    pub(crate) nodes: usize,
    pub(crate) spheres: usize,
    pub(crate) triangles: usize,
    pub(crate) polygons: usize,
}

impl HierarchyBytes {
    pub(crate) fn total(self) -> usize {
        self.nodes + self.spheres + self.triangles + self.polygons
    }
}

#[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
fn rounded(length: f64) -> f32 {
    length as f32
}

fn largest_coordinate(bounds: Bounds) -> f32 {
    bounds.low.abs().max(bounds.high.abs()).max_element()
}

fn shadowless(scene: &Scene) -> Vec<bool> {
    let mut shadowless = Vec::new();
    if scene.materials.iter().all(|material| material.casts_shadow) {
        return shadowless;
    }
    let ids = scene
        .geometry
        .materials()
        .filter(|(_, material)| !scene.materials[material.0 as usize].casts_shadow)
        .map(|(id, _)| id.0 as usize);
    for id in ids {
        if shadowless.len() <= id {
            shadowless.resize(id + 1, false);
        }
        shadowless[id] = true;
    }
    shadowless
}
