//! What a row asks for.

use welkin::output::printable;
use welkin::{AerialPerspective, Conditions};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    Radiance,
    RelativeRadiance,
    /// Q/I in the sun-aligned frame: positive where light is polarised across the plane of view and sun.
    Polarisation,
    /// In the vertical frame.
    StokesQ,
    StokesU,
    /// Of a segment, or of the whole ray.
    Transmittance,
    InScatter,
    /// Of the disc alone.
    SunRadiance,
}

impl Quantity {
    pub fn parse(cell: &[u8]) -> Result<Self, String> {
        match cell {
            b"radiance" => Ok(Self::Radiance),
            b"relative_radiance" => Ok(Self::RelativeRadiance),
            b"polarisation" => Ok(Self::Polarisation),
            b"stokes_q" => Ok(Self::StokesQ),
            b"stokes_u" => Ok(Self::StokesU),
            b"transmittance" => Ok(Self::Transmittance),
            b"in_scattering" => Ok(Self::InScatter),
            b"sun_radiance" => Ok(Self::SunRadiance),
            other => Err(format!(
                "unknown quantity \"{}\": expected radiance, relative_radiance, polarisation, stokes_q, stokes_u, transmittance, in_scattering or sun_radiance",
                printable(&String::from_utf8_lossy(other))
            )),
        }
    }

    /// Whether it may have a finite distance.
    pub fn is_of_segments(self) -> bool {
        !matches!(
            self,
            Self::Radiance | Self::RelativeRadiance | Self::SunRadiance
        )
    }

    /// Whether it is of the air along a ray and not of a sky.
    fn is_of_air(self, ray: &Ray) -> bool {
        match self {
            Self::Transmittance | Self::InScatter => true,
            _ => self.is_of_segments() && !ray.is_endless(),
        }
    }

    /// Rows of the same number can share work.
    fn kind(self) -> u64 {
        match self {
            Self::Radiance | Self::RelativeRadiance => 0,
            Self::Polarisation | Self::StokesQ | Self::StokesU => 1,
            Self::Transmittance => 2,
            Self::InScatter => 3,
            Self::SunRadiance => 4,
        }
    }
}

/// A row, understood.
#[derive(Clone, Debug)]
pub struct Question {
    pub quantity: Quantity,
    pub conditions: Conditions,
    pub ray: Ray,
    /// nm; of bands nobody asks for it.
    pub wavelength: f64,
}

/// Equal where only the wavelength differs; sorts what has much in common together.
pub type Key = [u64; 8];

impl Question {
    pub fn key(&self) -> Key {
        let Conditions {
            visibility,
            solar_elevation,
            albedo,
            altitude,
            ..
        } = self.conditions;
        let Ray {
            direction: [x, y, z],
            distance,
            above,
        } = self.ray;
        let altitude = above.unwrap_or(altitude);
        // A ray is known by two of its components and the half that the third is in.
        let half = 2 * u64::from(x < 0.0) + u64::from(y < 0.0);
        let [v, e, r, h, y, z, d] = [
            visibility,
            solar_elevation,
            albedo,
            altitude,
            y,
            z,
            distance,
        ]
        .map(f64::to_bits);
        [4 * self.quantity.kind() + half, v, e, r, h, y, z, d]
    }

    /// Rays through air alone may begin above the range of the model, as the altitude is not one of its conditions.
    pub fn of_air(mut self, highest: f64) -> Self {
        let altitude = self.conditions.altitude;
        if self.quantity.is_of_air(&self.ray) && altitude > highest && altitude.is_finite() {
            self.ray.above = Some(altitude);
            self.conditions.altitude = highest;
        }
        self
    }

    /// What skies, aerial perspectives and discs are prepared for.
    pub fn place(&self) -> [u64; 4] {
        let Conditions {
            visibility,
            solar_elevation,
            albedo,
            altitude,
            ..
        } = self.conditions;
        [visibility, solar_elevation, albedo, altitude].map(f64::to_bits)
    }
}

/// What a row looks along.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    pub direction: [f64; 3],
    /// m; infinite up to the ground or to space.
    pub distance: f64,
    /// Altitude that it begins at, if that is above the range of the model, m.
    pub above: Option<f64>,
}

impl Ray {
    /// Whether it is the way through all of the air.
    pub fn is_endless(&self) -> bool {
        self.distance == f64::INFINITY
    }

    pub fn narrow(&self) -> [f32; 3] {
        self.direction.map(|v| v as f32)
    }

    /// Start and end, of which the latter counts for finite distances.
    pub fn ends(&self, conditions: &Conditions) -> [[f64; 3]; 2] {
        let from = [0.0, 0.0, self.above.unwrap_or(conditions.altitude)];
        let to = core::array::from_fn(|k| from[k] + self.distance * self.direction[k]);
        [from, to]
    }

    /// In-scattered light and transmittance from the altitude of the conditions.
    pub fn through(
        &self,
        aerial: &AerialPerspective,
        light: &mut [f32],
        through: &mut [f32],
    ) -> welkin::Result<()> {
        let [from, to] = self.ends(aerial.conditions());
        match self.is_endless() {
            true => aerial.to_end(from, self.direction, light, through),
            false => aerial.in_scattering(from, to, light, through),
        }
    }
}
