//! `--parameter` instead of `--visibility`, and how the air is told of: see [`Model::axis`].

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

/// Refuses that nothing says how much of the axis there is: its nodes have no usual value.
pub fn required(model: &Model, is_given: bool) -> Result<()> {
    match model.axis()? {
        Some(axis) if !is_given && axis.values().len() > 1 => {
            let [name, unit] = [axis.name(), axis.unit()].map(printable);
            let [min, max] = axis.range().map(plain);
            let space = if unit.is_empty() { "" } else { " " };
            Err(Failure::message(format!(
                "the air of this model depends on {name}: --parameter {min} to {max}{space}{unit} is needed"
            )))
        }
        _ => Ok(()),
    }
}

/// What the model's axis has at a visibility (m), if it has another one than visibilities.
pub fn value(model: &Model, visibility: f64) -> Result<Option<(ModelAxis, f64)>> {
    let axis = model.axis()?;
    let with = |axis: ModelAxis| {
        let value = axis.value(visibility)?;
        Ok((axis, rounded(value)))
    };
    axis.map(with).transpose()
}

/// The air in words: its visibility (m), or what stands in place of that.
pub fn air(model: &Model, visibility: f64) -> Result<String> {
    Ok(match value(model, visibility)? {
        Some((axis, value)) => {
            let [name, unit] = [axis.name(), axis.unit()].map(printable);
            let space = if unit.is_empty() { "" } else { " " };
            format!("{name} {}{space}{unit}", plain(value))
        }
        // To the metre: what turbidity asks for has no end.
        None => format!("visibility {} km", plain(visibility.round() / 1e3)),
    })
}

/// Without the digits that interpolation makes up.
pub fn rounded(value: f64) -> f64 {
    format!("{value:.8e}").parse().unwrap_or(value)
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
