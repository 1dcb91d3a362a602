//! A recipe with one number changed.

use super::error::{RecipeError, field};
use super::file::{File, Layer};

/// What can be changed: the numbers that say how much there is.
const PARAMETERS: &str = "ozone (DU), water (cm), pressure (hPa), humidity (%), optical_depth, visibility (km), \
    sun_distance (AU), layers.NAME.optical_depth, layers.NAME.extinction (1/km), layers.NAME.visibility (km), \
    layers.NAME.humidity (%), layers.NAME.bottom (km), layers.NAME.top (km) and layers.NAME.scale_height (km)";

/// Changes it; whether the result makes sense is for others to say.
pub fn change(file: &mut File, parameter: &str, value: f64) -> Result<(), RecipeError> {
    match parameter {
        "ozone" => file.gases.ozone_du = Some(value),
        "water" => file.gases.water_cm = Some(value),
        "pressure" => file.gases.surface_pressure_hpa = Some(value),
        "humidity" => file.aerosol.humidity_percent = Some(value),
        "sun_distance" => file.sun.distance_au = value,
        "optical_depth" => optical_depth(file, value),
        "visibility" => visibility(file, value),
        _ => return in_layer(file, parameter, value),
    }
    Ok(())
}

/// The optical depth says how much there is instead of a visibility.
fn optical_depth(file: &mut File, value: f64) {
    file.aerosol.optical_depth_550 = Some(value);
    file.aerosol.visibility_km = None;
}

/// That of the layer which has one, or else that of all layers at the ground.
fn visibility(file: &mut File, value: f64) {
    let fog = file
        .layers
        .values_mut()
        .find(|layer| layer.visibility_km.is_some());
    match fog {
        Some(layer) => layer.visibility_km = Some(value),
        None => {
            file.aerosol.visibility_km = Some(value);
            file.aerosol.optical_depth_550 = None;
        }
    }
}

fn in_layer(file: &mut File, parameter: &str, value: f64) -> Result<(), RecipeError> {
    let unknown = || field(parameter, format!("cannot be changed; {PARAMETERS} can"));
    let path = parameter
        .strip_prefix("layers.")
        .and_then(|rest| rest.rsplit_once('.'));
    let (name, what) = path.ok_or_else(unknown)?;
    let layer = file.layers.get_mut(name);
    let layer = layer.ok_or_else(|| field(parameter, format!("there is no layer {name:?}")))?;
    match what {
        "optical_depth" => amount(layer).optical_depth_550 = Some(value),
        "extinction" => amount(layer).extinction_550_per_km = Some(value),
        "visibility" => amount(layer).visibility_km = Some(value),
        "humidity" => layer.humidity_percent = Some(value),
        "bottom" => layer.bottom_km = Some(value),
        "top" => layer.top_km = Some(value),
        "scale_height" => layer.scale_height_km = Some(value),
        _ => return Err(unknown()),
    }
    Ok(())
}

/// The layer without what said how much there is.
fn amount(layer: &mut Layer) -> &mut Layer {
    layer.optical_depth_550 = None;
    layer.extinction_550_per_km = None;
    layer.visibility_km = None;
    layer
}
