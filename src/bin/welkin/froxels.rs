//! `welkin froxels`: aerial perspective as a camera-aligned 3-D texture for real-time engines.

use std::io::Write;
use std::path::PathBuf;
use std::time::Instant;

use rayon::prelude::*;
use welkin::output;
use welkin::{AerialPerspective, ColourAerialPerspective, ColourSpace, Conditions, Model};

use crate::Source;
use crate::about::{About, LUMINANCE, RADIANCE};
use crate::camera::{Camera, Heading, Lens};
use crate::encoding::Encoding;
use crate::failure::{Failure, Result};
use crate::image::{Planes, exr};
use crate::naming::{self, Named};
use crate::parallel::bar;
use crate::parameter;
use crate::scene::Scene;

/// First bytes of a raw volume.
const MAGIC: &[u8; 8] = b"WLKFROXL";
/// Channels of colour: in-scattered light, transmittance.
const COLOURS: [&str; 6] = ["R", "G", "B", "TR", "TG", "TB"];

#[derive(clap::Args)]
// At the height of a person, not on the ground.
#[command(mut_arg("altitude", |altitude| altitude.default_value("2").help("Altitude of the camera above the ground, m")))]
pub struct Options {
    #[command(flatten)]
    source: Source,
    #[command(flatten)]
    lens: Lens,
    #[command(flatten)]
    heading: Heading,
    #[command(flatten)]
    scene: Scene,
    /// Width, height and depth of the volume.
    #[arg(long, default_value = "32x18x64", value_parser = size, value_name = "WxHxD")]
    size: [usize; 3],
    /// Depth of the first slice along the axis, m.
    #[arg(long, default_value_t = 50.0, value_name = "M")]
    near: f64,
    /// Depth of the last slice along the axis, m.
    #[arg(long, default_value_t = 100_000.0, value_name = "M")]
    far: f64,
    /// All wavelengths of the model instead of linear sRGB.
    #[arg(long)]
    spectral: bool,
    /// The volume: .exr (six channels per slice, or two per wavelength) or .raw (a header of 64 bytes, then single
    /// precision);
    /// - for standard output.
    #[arg(long, default_value = "froxels.exr", value_name = "FILE")]
    out: PathBuf,
    /// What to write where the name does not tell.
    #[arg(long, value_enum)]
    format: Option<Format>,
    #[command(flatten)]
    encoding: Encoding,
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    Exr,
    Raw,
}

fn size(text: &str) -> std::result::Result<[usize; 3], String> {
    let parts: Vec<usize> = text.split('x').map_while(|n| n.parse().ok()).collect();
    match <[usize; 3]>::try_from(parts) {
        Ok(size) if size.iter().all(|n| (1..=1024).contains(n)) => Ok(size),
        _ => Err("expected WIDTHxHEIGHTxDEPTH, each 1..=1024".to_owned()),
    }
}

/// `[slice][row][column][channel]`.
struct Volume {
    size: [usize; 3],
    /// Names: `R` … `TB`, or `400nm` … `T400nm` …
    channels: Vec<String>,
    values: Vec<f32>,
}

pub fn run(options: &Options) -> Result<()> {
    if !(options.near > 0.0 && options.near < options.far && options.far <= 1e7) {
        return Err(Failure::message(
            "near and far must be positive, near the smaller, far at most 10000 km",
        ));
    }
    let formats = [(Format::Exr, "exr"), (Format::Raw, "raw")];
    let Some(Named { format, target }) = naming::named(&options.out, options.format, &formats)?
    else {
        return Err(Failure::message("the volume is written as .exr or .raw"));
    };
    target.check()?;
    let model = options.scene.over_ground(options.source.open()?);
    parameter::required(&model, options.scene.has_visibility())?;
    let conditions = options.scene.conditions(&model)?;
    let aerial = match options.spectral {
        true => Aerial::Spectral(model.aerial_perspective(&conditions)?),
        false => Aerial::Colour(
            model.colour_aerial_perspective(&conditions)?,
            options.encoding.space(),
        ),
    };
    let [width, height, _] = options.size;
    let azimuth = options.heading.azimuth(0.0)?;
    let camera = options.lens.camera(azimuth, width as f64 / height as f64)?;
    let start = Instant::now();
    let volume = fill(options, &aerial, &camera)?;
    let time = start.elapsed();
    let bytes = match format {
        Format::Exr => layers(options, &model, &aerial, &volume)?,
        Format::Raw => raw(options, &volume),
    };
    output::write(&[(&target, &bytes)])?;
    let mut out = target.report();
    writeln!(out, "wrote           {target}")?;
    writeln!(
        out,
        "time            {:.0} ms for {} froxels",
        1e3 * time.as_secs_f64(),
        volume.values.len() / volume.channels.len()
    )?;
    Ok(())
}

impl Options {
    /// Depth of a slice along the axis: by equal factors from near to far.
    fn depth(&self, slice: usize) -> f64 {
        let share = slice as f64 / (self.size[2] - 1).max(1) as f64;
        self.near * (self.far / self.near).powf(share)
    }
}

/// What the volume is made of.
enum Aerial {
    Spectral(AerialPerspective),
    Colour(ColourAerialPerspective, ColourSpace),
}

impl Aerial {
    fn conditions(&self) -> &Conditions {
        match self {
            Self::Spectral(aerial) => aerial.conditions(),
            Self::Colour(aerial, _) => aerial.conditions(),
        }
    }

    fn channels(&self) -> Vec<String> {
        match self {
            Self::Spectral(aerial) => ["", "T"]
                .iter()
                .flat_map(|kind| {
                    aerial
                        .wavelengths()
                        .iter()
                        .map(move |nm| format!("{kind}{nm}nm"))
                })
                .collect(),
            Self::Colour(..) => COLOURS.map(str::to_owned).to_vec(),
        }
    }

    /// All slices along a ray, `[slice][channel]`.
    fn along(
        &self,
        from: [f64; 3],
        direction: [f64; 3],
        distances: &[f64],
        out: &mut [f32],
    ) -> welkin::Result<()> {
        let n = distances.len();
        let half = out.len() / n / 2;
        match self {
            Self::Spectral(aerial) => {
                let [mut light, mut through] = [(); 2].map(|()| vec![0.0; n * half]);
                aerial.in_scattering_along(from, direction, distances, &mut light, &mut through)?;
                let parts = light.chunks_exact(half).zip(through.chunks_exact(half));
                for (out, (light, through)) in out.chunks_exact_mut(2 * half).zip(parts) {
                    out[..half].copy_from_slice(light);
                    out[half..].copy_from_slice(through);
                }
            }
            Self::Colour(aerial, space) => {
                let [mut light, mut factors] = [(); 2].map(|()| vec![[0.0; 3]; n]);
                aerial.rgb_along(from, direction, distances, *space, &mut light, &mut factors)?;
                for (out, (light, factors)) in
                    out.chunks_exact_mut(6).zip(light.iter().zip(&factors))
                {
                    out[..3].copy_from_slice(light);
                    out[3..].copy_from_slice(factors);
                }
            }
        }
        Ok(())
    }
}

fn fill(options: &Options, aerial: &Aerial, camera: &Camera) -> Result<Volume> {
    let [width, height, depth] = options.size;
    let place = [0.0, 0.0, aerial.conditions().altitude];
    let channels = aerial.channels();
    let ray = |column: usize, row: usize, out: &mut [f32]| {
        let at = |n: usize, of: usize| (n as f64 + 0.5) / of as f64;
        let direction = camera.direction([at(column, width), at(row, height)]);
        let per_depth = 1.0 / camera.depth(direction);
        let distances: Vec<f64> = (0..depth)
            .map(|slice| options.depth(slice) * per_depth)
            .collect();
        aerial.along(place, direction, &distances, out)
    };
    let bar = bar(height, "froxels");
    let n = depth * channels.len();
    let rows: Vec<Vec<f32>> = (0..height)
        .into_par_iter()
        .map(|row| {
            let mut values = vec![0.0; width * n];
            for (column, values) in values.chunks_exact_mut(n).enumerate() {
                ray(column, row, values)?;
            }
            bar.inc(1);
            Ok(values)
        })
        .collect::<welkin::Result<_>>()?;
    bar.finish_and_clear();
    let mut values = Vec::with_capacity(height * width * n);
    for slice in 0..depth {
        for ray in rows.iter().flat_map(|row| row.chunks_exact(n)) {
            values.extend_from_slice(&ray[slice * channels.len()..][..channels.len()]);
        }
    }
    Ok(Volume {
        size: options.size,
        channels,
        values,
    })
}

/// One picture with the channels `slice000.R` … `slice000.TB` and so on.
fn layers(options: &Options, model: &Model, aerial: &Aerial, volume: &Volume) -> Result<Vec<u8>> {
    let azimuth = options.heading.azimuth(0.0)?;
    let mut about = About::scene(model, aerial.conditions(), azimuth)?;
    options.lens.describe(&mut about);
    about.number("nearM", options.near);
    about.number("farM", options.far);
    let units = if options.spectral {
        RADIANCE
    } else {
        LUMINANCE
    };
    let [width, height, depth] = volume.size;
    let channels = volume.channels.len();
    let mut planes = Vec::with_capacity(channels * depth);
    let slices = volume.values.chunks_exact(width * height * channels);
    for (slice, values) in slices.enumerate() {
        for (c, name) in volume.channels.iter().enumerate() {
            let plane = values.iter().skip(c).step_by(channels).copied().collect();
            planes.push((format!("slice{slice:03}.{name}"), plane));
        }
    }
    let planes = Planes {
        size: [width, height],
        planes,
        about,
        units,
        space: options.encoding.space(),
        comment: "in-scattered light, cd m^-2 (R, G, B), or W m^-2 sr^-1 nm^-1 (by wavelength); transmittance (T and the same)",
    };
    exr(planes, &options.encoding)
}

/// Header, then `[slice][row][column][channel]` as f32, all little-endian.
fn raw(options: &Options, volume: &Volume) -> Vec<u8> {
    let mut bytes = MAGIC.to_vec();
    let [width, height, depth] = volume.size;
    let counts = [1, width, height, depth, volume.channels.len()];
    bytes.extend(counts.iter().flat_map(|&n| (n as u32).to_le_bytes()));
    let numbers = [options.near, options.far, options.lens.field()];
    bytes.extend(numbers.iter().flat_map(|&v| (v as f32).to_le_bytes()));
    bytes.resize(64, 0);
    bytes.extend(volume.values.iter().flat_map(|v| v.to_le_bytes()));
    bytes
}
