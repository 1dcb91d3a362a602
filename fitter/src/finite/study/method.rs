//! Ways to the light of a finite segment.

use super::segment_case::Case;
use crate::successive_orders::{NW, Spectrum};
use crate::units::Solved;
use anyhow::Result;
use std::sync::{Arc, Mutex, PoisonError};
use welkin::{AerialPerspective, Conditions, Model, Sky, Transmittance};

/// A way to the light of a finite segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Wilkie et al. 2021, Eq. 2: the sky from the start less the attenuated sky from the end, not below zero.
    Difference,
    /// The same, averaged over seven directions within ±0.25° near the horizon at low altitude.
    Blurred,
    /// Quadrature of the stored source function: what `AerialPerspective` does.
    Quadrature,
    /// The same up to where the sky takes over: what `JoinedAerialPerspective` does.
    Joined,
    /// `Difference` and `Quadrature`, weighted by the inverse of their expected variances.
    Blend,
}

/// All methods.
pub const METHODS: [Method; 5] = [
    Method::Difference,
    Method::Blurred,
    Method::Quadrature,
    Method::Joined,
    Method::Blend,
];

/// Results of all methods, in the order of [`METHODS`].
pub type Lights = [Option<Spectrum>; METHODS.len()];

impl Method {
    /// For tables.
    pub fn name(self) -> &'static str {
        match self {
            Method::Difference => "Eq. 2",
            Method::Blurred => "Eq. 2, blurred",
            Method::Quadrature => "source",
            Method::Joined => "source, then sky",
            Method::Blend => "blend",
        }
    }
}

/// Evaluates all methods with one model.
pub struct Methods<'a> {
    model: &'a Model,
    solved: &'a [Solved],
    hazes: Last<AerialPerspective>,
    /// Of observers.
    skies: Last<Sky>,
}

/// What was prepared last: all pixels of a picture want the same.
struct Last<T>(Mutex<Option<(Conditions, Arc<T>)>>);

impl<T> Last<T> {
    fn get(
        &self,
        wanted: Conditions,
        prepare: impl FnOnce(&Conditions) -> welkin::Result<T>,
    ) -> Result<Arc<T>> {
        let lock = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let kept = lock().clone();
        if let Some((_, one)) = kept.filter(|(at, _)| *at == wanted) {
            return Ok(one);
        }
        let one = Arc::new(prepare(&wanted)?);
        *lock() = Some((wanted, one.clone()));
        Ok(one)
    }
}

/// Expected relative errors of the radiance of the sky and of the quadrature.
const EXPECTED: [f64; 2] = [0.003, 0.006];
/// The paper's renderer blurs up to this altitude (m) …
const BLUR_ALTITUDE: f64 = 300.0;
/// … this close to the horizon (rad) …
const BLUR_ANGLE: f64 = 0.052_36;
/// … by tilts of up to ± this much (rad).
const BLUR_TILT: f64 = 0.004_363;

/// Both terms of Eq. 2.
struct Terms {
    near: [f64; NW],
    far: [f64; NW],
}

impl Terms {
    fn difference(&self) -> [f64; NW] {
        std::array::from_fn(|w| self.near[w] - self.far[w])
    }
}

impl<'a> Methods<'a> {
    /// `solved` has the visibilities of the cases.
    pub fn new(model: &'a Model, solved: &'a [Solved]) -> Self {
        Self {
            model,
            solved,
            hazes: Last(Mutex::new(None)),
            skies: Last(Mutex::new(None)),
        }
    }

    /// Light before it is kept from being negative, per unit of solar irradiance; `None` where Eq. 2 would need a sky from
    /// beyond the model's altitudes.
    pub fn light(&self, method: Method, case: &Case) -> Result<Option<Spectrum>> {
        let narrow = |values: [f64; NW]| Some(values.map(|v| v as f32));
        if method == Method::Quadrature {
            return Ok(narrow(self.quadrature(case)?));
        }
        if method == Method::Joined {
            return Ok(narrow(self.joined(case)?));
        }
        let Some(terms) = self.terms(case)? else {
            return Ok(None);
        };
        Ok(match method {
            Method::Blurred => narrow(self.blurred(case, &terms)?),
            Method::Blend => narrow(blend(&self.quadrature(case)?, &terms)),
            _ => narrow(terms.difference()),
        })
    }

    /// What [`Methods::light`] needs: the aerial perspective of the conditions of a case.
    pub fn aerial(&self, case: &Case) -> Result<Arc<AerialPerspective>> {
        let conditions = self.conditions(case, 0.0, case.sun);
        self.hazes
            .get(conditions, |c| self.model.aerial_perspective(c))
    }

    /// The sky of an observer.
    fn observed(&self, conditions: Conditions) -> Result<Arc<Sky>> {
        self.skies.get(conditions, |c| self.model.sky(c))
    }

    fn quadrature(&self, case: &Case) -> Result<[f64; NW]> {
        let [from, to] = case.ends();
        let (mut light, mut through) = ([0.0; NW], [0.0; NW]);
        self.aerial(case)?
            .in_scattering(from, to, &mut light, &mut through)?;
        Ok(self.relative(&light))
    }

    fn joined(&self, case: &Case) -> Result<[f64; NW]> {
        let aerial = self.aerial(case)?;
        let sky = self
            .model
            .sky(&self.conditions(case, case.altitude, case.sun))?;
        let [_, to] = case.ends();
        let (mut light, mut through) = ([0.0; NW], [0.0; NW]);
        aerial
            .joined_to(&sky)?
            .in_scattering(to, &mut light, &mut through)?;
        Ok(self.relative(&light))
    }

    fn relative(&self, light: &[f32; NW]) -> [f64; NW] {
        let head = self.model.head();
        let irradiance = |w: usize| head.solar_irradiance_at(head.wavelengths[w]);
        std::array::from_fn(|w| f64::from(light[w]) / irradiance(w))
    }

    fn conditions(&self, case: &Case, altitude: f64, sun: f64) -> Conditions {
        Conditions {
            solar_elevation: sun,
            solar_azimuth: 0.0,
            visibility: self.solved[case.visibility].visibility,
            albedo: case.albedo,
            altitude,
        }
    }

    fn terms(&self, case: &Case) -> Result<Option<Terms>> {
        let [from, to] = case.ends();
        let air = self
            .model
            .transmittance(self.solved[case.visibility].visibility)?;
        let near = self.sky(case, &air, from, case.unit())?;
        let far = self.sky(case, &air, to, case.unit())?;
        let mut through = [0.0; NW];
        air.transmittance(from, to, &mut through)?;
        let (Some(near), Some(far)) = (near, far) else {
            return Ok(None);
        };
        let far = std::array::from_fn(|w| f64::from(through[w]) * far[w]);
        Ok(Some(Terms { near, far }))
    }

    /// Light of the sky that an observer at `place` (world frame) sees in `direction`, per unit of solar irradiance.
    fn sky(
        &self,
        case: &Case,
        air: &Transmittance,
        place: [f64; 3],
        direction: [f64; 3],
    ) -> Result<Option<[f64; NW]>> {
        let radius = air.planet().radius;
        let from_centre = [place[0], place[1], place[2] + radius];
        let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
        let distance = dot(from_centre, from_centre).sqrt();
        let up = from_centre.map(|v| v / distance);
        let sun = [case.sun.cos(), 0.0, case.sun.sin()];
        let sine = dot(sun, up).clamp(-1.0, 1.0);
        let level: [f64; 3] = std::array::from_fn(|k| sun[k] - sine * up[k]);
        let length = dot(level, level).sqrt().max(1e-12);
        let ahead = level.map(|v| v / length);
        let left = [
            up[1] * ahead[2] - up[2] * ahead[1],
            up[2] * ahead[0] - up[0] * ahead[2],
            up[0] * ahead[1] - up[1] * ahead[0],
        ];
        let altitude = (distance - radius).max(0.0);
        let [lowest, highest] = self.model.altitude_range();
        let suns = self.model.solar_elevation_range();
        if altitude >= 0.999 * air.planet().top {
            return Ok(Some([0.0; NW]));
        }
        if !(lowest..=highest).contains(&altitude) {
            return Ok(None);
        }
        let sun = sine.asin().clamp(suns[0], suns[1]);
        let conditions = self.conditions(case, altitude, sun);
        let sky = match place == case.ends()[0] {
            true => self.observed(conditions)?,
            false => Arc::new(self.model.sky(&conditions)?),
        };
        let local = [ahead, left, up].map(|axis| dot(direction, axis) as f32);
        let mut out = [0.0; NW];
        sky.relative_radiance(local, &mut out)?;
        Ok(Some(out.map(f64::from)))
    }

    fn blurred(&self, case: &Case, terms: &Terms) -> Result<[f64; NW]> {
        if case.altitude > BLUR_ALTITUDE || case.direction[0].abs() > BLUR_ANGLE {
            return Ok(terms.difference());
        }
        let (mut sum, mut count) = ([0.0; NW], 0.0);
        for i in -3..=3 {
            let mut tilted = *case;
            tilted.direction[0] += BLUR_TILT * f64::from(i) / 3.0;
            if let Some(terms) = self.terms(&tilted)? {
                let light = terms.difference();
                sum = std::array::from_fn(|w| sum[w] + light[w].max(0.0));
                count += 1.0;
            }
        }
        Ok(sum.map(|v| v / count))
    }
}

fn blend(quadrature: &[f64; NW], terms: &Terms) -> [f64; NW] {
    let difference = terms.difference();
    std::array::from_fn(|w| {
        let of_difference = EXPECTED[0].powi(2) * (terms.near[w].powi(2) + terms.far[w].powi(2));
        let of_quadrature = (EXPECTED[1] * quadrature[w]).powi(2);
        let share = of_quadrature / (of_quadrature + of_difference).max(1e-60);
        quadrature[w] + share * (difference[w] - quadrature[w])
    })
}
