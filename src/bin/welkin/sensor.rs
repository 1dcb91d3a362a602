//! The bands of a sensor: `--bands` and `--wavelengths`.

use std::path::{Path, PathBuf};

use welkin::output::printable;
use welkin::{BandSky, Conditions, Model, Response};

use crate::failure::{Failure, Result};

/// First column of a table of responses.
const WAVELENGTH: &str = "wavelength_nm";

#[derive(clap::Args)]
pub struct Options {
    /// Write the EXR with one channel per band of a sensor: a CSV table of wavelength_nm, increasing, and one column per
    /// band, named in its header. What a band sees is the integral of response times spectral radiance; responses are
    /// linear between rows and zero beyond them.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["wavelengths", "spectral", "stokes", "ground", "sun", "terrain"])]
    bands: Option<PathBuf>,
    /// Write the EXR with one channel per wavelength of a list, nm, such as 440,550.5,670: spectral radiance (W m⁻² sr⁻¹
    /// nm⁻¹) between those of the model, too.
    #[arg(long, value_name = "NM,NM…", value_delimiter = ',', conflicts_with_all = ["spectral", "stokes", "ground", "sun", "terrain"])]
    wavelengths: Vec<f64>,
}

/// A sky in the bands of a sensor.
pub struct Sensor {
    /// Channels.
    pub names: Vec<String>,
    pub sky: BandSky,
    pub units: &'static str,
    pub comment: &'static str,
}

impl Options {
    /// The sky in bands, if they are asked for.
    pub fn sky(&self, model: &Model, conditions: &Conditions) -> Result<Option<Sensor>> {
        let (names, responses, units, comment) = match &self.bands {
            Some(path) => {
                let text = std::fs::read_to_string(path)
                    .map_err(|e| Failure::message(format!("{}: {e}", path.display())))?;
                let table = table(&text).map_err(|error| error.about(&name(path)))?;
                let (names, responses) = table.into_iter().unzip();
                let comment = "integrals of response times radiance, W m^-2 sr^-1";
                (names, responses, "W m^-2 sr^-1", comment)
            }
            None if self.wavelengths.is_empty() => return Ok(None),
            None => {
                let channel = |l: &f64| format!("S0.{}nm", l.to_string().replace('.', ","));
                let names: Vec<String> = self.wavelengths.iter().map(channel).collect();
                let responses = self.wavelengths.iter().map(|&l| Response::wavelength(l));
                let responses: Vec<Response> = responses.collect();
                let comment = "spectral radiance, W m^-2 sr^-1 nm^-1";
                (names, responses, crate::about::RADIANCE, comment)
            }
        };
        if let Some(twice) = (1..names.len()).find(|&i| names[..i].contains(&names[i])) {
            let text = format!("two bands are called {}", printable(&names[twice]));
            return Err(Failure::message(text));
        }
        let bands = model.bands(&responses)?;
        Ok(Some(Sensor {
            names,
            sky: model.band_sky(conditions, &bands)?,
            units,
            comment,
        }))
    }

    /// Whether bands are asked for.
    pub fn is_wanted(&self) -> bool {
        self.bands.is_some() || !self.wavelengths.is_empty()
    }
}

fn name(path: &Path) -> String {
    printable(&path.display().to_string())
}

/// Names and responses of a table.
fn table(text: &str) -> Result<Vec<(String, Response)>> {
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let broken = |error: csv::Error| Failure::message(error.to_string());
    let names: Vec<String> = reader
        .headers()
        .map_err(broken)?
        .iter()
        .map(str::to_owned)
        .collect();
    if names.first().map(String::as_str) != Some(WAVELENGTH) || names.len() < 2 {
        let text = format!("expected columns {WAVELENGTH} and one per band");
        return Err(Failure::message(text));
    }
    if let Some(bad) = names[1..].iter().find(|n| n.is_empty() || n.contains('.')) {
        let text = "the name of a band must not be empty or hold a dot, which separates layers";
        return Err(Failure::message(text).about(&printable(bad)));
    }
    let mut columns = vec![Vec::new(); names.len()];
    for record in reader.records() {
        let record = record.map_err(broken)?;
        let line = record.position().map_or(0, csv::Position::line);
        for (column, field) in columns.iter_mut().zip(&record) {
            let number = field.parse::<f64>();
            column.push(number.map_err(|_| {
                Failure::message(format!("line {line}: {} is no number", printable(field)))
            })?);
        }
    }
    let (wavelengths, responses) = (columns.remove(0), columns);
    let response = |(name, values): (&String, Vec<f64>)| {
        let response = Response::table(&wavelengths, &values);
        let response = response.map_err(|e| Failure::from(e).about(&printable(name)))?;
        Ok((name.clone(), response))
    };
    names[1..].iter().zip(responses).map(response).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(text: &str) -> String {
        match table(text) {
            Err(Failure::Message(message)) => message,
            _ => panic!("{text:?} is taken"),
        }
    }

    #[test]
    fn tables_have_a_band_per_column() {
        let read =
            table("# sensor\nwavelength_nm, red ,blue\n400,0,1\n500,0,0.5\n700,1,0\n").unwrap();
        assert_eq!(read[0].0, "red");
        let expected = Response::table(&[400.0, 500.0, 700.0], &[1.0, 0.5, 0.0]).unwrap();
        assert_eq!(read[1], ("blue".to_owned(), expected));
    }

    #[test]
    fn what_is_wrong_in_tables_is_said() {
        assert!(refused("").contains("wavelength_nm"));
        assert!(refused("nm,red\n400,1\n").contains("wavelength_nm"));
        assert!(refused("wavelength_nm\n400\n").contains("one per band"));
        assert!(refused("wavelength_nm,a.b\n400,1\n500,1\n").contains("dot"));
        assert!(refused("wavelength_nm,red\n400,x\n500,1\n").contains("line 2: x"));
        assert!(refused("wavelength_nm,red\n400,1\n500\n").contains("line: 3"));
        assert!(refused("wavelength_nm,red\n500,1\n400,1\n").contains("red: "));
        assert!(refused("wavelength_nm,red\n500,1\n600,-1\n").contains("negative"));
    }
}
