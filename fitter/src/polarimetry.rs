//! How far the polarisation of a model is from held-out traced light, and what it would cost to drop the third Stokes
//! component.

use crate::assess::Quantiles;
use crate::dataset::Sample;
use crate::successive_orders::NW;
use anyhow::Result;
use welkin::{Conditions, Model, PolarisationFrame, Stokes};

/// Angles are compared where light is polarised more than this.
const POLARISED: f64 = 0.05;

/// An error of the polarisation and where it was made.
#[derive(Clone, Copy, Debug)]
pub struct Error {
    /// |model − truth| of the degree of linear polarisation.
    pub degree: f64,
    /// |model − truth| of the angle of polarisation, degrees; where the degree of the truth exceeds 0.05.
    pub angle: Option<f64>,
    /// Solar elevation, rad.
    pub solar_elevation: f64,
    /// Observer altitude, m.
    pub altitude: f64,
    /// Visibility, m.
    pub visibility: f64,
    /// Angle from the geometric horizon, rad.
    pub from_horizon: f64,
    /// Angle to the sun, rad.
    pub to_sun: f64,
}

/// A name, and what belongs under it.
pub type Class = (&'static str, fn(&Error) -> bool);

/// Directions of the sphere, suns and observers that are reported apart.
pub const CLASSES: [Class; 17] = [
    ("all", |_| true),
    ("sun −12..−8°", |e| e.solar_elevation < -0.1396),
    ("sun −8..−4.2°", |e| {
        (-0.1396..-0.0733).contains(&e.solar_elevation)
    }),
    ("sun −4.2..−2°", |e| {
        (-0.0733..-0.0349).contains(&e.solar_elevation)
    }),
    ("sun −2..0°", |e| {
        (-0.0349..0.0).contains(&e.solar_elevation)
    }),
    ("sun 0..12°", |e| {
        (0.0..0.2094).contains(&e.solar_elevation)
    }),
    ("sun 12..45°", |e| {
        (0.2094..0.785).contains(&e.solar_elevation)
    }),
    ("sun above 45°", |e| e.solar_elevation >= 0.785),
    ("below 500 m", |e| e.altitude < 500.0),
    ("500..2000 m", |e| (500.0..2000.0).contains(&e.altitude)),
    ("2000..6000 m", |e| (2000.0..6000.0).contains(&e.altitude)),
    ("above 6000 m", |e| e.altitude >= 6000.0),
    ("visibility below 30 km", |e| e.visibility < 30e3),
    ("visibility 30..80 km", |e| {
        (30e3..80e3).contains(&e.visibility)
    }),
    ("visibility above 80 km", |e| e.visibility >= 80e3),
    ("within 15° of the sun", |e| e.to_sun < 0.262),
    ("within 2° of the horizon", |e| e.from_horizon < 0.0349),
];

/// Errors of `model` at `samples` for all wavelengths with light.
pub fn errors(model: &Model, visibility: f64, samples: &[Sample]) -> Result<Vec<Error>> {
    let mut out = vec![];
    let mut light = vec![Stokes::default(); model.wavelengths().len()];
    let mut previous: Option<(Conditions, welkin::PolarisedSky)> = None;
    for sample in samples {
        let conditions = sample.conditions(visibility);
        let sky = match previous.take() {
            Some((same, sky)) if same == conditions => sky,
            _ => model.polarised_sky(&conditions)?,
        };
        sky.relative_stokes(sample.direction(), PolarisationFrame::Vertical, &mut light)?;
        let place = place(model, visibility, sample);
        for (got, truth) in light.iter().zip(traced(sample)) {
            if truth[0] > 0.0 {
                let got = [got.i, got.q, got.u].map(f64::from);
                out.push(compare(got, truth, place));
            }
        }
        previous = Some((conditions, sky));
    }
    Ok(out)
}

/// What is lost if the traced light itself has no third Stokes component in the sun-aligned frame.
pub fn without_u(model: &Model, visibility: f64, samples: &[Sample]) -> Vec<Error> {
    let mut out = vec![];
    for sample in samples {
        let place = place(model, visibility, sample);
        for truth in traced(sample).filter(|truth| truth[0] > 0.0) {
            let [i, q, _] = turned(truth, sample.sun_aligned());
            let kept = turned([i, q, 0.0], -sample.sun_aligned());
            out.push(compare(kept, truth, place));
        }
    }
    out
}

fn traced(sample: &Sample) -> impl Iterator<Item = [f64; 3]> {
    let [q, u] = sample.polarisation;
    (0..NW).map(move |w| [sample.radiance[w], q[w], u[w]])
}

/// Against axes that are turned by `angle`.
fn turned([i, q, u]: [f64; 3], angle: f64) -> [f64; 3] {
    let (s, c) = (2.0 * angle).sin_cos();
    [i, c * q + s * u, c * u - s * q]
}

fn compare(got: [f64; 3], truth: [f64; 3], place: Error) -> Error {
    let (degree, angle) = difference(got, truth);
    Error {
        degree,
        angle,
        ..place
    }
}

/// |got − truth| of the degree of linear polarisation and, where that of the truth exceeds 0.05, of the angle (degrees).
pub fn difference(
    [i, q, u]: [f64; 3],
    [truth_i, truth_q, truth_u]: [f64; 3],
) -> (f64, Option<f64>) {
    let degree = truth_q.hypot(truth_u) / truth_i;
    let got = if i > 0.0 { q.hypot(u) / i } else { 0.0 };
    // Half the angle between the vectors (Q, U).
    let turn = (q * truth_u - u * truth_q).atan2(q * truth_q + u * truth_u);
    let angle = (degree > POLARISED).then(|| (0.5 * turn).abs().to_degrees());
    ((got - degree).abs(), angle)
}

fn place(model: &Model, visibility: f64, sample: &Sample) -> Error {
    let planet = model.head().planet;
    Error {
        degree: 0.0,
        angle: None,
        solar_elevation: sample.solar_elevation,
        altitude: sample.altitude,
        visibility,
        from_horizon: planet.ray(sample.altitude, sample.view_elevation).angle,
        to_sun: sample.to_sun(),
    }
}

/// One line per class: degree of polarisation, then angle in degrees.
pub fn table(errors: &[Error]) -> String {
    let mut out = format!(
        "{:<26}{:>9}{:>9}{:>9}{:>9}{:>9}   {:>9}{:>9}\n",
        "", "values", "median", "p95", "p99", "max", "angle p95", "p99"
    );
    for (name, belongs) in CLASSES {
        let class = || errors.iter().filter(|e| belongs(e));
        if let Some(q) = Quantiles::of(class().map(|e| e.degree)) {
            out += &format!(
                "{name:<26}{:>9}{:>9.5}{:>9.5}{:>9.5}{:>9.4}",
                q.count, q.median, q.p95, q.p99, q.max
            );
            if let Some(q) = Quantiles::of(class().filter_map(|e| e.angle)) {
                out += &format!("   {:>8.3}°{:>8.3}°", q.p95, q.p99);
            }
            out.push('\n');
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turning_keeps_the_degree_and_moves_the_angle() {
        let place = Error {
            degree: 0.0,
            angle: None,
            solar_elevation: 0.0,
            altitude: 0.0,
            visibility: 1.0,
            from_horizon: 0.0,
            to_sun: 0.0,
        };
        let light = [1.0, 0.3, -0.4];
        let error = compare(turned(light, 2f64.to_radians()), light, place);
        assert!(error.degree < 1e-12);
        assert!((error.angle.unwrap() - 2.0).abs() < 1e-9);
        let weaker = compare([1.0, 0.27, -0.36], light, place);
        assert!((weaker.degree - 0.05).abs() < 1e-12 && weaker.angle.unwrap() < 1e-9);
        assert!(compare(light, [1.0, 0.01, 0.01], place).angle.is_none());
    }
}
