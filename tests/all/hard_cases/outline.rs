//! Outlines on an integer lattice, and where a point lies by integers alone.

/// A star of four points whose corners share their heights with each other; two of its edges are level. Corners at whole
/// numbers, here in halves, as points are.
pub(super) const STAR: [[i16; 2]; 12] = [
    [0, 16],
    [10, 12],
    [8, 0],
    [16, 8],
    [24, 8],
    [32, 2],
    [24, 16],
    [32, 30],
    [20, 20],
    [14, 20],
    [6, 32],
    [8, 20],
];

/// A concave outline of twelve corners, and the two parts of it that a chord makes: whole, one, other.
pub(super) const SPLIT: [&[[i16; 2]]; 3] = [
    &[
        [0, 0],
        [6, 2],
        [12, 0],
        [17, 3],
        [13, 6],
        [18, 9],
        [16, 15],
        [10, 11],
        [7, 16],
        [4, 10],
        [1, 13],
        [3, 6],
    ],
    &[[6, 2], [12, 0], [17, 3], [13, 6], [18, 9], [16, 15], [10, 11]],
    &[[0, 0], [6, 2], [10, 11], [7, 16], [4, 10], [1, 13], [3, 6]],
];

/// Twice the signed area of (p, a, b).
fn turn(p: [i16; 2], a: [i16; 2], b: [i16; 2]) -> i32 {
    let [px, py] = p.map(i32::from);
    let ([ax, ay], [bx, by]) = (a.map(i32::from), b.map(i32::from));
    (ax - px) * (by - py) - (ay - py) * (bx - px)
}

fn edges(outline: &[[i16; 2]]) -> impl Iterator<Item = ([i16; 2], [i16; 2])> {
    let next = outline.iter().cycle().skip(1);
    outline.iter().copied().zip(next.copied())
}

pub(super) fn is_on_edge(outline: &[[i16; 2]], point: [i16; 2]) -> bool {
    edges(outline).any(|(a, b)| {
        let between =
            |axis: usize| point[axis] >= a[axis].min(b[axis]) && point[axis] <= a[axis].max(b[axis]);
        turn(point, a, b) == 0 && between(0) && between(1)
    })
}

/// How often the outline goes around a point that is not on it: quarters of a turn, edge by edge. Of an outline that does
/// not cross itself it is 0 outside.
pub(super) fn winding_number(outline: &[[i16; 2]], point: [i16; 2]) -> i32 {
    let quarter = |[x, y]: [i16; 2]| match (x > point[0], y > point[1]) {
        (true, true) => 0,
        (false, true) => 1,
        (false, false) => 2,
        (true, false) => 3,
    };
    let quarters = edges(outline).map(|(a, b)| match (quarter(b) - quarter(a) + 4) % 4 {
        0 => 0,
        1 => 1,
        3 => -1,
        _ => 2 * turn(point, a, b).signum(),
    });
    quarters.sum::<i32>() / 4
}
