//! Turbidity, as other models of the sky describe the air, to the visibility that this one has.
//!
//! Equation 1 of Wilkie et al. 2021, after Preetham et al. 1999, *A Practical Analytic Model for Daylight*: the
//! vertical optical thickness of molecules and particles over that of molecules, at 550 nm. The thickness is that of
//! the air in the model.

use std::io::Write;

use welkin::{Error, Model};

use crate::failure::{Result, plain};

/// nm.
const WAVELENGTH: f64 = 550.0;
/// Vertical optical thickness of dry air at 1013.25 hPa: Bodhaine et al. 1999, *On Rayleigh Optical Depth
/// Calculations*.
const MOLECULES: f64 = 0.0971;
/// Of 345 DU of ozone, as in the US standard atmosphere; it absorbs, and so counts for neither.
const OZONE: f64 = 0.0306;

/// The visibility (m) of a turbidity; with `clamp` the nearest that the model reaches.
pub fn visibility(model: &Model, turbidity: f64, clamp: bool) -> Result<f64> {
    let [low, high] = model.visibility_range();
    let (min, max) = (of(model, high)?, of(model, low)?);
    let reached = turbidity.clamp(min, max);
    if reached != turbidity {
        if !clamp || turbidity.is_nan() {
            return Err(out_of_range(turbidity, min, max).into());
        }
        let [from, to] = [turbidity, reached].map(|v| plain((v * 1e3).round() / 1e3));
        // Nobody is left to tell when standard error is closed.
        let _ = writeln!(
            std::io::stderr(),
            "welkin: turbidity moved from {from} to {to}"
        );
    }
    // It grows with the reciprocal of the visibility, nearly in proportion.
    let [mut clear, mut hazy] = [high.recip(), low.recip()];
    for _ in 0..60 {
        let middle = 0.5 * (clear + hazy);
        match of(model, middle.recip())? < reached {
            true => clear = middle,
            false => hazy = middle,
        }
    }
    Ok((0.5 * (clear + hazy)).recip().clamp(low, high))
}

/// The turbidity at a visibility, m.
fn of(model: &Model, visibility: f64) -> Result<f64> {
    let air = model.transmittance(visibility)?;
    let through = air.transmittance_to_space_at([0.0; 3], [0.0, 0.0, 1.0], WAVELENGTH)?;
    Ok((-f64::from(through).ln() - OZONE) / MOLECULES)
}

fn out_of_range(value: f64, min: f64, max: f64) -> Error {
    // Rounded inwards, so that what is said can be asked for.
    let [min, max] = [(min * 1e3).ceil() * 1e-3, (max * 1e3).floor() * 1e-3];
    Error::OutOfRange {
        parameter: "turbidity",
        value,
        min: (min * 1e3).round() / 1e3,
        max: (max * 1e3).round() / 1e3,
        unit: "",
    }
}
