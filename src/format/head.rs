//! The head of a file in owned form: everything except the chunks.

use super::layout::{
    KIND_AXIS, KIND_COLUMN, KIND_ESTIMATE, KIND_POLARISATION, KIND_POLARISATION_BASIS,
    KIND_RADIANCE, KIND_RADIANCE_BASIS, KIND_SOURCE, KIND_SOURCE_BASIS, KIND_SPECTRUM,
    KIND_TRANSMITTANCE, Shape,
};
use super::matrix::{columns, pick};
use crate::geometry::Planet;
use crate::kernel::axis::sample;
use crate::kernel::axis::{ElevationAxis, Ends, coefficients};

/// Spline axis over the angle from the geometric horizon, on one side of it.
///
/// ```
/// use std::f64::consts::FRAC_PI_2;
/// use welkin::axis::alpha_angle;
/// use welkin::format::AlphaAxis;
///
/// let axis = AlphaAxis { intervals: 16, exponent: 3.0 };
/// // The first interval at the horizon is 16³ times narrower than the axis.
/// let angle = alpha_angle(1.0, FRAC_PI_2, axis.intervals, axis.exponent);
/// assert!((angle - FRAC_PI_2 / 4096.0).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AlphaAxis {
    /// Number of spline intervals.
    pub intervals: usize,
    /// How much denser the axis is at the horizon: the angle grows with this power of the coordinate, 1..=8.
    pub exponent: f64,
}

/// Shape of a phase function; its parameter per wavelength is in [`Field::parameter`].
///
/// ```
/// use welkin::Model;
/// use welkin::format::PhaseFunction;
///
/// let model = Model::default_model()?;
/// for field in &model.head().fields {
///     if field.phase == PhaseFunction::HenyeyGreenstein {
///         assert!(field.parameter.iter().all(|g| g.abs() < 1.0)); // asymmetry, by wavelength
///     }
/// }
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum PhaseFunction {
    /// Constant 1; the parameter is not used.
    None,
    /// Rayleigh; the parameter is the depolarisation ρ, 0..=1.
    Rayleigh,
    /// Henyey-Greenstein; the parameter is the asymmetry g, −1 < g < 1.
    HenyeyGreenstein,
}

/// A part of the radiance with a phase function of its own.
///
/// ```
/// use welkin::Model;
/// use welkin::format::PhaseFunction;
///
/// let model = Model::default_model()?;
/// let head = model.head();
/// for field in &head.fields {
///     assert_eq!(field.parameter.len(), head.wavelengths.len());
/// }
/// // One of them is light that the molecules of the air scatter once.
/// assert!(head.fields.iter().any(|field| field.phase == PhaseFunction::Rayleigh));
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Factor that depends on the angle to the sun.
    pub phase: PhaseFunction,
    /// Whether the ground reflected this light (scaled by the albedo).
    pub ground: bool,
    /// Which estimate the field is relative to; 0 in files without estimates.
    pub estimate: usize,
    /// Parameter of the phase function, `[wavelengths]`.
    pub parameter: Vec<f64>,
}

/// Axes, tables and provenance of a model. Angles in radians, lengths in metres, wavelengths in nanometres.
///
/// ```
/// use welkin::Model;
///
/// let model = Model::default_model()?;
/// let head = model.head();
/// assert_eq!(head.extinction.len(), head.visibilities.len() * head.constituents * head.wavelengths.len());
/// assert!(head.solar_irradiance_at(500.0) > 1.5); // W m⁻² nm⁻¹
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Head {
    /// Planet radius and top of the atmosphere, m.
    pub planet: Planet,
    /// Spline axis above the geometric horizon.
    pub up: AlphaAxis,
    /// Spline axis below the geometric horizon.
    pub down: AlphaAxis,
    /// Number of spline intervals over the azimuth 0..=π relative to the sun.
    pub phi_intervals: usize,
    /// Solar elevation axis.
    pub elevation: ElevationAxis,
    /// Wavelengths, nm, strictly increasing.
    pub wavelengths: Vec<f64>,
    /// Observer altitudes, m, strictly increasing.
    pub altitudes: Vec<f64>,
    /// Visibilities, m, strictly increasing.
    pub visibilities: Vec<f64>,
    /// Number of constituents of the air.
    pub constituents: usize,
    /// Constituents that absorb and do not scatter, bit k for constituent k: radiance is stored per share of the others
    /// in the optical depth.
    pub absorbers: u16,
    /// Whether fields are relative to estimates, and not to (1 − T) · ω · S.
    pub estimated: bool,
    /// Extinction coefficients where a constituent's profile is 1, m⁻¹, `[visibilities][constituents][wavelengths]`.
    pub extinction: Vec<f64>,
    /// Spherical albedo of the atmosphere seen from the ground, `[visibilities][wavelengths]`.
    pub spherical_albedo: Vec<f64>,
    /// CIE 1931 XYZ (cd m⁻² scale) per unit of relative radiance, `[wavelengths]`.
    pub xyz: Vec<[f64; 3]>,
    /// First wavelength of the solar spectrum, nm.
    pub solar_start: f64,
    /// Step of the solar spectrum, nm.
    pub solar_step: f64,
    /// Solar spectral irradiance, W m⁻² nm⁻¹.
    pub solar_irradiance: Vec<f32>,
    /// The fields of which the radiance is the sum.
    pub fields: Vec<Field>,
    /// JSON object with provenance and fit errors.
    pub metadata: String,
}

impl Head {
    /// Lengths of the tables in the chunks.
    pub fn shape(&self) -> Shape {
        Shape {
            up: coefficients(self.up.intervals, Ends::Free),
            down: coefficients(self.down.intervals, Ends::Free),
            phi: coefficients(self.phi_intervals, Ends::Mirrored),
            elevation: coefficients(self.elevation.intervals, Ends::Free),
            wavelengths: self.wavelengths.len(),
            channels: self.fields.len() * self.wavelengths.len(),
            constituents: self.constituents,
            levels: match self.estimated {
                true => 0,
                false => coefficients(self.elevation.intervals, Ends::Free),
            },
        }
    }

    /// The head of a file with these of the wavelengths. The colour weights stay as they are.
    pub(crate) fn at_wavelengths(&self, kept: &[usize]) -> Self {
        let nw = self.wavelengths.len();
        let field = |field: &Field| Field {
            parameter: pick(&field.parameter, kept),
            ..*field
        };
        Self {
            extinction: columns(&self.extinction, nw, kept),
            spherical_albedo: columns(&self.spherical_albedo, nw, kept),
            fields: self.fields.iter().map(field).collect(),
            xyz: pick(&self.xyz, kept),
            wavelengths: pick(&self.wavelengths, kept),
            ..self.clone()
        }
    }

    /// The same where the sun gives 1 W m⁻² nm⁻¹ at all wavelengths: what is made with it is relative.
    pub(crate) fn in_unit_sunlight(self) -> Self {
        Self {
            solar_irradiance: vec![1.0; 2],
            ..self
        }
    }

    /// Altitude nodes in the coordinate of interpolation between chunks, `h^(1/3)`.
    pub fn altitude_nodes(&self) -> Vec<f64> {
        self.altitudes.iter().map(|&h| altitude_node(h)).collect()
    }

    /// Visibility nodes in the coordinate of interpolation between chunks, `1/V`: strictly decreasing.
    pub fn visibility_nodes(&self) -> Vec<f64> {
        self.visibilities
            .iter()
            .map(|&v| visibility_node(v))
            .collect()
    }

    /// Wavelengths of the first and last sample of the solar spectrum, nm.
    pub fn solar_range(&self) -> [f64; 2] {
        let steps = self.solar_irradiance.len().saturating_sub(1) as f64;
        [self.solar_start, self.solar_start + steps * self.solar_step]
    }

    /// Solar spectral irradiance at a wavelength (nm), W m⁻² nm⁻¹, linear between samples and constant beyond them.
    pub fn solar_irradiance_at(&self, wavelength: f64) -> f64 {
        let axis = [self.solar_start, self.solar_step];
        sample(&self.solar_irradiance, axis, wavelength)
    }
}

pub(crate) fn altitude_node(altitude: f64) -> f64 {
    altitude.cbrt()
}

pub(crate) fn visibility_node(visibility: f64) -> f64 {
    1.0 / visibility
}

/// What a chunk holds.
///
/// ```
/// use welkin::Model;
/// use welkin::format::Kind;
///
/// let model = Model::default_model()?;
/// // Radiance for every altitude and visibility of the file.
/// let radiances = model.directory().iter().filter(|entry| entry.kind == Kind::Radiance);
/// let head = model.head();
/// assert_eq!(radiances.count(), head.altitudes.len() * head.visibilities.len());
/// assert_eq!(Kind::RadianceBasis.name(), "radiance basis");
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Kind {
    /// Factors of the radiance at one altitude and visibility.
    Radiance,
    /// Mean densities along rays from one altitude.
    Column,
    /// Factors of the polarisation at one altitude and visibility.
    Polarisation,
    /// What the polarisation of all altitudes and visibilities shares.
    PolarisationBasis,
    /// Densities of the air over altitude.
    Transmittance,
    /// Source function of multiply scattered light at one visibility.
    Source,
    /// What the sources of all visibilities share.
    SourceBasis,
    /// Factor matrices that all radiance chunks share.
    RadianceBasis,
    /// What lies between the wavelengths.
    Spectrum,
    /// Tables of the estimates that fields are relative to.
    Estimate,
    /// What the visibilities stand for.
    Axis,
    /// A kind that this reader skips.
    Unknown(u32),
}

impl Kind {
    pub(crate) fn from_code(code: u32) -> Self {
        match code {
            KIND_RADIANCE => Kind::Radiance,
            KIND_COLUMN => Kind::Column,
            KIND_POLARISATION => Kind::Polarisation,
            KIND_POLARISATION_BASIS => Kind::PolarisationBasis,
            KIND_TRANSMITTANCE => Kind::Transmittance,
            KIND_SOURCE => Kind::Source,
            KIND_SOURCE_BASIS => Kind::SourceBasis,
            KIND_RADIANCE_BASIS => Kind::RadianceBasis,
            KIND_SPECTRUM => Kind::Spectrum,
            KIND_ESTIMATE => Kind::Estimate,
            KIND_AXIS => Kind::Axis,
            other => Kind::Unknown(other),
        }
    }

    /// Name for messages.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Radiance => "radiance",
            Kind::Column => "column",
            Kind::Polarisation => "polarisation",
            Kind::PolarisationBasis => "polarisation basis",
            Kind::Transmittance => "transmittance",
            Kind::Source => "source",
            Kind::SourceBasis => "source basis",
            Kind::RadianceBasis => "radiance basis",
            Kind::Spectrum => "spectrum",
            Kind::Estimate => "estimate",
            Kind::Axis => "axis",
            Kind::Unknown(_) => "unknown",
        }
    }
}

/// A chunk in the directory.
///
/// ```
/// use welkin::Model;
/// use welkin::format::Kind;
///
/// let model = Model::default_model()?;
/// let bytes = |kind| {
///     let entries = model.directory().iter().filter(move |entry| entry.kind == kind);
///     entries.map(|entry| entry.length).sum::<usize>()
/// };
/// assert!(bytes(Kind::Radiance) > bytes(Kind::Column));
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// What it holds.
    pub kind: Kind,
    /// Index into the altitudes.
    pub altitude: Option<usize>,
    /// Index into the visibilities.
    pub visibility: Option<usize>,
    /// First byte in the file.
    pub offset: usize,
    /// Bytes in the file.
    pub length: usize,
    /// Bytes after decoding; equal to `length` for raw chunks.
    pub raw_length: usize,
    /// How the bytes are stored: [`ENCODING_RAW`](super::ENCODING_RAW) or [`ENCODING_ZSTD`](super::ENCODING_ZSTD).
    pub encoding: u32,
    /// CRC-32 of the bytes in the file.
    pub crc32: u32,
    /// Number of components; 0 for chunks without.
    pub rank: usize,
    /// Median error against the traced data, 0 if not measured: relative, or of the degree of polarisation.
    pub error_median: f32,
    /// 99th percentile of that error, 0 if not measured.
    pub error_p99: f32,
}
