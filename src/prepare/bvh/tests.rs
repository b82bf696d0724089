//! What every tree must be, whatever it is built of.
use super::*;
use glam::Vec3;

fn bench_items(n: u32, kinds: u32) -> Vec<Item> {
    let mut s = 12345_u64;
    let mut r = || { s = s.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407); (s >> 40) as f32 / (1u64<<24) as f32 };
    let size = 2.0 / (n as f32).cbrt();
    (0..n).map(|i| {
        let c = Vec3::new(r(), r(), r());
        let p = [(); 3].map(|()| c + size * Vec3::new(r(), r(), r()));
        Item { bounds: Bounds { low: p[0].min(p[1]).min(p[2]), high: p[0].max(p[1]).max(p[2]) },
          kind: if kinds == 1 { Kind::Triangle } else {[Kind::Sphere, Kind::Triangle, Kind::Polygon][(i % 3) as usize]}, weight: 1 }
    }).collect()
}
const COSTS: Costs = Costs { node: 1.0, block: [1.0, 1.0, 1.0], room: [4.0, 4.0, 1.0], largest_leaf: 4 };

#[test]
#[ignore]
fn speed() {
    for n in [100_000, 2_000_000] { for kinds in [1, 3] {
        let items = bench_items(n, kinds);
        for threads in [1, 2] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let mut best = 1e9_f64;
            let mut tree = None;
            let mut bb=0.0;
            for _ in 0..3 {
                let t = std::time::Instant::now();
                let b = pool.install(|| binary::build(&items, &COSTS));
                let tb = t.elapsed().as_secs_f64();
                let tr = pool.install(|| collapse::collapse(b));
                let e = t.elapsed().as_secs_f64();
                if e < best { best = e; bb=tb; }
                tree = Some(tr);
            }
            let tree = tree.unwrap();
            let used: usize = tree.nodes.iter().map(|n| n.children.iter().filter(|c| **c != Child::EMPTY).count()).sum();
            println!("n {n} kinds {kinds} threads {threads}: {:.2} M/s (binary {:.0} ms, all {:.0} ms) leaf fill {:.2} children {:.2} nodes {} depth {} sah {:.3}", f64::from(n) / best / 1e6, bb*1e3, best*1e3, f64::from(n) / tree.leaves.len() as f64, used as f64 / tree.nodes.len() as f64, tree.nodes.len(), tree.depth, sah_cost(&tree, &COSTS));
        }
    }}
}
