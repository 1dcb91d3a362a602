//! From the vertical frame to that of the caller, many directions at once: `polarisation::aspect` in single precision
//! and without branches.

use super::coordinates::LocalFrame;
use crate::error::{Error, Result};
use crate::kernel::lanes::Lanes;
use crate::polarisation::PolarisationFrame;

/// A [`PolarisationFrame`], checked.
#[derive(Clone, Copy)]
pub(super) enum Axes {
    Vertical,
    SunAligned,
    /// A unit vector.
    Along([f32; 3]),
}

/// How Q/I and U/(I sin φ) in the vertical frame make Q/I and U/I in the frame of the caller.
#[derive(Clone, Copy)]
pub(super) struct FrameRotation<const W: usize> {
    /// Cosine and sine of twice the angle between the frames.
    pub double: [Lanes<W>; 2],
    /// sin φ, φ the azimuth from the sun.
    pub sine: Lanes<W>,
}

impl Axes {
    pub fn new(frame: PolarisationFrame) -> Result<Self> {
        Ok(match frame {
            PolarisationFrame::Vertical => Self::Vertical,
            PolarisationFrame::SunAligned => Self::SunAligned,
            PolarisationFrame::Axis(axis) => {
                // In double precision the square of every single-precision number is normal.
                let [x, y, z] = axis.map(f64::from);
                let square = x * x + y * y + z * z;
                if !(square > 0.0 && square.is_finite()) {
                    return Err(Error::Direction { got: axis });
                }
                let shrink = 1.0 / square.sqrt();
                Self::Along([x, y, z].map(|v| (v * shrink) as f32))
            }
        })
    }

    /// For [`super::coordinates::prepared`] vectors.
    #[inline(always)]
    pub fn turn<const W: usize>(
        &self,
        view: &LocalFrame,
        [x, y, z]: &[Lanes<W>; 3],
    ) -> FrameRotation<W> {
        let (x, y, z) = (*x, *y, *z);
        let (zero, one) = (Lanes::splat(0.0), Lanes::splat(1.0));
        let [cs, ss] = view.azimuth();
        let square = x * x + y * y;
        let root = square.max(Lanes::splat(f32::MIN_POSITIVE)).sqrt();
        let ca = square.at_least(f32::MIN_POSITIVE, x / root, Lanes::splat(cs));
        let sa = square.at_least(f32::MIN_POSITIVE, y / root, Lanes::splat(ss));
        let (sine, cosine) = (sa * cs - ca * ss, ca * cs + sa * ss);
        let length = (square + z * z).sqrt();
        let (se, ce) = (z / length, root / length);
        let double = match self {
            Self::Vertical => [one, zero],
            Self::SunAligned => {
                let [level, height] = view.sun_elevation();
                let (p1, p2) = (ce * height - se * cosine * level, sine * level);
                double([-p2, p1], -one)
            }
            Self::Along([ax, ay, az]) => {
                let e1 = ce * *az - se * (ca * *ax + sa * *ay);
                double([e1, sa * *ax - ca * *ay], one)
            }
        };
        FrameRotation { double, sine }
    }
}

/// Cosine and sine of twice the angle of a vector from the first axis; `otherwise` and 0 if it is too short to tell.
#[inline(always)]
fn double<const W: usize>([x, y]: [Lanes<W>; 2], otherwise: Lanes<W>) -> [Lanes<W>; 2] {
    /// As in `polarisation::aspect`.
    const PARALLEL: f32 = 1e-12;
    let (xx, yy) = (x * x, y * y);
    let square = xx + yy;
    let scale = Lanes::splat(1.0) / square.max(Lanes::splat(PARALLEL));
    [
        square.at_least(PARALLEL, (xx - yy) * scale, otherwise),
        square.at_least(PARALLEL, x * y * 2.0 * scale, Lanes::splat(0.0)),
    ]
}
