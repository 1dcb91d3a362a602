//! All pixels of a picture.

use super::camera::Camera;
use super::colour::Colour;
use super::scene::Scene;
use crate::tracer::{Pixel, Tracer, View};
use anyhow::{Result, ensure};
use rayon::prelude::*;
use std::f64::consts::FRAC_PI_2;

/// What is rendered, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The camera.
    pub camera: Camera,
    /// Its altitude, m.
    pub altitude: f64,
    /// Elevation of the sun above the camera's horizontal plane, radians.
    pub sun_elevation: f64,
    /// Azimuth of the sun from straight ahead, to the left, radians.
    pub sun_azimuth: f64,
    /// Walks per pixel.
    pub samples: usize,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// A rendered picture, rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width and height.
    pub size: [usize; 2],
    /// Linear sRGB, cd m⁻² at white.
    pub rgb: Vec<[f32; 3]>,
    /// Upper bound of the standard error of the luminance, cd m⁻².
    pub error: Vec<f32>,
    /// Radiance per wavelength, W m⁻² nm⁻¹ sr⁻¹.
    pub spectrum: Vec<Vec<f32>>,
}

impl Settings {
    fn check(&self) -> Result<()> {
        self.camera.check()?;
        ensure!(
            self.sun_elevation.abs() <= FRAC_PI_2 + 1e-12,
            "sun elevation {:?} is outside -90..90 degrees",
            self.sun_elevation.to_degrees()
        );
        ensure!(
            self.sun_azimuth.is_finite(),
            "sun azimuth {} is not finite",
            self.sun_azimuth
        );
        Ok(())
    }
}

/// Renders a picture at the tracer's `wavelengths` (nm); `done` is called after every row. The result depends on the
/// arguments only.
pub fn render(
    tracer: &Tracer,
    wavelengths: &[f64],
    scene: &Scene,
    settings: &Settings,
    done: &(dyn Fn() + Sync),
) -> Result<Picture> {
    settings.check()?;
    let [width, height] = settings.camera.size;
    let colour = Colour::new(wavelengths)?;
    let view = View {
        altitude: settings.altitude,
        sun_elevation: settings.sun_elevation,
        sun_azimuth: settings.sun_azimuth,
        solids: scene,
    };
    let row = |y: usize| -> Result<Vec<Option<Pixel>>> {
        let pixel = |x: usize| {
            if !settings.camera.sees([x, y]) {
                return Ok(None);
            }
            let direction = |u: f64, v: f64| settings.camera.direction([x, y], [u, v]);
            let counters = (settings.seed, (y * width + x) as u64);
            tracer
                .pixel(&view, &direction, settings.samples, counters)
                .map(Some)
        };
        let row = (0..width).map(pixel).collect();
        done();
        row
    };
    let rows = (0..height)
        .into_par_iter()
        .map(row)
        .collect::<Result<Vec<_>>>()?;
    let pixels: Vec<Option<Pixel>> = rows.into_iter().flatten().collect();
    Ok(develop(settings.camera.size, &pixels, &colour))
}

fn develop(size: [usize; 2], pixels: &[Option<Pixel>], colour: &Colour) -> Picture {
    let rgb = |pixel: &Option<Pixel>| pixel.as_ref().map_or([0.0; 3], |p| colour.rgb(&p.radiance));
    let error = |pixel: &Option<Pixel>| {
        let error = pixel.as_ref().map_or(0.0, |p| colour.luminance(&p.error));
        error as f32
    };
    let plane = |(w, irradiance): (usize, &f64)| {
        let radiance = |p: &Option<Pixel>| p.as_ref().map_or(0.0, |p| p.radiance[w] * irradiance);
        pixels.iter().map(|p| radiance(p) as f32).collect()
    };
    Picture {
        size,
        rgb: pixels.iter().map(rgb).collect(),
        error: pixels.iter().map(error).collect(),
        spectrum: colour.irradiance().iter().enumerate().map(plane).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::camera::Projection;
    use super::super::ground::{Ground, Pattern};
    use super::super::scene::{Builder, Place, Tower};
    use super::*;
    use crate::atmosphere::real;
    use crate::tracer::Options;
    use crate::tracer::solids::Reflectance;

    fn picture(threads: usize, sun_azimuth: f64) -> Picture {
        let wavelengths = [450.0, 550.0, 650.0];
        let air = real(40_000.0, &wavelengths).unwrap();
        let tracer = Tracer::new(&air, Options::default()).unwrap();
        let mut builder = Builder::new(air.planet_radius);
        let tower = Tower {
            place: Place {
                ahead: 10_000.0,
                left: 0.0,
            },
            width: 6000.0,
            height: 6000.0,
        };
        builder.tower(&tower, Reflectance::grey(0.8)).unwrap();
        let ground = Ground {
            pattern: Pattern::Plain,
            albedo: 0.2,
            cell: 1000.0,
        };
        let scene = builder.build(ground).unwrap();
        let settings = Settings {
            camera: Camera {
                projection: Projection::Perspective(1.2),
                pitch: 0.1,
                size: [12, 8],
            },
            altitude: 1000.0,
            sun_elevation: 0.3,
            sun_azimuth,
            samples: 64,
            seed: 1,
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap()
            .install(|| render(&tracer, &wavelengths, &scene, &settings, &|| ()).unwrap())
    }

    #[test]
    fn a_picture_does_not_depend_on_threads() {
        assert_eq!(picture(1, 2.0), picture(3, 2.0));
    }

    #[test]
    fn towers_are_bright_on_the_suns_side() {
        let middle = |p: &Picture| p.rgb[4 * 12 + 6][1];
        let (behind, ahead) = (picture(2, std::f64::consts::PI), picture(2, 0.0));
        assert!(middle(&behind) > 2.0 * middle(&ahead));
        let sky = behind.rgb[0];
        assert!(sky[2] > 1.2 * sky[0], "{sky:?}");
    }
}
