//! Columns of a queue: 64-byte aligned, allocated once.

use crate::lanes::{Double, Vector};
use bytemuck::{Pod, Zeroable};
use std::marker::PhantomData;
use std::ops::{Deref, DerefMut};

/// A cache line, and as much as the widest lanes load at once.
#[repr(C, align(64))]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Line([u8; 64]);

/// As many values as were asked for, rounded up to whole cache lines; all zero at first.
pub(crate) struct Column<T> {
    lines: Vec<Line>,
    of: PhantomData<T>,
}

impl<T: Pod> Column<T> {
    pub(crate) fn with_rows(rows: usize) -> Self {
        let lines = (rows * size_of::<T>()).div_ceil(size_of::<Line>());
        Self { lines: vec![Line::zeroed(); lines], of: PhantomData }
    }
}

impl<T: Pod> Deref for Column<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        bytemuck::cast_slice(&self.lines)
    }
}

impl<T: Pod> DerefMut for Column<T> {
    fn deref_mut(&mut self) -> &mut [T] {
        bytemuck::cast_slice_mut(&mut self.lines)
    }
}

/// A field of a record, and the columns that hold it.
pub(crate) trait Field: Copy {
    type Columns;
    /// How it is spread over columns, for `explain`.
    const TYPE: &'static str;

    fn columns(rows: usize) -> Self::Columns;
    fn put(self, columns: &mut Self::Columns, row: usize);
    fn get(columns: &Self::Columns, row: usize) -> Self;
    fn bytes(columns: &Self::Columns) -> usize;
}

macro_rules! plain_field {
    ($type:ty) => {
        impl Field for $type {
            type Columns = Column<$type>;
            const TYPE: &'static str = stringify!($type);

            fn columns(rows: usize) -> Column<$type> {
                Column::with_rows(rows)
            }

            #[inline(always)]
            fn put(self, columns: &mut Column<$type>, row: usize) {
                columns[row] = self;
            }

            #[inline(always)]
            fn get(columns: &Column<$type>, row: usize) -> Self {
                columns[row]
            }

            fn bytes(columns: &Column<$type>) -> usize {
                size_of_val(&**columns)
            }
        }
    };
}

plain_field!(f32);
plain_field!(u32);
plain_field!(u64);

/// Three columns: x, y, z or red, green, blue.
impl Field for [f32; 3] {
    type Columns = [Column<f32>; 3];
    const TYPE: &'static str = "3 × f32";

    fn columns(rows: usize) -> Self::Columns {
        [(); 3].map(|()| Column::with_rows(rows))
    }

    #[inline(always)]
    fn put(self, columns: &mut Self::Columns, row: usize) {
        for (column, value) in columns.iter_mut().zip(self) {
            column[row] = value;
        }
    }

    #[inline(always)]
    fn get(columns: &Self::Columns, row: usize) -> Self {
        [columns[0][row], columns[1][row], columns[2][row]]
    }

    fn bytes(columns: &Self::Columns) -> usize {
        columns.iter().map(f32::bytes).sum()
    }
}

/// Rounds into three columns, from a row on.
#[inline(always)]
pub(super) fn round_vector<D: Double>(vector: Vector<D>, columns: &mut [Column<f32>; 3], row: usize) {
    let [x, y, z] = columns;
    vector.x.round(&mut x[row..]);
    vector.y.round(&mut y[row..]);
    vector.z.round(&mut z[row..]);
}

/// Widens from three columns, from a row on.
#[inline(always)]
pub(super) fn widen_vector<D: Double>(columns: &[Column<f32>; 3], row: usize) -> Vector<D> {
    let [x, y, z] = columns;
    Vector::new(D::widen(&x[row..]), D::widen(&y[row..]), D::widen(&z[row..]))
}
