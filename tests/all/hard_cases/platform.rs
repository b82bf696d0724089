//! What a processor or a build could change: cases 21 and 57 to 59.

use super::case::Shape;
use super::case::ray;
use super::run::*;
#[test]
fn experiment() {
    for leg in [
        1e-12, 1e-15, 1e-16, 1e-17, 1e-18, 3e-19, 1e-19, 1e-20, 1e-21, 1e-22, 1e-23, 1e-25, 1e-30, 1e-38,
        1e-40_f32,
    ] {
        let small = Shape::Triangle([[0.0, 0.0, leg], [leg, 0.0, leg], [0.0, leg, 0.0]]);
        let q = leg / 4.0;
        let poly = Shape::Polygon(vec![[0.0, 0.0, leg], [leg, 0.0, leg], [0.0, leg, 0.0]]);
        let sph = Shape::Sphere([0.0, 0.0, 0.0], leg);
        for shape in [small, poly, sph] {
            for other in [true, false] {
                let mut shapes = vec![shape.clone()];
                if other {
                    shapes.push(Shape::Triangle([[1.0, 0.0, 0.0], [1.5, 0.0, 0.0], [1.0, 1.0, 0.0]]));
                }
                let scene = super::case::scene(&shapes);
                let e = Engines::new(&scene, 1);
                let rays = [
                    ray([q, q, 1.0], [0.0, 0.0, -1.0]),
                    ray([q, q, 4.0 * leg], [0.0, 0.0, -1.0]),
                    ray([q, -1.0, q], [0.0, 1.0, 0.0]),
                ];
                let out: Vec<_> = [ENGINES[0], ENGINES[1], ENGINES[4]]
                    .iter()
                    .flat_map(|&en| {
                        e.answers(&rays, en, Company::Alone)
                            .into_iter()
                            .map(|a| format!("{:?}/{:e}", a.id as i32, f64::from(a.t) / f64::from(leg)))
                            .collect::<Vec<_>>()
                    })
                    .collect();
                println!("{leg:e} {other} {shape:?}\n    {out:?}");
            }
        }
    }
}
