//! The bands of a sensor: `--bands` and `--wavelengths`.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use csv::ByteRecord;
use welkin::output::printable;
use welkin::{Bands, Error, Model, Response};

use crate::cells;
use crate::failure::{Failure, Result, plain};

/// First column of a table of responses.
const WAVELENGTH: &str = "wavelength_nm";
/// Of channels in EXR files.
const LONGEST_NAME: usize = 255;

#[derive(clap::Args)]
#[group(id = "sensor", multiple = false)]
pub struct Options {
    /// Values in the bands of a sensor instead: a CSV table of wavelength_nm, increasing, and one column per band, named
    /// in its header. What a band sees is the integral of response times spectral radiance (W m⁻² sr⁻¹); responses are
    /// linear between rows and zero beyond them. In an EXR every band is a channel, in a table a column.
    #[arg(long, value_name = "FILE")]
    bands: Option<PathBuf>,
    /// Values at each of a list of wavelengths, nm, such as 440,550.5,670: between those of the model, too. Spectral
    /// radiance is in W m⁻² sr⁻¹ nm⁻¹.
    #[arg(long, value_name = "NM,NM…", value_delimiter = ',')]
    wavelengths: Vec<f64>,
    #[arg(skip)]
    prepared: OnceLock<Sensor>,
}

/// The bands of a sensor.
pub struct Sensor {
    /// Of the bands, printable ASCII.
    pub names: Vec<String>,
    pub bands: Bands,
    /// Whether they are single wavelengths, nm.
    pub wavelengths: Option<Vec<f64>>,
}

/// Before it is projected onto a model.
struct Curves {
    names: Vec<String>,
    responses: Vec<Response>,
    wavelengths: Option<Vec<f64>>,
}

impl Options {
    /// The bands, if they are asked for: projected at the first call.
    pub fn sensor(&self, model: &Model) -> Result<Option<&Sensor>> {
        if let Some(sensor) = self.prepared.get() {
            return Ok(Some(sensor));
        }
        let curves = match &self.bands {
            Some(path) => curves(path, model)?,
            None if self.wavelengths.is_empty() => return Ok(None),
            None => lines(&self.wavelengths, model)?,
        };
        let sensor = Sensor {
            bands: model.bands(&curves.responses)?,
            names: curves.names,
            wavelengths: curves.wavelengths,
        };
        Ok(Some(self.prepared.get_or_init(|| sensor)))
    }

    /// Whether bands are asked for.
    pub fn is_wanted(&self) -> bool {
        self.bands.is_some() || !self.wavelengths.is_empty()
    }

    /// The file that they are read from.
    pub fn file(&self) -> Option<&Path> {
        self.bands.as_deref()
    }
}

/// Bands of one wavelength each.
fn lines(wavelengths: &[f64], model: &Model) -> Result<Curves> {
    let [min, max] = model.wavelength_range()?;
    for (i, value) in wavelengths.iter().enumerate() {
        if !(min..=max).contains(value) {
            return Err(Failure::from(Error::OutOfRange {
                parameter: "wavelength",
                value: *value,
                min,
                max,
                unit: "nm",
            }));
        }
        if wavelengths[..i].contains(value) {
            let text = format!("the wavelength {} nm is given twice", plain(*value));
            return Err(Failure::message(text));
        }
    }
    let responses = wavelengths.iter().map(|&l| Response::wavelength(l));
    Ok(Curves {
        names: wavelengths.iter().map(|l| format!("{l}nm")).collect(),
        responses: responses.collect(),
        wavelengths: Some(wavelengths.to_vec()),
    })
}

/// The bands of a file.
fn curves(path: &Path, model: &Model) -> Result<Curves> {
    let file = printable(&path.display().to_string());
    let text = std::fs::read(path).map_err(|e| Failure::message(format!("{file}: {e}")))?;
    let [min, max] = model.wavelength_range()?;
    let table = table(&text, [min, max]).map_err(|error| error.about(&file))?;
    let (names, responses) = table.into_iter().unzip();
    Ok(Curves {
        names,
        responses,
        wavelengths: None,
    })
}

/// Names and responses of a table, within a range of wavelengths.
fn table(text: &[u8], range: [f64; 2]) -> Result<Vec<(String, Response)>> {
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text);
    let broken = |error: csv::Error| Failure::message(error.to_string());
    let header = reader.byte_headers().map_err(broken)?.clone();
    let names = names(&header)?;
    let mut columns = vec![Vec::new(); header.len()];
    for record in reader.byte_records() {
        let record = record.map_err(broken)?;
        let line = record.position().map_or(0, csv::Position::line);
        let titles = [WAVELENGTH]
            .into_iter()
            .chain(names.iter().map(String::as_str));
        for ((column, cell), title) in columns.iter_mut().zip(&record).zip(titles) {
            let wrong = |text| Failure::message(format!("line {line}: {text}"));
            column.push(cells::number(title, cell).map_err(wrong)?);
        }
    }
    let wavelengths = columns.remove(0);
    let response = |(name, values): (String, Vec<f64>)| {
        let response = response(&wavelengths, &values, range).map_err(|e| e.about(&name))?;
        Ok((name, response))
    };
    names.into_iter().zip(columns).map(response).collect()
}

/// The names of bands.
fn names(header: &ByteRecord) -> Result<Vec<String>> {
    let mut cells = header.iter().map(cells::name);
    if cells.next() != Some(WAVELENGTH.as_bytes()) || header.len() < 2 {
        let hint = cells::separator_hint(header);
        let text = format!("expected the columns {WAVELENGTH} and one per band{hint}");
        return Err(Failure::message(text));
    }
    let mut names: Vec<String> = Vec::new();
    for cell in cells {
        let name = String::from_utf8_lossy(cell).into_owned();
        let is_plain = |b: &u8| matches!(b, b' '..=b'~') && *b != b'.';
        if cell.is_empty() || cell.len() > LONGEST_NAME || !cell.iter().all(is_plain) {
            let text = format!(
                "the name of a band must be of 1 to {LONGEST_NAME} printable ASCII characters without a dot, which separates layers, got \"{}\"",
                printable(&name)
            );
            return Err(Failure::message(text));
        }
        if names.contains(&name) {
            return Err(Failure::message(format!("two bands are called {name}")));
        }
        names.push(name);
    }
    Ok(names)
}

fn response(wavelengths: &[f64], values: &[f64], [min, max]: [f64; 2]) -> Result<Response> {
    let response = Response::table(wavelengths, values)?;
    let [first, last] = response.range();
    if first < min || last > max {
        let [min, max, first, last] = [min, max, first, last].map(plain);
        let text = format!(
            "the response reaches from {first} to {last} nm, but the model from {min} to {max} nm: it must be zero beyond"
        );
        return Err(Failure::message(text));
    }
    Ok(response)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<(String, Response)>> {
        table(text.as_bytes(), [300.0, 1100.0])
    }

    fn refused(text: &str) -> String {
        match read(text) {
            Err(Failure::Message(message)) => message,
            _ => panic!("{text:?} is taken"),
        }
    }

    #[test]
    fn tables_have_a_band_per_column() {
        let text =
            "\u{feff}wavelength_nm, red ,Band 2\r\n# sensor\n400,0,1\r\n500,0,0.5\n700,1,0\n";
        let read = read(text).unwrap();
        assert_eq!(read[0].0, "red");
        let expected = Response::table(&[400.0, 500.0, 700.0], &[1.0, 0.5, 0.0]).unwrap();
        assert_eq!(read[1], ("Band 2".to_owned(), expected));
    }

    #[test]
    fn what_is_wrong_in_tables_is_said() {
        assert!(refused("").contains("wavelength_nm"));
        assert!(refused("nm,red\n400,1\n").contains("wavelength_nm"));
        assert!(refused("wavelength_nm;red\n400;1\n").contains("semicolons"));
        assert!(refused("wavelength_nm\n400\n").contains("one per band"));
        for name in ["a.b", "", "λ", "é", "a\tb", &"x".repeat(256)] {
            let text = refused(&format!("wavelength_nm,{name},z\n400,1,1\n500,1,1\n"));
            assert!(text.contains("printable ASCII"), "{text}");
        }
        assert!(refused("wavelength_nm,a, a\n400,1,1\n").contains("two bands are called a"));
        let text = refused("wavelength_nm,red\n400,x\n500,1\n");
        assert_eq!(text, "line 2: red must be a number, got \"x\"");
        assert!(refused("wavelength_nm,red\n\"400,5\",1\n").contains("a point, 400.5"));
        assert!(refused("wavelength_nm,red\n400,\n").contains("line 2: red is empty"));
        assert!(refused("wavelength_nm,red\n400,1\n500\n").contains("line: 3"));
        assert!(refused("wavelength_nm,red\n500,1\n").contains("red: "));
        for wrong in [
            "500,1\n400,1",
            "500,1\n500,1",
            "NaN,1\n500,1",
            "500,0\n600,0",
        ] {
            assert!(refused(&format!("wavelength_nm,red\n{wrong}\n")).contains("red: "));
        }
        for value in ["-1", "NaN", "inf"] {
            let text = refused(&format!("wavelength_nm,red\n500,1\n600,{value}\n"));
            assert!(text.contains("finite and not negative"), "{text}");
        }
        for value in ["1e300", "1e-300"] {
            let text = refused(&format!("wavelength_nm,red\n500,0\n600,{value}\n"));
            assert!(
                text.contains("red: ") && text.contains("integral"),
                "{text}"
            );
        }
        let text = refused("wavelength_nm,red\n200,0\n250,1\n500,1\n");
        assert!(
            text.contains("red: ") && text.contains("200 to 500 nm"),
            "{text}"
        );
        read("wavelength_nm,red\n100,0\n300,0\n500,1\n1100,0\n2000,0\n").unwrap();
    }
}
