//! `welkin export`: the sky and the sun for renderers, as each expects them.

mod arnold;
mod axes;
mod lights;
mod names;
mod pbrt;
mod spectrum;
mod usd;

use std::f64::consts::FRAC_PI_2;
use std::io::Write;
use std::path::PathBuf;

use clap::ValueEnum;
use welkin::{ColourSpace, Conditions, Model};

use crate::Source;
use crate::about::{About, LUMINANCE};
use crate::disc::Disc;
use crate::encoding::Encoding;
use crate::exposure;
use crate::failure::{Failure, Result};
use crate::ground::Ground;
use crate::image::{Planes, exr};
use crate::parameter;
use crate::projection::Projection;
use crate::scene::Scene;
use crate::view::View;

use axes::Up;
use lights::{Lights, Sun};
use names::Files;
use usd::Intensity;

#[derive(clap::Args)]
pub struct Options {
    /// The renderer.
    #[arg(long = "for", value_enum, value_name = "RENDERER")]
    renderer: Renderer,
    #[command(flatten)]
    source: Source,
    #[command(flatten)]
    scene: Scene,
    /// Height of the map, pixels: lat-long maps are twice as wide, that for pbrt is a square.
    #[arg(
        long,
        default_value_t = 1024,
        value_parser = clap::value_parser!(u16).range(4..=16384),
        value_name = "PIXELS"
    )]
    size: u16,
    /// Axis of the scene that points to the zenith: z for pbrt and usd, y for arnold and karma if absent.
    #[arg(long, value_enum, value_name = "AXIS")]
    up: Option<Up>,
    /// Put the sun's disc into the map instead of a light of its own. It is some pixels, 10⁵ times as bright as the
    /// sky, which few renderers sample well.
    #[arg(long)]
    sun: bool,
    /// Fill what is below the horizon with the ground of the given albedo in the light of sun and sky; black if absent.
    #[arg(long)]
    ground: bool,
    /// Scale all light for a camera without an exposure: white at this exposure value at ISO 100 becomes 1. If absent,
    /// values are cd/m² and lx. The map stays as it is; the scene says the factor.
    #[arg(long, value_name = "EV", value_parser = exposure::value)]
    exposure: Option<f64>,
    /// Base name of the map (.exr) and the scene (.pbrt, .ass, .usda), or the name of one of them.
    #[arg(long, default_value = "sky", value_name = "FILE")]
    out: PathBuf,
    #[command(flatten)]
    encoding: Encoding,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Renderer {
    /// pbrt-v4: an equal-area map, a distant light with the spectrum of the sun.
    Pbrt,
    /// Arnold: a skydome and a distant light.
    Arnold,
    /// Karma in Houdini: UsdLux, the sun by the luminance of its disc.
    Karma,
    /// UsdLux for any renderer, the sun by its illuminance.
    Usd,
}

impl Renderer {
    fn extension(self) -> &'static str {
        match self {
            Self::Pbrt => "pbrt",
            Self::Arnold => "ass",
            Self::Karma | Self::Usd => "usda",
        }
    }

    /// Which axis is up where nothing else is said.
    fn up(self) -> Up {
        match self {
            Self::Pbrt | Self::Usd => Up::Z,
            Self::Arnold | Self::Karma => Up::Y,
        }
    }

    /// Of the map, and the azimuth (rad) that it looks to.
    fn projection(self) -> (Projection, f64) {
        match self {
            Self::Pbrt => (Projection::Octahedral, 0.0),
            // The middle of OpenEXR's lat-long maps is +z with +y up, which is −y with +z up.
            _ => (Projection::LatLong, -FRAC_PI_2),
        }
    }

    fn check(self, space: ColourSpace) -> Result<()> {
        if space == ColourSpace::Xyz {
            let text = "renderers take RGB: --colour-space srgb, rec2020 or acescg, not xyz";
            return Err(Failure::message(text));
        }
        match self {
            Self::Pbrt => pbrt::check(space),
            _ => Ok(()),
        }
    }

    fn scene(self, lights: &Lights, model: &Model) -> Result<String> {
        Ok(match self {
            Self::Pbrt => {
                let sun = lights.sun.as_ref();
                let spectrum = sun.map(|sun| spectrum::samples(model, &sun.conditions));
                pbrt::scene(lights, &spectrum.transpose()?.unwrap_or_default())
            }
            Self::Arnold => arnold::scene(lights),
            Self::Karma => usd::scene(lights, Intensity::Luminance),
            Self::Usd => usd::scene(lights, Intensity::Illuminance),
        })
    }
}

pub fn run(options: &Options) -> Result<()> {
    let renderer = options.renderer;
    renderer.check(options.encoding.space())?;
    if options.sun && options.encoding.is_half() {
        let text = "half precision ends far below the sun's disc, which would be lost: --exr-type float, or no --sun";
        return Err(Failure::message(text));
    }
    let files = Files::new(&options.out, renderer.extension())?;
    let model = options.scene.over_ground(options.source.open()?);
    parameter::required(&model, options.scene.has_visibility())?;
    let conditions = options.scene.conditions(&model)?;
    let lights = options.lights(&model, &conditions, files.name.clone())?;
    let scene = renderer.scene(&lights, &model)?;
    let picture = options.map(&model, &conditions)?;
    files.write(&picture, scene.as_bytes())?;
    report(&lights, &files)
}

impl Options {
    fn lights(&self, model: &Model, conditions: &Conditions, picture: String) -> Result<Lights> {
        let space = self.encoding.space();
        let sun = match self.sun {
            true => None,
            false => Sun::new(model, conditions, space)?,
        };
        Ok(Lights {
            picture,
            size: self.size.into(),
            up: self.up.unwrap_or(self.renderer.up()),
            space,
            space_id: self.encoding.interop_id(),
            sun,
            exposure: self.exposure,
            about: lights::about(model, conditions, &self.source.name())?,
        })
    }

    /// The encoded map.
    fn map(&self, model: &Model, conditions: &Conditions) -> Result<Vec<u8>> {
        let (projection, azimuth) = self.renderer.projection();
        let ground = self.ground.then(|| Ground::new(model, conditions));
        let disc = self.sun.then(|| Disc::new(model, conditions));
        let view = View {
            projection,
            size: projection.dimensions(self.size.into()),
            azimuth,
            ground: ground.transpose()?,
            disc: disc.transpose()?,
            moon: None,
        };
        let pixels = view.rgb(&model.sky(conditions)?)?;
        if self.renderer == Renderer::Pbrt {
            self.warn_of_negatives(&pixels);
        }
        let channel = |c: usize| pixels.iter().map(|p| p[c]).collect();
        let names = ["R", "G", "B"].into_iter().enumerate();
        let planes = Planes {
            size: view.size,
            planes: names
                .map(|(c, name)| (name.to_owned(), channel(c)))
                .collect(),
            about: self.about(model, conditions, azimuth, projection)?,
            units: LUMINANCE,
            space: ColourSpace::Srgb,
            comment: self.encoding.comment(),
        };
        exr(planes, &self.encoding)
    }

    fn about(
        &self,
        model: &Model,
        conditions: &Conditions,
        azimuth: f64,
        projection: Projection,
    ) -> Result<About> {
        let mut about = About::scene(model, conditions, azimuth)?;
        about.text("model", self.source.name());
        about.text("projection", projection.name());
        if self.ground {
            about.text("ground", "lit");
        }
        if self.sun {
            about.text("sun", "disc");
        }
        Ok(about)
    }

    /// pbrt makes spectra of colours, and none of negative ones.
    fn warn_of_negatives(&self, pixels: &[[f32; 3]]) {
        let space = self.encoding.space();
        let is_outside = |&&rgb: &&[f32; 3]| space.from_linear_srgb(rgb).iter().any(|&v| v < 0.0);
        let count = pixels.iter().filter(is_outside).count();
        if count > 0 {
            let hint = match space {
                ColourSpace::Srgb => ": --colour-space rec2020 has more colours",
                _ => "",
            };
            eprintln!(
                "warning: pbrt takes negative components, which {count} pixels out of the gamut have, for 0{hint}"
            );
        }
    }
}

fn report(lights: &Lights, files: &Files) -> Result<()> {
    let mut out = std::io::stdout().lock();
    match &lights.sun {
        Some(sun) => {
            let [r, g, b] = sun.colour;
            writeln!(
                out,
                "sun             {:.5e} lx, colour {r:.4} {g:.4} {b:.4}, disc {:.4}° wide",
                sun.illuminance,
                Sun::angle(),
            )?;
        }
        None => writeln!(out, "sun             no light of its own")?,
    }
    for target in files.all() {
        writeln!(out, "wrote           {target}")?;
    }
    Ok(())
}
