//! Bodies that touch and do not overlap.

use super::bodies::{Body, Face};
use super::grid::{Grid, SQUARE, Style, frame, prism};
use super::settings::Setting;
use crate::random::Random;
use glam::{DVec3, I64Vec3};
use wavelane::scene::{Geometry, MaterialId};

/// Half the ground, in sizes of what stands on it.
const GROUND: i64 = 16;

pub(super) fn contact(random: &mut Random) -> Setting {
    let grid = Grid::random(2 * GROUND, random);
    match random.whole(0, 2) {
        0 => sphere_on_plane(&grid, random),
        1 => brick_on_plane(&grid, random),
        _ => brick_by_brick(&grid, random),
    }
}

/// A quadrilateral around the origin of the grid, as one polygon or as two triangles.
fn add_ground(grid: &Grid, [a, b]: [I64Vec3; 2], geometry: &mut Geometry, random: &mut Random) -> Vec<Face> {
    let corners = vec![-a - b, a - b, a + b, b - a];
    let style = *random.pick(&[Style::Triangles, Style::Polygons]);
    grid.add(&[corners], style, geometry, random)
}

/// A tangent plane whose normal has a whole length: (0, 0, 1), or (1, 2, 2) with its 3, axes and signs at random.
fn sphere_on_plane(grid: &Grid, random: &mut Random) -> Setting {
    let (axes, length) = match random.one_in(3) {
        true => ([I64Vec3::X, I64Vec3::Y, I64Vec3::Z], 1),
        false => ([I64Vec3::new(2, 1, -2), I64Vec3::new(2, -2, 1), I64Vec3::new(-1, -2, -2)], 3),
    };
    let turns = random.whole(0, 2);
    let signs = I64Vec3::from([(); 3].map(|()| *random.pick(&[-1, 1])));
    let turned = |axis: I64Vec3| {
        let [x, y, z] = (axis * signs).to_array();
        I64Vec3::from([[x, y, z], [y, z, x], [z, x, y]][turns as usize])
    };
    let [a, b, n] = axes.map(turned);
    // Signs may have made the frame left-handed.
    let (a, b) = if a.cross(b).dot(n) > 0 { (a, b) } else { (b, a) };
    let steps = grid.size / (2 * length);
    let mut geometry = Geometry::default();
    let ground_first = random.one_in(2);
    let ground = |geometry: &mut Geometry, random: &mut Random| {
        add_ground(grid, [a * steps * GROUND, b * steps * GROUND], geometry, random)
    };
    let mut faces = if ground_first { ground(&mut geometry, random) } else { Vec::new() };
    let center = grid.vertex(n * steps);
    let radius = (grid.world(I64Vec3::X * steps * length) - grid.world(I64Vec3::ZERO)).x;
    geometry.add_sphere(center, radius as f32, MaterialId(0)).unwrap();
    let sphere = Body::Sphere { id: geometry.spheres[0].id, center: center.as_dvec3(), radius };
    if !ground_first {
        faces = ground(&mut geometry, random);
    }
    let contact = grid.world(I64Vec3::ZERO);
    let normal = n.as_dvec3().normalize();
    let along = normal.cross(random.direction()).normalize();
    let angle = random.log_between(1e-6, 1.0);
    let aim = if random.one_in(2) {
        (contact + along * radius * angle, normal)
    } else {
        let outward = along * angle.sin() - normal * angle.cos();
        // Seen from the side, above the plane.
        (center.as_dvec3() + outward * radius, (along + normal * (0.5 * angle)).normalize())
    };
    Setting {
        name: "sphere on a plane",
        geometry,
        bodies: [sphere].into_iter().chain(faces.into_iter().map(Body::Flat)).collect(),
        size: 2.0 * radius,
        center: contact,
        aim,
        to_edge: None,
    }
}

/// A point close to an edge, on either side of it.
fn near_edge(grid: &Grid, from: I64Vec3, to: I64Vec3, across: DVec3, random: &mut Random) -> DVec3 {
    let on_edge = grid.world(from).lerp(grid.world(to), random.unit());
    let away = grid.world_size() * random.log_between(2.0_f64.powi(-30), 0.5);
    on_edge + across * if random.one_in(2) { away } else { -away }
}

/// Its bottom lies in the ground.
fn brick_on_plane(grid: &Grid, random: &mut Random) -> Setting {
    let size = grid.size as f64;
    let [a, b, c] = frame([(); 3].map(|()| size * random.between(0.1, 0.5)), random);
    let mut geometry = Geometry::default();
    let ground_first = random.one_in(2);
    // No larger than 24 bits allow, with a and b as long as the size in all.
    let ground = |geometry: &mut Geometry, random: &mut Random| {
        add_ground(grid, [a * GROUND, b * GROUND], geometry, random)
    };
    let mut faces = if ground_first { ground(&mut geometry, random) } else { Vec::new() };
    let style = *random.pick(&[Style::Triangles, Style::Polygons, Style::Both]);
    // Oblique, and as high as it may be.
    let c = c + (a + b) / 3;
    let brick = grid.add_solid(&prism(&SQUARE, I64Vec3::ZERO, [a, b, c]), style, &mut geometry, random);
    if !ground_first {
        faces = ground(&mut geometry, random);
    }
    let normal = a.cross(b).as_dvec3().normalize();
    let aim = near_edge(grid, I64Vec3::ZERO, a, b.as_dvec3().normalize(), random);
    // From the side where the brick does not hide it, or from above.
    let tilt = if random.one_in(2) { DVec3::ZERO } else { -b.as_dvec3().normalize() };
    let brick = brick.expect("a brick is convex");
    Setting {
        name: "brick on a plane",
        geometry,
        bodies: [brick].into_iter().chain(faces.into_iter().map(Body::Flat)).collect(),
        size: grid.world_size(),
        center: grid.world(I64Vec3::ZERO),
        aim: (aim, (normal + tilt).normalize()),
        to_edge: None,
    }
}

/// They share a part of a plane; the second is as high as the first or half as high.
fn brick_by_brick(grid: &Grid, random: &mut Random) -> Setting {
    let size = grid.size as f64;
    let [a, b, c] = frame([(); 3].map(|()| size * random.between(0.02, 0.12)), random);
    // In quarters, so that the second can begin and end within the first.
    let (long, high) = (a * 4, c * 4);
    let mut geometry = Geometry::default();
    let style = *random.pick(&[Style::Triangles, Style::Polygons, Style::Both]);
    let one =
        grid.add_solid(&prism(&SQUARE, I64Vec3::ZERO, [long, b * 4, high]), style, &mut geometry, random);
    let other_from = b * 4 + a * random.whole(-2, 2);
    let other_high = if random.one_in(2) { high } else { c * 2 };
    let other = prism(&SQUARE, other_from, [long, b * random.whole(1, 4), other_high]);
    let other = grid.add_solid(&other, style, &mut geometry, random);
    let edge_from = b * 4 + if random.one_in(2) { high } else { other_high };
    let across = b.as_dvec3().normalize();
    let normal = a.cross(b).as_dvec3().normalize();
    let aim = near_edge(grid, edge_from, edge_from + long, across, random);
    Setting {
        name: "brick by brick",
        geometry,
        bodies: vec![one.expect("a brick is convex"), other.expect("a brick is convex")],
        size: grid.world_size(),
        center: grid.world(I64Vec3::ZERO),
        aim: (aim, normal),
        to_edge: None,
    }
}
