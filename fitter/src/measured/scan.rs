//! Scans of the sky of Kider et al. 2014: a folder `DATE___TIME` of 81 exports of a spectroradiometer,
//! `DATE___TIME_-_INDEX____AZIMUTH___ELEVATION.asd.rad.txt`, each a heading and lines of wavelength (nm) and radiance
//! (W m⁻² sr⁻¹ nm⁻¹).

use super::capture_time::CaptureTime;
use super::error::{MeasuredError, text};
use super::pattern;
use std::path::{Path, PathBuf};

const SUFFIX: &str = ".asd.rad.txt";
/// Brighter than any sky, W m⁻² sr⁻¹ nm⁻¹; the disc of the sun is 10⁴ times as bright.
const BRIGHTEST: f64 = 10.0;

/// One direction of a scan.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Place in the order of the scan, from 0.
    pub index: usize,
    /// As named, rad, counter-clockwise from +x, which is the east.
    pub azimuth: f64,
    /// rad.
    pub elevation: f64,
    /// At the wavelengths of the scan, W m⁻² sr⁻¹ nm⁻¹.
    pub radiance: Vec<f64>,
}

/// A sky.
#[derive(Clone, Debug, PartialEq)]
pub struct Scan {
    /// Of the first sample.
    pub start: CaptureTime,
    /// nm, increasing.
    pub wavelengths: Vec<f64>,
    /// All of them, in their order.
    pub samples: Vec<Sample>,
}

impl Scan {
    /// Seconds from the first to the last sample: the pyranometer beside the scanner wrote 81 lines in that time.
    pub const DURATION: f64 = 342.0;

    /// Reads the folder of a scan. One with a sample missing is refused: which one it is cannot be told, as the names
    /// were counted.
    pub fn read(folder: &Path) -> Result<Self, MeasuredError> {
        let name = folder_name(folder)?;
        let start = CaptureTime::parse(&name)
            .ok_or_else(|| MeasuredError::name(folder, "expected a folder DATE___TIME"))?;
        let mut files = vec![];
        for path in entries(folder)? {
            if let Some(place) = placed(&path, &name)? {
                files.push((place, path));
            }
        }
        files.sort_by_key(|(place, _)| place.0);
        check_count(folder, &files)?;
        let mut scan = Self {
            start,
            wavelengths: vec![],
            samples: vec![],
        };
        for ((index, angles), path) in files {
            scan.add(index, angles, &path)?;
        }
        Ok(scan)
    }

    /// The middle of the scan.
    pub fn middle(&self) -> CaptureTime {
        self.start.after(0.5 * Self::DURATION)
    }

    /// Mean radiance of every sample within half a step of a wavelength, nm; NaN where nothing was measured.
    pub fn band(&self, wavelength: f64, step: f64) -> Vec<f64> {
        let within: Vec<usize> = self.within(wavelength, step).collect();
        let mean = |sample: &Sample| {
            let sum: f64 = within.iter().map(|&i| sample.radiance[i]).sum();
            sum / within.len() as f64
        };
        self.samples.iter().map(mean).collect()
    }

    /// The wavelengths that [`Scan::band`] is the mean of.
    pub fn inside(&self, wavelength: f64, step: f64) -> Vec<f64> {
        let within = self.within(wavelength, step);
        within.map(|i| self.wavelengths[i]).collect()
    }

    fn within(&self, wavelength: f64, step: f64) -> impl Iterator<Item = usize> {
        let near = move |&i: &usize| (self.wavelengths[i] - wavelength).abs() <= 0.5 * step + 1e-9;
        (0..self.wavelengths.len()).filter(near)
    }

    fn add(&mut self, index: usize, angles: [f64; 2], path: &Path) -> Result<(), MeasuredError> {
        let (wavelengths, radiance) = spectrum(path)?;
        if self.samples.is_empty() {
            self.wavelengths = wavelengths;
        } else if self.wavelengths != wavelengths {
            let detail = "not at the wavelengths of the samples before";
            return Err(MeasuredError::incomplete(path, detail));
        }
        let [azimuth, elevation] = angles;
        self.samples.push(Sample {
            index,
            azimuth: (90.0 + azimuth).rem_euclid(360.0).to_radians(),
            elevation: elevation.to_radians(),
            radiance,
        });
        Ok(())
    }
}

/// Folders of scans: the folder itself, or those in it, at most two folders deep, in the order of time.
pub fn folders(folder: &Path) -> Result<Vec<PathBuf>, MeasuredError> {
    let is_name = |name: &str| CaptureTime::parse(name).is_some();
    let is_scan = |path: &Path| {
        let name = path.file_name().and_then(|name| name.to_str());
        path.is_dir() && name.is_some_and(is_name)
    };
    if folder.is_dir() && folder_name(folder).is_ok_and(|name| is_name(&name)) {
        return Ok(vec![folder.to_owned()]);
    }
    let mut found = vec![];
    let mut level = vec![folder.to_owned()];
    for _ in 0..3 {
        let mut next = vec![];
        for parent in level {
            next.extend(entries(&parent)?.into_iter().filter(|path| path.is_dir()));
        }
        let (scans, others): (Vec<_>, Vec<_>) = next.into_iter().partition(|path| is_scan(path));
        found.extend(scans);
        level = others;
    }
    if found.is_empty() {
        let detail = "no folder DATE___TIME of a scan in it; the archives of the set are to be unpacked first";
        return Err(MeasuredError::incomplete(folder, detail));
    }
    found.sort_by_key(|path| path.file_name().map(ToOwned::to_owned));
    Ok(found)
}

/// What a folder holds, sorted.
pub fn entries(folder: &Path) -> Result<Vec<PathBuf>, MeasuredError> {
    let read = std::fs::read_dir(folder).map_err(MeasuredError::read(folder))?;
    let paths = read.map(|entry| entry.map(|entry| entry.path()));
    let mut paths: Vec<PathBuf> = paths
        .collect::<Result<_, _>>()
        .map_err(MeasuredError::read(folder))?;
    paths.sort();
    Ok(paths)
}

fn folder_name(folder: &Path) -> Result<String, MeasuredError> {
    // "." and ".." have names, too.
    let whole = folder.canonicalize().map_err(MeasuredError::read(folder))?;
    let name = whole.file_name().and_then(|name| name.to_str());
    let name = name.ok_or_else(|| MeasuredError::name(folder, "expected a folder DATE___TIME"))?;
    Ok(name.to_owned())
}

type Place = (usize, [f64; 2]);

/// Index, azimuth and elevation that the name of an export says; none for other files.
fn placed(path: &Path, scan: &str) -> Result<Option<Place>, MeasuredError> {
    let name = path.file_name().and_then(|name| name.to_str());
    let Some(stem) = name.and_then(|name| name.strip_suffix(SUFFIX)) else {
        return Ok(None);
    };
    let wrong = |detail: &str| MeasuredError::name(path, detail);
    let rest = stem
        .strip_prefix(scan)
        .and_then(|rest| rest.strip_prefix("_-_"))
        .ok_or_else(|| wrong("the name does not begin with that of its folder and _-_"))?;
    let parts: Vec<&str> = rest.split('_').filter(|part| !part.is_empty()).collect();
    let [index, azimuth, elevation] = parts[..] else {
        return Err(wrong("expected INDEX____AZIMUTH___ELEVATION in the name"));
    };
    let index = index.parse().map_err(|_| wrong("no index in the name"))?;
    let [azimuth, elevation] = [azimuth, elevation].map(|angle| angle.parse::<f64>());
    let (Ok(azimuth), Ok(elevation)) = (azimuth, elevation) else {
        return Err(wrong("no angles in the name"));
    };
    if !pattern::is_at(index, [azimuth, elevation]) {
        return Err(wrong("not a direction of the pattern at this index"));
    }
    Ok(Some((index, [azimuth, elevation])))
}

fn check_count(folder: &Path, files: &[(Place, PathBuf)]) -> Result<(), MeasuredError> {
    for (i, ((index, _), path)) in files.iter().enumerate() {
        if i > 0 && files[i - 1].0.0 == *index {
            return Err(MeasuredError::incomplete(
                path,
                "a second sample of this index",
            ));
        }
    }
    match files.len() {
        pattern::SAMPLES => Ok(()),
        count => {
            let detail = format!("{count} of {} samples *{SUFFIX}", pattern::SAMPLES);
            Err(MeasuredError::incomplete(folder, detail))
        }
    }
}

/// Wavelengths and radiance of an export.
fn spectrum(path: &Path) -> Result<(Vec<f64>, Vec<f64>), MeasuredError> {
    let text = text(path)?;
    let (mut wavelengths, mut radiance) = (vec![], vec![]);
    for (i, line) in text.lines().enumerate().skip(1) {
        if line.trim().is_empty() {
            continue;
        }
        let wrong = |detail: &str| MeasuredError::line(path, i, detail);
        let numbers: Vec<&str> = line.split_whitespace().collect();
        let [wavelength, value] = numbers[..] else {
            return Err(wrong("expected a wavelength and a radiance"));
        };
        let [wavelength, value] = [wavelength, value].map(|number| number.parse::<f64>());
        let (Ok(wavelength), Ok(value)) = (wavelength, value) else {
            return Err(wrong("not two numbers"));
        };
        let of_a_sky = value.abs() < BRIGHTEST;
        if !of_a_sky {
            return Err(wrong("no radiance of a sky in W m^-2 sr^-1 nm^-1"));
        }
        let last = wavelengths.last().copied().unwrap_or(100.0);
        if !(wavelength > last && wavelength < 1e5) {
            return Err(wrong("wavelengths must increase, in nm"));
        }
        wavelengths.push(wavelength);
        radiance.push(value);
    }
    match wavelengths.len() {
        0 | 1 => Err(MeasuredError::incomplete(path, "no spectrum")),
        _ => Ok((wavelengths, radiance)),
    }
}
