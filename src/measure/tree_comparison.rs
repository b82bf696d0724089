//! Two trees of rays of one pixel side by side, in the order in which the recursion comes to each value, and the first
//! value at which they differ.
//!
//! A number of the engine agrees where it is the f32 nearest to the reference's. One of another size is given in ulps, the
//! spacing of f32 numbers at the size of the largest component: a direction's smallest component is no better known than
//! its largest. A decision is what has no such distance: which primitive is hit and from which side, what a light's shadow
//! ray found, and whether a child was traced.

use crate::ray_tree::{PixelTree, PrimitiveKind, RayTree, Shadow, TreeHit};
use crate::rays::RayKind;
use crate::scene::{MaterialId, PrimitiveId};
use serde::Serialize;

/// Everything that the reference and an engine say of a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct TreeComparison {
    /// In the order of the recursion, sample by sample; the pixel's colour last.
    pub rows: Vec<Row>,
    /// The first row whose values differ, decision or not.
    pub first_difference: Option<usize>,
    /// The first row whose decisions differ: beyond it the trees have no more to do with each other.
    pub parting: Option<usize>,
}

/// One value of a tree, as both have it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Number of the sample, from 0; none for what belongs to the pixel as a whole.
    pub sample: Option<usize>,
    /// The ray that it belongs to.
    pub ray: RayKind,
    /// How many hits lie before that ray.
    pub depth: u32,
    /// What is compared.
    pub quantity: Quantity,
    /// None where the reference has no such thing.
    pub reference: Option<Reading>,
    /// None where the engine has no such thing.
    pub engine: Option<Reading>,
    /// How the two lie to each other.
    pub r#match: Match,
}

/// What is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Whether the ray was traced.
    Ray,
    /// Where it starts.
    Origin,
    /// Where it goes.
    Direction,
    /// Share of what it sees that reaches the eye.
    Weight,
    /// What it hits.
    Hit,
    /// Where along the ray.
    T,
    /// Where in the world.
    Point,
    /// n_g on the side of the ray.
    GeometricNormal,
    /// n_s on the side of the ray; compared where it is not n_g in one of the trees.
    ShadingNormal,
    /// Beer's law; compared where it is not 1 in one of the trees.
    Attenuation,
    /// What the shadow ray to a light found; lights are numbered from 0 in file order.
    Light(usize),
    /// What a visible light adds.
    LightAdds(usize),
    /// Ambient light and what all lights add.
    LocalLight,
    /// What the ray sees.
    Colour,
    /// The mean of the samples.
    PixelColour,
}

/// A value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Reading {
    /// Three numbers.
    Vector([f64; 3]),
    /// A number.
    Number(f64),
    /// What a ray hits; none on a miss.
    Hit(Option<HitDecision>),
    /// What a light's shadow ray found.
    Light(Shadow),
    /// Whether a ray was traced.
    Traced(bool),
}

/// A primitive, and the side from which it is hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct HitDecision {
    /// What is hit.
    pub kind: PrimitiveKind,
    /// Which one.
    pub primitive: PrimitiveId,
    /// Its index among the scene's materials.
    pub material: MaterialId,
    /// From outside.
    pub entering: bool,
}

/// How an engine's value lies to the reference's.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Match {
    /// The same decision, or the f32 that is nearest to the reference's number.
    Same,
    /// Another number.
    Off {
        /// The largest difference of a component, in spacings of f32 numbers at the largest component.
        ulps: f64,
    },
    /// Another decision.
    Parted,
    /// Only one of the trees has it, after they have parted.
    OneSided,
}

impl TreeComparison {
    /// Puts the two trees of one pixel side by side.
    #[must_use]
    pub fn new(reference: &PixelTree, engine: &PixelTree) -> Self {
        let mut walk = Walk { rows: Vec::new(), sample: None };
        for sample in 0..reference.samples.len().max(engine.samples.len()) {
            walk.sample = Some(sample);
            walk.ray(RayKind::Primary, 0, [reference, engine].map(|tree| tree.samples.get(sample)));
        }
        walk.sample = None;
        let colours = [reference, engine].map(|tree| Some(Reading::Vector(tree.colour)));
        walk.push(RayKind::Primary, 0, Quantity::PixelColour, colours);
        let rows = walk.rows;
        let first_difference = rows.iter().position(|row| row.r#match != Match::Same);
        let parting = rows.iter().position(|row| row.r#match == Match::Parted);
        Self { rows, first_difference, parting }
    }
}

struct Walk {
    rows: Vec<Row>,
    sample: Option<usize>,
}

impl Walk {
    /// Appends a value that at least one of the trees has.
    fn push(
        &mut self,
        ray: RayKind,
        depth: u32,
        quantity: Quantity,
        [reference, engine]: [Option<Reading>; 2],
    ) {
        let r#match = match (&reference, &engine) {
            (None, None) => return,
            (Some(reference), Some(engine)) => reference.compared_with(engine),
            _ => Match::OneSided,
        };
        self.rows.push(Row { sample: self.sample, ray, depth, quantity, reference, engine, r#match });
    }

    /// A ray and all of its descendants, in the order in which they are traced; what it sees comes last.
    fn ray(&mut self, kind: RayKind, depth: u32, rays: [Option<&RayTree>; 2]) {
        if rays == [None; 2] {
            return;
        }
        self.push(kind, depth, Quantity::Ray, rays.map(|ray| Some(Reading::Traced(ray.is_some()))));
        let mut push = |quantity, read: fn(&RayTree) -> Reading| {
            self.push(kind, depth, quantity, rays.map(|ray| ray.map(read)));
        };
        push(Quantity::Origin, |ray| Reading::Vector(ray.origin));
        push(Quantity::Direction, |ray| Reading::Vector(ray.direction));
        push(Quantity::Weight, |ray| Reading::Vector(ray.weight));
        push(Quantity::Hit, |ray| Reading::Hit(ray.hit.as_ref().map(HitDecision::of)));
        self.hit(kind, depth, rays.map(|ray| ray.and_then(|ray| ray.hit.as_ref())));
        self.ray(RayKind::Reflect, depth + 1, rays.map(|ray| ray.and_then(|ray| ray.reflect.as_deref())));
        self.ray(RayKind::Refract, depth + 1, rays.map(|ray| ray.and_then(|ray| ray.refract.as_deref())));
        let colours = rays.map(|ray| ray.map(|ray| Reading::Vector(ray.colour)));
        self.push(kind, depth, Quantity::Colour, colours);
    }

    fn hit(&mut self, kind: RayKind, depth: u32, hits: [Option<&TreeHit>; 2]) {
        let is_any = |is_so: fn(&TreeHit) -> bool| hits.into_iter().flatten().any(is_so);
        let has_shading_normal = is_any(|hit| hit.shading_normal != hit.geometric_normal);
        let is_attenuated = is_any(|hit| hit.attenuation != [1.0; 3]);
        let mut push = |quantity, read: fn(&TreeHit) -> Reading| {
            self.push(kind, depth, quantity, hits.map(|hit| hit.map(read)));
        };
        push(Quantity::T, |hit| Reading::Number(hit.t));
        push(Quantity::Point, |hit| Reading::Vector(hit.point));
        push(Quantity::GeometricNormal, |hit| Reading::Vector(hit.geometric_normal));
        if has_shading_normal {
            push(Quantity::ShadingNormal, |hit| Reading::Vector(hit.shading_normal));
        }
        if is_attenuated {
            push(Quantity::Attenuation, |hit| Reading::Vector(hit.attenuation));
        }
        let count = hits.into_iter().flatten().map(|hit| hit.lights.len()).max();
        for light in 0..count.unwrap_or(0) {
            let lights = hits.map(|hit| hit.and_then(|hit| hit.lights.get(light)));
            let verdicts = lights.map(|light| light.map(|light| Reading::Light(light.shadow)));
            self.push(kind, depth, Quantity::Light(light), verdicts);
            let visible = lights.map(|light| light.filter(|light| light.shadow == Shadow::Visible));
            let adds = visible.map(|light| light.map(|light| Reading::Vector(light.adds)));
            self.push(kind, depth, Quantity::LightAdds(light), adds);
        }
        let local_light = hits.map(|hit| hit.map(|hit| Reading::Vector(hit.local_light)));
        self.push(kind, depth, Quantity::LocalLight, local_light);
    }
}

impl HitDecision {
    fn of(hit: &TreeHit) -> Self {
        let TreeHit { kind, primitive, material, entering, .. } = *hit;
        Self { kind, primitive, material, entering }
    }
}

impl Reading {
    /// How an engine's value lies to this one of the reference.
    fn compared_with(&self, engine: &Self) -> Match {
        match (self, engine) {
            (Self::Vector(reference), Self::Vector(engine)) => compare(reference, engine),
            (Self::Number(reference), Self::Number(engine)) => compare(&[*reference], &[*engine]),
            _ if self == engine => Match::Same,
            _ => Match::Parted,
        }
    }
}

fn compare(reference: &[f64], engine: &[f64]) -> Match {
    let pairs = || reference.iter().zip(engine);
    if pairs().all(|(&reference, &engine)| nearest_f32(reference) == engine) {
        return Match::Same;
    }
    let difference = pairs().map(|(reference, engine)| (reference - engine).abs()).fold(0.0, f64::max);
    let size = pairs().map(|(reference, engine)| reference.abs().max(engine.abs())).fold(0.0, f64::max);
    // Beside an infinite number every other one is infinitely far off.
    Match::Off { ulps: if size.is_finite() { difference / spacing(size) } else { f64::INFINITY } }
}

fn nearest_f32(value: f64) -> f64 {
    #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
    let nearest = value as f32;
    f64::from(nearest)
}

/// Between an f32 number of this size and the next larger one.
fn spacing(size: f64) -> f64 {
    // In steps of the smallest subnormal number, 2⁻¹⁴⁹, below the smallest normal one.
    let exponent = ((size.to_bits() >> 52).cast_signed() - 1023).max(-126) - 23;
    f64::from_bits(u64::try_from(exponent + 1023).unwrap_or(0) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ray_tree::TreeLight;

    /// Two mirrors in front of each other, and a ray that goes from one to the other and then away; every number is an f32.
    fn tree() -> PixelTree {
        let miss = RayTree {
            origin: [0.0, 0.0, 2.0],
            direction: [0.0, 1.0, 0.0],
            weight: [0.25; 3],
            hit: None,
            reflect: None,
            refract: None,
            colour: [0.5; 3],
        };
        let hit = TreeHit {
            kind: PrimitiveKind::Sphere,
            primitive: PrimitiveId(3),
            material: MaterialId(0),
            entering: true,
            t: 2.0,
            point: [0.0, 0.0, 2.0],
            geometric_normal: [0.0, 0.0, -1.0],
            shading_normal: [0.0, 0.0, -1.0],
            attenuation: [1.0; 3],
            lights: vec![
                TreeLight { shadow: Shadow::Visible, adds: [0.125; 3] },
                TreeLight { shadow: Shadow::Hidden, adds: [0.0; 3] },
            ],
            local_light: [0.125; 3],
        };
        let first = RayTree {
            origin: [0.0; 3],
            direction: [0.0, 0.0, 1.0],
            weight: [0.5; 3],
            hit: Some(hit.clone()),
            reflect: Some(Box::new(miss)),
            refract: None,
            colour: [0.375; 3],
        };
        let primary = RayTree { weight: [1.0; 3], reflect: Some(Box::new(first.clone())), ..first };
        PixelTree { colour: [0.3125; 3], samples: vec![primary.clone(), primary] }
    }

    /// The sample, ray, depth and quantity of the first difference and of the parting, once a change is made to the engine's
    /// tree.
    type Place = (Option<usize>, RayKind, u32, Quantity);
    fn places(change: impl FnOnce(&mut PixelTree)) -> [Option<Place>; 2] {
        let reference = tree();
        let mut engine = tree();
        change(&mut engine);
        let found = TreeComparison::new(&reference, &engine);
        [found.first_difference, found.parting].map(|row| {
            row.map(|row| &found.rows[row]).map(|row| (row.sample, row.ray, row.depth, row.quantity))
        })
    }

    fn child(tree: &mut PixelTree, sample: usize) -> &mut RayTree {
        tree.samples[sample].reflect.as_mut().unwrap()
    }

    fn child_hit(tree: &mut PixelTree) -> &mut TreeHit {
        child(tree, 0).hit.as_mut().unwrap()
    }

    #[test]
    fn a_tree_does_not_differ_from_itself() {
        assert_eq!(places(|_| ()), [None, None]);
    }

    #[test]
    fn the_first_value_that_differs_is_found_and_rounding_parts_nothing() {
        use Quantity::{Colour, Direction, Light, LightAdds, PixelColour, Point, T};
        let (up, at) = (1.0 + f64::from(f32::EPSILON), RayKind::Reflect);
        assert_eq!(places(|tree| child_hit(tree).t *= up), [Some((Some(0), at, 1, T)), None]);
        assert_eq!(places(|tree| child_hit(tree).point[2] *= up), [Some((Some(0), at, 1, Point)), None]);
        let found = places(|tree| child_hit(tree).lights[0].adds[1] *= up);
        assert_eq!(found, [Some((Some(0), at, 1, LightAdds(0))), None]);
        let found = places(|tree| child(tree, 1).direction[2] *= up);
        assert_eq!(found, [Some((Some(1), at, 1, Direction)), None]);
        let found = places(|tree| tree.colour[0] *= up);
        assert_eq!(found, [Some((None, RayKind::Primary, 0, PixelColour)), None]);
        // What a ray sees comes after what its descendants see, and before what its parent sees.
        let found = places(|tree| {
            tree.samples[0].colour[0] *= up;
            child(tree, 0).colour[0] *= up;
            child_hit(tree).lights[1].shadow = Shadow::NotTraced;
        });
        assert_eq!(found, [Some((Some(0), at, 1, Light(1))); 2]);
        let found = places(|tree| {
            tree.samples[0].colour[0] *= up;
            child(tree, 0).reflect.as_mut().unwrap().colour[0] *= up;
        });
        assert_eq!(found, [Some((Some(0), at, 2, Colour)), None]);
    }

    #[test]
    fn trees_part_at_the_first_decision_that_differs_after_any_rounding() {
        use Quantity::{Hit, Light, Origin, Ray};
        let at = RayKind::Reflect;
        let found = places(|tree| {
            child(tree, 0).origin[0] += 1e-7;
            child_hit(tree).primitive = PrimitiveId(4);
            child(tree, 1).hit = None;
        });
        assert_eq!(found, [Some((Some(0), at, 1, Origin)), Some((Some(0), at, 1, Hit))]);
        assert_eq!(places(|tree| child_hit(tree).entering = false), [Some((Some(0), at, 1, Hit)); 2]);
        assert_eq!(places(|tree| child(tree, 0).hit = None), [Some((Some(0), at, 1, Hit)); 2]);
        let found = places(|tree| child_hit(tree).lights[1].shadow = Shadow::Visible);
        assert_eq!(found, [Some((Some(0), at, 1, Light(1))); 2]);
        assert_eq!(places(|tree| child(tree, 0).reflect = None), [Some((Some(0), at, 2, Ray)); 2]);
        let found = places(|tree| child(tree, 0).refract = child(tree, 0).reflect.clone());
        assert_eq!(found, [Some((Some(0), RayKind::Refract, 2, Ray)); 2]);
    }

    #[test]
    fn a_number_agrees_where_it_is_the_nearest_f32() {
        let third = f64::from(1.0_f32 / 3.0);
        assert_eq!(compare(&[1.0 / 3.0], &[third]), Match::Same);
        assert_eq!(compare(&[0.0], &[-0.0]), Match::Same);
        assert_eq!(compare(&[1e60], &[f64::INFINITY]), Match::Same, "as f32 has it");
        assert_eq!(compare(&[f64::INFINITY], &[1.0]), Match::Off { ulps: f64::INFINITY });
        // f32 numbers from 1/4 to 1/2 are 2⁻²⁵ apart, from 1 to 2 2⁻²³, and the smallest ones 2⁻¹⁴⁹.
        let ulps = |reference: &[f64], engine: &[f64]| match compare(reference, engine) {
            Match::Off { ulps } => ulps,
            other => panic!("{other:?}"),
        };
        assert_eq!(ulps(&[third], &[third + 3.0 / f64::from(1 << 25)]), 3.0);
        assert_eq!(ulps(&[1.5, 1e-9, 0.0], &[1.5, 1e-9, 1.0 / f64::from(1 << 22)]), 2.0);
        assert_eq!(ulps(&[0.0], &[f64::from(f32::from_bits(5))]), 5.0);
    }
}
