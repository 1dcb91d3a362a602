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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_measure_leads_back_to_the_visibility() {
        let model = Model::default_model().unwrap();
        for visibility in VISIBILITIES.map(|km| 1e3 * km) {
            let turbidity = model.turbidity(visibility).unwrap();
            let depth = model.aerosol_optical_depth(visibility).unwrap();
            assert!((turbidity - 1.0 - depth / 0.0971).abs() < 1e-12);
            let again = model.visibility_of_turbidity(turbidity).unwrap();
            assert!(
                (again / visibility - 1.0).abs() < 1e-5,
                "{visibility}: {again}"
            );
            let again = model.visibility_of_aerosol_optical_depth(depth).unwrap();
            assert!(
                (again / visibility - 1.0).abs() < 1e-5,
                "{visibility}: {again}"
            );
        }
    }

    #[test]
    fn what_the_model_does_not_reach_is_refused() {
        let model = Model::default_model().unwrap();
        for wrong in [0.5, 8.0, f64::NAN, f64::INFINITY] {
            let error = model.visibility_of_turbidity(wrong).unwrap_err();
            assert_eq!(error.class(), "range");
            assert!(model.visibility_of_aerosol_optical_depth(wrong).is_err());
        }
        // What the message offers can be asked for.
        let welkin::Error::OutOfRange { min, max, .. } =
            model.visibility_of_turbidity(8.0).unwrap_err()
        else {
            panic!("another error");
        };
        for edge in [min, max] {
            assert!(model.visibility_of_turbidity(edge).is_ok());
        }
    }

    /// The exact optical depths of the traced air, at 560 nm, are near those at 550 nm.
    #[test]
    fn the_depth_is_that_of_the_traced_air() {
        let air = crate::evidence::air::Air::read(&super::super::table::folder().join("air.csv"));
        let [_, particles, _] = air.unwrap().medium(0.2).unwrap().vertical();
        let between = 0.75 * particles.0[4] + 0.25 * particles.0[3];
        let depth = Model::default_model()
            .unwrap()
            .aerosol_optical_depth(59.4e3)
            .unwrap();
        assert!(
            (f64::from(between) / depth - 1.0).abs() < 0.01,
            "{between} {depth}"
        );
    }
}
