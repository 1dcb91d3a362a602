//! `welkin-fit picture`: path-traced pictures of sky, ground and simple things on it.

use super::trace::AerosolArg;
use super::variation::VariationArgs;
use anyhow::{Context, Result, ensure};
use clap::{Args as ClapArgs, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use std::path::PathBuf;
use welkin::output::{Target, write};
use welkin_fitter::atmosphere::{Particles, real_varied};
use welkin_fitter::picture::camera::{Camera, Projection};
use welkin_fitter::picture::ground::{Ground, Pattern};
use welkin_fitter::picture::scene::{Builder, Place, Scene, Tower};
use welkin_fitter::picture::{Settings, image, load_obj, render};
use welkin_fitter::tracer::solids::Reflectance;
use welkin_fitter::tracer::{Aerosol, Options, Tracer};

/// Arguments of `picture`.
#[derive(ClapArgs)]
pub struct Args {
    /// Visibility, km (20..131.8).
    #[arg(long, default_value_t = 59.4)]
    visibility: f64,
    /// Wavelengths, nm, separated by commas; groups of up to 12 share walks.
    #[arg(
        long,
        value_delimiter = ',',
        default_value = "390,420,450,480,510,540,570,600,630,660,690,720"
    )]
    wavelengths: Vec<f64>,
    /// Aerosols: Henyey-Greenstein ones that depolarise or preserve polarisation, or full Mie matrices.
    #[arg(long, value_enum, default_value = "depolarising")]
    aerosol: AerosolArg,
    #[command(flatten)]
    variation: VariationArgs,
    /// Sun elevation, degrees.
    #[arg(long, default_value_t = 30.0)]
    solar_elevation: f64,
    /// Azimuth of the sun from the middle of the picture, degrees to the left.
    #[arg(long, default_value_t = 0.0)]
    solar_azimuth: f64,
    /// Angular radius of the sun, degrees.
    #[arg(long, default_value_t = 0.2667)]
    sun_radius: f64,
    /// Altitude of the camera, km.
    #[arg(long, default_value_t = 0.0)]
    altitude: f64,
    /// Projection.
    #[arg(long, value_enum, default_value = "perspective")]
    projection: ProjectionArg,
    /// Angle of the camera's axis above the horizontal, degrees; 90 for a fish-eye of the sky, with what is ahead at
    /// the lower edge (`--solar-azimuth 180` puts the sun at the upper one).
    #[arg(long, default_value_t = 0.0)]
    pitch: f64,
    /// Vertical field of view in perspective, degrees.
    #[arg(long, default_value_t = 50.0)]
    field_of_view: f64,
    /// Width, pixels.
    #[arg(long, default_value_t = 640)]
    width: usize,
    /// Height, pixels.
    #[arg(long, default_value_t = 360)]
    height: usize,
    /// Walks per pixel.
    #[arg(long, default_value_t = 64)]
    samples: usize,
    /// Pattern of the ground.
    #[arg(long, value_enum, default_value = "plain")]
    ground: GroundArg,
    /// Albedo of the ground's bright parts.
    #[arg(long, default_value_t = 0.3)]
    albedo: f64,
    /// Length of the pattern's cells, km.
    #[arg(long, default_value_t = 5.0)]
    cell: f64,
    /// A tower: AHEAD,LEFT,WIDTH,HEIGHT in km. May be repeated.
    #[arg(long = "tower", value_parser = tower, allow_hyphen_values = true)]
    towers: Vec<Tower>,
    /// A Wavefront OBJ mesh, y up.
    #[arg(long)]
    mesh: Option<PathBuf>,
    /// Where the mesh's origin stands: AHEAD,LEFT in km.
    #[arg(long, value_parser = place, default_value = "1,0", allow_hyphen_values = true)]
    mesh_at: Place,
    /// Metres per unit of the mesh.
    #[arg(long, default_value_t = 1.0)]
    mesh_scale: f64,
    /// Albedo of towers and of meshes without materials.
    #[arg(long, default_value_t = 0.6)]
    surface_albedo: f64,
    /// Seed of the random numbers.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// EXR to write: linear sRGB in cd m⁻²; - for standard output. Of two files the EXR is renamed first.
    #[arg(long, required_unless_present = "png")]
    exr: Option<PathBuf>,
    /// Put the spectrum into the EXR, too.
    #[arg(long, requires = "exr")]
    spectral: bool,
    /// PNG to write; - for standard output.
    #[arg(long)]
    png: Option<PathBuf>,
    /// Luminance of display white in the PNG, cd m⁻²; without it, three times the picture's geometric mean.
    #[arg(long)]
    white: Option<f32>,
}

#[derive(Clone, Copy, ValueEnum)]
enum ProjectionArg {
    Perspective,
    FishEye,
    LatLong,
}

#[derive(Clone, Copy, ValueEnum)]
enum GroundArg {
    Plain,
    Checker,
    Grid,
}

fn kilometres<const N: usize>(text: &str) -> Result<[f64; N]> {
    let values = text
        .split(',')
        .map(|cell| {
            let value: f64 = cell
                .trim()
                .parse()
                .with_context(|| format!("\"{cell}\" is not a number"))?;
            Ok(1000.0 * value)
        })
        .collect::<Result<Vec<_>>>()?;
    let count = values.len();
    let values = values.try_into().ok();
    values.with_context(|| format!("{N} numbers are needed, not {count}"))
}

fn place(text: &str) -> Result<Place> {
    let [ahead, left] = kilometres(text)?;
    Ok(Place { ahead, left })
}

fn tower(text: &str) -> Result<Tower> {
    let [ahead, left, width, height] = kilometres(text)?;
    Ok(Tower {
        place: Place { ahead, left },
        width,
        height,
    })
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    ensure!(
        args.wavelengths.windows(2).all(|w| w[0] < w[1]),
        "--wavelengths must increase"
    );
    ensure!(
        args.white
            .is_none_or(|white| white.is_finite() && white > 0.0),
        "--white is not positive"
    );
    let [exr, png] = [&args.exr, &args.png].map(|path| path.as_ref().map(Target::new));
    ensure!(exr != png, "--exr and --png are the same");
    for target in exr.iter().chain(&png) {
        target.check()?;
    }
    let particles = match args.aerosol {
        AerosolArg::Mie => Particles::Mie,
        _ => Particles::HenyeyGreenstein,
    };
    let variation = args.variation.variation();
    let air = real_varied(
        1000.0 * args.visibility,
        &args.wavelengths,
        particles,
        variation,
    )?;
    let tracer = Tracer::new(&air, args.options())?;
    let scene = args.scene(air.planet_radius)?;
    let style = ProgressStyle::with_template("render {bar:40} {pos}/{len} {eta}");
    let bar = ProgressBar::new(args.height as u64)
        .with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    let done = || bar.inc(1);
    let picture = render(&tracer, &args.wavelengths, &scene, &args.settings(), &done)?;
    bar.finish();
    let mut files = Vec::new();
    if let Some(target) = &exr {
        let spectrum = args.spectral.then_some(args.wavelengths.as_slice());
        files.push((target, image::exr(&picture, spectrum)?));
    }
    if let Some(target) = &png {
        let automatic = || image::automatic_white(&picture);
        let white = args.white.unwrap_or_else(automatic);
        files.push((target, image::png(&picture, white)?));
    }
    let files: Vec<_> = files.iter().map(|(t, b)| (*t, b.as_slice())).collect();
    Ok(write(&files)?)
}

impl Args {
    fn options(&self) -> Options {
        Options {
            aerosol: match self.aerosol {
                AerosolArg::Preserving => Aerosol::Preserving,
                _ => Aerosol::Depolarising,
            },
            sun_radius: self.sun_radius.to_radians(),
            ..Options::default()
        }
    }

    fn settings(&self) -> Settings {
        Settings {
            camera: Camera {
                projection: match self.projection {
                    ProjectionArg::Perspective => {
                        Projection::Perspective(self.field_of_view.to_radians())
                    }
                    ProjectionArg::FishEye => Projection::FishEye,
                    ProjectionArg::LatLong => Projection::LatLong,
                },
                pitch: self.pitch.to_radians(),
                size: [self.width, self.height],
            },
            altitude: 1000.0 * self.altitude,
            sun_elevation: self.solar_elevation.to_radians(),
            sun_azimuth: self.solar_azimuth.to_radians(),
            samples: self.samples,
            seed: self.seed,
        }
    }

    fn scene(&self, radius: f64) -> Result<Scene> {
        ensure!(
            (0.0..=1.0).contains(&self.surface_albedo),
            "--surface-albedo {:?} is outside 0..1",
            self.surface_albedo
        );
        let reflectance = Reflectance::grey(self.surface_albedo);
        let mut builder = Builder::new(radius);
        for (i, tower) in self.towers.iter().enumerate() {
            let added = builder.tower(tower, reflectance);
            added.with_context(|| format!("tower {}", i + 1))?;
        }
        if let Some(path) = &self.mesh {
            builder.mesh(&load_obj(path, reflectance)?, self.mesh_at, self.mesh_scale)?;
        }
        builder.build(Ground {
            pattern: match self.ground {
                GroundArg::Plain => Pattern::Plain,
                GroundArg::Checker => Pattern::Checker,
                GroundArg::Grid => Pattern::Grid,
            },
            albedo: self.albedo,
            cell: 1000.0 * self.cell,
        })
    }
}
