//! The official model of Wilkie et al. 2021, evaluated exactly from a file of its data.
//!
//! The data are nobody's to put into this repository: without a file the rows of the model say that it was not run.

use std::path::Path;

use welkin_fitter::official::evaluate::OfficialSky;
use welkin_fitter::official::{self, OfficialData, SAFETY_ALTITUDE};

use super::Result;
use super::cases::Case;
use super::entry::{Entry, NO_SKY, NOT_RUN};
use crate::peers::WAVELENGTHS;
use crate::peers::colour::ToXyz;
use crate::peers::lanes::Lanes;
use crate::peers::sky::{Coloured, LaneModel, LaneSky, Observer, Sky, SkyModel};
use crate::peers::spectra;

/// Where the file is named if not on the command line.
pub const VARIABLE: &str = "WELKIN_OFFICIAL_DATA";
/// Names of its rows, as its code has it and with observers where they are.
pub const NAMES: [&str; 2] = ["Wilkie et al. 2021, official", "the same, not raised"];
/// The files of both.
const KEYS: [&str; 2] = ["wilkie-raised", "wilkie"];

/// The model at a visibility and an albedo.
pub struct Official {
    data: OfficialData,
    raised: f64,
    visibility: f64,
    albedo: f32,
    /// Mean solar irradiance of each channel.
    sun: Vec<f64>,
    /// Channels around each wavelength that is compared, and how far between their centres it is.
    between: [(usize, f64); WAVELENGTHS.len()],
}

impl Official {
    /// Opens a file.
    ///
    /// # Errors
    /// Where it cannot be read or lacks wavelengths that are compared.
    pub fn open(file: &Path, raised: f64, visibility: f64, albedo: f32) -> Result<Self> {
        let data = OfficialData::open(file).map_err(|e| format!("{}: {e}", file.display()))?;
        let channels = data.header().channels;
        let sun = |c: usize| {
            let start = channels.start + c as f64 * channels.width;
            let steps = (channels.width.ceil() as usize).max(1);
            let nm = |i: usize| start + channels.width * (i as f64 + 0.5) / steps as f64;
            (0..steps).map(|i| spectra::sun(nm(i))).sum::<f64>() / steps as f64
        };
        let place = |nm: f64| {
            let place = (nm - channels.centre(0)) / channels.width;
            let first = place.floor();
            let last = channels.count as f64 - 1.0;
            (first >= 0.0 && first < last).then_some((first as usize, place - first))
        };
        let mut between = [(0, 0.0); WAVELENGTHS.len()];
        for (between, nm) in between.iter_mut().zip(WAVELENGTHS) {
            *between = place(nm).ok_or_else(|| format!("{}: no {nm} nm", file.display()))?;
        }
        Ok(Self {
            raised,
            visibility,
            albedo,
            sun: (0..channels.count).map(sun).collect(),
            between,
            data,
        })
    }

    /// The albedo that it answers for: the nearest on its axis where that ends.
    fn nearest_albedo(&self) -> f64 {
        let albedos = &self.data.header().axes.albedos;
        f64::from(self.albedo).clamp(albedos[0], albedos[albedos.len() - 1])
    }
}

impl LaneModel<8> for Official {
    /// None under suns lower than the file has: the nearest would be another.
    fn sky(&self, observer: Observer) -> Option<Box<dyn LaneSky<8> + '_>> {
        let lowest = self.data.header().axes.elevations[0].to_radians();
        if observer.solar_elevation < lowest - 1e-9 {
            return None;
        }
        let raised = official::Observer {
            viewpoint: [0.0, 0.0, observer.altitude],
            raised: self.raised,
            solar_elevation: observer.solar_elevation,
            solar_azimuth: 0.0,
        };
        let albedo = f64::from(self.albedo);
        let sky = self.data.sky(&raised, self.visibility, albedo).ok()?;
        Some(Box::new(Tables { model: self, sky }))
    }

    fn bytes(&self) -> usize {
        self.data.bytes() as usize
    }
}

struct Tables<'a> {
    model: &'a Official,
    sky: OfficialSky<'a>,
}

impl LaneSky<8> for Tables<'_> {
    /// Between the centres of channels the logarithm is linear; channels that are black stay so.
    fn relative_radiance(&self, direction: [f32; 3]) -> Option<Lanes<8>> {
        let radiance = self.sky.radiance(direction.map(f64::from)).ok()?;
        let ratio = |c: usize| radiance[c] / self.model.sun[c];
        let at = |(c, share): (usize, f64)| match [ratio(c), ratio(c + 1)] {
            [a, b] if a > 0.0 && b > 0.0 => (a.ln() * (1.0 - share) + b.ln() * share).exp(),
            [a, b] => a * (1.0 - share) + b * share,
        };
        Some(Lanes(self.model.between.map(|place| at(place) as f32)))
    }

    fn bytes(&self) -> usize {
        self.sky.bytes()
    }
}

/// Has no sky at all.
struct NotRun;

impl SkyModel for NotRun {
    fn sky(&self, _: Observer) -> Option<Box<dyn Sky + '_>> {
        None
    }

    fn bytes(&self) -> usize {
        0
    }
}

/// As its code has it, and with observers where they are.
///
/// # Errors
/// Where the file cannot be read or does not suit.
pub fn entries(case: &Case, file: Option<&Path>) -> Result<Vec<Entry>> {
    let entry = |(i, raised): (usize, f64)| {
        let mut entry = Entry {
            key: KEYS[i],
            name: NAMES[i],
            terms: "not run: `--official FILE.dat`".into(),
            own_light: true,
            absent: NOT_RUN,
            model: Box::new(NotRun),
        };
        let Some(file) = file else {
            return Ok(entry);
        };
        let model = Official::open(file, raised, case.visibility, case.albedo)?;
        entry.absent = NO_SKY;
        entry.terms = format!(
            "visibility {} km, albedo {:.2}, observer at {raised} m",
            case.visibility / 1e3,
            model.nearest_albedo(),
        );
        let colour = ToXyz::spectral(WAVELENGTHS);
        entry.model = Box::new(Coloured { model, colour });
        Ok(entry)
    };
    let both = [SAFETY_ALTITUDE, 0.0].into_iter().enumerate();
    both.map(entry).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::cases::FIRST;
    use welkin::Model;
    use welkin_fitter::official::export::{Plan, export};
    use welkin_fitter::official::layout::{Axes, Channels};

    #[test]
    fn without_a_file_its_rows_say_so() {
        let entries = entries(&FIRST, None).unwrap();
        assert_eq!(entries.len(), 2);
        for entry in entries {
            assert!(!entry.was_run() && entry.terms.starts_with("not run"));
            assert!(entry.model.sky(Observer::on_the_ground(0.3)).is_none());
        }
        assert!(super::entries(&FIRST, Some(Path::new("no such file"))).is_err());
    }

    /// A file of welkin's sky shows what welkin shows.
    #[test]
    fn it_says_what_is_in_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("sky.dat");
        let model = Model::default_model().unwrap();
        let plan = Plan {
            axes: Axes {
                visibilities: vec![59.4],
                albedos: vec![0.2],
                altitudes: vec![0.0],
                elevations: vec![20.0],
            },
            channels: Channels {
                count: 9,
                start: 360.0,
                width: 40.0,
            },
            transmittance_altitudes: vec![0.0, 1000.0],
            polarisation_rank: 0,
            ..Plan::default()
        };
        export(&model, &plan, &file).unwrap();
        let entries = entries(&FIRST, Some(&file)).unwrap();
        let observer = Observer::on_the_ground(20f64.to_radians());
        let sky = entries[1].model.sky(observer).unwrap();
        let want = model
            .sky(&crate::evidence::models::conditions(&FIRST, observer))
            .unwrap();
        for direction in [[0.0, 0.0, 1.0], [0.6, 0.0, 0.8], [0.0, 0.96, 0.28]] {
            let (got, want) = (sky.xyz(direction).unwrap(), want.xyz(direction).unwrap());
            for (got, want) in got.iter().zip(want) {
                assert!((got / want - 1.0).abs() < 0.02, "{got} {want}");
            }
        }
        let low = Observer::on_the_ground(10f64.to_radians());
        assert!(entries[1].model.sky(low).is_none());
    }
}
