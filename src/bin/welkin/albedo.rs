//! `--albedo`: a number, a name, a list or a table.

use std::path::Path;

use welkin::output::printable;
use welkin::{Albedo, Model};

use crate::cells;
use crate::failure::describe;

/// Grounds that have a name, with where their spectra are from. Recipes of the fitter have the same.
const SURFACES: &str = include_str!("surfaces.csv");
/// Columns of a table.
const COLUMNS: [&str; 2] = ["wavelength_nm", "albedo"];

/// The albedo of the ground as it was given.
#[derive(Clone, Debug)]
pub enum Ground {
    /// Whether it is one is for the conditions to say.
    Grey(f64),
    ByWavelength(Albedo),
}

impl Ground {
    /// A number; the name of a surface; a list such as 400:0.05,690:0.06,740:0.5; or the name of a table. For clap.
    pub fn parse(text: &str) -> Result<Self, String> {
        if let Ok(share) = text.parse() {
            return Ok(Self::Grey(share));
        }
        if let Some(ground) = surface(text)? {
            return Ok(ground);
        }
        let path = Path::new(text);
        let albedo = match text.contains(':') && !path.is_file() {
            true => list(text),
            false => file(path),
        }?;
        Ok(Self::ByWavelength(albedo))
    }

    /// At a wavelength, nm.
    pub fn at(&self, wavelength: f64) -> f64 {
        match self {
            Self::Grey(share) => *share,
            Self::ByWavelength(albedo) => albedo.at(wavelength),
        }
    }

    /// What conditions have.
    pub fn share(&self) -> f64 {
        match self {
            Self::Grey(share) => *share,
            // The model says what that is: see `Ground::under`.
            Self::ByWavelength(albedo) => albedo.at(550.0),
        }
    }

    /// Where it is no number.
    pub fn by_wavelength(&self) -> Option<&Albedo> {
        match self {
            Self::Grey(_) => None,
            Self::ByWavelength(albedo) => Some(albedo),
        }
    }

    /// The model over this ground.
    pub fn under(&self, model: Model) -> Model {
        match self {
            Self::Grey(_) => model,
            Self::ByWavelength(albedo) => model.over(albedo),
        }
    }
}

fn list(text: &str) -> Result<Albedo, String> {
    let pair = |item: &str| {
        let (wavelength, share) = item.split_once(':').ok_or_else(|| {
            let item = printable(item);
            format!("expected wavelength:albedo, such as 550:0.1, got \"{item}\"")
        })?;
        let number = |name, cell: &str| cells::number(name, cell.trim().as_bytes());
        Ok((
            number("a wavelength", wavelength)?,
            number("an albedo", share)?,
        ))
    };
    let pairs: Result<Vec<(f64, f64)>, String> = text.split(',').map(pair).collect();
    let (wavelengths, shares): (Vec<f64>, Vec<f64>) = pairs?.into_iter().unzip();
    Albedo::table(&wavelengths, &shares).map_err(|error| describe(&error))
}

fn file(path: &Path) -> Result<Albedo, String> {
    let absent = |error| {
        let names = surfaces().map_or(String::new(), |names| names.join(", "));
        format!("no number, none of {names}, and no file: {error}")
    };
    let text = std::fs::read(path).map_err(absent)?;
    table(&text)
}

/// The names in [`SURFACES`].
fn surfaces() -> Result<Vec<String>, String> {
    let mut reader = reader(SURFACES.as_bytes());
    let header = reader.headers().map_err(|e| e.to_string())?;
    Ok(header.iter().skip(1).map(str::to_owned).collect())
}

/// The ground of that name; one without colour is a number.
fn surface(name: &str) -> Result<Option<Ground>, String> {
    let Some(column) = surfaces()?.iter().position(|known| known == name) else {
        return Ok(None);
    };
    let (mut wavelengths, mut shares) = (Vec::new(), Vec::new());
    for record in reader(SURFACES.as_bytes()).byte_records() {
        let record = record.map_err(|e| e.to_string())?;
        wavelengths.push(cells::number(COLUMNS[0], &record[0])?);
        shares.push(cells::number(name, &record[1 + column])?);
    }
    let is_grey = shares.iter().all(|share| *share == shares[0]);
    if is_grey {
        return Ok(shares.first().copied().map(Ground::Grey));
    }
    let albedo = Albedo::table(&wavelengths, &shares).map_err(|error| describe(&error))?;
    Ok(Some(Ground::ByWavelength(albedo)))
}

fn reader(text: &[u8]) -> csv::Reader<&[u8]> {
    csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text)
}

/// A table with one row per wavelength.
fn table(text: &[u8]) -> Result<Albedo, String> {
    let mut reader = reader(text);
    let header = reader.byte_headers().map_err(|e| e.to_string())?.clone();
    let names: Vec<&[u8]> = header.iter().map(cells::name).collect();
    if names != COLUMNS.map(str::as_bytes) {
        let hint = cells::separator_hint(&header);
        return Err(format!("expected the columns {}{hint}", COLUMNS.join(", ")));
    }
    let (mut wavelengths, mut shares) = (Vec::new(), Vec::new());
    for record in reader.byte_records() {
        let record = record.map_err(|error| error.to_string())?;
        let line = record.position().map_or(0, csv::Position::line);
        let wrong = |text: String| format!("line {line}: {text}");
        let cell = |k: usize| cells::number(COLUMNS[k], &record[k]).map_err(wrong);
        let (wavelength, share) = (cell(0)?, cell(1)?);
        // One row alone, and with the one before: so that what is wrong has a line.
        let before = wavelengths.last().zip(shares.last());
        let before: Vec<(f64, f64)> = before.map(|(&l, &a)| (l, a)).into_iter().collect();
        let (mut ls, mut values): (Vec<f64>, Vec<f64>) = before.into_iter().unzip();
        ls.push(wavelength);
        values.push(share);
        Albedo::table(&ls, &values).map_err(|error| wrong(describe(&error)))?;
        wavelengths.push(wavelength);
        shares.push(share);
    }
    Albedo::table(&wavelengths, &shares).map_err(|error| describe(&error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_and_tables_are_the_same() {
        let expected = Albedo::table(&[400.0, 690.0, 740.0], &[0.05, 0.06, 0.5]).unwrap();
        let Ok(Ground::ByWavelength(listed)) = Ground::parse("400:0.05, 690:0.06,740:0.5") else {
            panic!("a list is refused");
        };
        assert_eq!(listed, expected);
        let text = "\u{feff}wavelength_nm, albedo\r\n# grass\r\n400,0.05\r\n690,0.06\n740,0.5\n";
        assert_eq!(table(text.as_bytes()).unwrap(), expected);
        assert!(matches!(Ground::parse("0.25"), Ok(Ground::Grey(share)) if share == 0.25));
    }

    #[test]
    fn surfaces_have_names() {
        let names = surfaces().unwrap();
        assert_eq!(names, ["grass", "snow", "sand", "sea", "urban"]);
        let at = |name: &str, nm: f64| Ground::parse(name).unwrap().at(nm);
        // Vegetation is bright beyond 700 nm, snow everywhere seen, sand reddish.
        assert!(at("grass", 800.0) > 4.0 * at("grass", 670.0));
        assert!(at("snow", 550.0) > 0.9);
        assert!(at("sand", 650.0) > 1.3 * at("sand", 450.0));
        for (name, share) in [("sea", 0.06), ("urban", 0.18)] {
            let ground = Ground::parse(name).unwrap();
            assert!(matches!(ground, Ground::Grey(s) if s == share), "{name}");
        }
        let refused = Ground::parse("sandd").unwrap_err();
        assert!(refused.contains("none of grass, snow, sand"), "{refused}");
    }

    #[test]
    fn what_is_wrong_is_said_with_its_line() {
        let refused =
            |rows: &str| table(format!("wavelength_nm,albedo\n{rows}").as_bytes()).unwrap_err();
        assert_eq!(
            refused("400,x\n"),
            "line 2: albedo must be a number, got \"x\""
        );
        assert!(refused("400,0.1\n500,\n").starts_with("line 3: albedo is empty"));
        assert!(refused("400,0.1\n500,1.5\n").starts_with("line 3: albedo"));
        assert!(refused("400,0.1\n500,NaN\n").starts_with("line 3: albedo"));
        assert!(refused("500,0.1\n400,0.1\n").starts_with("line 3: invalid albedo: wavelengths"));
        assert!(refused("-4,0.1\n").starts_with("line 2: "));
        assert!(refused("400,0.1\n500\n").contains("line: 3"));
        assert!(refused("").contains("at least one"));
        assert!(table(b"").unwrap_err().contains("wavelength_nm, albedo"));
        assert!(
            table(b"nm;albedo\n400;1\n")
                .unwrap_err()
                .contains("semicolons")
        );
        for text in ["400:0.1,500", "400:x", "a:b:c", "500:0.1,400:0.2", "400:2"] {
            assert!(Ground::parse(text).is_err(), "{text}");
        }
        assert!(
            Ground::parse("nowhere.csv")
                .unwrap_err()
                .contains("no file")
        );
    }
}
