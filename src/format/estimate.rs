//! Tables of the estimates that fields are relative to (kind 10), to be written. Format specification, section 6.10.

use zerocopy::IntoBytes;
use zerocopy::little_endian::{F32, U32};

use super::estimate_view::{EstimateCounts, EstimateView, MAX_ESTIMATE_CONSTITUENTS};
use super::head::{Field, Head};
use super::payload_bytes::{check, push_f32};
use crate::error::{Error, Result};

/// Tables of the estimates that fields are relative to, to be written: see [`EstimateView`]. Rows over constituents are 8
/// wide, rows over wavelengths a multiple of 8.
///
/// ```
/// use welkin::format::Estimate;
///
/// let (constituents, stride) = (1, 8);
/// let estimate = Estimate {
///     sun_lowest: -0.3,
///     sun_width: 0.1,
///     level: vec![0.0, 100e3], // m
///     ring: vec![0.0],
///     scatters: vec![1],
///     albedo: vec![1.0; constituents * stride],
///     density: vec![0.5; 8 * 2],
///     column: vec![9.0; 8 * 2 * 2],
///     light: vec![-3.0; 2 * 2 * stride],
///     ..Estimate::default()
/// };
/// assert_eq!(estimate.level.len(), 2);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Estimate {
    /// Angles above the horizon.
    pub angles: usize,
    /// Solar elevations.
    pub suns: usize,
    /// Sine of the lowest solar elevation of `light`.
    pub sun_lowest: f32,
    /// Sines of solar elevations of `light` are equidistant in arsinh(sine / width).
    pub sun_width: f32,
    /// Altitudes at which a ray has stops, m, from 0 to the top of the atmosphere.
    pub level: Vec<f32>,
    /// Altitudes of rays of the sun that touch the Earth, behind which a view ray has stops, m.
    pub ring: Vec<f32>,
    /// Bit k: constituent k scatters in the estimate. The last estimate is of diffuse light, the others of sunlight.
    pub scatters: Vec<u32>,
    /// Share of the extinction that an estimate scatters, `[estimates][constituents][stride]`.
    pub albedo: Vec<f32>,
    /// Profiles of the constituents, `[densities][8]`, equidistant in the root of the altitude.
    pub density: Vec<f32>,
    /// ln of columns to space, m, `[levels][angles][8]`, equidistant in the root of the angle from horizon to zenith.
    pub column: Vec<f32>,
    /// ln of the mean radiance of scattered light, sr⁻¹, `[levels][suns][stride]`.
    pub light: Vec<f32>,
}

fn narrow(values: &[F32]) -> Vec<f32> {
    values.iter().map(|v| v.get()).collect()
}

impl From<&EstimateView<'_>> for Estimate {
    fn from(view: &EstimateView) -> Self {
        Self {
            angles: view.angles,
            suns: view.suns,
            sun_lowest: view.sun_lowest,
            sun_width: view.sun_width,
            level: narrow(view.level),
            ring: narrow(view.ring),
            scatters: view.scatters.iter().map(|s| s.get()).collect(),
            albedo: narrow(view.albedo),
            density: narrow(view.density),
            column: narrow(view.column),
            light: narrow(view.light),
        }
    }
}

impl Estimate {
    /// Leaves out all but these of `wavelengths` nodes.
    pub(crate) fn keep(&mut self, wavelengths: usize, nodes: &[usize]) {
        let (old, new) = [wavelengths, nodes.len()]
            .map(|n| n.next_multiple_of(8))
            .into();
        for table in [&mut self.albedo, &mut self.light] {
            let rows = table.chunks_exact(old);
            let row = |row: &[f32]| {
                let kept = nodes.iter().map(|&n| row[n]);
                kept.chain(std::iter::repeat(0.0))
                    .take(new)
                    .collect::<Vec<f32>>()
            };
            *table = rows.flat_map(row).collect();
        }
    }

    /// The payload in a file with this head.
    ///
    /// # Errors
    /// [`Error::Length`](crate::Error::Length) and [`Error::Invalid`](crate::Error::Invalid) for tables that break the
    /// specification.
    pub fn encode(&self, constituents: usize, wavelengths: usize, top: f64) -> Result<Vec<u8>> {
        let stride = wavelengths.next_multiple_of(8);
        let width = MAX_ESTIMATE_CONSTITUENTS;
        let levels = self.level.len();
        check(
            "albedo",
            &self.albedo,
            self.scatters.len() * constituents * stride,
        )?;
        check("density", &self.density, self.density.len() / width * width)?;
        check(
            "column of the estimate",
            &self.column,
            levels * self.angles * width,
        )?;
        check("light", &self.light, levels * self.suns * stride)?;
        let count = |n: usize| U32::new(n as u32);
        let counts = EstimateCounts {
            levels: count(levels),
            angles: count(self.angles),
            suns: count(self.suns),
            densities: count(self.density.len() / width),
            rings: count(self.ring.len()),
            estimates: count(self.scatters.len()),
            sun_lowest: F32::new(self.sun_lowest),
            sun_width: F32::new(self.sun_width),
        };
        let mut bytes = counts.as_bytes().to_vec();
        push_f32(&mut bytes, &self.level);
        push_f32(&mut bytes, &self.ring);
        bytes.extend(self.scatters.iter().flat_map(|s| s.to_le_bytes()));
        for table in [&self.albedo, &self.density, &self.column, &self.light] {
            push_f32(&mut bytes, table);
        }
        let view = EstimateView::new(&bytes, constituents, wavelengths, top)?;
        match view.is_padded(wavelengths) {
            true => Ok(bytes),
            false => Err(Error::invalid("estimate chunk", "its padding must be zero")),
        }
    }
}

/// The payload of an estimate chunk in a file with this head, checked.
pub(crate) fn view<'a>(head: &Head, bytes: &'a [u8]) -> Result<EstimateView<'a>> {
    let (constituents, wavelengths) = (head.constituents, head.wavelengths.len());
    let view = EstimateView::new(bytes, constituents, wavelengths, head.planet.top)?;
    let known = |field: &Field| field.estimate < view.scatters.len();
    match head.fields.iter().all(known) {
        true => Ok(view),
        false => Err(Error::invalid(
            "field",
            "is relative to an estimate that the file does not have",
        )),
    }
}
