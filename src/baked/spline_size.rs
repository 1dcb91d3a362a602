//! How many coefficients the spline of one side of the horizon has.

/// Intervals over the height and over the azimuth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Size {
    pub rows: u32,
    pub columns: u32,
}

impl Size {
    /// Coefficients in a row.
    #[inline(always)]
    pub fn stride(&self) -> usize {
        self.columns as usize + 3
    }

    /// Coefficients of a block.
    #[inline(always)]
    pub fn cells(&self) -> usize {
        (self.rows as usize + 3) * self.stride()
    }
}
