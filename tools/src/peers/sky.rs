//! What a model of the sky is asked, here.

use super::colour::ToXyz;
use super::lanes::Lanes;

/// Who looks, and where the sun stands: its azimuth is that of +x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observer {
    /// Geometric elevation of the sun's centre, radians.
    pub solar_elevation: f64,
    /// Above the ground, m.
    pub altitude: f64,
}

impl Observer {
    /// At altitude 0.
    pub fn on_the_ground(solar_elevation: f64) -> Self {
        Self {
            solar_elevation,
            altitude: 0.0,
        }
    }

    /// Unit vector towards the sun.
    pub fn sun(&self) -> [f32; 3] {
        let (z, x) = self.solar_elevation.sin_cos();
        [x as f32, 0.0, z as f32]
    }
}

/// A model of the sky with its parameters.
pub trait SkyModel: Send + Sync {
    /// The sky of an observer, if the model has one.
    fn sky(&self, observer: Observer) -> Option<Box<dyn Sky + '_>>;
    /// Memory of what serves all suns.
    fn bytes(&self) -> usize;
}

/// A sky under one sun.
pub trait Sky: Send + Sync {
    /// CIE XYZ (cd m⁻²) of a unit vector, if the model knows anything there.
    fn xyz(&self, direction: [f32; 3]) -> Option<[f32; 3]>;
    /// Memory of what serves this sun only.
    fn bytes(&self) -> usize {
        0
    }
}

/// As [`SkyModel`], at wavelengths.
pub trait LaneModel<const K: usize>: Send + Sync {
    /// The sky of an observer, if the model has one.
    fn sky(&self, observer: Observer) -> Option<Box<dyn LaneSky<K> + '_>>;
    /// Memory of what serves all suns.
    fn bytes(&self) -> usize;
}

/// As [`Sky`], at wavelengths.
pub trait LaneSky<const K: usize>: Send + Sync {
    /// Radiance per unit of solar irradiance, sr⁻¹.
    fn relative_radiance(&self, direction: [f32; 3]) -> Option<Lanes<K>>;
    /// Memory of what serves this sun only.
    fn bytes(&self) -> usize {
        0
    }
}

/// A model at wavelengths, seen.
pub struct Coloured<M, const K: usize> {
    /// The model.
    pub model: M,
    /// How its lanes look.
    pub colour: ToXyz<K>,
}

impl<M: LaneModel<K>, const K: usize> SkyModel for Coloured<M, K> {
    fn sky(&self, observer: Observer) -> Option<Box<dyn Sky + '_>> {
        let sky = self.model.sky(observer)?;
        let colour = &self.colour;
        Some(Box::new(ColouredSky { sky, colour }))
    }

    fn bytes(&self) -> usize {
        self.model.bytes()
    }
}

struct ColouredSky<'a, const K: usize> {
    sky: Box<dyn LaneSky<K> + 'a>,
    colour: &'a ToXyz<K>,
}

impl<const K: usize> Sky for ColouredSky<'_, K> {
    fn xyz(&self, direction: [f32; 3]) -> Option<[f32; 3]> {
        let ratio = self.sky.relative_radiance(direction)?;
        Some(self.colour.xyz(ratio))
    }

    fn bytes(&self) -> usize {
        self.sky.bytes()
    }
}
