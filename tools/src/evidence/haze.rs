//! Visibility, aerosol optical depth and turbidity of the same air.

use welkin::Model;

use super::Result;
use super::table::Table;

const COMMAND: &str = "cargo run --release -p welkin-tools --bin evidence -- skies";
/// km.
const VISIBILITIES: [f64; 6] = [20.0, 27.6, 40.0, 59.4, 90.0, 131.8];

/// Writes the table.
///
/// # Errors
/// Where the default model does not open or the table cannot be written.
pub fn write() -> Result<()> {
    let model = Model::default_model()?;
    let mut table = Table::new(
        COMMAND,
        &[
            "visibility",
            "extinction at the ground",
            "aerosol optical depth",
            "turbidity",
            "Ångström's β",
        ],
    );
    for visibility in VISIBILITIES {
        let turbidity = model.turbidity(1e3 * visibility)?;
        table.push(vec![
            format!("{visibility} km"),
            format!("{:.4} km⁻¹", 50f64.ln() / visibility),
            format!("{:.4}", model.aerosol_optical_depth(1e3 * visibility)?),
            format!("{turbidity:.3}"),
            // Preetham et al. 1999, Appendix A.1, for a wavelength exponent of 1.3.
            format!("{:.4}", 0.046_083_65 * turbidity - 0.045_860_26),
        ]);
    }
    table.write("haze.csv")
}
