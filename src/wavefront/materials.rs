//! What the materials of rows say, side by side.

/// For up to eight rows, by the index of their material, the numbers that `values` gives of it: a column each, anything where
/// there is no row. Neighbours often are of one material, which is then read once.
#[inline(always)]
pub(super) fn columns_of<const N: usize>(
    of_rows: &[u32],
    values: impl Fn(usize) -> [f32; N],
) -> [[f32; 8]; N] {
    let first = of_rows[0];
    if of_rows.iter().fold(0, |differs, of_row| differs | of_row ^ first) == 0 {
        return values(first as usize).map(|value| [value; 8]);
    }
    let mut columns = [[0.0; 8]; N];
    for (lane, &of_row) in of_rows.iter().enumerate() {
        for (column, value) in columns.iter_mut().zip(values(of_row as usize)) {
            column[lane] = value;
        }
    }
    columns
}
