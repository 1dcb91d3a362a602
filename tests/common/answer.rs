//! One line of the conformance suite's queries, answered by the library.

use welkin::{
    AerialPerspective, Conditions, Error, Model, PolarisationFrame, Stokes, StokesSpectra,
};

/// The values, or the class of the error.
pub fn answer(model: &Model, line: &str) -> Result<Vec<f32>, &'static str> {
    let (quantity, rest) = line.split_once('\t').unwrap_or((line, ""));
    let numbers: Result<Vec<f64>, _> = rest.split('\t').map(str::parse).collect();
    let Ok(cells) = numbers else {
        return Err("query");
    };
    let Ok(
        [
            altitude,
            visibility,
            albedo,
            solar_elevation,
            solar_azimuth,
            x,
            y,
            z,
            wavelength,
            distance,
        ],
    ) = <[f64; 10]>::try_from(cells)
    else {
        return Err("query");
    };
    let conditions = Conditions {
        altitude,
        visibility,
        albedo,
        solar_elevation,
        solar_azimuth,
    };
    let segment = ends(altitude, [x, y, z], distance);
    match quantity {
        "axis_visibility" => {
            let answer = axis_visibility(model, visibility);
            return answer.map(|v| vec![v as f32]).map_err(|e| e.class());
        }
        "transmittance" => return transmittance(model, visibility, segment).map_err(|e| e.class()),
        "in_scattering" => {
            return in_scattering(model, &conditions, segment).map_err(|e| e.class());
        }
        "in_scattering_stokes" => {
            return in_scattering_stokes(model, &conditions, segment).map_err(|e| e.class());
        }
        "transmittance_at" => {
            let through = transmittance_at(model, visibility, segment, wavelength);
            return through.map_err(|e| e.class());
        }
        "in_scattering_at" => {
            let light = in_scattering_at(model, &conditions, segment, wavelength);
            return light.map(|[l, ..]| vec![l]).map_err(|e| e.class());
        }
        "in_scattering_stokes_at" => {
            let light = in_scattering_stokes_at(model, &conditions, segment, wavelength);
            return light.map(Vec::from).map_err(|e| e.class());
        }
        _ => {}
    }
    let direction = [x, y, z].map(|v| v as f32);
    values(model, quantity, &conditions, direction, wavelength).map_err(|error| error.class())
}

/// Of the value that stands where visibilities do.
fn axis_visibility(model: &Model, value: f64) -> Result<f64, Error> {
    let absent = || Error::MissingChunk {
        kind: "axis",
        altitude: None,
        visibility: None,
    };
    model.axis()?.ok_or_else(absent)?.visibility(value)
}

fn values(
    model: &Model,
    quantity: &str,
    conditions: &Conditions,
    direction: [f32; 3],
    wavelength: f64,
) -> Result<Vec<f32>, Error> {
    let sky = model.sky(conditions)?;
    let mut row = vec![0.0; sky.wavelengths().len()];
    match quantity {
        "relative_radiance" => sky.relative_radiance(direction, &mut row)?,
        "radiance" => sky.radiance(direction, &mut row)?,
        "relative_radiance_at" => {
            return Ok(vec![sky.relative_radiance_at(direction, wavelength)?]);
        }
        "radiance_at" => return Ok(vec![sky.radiance_at(direction, wavelength)?]),
        "stokes" => {
            let mut light = vec![Stokes::default(); row.len()];
            let sky = model.polarised_sky(conditions)?;
            sky.relative_stokes(direction, PolarisationFrame::Vertical, &mut light)?;
            let parts: [fn(&Stokes) -> f32; 3] = [|s| s.i, |s| s.q, |s| s.u];
            return Ok(parts
                .iter()
                .flat_map(|part| light.iter().map(part))
                .collect());
        }
        "stokes_at" => {
            let sky = model.polarised_sky(conditions)?;
            let light = sky.stokes_at(direction, PolarisationFrame::Vertical, wavelength)?;
            let sun = model.head().solar_irradiance_at(wavelength) as f32;
            return Ok([light.i, light.q, light.u].map(|v| v / sun).to_vec());
        }
        "xyz" => return Ok(sky.xyz(direction)?.to_vec()),
        other => panic!("unknown quantity {other}"),
    }
    Ok(row)
}

/// The ends of a segment that starts above the origin.
fn ends(altitude: f64, direction: [f64; 3], distance: f64) -> [[f64; 3]; 2] {
    let length = direction.iter().map(|v| v * v).sum::<f64>().sqrt();
    let from = [0.0, 0.0, altitude];
    let to = core::array::from_fn(|i| from[i] + direction[i] / length * distance);
    [from, to]
}

fn transmittance(
    model: &Model,
    visibility: f64,
    [from, to]: [[f64; 3]; 2],
) -> Result<Vec<f32>, Error> {
    let air = model.transmittance(visibility)?;
    let mut row = vec![0.0; air.wavelengths().len()];
    air.transmittance(from, to, &mut row)?;
    Ok(row)
}

fn transmittance_at(
    model: &Model,
    visibility: f64,
    [from, to]: [[f64; 3]; 2],
    wavelength: f64,
) -> Result<Vec<f32>, Error> {
    let air = model.transmittance(visibility)?;
    Ok(vec![air.transmittance_at(from, to, wavelength)?])
}

/// Per unit of solar irradiance.
fn in_scattering_at(
    model: &Model,
    conditions: &Conditions,
    [from, to]: [[f64; 3]; 2],
    wavelength: f64,
) -> Result<[f32; 1], Error> {
    let aerial = aerial(model, conditions)?;
    Ok([aerial.relative_in_scattering_at(from, to, wavelength)?])
}

/// L, Q and U.
fn in_scattering_stokes_at(
    model: &Model,
    conditions: &Conditions,
    [from, to]: [[f64; 3]; 2],
    wavelength: f64,
) -> Result<[f32; 3], Error> {
    let aerial = aerial(model, conditions)?;
    let frame = PolarisationFrame::Vertical;
    let light = aerial.relative_stokes_at(from, to, frame, wavelength)?;
    Ok([light.i, light.q, light.u])
}

/// Per unit of solar irradiance.
fn in_scattering(
    model: &Model,
    conditions: &Conditions,
    [from, to]: [[f64; 3]; 2],
) -> Result<Vec<f32>, Error> {
    let aerial = aerial(model, conditions)?;
    let mut light = vec![0.0; aerial.wavelengths().len()];
    let mut through = light.clone();
    aerial.in_scattering(from, to, &mut light, &mut through)?;
    Ok(per_sun(model, &light))
}

/// L, then Q, then U.
fn in_scattering_stokes(
    model: &Model,
    conditions: &Conditions,
    [from, to]: [[f64; 3]; 2],
) -> Result<Vec<f32>, Error> {
    let aerial = aerial(model, conditions)?;
    let [mut i, mut q, mut u, mut through] =
        [(); 4].map(|()| vec![0.0; aerial.wavelengths().len()]);
    let light = StokesSpectra {
        i: &mut i,
        q: &mut q,
        u: &mut u,
    };
    aerial.in_scattering_stokes(from, to, PolarisationFrame::Vertical, light, &mut through)?;
    Ok([i, q, u].map(|part| per_sun(model, &part)).concat())
}

fn aerial(model: &Model, conditions: &Conditions) -> Result<AerialPerspective, Error> {
    // An aerial perspective does not ask where the observer is.
    let [altitude, _] = model.altitude_range();
    model.aerial_perspective(&Conditions {
        altitude,
        ..*conditions
    })
}

fn per_sun(model: &Model, light: &[f32]) -> Vec<f32> {
    let head = model.head();
    let suns = head.wavelengths.iter();
    let suns = suns.map(|wavelength| head.solar_irradiance_at(*wavelength) as f32);
    light.iter().zip(suns).map(|(l, sun)| l / sun).collect()
}
