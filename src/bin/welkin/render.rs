//! `welkin render`.

use std::io::Write;
use std::path::PathBuf;
use std::time::Instant;

use welkin::output::{self, Target};
use welkin::{Conditions, Model, PolarisedSky, Sky};

use crate::Source;
use crate::about::About;
use crate::failure::{Failure, Result, fixed, plain};
use crate::ground::Ground;
use crate::landscape::{self, Landscape};
use crate::naming::{self, Named};
use crate::picture::{Picture, View, Wanted};
use crate::polarised::{Axes, Colouring, Quantity};
use crate::projection::Projection;
use crate::scene::Scene;

/// Luminance of display white over the mean luminance of the sky (a geometric mean), for the automatic exposure.
const WHITE_OVER_MEAN: f64 = 3.5;
/// Luminance of display white at exposure value 0 (ISO 100), cd m⁻².
const WHITE_AT_EV_0: f64 = 1.2;

#[derive(clap::Args)]
pub struct Options {
    #[command(flatten)]
    source: Source,
    #[command(flatten)]
    scene: Scene,
    /// Altitude of the observer above the ground, m.
    #[arg(long, default_value_t = 0.0, value_name = "M")]
    altitude: f64,
    /// Move conditions that the model does not reach to its nearest, and say which on standard error.
    #[arg(long)]
    clamp: bool,
    /// How the sphere of directions is laid onto the picture.
    #[arg(long, value_enum, default_value = "up")]
    projection: Projection,
    /// Height of the picture or of a face of the cube, pixels; lat-long is twice as wide.
    #[arg(long, default_value_t = 768, value_parser = clap::value_parser!(u16).range(1..=16384), value_name = "PIXELS")]
    size: u16,
    /// Base name for an EXR and a PNG, or the name of one of them with its extension; - for standard output. What begins with a digit
    /// is no extension.
    #[arg(long, default_value = "sky", value_name = "FILE")]
    out: PathBuf,
    /// Write only this, to the very file that --out names, where its name does not tell.
    #[arg(long, value_enum)]
    format: Option<Format>,
    /// Write the EXR with one channel per wavelength (W m⁻² sr⁻¹ nm⁻¹) instead of linear sRGB (cd m⁻²).
    #[arg(long)]
    spectral: bool,
    /// Write the EXR with Stokes layers: S0.R … S3.B, or S0.320nm … S3.760nm with --spectral.
    #[arg(long)]
    stokes: bool,
    /// Fill what is below the horizon with the ground of the given albedo in the light of sun and sky; black if absent.
    #[arg(long, conflicts_with_all = ["stokes", "terrain"])]
    ground: bool,
    /// What the picture shows.
    #[arg(long, value_enum, default_value = "radiance")]
    quantity: Quantity,
    /// Wavelength of the polarisation, nm; that of the luminance if absent.
    #[arg(long, value_name = "NM")]
    wavelength: Option<f64>,
    /// Axes of q, u and aolp.
    #[arg(long, value_enum, default_value = "sun")]
    frame: Axes,
    #[command(flatten)]
    landscape: landscape::Options,
    /// Exposure value of the PNG at ISO 100; automatic if absent.
    #[arg(long, value_name = "EV", value_parser = exposure)]
    exposure: Option<f64>,
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    Exr,
    Png,
}

/// Where the files of a picture go, as far as they are wanted.
struct Outputs {
    exr: Option<Target>,
    png: Option<Target>,
}

fn exposure(text: &str) -> std::result::Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (-60.0..=60.0).contains(&value) => Ok(value),
        _ => Err("expected a number in -60..=60".to_owned()),
    }
}

impl Options {
    fn conditions(&self, model: &Model) -> Result<Conditions> {
        match self.clamp {
            true => self.scene.clamped(self.altitude, model),
            false => Ok(self.scene.conditions(self.altitude)),
        }
    }

    /// Where to write, checked.
    fn outputs(&self) -> Result<Outputs> {
        let formats = [(Format::Exr, "exr"), (Format::Png, "png")];
        let named = naming::named(&self.out, self.format, &formats)?;
        Target::new(&self.out).check()?;
        let with = |extension: &str| {
            let mut path = self.out.clone().into_os_string();
            path.push(extension);
            Some(Target::Path(path.into()))
        };
        let [exr, png] = match named {
            Some(Named {
                format: Format::Exr,
                target,
            }) => [Some(target), None],
            Some(Named { target, .. }) => [None, Some(target)],
            None => [with(".exr"), with(".png")],
        };
        for target in exr.iter().chain(&png) {
            target.check()?;
        }
        Ok(Outputs { exr, png })
    }
}

impl Outputs {
    fn wanted(&self, white: f32, about: About) -> Wanted {
        let [exr, png] = [&self.exr, &self.png].map(Option::is_some);
        Wanted {
            exr,
            png,
            white,
            about,
        }
    }

    fn all(&self) -> impl Iterator<Item = &Target> {
        self.exr.iter().chain(&self.png)
    }

    /// Both of a picture, or none: first the EXR gets its name, then the PNG.
    fn write(&self, picture: &Picture) -> Result<()> {
        let bytes = picture.exr.iter().chain(&picture.png);
        let files: Vec<_> = self.all().zip(bytes.map(Vec::as_slice)).collect();
        Ok(output::write(&files)?)
    }

    /// Where to say what was done.
    fn report(&self) -> Box<dyn Write> {
        match self.all().next() {
            Some(target) => target.report(),
            None => Box::new(std::io::stdout()),
        }
    }
}

impl Options {
    fn view(&self, model: &Model, conditions: &Conditions, azimuth: f64) -> Result<View> {
        if self.ground && self.quantity != Quantity::Radiance {
            let text = "the ground has no polarisation: --ground shows radiance only";
            return Err(Failure::message(text));
        }
        let ground = self.ground.then(|| Ground::new(model, conditions));
        Ok(View {
            projection: self.projection,
            size: self.projection.dimensions(self.size.into()),
            azimuth,
            ground: ground.transpose()?,
        })
    }

    /// The picture of a landscape and the number of its pixels.
    fn scene(&self, landscape: &Landscape, wanted: &mut Wanted) -> Result<(Picture, usize)> {
        if self.spectral || self.stokes || self.quantity != Quantity::Radiance {
            let text = "landscapes are in colour only, without --spectral, --stokes and --quantity";
            return Err(Failure::message(text));
        }
        let height = usize::from(self.size);
        let size = [(height as f64 * landscape::ASPECT) as usize, height];
        let pixels = landscape.pixels(size)?;
        landscape.describe(&self.landscape, &mut wanted.about);
        let picture = Picture::of_pixels(size, &pixels, wanted)?;
        Ok((picture, pixels.len()))
    }

    fn picture(
        &self,
        view: &View,
        sky: &Sky,
        polarised: Option<&PolarisedSky>,
        wanted: &mut Wanted,
    ) -> Result<Picture> {
        let projection = self.projection.name();
        wanted.about.text("projection", projection);
        if self.ground {
            wanted.about.text("ground", "lit");
        }
        match polarised {
            Some(polarised) if self.quantity != Quantity::Radiance => {
                let colouring = Colouring {
                    quantity: self.quantity,
                    axes: self.frame,
                    wavelength: self.wavelength,
                };
                Picture::of_polarisation(view, polarised, &colouring, wanted)
            }
            _ => Picture::of_sky(view, sky, polarised, self.spectral, wanted),
        }
    }
}

pub fn run(options: &Options) -> Result<()> {
    let outputs = options.outputs()?;
    let start = Instant::now();
    let model = options.source.open()?;
    let conditions = options.conditions(&model)?;
    let polarised = match options.stokes || options.quantity != Quantity::Radiance {
        true => Some(model.polarised_sky(&conditions)?),
        false => None,
    };
    let sky = match &polarised {
        Some(polarised) => polarised.sky().clone(),
        None => model.sky(&conditions)?,
    };
    let prepared = start.elapsed();
    let azimuth = options.scene.view_azimuth()?;
    let view = options.view(&model, &conditions, azimuth)?;
    let rendering = Instant::now();
    let white = match options.exposure {
        Some(value) => WHITE_AT_EV_0 * value.exp2(),
        // As a photographer opens the lens by one stop.
        None if options.landscape.is_filtered() => {
            f64::from(landscape::HALF) * automatic_white(&sky)?
        }
        None => automatic_white(&sky)?,
    };
    let mut about = About::scene(sky.conditions(), azimuth);
    about.text("model", options.source.name());
    about.number("exposureValue", (white / WHITE_AT_EV_0).log2());
    let mut wanted = outputs.wanted(white as f32, about);
    let (picture, count) = match options.landscape.prepare(&model, &conditions, azimuth)? {
        Some(landscape) => options.scene(&landscape, &mut wanted)?,
        None => {
            let picture = options.picture(&view, &sky, polarised.as_ref(), &mut wanted)?;
            (picture, view.size[0] * view.size[1])
        }
    };
    let rendered = rendering.elapsed();
    outputs.write(&picture)?;
    let mut out = outputs.report();
    report(options, &model, &sky, white, &mut out)?;
    for target in outputs.all() {
        writeln!(out, "wrote           {target}")?;
    }
    writeln!(
        out,
        "time            {:.2} ms to open and prepare, {:.0} ms for {count} pixels",
        1e3 * prepared.as_secs_f64(),
        1e3 * rendered.as_secs_f64(),
    )?;
    writeln!(
        out,
        "memory          {} of {} bytes of the model touched, {} bytes of tables prepared",
        model.touched_bytes(),
        model.file_bytes(),
        sky.bytes(),
    )?;
    Ok(())
}

/// The luminance of display white that suits a sky, cd m⁻².
pub fn automatic_white(sky: &Sky) -> Result<f64> {
    Ok(WHITE_OVER_MEAN * mean_luminance(sky)?)
}

/// Geometric mean over the upper hemisphere, cd m⁻².
fn mean_luminance(sky: &Sky) -> Result<f64> {
    let rings = 8;
    let spokes = 16;
    let (mut sum, mut count) = (0.0, 0.0);
    for ring in 0..rings {
        let z = (f64::from(ring) + 0.5) / f64::from(rings);
        for spoke in 0..spokes {
            let phi = f64::from(spoke) / f64::from(spokes) * std::f64::consts::TAU;
            let r = (1.0 - z * z).sqrt();
            let direction = [r * phi.cos(), r * phi.sin(), z].map(|v| v as f32);
            sum += f64::from(sky.xyz(direction)?[1]).max(1e-12).ln();
            count += 1.0;
        }
    }
    Ok((sum / count).exp())
}

fn report(
    options: &Options,
    model: &Model,
    sky: &Sky,
    white: f64,
    out: &mut dyn Write,
) -> Result<()> {
    let conditions = sky.conditions();
    writeln!(
        out,
        "model           {}, {} wavelengths",
        options.source.name(),
        model.wavelengths().len()
    )?;
    writeln!(
        out,
        "sun             elevation {:.2}°, azimuth {}°",
        conditions.solar_elevation.to_degrees(),
        fixed(conditions.solar_azimuth.to_degrees(), 2),
    )?;
    writeln!(
        out,
        "conditions      visibility {} km, albedo {}, altitude {} m",
        plain(conditions.visibility * 1e-3),
        plain(conditions.albedo),
        plain(conditions.altitude),
    )?;
    let zenith = sky.xyz([0.0, 0.0, 1.0])?[1];
    writeln!(out, "zenith          {} cd/m²", fixed(zenith.into(), 4))?;
    writeln!(
        out,
        "exposure        EV {:.2}",
        (white / WHITE_AT_EV_0).log2()
    )?;
    Ok(())
}
