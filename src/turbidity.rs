//! Turbidity and aerosol optical depth, as other models and instruments describe the air, and the visibility that this
//! one has.

use crate::error::{Error, Result};
use crate::model::Model;

/// nm: where the optical depth of aerosols is usually given, and what turbidity is defined at here.
const WAVELENGTH: f64 = 550.0;
/// Vertical optical depth of dry air at 1013.25 hPa: Bodhaine et al. 1999, *On Rayleigh Optical Depth Calculations*.
const MOLECULES: f64 = 0.0971;
/// Of 345 DU of ozone, as in the US standard atmosphere. It absorbs, and so counts for neither.
const OZONE: f64 = 0.0306;

/// Other measures of the air than the visibility, all at 550 nm and for the air of this model.
///
/// | measure | is | source |
/// | --- | --- | --- |
/// | visibility V | ln 50 / extinction at the ground (molecules and particles) | Koschmieder 1924, threshold 2 % |
/// | aerosol optical depth τ | vertical depth of all that is neither molecules nor ozone | as sun photometers give it |
/// | turbidity T | (molecules + τ) / molecules = 1 + τ / 0.0971 | Preetham et al. 1999; Wilkie et al. 2021, Eq. 1 |
///
/// The visibility is that along the ground, the other two are sums over the vertical, so which belong together depends
/// on where the particles are: models with particles elsewhere have another haze at the same turbidity.
///
/// ```
/// use welkin::Model;
///
/// let model = Model::default_model()?;
/// let turbidity = model.turbidity(59.4e3)?;
/// let depth = model.aerosol_optical_depth(59.4e3)?;
/// assert!((turbidity - (1.0 + depth / 0.0971)).abs() < 1e-12);
/// assert!((2.0..2.2).contains(&turbidity));
/// assert!((model.visibility_of_turbidity(turbidity)? / 59.4e3 - 1.0).abs() < 1e-6);
/// assert!((model.visibility_of_aerosol_optical_depth(depth)? / 59.4e3 - 1.0).abs() < 1e-6);
/// # Ok::<(), welkin::Error>(())
/// ```
impl Model {
    /// Vertical optical depth of the aerosols at 550 nm.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if the model does not reach the visibility (m), or not 550 nm.
    pub fn aerosol_optical_depth(&self, visibility: f64) -> Result<f64> {
        let air = self.transmittance(visibility)?;
        let through = air.transmittance_to_space_at([0.0; 3], [0.0, 0.0, 1.0], WAVELENGTH)?;
        Ok(-f64::from(through).ln() - OZONE - MOLECULES)
    }

    /// Vertical optical depth of molecules and aerosols over that of molecules, at 550 nm.
    ///
    /// # Errors
    /// As [`Model::aerosol_optical_depth`].
    pub fn turbidity(&self, visibility: f64) -> Result<f64> {
        Ok(of_depth(self.aerosol_optical_depth(visibility)?))
    }

    /// Lowest and highest turbidity that the model reaches.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if the model does not reach 550 nm.
    pub fn turbidity_range(&self) -> Result<[f64; 2]> {
        let [clear, hazy] = self.aerosol_optical_depth_range()?;
        Ok([clear, hazy].map(of_depth))
    }

    /// The visibility (m) of a turbidity.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a turbidity that the model does not reach, or if it does not reach 550 nm.
    pub fn visibility_of_turbidity(&self, turbidity: f64) -> Result<f64> {
        let [min, max] = self.turbidity_range()?;
        if !(min..=max).contains(&turbidity) {
            return Err(out_of_range("turbidity", turbidity, [min, max]));
        }
        self.visibility_where(|visibility| Ok(self.turbidity(visibility)? < turbidity))
    }

    /// The visibility (m) of an optical depth of the aerosols at 550 nm.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a depth that the model does not reach, or if it does not reach 550 nm.
    pub fn visibility_of_aerosol_optical_depth(&self, depth: f64) -> Result<f64> {
        let range = self.aerosol_optical_depth_range()?;
        if !(range[0]..=range[1]).contains(&depth) {
            return Err(out_of_range("aerosol optical depth", depth, range));
        }
        self.visibility_where(|visibility| Ok(self.aerosol_optical_depth(visibility)? < depth))
    }

    /// Of the clearest and of the haziest air.
    fn aerosol_optical_depth_range(&self) -> Result<[f64; 2]> {
        let [hazy, clear] = self.visibility_range();
        Ok([
            self.aerosol_optical_depth(clear)?,
            self.aerosol_optical_depth(hazy)?,
        ])
    }

    /// The visibility at which the air stops being too clear.
    fn visibility_where(&self, too_clear: impl Fn(f64) -> Result<bool>) -> Result<f64> {
        let [low, high] = self.visibility_range();
        // Depths grow with the reciprocal of the visibility, nearly in proportion.
        let [mut clear, mut hazy] = [high.recip(), low.recip()];
        for _ in 0..60 {
            let middle = 0.5 * (clear + hazy);
            match too_clear(middle.recip().clamp(low, high))? {
                true => clear = middle,
                false => hazy = middle,
            }
        }
        Ok((0.5 * (clear + hazy)).recip().clamp(low, high))
    }
}

fn of_depth(depth: f64) -> f64 {
    1.0 + depth / MOLECULES
}

fn out_of_range(parameter: &'static str, value: f64, [min, max]: [f64; 2]) -> Error {
    // Rounded inwards, so that what is said can be asked for.
    let [min, max] = [(min * 1e3).ceil() * 1e-3, (max * 1e3).floor() * 1e-3];
    Error::OutOfRange {
        parameter,
        value,
        min: (min * 1e3).round() / 1e3,
        max: (max * 1e3).round() / 1e3,
        unit: "",
    }
}
