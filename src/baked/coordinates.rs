//! From directions to the coordinates of baked tables: single precision, no branches and nothing but roots and
//! quotients.

use crate::conditions::Conditions;
use crate::geometry::Side;
use crate::kernel::lanes::Lanes;
use crate::sky::Sky;

/// What directions are measured against.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocalFrame {
    /// Unit vector towards the sun.
    pub(super) sun: [f32; 3],
    /// Cosine of the sun's elevation.
    level: f32,
    /// Cosine and sine of the sun's azimuth.
    pub(super) azimuth: [f32; 2],
    /// z of unit vectors that meet the geometric horizon, ≤ 0.
    pub(super) horizon: f32,
    /// 1 / (1 ∓ horizon): what makes shares of distances in z from it, above and below.
    pub(super) shrink: [f32; 2],
    /// Distance from the planet's centre over [`opaque_length`].
    pub(super) radius: f32,
}

/// Directions in the coordinates of the tables; all but `side` are 0..=1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Points<const N: usize> {
    /// ≥ 0 where the ray ends in space.
    pub side: Lanes<N>,
    /// Warped distance from the geometric horizon.
    pub height: Lanes<N>,
    /// The same, drawn together further towards the horizon: the place among the rows of a table.
    pub row: Lanes<N>,
    /// sin(φ/2), φ the azimuth from the sun.
    pub azimuth: Lanes<N>,
    /// sin(γ/2), γ the angle from the sun.
    pub sun: Lanes<N>,
    /// What the radiance is divided by: about the opacity of the air before the ground, 1 where the ray ends in space.
    pub opacity: Lanes<N>,
}

/// Length of air at the ground with an optical depth of 1 at 550 nm, m.
pub(crate) fn opaque_length(conditions: &Conditions) -> f64 {
    conditions.visibility / 3.912
}

/// The inverse of [`Points::height`]: the share of the way in z from the horizon to the pole.
pub(crate) fn share(height: f64) -> f64 {
    let near_pole = 1.0 - height * height;
    1.0 - near_pole * near_pole
}

/// How rows are drawn together towards the horizon, above and below it. Measured: with the same number of rows the
/// 99.9th percentile of errors is a third of what it is with the height alone, and the 95th two thirds.
pub(crate) const CROWDING: [f32; 2] = [2.2, 1.1];

/// How far rows stand from the pole.
pub(crate) const POLE: f32 = 0.5;

/// The inverse of [`Points::row`]: the share of the way in z from the horizon to the pole.
pub(crate) fn share_at_row(side: Side, row: f64) -> f64 {
    // With the share as a squared sine: A sin ψ − B cos ψ = row.
    let crowding = crowding(side);
    let (a, b) = (1.0 + crowding * (1.0 - row), f64::from(POLE) * row);
    let angle = (row / a.hypot(b)).min(1.0).asin() + b.atan2(a);
    angle.sin().powi(2).min(1.0)
}

/// [`Points::row`] of a share of the way in z from the horizon to the pole.
pub(crate) fn row_at_share(side: Side, share: f64) -> f64 {
    let (sine, cosine) = (share.sqrt(), (1.0 - share).sqrt());
    let crowding = crowding(side);
    sine * (1.0 + crowding) / (crowding * sine + 1.0 + f64::from(POLE) * cosine)
}

fn crowding(side: Side) -> f64 {
    let [up, down] = CROWDING;
    f64::from(match side {
        Side::Up => up,
        Side::Down => down,
    })
}

/// Scales vectors by powers of two, if need be, so that their squares neither over- nor underflow; `None` if one is
/// zero or not finite.
#[inline(always)]
pub(crate) fn prepared<const N: usize>(vector: [Lanes<N>; 3]) -> Option<[Lanes<N>; 3]> {
    // Bits order magnitudes like numbers, with infinity and NaN at the end; in integers this stays free of branches.
    const SMALL: u32 = 67 << 23; // 2^-60
    const LARGE: u32 = 187 << 23; // 2^60
    let mut furthest = 0;
    for i in 0..N {
        furthest = furthest.max(largest(vector, i).wrapping_sub(SMALL));
    }
    if furthest < LARGE - SMALL {
        return Some(vector);
    }
    scaled(vector)
}

/// Bits of the largest magnitude in lane `i`.
#[inline(always)]
fn largest<const N: usize>([x, y, z]: [Lanes<N>; 3], i: usize) -> u32 {
    let magnitude = |v: Lanes<N>| v.0[i].to_bits() & !(1 << 31);
    magnitude(x).max(magnitude(y)).max(magnitude(z))
}

#[cold]
fn scaled<const N: usize>(vector: [Lanes<N>; 3]) -> Option<[Lanes<N>; 3]> {
    let mut scaled = vector;
    for i in 0..N {
        let factor = match largest(vector, i) >> 23 {
            255 => return None,
            187.. => 2f32.powi(-66),
            67.. => 1.0,
            _ if largest(vector, i) == 0 => return None,
            _ => 2f32.powi(90),
        };
        for component in &mut scaled {
            component.0[i] *= factor;
        }
    }
    Some(scaled)
}

impl LocalFrame {
    pub fn new(sky: &Sky) -> Self {
        let conditions = sky.conditions();
        let centre = sky.planet().radius + conditions.altitude;
        let horizon = -sky.dip().sin() as f32;
        let mut frame = Self {
            shrink: [1.0 / (1.0 - horizon), 1.0 / (1.0 + horizon)],
            sun: [0.0; 3],
            level: conditions.solar_elevation.cos() as f32,
            azimuth: [0.0; 2],
            horizon,
            radius: (centre / opaque_length(conditions)) as f32,
        };
        frame.turn(conditions);
        frame
    }

    /// The same observer under another sun.
    pub fn under(mut self, conditions: &Conditions) -> Self {
        self.level = conditions.solar_elevation.cos() as f32;
        self.turn(conditions);
        self
    }

    /// Follows the azimuth of the sun.
    pub fn turn(&mut self, conditions: &Conditions) {
        self.sun = conditions.sun_direction().map(|v| v as f32);
        let (sine, cosine) = conditions.solar_azimuth.sin_cos();
        self.azimuth = [cosine as f32, sine as f32];
    }

    /// Cosine and sine of the sun's azimuth.
    pub fn azimuth(&self) -> [f32; 2] {
        self.azimuth
    }

    /// Cosine and sine of the sun's elevation.
    #[inline(always)]
    pub fn sun_elevation(&self) -> [f32; 2] {
        [self.level, self.sun[2]]
    }

    /// z at the two edges of a row of directions, when heights are divided evenly into `up` rows above the horizon,
    /// counted from there, and then `down` below.
    pub fn row(&self, row: usize, up: usize, down: usize) -> [f64; 2] {
        let (sign, row, rows) = match row < up {
            true => (1.0, row, up),
            false => (-1.0, row - up, down),
        };
        let horizon = f64::from(self.horizon);
        let edge = |i: usize| horizon + share(i as f64 / rows as f64) * (sign - horizon);
        [edge(row), edge(row + 1)]
    }

    /// Locates [`prepared`] directions of any length.
    #[inline(always)]
    pub fn locate<const N: usize>(&self, [x, y, z]: [Lanes<N>; 3]) -> Points<N> {
        let horizontal_square = x * x + y * y;
        let length = (horizontal_square + z * z).sqrt();
        let unit = [x / length, y / length, z / length];
        let side = unit[2] - self.horizon;
        let (height, row) = self.height(unit[2], side);
        Points {
            side,
            height,
            row,
            azimuth: self.half_azimuth(x, y, horizontal_square),
            sun: self.half_angle(unit),
            opacity: self.opacity(unit[2], side),
        }
    }

    /// With t the share of the way in z from the horizon to the pole: √(1 − √(1 − t)), and the place among the rows, √t
    /// over a mixture of √t, √(1 − t) and 1. Near the horizon both go with the root of the angle, near the pole with
    /// the angle. In the place nothing cancels; in the height it costs 3e-4 at most.
    #[inline(always)]
    fn height<const N: usize>(&self, z: Lanes<N>, side: Lanes<N>) -> (Lanes<N>, Lanes<N>) {
        let (zero, one) = (Lanes::splat(0.0), Lanes::splat(1.0));
        let [above, below] = self.shrink.map(Lanes::splat);
        let shrink = side.at_least(0.0, above, below);
        let [up, down] = CROWDING.map(Lanes::splat);
        let crowding = side.at_least(0.0, up, down);
        let sine = (side.abs() * shrink).min(one).sqrt();
        let sign = side.at_least(0.0, one, -one);
        let cosine = ((one - sign * z) * shrink).max(zero).min(one).sqrt();
        let row = (crowding * sine + sine) / (crowding * sine + (cosine * POLE + 1.0));
        ((one - cosine).sqrt(), row)
    }

    /// d/(d + opaque length), d the way to the ground: z² − z_h² is taken apart, as its terms cancel at the horizon.
    #[inline(always)]
    fn opacity<const N: usize>(&self, z: Lanes<N>, side: Lanes<N>) -> Lanes<N> {
        let zero = Lanes::splat(0.0);
        let product = (z + self.horizon) * (z - self.horizon);
        let root = product.max(zero).sqrt();
        let divisor = (root + z.abs()).max(Lanes::splat(1e-20));
        let length = Lanes::splat(self.radius * self.horizon * self.horizon);
        // Arithmetic instead of a choice between results keeps branches away.
        (length + side.at_least(0.0, divisor, zero)) / (length + divisor)
    }

    /// 0 where the direction is vertical: the vertical plane is that of the sun there.
    #[inline(always)]
    fn half_azimuth<const N: usize>(&self, x: Lanes<N>, y: Lanes<N>, square: Lanes<N>) -> Lanes<N> {
        let (zero, one) = (Lanes::splat(0.0), Lanes::splat(1.0));
        let tiny = Lanes::splat(f32::MIN_POSITIVE);
        let along = x * self.azimuth[0] + y * self.azimuth[1];
        let share = along / square.max(tiny).sqrt();
        let share = square.at_least(f32::MIN_POSITIVE, share, one);
        (Lanes::splat(0.5) - share * 0.5).max(zero).min(one).sqrt()
    }

    /// Half the chord: exact where the cosine of the angle is not.
    #[inline(always)]
    fn half_angle<const N: usize>(&self, [x, y, z]: [Lanes<N>; 3]) -> Lanes<N> {
        let [x, y, z] = [x - self.sun[0], y - self.sun[1], z - self.sun[2]];
        ((x * x + y * y + z * z).sqrt() * 0.5).min(Lanes::splat(1.0))
    }
}
