//! From matrices to rows.

use faer::Mat;

/// The rows of a matrix one after the other.
pub fn row_major(matrix: &Mat<f64>) -> Vec<f32> {
    (0..matrix.nrows())
        .flat_map(|i| (0..matrix.ncols()).map(move |j| matrix[(i, j)] as f32))
        .collect()
}
