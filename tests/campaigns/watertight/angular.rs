//! Closed surfaces with flat sides: cubes, prisms over concave outlines, and boxes of a lattice's squares.

use super::solid::{Made, Solid, prism};
use crate::random::Random;
use glam::{DVec2, DVec3};
use std::collections::HashMap;
use std::f64::consts::TAU;

/// Of six sides, each made as its number says.
pub(super) fn cube(made: impl Fn(usize) -> Made) -> Solid {
    let corner = |at: usize| [0, 1, 2].map(|axis| if at >> axis & 1 == 1 { 1.0 } else { -1.0 });
    let mut solid = Solid::new((0..8).map(|at| DVec3::from(corner(at))).collect(), vec![DVec3::ZERO]);
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    for (side, corners) in sides.into_iter().enumerate() {
        solid.add_quad(side, corners, made(side));
    }
    solid
}

/// One side has a corner more than it needs, on a straight edge.
pub(super) fn l_prism(sides: Made) -> Solid {
    let outline = [(0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)].map(on_grid);
    prism(&outline, &[DVec2::splat(0.5), DVec2::new(1.5, 0.4), DVec2::new(0.6, 1.5)], None, sides)
}

pub(super) fn u_prism(sides: Made) -> Solid {
    let outline = [(0, 0), (3, 0), (3, 3), (2, 3), (2, 1), (1, 1), (1, 3), (0, 3)].map(on_grid);
    let inside = [(0.5, 0.5), (1.5, 0.6), (2.5, 0.4), (0.4, 2.0), (2.6, 2.0)].map(DVec2::from);
    prism(&outline, &inside, None, sides)
}

/// A slab with a column on it, at its edge. The slab's top is a U whose plane cuts the column between the U's arms: from there
/// rays in that plane have an arm before and one behind them.
pub(super) fn column_on_a_slab() -> Solid {
    let u = [(0, 0), (3, 0), (3, 3), (2, 3), (2, 1), (1, 1), (1, 3), (0, 3)].map(on_grid);
    let bottom = [u[0], u[1], u[2], u[7]].map(|point| point.extend(-1.0));
    let top = [u[3], u[4], u[5], u[6]].map(|point| point.extend(1.0));
    let corners = bottom.into_iter().chain(u.map(|point| point.extend(0.0))).chain(top).collect();
    let inside = [(1.5, 1.5, -0.5), (1.5, 2.0, 0.5), (0.5, 0.5, -0.5)].map(DVec3::from);
    let mut solid = Solid::new(corners, inside.to_vec());
    let faces: [&[usize]; 10] = [
        &[0, 3, 2, 1],
        &[4, 5, 6, 7, 8, 9, 10, 11],
        &[14, 13, 12, 15],
        &[8, 7, 12, 13],
        &[10, 9, 14, 15],
        &[9, 8, 13, 14],
        &[3, 0, 4, 11],
        &[1, 2, 6, 5],
        &[0, 1, 5, 4],
        &[2, 3, 11, 10, 15, 12, 7, 6],
    ];
    for (strip, face) in faces.into_iter().enumerate() {
        solid.add(strip, face);
    }
    solid
}

fn on_grid((x, y): (i32, i32)) -> DVec2 {
    DVec2::new(x.into(), y.into())
}

/// Over a star of 5 to 9 points.
pub(super) fn star_prism(random: &mut Random, caps: Made, sides: Made) -> Solid {
    let points = 5 + random.below(5);
    let outline: Vec<DVec2> = (0..2 * points)
        .map(|at| {
            let radius = if at % 2 == 0 { 1.0 } else { random.between(0.35, 0.6) };
            radius * DVec2::from_angle(TAU * at as f64 / (2 * points) as f64)
        })
        .collect();
    let middle = (caps == Made::Triangles).then_some(DVec2::ZERO);
    prism(&outline, &[DVec2::ZERO], middle, sides)
}

/// A cube of cells × cells squares a side, all corners whole numbers. A square is made as its side, column and row say.
pub(super) fn lattice(cells: usize, made: impl Fn([usize; 3]) -> Made) -> Solid {
    let mut solid = Solid::new(Vec::new(), vec![DVec3::splat(cells as f64 / 2.0)]);
    solid.lattice = Some(cells);
    let mut numbers = HashMap::new();
    for side in 0..6 {
        let (axis, is_high) = (side / 2, side % 2 == 1);
        for (column, row) in (0..cells).flat_map(|column| (0..cells).map(move |row| (column, row))) {
            let mut corner = |column: usize, row: usize| {
                let mut at = [0; 3];
                at[axis] = if is_high { cells } else { 0 };
                at[(axis + 1) % 3] = column;
                at[(axis + 2) % 3] = row;
                *numbers.entry(at).or_insert_with(|| {
                    solid.corners.push(DVec3::from(at.map(|number| number as f64)));
                    solid.corners.len() - 1
                })
            };
            let [a, b] = [corner(column, row), corner(column + 1, row)];
            let [c, d] = [corner(column + 1, row + 1), corner(column, row + 1)];
            let square = if is_high { [a, b, c, d] } else { [a, d, c, b] };
            // The diagonals of triangles run either way.
            let [a, b, c, d] = square;
            let square = if (column + row) % 3 == 0 { [b, c, d, a] } else { [a, b, c, d] };
            solid.add_quad(side * cells + column, square, made([side, column, row]));
        }
    }
    solid
}
