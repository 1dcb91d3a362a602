//! The sampler as plain arrays, for draws on a graphics processor.

use zerocopy::{Immutable, IntoBytes};

use super::sampler::{COLUMNS, DOWN, SkySampler, UP};

/// How a sampler is indexed: 48 bytes with the layout that std140 and std430 give these fields.
///
/// ```
/// use welkin::{BakedSky, Conditions, Model};
///
/// let sky = Model::default_model()?.colour_sky(&Conditions::default())?.bake(BakedSky::TOLERANCE)?;
/// let header = sky.sampler().buffers().header;
/// assert_eq!((header.rows, header.columns, header.share), ([48, 24], 48, 0.0));
/// # Ok::<(), welkin::Error>(())
/// ```
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, IntoBytes, Immutable)]
pub struct SamplerHeader {
    /// Cosine and sine of the sun's azimuth.
    pub azimuth: [f32; 2],
    /// 1 / (1 − horizon) and 1 / (1 + horizon).
    pub shrink: [f32; 2],
    /// z of unit vectors that meet the geometric horizon, ≤ 0.
    pub horizon: f32,
    /// Share of the draws that the disc has; 0 without one.
    pub share: f32,
    /// Rows of cells above and below the horizon.
    pub rows: [u32; 2],
    /// Columns of cells from the sun's azimuth to the opposite one.
    pub columns: u32,
    /// 0.
    pub unused: [u32; 2],
    /// [`SamplerBuffers::LAYOUT`].
    pub layout: u32,
}

/// A sampler as plain arrays. With `h` the header and `n` all rows, `table` has, one after the other:
///
/// ```text
/// heights[n][2]                // z at the edges of each row, the one next to the horizon first
/// azimuths[h.columns + 1]      // from the sun's, rad, 0..=π, at the edges of the columns
/// rows[n + 1]                  // cumulative probability at the edges of the rows, 0..=1
/// columns[n][h.columns + 1]    // the same of the columns of each row
/// density[n][h.columns]        // per solid angle, sr⁻¹
/// ```
///
/// A draw takes a row by the first number and a column by the second, of which the halves are left and right of the
/// sun, and goes on evenly in height and azimuth with what is left of them ([`SkySampler::sample`]). The density of a
/// unit vector `d` is that of its row and column:
///
/// ```text
/// k        = d.z ≥ h.horizon ? 0 : 1,  sign = 1 − 2k
/// cosine   = √clamp((1 − sign·d.z) · h.shrink[k], 0, 1)
/// row      = min(⌊√(1 − cosine) · h.rows[k]⌋, h.rows[k] − 1) + k · h.rows[0]
/// column   = min(⌊√((1 − cos φ) / 2) · h.columns⌋, h.columns − 1)
/// pdf      = (1 − h.share) · density[row][column] + h.share · (density of the disc)
/// ```
///
/// The disc's share is drawn by what [`SolarDisc::buffers`](crate::SolarDisc::buffers) gives.
///
/// ```
/// use welkin::{BakedSky, Conditions, Model};
///
/// let sky = Model::default_model()?.colour_sky(&Conditions::default())?.bake(BakedSky::TOLERANCE)?;
/// let buffers = sky.sampler().buffers();
/// assert_eq!(buffers.table.len(), 72 * 2 + 49 + 73 + 72 * 49 + 72 * 48);
/// assert_eq!(buffers.header_bytes().len(), 48);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct SamplerBuffers {
    /// How the table is indexed.
    pub header: SamplerHeader,
    /// Edges, probabilities and densities.
    pub table: Vec<f32>,
}

impl SamplerBuffers {
    /// Version of the layout; another one means other fields or formulae.
    pub const LAYOUT: u32 = 1;

    /// The header as it is uploaded, in the byte order of this machine.
    pub fn header_bytes(&self) -> &[u8] {
        self.header.as_bytes()
    }

    /// The table as it is uploaded, in the byte order of this machine.
    pub fn table_bytes(&self) -> &[u8] {
        self.table.as_bytes()
    }
}

impl SkySampler {
    /// The tables, for draws elsewhere.
    pub fn buffers(&self) -> SamplerBuffers {
        let parts = [
            self.heights.as_flattened(),
            &self.azimuths,
            &self.rows,
            &self.columns,
            &self.density,
        ];
        SamplerBuffers {
            header: SamplerHeader {
                azimuth: self.frame.azimuth,
                shrink: self.frame.shrink,
                horizon: self.frame.horizon,
                share: self.sun.as_ref().map_or(0.0, |(_, share)| *share),
                rows: [UP as u32, DOWN as u32],
                columns: COLUMNS as u32,
                unused: [0; 2],
                layout: SamplerBuffers::LAYOUT,
            },
            table: parts.concat(),
        }
    }
}
