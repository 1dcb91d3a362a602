//! The disc as plain arrays, for evaluation on a graphics processor.

use zerocopy::{Immutable, IntoBytes};

use super::SolarDisc;
use super::cap::Cap;
use super::depths::NODES;

/// Channels of a vector.
const GROUP: usize = 4;

/// Where the disc is and what of it is seen: 96 bytes with the layout that std140 and std430 give these fields.
///
/// ```
/// use welkin::{Conditions, Model};
///
/// let header = Model::default_model()?.solar_disc(&Conditions::default())?.buffers().header;
/// assert_eq!((header.visible, header.cut, header.nodes), (1, 0, 129));
/// assert!((header.chord - 0.004654793).abs() < 1e-8);
/// # Ok::<(), welkin::Error>(())
/// ```
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, IntoBytes, Immutable)]
pub struct DiscHeader {
    /// Unit vector towards the centre.
    pub centre: [f32; 3],
    /// Distance of unit vectors to the limb from that to the centre.
    pub chord: f32,
    /// Unit vector across the centre, upwards.
    pub up: [f32; 3],
    /// What is drawn from lies above this, in chords along `up`.
    pub floor: f32,
    /// Unit vector across the centre, to the left of an observer who faces it.
    pub left: [f32; 3],
    /// Solid angle of what is drawn from over `chord²`.
    pub area: f32,
    /// Cosine and sine of the elevation of the first node.
    pub lowest: [f32; 2],
    /// Nodes per radian of elevation.
    pub nodes_per_radian: f32,
    /// 1 / solid angle of the whole disc, sr⁻¹.
    pub mean: f32,
    /// Nodes of the elevation, 129, or 0 where the disc has set.
    pub nodes: u32,
    /// Groups of four wavelengths.
    pub groups: u32,
    /// Wavelengths; those that fill up the last group are dark.
    pub wavelengths: u32,
    /// Whether any of the disc is above the geometric horizon: 0 or 1.
    pub visible: u32,
    /// Whether what is below the first node is below the horizon: 0 or 1.
    pub cut: u32,
    /// Share of the radius that draws keep off the limb, and by which their density reaches beyond it.
    pub margin: f32,
    /// 0.
    pub unused: u32,
    /// [`DiscBuffers::LAYOUT`].
    pub layout: u32,
}

/// A disc of the sun, or of the moon, as plain arrays. With `h` the header, a unit vector `d` is looked up so:
///
/// ```text
/// square     = |d − h.centre|² / h.chord²                     // beside the disc if > 1
/// level      = |(d.x, d.y)|
/// sine       = d.z · h.lowest[0] − level · h.lowest[1]        // of the elevation above the first node
/// elevation  = sine + sine³ / 6                               // below the horizon if < 0 and h.cut
/// u          = clamp(elevation · h.nodes_per_radian, 0, h.nodes − 1)
/// first      = clamp(⌊u⌋, 1, h.nodes − 3) − 1
/// depth      = Σ lagrange(k, u − first) · depths[first + k]   // cubic in four nodes
/// μ          = √(1 − square)
/// relative   = exp(−max(depth, 0)) · h.mean · Σ profile[i] μⁱ
/// X, Y, Z    = relative · weights[0], · weights[1], · weights[2]
/// radiance   = relative ∘ weights[3]
/// ```
///
/// `table` has `depths[node][group]`, `profile[group][6]` and `weights[group][4]`, one after the other.
///
/// ```
/// use welkin::{Conditions, Model};
///
/// let buffers = Model::default_model()?.solar_disc(&Conditions::default())?.buffers();
/// let header = buffers.header;
/// assert_eq!(buffers.table.len() as u32, header.groups * (header.nodes + 6 + 4));
/// assert_eq!(buffers.header_bytes().len(), 96);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct DiscBuffers {
    /// The numbers that all directions share.
    pub header: DiscHeader,
    /// Depths, profiles and weights.
    pub table: Vec<[f32; 4]>,
}

impl DiscBuffers {
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

impl SolarDisc {
    /// The tables, for evaluation elsewhere.
    pub fn buffers(&self) -> DiscBuffers {
        let (n, nodes) = (self.wavelengths.len(), self.depths.as_ref());
        let mut table = Vec::new();
        if let Some(depths) = nodes {
            table.extend(depths.rows().flat_map(|row| grouped(n, |w| row[w])));
        }
        let profiles: [Vec<_>; 6] =
            core::array::from_fn(|i| grouped(n, |w| self.profile[w][i]).collect());
        let colours: [Vec<_>; 3] =
            core::array::from_fn(|c| grouped(n, |w| self.xyz[w][c]).collect());
        let irradiance: Vec<_> = grouped(n, |w| self.irradiance[w]).collect();
        let groups = n.div_ceil(GROUP);
        table.extend((0..groups).flat_map(|g| profiles.each_ref().map(|rows| rows[g])));
        for g in 0..groups {
            table.extend(colours.each_ref().map(|rows| rows[g]));
            table.push(irradiance[g]);
        }
        let axis = nodes.map(|depths| depths.axis());
        DiscBuffers {
            header: header(&self.cap, axis, n),
            table,
        }
    }
}

fn header(cap: &Cap, axis: Option<[f64; 2]>, wavelengths: usize) -> DiscHeader {
    let [lowest, nodes_per_radian] = axis.unwrap_or([0.0, 0.0]);
    let (sine, cosine) = lowest.sin_cos();
    let shape = cap.shape();
    DiscHeader {
        centre: cap.centre().map(|v| v as f32),
        chord: shape.chord as f32,
        up: shape.up.map(|v| v as f32),
        floor: shape.floor as f32,
        left: shape.left.map(|v| v as f32),
        area: shape.area as f32,
        lowest: [cosine, sine].map(|v| v as f32),
        nodes_per_radian: nodes_per_radian as f32,
        mean: (1.0 / cap.solid_angle()) as f32,
        nodes: if axis.is_some() { NODES as u32 } else { 0 },
        groups: wavelengths.div_ceil(GROUP) as u32,
        wavelengths: wavelengths as u32,
        visible: u32::from(axis.is_some()),
        cut: u32::from(lowest <= cap.lowest()),
        margin: super::cap::MARGIN as f32,
        unused: 0,
        layout: DiscBuffers::LAYOUT,
    }
}

/// A spectrum in vectors of four, filled up with zeros.
fn grouped(n: usize, value: impl Fn(usize) -> f32) -> impl Iterator<Item = [f32; GROUP]> {
    let lane = move |w: usize| if w < n { value(w) } else { 0.0 };
    let group = move |g: usize| core::array::from_fn(|i| lane(g * GROUP + i));
    (0..n.div_ceil(GROUP)).map(group)
}
