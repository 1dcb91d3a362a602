//! How a picture is exposed and developed, as arguments. The EXR is the light itself.

use clap::ValueEnum;
use welkin::Sky;

use crate::about::About;
use crate::failure::Result;
use crate::tone::{Film, Tone, WhiteBalance};

/// Luminance of scene white over that of the mean sky (a geometric mean), for the automatic exposure: photographers put a clear sky one
/// stop above middle grey, which is 0.18 of white.
const WHITE_OVER_SKY: f64 = 1.0 / 0.36;
/// Luminance of scene white at exposure value 0 (ISO 100), cd m⁻².
const WHITE_AT_EV_0: f64 = 1.2;

#[derive(clap::Args)]
pub struct Exposure {
    /// Exposure value of the PNG at ISO 100. Automatic if absent: the mean of the sky (a geometric mean over the upper hemisphere,
    /// without the disc of the sun) is one stop above middle grey, 0.36 of white. It changes as smoothly as the sun moves.
    #[arg(long, value_name = "EV", value_parser = value)]
    exposure: Option<f64>,
    /// Tone curve of the PNG.
    #[arg(long, value_enum, default_value_t)]
    tone: Tone,
    /// Which light is white in the PNG.
    #[arg(long, value_enum, default_value_t)]
    white_balance: WhiteBalance,
}

fn value(text: &str) -> std::result::Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (-60.0..=60.0).contains(&value) => Ok(value),
        _ => Err("expected a number in -60..=60".to_owned()),
    }
}

impl Exposure {
    /// For a sky of which so much (1 = all) reaches the film where the exposure is automatic.
    pub fn film(&self, sky: &Sky, share: f64) -> Result<Film> {
        let white = match self.exposure {
            Some(value) => WHITE_AT_EV_0 * value.exp2(),
            None => share * WHITE_OVER_SKY * mean_luminance(sky)?,
        };
        Ok(Film {
            white: white as f32,
            tone: self.tone,
            balance: self.white_balance,
        })
    }
}

impl Film {
    /// At ISO 100.
    pub fn exposure_value(&self) -> f64 {
        (f64::from(self.white) / WHITE_AT_EV_0).log2()
    }

    /// What the picture says about it.
    pub fn describe(&self, about: &mut About) {
        let name = |value: Option<clap::builder::PossibleValue>| {
            value.map_or(String::new(), |value| value.get_name().to_owned())
        };
        about.number("exposureValue", self.exposure_value());
        about.text("toneCurve", name(self.tone.to_possible_value()));
        about.text("whiteBalance", name(self.balance.to_possible_value()));
    }
}

/// Geometric mean over the upper hemisphere, cd m⁻².
fn mean_luminance(sky: &Sky) -> Result<f64> {
    let rings = 16;
    let spokes = 32;
    let sun = sky.conditions().solar_azimuth;
    let (mut sum, mut count) = (0.0, 0.0);
    for ring in 0..rings {
        let z = (f64::from(ring) + 0.5) / f64::from(rings);
        for spoke in 0..spokes {
            let phi = sun + f64::from(spoke) / f64::from(spokes) * std::f64::consts::TAU;
            let r = (1.0 - z * z).sqrt();
            let direction = [r * phi.cos(), r * phi.sin(), z].map(|v| v as f32);
            sum += f64::from(sky.xyz(direction)?[1]).max(1e-12).ln();
            count += 1.0;
        }
    }
    Ok((sum / count).exp())
}
