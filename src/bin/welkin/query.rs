//! `welkin query`: a CSV table in, the same table with values out.

use std::collections::HashMap;
use std::fs::File;
use std::io::{self, Read};
use std::path::PathBuf;

use csv::ByteRecord;
use welkin::{Conditions, Frame, Haze, Model, PolarisedSky, Sky, Stokes, SunDisc};

use crate::Source;
use crate::failure::{Failure, Result, describe};

/// Prepared skies that are kept at once.
const MOST_SKIES: usize = 128;
/// The same of hazes, which are larger.
const MOST_HAZES: usize = 16;

#[derive(clap::Args)]
pub struct Options {
    #[command(flatten)]
    source: Source,
    /// Fail (exit code 2) if a row got an error.
    #[arg(long)]
    strict: bool,
    /// Move conditions that the model does not reach to its nearest.
    #[arg(long)]
    clamp: bool,
    /// Table with a header; standard input if absent or "-".
    file: Option<PathBuf>,
}

pub fn run(options: &Options) -> Result<()> {
    let model = options.source.open()?;
    let input = input(options)?;
    let (rows, failures) = answer(&model, options.clamp, input, io::stdout().lock())?;
    if options.strict && failures > 0 {
        let text = format!("{failures} of {rows} rows failed (see their column \"error\")");
        return Err(Failure::message(text));
    }
    Ok(())
}

/// Answers a table; returns how many rows it has and how many of them failed.
pub fn answer(
    model: &Model,
    clamp: bool,
    input: impl Read,
    output: impl io::Write,
) -> Result<(u64, u64)> {
    let mut reader = csv::ReaderBuilder::new()
        .flexible(true)
        .trim(csv::Trim::All)
        .from_reader(input);
    let header = reader.byte_headers().map_err(unreadable)?.clone();
    let columns = Columns::find(&header)?;
    let mut writer = csv::Writer::from_writer(output);
    write_row(&mut writer, &header, header.len(), "value", "error")?;
    let mut answerer = Answerer {
        model,
        clamp,
        skies: HashMap::new(),
        polarised: HashMap::new(),
        hazes: HashMap::new(),
    };
    let (mut rows, mut failures) = (0u64, 0u64);
    let mut row = ByteRecord::new();
    while reader.read_byte_record(&mut row).map_err(unreadable)? {
        rows += 1;
        let (value, error) = match columns.answer(&row, header.len(), &mut answerer) {
            Ok(value) => (format!("{value:?}"), String::new()),
            Err(error) => (String::new(), error),
        };
        failures += u64::from(!error.is_empty());
        write_row(&mut writer, &row, header.len(), &value, &error)?;
    }
    writer.flush()?;
    Ok((rows, failures))
}

fn input(options: &Options) -> Result<Box<dyn Read>> {
    match &options.file {
        Some(path) if path.as_os_str() != "-" => {
            let unreadable = |e: io::Error| Failure::message(format!("{}: {e}", path.display()));
            Ok(Box::new(File::open(path).map_err(unreadable)?))
        }
        _ => Ok(Box::new(io::stdin().lock())),
    }
}

fn unreadable(error: csv::Error) -> Failure {
    Failure::message(format!("cannot read the table: {error}"))
}

fn write_row(
    writer: &mut csv::Writer<impl io::Write>,
    row: &ByteRecord,
    columns: usize,
    value: &str,
    error: &str,
) -> Result<()> {
    let cells = (0..columns).map(|i| row.get(i).unwrap_or(b""));
    let written = writer.write_record(cells.chain([value.as_bytes(), error.as_bytes()]));
    written.map_err(|error| match error.into_kind() {
        csv::ErrorKind::Io(error) => Failure::from(error),
        other => Failure::message(format!("cannot write the table: {other:?}")),
    })
}

const QUANTITY: &str = "quantity";
const DISTANCE: &str = "distance_m";
const NUMBERS: [&str; 7] = [
    "visibility_km",
    "albedo",
    "altitude_m",
    "solar_elevation_deg",
    "view_zenith_deg",
    "view_azimuth_deg",
    "wavelength_nm",
];

/// Where the columns stand.
struct Columns {
    quantity: usize,
    numbers: [usize; 7],
    distance: Option<usize>,
}

impl Columns {
    fn find(header: &ByteRecord) -> Result<Self> {
        for reserved in ["value", "error"] {
            if position(header, reserved)?.is_some() {
                let text = format!("the table has a column \"{reserved}\" already: rename it");
                return Err(Failure::message(text));
            }
        }
        let wanted = |name: &str| {
            position(header, name)?.ok_or_else(|| {
                Failure::message(format!(
                    "the table lacks the column \"{name}\"; it needs {QUANTITY}, {}",
                    NUMBERS.join(", ")
                ))
            })
        };
        let mut numbers = [0; 7];
        for (index, name) in numbers.iter_mut().zip(NUMBERS) {
            *index = wanted(name)?;
        }
        Ok(Self {
            quantity: wanted(QUANTITY)?,
            numbers,
            distance: position(header, DISTANCE)?,
        })
    }

    /// The value for a row, or what to write in its error column.
    fn answer(
        &self,
        row: &ByteRecord,
        columns: usize,
        answerer: &mut Answerer,
    ) -> std::result::Result<f32, String> {
        if row.len() != columns {
            return Err(format!("expected {columns} cells, got {}", row.len()));
        }
        let quantity = Quantity::parse(&row[self.quantity])?;
        let mut numbers = [0.0; 7];
        for ((number, &index), name) in numbers.iter_mut().zip(&self.numbers).zip(NUMBERS) {
            *number = parse_number(name, &row[index])?;
        }
        let distance = match self.distance.map(|index| &row[index]) {
            Some(cell) if !cell.is_empty() => parse_number(DISTANCE, cell)?,
            _ => f64::INFINITY,
        };
        if !quantity.is_of_segments() && distance != f64::INFINITY {
            return Err("distance_m must be empty: radiance is along the whole ray".to_owned());
        }
        if distance.is_nan() || distance < 0.0 {
            return Err(format!("distance_m must not be negative, got {distance}"));
        }
        answerer.answer(quantity, numbers, distance)
    }
}

/// The index of a column; two of the same name are an error.
fn position(header: &ByteRecord, name: &str) -> Result<Option<usize>> {
    let bytes = name.as_bytes();
    let mut found = header.iter().enumerate().filter(|(_, cell)| {
        // Some programs put a byte order mark before the first column.
        cell.strip_prefix(b"\xef\xbb\xbf").unwrap_or(cell) == bytes
    });
    let first = found.next().map(|(i, _)| i);
    match found.next() {
        None => Ok(first),
        Some(_) => Err(Failure::message(format!(
            "the table has two columns \"{name}\""
        ))),
    }
}

fn parse_number(name: &str, cell: &[u8]) -> std::result::Result<f64, String> {
    let text = String::from_utf8_lossy(cell);
    if text.is_empty() {
        return Err(format!("{name} is empty"));
    }
    let number = text.parse::<f64>();
    number.map_err(|_| format!("{name} must be a number, got \"{text}\""))
}

#[derive(Clone, Copy)]
enum Quantity {
    Radiance,
    RelativeRadiance,
    /// Q/I in the sun-aligned frame: positive where light is polarised across the plane of view and sun.
    Polarisation,
    /// In the vertical frame.
    StokesQ,
    StokesU,
    /// Of a segment, or of the whole ray.
    Transmittance,
    InScatter,
    /// Of the disc alone.
    SunRadiance,
}

impl Quantity {
    fn parse(cell: &[u8]) -> std::result::Result<Self, String> {
        match cell {
            b"radiance" => Ok(Self::Radiance),
            b"relative_radiance" => Ok(Self::RelativeRadiance),
            b"polarisation" => Ok(Self::Polarisation),
            b"stokes_q" => Ok(Self::StokesQ),
            b"stokes_u" => Ok(Self::StokesU),
            b"transmittance" => Ok(Self::Transmittance),
            b"in_scatter" => Ok(Self::InScatter),
            b"sun_radiance" => Ok(Self::SunRadiance),
            other => Err(format!(
                "unknown quantity \"{}\": expected radiance, relative_radiance, polarisation, stokes_q, stokes_u, transmittance, in_scatter or sun_radiance",
                String::from_utf8_lossy(other)
            )),
        }
    }
}

impl Quantity {
    /// Whether it may have a finite distance.
    fn is_of_segments(self) -> bool {
        !matches!(
            self,
            Self::Radiance | Self::RelativeRadiance | Self::SunRadiance
        )
    }
}

/// Answers rows, and keeps skies for rows with the same conditions.
struct Answerer<'a> {
    model: &'a Model,
    clamp: bool,
    skies: HashMap<[u64; 4], Sky>,
    polarised: HashMap<[u64; 4], PolarisedSky>,
    hazes: HashMap<[u64; 4], Haze>,
}

impl Answerer<'_> {
    fn answer(
        &mut self,
        quantity: Quantity,
        [
            visibility,
            albedo,
            altitude,
            elevation,
            zenith,
            azimuth,
            wavelength,
        ]: [f64; 7],
        distance: f64,
    ) -> std::result::Result<f32, String> {
        if !(0.0..=180.0).contains(&zenith) {
            return Err(format!("view_zenith_deg must be in 0..=180, got {zenith}"));
        }
        if !azimuth.is_finite() {
            return Err(format!("view_azimuth_deg must be finite, got {azimuth}"));
        }
        let conditions = Conditions {
            solar_elevation: elevation.to_radians(),
            solar_azimuth: 0.0,
            visibility: visibility * 1e3,
            albedo,
            altitude,
        };
        let ray = Ray {
            direction: direction(zenith, azimuth),
            distance,
        };
        let value = self.value(quantity, conditions, &ray, wavelength);
        value.map_err(|error| describe(&error))
    }

    fn value(
        &mut self,
        quantity: Quantity,
        conditions: Conditions,
        ray: &Ray,
        wavelength: f64,
    ) -> welkin::Result<f32> {
        let direction = ray.direction.map(|v| v as f32);
        match quantity {
            Quantity::Radiance => self.sky(conditions)?.radiance_at(direction, wavelength),
            Quantity::RelativeRadiance => {
                let sky = self.sky(conditions)?;
                sky.relative_radiance_at(direction, wavelength)
            }
            Quantity::Polarisation => {
                let light = self.stokes(conditions, ray, Frame::SunAligned, wavelength)?;
                Ok(light.signed_degree())
            }
            Quantity::StokesQ => {
                let light = self.stokes(conditions, ray, Frame::Vertical, wavelength)?;
                Ok(light.q)
            }
            Quantity::StokesU => {
                let light = self.stokes(conditions, ray, Frame::Vertical, wavelength)?;
                Ok(light.u)
            }
            Quantity::Transmittance => {
                let haze = self.haze(conditions)?;
                let (_, through) = ray.through(haze)?;
                welkin::between_wavelengths(haze.wavelengths(), &through, wavelength)
            }
            Quantity::InScatter => {
                let (light, _) = ray.through(self.haze(conditions)?)?;
                self.at(light, wavelength)
            }
            Quantity::SunRadiance => {
                let disc = SunDisc::new(self.sky(conditions)?);
                let mut light = vec![0.0; disc.wavelengths().len()];
                disc.radiance(direction, &mut light)?;
                self.at(light, wavelength)
            }
        }
    }

    /// Of the sky, or of what the air within a finite distance scatters.
    fn stokes(
        &mut self,
        conditions: Conditions,
        ray: &Ray,
        frame: Frame,
        wavelength: f64,
    ) -> welkin::Result<Stokes> {
        if ray.distance == f64::INFINITY {
            let direction = ray.direction.map(|v| v as f32);
            let sky = self.polarised_sky(conditions)?;
            return sky.stokes_at(direction, frame, wavelength);
        }
        let haze = self.haze(conditions)?;
        let [from, to] = ray.ends(haze);
        let light = haze.relative_stokes_at(from, to, frame, wavelength)?;
        let irradiance = self.model.head().solar_irradiance_at(wavelength) as f32;
        Ok(Stokes {
            i: irradiance * light.i,
            q: irradiance * light.q,
            u: irradiance * light.u,
        })
    }

    /// Spectral radiance between the wavelengths of the model.
    fn at(&self, mut light: Vec<f32>, wavelength: f64) -> welkin::Result<f32> {
        let head = self.model.head();
        for (light, &node) in light.iter_mut().zip(&head.wavelengths) {
            *light /= head.solar_irradiance_at(node) as f32;
        }
        let relative = welkin::between_wavelengths(&head.wavelengths, &light, wavelength)?;
        Ok(relative * head.solar_irradiance_at(wavelength) as f32)
    }

    fn haze(&mut self, conditions: Conditions) -> welkin::Result<&Haze> {
        let (model, clamp) = (self.model, self.clamp);
        kept(&mut self.hazes, MOST_HAZES, conditions, || {
            model.haze(&reachable(model, clamp, conditions)?)
        })
    }

    fn sky(&mut self, conditions: Conditions) -> welkin::Result<&Sky> {
        let (model, clamp) = (self.model, self.clamp);
        kept(&mut self.skies, MOST_SKIES, conditions, || {
            model.sky(&reachable(model, clamp, conditions)?)
        })
    }

    fn polarised_sky(&mut self, conditions: Conditions) -> welkin::Result<&PolarisedSky> {
        let (model, clamp) = (self.model, self.clamp);
        kept(&mut self.polarised, MOST_SKIES, conditions, || {
            model.polarised_sky(&reachable(model, clamp, conditions)?)
        })
    }
}

/// What a row looks along.
struct Ray {
    direction: [f64; 3],
    /// m; infinite up to the ground or to space.
    distance: f64,
}

impl Ray {
    /// Start and end, of which the latter counts for finite distances.
    fn ends(&self, haze: &Haze) -> [[f64; 3]; 2] {
        let from = [0.0, 0.0, haze.conditions().altitude];
        let to = core::array::from_fn(|k| from[k] + self.distance * self.direction[k]);
        [from, to]
    }

    /// In-scattered light and transmittance from the altitude of the conditions.
    fn through(&self, haze: &Haze) -> welkin::Result<(Vec<f32>, Vec<f32>)> {
        let n = haze.wavelengths().len();
        let (mut light, mut through) = (vec![0.0; n], vec![0.0; n]);
        let [from, to] = self.ends(haze);
        if self.distance == f64::INFINITY {
            haze.to_end(from, self.direction, &mut light, &mut through)?;
        } else {
            haze.in_scatter(from, to, &mut light, &mut through)?;
        }
        Ok((light, through))
    }
}

fn reachable(model: &Model, clamp: bool, conditions: Conditions) -> welkin::Result<Conditions> {
    match clamp {
        true => conditions.clamped(model),
        false => Ok(conditions),
    }
}

/// The sky for these conditions, prepared now or earlier.
fn kept<T>(
    skies: &mut HashMap<[u64; 4], T>,
    most: usize,
    conditions: Conditions,
    prepare: impl FnOnce() -> welkin::Result<T>,
) -> welkin::Result<&T> {
    let key = [
        conditions.solar_elevation,
        conditions.visibility,
        conditions.albedo,
        conditions.altitude,
    ]
    .map(f64::to_bits);
    if !skies.contains_key(&key) {
        let sky = prepare()?;
        if skies.len() == most {
            skies.clear();
        }
        skies.insert(key, sky);
    }
    Ok(&skies[&key])
}

/// Unit vector at a zenith angle and an azimuth from the sun, degrees; exact at the poles and the horizon.
fn direction(zenith: f64, azimuth: f64) -> [f64; 3] {
    let elevation = (90.0 - zenith).to_radians();
    let (z, horizontal) = elevation.sin_cos();
    let horizontal = if zenith == 0.0 || zenith == 180.0 {
        0.0
    } else {
        horizontal
    };
    let (y, x) = (azimuth % 360.0).to_radians().sin_cos();
    [horizontal * x, horizontal * y, z]
}
