//! `welkin render`.

use std::io::Write;
use std::time::{Duration, Instant};

use welkin::{Conditions, Model, PolarisedSky, Sky};

use crate::Source;
use crate::about::About;
use crate::camera::Heading;
use crate::disc::Disc;
use crate::exposure::Exposure;
use crate::failure::{Failure, Result, fixed, plain};
use crate::ground::Ground;
use crate::landscape::{self, Landscape};
use crate::moonlight::{self, Lit};
use crate::outputs::{self, Outputs};
use crate::parameter;
use crate::picture::{Picture, Wanted};
use crate::polarised::{Axes, Colouring, Quantity};
use crate::projection::Projection;
use crate::scene::Scene;
use crate::sensor;
use crate::space::{self, Space};
use crate::tone::Film;
use crate::view::{Moonlight, View};

#[derive(clap::Args)]
#[group(skip)]
pub struct Options {
    #[command(flatten)]
    pub source: Source,
    #[command(flatten)]
    pub scene: Scene,
    #[command(flatten)]
    moon: moonlight::Options,
    #[command(flatten)]
    heading: Heading,
    /// How the sphere of directions is laid onto the picture.
    #[arg(long, value_enum, default_value = "up")]
    projection: Projection,
    /// Height of the picture or of a face of the cube, pixels; lat-long is twice as wide.
    #[arg(long, default_value_t = 768, value_parser = clap::value_parser!(u16).range(1..=16384), value_name = "PIXELS")]
    size: u16,
    #[command(flatten)]
    pub outputs: outputs::Options,
    /// Write the EXR with one channel per wavelength (W m⁻² sr⁻¹ nm⁻¹) instead of linear sRGB (cd m⁻²).
    #[arg(long, conflicts_with = "sensor")]
    spectral: bool,
    /// Write the EXR with Stokes layers: S0.R … S3.B, or with --spectral S0.550nm and the like for
    /// each wavelength.
    #[arg(long, conflicts_with = "sensor")]
    stokes: bool,
    /// Fill what is below the horizon with the ground of the given albedo in the light of sun and sky; black if absent.
    #[arg(long, conflicts_with_all = ["stokes", "terrain", "sensor"])]
    ground: bool,
    /// Add the sun's disc, darker towards its limb; pixels that it covers in part get their share of its light. It is
    /// 10⁵ times as bright as the sky: environment maps are better off with a light of their own (welkin light).
    #[arg(long, conflicts_with_all = ["stokes", "polariser", "sensor"])]
    sun: bool,
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
    pub sensor: sensor::Options,
    #[command(flatten)]
    pub landscape: landscape::Options,
    #[command(flatten)]
    exposure: Exposure,
}

const ZENITH: [f32; 3] = [0.0, 0.0, 1.0];

/// A picture, and what it was made of.
pub struct Shot {
    pub picture: Picture,
    /// With the sun, wherever it is.
    conditions: Conditions,
    /// Memory of the tables, bytes.
    bytes: usize,
    film: Film,
    /// Luminance of the zenith, cd m⁻².
    zenith: f32,
    pixels: usize,
    /// How long the sky took.
    prepared: Duration,
}

impl Options {
    /// As many conditions as there are steps in the course of the sun.
    pub fn course(&self, model: &Model, steps: usize) -> Result<Vec<Conditions>> {
        parameter::required(model, self.scene.has_visibility())?;
        let has_moon = self.moon.moon().is_some();
        let mut course = self.scene.course_beyond(model, steps, has_moon)?;
        for conditions in &course {
            self.moon.check(model, conditions)?;
        }
        if let (None, Some(altitude)) = (self.scene.altitude, self.landscape.altitude()) {
            let [lowest, highest] = model.altitude_range();
            let altitude = altitude.clamp(lowest, highest);
            course.iter_mut().for_each(|c| c.altitude = altitude);
        }
        Ok(course)
    }

    /// A picture under some conditions, with `marks` about it.
    pub fn shot(
        &self,
        model: &Model,
        conditions: &Conditions,
        outputs: &Outputs,
        marks: &[(&'static str, &str)],
    ) -> Result<Shot> {
        if space::is_beyond(model, conditions) {
            return self.shot_from_space(model, conditions, outputs, marks);
        }
        let start = Instant::now();
        let moon = self.moon.lit(model, conditions)?;
        let conditions_of_sun = conditions;
        let (model, conditions, moon) = match (&moon, moonlight::is_up(model, conditions)) {
            (Some(moon), false) => (&moon.model, &moon.conditions, None),
            (moon, _) => (model, conditions, moon.as_ref()),
        };
        let sensor = match self.sensor.sensor(model)? {
            Some(sensor) => Some((sensor, model.band_sky(conditions, &sensor.bands)?)),
            None => None,
        };
        let polarised = match self.stokes || self.quantity != Quantity::Radiance {
            true => Some(model.polarised_sky(conditions)?),
            false => None,
        };
        let sky = match &polarised {
            Some(polarised) => polarised.sky().clone(),
            None => model.sky(conditions)?,
        };
        let prepared = start.elapsed();
        let azimuth = self.heading.azimuth(self.landscape.azimuth())?;
        let mut about = About::scene(model, conditions_of_sun, azimuth)?.with(marks);
        self.moon.describe(&mut about);
        about.text("model", self.source.name());
        if self.sun {
            about.text("sun", "disc");
        }
        let mut zenith = sky.xyz(ZENITH)?[1];
        let landscape = self
            .landscape
            .prepare(model, conditions, azimuth, self.sun)?;
        let (picture, film, pixels) = match landscape {
            Some(landscape) => self.scenery(&landscape, outputs, about)?,
            None => {
                let view = View {
                    moon: moon.map(|moon| self.moonlight(moon)).transpose()?,
                    ..self.view(model, conditions, azimuth)?
                };
                let film = self.exposure.of_sky(&view, &sky)?;
                let mut wanted = outputs.wanted(film, about);
                let picture = match &sensor {
                    Some((sensor, bands)) => {
                        wanted.about.text("projection", self.projection.name());
                        Picture::of_bands(&view, &sky, (sensor, bands), &wanted)?
                    }
                    None => self.picture(&view, &sky, polarised.as_ref(), &mut wanted)?,
                };
                zenith = view.xyz(&sky, ZENITH)?[1];
                (picture, film, view.size[0] * view.size[1])
            }
        };
        Ok(Shot {
            picture,
            conditions: *conditions_of_sun,
            bytes: sky.bytes(),
            film,
            zenith,
            pixels,
            prepared,
        })
    }

    /// The same of an observer beyond the air.
    fn shot_from_space(
        &self,
        model: &Model,
        conditions: &Conditions,
        outputs: &Outputs,
        marks: &[(&'static str, &str)],
    ) -> Result<Shot> {
        let is_plain = !(self.spectral || self.stokes || self.sun || self.sensor.is_wanted())
            && self.quantity == Quantity::Radiance
            && self.moon.moon().is_none();
        let azimuth = self.heading.azimuth(self.landscape.azimuth())?;
        if !is_plain || self.landscape.is_wanted() {
            let text = "from beyond the air pictures are in colour only: without --spectral, --stokes, --quantity, \
                        --bands, --wavelengths, --sun, --moon-elevation and --terrain";
            return Err(Failure::message(text));
        }
        if model.ground().is_some() {
            let text = "from beyond the air the ground has one albedo at all wavelengths: give --albedo a number";
            return Err(Failure::message(text));
        }
        let start = Instant::now();
        let view = self.view(model, conditions, azimuth)?;
        let bytes = self.source.bytes()?;
        let space = Space::new(model, &bytes, conditions)?;
        let prepared = start.elapsed();
        let pixels = space.rgb(&view)?;
        let film = self.exposure.of_landscape(&pixels);
        let mut about = About::scene(model, conditions, azimuth)?.with(marks);
        about.text("model", self.source.name());
        about.text("projection", self.projection.name());
        if self.ground {
            about.text("ground", "lit");
        }
        let picture = Picture::of_pixels(view.size, &pixels, &outputs.wanted(film, about))?;
        Ok(Shot {
            picture,
            conditions: *conditions,
            bytes: 0,
            film,
            zenith: 0.0,
            pixels: pixels.len(),
            prepared,
        })
    }

    fn view(&self, model: &Model, conditions: &Conditions, azimuth: f64) -> Result<View> {
        let is_false_colour = self.quantity != Quantity::Radiance;
        for (wanted, text) in [
            (
                self.ground,
                "the ground has no polarisation: --ground shows radiance only",
            ),
            (
                self.sun,
                "the sun is not polarised: --sun shows radiance only",
            ),
            (
                self.moon.moon().is_some(),
                "the moon's polarisation is not shown: --moon-elevation shows radiance only",
            ),
            (
                self.sensor.is_wanted(),
                "bands have no quantity but radiance: --bands and --wavelengths show that only",
            ),
        ] {
            if wanted && is_false_colour {
                return Err(Failure::message(text));
            }
        }
        let ground = self.ground.then(|| Ground::new(model, conditions));
        let disc = self.sun.then(|| Disc::new(model, conditions));
        Ok(View {
            projection: self.projection,
            size: self.projection.dimensions(self.size.into()),
            azimuth,
            ground: ground.transpose()?,
            disc: disc.transpose()?,
            moon: None,
        })
    }

    /// What the moon adds.
    fn moonlight(&self, Lit { model, conditions }: &Lit) -> Result<Moonlight> {
        let ground = self.ground.then(|| Ground::new(model, conditions));
        let disc = self.sun.then(|| Disc::new(model, conditions));
        Ok(Moonlight {
            sky: model.sky(conditions)?,
            ground: ground.transpose()?,
            disc: disc.transpose()?,
        })
    }

    /// The picture of a landscape, how it is exposed, and the number of its pixels.
    fn scenery(
        &self,
        landscape: &Landscape,
        outputs: &Outputs,
        mut about: About,
    ) -> Result<(Picture, Film, usize)> {
        if self.spectral || self.stokes || self.quantity != Quantity::Radiance {
            let text = "landscapes are in colour only, without --spectral, --stokes and --quantity";
            return Err(Failure::message(text));
        }
        let height = usize::from(self.size);
        let width = (height as f64 * landscape::ASPECT).round();
        let size = [width as usize, height];
        let pixels = landscape.pixels(size)?;
        landscape.describe(&self.landscape, &mut about);
        let film = self.exposure.of_landscape(&pixels);
        let picture = Picture::of_pixels(size, &pixels, &outputs.wanted(film, about))?;
        Ok((picture, film, pixels.len()))
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
    let outputs = options.outputs.one()?;
    let start = Instant::now();
    let model = options.scene.over_ground(options.source.open()?);
    options.scene.sun.still()?;
    let conditions = options.course(&model, 1)?[0];
    let opened = start.elapsed();
    let shot = options.shot(&model, &conditions, &outputs, &[])?;
    let prepared = opened + shot.prepared;
    let rendered = start.elapsed() - prepared;
    outputs.write(&shot.picture)?;
    let mut out = outputs.report();
    report(options, &model, &shot, &mut out)?;
    for target in outputs.all() {
        writeln!(out, "wrote           {target}")?;
    }
    writeln!(
        out,
        "time            {:.2} ms to open and prepare, {:.0} ms for {} pixels",
        1e3 * prepared.as_secs_f64(),
        1e3 * rendered.as_secs_f64(),
        shot.pixels,
    )?;
    writeln!(
        out,
        "memory          {} of {} bytes of the model touched, {} bytes of tables prepared",
        model.touched_bytes(),
        model.file_bytes(),
        shot.bytes,
    )?;
    Ok(())
}

fn report(options: &Options, model: &Model, shot: &Shot, out: &mut dyn Write) -> Result<()> {
    let conditions = &shot.conditions;
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
    if let Some(moon) = options.moon.moon() {
        writeln!(
            out,
            "moon            elevation {:.2}°, azimuth {}°, phase angle {}°",
            moon.elevation.to_degrees(),
            fixed(moon.azimuth.to_degrees(), 2),
            fixed(moon.phase_angle.to_degrees(), 2),
        )?;
    }
    writeln!(
        out,
        "conditions      {}, albedo {}, altitude {} m",
        parameter::air(model, conditions.visibility)?,
        plain(parameter::rounded(conditions.albedo)),
        plain(conditions.altitude),
    )?;
    writeln!(
        out,
        "zenith          {} cd/m²",
        fixed(shot.zenith.into(), 4)
    )?;
    writeln!(out, "exposure        EV {:.2}", shot.film.exposure_value())?;
    Ok(())
}
