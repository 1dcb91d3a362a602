//! What all threads share: the model, and its evaluators for questions that have nothing in common.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use welkin::{
    AerialPerspectiveQuery, Bands, Budget, Channels, Conditions, Interpolation, Model, Plan,
    PointQuery, PolarisedPointQuery, Result,
};

use crate::albedo::Ground;

/// The model and what is prepared of it when it is first needed.
///
/// Queries at any conditions verify all that they could ever read. Where that fails, because a chunk is missing or
/// damaged, or because the file is too large for them, there are none: then what a row needs is prepared row by row, so
/// that only rows that need the broken chunk get an error.
pub struct Shared<'a> {
    pub model: &'a Model,
    pub clamp: bool,
    /// Of a sensor, if answers are in those.
    pub bands: Option<Bands>,
    /// In place of the albedo of rows.
    pub ground: Option<&'a Ground>,
    /// In place of the visibility of rows, m.
    pub visibility: Option<f64>,
    /// Solar spectral irradiance at the wavelengths of the model.
    pub irradiance: Vec<f32>,
    moved: AtomicBool,
    point_query: OnceLock<Option<Box<PointQuery<'a>>>>,
    polarised: OnceLock<Option<Box<PolarisedPointQuery<'a>>>>,
    aerial: OnceLock<Option<AerialPerspectiveQuery<'a>>>,
}

impl<'a> Shared<'a> {
    pub fn new(model: &'a Model, clamp: bool, bands: Option<Bands>) -> Self {
        let head = model.head();
        let irradiance = |&l: &f64| head.solar_irradiance_at(l) as f32;
        Self {
            irradiance: head.wavelengths.iter().map(irradiance).collect(),
            model,
            clamp,
            bands,
            ground: None,
            visibility: None,
            moved: AtomicBool::new(false),
            point_query: OnceLock::new(),
            polarised: OnceLock::new(),
            aerial: OnceLock::new(),
        }
    }

    /// The same where all rows have this ground.
    pub fn over(mut self, ground: Option<&'a Ground>) -> Self {
        self.ground = ground;
        self
    }

    /// The same where all rows have this visibility, m.
    pub fn in_air(mut self, visibility: Option<f64>) -> Self {
        self.visibility = visibility;
        self
    }

    /// Radiance of any direction under any conditions, as exact as prepared skies.
    pub fn point_query(&self) -> Option<&PointQuery<'a>> {
        let prepared = self.point_query.get_or_init(|| {
            let query = self
                .model
                .point_query(&self.whole(Channels::Spectral).ok()?);
            Some(Box::new(
                query.ok()?.with_interpolation(Interpolation::Full),
            ))
        });
        prepared.as_deref()
    }

    /// The same of Stokes vectors.
    pub fn polarised(&self) -> Option<&PolarisedPointQuery<'a>> {
        let prepared = self.polarised.get_or_init(|| {
            let plan = self.whole(Channels::Stokes).ok()?;
            Some(Box::new(self.model.polarised_point_query(&plan).ok()?))
        });
        prepared.as_deref()
    }

    /// All conditions of the model.
    fn whole(&self, channels: Channels) -> Result<Plan> {
        self.model.plan(&Budget {
            altitude: self.model.altitude_range(),
            visibility: self.model.visibility_range(),
            solar_elevation: self.model.solar_elevation_range(),
            tolerance: 1.0,
            channels,
        })
    }

    /// Light of any segment under any conditions.
    pub fn aerial(&self) -> Option<&AerialPerspectiveQuery<'a>> {
        let prepared = self
            .aerial
            .get_or_init(|| self.model.aerial_perspective_query().ok());
        prepared.as_ref()
    }

    /// The conditions, moved into the model if that is wanted.
    pub fn reachable(&self, conditions: &Conditions) -> Result<Conditions> {
        if !self.clamp {
            return Ok(*conditions);
        }
        let reached = conditions.clamped(self.model)?;
        if reached != *conditions {
            self.moved.store(true, Ordering::Relaxed);
        }
        Ok(reached)
    }

    /// Whether conditions of any row were moved.
    pub fn has_moved(&self) -> bool {
        self.moved.load(Ordering::Relaxed)
    }

    /// Between the wavelengths of the model.
    pub fn between(&self, values: &[f32], wavelength: f64) -> Result<f32> {
        let interpolation = self.model.spectral_interpolation()?;
        interpolation.between(values, wavelength)
    }

    /// Spectral radiance from relative radiance.
    pub fn times_irradiance(&self, relative: f32, wavelength: f64) -> f32 {
        let irradiance = self.model.head().solar_irradiance_at(wavelength);
        (f64::from(relative) * irradiance).min(f64::from(f32::MAX)) as f32
    }
}
