//! Ways to the light of a finite segment.

use super::segment_case::Case;
use crate::successive_orders::{NW, Spectrum};
use crate::units::Solved;
use anyhow::Result;
use std::sync::{Arc, Mutex, PoisonError};
use welkin::{AerialPerspective, Conditions, Model, SkyDifference};

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
    differences: Last<SkyDifference<'a>>,
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

impl<'a> Methods<'a> {
    /// `solved` has the visibilities of the cases.
    pub fn new(model: &'a Model, solved: &'a [Solved]) -> Self {
        Self {
            model,
            solved,
            hazes: Last(Mutex::new(None)),
            differences: Last(Mutex::new(None)),
        }
    }

    /// Light before it is kept from being negative, per unit of solar irradiance; `None` where Eq. 2 would need a sky
    /// from beyond the model's altitudes.
    pub fn light(&self, method: Method, case: &Case) -> Result<Option<Spectrum>> {
        let narrow = |values: [f64; NW]| Some(values.map(|v| v as f32));
        if method == Method::Quadrature {
            return Ok(narrow(self.quadrature(case)?));
        }
        if method == Method::Joined {
            return Ok(narrow(self.joined(case)?));
        }
        self.difference(method, case)
    }

    /// What [`Methods::light`] needs: the aerial perspective of the conditions of a case.
    pub fn aerial(&self, case: &Case) -> Result<Arc<AerialPerspective>> {
        let conditions = self.conditions(case, 0.0, case.sun);
        self.hazes
            .get(conditions, |c| self.model.aerial_perspective(c))
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

    fn difference(&self, method: Method, case: &Case) -> Result<Option<Spectrum>> {
        let conditions = self.conditions(case, 0.0, case.sun);
        let skies = self
            .differences
            .get(conditions, |c| self.model.sky_difference(c))?;
        let ([from, to], mut out) = (case.ends(), [0.0; NW]);
        let answer = match method {
            Method::Blurred => skies.blurred(from, to, &mut out),
            Method::Blend => skies.blended(&*self.aerial(case)?, from, to, &mut out),
            _ => skies.in_scattering(from, to, &mut out),
        };
        match answer {
            Ok(()) => Ok(Some(out)),
            Err(welkin::Error::OutOfRange { .. }) => Ok(None),
            Err(error) => Err(error.into()),
        }
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
}
