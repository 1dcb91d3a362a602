//! Light and air of a model at any wavelength.

use super::between::{MOST_WAVELENGTHS, between, between_wavelengths, check};
use super::cell_table::CellTable;
use super::cells;
use crate::error::{Error, Result};
use crate::format::{Head, Shape, SpectrumView};
use crate::kernel::axis::{Stencil, hermite, sample};

/// How values at the wavelengths of a model make values at any wavelength: by the cells of its spectrum chunk, or where it
/// has none by a curve through the neighbours ([`between_wavelengths`]).
///
/// Of [`Model::spectral_interpolation`](crate::Model::spectral_interpolation); skies and the like share it. Queries do
/// not allocate. `Send + Sync`.
///
/// ```
/// use welkin::{Conditions, Model};
///
/// let model = Model::default_model()?;
/// let sky = model.sky(&Conditions::default())?;
/// let mut values = vec![0.0; sky.wavelengths().len()];
/// sky.relative_radiance([0.0, 0.0, 1.0], &mut values)?; // once for many wavelengths
/// let interpolation = model.spectral_interpolation()?;
/// let light = interpolation.between(&values, 500.0)?; // sr⁻¹
/// assert_eq!(light, sky.relative_radiance_at([0.0, 0.0, 1.0], 500.0)?);
/// let irradiance = interpolation.solar_irradiance(500.0); // W m⁻² nm⁻¹
/// assert!(irradiance > 1.5);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct SpectralInterpolation {
    nodes: Vec<f64>,
    solar: Vec<f32>,
    solar_axis: [f64; 2],
    spectrum: Option<Spectrum>,
}

/// A spectrum chunk that was checked, and what its view needs.
#[derive(Clone, Debug)]
struct Spectrum {
    payload: Box<[u8]>,
    shape: Shape,
    visibilities: usize,
    range: [f64; 2],
    table: CellTable,
}

impl SpectralInterpolation {
    /// Of a file without a spectrum.
    pub(crate) fn of_nodes(head: &Head) -> Self {
        Self {
            nodes: head.wavelengths.clone(),
            solar: head.solar_irradiance.clone(),
            solar_axis: [head.solar_start, head.solar_step],
            spectrum: None,
        }
    }

    /// Of a file with this spectrum chunk.
    ///
    /// # Errors
    /// [`Error::Invalid`] if it breaks the specification.
    pub(crate) fn of_cells(head: &Head, payload: &[u8]) -> Result<Self> {
        let (shape, visibilities) = (head.shape(), head.visibilities.len());
        let view = SpectrumView::new(payload, &shape, visibilities, head.solar_range())?;
        let ends = [0, view.wavelength.len() - 1];
        let spectrum = Some(Spectrum {
            range: ends.map(|i| view.wavelength[i].get()),
            table: CellTable::new(&view),
            payload: payload.into(),
            shape,
            visibilities,
        });
        Ok(Self {
            spectrum,
            ..Self::of_nodes(head)
        })
    }

    /// Wavelengths of the values, nm.
    pub fn wavelengths(&self) -> &[f64] {
        &self.nodes
    }

    /// Shortest and longest wavelength, nm.
    pub fn range(&self) -> [f64; 2] {
        match &self.spectrum {
            Some(spectrum) => spectrum.range,
            None => [self.nodes[0], self.nodes[self.nodes.len() - 1]],
        }
    }

    /// Radiance per unit of solar irradiance at a wavelength (nm) from `values` at the wavelengths of the model, all over
    /// the ground of that wavelength: those of a model over a ground whose albedo depends on wavelength
    /// ([`Model::over`](crate::Model::over)) are not.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for the wavelength; [`Error::Length`] unless there is one value per wavelength;
    /// [`Error::Invalid`] for values that are not finite.
    pub fn between(&self, values: &[f32], wavelength: f64) -> Result<f32> {
        let Some(view) = self.view() else {
            return between_wavelengths(&self.nodes, values, wavelength);
        };
        if values.len() != self.nodes.len() {
            return Err(Error::Length {
                what: "values",
                expected: self.nodes.len() as u64,
                got: values.len() as u64,
            });
        }
        self.check(wavelength)?;
        if !values.iter().all(|v| v.is_finite()) {
            return Err(Error::invalid("values", "must be finite"));
        }
        let value = cells::radiance(&view, values, wavelength);
        Ok(value.min(f64::from(f32::MAX)) as f32)
    }

    /// Solar spectral irradiance (W m⁻² nm⁻¹) outside the air at a wavelength, nm.
    pub fn solar_irradiance(&self, wavelength: f64) -> f64 {
        sample(&self.solar, self.solar_axis, wavelength)
    }

    /// Refuses wavelengths out of range.
    pub(crate) fn check(&self, wavelength: f64) -> Result<()> {
        check(wavelength, self.range())
    }

    /// Radiance at a wavelength in range.
    pub(crate) fn radiance(&self, values: &[f32], wavelength: f64) -> f64 {
        match self.view() {
            Some(view) => cells::radiance(&view, values, wavelength),
            None => between(&self.nodes, values, wavelength),
        }
    }

    /// The shares that nodes have in light at a wavelength in range, given its radiance at the nodes.
    pub(crate) fn shares(&self, values: &[f32], wavelength: f64) -> [f64; MOST_WAVELENGTHS] {
        if let Some(view) = self.view() {
            return cells::shares(&view, values, wavelength);
        }
        let mut shares = [0.0; MOST_WAVELENGTHS];
        let stencil = hermite(&self.nodes, wavelength);
        stencil.taps().for_each(|(n, w)| shares[n] = w);
        shares
    }

    /// The cells, if there are any.
    pub(crate) fn table(&self) -> Option<&CellTable> {
        self.spectrum.as_ref().map(|spectrum| &spectrum.table)
    }

    /// Transmittance of columns (m, one per constituent) at a wavelength in range, if there are cells.
    pub(crate) fn transmittance(
        &self,
        wavelength: f64,
        visibility: &Stencil,
        column: impl Fn(usize) -> f32,
    ) -> Option<f64> {
        let view = self.view()?;
        let constituents = self.spectrum.as_ref()?.shape.constituents;
        let mut columns = [0.0; MOST_CONSTITUENTS];
        let columns = &mut columns[..constituents];
        for (k, out) in columns.iter_mut().enumerate() {
            *out = column(k);
        }
        Some(cells::transmittance(&view, wavelength, visibility, columns))
    }

    /// The chunk, which was checked.
    fn view(&self) -> Option<SpectrumView<'_>> {
        let spectrum = self.spectrum.as_ref()?;
        SpectrumView::divide(&spectrum.payload, &spectrum.shape, spectrum.visibilities).ok()
    }
}

/// Most constituents that a file can have.
const MOST_CONSTITUENTS: usize = 16;
