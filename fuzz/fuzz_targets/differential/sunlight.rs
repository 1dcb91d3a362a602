//! The light of the sun through the air, from the radiance of its disc. Format specification, section 7.8.

use std::path::Path;
use std::sync::OnceLock;

use welkin::{Conditions, Model};

use crate::question::{Answer, Question};
use crate::readers::ABSTAINS;

/// Irradiance times transmittance at a wavelength: what other readers, which know of no disc, can be asked for.
pub fn of_disc(model: &Model, question: &Question) -> Answer {
    let wavelength = question.cells[8];
    let class = |error: welkin::Error| error.class().to_owned();
    let disc = model.solar_disc(&question.conditions()).map_err(class)?;
    let radiance = disc
        .radiance_at(disc.direction(), wavelength)
        .map_err(class)?;
    let has_air = model.transmittance(question.cells[1]).is_ok();
    match centre_over_mean(wavelength) {
        // Part of the disc is below the horizon, which moves its centre of light, or all of it.
        _ if question.cells[3] < LOWEST => Err(ABSTAINS.to_owned()),
        Some(share) if has_air => Ok(vec![f64::from(radiance) / share]),
        _ => Err(ABSTAINS.to_owned()),
    }
}

/// Elevation of the sun, rad, from which all of the disc is above any horizon.
const LOWEST: f64 = 0.01;

/// Radiance of the disc's centre over irradiance, sr⁻¹, outside the air: of a sun at the zenith of a sound file, so that
/// the limb darkening is the library's.
fn centre_over_mean(wavelength: f64) -> Option<f64> {
    static SOUND: OnceLock<Model> = OnceLock::new();
    let sound = SOUND.get_or_init(|| {
        let files = Path::new(env!("CARGO_MANIFEST_DIR")).join("../format-spec/conformance/files");
        Model::open(files.join("spectrum-air.welkin")).expect("a file of the suite")
    });
    let conditions = Conditions {
        solar_elevation: sound.solar_elevation_range()[1],
        visibility: sound.visibility_range()[1],
        altitude: sound.altitude_range()[0],
        ..Conditions::default()
    };
    let disc = sound.solar_disc(&conditions).expect("a sound file");
    let centre = disc.direction();
    let from = [0.0, 0.0, conditions.altitude];
    let air = sound
        .transmittance(conditions.visibility)
        .expect("a sound file");
    let passed = air
        .transmittance_to_space_at(from, centre.map(f64::from), wavelength)
        .ok()?;
    let irradiance = sound.head().solar_irradiance_at(wavelength) * f64::from(passed);
    Some(f64::from(disc.radiance_at(centre, wavelength).ok()?) / irradiance)
}
