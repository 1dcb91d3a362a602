//! Sums over walks.

/// Sums of Stokes vectors by number of ground bounces.
pub struct Tally<const N: usize> {
    /// `sums[bounces][component][wavelength]`.
    pub sums: Vec<[[f64; N]; 3]>,
}

impl<const N: usize> Tally<N> {
    pub fn add(&mut self, bounces: usize, stokes: &[[f64; N]; 3], factor: &[f64; N]) {
        for (sum, s) in self.sums[bounces].iter_mut().zip(stokes) {
            for w in 0..N {
                sum[w] += s[w] * factor[w];
            }
        }
    }
}
