//! The air as plain arrays, for transmittance on a graphics processor.

use zerocopy::{Immutable, IntoBytes};

use super::Transmittance;
use super::layers::LayerRow;
use crate::kernel::math::LANES;

/// Below the ground the first layer goes on down to here, in squared altitude, m: farther than any line comes.
const DEEPEST: f64 = -1e7;

/// The sizes of the air's table and the planet: 32 bytes with the layout that std140 and std430 give these fields.
///
/// ```
/// use welkin::Model;
///
/// let header = Model::default_model()?.transmittance(40e3)?.buffers().header;
/// assert!(header.layers > 8 && header.quads > 0 && header.groups > 0);
/// assert!((6.3e6..6.4e6).contains(&header.radius));
/// # Ok::<(), welkin::Error>(())
/// ```
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, IntoBytes, Immutable)]
pub struct AirHeader {
    /// Of the planet, m.
    pub radius: f32,
    /// Altitude of the top of the air, m.
    pub top: f32,
    /// Layers, of which the first lies below the ground.
    pub layers: u32,
    /// Groups of four constituents.
    pub quads: u32,
    /// Groups of four wavelengths.
    pub groups: u32,
    /// Wavelengths.
    pub wavelengths: u32,
    /// 0.
    pub unused: u32,
    /// [`AirBuffers::LAYOUT`].
    pub layout: u32,
}

/// The air at one visibility as plain arrays. With `h` the header, `table` has, one after the other:
///
/// ```text
/// layers[h.layers]                       // w at the bottom, 1 / thickness, the same over 2 · h.radius, w at the top
/// polynomials[h.layers][3][h.quads]      // densities: a + b·t + c·t², t the share of the layer
/// extinction[4 · h.quads][h.groups]      // m⁻¹ where the density of a constituent is 1
/// ```
///
/// With `w = a + a² / 2R` for the altitude `a`, a line that leaves `w₀` at the distance `r` from the planet's centre
/// with the cosine `μ` of its angle from the vertical there has `w = w₀ + (s² + 2 s r μ) / 2R` after `s` metres, so that
/// a piece of it within a layer from `s` to `s + d`, with `m` in the middle, has the column
///
/// ```text
/// mean      = (w(m) + d² / 24R − bottom) · rate
/// variance  = ((m + r μ)² / 3 + d² / 180) · d² · bend²      // bend = rate / 2R
/// column    = d · max(a + b · mean + c · (mean² + variance), 0)
/// ```
///
/// The optical depth is the sum of the columns of all constituents times their extinction.
///
/// ```
/// use welkin::Model;
///
/// let buffers = Model::default_model()?.transmittance(40e3)?.buffers();
/// let h = buffers.header;
/// let length = h.layers + 3 * h.layers * h.quads + 4 * h.quads * h.groups;
/// assert_eq!((buffers.table.len() as u32, buffers.header_bytes().len()), (length, 32));
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct AirBuffers {
    /// Sizes.
    pub header: AirHeader,
    /// Layers, densities and extinction.
    pub table: Vec<[f32; 4]>,
}

impl AirBuffers {
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

impl Transmittance {
    /// The tables, for evaluation elsewhere.
    pub fn buffers(&self) -> AirBuffers {
        let quads = self.layers.quads;
        let rows: Vec<LayerRow> = self.layers.rows().collect();
        let edges = rows.iter().map(|row| {
            let [bottom, top] = row.edges.map(|w| w.max(DEEPEST));
            // The first layer is the same all over.
            let bottom = if row.rate > 0.0 { bottom } else { DEEPEST };
            [bottom, row.rate, row.bend, top].map(|v| v as f32)
        });
        let polynomials = rows.iter().flat_map(|row| row.polynomial);
        let densities = polynomials.flat_map(|amounts| &amounts.0[..quads]).copied();
        let extinction = self.extinction.table[..quads * LANES * self.extinction.blocks].iter();
        let planet = self.planet();
        AirBuffers {
            header: AirHeader {
                radius: planet.radius as f32,
                top: planet.top as f32,
                layers: rows.len() as u32,
                quads: quads as u32,
                groups: self.extinction.blocks as u32,
                wavelengths: self.wavelengths.len() as u32,
                unused: 0,
                layout: AirBuffers::LAYOUT,
            },
            table: edges.chain(densities).chain(extinction.copied()).collect(),
        }
    }
}
