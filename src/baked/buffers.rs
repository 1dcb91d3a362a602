//! The tables of baked skies for evaluation elsewhere: on a graphics processor, in an array language.

use zerocopy::{Immutable, IntoBytes};

use super::baked_bands::{BakedBandSky, BakedPolarisedBandSky};
use super::baked_colour::BakedColourSky;
use super::baked_polarised::BakedPolarisedSky;
use super::baked_spectral::{BakedSky, LANES};
use super::coordinates::{CROWDING, LocalFrame, POLE};
use super::spline_table::{ENVELOPE, GROUP, Grid, SUN, Table, regrouped};
use crate::kernel::lanes::Lanes;

/// Where a baked sky is looked up: 80 bytes with the layout that std140 and std430 give these fields.
///
/// Units are those of the sky: +z up, azimuths counter-clockwise from +x.
///
/// ```
/// use welkin::{BakedSky, Conditions, Model};
///
/// let sky = Model::default_model()?.colour_sky(&Conditions::default())?.bake(BakedSky::TOLERANCE)?;
/// let header = sky.buffers().header;
/// assert_eq!((header.channels, header.groups, header.polarised), (3, 1, 0));
/// assert!(header.sun[2] > 0.3 && header.horizon == 0.0);
/// # Ok::<(), welkin::Error>(())
/// ```
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, IntoBytes, Immutable)]
pub struct BufferHeader {
    /// Unit vector towards the sun.
    pub sun: [f32; 3],
    /// z of unit vectors that meet the geometric horizon, ≤ 0.
    pub horizon: f32,
    /// Cosine and sine of the sun's azimuth.
    pub azimuth: [f32; 2],
    /// 1 / (1 − horizon) and 1 / (1 + horizon).
    pub shrink: [f32; 2],
    /// 2.2 and 1.1: how rows crowd towards the horizon above and below it.
    pub crowding: [f32; 2],
    /// How far rows stand from the poles, 0.5.
    pub pole: f32,
    /// What the way to the ground is measured with.
    pub opaque: f32,
    /// Intervals of the rows above and below the horizon, and of the azimuth.
    pub intervals: [u32; 3],
    /// Intervals of the angle from the sun, 32.
    pub sun_intervals: u32,
    /// Groups of four channels.
    pub groups: u32,
    /// Channels: three for colours (X, Y, Z in cd m⁻²), otherwise the wavelengths or the bands.
    pub channels: u32,
    /// Whether there is a table of the polarisation: 0 or 1.
    pub polarised: u32,
    /// [`SkyBuffers::LAYOUT`].
    pub layout: u32,
}

/// A baked sky as plain arrays. With `h` the header, a unit vector `d` is looked up so; `s` is a spline's sum over four
/// neighbours, with weights `(1−t)³, 3t³ − 6t² + 4, the same of 1 − t, t³`, each over 6, at the cell `⌊u⌋` (at most
/// `intervals − 1`) and `t = u − ⌊u⌋`:
///
/// ```text
/// side     = d.z − h.horizon                        // up if ≥ 0, otherwise down
/// k        = side ≥ 0 ? 0 : 1,  sign = 1 − 2k
/// sine     = √min(|side| · h.shrink[k], 1)
/// cosine   = √clamp((1 − sign·d.z) · h.shrink[k], 0, 1)
/// row      = sine (1 + c) / (c·sine + 1 + h.pole·cosine),  c = h.crowding[k]
/// azimuth  = √clamp((1 − cos φ) / 2, 0, 1),  cos φ = (d.x, d.y) · h.azimuth / |(d.x, d.y)|, 1 where d is vertical
/// angle    = min(|d − h.sun| / 2, 1)
/// root     = √max((d.z + h.horizon)(d.z − h.horizon), 0) + |d.z|
/// opacity  = side ≥ 0 ? 1 : h.opaque / (h.opaque + root)
/// logarithm = Σ envelope[group][angle · h.sun_intervals] + Σ Σ cells[group][row][azimuth]
/// value    = 2^logarithm · opacity · scale[group]
/// ```
///
/// with `row · h.intervals[k]` (rows below the horizon start at `h.intervals[0] + 3`) and `azimuth · h.intervals[2]` for
/// the surface, whose rows have `h.intervals[2] + 3` cells. The polarisation of a channel is the sum of the same weights
/// over `polarisation[2·group]`, Q/I, and `polarisation[2·group + 1]`, U/(I sin φ), both in the vertical frame
/// ([`PolarisationFrame::Vertical`](crate::PolarisationFrame)), with φ the azimuth from the sun, counter-clockwise.
///
/// ```
/// use welkin::{BakedSky, Conditions, Model};
///
/// let sky = Model::default_model()?.colour_sky(&Conditions::default())?.bake(BakedSky::TOLERANCE)?;
/// let buffers = sky.buffers();
/// let [up, down, azimuth] = buffers.header.intervals.map(|n| n as usize + 3);
/// assert_eq!(buffers.cells.len(), (up + down) * azimuth);
/// assert_eq!(buffers.header_bytes().len(), 80);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct SkyBuffers {
    /// The numbers that all directions share.
    pub header: BufferHeader,
    /// `[group][sun_intervals + 3]`.
    pub envelope: Vec<[f32; 4]>,
    /// `[group][row][column]`.
    pub cells: Vec<[f32; 4]>,
    /// `[group][2][row][column]`, or nothing.
    pub polarisation: Vec<[f32; 4]>,
    /// `[group]`: solar spectral irradiance, W m⁻² nm⁻¹; 1 for colours and bands.
    pub scale: Vec<[f32; 4]>,
}

impl SkyBuffers {
    /// Version of the layout; another one means other fields or formulae.
    pub const LAYOUT: u32 = 1;

    /// The header as it is uploaded, in the byte order of this machine.
    pub fn header_bytes(&self) -> &[u8] {
        self.header.as_bytes()
    }

    /// All arrays one after the other, for a single buffer: the envelope, the cells, the polarisation, the scale.
    pub fn table(&self) -> Vec<[f32; 4]> {
        [&self.envelope, &self.cells, &self.polarisation, &self.scale]
            .map(|part| part.as_slice())
            .concat()
    }

    fn of<const N: usize>(frame: &LocalFrame, table: &Table<N>, channels: usize) -> Self {
        let groups = channels.div_ceil(GROUP);
        let lanes = |cells: &[Lanes<N>], length| regrouped(cells, length, groups, [0, N]);
        Self {
            header: header(frame, table.grid, channels),
            envelope: lanes(&table.envelope, ENVELOPE),
            cells: lanes(&table.cells, table.grid.cells()),
            polarisation: Vec::new(),
            scale: vec![[1.0; GROUP]; groups],
        }
    }
}

impl BakedColourSky {
    /// The tables, for evaluation elsewhere: X, Y and Z, which a [`ColourSpace`](crate::ColourSpace) takes on.
    pub fn buffers(&self) -> SkyBuffers {
        SkyBuffers::of(&self.frame(), self.table(), 3)
    }
}

impl BakedSky {
    /// The tables, for evaluation elsewhere, at each of [`BakedSky::wavelengths`].
    pub fn buffers(&self) -> SkyBuffers {
        let channels = self.wavelengths().len();
        let mut buffers = SkyBuffers::of(self.frame(), &self.baked.table, channels);
        buffers.scale = regrouped(&self.irradiance, 1, buffers.scale.len(), [0, LANES]);
        buffers
    }
}

impl BakedPolarisedSky {
    /// The tables, for evaluation elsewhere, at each of [`BakedSky::wavelengths`].
    pub fn buffers(&self) -> SkyBuffers {
        let mut buffers = self.sky().buffers();
        let groups = buffers.header.groups as usize;
        let cells = self.degrees.grid().cells();
        let [q, u] = [0, 1].map(|part| self.degrees.regrouped(groups, part));
        let pairs = q.chunks_exact(cells).zip(u.chunks_exact(cells));
        buffers.polarisation = pairs.flat_map(|(q, u)| [q, u].concat()).collect();
        buffers.header.polarised = 1;
        buffers
    }
}

impl BakedBandSky {
    /// The tables, for evaluation elsewhere; the channels are the bands.
    pub fn buffers(&self) -> SkyBuffers {
        self.sky.buffers()
    }
}

impl BakedPolarisedBandSky {
    /// The tables, for evaluation elsewhere; the channels are the bands.
    pub fn buffers(&self) -> SkyBuffers {
        self.sky.buffers()
    }
}

fn header(frame: &LocalFrame, grid: Grid, channels: usize) -> BufferHeader {
    BufferHeader {
        sun: frame.sun,
        horizon: frame.horizon,
        azimuth: frame.azimuth,
        shrink: frame.shrink,
        crowding: CROWDING,
        pole: POLE,
        opaque: frame.radius * frame.horizon * frame.horizon,
        intervals: [grid.up, grid.down, grid.azimuth],
        sun_intervals: SUN,
        groups: channels.div_ceil(GROUP) as u32,
        channels: channels as u32,
        polarised: 0,
        layout: SkyBuffers::LAYOUT,
    }
}
