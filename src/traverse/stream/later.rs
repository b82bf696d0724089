//! Leaves that are visited a little later than their turn, so that the memory that was asked for has come by then.
//!
//! What lies in the leaves of a node is asked for when the node is visited, and the first of them comes next: at a terrain of
//! 2 million triangles a sixth of the time of shadow rays was waiting for blocks. Shadow rays may meet leaves in any order, and
//! were 1.09 times as fast there, at tetrahedra 1.08, elsewhere 0.97 to 1.01. Closest hits cut rays short, and the later the less:
//! mirror and diffuse rays at 0.95 of the speed, but for those of a large terrain, 1.02 to 1.07 (2026-11).

use super::MOST_IN_TILES;
use crate::prepare::Place;

/// Leaves that wait; a power of two.
const WAITING: usize = 8;

/// Numbers of rays, and as many more as may be read beyond the last.
const ROOM: usize = MOST_IN_TILES + 8;

/// A leaf, and the rays that meet it.
pub(super) struct Visit {
    pub(super) leaf: Place,
    numbers: [u32; ROOM],
    count: usize,
}

impl Visit {
    /// Numbers of rays, and how many of these meet the leaf.
    #[inline(always)]
    pub(super) fn list(&self) -> (&[u32], usize) {
        (&self.numbers, self.count)
    }
}

/// Visits in the order in which they came.
pub(super) struct Later {
    visits: [Visit; WAITING],
    first: usize,
    waiting: usize,
}

impl Later {
    pub(super) fn new() -> Self {
        const NONE: Visit = Visit { leaf: Place::Node(0), numbers: [0; ROOM], count: 0 };
        Self { visits: [NONE; WAITING], first: 0, waiting: 0 }
    }

    #[inline(always)]
    pub(super) fn is_full(&self) -> bool {
        self.waiting == WAITING
    }

    /// Takes a visit in, for so many of a list that goes on; there must be room.
    #[inline(always)]
    pub(super) fn push(&mut self, leaf: Place, (list, count): (&[u32], usize)) {
        let visit = &mut self.visits[(self.first + self.waiting) % WAITING];
        (visit.leaf, visit.count) = (leaf, count);
        visit.numbers.copy_from_slice(&list[..ROOM]);
        self.waiting += 1;
    }

    /// Hands out the first.
    #[inline(always)]
    pub(super) fn pop(&mut self) -> Option<&Visit> {
        let first = self.first;
        self.waiting = self.waiting.checked_sub(1)?;
        self.first = (first + 1) % WAITING;
        Some(&self.visits[first])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn visits_come_out_in_their_order() {
        let mut later = Later::new();
        let mut came = Vec::new();
        let list: Vec<u32> = (0..100).collect();
        let mut come = |later: &mut Later| {
            let visit = later.pop()?;
            let Place::Triangles(index) = visit.leaf else { return None };
            came.push(index);
            assert_eq!(visit.list(), (&list[index..index + ROOM], 1 + index % 7));
            Some(())
        };
        for index in 0..40 {
            if later.is_full() {
                come(&mut later);
            }
            later.push(Place::Triangles(index), (&list[index..], 1 + index % 7));
            assert_eq!(later.is_full(), index + 1 >= WAITING);
        }
        while come(&mut later).is_some() {}
        assert_eq!(came, (0..40).collect::<Vec<_>>());
    }
}
