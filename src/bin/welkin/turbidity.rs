//! `--turbidity` instead of `--visibility`: see [`Model::turbidity`].

use std::io::Write;

use welkin::Model;

use crate::failure::{Result, plain};

/// The visibility (m) of a turbidity; with `clamp` the nearest that the model reaches.
pub fn visibility(model: &Model, turbidity: f64, clamp: bool) -> Result<f64> {
    let [min, max] = model.turbidity_range()?;
    let reached = turbidity.clamp(min, max);
    if !clamp || turbidity.is_nan() || reached == turbidity {
        return Ok(model.visibility_of_turbidity(turbidity)?);
    }
    let [from, to] = [turbidity, reached].map(|v| plain((v * 1e3).round() / 1e3));
    // Nobody is left to tell when standard error is closed.
    let _ = writeln!(
        std::io::stderr(),
        "welkin: turbidity moved from {from} to {to}"
    );
    Ok(model.visibility_of_turbidity(reached)?)
}
