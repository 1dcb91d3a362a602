//! A model before a traced walk over wavelengths.

use super::colour::{Observer, between};
use super::walk::{Traced, Walk};
use crate::dataset::Sample;
use crate::finite::study::Case;
use anyhow::Result;
use palette::color_difference::Ciede2000;
use palette::white_point::D65;
use palette::{FromColor, Lab, Xyz};
use rayon::prelude::*;
use welkin::{AerialPerspective, Conditions, Model, PolarisationFrame, PolarisedSky};

/// Differences of a model to traced light.
#[derive(Clone, Debug, Default)]
pub struct Judgement {
    /// Radiance of skies.
    pub radiance: Vec<Difference>,
    /// Degree of linear polarisation of skies, absolute.
    pub degree: Vec<Difference>,
    /// In-scattered light of segments.
    pub in_scattering: Vec<Difference>,
    /// Transmittance of segments, absolute.
    pub transmittance: Vec<Difference>,
    /// Colour of skies.
    pub colour: Vec<Colour>,
}

/// The colour of one line.
#[derive(Clone, Copy, Debug)]
pub struct Colour {
    /// Solar elevation, rad.
    pub sun: f64,
    /// ΔE00, exposed so that Y is half of that of white (D65).
    pub difference: f64,
    /// Luminance, traced and of the model, cd/m².
    pub luminance: [f64; 2],
}

/// One wavelength of one line.
#[derive(Clone, Copy, Debug)]
pub struct Difference {
    /// nm.
    pub wavelength: f64,
    /// Solar elevation, rad.
    pub sun: f64,
    /// Without sign.
    pub error: f64,
}

/// Colours are judged by walks over all of this, nm.
const SEEN: [f64; 2] = [400.0, 700.0];
/// Darker light (sr⁻¹) is not judged.
const DARK: f64 = 1e-12;

/// Judges `model` by the walk. Wavelengths beyond the model are left out.
pub fn judge(model: &Model, walk: &Walk, traced: &Traced) -> Result<Judgement> {
    let [shortest, longest] = model.wavelength_range()?;
    let inside: Vec<usize> = (0..walk.wavelengths.len())
        .filter(|&i| (shortest..=longest).contains(&walk.wavelengths[i]))
        .collect();
    let observer = Observer::new()?;
    let judge = Judge {
        model,
        walk,
        traced,
        inside: &inside,
        observer: &observer,
    };
    let views = walk.counts[0];
    let skies: Vec<usize> = (0..traced.samples.len()).step_by(views).collect();
    let skies = skies
        .par_iter()
        .map(|&first| judge.sky(first..first + views));
    let segments = (0..traced.cases.len())
        .into_par_iter()
        .map(|i| judge.segment(i));
    let parts = skies.chain(segments).collect::<Result<Vec<_>>>()?;
    Ok(parts.into_iter().fold(Judgement::default(), Judgement::and))
}

struct Judge<'a> {
    model: &'a Model,
    walk: &'a Walk,
    traced: &'a Traced,
    /// Wavelengths that are judged.
    inside: &'a [usize],
    observer: &'a Observer,
}

impl Judge<'_> {
    /// Samples that share their conditions.
    fn sky(&self, samples: std::ops::Range<usize>) -> Result<Judgement> {
        let mut out = Judgement::default();
        let conditions = self.traced.samples[samples.start].conditions(self.walk.visibility);
        let sky = self.model.polarised_sky(&conditions)?;
        for s in samples {
            let sample = &self.traced.samples[s];
            for &i in self.inside {
                self.line(&sky, sample, (i, s), &mut out)?;
            }
            out.colour.extend(self.colour(&sky, sample, s)?);
        }
        Ok(out)
    }

    fn line(
        &self,
        sky: &PolarisedSky,
        sample: &Sample,
        (i, s): (usize, usize),
        out: &mut Judgement,
    ) -> Result<()> {
        let wavelength = self.walk.wavelengths[i];
        let [want, q, u] = self.traced.stokes[i][s];
        if want < DARK {
            return Ok(());
        }
        let at = |error: f64| Difference {
            wavelength,
            sun: sample.solar_elevation,
            error: error.abs(),
        };
        let direction = sample.direction();
        let got = sky.sky().relative_radiance_at(direction, wavelength)?;
        out.radiance.push(at(f64::from(got) / want - 1.0));
        let stokes = sky.stokes_at(direction, PolarisationFrame::Vertical, wavelength)?;
        if stokes.i > 0.0 {
            let degree = f64::from(stokes.q.hypot(stokes.u) / stokes.i);
            out.degree.push(at(degree - q.hypot(u) / want));
        }
        Ok(())
    }

    fn colour(&self, sky: &PolarisedSky, sample: &Sample, s: usize) -> Result<Option<Colour>> {
        let [first, last] = [0, self.walk.wavelengths.len() - 1].map(|i| self.walk.wavelengths[i]);
        if first > SEEN[0] || last < SEEN[1] {
            return Ok(None);
        }
        let light = self
            .traced
            .stokes
            .iter()
            .map(|row| row[s][0].max(f64::MIN_POSITIVE).ln());
        let logarithms: Vec<f64> = light.collect();
        let relative = |nm: f64| between(&self.walk.wavelengths, &logarithms, nm).exp();
        let want = self.observer.xyz(relative);
        if want[1] < 1e-6 {
            return Ok(None);
        }
        let got = sky.sky().xyz(sample.direction())?.map(f64::from);
        let lab = |xyz: [f64; 3]| {
            let [x, y, z] = xyz.map(|v| 0.5 * v / want[1]);
            Lab::<D65, f64>::from_color(Xyz::new(x, y, z))
        };
        Ok(Some(Colour {
            sun: sample.solar_elevation,
            difference: lab(got).difference(lab(want)),
            luminance: [want[1], got[1]],
        }))
    }

    fn segment(&self, i: usize) -> Result<Judgement> {
        let mut out = Judgement::default();
        let case = &self.traced.cases[i];
        let aerial = self.model.aerial_perspective(&self.conditions(case))?;
        let [from, to] = case.ends();
        for &w in self.inside {
            let wavelength = self.walk.wavelengths[w];
            let [want, _, _, through] = self.traced.segments[w][i];
            let at = |error: f64| Difference {
                wavelength,
                sun: case.sun,
                error: error.abs(),
            };
            out.transmittance
                .push(at(self.transmittance(&aerial, case, wavelength)? - through));
            if want >= DARK * 1e-3 {
                let got = aerial.relative_in_scattering_at(from, to, wavelength)?;
                out.in_scattering.push(at(f64::from(got) / want - 1.0));
            }
        }
        Ok(out)
    }

    fn transmittance(&self, aerial: &AerialPerspective, case: &Case, nm: f64) -> Result<f64> {
        let [from, to] = case.ends();
        Ok(f64::from(
            aerial.transmittance().transmittance_at(from, to, nm)?,
        ))
    }

    fn conditions(&self, case: &Case) -> Conditions {
        Conditions {
            solar_elevation: case.sun,
            solar_azimuth: 0.0,
            visibility: self.walk.visibility,
            albedo: case.albedo,
            altitude: 0.0,
        }
    }
}

impl Judgement {
    /// All of both.
    #[must_use]
    pub fn and(mut self, other: Self) -> Self {
        self.radiance.extend(other.radiance);
        self.degree.extend(other.degree);
        self.in_scattering.extend(other.in_scattering);
        self.transmittance.extend(other.transmittance);
        self.colour.extend(other.colour);
        self
    }
}
