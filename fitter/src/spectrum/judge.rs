//! A model before a traced walk over wavelengths.

use super::colour::{Observer, between};
use super::walk::{Traced, Walk};
use crate::assess::Quantiles;
use crate::dataset::Sample;
use crate::finite::study::Case;
use anyhow::Result;
use palette::color_difference::Ciede2000;
use palette::white_point::D65;
use palette::{FromColor, Lab, Xyz};
use rayon::prelude::*;
use std::fmt::Write;
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

/// A class of suns: its name, and which elevations (rad) belong to it.
pub type SunClass = (&'static str, fn(f64) -> bool);

/// Classes that are reported apart.
pub const SUNS: [SunClass; 3] = [
    ("sun above 12°", |e| e >= 0.209_44),
    ("sun at 0..12°", |e| (0.0..0.209_44).contains(&e)),
    ("twilight", |e| e < 0.0),
];

/// Width of the bands of a table, nm.
const BAND: f64 = 20.0;

/// CSV with quantiles by quantity, sun and 20 nm; `unit` 1e-2 gives percent.
pub fn csv(judgement: &Judgement) -> String {
    let mut out = String::from("quantity,sun,from_nm,to_nm,values,median,p95,p99,max\n");
    let quantities = [
        ("radiance", &judgement.radiance),
        ("degree of linear polarisation", &judgement.degree),
        ("in-scattering", &judgement.in_scattering),
        ("transmittance", &judgement.transmittance),
    ];
    for (name, all) in quantities {
        for (sun, belongs) in SUNS {
            let class: Vec<&Difference> = all.iter().filter(|d| belongs(d.sun)).collect();
            let last = class.iter().map(|d| d.wavelength).fold(0.0, f64::max);
            let first = class.iter().map(|d| d.wavelength).fold(f64::MAX, f64::min);
            let mut from = BAND * (first / BAND).floor();
            row(
                &mut out,
                (name, sun),
                [first, last],
                class.iter().map(|d| d.error),
            );
            while from <= last {
                let band = |d: &&&Difference| (from..from + BAND).contains(&d.wavelength);
                let errors = class.iter().filter(band).map(|d| d.error);
                row(&mut out, (name, sun), [from, from + BAND], errors);
                from += BAND;
            }
        }
    }
    for (sun, belongs) in SUNS {
        let class = judgement
            .colour
            .iter()
            .filter(|c| belongs(c.sun))
            .map(|c| c.difference);
        row(&mut out, ("colour (ΔE00)", sun), [360.0, 830.0], class);
    }
    out
}

fn row(
    out: &mut String,
    (name, sun): (&str, &str),
    [from, to]: [f64; 2],
    errors: impl Iterator<Item = f64>,
) {
    if let Some(q) = Quantiles::of(errors) {
        let Quantiles {
            count,
            median,
            p95,
            p99,
            max,
        } = q;
        let _ = writeln!(
            out,
            "{name},{sun},{from},{to},{count},{median:.6},{p95:.6},{p99:.6},{max:.6}"
        );
    }
}

/// Rows of a page: radiance by 20 nm, median and p95 per class of suns.
pub fn bands(judgement: &Judgement) -> String {
    let classes = SUNS
        .map(|(name, _)| format!("{name}: median,p95,p99"))
        .join(",");
    let mut out = format!("radiance at,{classes}\n");
    let wavelengths = || judgement.radiance.iter().map(|d| d.wavelength);
    let last = wavelengths().fold(0.0, f64::max);
    let mut from = BAND * (wavelengths().fold(f64::MAX, f64::min) / BAND).floor();
    while from <= last {
        let band = |d: &&Difference| (from..from + BAND).contains(&d.wavelength);
        let cells = SUNS.map(|(_, belongs)| {
            let class = judgement
                .radiance
                .iter()
                .filter(band)
                .filter(|d| belongs(d.sun));
            percentages(Quantiles::of(class.map(|d| d.error)))
        });
        out += &format!("{from}..{} nm,{}\n", from + BAND, cells.join(","));
        from += BAND;
    }
    out
}

fn percentages(q: Option<Quantiles>) -> String {
    let Some(q) = q else {
        return ",,".into();
    };
    [q.median, q.p95, q.p99]
        .map(|v| two_digits(100.0 * v, " %"))
        .join(",")
}

fn two_digits(value: f64, unit: &str) -> String {
    let decimals = (1.0 - value.abs().max(1e-9).log10().floor()).clamp(0.0, 6.0);
    format!("{value:.*}{unit}", decimals as usize)
}

/// Rows of a page: all quantities over visible light and over all, by day and in twilight.
pub fn summary(judgement: &Judgement) -> String {
    let mut out = String::from("held out between the nodes,median,p95,p99,max\n");
    let quantities = [
        ("radiance", &judgement.radiance, 100.0, " %"),
        ("degree of linear polarisation", &judgement.degree, 1.0, ""),
        (
            "in-scattering of segments",
            &judgement.in_scattering,
            100.0,
            " %",
        ),
        (
            "transmittance of segments",
            &judgement.transmittance,
            1.0,
            "",
        ),
    ];
    let days: [SunClass; 2] = [("day", |e| e >= 0.0), ("twilight", |e| e < 0.0)];
    for (name, all, scale, unit) in quantities {
        for (sun, belongs) in days {
            for (range, [from, to]) in [("300..760 nm", [300.0, 760.0]), ("beyond", [760.0, 9e9])] {
                let inside =
                    |d: &&Difference| belongs(d.sun) && (from..=to).contains(&d.wavelength);
                let errors = all.iter().filter(inside).map(|d| d.error);
                if let Some(q) = Quantiles::of(errors) {
                    let cells =
                        [q.median, q.p95, q.p99, q.max].map(|v| two_digits(scale * v, unit));
                    out += &format!("\"{name}, {range}, {sun}\",{}\n", cells.join(","));
                }
            }
        }
    }
    for (sun, belongs) in days {
        let colours = judgement
            .colour
            .iter()
            .filter(|c| belongs(c.sun))
            .map(|c| c.difference);
        if let Some(q) = Quantiles::of(colours) {
            let cells = [q.median, q.p95, q.p99, q.max].map(|v| two_digits(v, ""));
            out += &format!("\"ΔE00 of XYZ, {sun}\",{}\n", cells.join(","));
        }
    }
    out
}

/// Luminance of the night sky without sun and moon, cd/m²: what the sun adds is seen before it.
const NIGHT: f64 = 2e-4;
/// Bands of solar elevation of luminances, degrees.
const LUMINANCE_SUNS: [(f64, f64); 6] = [
    (12.0, 90.0),
    (0.0, 12.0),
    (-4.2, 0.0),
    (-6.0, -4.2),
    (-9.0, -6.0),
    (-12.0, -9.0),
];

/// Rows of a page: luminances and their errors, relative, absolute, and relative to them and a night sky together.
pub fn luminance(judgement: &Judgement) -> String {
    let mut out = String::from(
        "sun at,cd/m²: p5,median,p95,error: median,p95,max,in cd/m²: p95,max,with night: p95,max\n",
    );
    for (low, high) in LUMINANCE_SUNS {
        let inside = |c: &&Colour| (low..high).contains(&c.sun.to_degrees());
        let class: Vec<[f64; 2]> = judgement
            .colour
            .iter()
            .filter(inside)
            .map(|c| c.luminance)
            .collect();
        let errors = |by: &dyn Fn(f64) -> f64| {
            let errors = class
                .iter()
                .map(|[want, got]| (got - want).abs() / by(*want));
            Quantiles::of(errors)
        };
        let parts = (
            errors(&|want| want),
            errors(&|_| 1.0),
            errors(&|want| want + NIGHT),
        );
        let (Some(relative), Some(absolute), Some(seen)) = parts else {
            continue;
        };
        let mut bright: Vec<f64> = class.iter().map(|[want, _]| *want).collect();
        bright.sort_by(f64::total_cmp);
        let at = |q: f64| bright[(q * (bright.len() - 1) as f64).round() as usize];
        let cells = [0.05, 0.5, 0.95].map(|q| candela(at(q)));
        let percent =
            |q: &[f64]| -> Vec<String> { q.iter().map(|v| two_digits(100.0 * v, " %")).collect() };
        let cells: Vec<String> = cells
            .into_iter()
            .chain(percent(&[relative.median, relative.p95, relative.max]))
            .chain([absolute.p95, absolute.max].map(candela))
            .chain(percent(&[seen.p95, seen.max]))
            .collect();
        out += &format!("{low}..{high}°,{}\n", cells.join(","));
    }
    out
}

/// Two digits.
fn candela(value: f64) -> String {
    let power = value.abs().max(1e-30).log10().floor();
    if (-3.0..4.0).contains(&power) {
        return two_digits(value, "");
    }
    format!("{value:.1e}")
}
