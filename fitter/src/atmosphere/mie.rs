//! Full Mie scattering matrices of the aerosol species.

use super::matrix::{Elements, Matrix};
use super::table::Table;
use anyhow::{Context, Result, bail, ensure};

/// Wavelengths of the tables, nm.
const WAVELENGTHS: [u32; 12] = [340, 380, 420, 460, 500, 540, 550, 580, 620, 660, 700, 740];
/// How far the tables are continued beyond their ends, nm: half a channel of the published model.
const BEYOND: f64 = 20.0;

/// The matrix of `species` (waso, inso, soot) at the given wavelengths (nm, 320..760).
pub fn matrix(species: &str, wavelengths: &[f64]) -> Result<Matrix> {
    let table = table(species)?;
    let angles = table.column("theta_deg")?;
    let columns = WAVELENGTHS
        .iter()
        .map(|nm| column(&table, *nm))
        .collect::<Result<Vec<_>>>()?;
    let rows = wavelengths
        .iter()
        .map(|&nm| between(&columns, nm))
        .collect::<Result<Vec<_>>>()?;
    Matrix::resample(&angles, &rows).with_context(|| format!("Mie table of {species}"))
}

fn table(species: &str) -> Result<Table> {
    macro_rules! file {
        ($name:literal) => {
            Table::parse($name, include_str!(concat!("../../data/", $name)))
        };
    }
    match species {
        "waso" => file!("mie_phase_matrix_waso50.csv"),
        "inso" => file!("mie_phase_matrix_inso00.csv"),
        "soot" => file!("mie_phase_matrix_soot00.csv"),
        other => bail!("there is no Mie table of species {other}"),
    }
}

/// ln F11 and the ratios to it, per angle.
fn column(table: &Table, nm: u32) -> Result<Vec<Elements>> {
    let [f11, r12, r33] =
        ["p11", "r12", "r33"].map(|element| table.column(&format!("{element}_{nm}")));
    let rows = f11?.into_iter().zip(r12?).zip(r33?);
    Ok(rows.map(|((f11, r12), r33)| [f11.ln(), r12, r33]).collect())
}

/// Linear in wavelength, also a little beyond the ends.
fn between(columns: &[Vec<Elements>], nm: f64) -> Result<Vec<Elements>> {
    let nodes = WAVELENGTHS.map(f64::from);
    let last = nodes.len() - 1;
    ensure!(
        (nodes[0] - BEYOND..=nodes[last] + BEYOND).contains(&nm),
        "wavelength {nm:?} nm is outside {}..{} nm, where Mie matrices are known",
        nodes[0] - BEYOND,
        nodes[last] + BEYOND
    );
    let i = nodes.partition_point(|&n| n <= nm).clamp(1, last) - 1;
    let t = (nm - nodes[i]) / (nodes[i + 1] - nodes[i]);
    let pairs = columns[i].iter().zip(&columns[i + 1]);
    Ok(pairs
        .map(|(a, b)| std::array::from_fn(|e| a[e] + t * (b[e] - a[e])))
        .collect())
}

#[cfg(test)]
mod tests {
    use super::super::matrix::{NODES, angle};
    use super::*;

    /// Mean of F11 times cosine, exactly for what is linear between nodes.
    fn asymmetry(matrix: &Matrix, w: usize) -> f64 {
        (1..NODES)
            .map(|i| {
                let (a, b) = (angle(i).cos(), angle(i - 1).cos());
                let (p, q) = (matrix.at(w, i)[0], matrix.at(w, i - 1)[0]);
                (b - a) / 12.0 * (p * (2.0 * a + b) + q * (a + 2.0 * b))
            })
            .sum()
    }

    /// From the same Mie computation, by quadrature; 320 nm is beyond the tables.
    #[test]
    fn asymmetry_is_that_of_the_particles() {
        for (species, g) in [
            ("waso", [0.70796, 0.67226, 0.64173]),
            ("inso", [0.87152, 0.82631, 0.79927]),
            ("soot", [0.44063, 0.33664, 0.28104]),
        ] {
            let matrix = matrix(species, &[320.0, 550.0, 740.0]).unwrap();
            for (w, (g, tolerance)) in g.into_iter().zip([2e-3, 1e-3, 1e-3]).enumerate() {
                let ours = asymmetry(&matrix, w);
                assert!((ours - g).abs() < tolerance, "{species} {w}: {ours} {g}");
            }
        }
    }

    #[test]
    fn the_mean_is_one_before_it_is_made_so() {
        for species in ["waso", "inso", "soot"] {
            let table = table(species).unwrap();
            let angles = table.column("theta_deg").unwrap();
            let f11 = table.column("p11_550").unwrap();
            let matrix = matrix(species, &[550.0]).unwrap();
            // Resampling keeps the nodes' values, so the factor shows there.
            let i = angles.iter().position(|&a| a == 90.0).unwrap();
            let node = super::super::matrix::interval(90.1_f64.to_radians());
            let factor = matrix.at(0, node)[0] / f11[i];
            assert!((factor - 1.0).abs() < 1e-3, "{species}: {factor}");
        }
    }

    #[test]
    fn unknown_species_and_wavelengths_are_refused() {
        assert!(matrix("dust", &[550.0]).is_err());
        let message = format!("{:#}", matrix("waso", &[550.0, 800.0]).unwrap_err());
        assert!(message.contains("800"), "{message}");
        assert!(matrix("waso", &[f64::NAN]).is_err());
    }
}
