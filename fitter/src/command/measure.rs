//! `welkin-fit measure`: the model beside skies that were measured.

use anyhow::{Context, Result, ensure};
use clap::{Args as ClapArgs, Subcommand};
use std::io::Write;
use std::path::{Path, PathBuf};
use welkin::Model;
use welkin::output::{check, printable, replace_files};
use welkin_fitter::dataset::Store;
use welkin_fitter::measured::broadband::{Air, Broadband};
use welkin_fitter::measured::fisheye::Sheet;
use welkin_fitter::measured::fit::{Choice, Fitted, fit};
use welkin_fitter::measured::scan::{Scan, folders};
use welkin_fitter::measured::site::{Site, Sun};
use welkin_fitter::measured::{global_fit, near_infrared, pattern, scan_report};

/// Compares the model with measured skies.
#[derive(ClapArgs)]
pub struct Args {
    #[command(subcommand)]
    action: Action,
}

#[derive(Subcommand)]
enum Action {
    /// Fit skies to scans of spectral radiance of Kider et al. 2014.
    Kider(KiderArgs),
    /// Fit the visibility to global irradiance as a pyranometer logged it; prints CSV.
    Irradiance(IrradianceArgs),
    /// What vegetation, absorption bands and particles do to the sky up to 800 nm; prints ratios as CSV.
    NearInfrared(NearInfraredArgs),
}

#[derive(ClapArgs)]
struct SiteArgs {
    /// Degrees, north positive; by default the roof of Rhodes Hall, as for the other three.
    #[arg(long, default_value_t = Site::RHODES_HALL.latitude)]
    latitude: f64,
    /// Degrees, east positive.
    #[arg(long, default_value_t = Site::RHODES_HALL.longitude)]
    longitude: f64,
    /// Of the instrument above the sea, m; the ground of the model is at sea level.
    #[arg(long, default_value_t = Site::RHODES_HALL.altitude)]
    altitude: f64,
    /// What the clock of the measurements is ahead of UTC, h; west of Greenwich it is negative.
    #[arg(long, default_value_t = Site::RHODES_HALL.utc_offset)]
    utc_offset: f64,
}

#[derive(ClapArgs)]
struct KiderArgs {
    /// A folder of a scan, or one with folders of scans in it.
    folder: PathBuf,
    /// The model file.
    #[arg(long, default_value = "models/default.welkin")]
    model: PathBuf,
    /// Only scans of this day, YYYY-MM-DD.
    #[arg(long)]
    day: Option<String>,
    /// Middle of the first band, nm: below 400 the instrument has little signal.
    #[arg(long, default_value_t = 400.0)]
    from: f64,
    /// No middle of a band is beyond, nm.
    #[arg(long, default_value_t = 800.0)]
    to: f64,
    /// Width and distance of the bands that are compared, nm.
    #[arg(long, default_value_t = 10.0)]
    step: f64,
    /// Albedo of the ground.
    #[arg(long, default_value_t = 0.2, conflicts_with = "fit_albedo")]
    albedo: f64,
    /// Fit the albedo.
    #[arg(long)]
    fit_albedo: bool,
    /// What to add to the azimuths of the instrument, degrees counter-clockwise; fitted if not given.
    #[arg(long)]
    north: Option<f64>,
    /// Take the radiance as absolute; one factor per scan is fitted otherwise.
    #[arg(long)]
    absolute: bool,
    /// Keep the first sample, too, which is wrong in all scans of the set.
    #[arg(long)]
    keep_first: bool,
    /// Other samples to leave out, counted from 0.
    #[arg(long, value_delimiter = ',')]
    without: Vec<usize>,
    /// Samples nearer to the sun are left out, degrees.
    #[arg(long, default_value_t = 15.0)]
    around_sun: f64,
    /// Where errors by wavelength and angle go, as CSV.
    #[arg(long)]
    csv: Option<PathBuf>,
    /// Where a picture goes: measured, model, and their ratio, one row per scan.
    #[arg(long)]
    png: Option<PathBuf>,
    #[command(flatten)]
    site: SiteArgs,
}

#[derive(ClapArgs)]
struct IrradianceArgs {
    /// A log, or a folder of logs of one air.
    path: PathBuf,
    /// The model file.
    #[arg(long, default_value = "models/default.welkin")]
    model: PathBuf,
    /// Take this visibility, km; fitted if not given.
    #[arg(long)]
    visibility: Option<f64>,
    /// Fit one factor, too.
    #[arg(long)]
    scale: bool,
    /// Albedo of the ground.
    #[arg(long, default_value_t = 0.2)]
    albedo: f64,
    /// Water vapour relative to the 1.42 cm of the US standard atmosphere.
    #[arg(long, default_value_t = 1.0)]
    water: f64,
    /// How much darker the sky is in the last column.
    #[arg(long, default_value_t = 0.73)]
    sky_factor: f64,
    /// Print what changes of air and ground would do to the last reading instead.
    #[arg(long)]
    effects: bool,
    #[command(flatten)]
    site: SiteArgs,
}

#[derive(ClapArgs)]
struct NearInfraredArgs {
    /// Elevation of the sun, degrees: that of Wilkie et al. 2021, Fig. 7.
    #[arg(long, default_value_t = 41.08)]
    sun_elevation: f64,
    /// Visibility of the air that the others are compared with, km.
    #[arg(long, default_value_t = 59.4)]
    visibility: f64,
    /// Folder for finished work units.
    #[arg(long, default_value = "work")]
    work: PathBuf,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    match &args.action {
        Action::Kider(args) => args.run(),
        Action::Irradiance(args) => args.run(),
        Action::NearInfrared(args) => args.run(),
    }
}

impl SiteArgs {
    fn site(&self) -> Result<Site> {
        ensure!(
            self.latitude.abs() <= 90.0 && self.longitude.abs() <= 180.0,
            "--latitude must lie in -90..90 and --longitude in -180..180"
        );
        ensure!(
            self.utc_offset.abs() <= 14.0 && (0.0..9000.0).contains(&self.altitude),
            "--utc-offset must lie in -14..14 and --altitude in 0..9000"
        );
        Ok(Site {
            latitude: self.latitude,
            longitude: self.longitude,
            altitude: self.altitude,
            utc_offset: self.utc_offset,
        })
    }
}

fn open(path: &PathBuf) -> Result<Model> {
    Model::open(path).with_context(|| format!("{}", path.display()))
}

fn say(text: &str) -> Result<()> {
    Ok(std::io::stdout().write_all(text.as_bytes())?)
}

/// Most bands of a fit.
const MOST_BANDS: f64 = 1000.0;
/// What a sky may be brighter than the model's by.
const MOST_SKY_FACTOR: f64 = 10.0;

/// Scans were made by day: a sun that is down tells that place or clock are wrong.
fn is_up(sun: &Sun) -> Result<()> {
    let elevation = sun.elevation.to_degrees();
    ensure!(
        elevation > 0.0,
        "the sun was at {elevation:.1}° then: --utc-offset must be what its clock is ahead of UTC (negative in the \
         west), and --latitude and --longitude where it stood"
    );
    Ok(())
}

impl KiderArgs {
    fn run(&self) -> Result<()> {
        let site = self.site.site()?;
        let choice = self.choice(&site)?;
        self.check_targets()?;
        let model = open(&self.model)?;
        let mut fits: Vec<(Scan, Vec<Vec<f64>>, Fitted)> = vec![];
        let mut table = String::from(scan_report::HEAD);
        for folder in folders(&self.folder)? {
            let scan = Scan::read(&folder)?;
            if !self.wanted(&scan) {
                continue;
            }
            let sun = site.sun(&scan.middle())?;
            is_up(&sun).with_context(|| format!("{}", folder.display()))?;
            let fitted = fit(&model, &scan, sun, &choice)
                .with_context(|| format!("{}", folder.display()))?;
            say(&(scan_report::summary(&scan, &fitted) + "\n"))?;
            if fitted.left_out.count() > 0 {
                let name = folder.display().to_string();
                eprintln!("warning: {}: {}", printable(&name), fitted.left_out);
            }
            table += &scan_report::csv(&scan, &choice, &fitted);
            let bands = choice.wavelengths.iter();
            let measured = bands.map(|&nm| scan.band(nm, choice.step)).collect();
            fits.push((scan, measured, fitted));
        }
        ensure!(!fits.is_empty(), "no scan of this day");
        let mut files: Vec<(&Path, Vec<u8>)> = vec![];
        if let Some(path) = &self.csv {
            files.push((path.as_path(), table.into_bytes()));
        }
        if let Some(path) = &self.png {
            let rows: Vec<_> = fits.iter().map(|(s, m, f)| (s, m.as_slice(), f)).collect();
            files.push((path.as_path(), Sheet::new(&rows).png()?));
        }
        let files: Vec<(&Path, &[u8])> = files.iter().map(|(p, b)| (*p, b.as_slice())).collect();
        Ok(replace_files(&files)?)
    }

    /// Fits take minutes: where their results cannot go is said before.
    fn check_targets(&self) -> Result<()> {
        for path in [&self.csv, &self.png].into_iter().flatten() {
            check(path)?;
        }
        ensure!(
            self.csv.is_none() || self.csv != self.png,
            "--csv and --png name one file"
        );
        Ok(())
    }

    fn choice(&self, site: &Site) -> Result<Choice> {
        let count = ((self.to - self.from) / self.step).floor() + 1.0;
        ensure!(
            self.step > 0.0 && (1.0..MOST_BANDS).contains(&count),
            "--from, --to and --step make no bands"
        );
        ensure!(
            (0.0..=1.0).contains(&self.albedo),
            "--albedo must lie in 0..1"
        );
        ensure!(
            (0.0..180.0).contains(&self.around_sun),
            "--around-sun must lie in 0..180"
        );
        ensure!(
            self.north.is_none_or(|north| north.abs() <= 360.0),
            "--north must lie in -360..360"
        );
        ensure!(
            self.without.iter().all(|&sample| sample < pattern::SAMPLES),
            "--without: samples are counted from 0 to {}",
            pattern::SAMPLES - 1
        );
        let first = (!self.keep_first).then_some(0);
        Ok(Choice {
            wavelengths: (0..count as usize)
                .map(|i| self.from + self.step * i as f64)
                .collect(),
            step: self.step,
            albedo: (!self.fit_albedo).then_some(self.albedo),
            north: self.north.map(f64::to_radians),
            scale: !self.absolute,
            without: first.into_iter().chain(self.without.clone()).collect(),
            around_sun: self.around_sun.to_radians(),
            altitude: site.altitude,
        })
    }

    fn wanted(&self, scan: &Scan) -> bool {
        let time = scan.start;
        let day = format!("{}-{:02}-{:02}", time.year, time.month, time.day);
        self.day.as_ref().is_none_or(|wanted| *wanted == day)
    }
}

impl IrradianceArgs {
    fn run(&self) -> Result<()> {
        let site = self.site.site()?;
        let model = open(&self.model)?;
        ensure!(
            (0.0..=10.0).contains(&self.water),
            "--water must lie in 0..10"
        );
        ensure!(
            self.sky_factor > 0.0 && self.sky_factor <= MOST_SKY_FACTOR,
            "--sky-factor must be above 0 and at most {MOST_SKY_FACTOR}"
        );
        let ends = model.visibility_range();
        let mut air = Air {
            visibility: 1e3 * self.visibility.unwrap_or(1e-3 * ends[0]),
            albedo: self.albedo,
            altitude: site.altitude,
            water: self.water,
        };
        let (readings, low) = global_fit::readings(&self.path, &site)?;
        let broadband = Broadband::new(&model)?;
        let fit = match self.visibility {
            Some(_) => global_fit::judge(&broadband, &readings, &air, self.scale)?,
            None => global_fit::fit(&broadband, &readings, &air, ends, self.scale)?,
        };
        air.visibility = fit.visibility;
        if self.effects {
            let last = readings[readings.len() - 1];
            return say(&global_fit::effects(&broadband, &last.sun, &air, ends)?);
        }
        let head = format!(
            "# visibility {:.1} km, measured / model {:.4}, rms {:.4}, {low} logs under too low a sun\n",
            1e-3 * fit.visibility,
            fit.scale,
            fit.rms,
        );
        say(&(head + &global_fit::csv(&readings, &fit, self.sky_factor)))
    }
}

impl NearInfraredArgs {
    fn run(&self) -> Result<()> {
        let (sun, visibility) = (self.sun_elevation.to_radians(), 1e3 * self.visibility);
        let store = Store::open(&self.work, format!("near-infrared 1 {sun} {visibility}"))?;
        let rows = near_infrared::rows(&store, sun, visibility)?;
        say(&near_infrared::csv(&rows))
    }
}
