//! From a file of the official model to one of welkin.
//!
//! Official tables are functions of the angle to the sun and of one to the zenith or the Earth's shadow, each of its own
//! for every sky and channel; welkin's are factors over fixed directions that all suns and channels share. So the skies
//! are sampled where welkin's splines have their sites, under the suns of the file, parted into lobes around the sun and
//! the rest, decomposed together, and refined in relative radiance.

mod air;
mod albedo;
mod bare_head;
mod fields;
mod fit;
mod judge;
pub mod left_out;
mod light;
mod pack;
mod polarise;
mod refine;
mod sample;
mod sites;
mod split;
mod suns;

use super::OfficialData;
use crate::assess::Quantiles;
use crate::dataset::Store;
use crate::decompose::{Fit, Options};
use crate::progress::bar;
use air::Air;
use albedo::AlbedoLaw;
use anyhow::{Context, Result, ensure};
use fields::Fields;
use fit::Tensor;
use light::Light;
use sample::Samples;
pub use sites::Intervals;
use sites::Sites;
use split::Splitter;
use std::path::PathBuf;
use suns::SunSplines;
use welkin::Model;
use welkin::format::{Chunk, Head, Payload, encode};

/// How a file is imported.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Intervals of the axes.
    pub intervals: Intervals,
    /// The decomposition.
    pub options: Options,
    /// Passes of the refinement.
    pub refinements: usize,
    /// The decomposition of the polarisation, where the file has one.
    pub polarisation: Options,
    /// Random directions per sky that the errors are measured in.
    pub directions: usize,
    /// Where finished parts of the fit are kept, so that an import that is broken off goes on from them.
    pub work: Option<PathBuf>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            intervals: Intervals {
                up: 32,
                down: 20,
                azimuth: 18,
                elevation: None,
            },
            options: Options {
                rank: 192,
                sweeps: 120,
                seed: 1,
            },
            refinements: 30,
            polarisation: Options {
                rank: 48,
                sweeps: 150,
                seed: 1,
            },
            directions: 200,
            work: None,
        }
    }
}

/// An imported model.
pub struct Imported {
    /// The bytes of its file.
    pub bytes: Vec<u8>,
    /// What was done and how far the model is from the file.
    pub report: String,
}

/// Turns a file into a model.
///
/// # Errors
/// If the file cannot be read, has numbers that are not finite, or wavelengths beyond the solar spectrum.
pub fn import(data: &OfficialData, settings: &Settings) -> Result<Imported> {
    let header = data.header();
    let suns = sites::elevations(data);
    let grid = sites::grid(data, settings.intervals);
    let splines = SunSplines::new(&grid, &suns);
    let light = Light::new(header.channels)?;
    let (fields, places, laws) = sample_all(data, &grid, &splines, &light)?;
    let fit = fit_all(&fields, &header.channels.centres(), settings)?;
    let air = match data.transmittance_shape() {
        Some(_) => Air::new(&data.transmittance()?, &grid.visibilities)?,
        None => Air::unknown(),
    };
    let ground = header.axes.albedos.len() > 1;
    let spherical = laws.iter().flat_map(|law| law.spherical.clone()).collect();
    let head = pack::head(&grid, header.channels, &light, spherical, (&air, ground));
    let pairs = (fields.as_slice(), places.as_slice());
    let mut chunks = pack::radiance(&grid, &splines, pairs, &fit, head.constituents);
    chunks.extend(pack::transmittance(&air));
    if data.polarisation().is_some() {
        let progress = bar(settings.polarisation.sweeps, "decomposing the polarisation");
        let tell = |sweep: usize, _: f64| progress.set_position(sweep as u64 + 1);
        let fit = polarise::fit(data, pairs, &laws, settings.polarisation, &tell)?;
        progress.finish();
        chunks.extend(pack::polarisation(&grid, &splines, pairs, &fit));
    }
    assemble(data, settings, head, chunks, &places)
}

type Sampled = (Vec<Fields>, Vec<[usize; 2]>, Vec<AlbedoLaw>);

/// Samples altitude by altitude, so that a range of altitudes is one piece of the file.
fn sample_all(
    data: &OfficialData,
    grid: &crate::dataset::Grid,
    splines: &SunSplines,
    light: &Light,
) -> Result<Sampled> {
    let axes = &data.header().axes;
    let (nh, nv) = (axes.altitudes.len(), axes.visibilities.len());
    let suns = sites::elevations(data);
    let coordinate = |e: &f64| {
        let whole = grid.elevation.intervals as f64;
        2.0 * grid.elevation.coordinate(*e) / whole - 1.0
    };
    let coordinates: Vec<f64> = suns.iter().map(coordinate).collect();
    let progress = bar(nh * nv, "sampling");
    let mut laws: Vec<AlbedoLaw> = vec![];
    let (mut fields, mut places) = (vec![], vec![]);
    for (altitude, h) in axes.altitudes.iter().enumerate() {
        let sites = Sites::new(grid, *h, suns.clone());
        let splitter = Splitter::new(&sites, &coordinates, Sites::sees_down(*h));
        for visibility in 0..nv {
            let samples = Samples::new(data, &sites, [altitude, visibility])?;
            let samples = samples.relative_to(&light.irradiance);
            if laws.len() == visibility {
                laws.push(AlbedoLaw::new(
                    &axes.albedos,
                    std::slice::from_ref(&samples),
                ));
            }
            let pair = (sites.clone(), samples);
            fields.push(Fields::new(pair, &laws[visibility], &splitter, splines));
            places.push([altitude, visibility]);
            progress.inc(1);
        }
    }
    progress.finish();
    Ok((fields, places, laws))
}

fn fit_all(fields: &[Fields], wavelengths: &[f64], settings: &Settings) -> Result<Fit> {
    let store = match &settings.work {
        Some(folder) => Some(Store::open(folder, fit::key(fields, settings.options))?),
        None => None,
    };
    let unit = |name: &str, compute: &dyn Fn() -> Fit| -> Result<Fit> {
        let Some(store) = &store else {
            return Ok(compute());
        };
        let values = store.unit(name, || Ok(compute().to_values()))?;
        fit::restore(&values, fields, settings.options.rank).context("a fit of another size")
    };
    let first = unit("decomposition", &|| decompose(fields, settings.options))?;
    let name = format!("refinement-{}", settings.refinements);
    unit(&name, &|| {
        refined(fields, wavelengths, first.clone(), settings.refinements)
    })
}

fn decompose(fields: &[Fields], options: Options) -> Fit {
    let progress = bar(options.sweeps, "decomposing");
    let tell = |sweep: usize, rms: f64| {
        progress.set_position(sweep as u64 + 1);
        progress.set_message(format!("decomposing, rms {:.3} %", 100.0 * rms));
    };
    let tensor = |chunk| Tensor::from(chunk);
    let tensors: Vec<Tensor> = fields.iter().map(tensor).collect();
    let weights = fit::channel_weights(fields);
    let fit = fit::decompose_all(&tensors, &weights, options, &tell);
    progress.finish();
    fit
}

fn refined(fields: &[Fields], wavelengths: &[f64], mut fit: Fit, passes: usize) -> Fit {
    // Of light that nobody sees less is asked.
    let importance = wavelengths.iter().map(|w| match w {
        ..760.0 => 1.0,
        _ => 0.5,
    });
    let importance = importance.collect();
    let progress = bar(passes, "refining");
    let tell = |pass: usize| progress.set_position(pass as u64);
    refine::refine(fields, &importance, &mut fit, passes, &tell);
    progress.finish();
    fit
}

/// Encodes the file twice: once to measure its errors, once with them.
fn assemble(
    data: &OfficialData,
    settings: &Settings,
    mut head: Head,
    mut chunks: Vec<Chunk>,
    places: &[[usize; 2]],
) -> Result<Imported> {
    let model = Model::from_bytes(encode(&head, &chunks)?)?;
    let progress = bar(places.len(), "measuring");
    let mut all = vec![];
    for place in places {
        let errors = judge::errors(data, &model, *place, settings.directions)?;
        let quantiles = Quantiles::of(errors.iter().map(|e| e.relative));
        note(
            &mut chunks,
            *place,
            quantiles.context("a sky without light")?,
        );
        all.extend(errors);
        progress.inc(1);
    }
    progress.finish();
    ensure!(
        all.iter().all(|e| e.relative.is_finite()),
        "the fit failed: an error is not a number"
    );
    head.metadata = metadata(data, settings, &all);
    let bytes = encode(&head, &chunks)?;
    let mut report = judge::table("relative error", &all);
    if data.polarisation().is_some() {
        let degrees = places.iter();
        let degrees = degrees.map(|p| judge::degrees(data, &model, *p, settings.directions));
        let degrees = degrees.collect::<Result<Vec<_>>>()?;
        report += &judge::table("error of the degree of polarisation", &degrees.concat());
    }
    if data.transmittance_shape().is_some() {
        let table = data.transmittance()?;
        let errors = model.head().visibilities.iter();
        let errors = errors.map(|v| judge::transmittance(&table, &model, *v));
        let errors = errors.collect::<Result<Vec<_>>>()?.concat();
        report += &judge::row("error of the transmittance", errors.into_iter());
    }
    report += &format!("{} bytes from {}\n", bytes.len(), data.bytes());
    Ok(Imported { bytes, report })
}

fn note(chunks: &mut [Chunk], [altitude, visibility]: [usize; 2], q: Quantiles) {
    let radiance = |c: &&mut Chunk| matches!(c.payload, Payload::Radiance(_));
    for chunk in chunks.iter_mut().filter(radiance) {
        if (chunk.altitude, chunk.visibility) == (Some(altitude), Some(visibility)) {
            chunk.error_median = q.median as f32;
            chunk.error_p99 = q.p99 as f32;
        }
    }
}

fn metadata(data: &OfficialData, settings: &Settings, errors: &[judge::Error]) -> String {
    let classes = judge::CLASSES.iter().filter_map(|(name, belongs)| {
        let class = errors.iter().filter(|e| belongs(e));
        let q = Quantiles::of(class.map(|e| e.relative))?;
        Some(((*name).to_owned(), serde_json::to_value(q).ok()?))
    });
    let classes: serde_json::Map<String, serde_json::Value> = classes.collect();
    let notes: Vec<String> = data.notes().iter().map(ToString::to_string).collect();
    serde_json::json!({
        "title": "Imported from a file of the official model of Wilkie et al. 2021",
        "generator": concat!("welkin-fit ", env!("CARGO_PKG_VERSION")),
        "imported": {
            "bytes": data.bytes(),
            "albedos": data.header().axes.albedos,
            "notes": notes,
        },
        "fit": {
            "rank": settings.options.rank,
            "sweeps": settings.options.sweeps,
            "refinements": settings.refinements,
            "seed": settings.options.seed,
        },
        "relative_error_at_stored_skies": classes,
    })
    .to_string()
}
