//! The moon as the source of light.

use core::f64::consts::PI;

use super::disc_reflectance::DiscReflectance;
use crate::conditions::{Conditions, direction};
use crate::error::{Error, Result};

/// Solid angle of the moon at [`Moon::MEAN_DISTANCE`], sr.
const SOLID_ANGLE: f64 = 6.4177e-5;

/// The moon, where it stands and how much of it is lit. Angles in radians, lengths in metres.
///
/// Its light is that of the sun times the mean reflectance of its disc: the model of the Robotic Lunar Observatory
/// (Kieffer and Stone 2005), smoothed over wavelength, without libration; the mean of waxing and waning moons, which
/// differ from it by up to 6 %. Its authors give it 5 to 10 % of absolute uncertainty. It was fitted from 1.55° to 97°
/// and from 350 to 2384 nm; thinner crescents follow the visual law of Krisciunas and Schaefer (1991), and the eclipsed
/// moon is not modelled.
///
/// ```
/// use welkin::{Conditions, Model, Moon};
///
/// let model = Model::default_model()?;
/// let moon = Moon { elevation: 45f64.to_radians(), phase_angle: 0.1, ..Moon::default() };
/// let night = Conditions { solar_elevation: -20f64.to_radians(), ..Conditions::default() };
/// let sky = model.sky_with_moon(&night, &moon)?;
/// let luminance = sky.xyz([0.0, 0.0, 1.0])?[1]; // cd m⁻²
/// assert!((1e-3..1e-2).contains(&luminance));
/// // The air that the moon lights, for everything else that a model gives: baked skies, its disc, aerial perspective.
/// let moonlit = model.moonlit(&moon)?;
/// let disc = moonlit.solar_disc(&moon.conditions(&night))?;
/// assert!(disc.is_visible());
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moon {
    /// Geometric elevation of its centre above the observer's horizontal plane, rad.
    pub elevation: f64,
    /// Azimuth, rad, counter-clockwise from +x seen from above.
    pub azimuth: f64,
    /// Phase angle, rad: between the sun and the observer as seen from the moon. 0 is full, π new.
    pub phase_angle: f64,
    /// Distance of its centre from the observer, m.
    pub distance: f64,
}

impl Default for Moon {
    /// Full as it can be without an eclipse, 45° high towards +x, at its mean distance.
    fn default() -> Self {
        Self {
            elevation: 45f64.to_radians(),
            azimuth: 0.0,
            phase_angle: 1.55f64.to_radians(),
            distance: Self::MEAN_DISTANCE,
        }
    }
}

impl Moon {
    /// Mean distance, m, to which the reflectance is referred.
    pub const MEAN_DISTANCE: f64 = 384_400e3;
    /// Shortest and longest distance, m.
    pub const DISTANCES: [f64; 2] = [3.4e8, 4.2e8];

    /// The phase angle (rad) of a moon at mean distance in a direction, with the sun in another; vectors of one frame,
    /// which need not be normalised.
    pub fn phase_angle_between(moon: [f64; 3], sun: [f64; 3]) -> f64 {
        /// Of the sun, in distances of the moon.
        const SUN: f64 = 389.17;
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let cosine = dot(moon, sun) / (dot(moon, moon) * dot(sun, sun)).sqrt();
        let elongation = cosine.clamp(-1.0, 1.0).acos();
        let (sine, cosine) = elongation.sin_cos();
        (SUN * sine).atan2(SUN * -cosine + 1.0).clamp(0.0, PI)
    }

    /// The conditions of the air that the moon lights: the moon stands where the sun does in `conditions`.
    pub fn conditions(&self, conditions: &Conditions) -> Conditions {
        Conditions {
            solar_elevation: self.elevation,
            solar_azimuth: self.azimuth,
            ..*conditions
        }
    }

    /// Unit vector towards its centre.
    pub fn direction(&self) -> [f64; 3] {
        direction(self.elevation, self.azimuth)
    }

    /// Its spectral irradiance outside the air over that of the sun, at wavelengths in nm.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a phase angle outside 0..=π or a distance outside [`Moon::DISTANCES`].
    pub fn relative_irradiance(&self) -> Result<impl Fn(f64) -> f64> {
        let check = |parameter, value: f64, [min, max]: [f64; 2], unit| match (min..=max)
            .contains(&value)
        {
            true => Ok(()),
            false => Err(Error::OutOfRange {
                parameter,
                value,
                min,
                max,
                unit,
            }),
        };
        check("phase_angle", self.phase_angle, [0.0, PI], "rad")?;
        check("distance", self.distance, Self::DISTANCES, "m")?;
        let reflectance = DiscReflectance::new(self.phase_angle);
        let share = SOLID_ANGLE / PI * (Self::MEAN_DISTANCE / self.distance).powi(2);
        Ok(move |wavelength| share * reflectance.at(wavelength))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phase_angles_follow_from_directions() {
        let sun = [1.0, 0.0, 0.0];
        let at = |degrees: f64| {
            let (y, x) = degrees.to_radians().sin_cos();
            Moon::phase_angle_between([3.0 * x, 3.0 * y, 0.0], sun).to_degrees()
        };
        assert!(at(180.0) < 1e-6 && (at(0.0) - 180.0).abs() < 1e-6);
        // At right angles the sun is not quite at infinity: the moon is a little more than half lit.
        assert!((at(90.0) - 89.853).abs() < 1e-3, "{}", at(90.0));
    }

    /// Illuminance of the full moon outside the air: 0.32 lx at mean distance (for instance Kyba, Mohar and Posch 2017,
    /// *How bright is moonlight?*, with 0.26 to 0.32 lx under the air).
    #[test]
    fn the_full_moon_gives_a_third_of_a_lux() {
        let ratio = Moon::default().relative_irradiance().unwrap()(555.0);
        let illuminance = ratio * 133_100.0;
        assert!((0.29..0.40).contains(&illuminance), "{illuminance} lx");
    }

    #[test]
    fn what_is_no_moon_is_refused() {
        for (phase_angle, distance) in [(-0.1, 3.8e8), (3.2, 3.8e8), (f64::NAN, 3.8e8), (0.1, 1e8)]
        {
            let moon = Moon {
                phase_angle,
                distance,
                ..Moon::default()
            };
            assert!(moon.relative_irradiance().is_err());
        }
    }
}
