//! Secondary rays from surfaces of which geometry says, without a tolerance, what they meet: nothing, or one wall. A ray that
//! meets what it leaves is a self-hit, and shows as acne; one that misses the wall is lost light, or a leak.
//!
//! Frames are rendered as ever, with their rays recorded; what the engine found for each ray is held against the verdict of
//! geometry (`verdicts`). All sizes from 2⁻²⁰ to 2²⁰, up to 2¹⁶ sizes from the origin, seen from 2 to 10⁴ sizes away, down to
//! 89.99° off the normal and next to edges:
//!
//! - a sphere, a triangle, a polygon alone: nothing is met from outside, from inside a sphere its far side;
//! - closed convex solids: nothing is met from outside, from inside another wall, which is left by its inner side;
//! - the inside of their edges, at angles down to 10⁻⁶: nothing leaves;
//! - bodies that touch: what is touched is not met at the start, but farther on.

mod bodies;
mod contacts;
mod exact;
mod frames;
mod grid;
mod judge;
mod naive;
mod settings;
mod table;
mod verdicts;
mod views;

use crate::random::Random;
use frames::{Frames, run};
use settings::{alone, solid};
use views::Eye;

/// Of the rays that a run affords.
fn share(parts: u64) -> u64 {
    crate::ray_budget(16_000_000) / parts
}

#[test]
fn what_stands_alone_never_meets_itself() {
    let setting = |random: &mut Random| {
        let setting = alone(random);
        let eye = if setting.name == "sphere" && random.one_in(2) { Eye::Inside } else { Eye::Outside };
        (setting, eye)
    };
    run(&Frames { name: "alone", first_seed: 0, rays: share(4), setting: &setting });
}

#[test]
fn convex_solids_never_meet_themselves_from_outside_and_always_from_inside() {
    let setting = |random: &mut Random| {
        let eye = *random.pick(&[Eye::Outside, Eye::Outside, Eye::Inside]);
        (solid(false, random), eye)
    };
    run(&Frames { name: "solids", first_seed: 1 << 32, rays: share(4), setting: &setting });
}

#[test]
fn no_ray_leaves_a_room_by_its_edges() {
    let setting = |random: &mut Random| (solid(true, random), Eye::AtEdge);
    run(&Frames { name: "rooms", first_seed: 2 << 32, rays: share(4), setting: &setting });
}

#[test]
fn what_touches_is_not_met_at_the_start_but_farther_on() {
    let setting = |random: &mut Random| {
        let eye = *random.pick(&[Eye::Outside, Eye::Outside, Eye::Outside, Eye::Inside]);
        (contacts::contact(random), eye)
    };
    run(&Frames { name: "contacts", first_seed: 3 << 32, rays: share(4), setting: &setting });
}
