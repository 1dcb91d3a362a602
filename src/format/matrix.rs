//! Rows and columns of row-major matrices.

use zerocopy::little_endian::F32;

pub(super) fn pick<T: Copy>(values: &[T], indices: &[usize]) -> Vec<T> {
    indices.iter().map(|&i| values[i]).collect()
}

/// Rows of a matrix of the given width.
pub(super) fn rows<T: Copy>(matrix: &[T], width: usize, indices: &[usize]) -> Vec<T> {
    let row = |&i: &usize| &matrix[i * width..(i + 1) * width];
    indices.iter().flat_map(row).copied().collect()
}

/// Columns of a matrix of the given width.
pub(crate) fn columns<T: Copy>(matrix: &[T], width: usize, indices: &[usize]) -> Vec<T> {
    let rows = matrix.chunks_exact(width);
    rows.flat_map(|row| pick(row, indices)).collect()
}

pub(super) fn narrow(values: &[F32]) -> Vec<f32> {
    values.iter().map(|v| v.get()).collect()
}
