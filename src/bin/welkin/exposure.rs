//! How a picture is exposed and developed, as arguments. The EXR is the light itself.

use std::f64::consts::TAU;

use clap::ValueEnum;
use welkin::Sky;

use crate::about::About;
use crate::failure::Result;
use crate::tone::{Film, Tone, WhiteBalance, luminance};
use crate::view::View;

/// Middle grey is 0.18 of white. Photographers put a clear sky one stop above it …
const SKY: f64 = 0.36;
/// … and a landscape with its sky half a stop.
const LANDSCAPE: f64 = 0.25;
/// A dark slope does not burn the sky above it: this share of a landscape may be brighter …
const BRIGHTEST: f64 = 0.05;
/// … than so many times white.
const BRIGHT: f64 = 2.0;
/// Luminance of scene white at exposure value 0 (ISO 100), cd m⁻².
const WHITE_AT_EV_0: f64 = 1.2;

#[derive(clap::Args)]
pub struct Exposure {
    /// Exposure value of the PNG at ISO 100. Automatic if absent: the mean of the sky (a geometric mean over the upper
    /// hemisphere, without the disc of the sun) is 0.36 of white, one stop above middle grey; the mean of a landscape
    /// (of all its pixels) 0.25, or less where more than a twentieth of it would be brighter than twice white. It
    /// changes as smoothly as the sun moves.
    #[arg(long, value_name = "EV", value_parser = value)]
    exposure: Option<f64>,
    /// Tone curve of the PNG.
    #[arg(long, value_enum, default_value_t)]
    tone: Tone,
    /// Which light is white in the PNG.
    #[arg(long, value_enum, default_value_t)]
    white_balance: WhiteBalance,
}

/// An exposure value that makes sense.
pub fn value(text: &str) -> std::result::Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (-60.0..=60.0).contains(&value) => Ok(value),
        _ => Err("expected a number in -60..=60".to_owned()),
    }
}

/// Luminance of scene white at an exposure value (ISO 100), cd m⁻².
pub fn white(value: f64) -> f64 {
    WHITE_AT_EV_0 * value.exp2()
}

impl Exposure {
    /// For a sky, with what the moon adds to it in a view.
    pub fn of_sky(&self, view: &View, sky: &Sky) -> Result<Film> {
        let white = match self.white() {
            Some(white) => white,
            None => mean_luminance(view, sky)? / SKY,
        };
        Ok(self.film(white))
    }

    /// For the pixels of a landscape: linear sRGB, cd m⁻².
    pub fn of_landscape(&self, pixels: &[[f32; 3]]) -> Film {
        let white = self.white().unwrap_or_else(|| {
            let luminances = pixels.iter().map(|&pixel| f64::from(luminance(pixel)));
            // Space is black.
            let mut luminances: Vec<_> = luminances.filter(|&l| l > 0.0).collect();
            if luminances.is_empty() {
                return WHITE_AT_EV_0;
            }
            let mean = geometric_mean(luminances.iter().copied());
            let bright = (luminances.len() as f64 * (1.0 - BRIGHTEST)) as usize;
            let (_, &mut bright, _) = luminances.select_nth_unstable_by(bright, f64::total_cmp);
            (mean / LANDSCAPE).max(bright / BRIGHT)
        });
        self.film(white)
    }

    fn white(&self) -> Option<f64> {
        self.exposure.map(white)
    }

    fn film(&self, white: f64) -> Film {
        Film {
            white: white as f32,
            tone: self.tone,
            balance: self.white_balance,
        }
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
fn mean_luminance(view: &View, sky: &Sky) -> Result<f64> {
    const RINGS: usize = 16;
    const SPOKES: usize = 32;
    let sun = sky.conditions().solar_azimuth;
    let places = (0..RINGS * SPOKES).map(|k| {
        let z = ((k / SPOKES) as f64 + 0.5) / RINGS as f64;
        let level = (1.0 - z * z).sqrt();
        let (y, x) = (sun + TAU * (k % SPOKES) as f64 / SPOKES as f64).sin_cos();
        [level * x, level * y, z].map(|v| v as f32)
    });
    let luminances: welkin::Result<Vec<f64>> = places
        .map(|direction| Ok(f64::from(view.xyz(sky, direction)?[1])))
        .collect();
    Ok(geometric_mean(luminances?.into_iter()))
}

/// Of luminances; black counts as next to nothing.
fn geometric_mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    let sum: f64 = values.map(|v| v.max(1e-12).ln()).sum();
    (sum / count).exp()
}
