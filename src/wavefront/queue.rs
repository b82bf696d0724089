//! Every queue and its columns.
//!
//! A queue is pushed to by record and read by lanes. Its rows are allocated once, from a bound on what a stage can put into
//! it, and used again for every batch; a queue that a scene does not need has no rows. Positions and lengths are in the
//! scale of `prepare` (the largest coordinate lies in [1, 2)), directions have the world's axes, colours are linear RGB.

use super::column::Field;
use serde::Serialize;

/// A column as `explain` shows it.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ColumnPlan {
    /// Its name.
    pub name: &'static str,
    /// What it holds, with unit and space.
    pub what: &'static str,
    /// As what numbers.
    pub r#type: &'static str,
    /// Bytes a row.
    pub bytes: usize,
}

/// A queue as `explain` shows it.
#[derive(Clone, Debug, Serialize)]
pub struct QueuePlan {
    /// Its name.
    pub name: &'static str,
    /// Rows that it has room for; 0 where the scene does not need it.
    pub rows: usize,
    /// Memory.
    pub bytes: usize,
    /// What its rows are made of.
    pub columns: &'static [ColumnPlan],
}

macro_rules! queue {
    (
        $(#[doc = $queue_doc:literal])+
        $queue:ident of $record:ident {
            $($(#[doc = $doc:literal])+ $field:ident: $type:ty,)+
        }
    ) => {
        $(#[doc = $queue_doc])+
        pub(crate) struct $queue {
            $($(#[doc = $doc])+ pub(crate) $field: <$type as Field>::Columns,)+
            #[allow(dead_code, reason = "not of queues that lie row by row beside another")]
            len: usize,
            capacity: usize,
        }

        #[doc = concat!("A row of [`", stringify!($queue), "`].")]
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub(crate) struct $record {
            $($(#[doc = $doc])+ pub(crate) $field: $type,)+
        }

        #[allow(dead_code, reason = "a queue has them all, and its stages use some")]
        impl $queue {
            pub(crate) const COLUMNS: &[ColumnPlan] = &[$(ColumnPlan {
                name: stringify!($field),
                what: concat!($($doc),+).trim_ascii(),
                r#type: <$type as Field>::TYPE,
                bytes: size_of::<$type>(),
            }),+];

            /// Room for rows, and for lanes to read beyond them.
            pub(crate) fn with_capacity(rows: usize) -> Self {
                let rows = rows.next_multiple_of(crate::traverse::RUN);
                Self { $($field: <$type as Field>::columns(rows),)+ len: 0, capacity: rows }
            }

            pub(crate) fn clear(&mut self) {
                self.len = 0;
            }

            pub(crate) fn len(&self) -> usize {
                self.len
            }

            /// Sets the number of rows, for a stage that writes lanes of them at once.
            pub(crate) fn set_len(&mut self, len: usize) {
                assert!(len <= self.capacity, concat!(stringify!($queue), " holds more rows than it was given room for"));
                self.len = len;
            }

            /// Appends a row, and returns where it is. The room was reserved from a bound on what its stage emits.
            #[inline(always)]
            pub(crate) fn push(&mut self, record: $record) -> u32 {
                let row = self.len;
                self.put(row, record);
                self.len = row + 1;
                #[expect(clippy::cast_possible_truncation, reason = "a batch has some thousand rows")]
                let row = row as u32;
                row
            }

            /// Writes a row.
            #[inline(always)]
            pub(crate) fn put(&mut self, row: usize, record: $record) {
                $(record.$field.put(&mut self.$field, row);)+
            }

            pub(crate) fn get(&self, row: usize) -> $record {
                $record { $($field: <$type as Field>::get(&self.$field, row),)+ }
            }

            pub(crate) fn plan(&self) -> QueuePlan {
                QueuePlan { name: stringify!($queue), rows: self.capacity, bytes: self.bytes(), columns: Self::COLUMNS }
            }

            fn bytes(&self) -> usize {
                0 $(+ <$type as Field>::bytes(&self.$field))+
            }
        }
    };
}

queue! {
    /// Rays to be traced.
    RayQueue of RayRecord {
        /// start, scene scale
        origin: [f32; 3],
        /// unit length
        direction: [f32; 3],
    }
}

queue! {
    /// What rays beyond the primary ones have in addition, row by row.
    DepartureQueue of DepartureRecord {
        /// twice the id of the primitive that the ray starts on, plus 1 if it goes inside
        departure: u32,
        /// what the start's rounding to f32 left out
        origin_low: [f32; 3],
        /// share of what the ray sees that reaches the eye, linear RGB
        weight: [f32; 3],
    }
}

queue! {
    /// Where rays end, row by row.
    HitQueue of HitRecord {
        /// along the ray, in units of its direction; infinite on a miss
        t: f32,
        /// primitive; 2³² − 1 on a miss
        id: u32,
    }
}

queue! {
    /// Points that rays have hit.
    SurfaceQueue of SurfaceRecord {
        /// row of the ray
        ray: u32,
        /// departure of a ray that stays on this side of the surface; the other side's has the lowest bit turned
        departure: u32,
        /// index of the material
        material: u32,
        /// of the ray, unit length
        direction: [f32; 3],
        /// the point, scene scale
        position: [f32; 3],
        /// what its rounding to f32 left out
        position_low: [f32; 3],
        /// n_g, unit, on the side that the ray comes from
        geometric_normal: [f32; 3],
    }
}

queue! {
    /// Normals that vertices give, row by row of the surfaces.
    NormalQueue of NormalRecord {
        /// n_s, unit, on the side that the ray comes from
        shading_normal: [f32; 3],
    }
}

queue! {
    /// Shadow rays of one light.
    ShadowQueue of ShadowRecord {
        /// start, scene scale
        origin: [f32; 3],
        /// what its rounding to f32 left out
        origin_low: [f32; 3],
        /// to a point light the whole way, divided by a power of two; to a directional one unit length
        direction: [f32; 3],
        /// twice the id of the primitive that the ray starts on, plus 1 if it goes inside
        departure: u32,
        /// where the segment ends: that power of two, or infinite; −1 once it is known to be occluded
        t: f32,
        /// row of the surface
        surface: u32,
        /// what the surface gains if the light is visible, linear RGB
        light: [f32; 3],
    }
}

queue! {
    /// Refracted rays that wait for their turn, after the reflected ones; row by row of the surfaces.
    RefractionQueue of RefractionRecord {
        /// unit length
        direction: [f32; 3],
        /// of what the ray sees, linear RGB
        share: [f32; 3],
    }
}

queue! {
    /// Light that leaves surfaces, complete once their children are.
    PendingQueue of PendingRecord {
        /// row of the ray that it is for
        ray: u32,
        /// local light, linear RGB
        light: [f32; 3],
    }
}

queue! {
    /// Reflected or refracted rays of pending surfaces, row by row of these.
    ChildQueue of ChildRecord {
        /// row of the ray one level deeper; 2³² − 1 for none
        row: u32,
        /// of what it sees, linear RGB
        share: [f32; 3],
    }
}

queue! {
    /// Beer's law for pending surfaces, row by row of these.
    AttenuationQueue of AttenuationRecord {
        /// of all light that leaves the surface along the ray, linear RGB
        attenuation: [f32; 3],
    }
}

queue! {
    /// What rays see, row by row of these.
    RadianceQueue of RadianceRecord {
        /// linear RGB
        radiance: [f32; 3],
    }
}

queue! {
    /// What rays hit; kept where a record of the picture is asked for. Row by row of the rays.
    NodeQueue of NodeRecord {
        /// signature of the ray's tree
        node: u64,
        /// primitive; 2³² − 1 on a miss
        id: u32,
    }
}

queue! {
    /// What pending surfaces are and see; kept where a record of the picture is asked for. Row by row of these.
    TrailQueue of TrailRecord {
        /// signature of the lights so far
        lights: u64,
        /// primitive
        id: u32,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_pushed_can_be_got() {
        let mut rays = RayQueue::with_capacity(3);
        let records = [1.0, 2.0, 3.0]
            .map(|x| RayRecord { origin: [x, 2.0 * x, 3.0 * x], direction: [-x, 0.5, x + 7.0] });
        for (row, record) in (0..).zip(records) {
            assert_eq!(rays.push(record), row);
        }
        for (row, record) in records.into_iter().enumerate() {
            assert_eq!(rays.get(row), record);
        }
        let mut shadows = ShadowQueue::with_capacity(1);
        let record = ShadowRecord {
            origin: [1.0, 2.0, 3.0],
            origin_low: [0.1, 0.2, 0.3],
            direction: [4.0, 5.0, 6.0],
            departure: 7,
            t: 8.0,
            surface: 9,
            light: [10.0, 11.0, 12.0],
        };
        shadows.push(record);
        assert_eq!(shadows.get(0), record);
    }

    #[test]
    fn columns_are_aligned_and_rows_fill_whole_runs() {
        let rays = RayQueue::with_capacity(65);
        for column in rays.origin.iter().chain(&rays.direction) {
            assert_eq!((column.as_ptr().align_offset(64), column.len()), (0, 128));
        }
        assert_eq!(rays.bytes(), 128 * 24);
        assert_eq!(RayQueue::COLUMNS.iter().map(|column| column.bytes).sum::<usize>(), 24);
    }

    #[test]
    fn a_queue_that_is_not_needed_takes_no_memory() {
        assert_eq!(SurfaceQueue::with_capacity(0).bytes(), 0);
    }
}
