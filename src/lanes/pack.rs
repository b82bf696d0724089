//! Lanes put side by side that were chosen by a mask, for lists.

use wide::{i32x4, i32x8, i32x16, u32x8};

/// See [`super::Single::pack_ids`].
pub(super) trait Packed {
    fn pack(self, bits: u32, to: &mut [u32]);
}

/// For each mask of eight lanes, those that are in it, in order; then anything.
static CHOSEN: [[u32; 8]; 256] = {
    let mut table = [[0; 8]; 256];
    let mut mask = 0;
    while mask < 256 {
        let (mut count, mut lane) = (0, 0);
        while lane < 8 {
            if mask >> lane & 1 == 1 {
                table[mask][count] = lane;
                count += 1;
            }
            lane += 1;
        }
        mask += 1;
    }
    table
};

impl Packed for i32x8 {
    #[inline(always)]
    fn pack(self, bits: u32, to: &mut [u32]) {
        let ids: u32x8 = bytemuck::cast(self);
        if cfg!(target_feature = "avx2") {
            let packed = ids.shuffle(u32x8::new(CHOSEN[bits as usize & 255]));
            to[..8].copy_from_slice(&packed.to_array());
        } else {
            pack_each(&ids.to_array(), bits, to);
        }
    }
}

impl Packed for i32x4 {
    #[inline(always)]
    fn pack(self, bits: u32, to: &mut [u32]) {
        pack_each(bytemuck::cast_ref::<_, [u32; 4]>(&self.to_array()), bits, to);
    }
}

impl Packed for i32x16 {
    #[inline(always)]
    fn pack(self, bits: u32, to: &mut [u32]) {
        let [low, high]: [i32x8; 2] = bytemuck::cast(self);
        low.pack(bits & 255, to);
        high.pack(bits >> 8, &mut to[(bits & 255).count_ones() as usize..]);
    }
}

/// Without a branch: what is not chosen is written over.
#[inline(always)]
fn pack_each(ids: &[u32], bits: u32, to: &mut [u32]) {
    let mut count = 0;
    for (lane, &id) in ids.iter().enumerate() {
        to[count] = id;
        count += (bits >> lane & 1) as usize;
    }
}

#[cfg(test)]
mod tests {
    use crate::lanes::{Job, Single, Width};

    struct Packs;

    impl Job for Packs {
        type Output = ();

        fn run<F: Single>(self) {
            let ids: Vec<u32> = (1000..1016).collect();
            for bits in 0..1_u32 << F::WIDTH {
                // Up to the last lane's place there is room, and beyond it nothing is written.
                let mut to = [7; 17];
                F::pack_ids(F::load_ids(&ids), bits, &mut to[..F::WIDTH]);
                let chosen: Vec<u32> =
                    (0..F::WIDTH).filter(|lane| bits >> lane & 1 == 1).map(|lane| ids[lane]).collect();
                assert_eq!(to[..chosen.len()], chosen, "{bits:b} of {}", F::WIDTH);
                assert!(to[F::WIDTH..].iter().all(|&id| id == 7));
            }
        }
    }

    #[test]
    fn lanes_of_any_mask_come_one_after_the_other() {
        for width in Width::ALL {
            width.run(Packs);
        }
    }
}
