//! `--parameter` instead of `--visibility`: see [`Model::axis`].

use std::io::Write;

use welkin::output::printable;
use welkin::{Model, ModelAxis};

use crate::failure::{Failure, Result, plain};

/// The visibility (m) that stands for a value of the model's axis; with `clamp` of the nearest that the model reaches.
pub fn visibility(model: &Model, value: f64, clamp: bool) -> Result<f64> {
    let Some(axis) = model.axis()? else {
        let text = "--parameter: the nodes of this model stand for visibilities, not for another \
                    quantity: use --visibility";
        return Err(Failure::message(text));
    };
    let [min, max] = axis.range();
    let reached = value.clamp(min, max);
    if !clamp || value.is_nan() || reached == value {
        return Ok(axis.visibility(value)?);
    }
    say_moved(&axis, value, reached);
    Ok(axis.visibility(reached)?)
}

fn say_moved(axis: &ModelAxis, from: f64, to: f64) {
    let [name, unit] = [axis.name(), axis.unit()].map(printable);
    let space = if unit.is_empty() { "" } else { " " };
    let [from, to] = [from, to].map(plain);
    // Nobody is left to tell when standard error is closed.
    let _ = writeln!(
        std::io::stderr(),
        "welkin: {name} moved from {from} to {to}{space}{unit}"
    );
}
