//! The air around a camera as plain arrays, from which a graphics processor fills volumes.

use zerocopy::{Immutable, IntoBytes};

/// Where the air around a camera is looked up: 144 bytes with the layout that std140 and std430 give these fields.
///
/// ```
/// use welkin::{Conditions, Model};
///
/// let aerial = Model::default_model()?.colour_aerial_perspective(&Conditions::default())?;
/// let header = aerial.buffers([0.0, 0.0, 2.0])?.header;
/// assert_eq!((header.up, header.intervals), ([0.0, 0.0, 1.0], [32, 16, 16]));
/// # Ok::<(), welkin::Error>(())
/// ```
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, IntoBytes, Immutable)]
pub struct AerialHeader {
    /// Unit vector towards the sun.
    pub sun: [f32; 3],
    /// Cosine of the angle from `up` at which the camera sees the geometric horizon, ≤ 0.
    pub horizon: f32,
    /// Unit vector away from the planet's centre at the camera.
    pub up: [f32; 3],
    /// w of the camera, m.
    pub height: f32,
    /// Unit vector across `up` in the vertical plane of the sun.
    pub forward: [f32; 3],
    /// w of the top of the air, m.
    pub top: f32,
    /// Unit vector across both, counter-clockwise from `forward` seen from above.
    pub left: [f32; 3],
    /// 1 / 2R, m⁻¹.
    pub bend: f32,
    /// X, Y and Z of the sun outside the air, relative to one another: what the factors are those of.
    pub white: [f32; 3],
    /// How far rows stand from the poles.
    pub pole: f32,
    /// 1 / (1 − horizon) and 1 / (1 + horizon).
    pub shrink: [f32; 2],
    /// How rows crowd towards the horizon above and below it.
    pub crowding: [f32; 2],
    /// Intervals of the rows above and below the horizon, and of the azimuth.
    pub intervals: [u32; 3],
    /// Intervals of the angle from the sun.
    pub sun_intervals: u32,
    /// Intervals of the distance.
    pub distances: u32,
    /// r / R at the camera.
    pub steepness: f32,
    /// w up to which nodes of the distance crowd in the lower air, m.
    pub haze: f32,
    /// How they crowd towards the camera.
    pub nearness: f32,
    /// 1 / log2(1 + nearness).
    pub per_stretch: f32,
    /// 0.
    pub unused: [u32; 2],
    /// [`AerialBuffers::LAYOUT`].
    pub layout: u32,
}

/// The light that the air between a camera and all points around it scatters to the camera, and what it leaves of
/// light from there, as plain arrays. One table serves all views from one place.
///
/// With `h` the header, a point at the distance `s` in the direction of a unit vector `d` is looked up as a
/// [`SkyBuffers`](crate::SkyBuffers) is, with `z = d · h.up` for `d.z` and `(d · h.forward, d · h.left)` for the
/// azimuth, so that row, column and angle are those of its formulae, and with four more neighbours over the distance.
/// Its nodes crowd near the camera and in the lower air. With `w = altitude + altitude² / 2R`, a parabola of `s`:
///
/// ```text
/// rise       = z · h.steepness                                  // of w at the camera
/// room       = h.top − h.height
/// end        = max(0, z < h.horizon ?
///                h.height / ((√((z − h.horizon) (z + h.horizon)) − z) · h.steepness / 2) :
///                (√max(rise² + 4 h.bend · room, 0) − rise) / (2 h.bend)) + 20
/// q          = √max(h.height + h.haze + s (rise + s · h.bend), h.haze / 2)
/// p          = √(h.height + h.haze)
/// m(s)       = u / (p q (1 − h.bend · u²)) with u = s / (p + q) // half of ∫ (w + h.haze)^(−3/2) ds
/// t          = min(s, end)
/// node       = log2(1 + h.nearness · m(t) / m(end)) · h.per_stretch · h.distances
/// logarithm  = Σ envelope[angle · h.sun_intervals] + Σ Σ Σ light[node][row][column]
/// X, Y, Z    = 2^logarithm · t                                  // cd m⁻²
/// depths     = t · max(Σ Σ Σ depth[node][row][column], 0)       // of X, Y and Z
/// factors    = 2^−depths
/// ```
///
/// Where a ray that goes down is longer than to its end, as into a valley, it goes on through the same air: with
/// `k = s / end` depths are `k` times as much, and X, Y and Z `(1 − factors^k) / (1 − factors)` times.
///
/// `table` has `envelope[h.sun_intervals + 3]`, `light[h.distances + 3][rows][columns]` and `depth[…]` of the same
/// size, one after the other, with rows and columns as those of the sky. The fourth component is 0.
///
/// ```
/// use welkin::{Conditions, Model};
///
/// let aerial = Model::default_model()?.colour_aerial_perspective(&Conditions::default())?;
/// let buffers = aerial.buffers([0.0, 0.0, 2.0])?;
/// let h = buffers.header;
/// let [up, down, columns] = h.intervals.map(|n| n + 3);
/// let cells = (h.distances + 3) * (up + down) * columns;
/// assert_eq!(buffers.table.len() as u32, h.sun_intervals + 3 + 2 * cells);
/// assert_eq!(buffers.header_bytes().len(), 144);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct AerialBuffers {
    /// The numbers that all points share.
    pub header: AerialHeader,
    /// Envelope, light, optical depths.
    pub table: Vec<[f32; 4]>,
}

impl AerialBuffers {
    /// Version of the layout; another one means other fields or formulae.
    pub const LAYOUT: u32 = 2;

    /// The header as it is uploaded, in the byte order of this machine.
    pub fn header_bytes(&self) -> &[u8] {
        self.header.as_bytes()
    }

    /// The table as it is uploaded, in the byte order of this machine.
    pub fn table_bytes(&self) -> &[u8] {
        self.table.as_bytes()
    }
}
