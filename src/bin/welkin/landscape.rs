//! A landscape that recedes: terrain in sunlight and skylight, seen through the air.

use std::f64::consts::PI;
use std::path::{Path, PathBuf};

use welkin::{
    AerialPerspective, Conditions, Model, PolarisationFrame, PolarisedSky, Sky, Stokes,
    xyz_to_linear_srgb,
};

use crate::about::About;
use crate::camera::{Camera, Lens};
use crate::difference::{Difference, Method};
use crate::disc::Disc;
use crate::edges::{self, Seen};
use crate::failure::{Failure, Result};
use crate::parallel;
use crate::terrain::{FARTHEST, Field, Terrain, altitude, noise};

/// What stands on the ground.
#[derive(clap::Args)]
#[group(skip)]
pub struct Options {
    #[command(flatten)]
    lens: Lens,
    /// Render a landscape in perspective instead of the sky alone: `flat`, `hills`, or a height field (.png or .exr, +y
    /// up). Before `hills` --altitude is 2600 m, --view-azimuth 104°, and --pitch towards a mountain there, if they are
    /// absent.
    #[arg(long, value_name = "FILE", conflicts_with = "sensor")]
    terrain: Option<PathBuf>,
    /// Width of the height field on the ground, km.
    #[arg(long, default_value_t = 50.0, value_name = "KM")]
    terrain_width: f64,
    /// Height of the hills or of white in the height field, m; 3000 m, or 1 for an EXR, if absent.
    #[arg(long, value_name = "M")]
    terrain_height: Option<f64>,
    /// Look at the landscape through an ideal polariser that passes light along this angle from the top of the picture
    /// to the right, degrees.
    #[arg(
        long,
        value_name = "DEG",
        requires = "terrain",
        conflicts_with = "sensor"
    )]
    polariser: Option<f64>,
    /// How the light of the air before the terrain is computed.
    #[arg(
        long,
        value_enum,
        default_value_t,
        requires = "terrain",
        conflicts_with_all = ["polariser", "sensor"]
    )]
    aerial_perspective: Method,
}

/// Width over height of a picture in perspective.
pub const ASPECT: f64 = 1.5;
/// Reflectance in linear sRGB.
const MEADOW: [f32; 3] = [0.09, 0.12, 0.05];
const WOOD: [f32; 3] = [0.03, 0.045, 0.02];
const ROCK: [f32; 3] = [0.19, 0.17, 0.15];
const SNOW: [f32; 3] = [0.75, 0.77, 0.80];

/// What the built-in hills are looked at from, above the origin, m …
const VIEWPOINT: f64 = 2600.0;
/// … and a mountain there: azimuth (rad), distance and height (m).
const MOUNTAIN: [f64; 3] = [104.0 * PI / 180.0, 5900.0, 2136.0];

/// All that a landscape needs.
pub struct Landscape<'a> {
    terrain: Terrain,
    lens: Lens,
    camera: Camera,
    place: [f64; 3],
    aerial: AerialPerspective,
    /// Instead of the aerial perspective's own light.
    difference: Option<Difference<'a>>,
    sky: Sky,
    /// The sun's disc; none if absent.
    disc: Option<Disc>,
    /// XYZ per unit of relative radiance.
    xyz: Vec<[f64; 3]>,
    /// Irradiance of a level plane by the sky, linear sRGB.
    skylight: [f32; 3],
    polariser: Option<Polariser>,
}

/// A polarising filter before the camera.
struct Polariser {
    sky: PolarisedSky,
    /// rad, from the up vector of the camera to the right.
    angle: f32,
    frame: PolarisationFrame,
}

/// What an ideal polariser leaves of light that is not polarised: that of the ground is taken to be so.
const HALF: f32 = 0.5;

impl Options {
    /// The height field, if one is wanted.
    pub fn file(&self) -> Option<&Path> {
        let name = self.terrain.as_deref();
        name.filter(|path| ![Path::new("flat"), Path::new("hills")].contains(path))
    }

    /// Whether there is to be one.
    pub fn is_wanted(&self) -> bool {
        self.terrain.is_some()
    }

    fn is_hills(&self) -> bool {
        self.terrain.as_deref() == Some(Path::new("hills"))
    }

    /// Where observers are who did not say, m.
    pub fn altitude(&self) -> Option<f64> {
        self.is_hills().then_some(VIEWPOINT)
    }

    /// Where they look, rad.
    pub fn azimuth(&self) -> f64 {
        match self.is_hills() {
            true => MOUNTAIN[0],
            false => 0.0,
        }
    }

    /// How far up, from so high (m), rad.
    fn pitch(&self, height: f64) -> f64 {
        match self.is_hills() {
            true => (MOUNTAIN[2] - height).atan2(MOUNTAIN[1]),
            false => 0.0,
        }
    }

    /// Prepares the landscape around an observer, if one is wanted.
    pub fn prepare<'a>(
        &self,
        model: &'a Model,
        conditions: &Conditions,
        azimuth: f64,
        has_disc: bool,
    ) -> Result<Option<Landscape<'a>>> {
        let Some(terrain) = &self.terrain else {
            return Ok(None);
        };
        let terrain = self.read(terrain)?;
        let place = [
            0.0,
            0.0,
            conditions.altitude.max(terrain.height(0.0, 0.0)) + 2.0,
        ];
        let lens = self.lens.tilted(self.pitch(place[2]));
        let camera = lens.camera(azimuth, ASPECT)?;
        let aerial = model.aerial_perspective(conditions)?;
        // The sky of the place, so that what is far away vanishes in it.
        let [lowest, highest] = model.altitude_range();
        let there = Conditions {
            altitude: place[2].clamp(lowest, highest),
            ..*conditions
        };
        let sky = model.sky(&there)?;
        Ok(Some(Landscape {
            difference: Difference::new(model, conditions, self.aerial_perspective)?,
            aerial,
            skylight: skylight(&sky)?,
            xyz: model.head().xyz.clone(),
            terrain,
            polariser: self.filter(model, &there, &camera)?,
            lens,
            camera,
            place,
            sky,
            disc: match has_disc {
                true => Some(Disc::new(model, &there)?),
                false => None,
            },
        }))
    }

    fn filter(
        &self,
        model: &Model,
        conditions: &Conditions,
        camera: &Camera,
    ) -> Result<Option<Polariser>> {
        let Some(angle) = self.polariser else {
            return Ok(None);
        };
        if !angle.is_finite() {
            return Err(Failure::message(
                "the angle of the polariser must be finite",
            ));
        }
        Ok(Some(Polariser {
            sky: model.polarised_sky(conditions)?,
            angle: angle.to_radians() as f32,
            frame: PolarisationFrame::Axis(camera.up()),
        }))
    }

    fn read(&self, terrain: &Path) -> Result<Terrain> {
        let wrong = |name: &str| {
            Err(Failure::message(format!(
                "the {name} of the terrain must be positive"
            )))
        };
        if !(self.terrain_width > 0.0 && self.terrain_width.is_finite()) {
            return wrong("width");
        }
        if self
            .terrain_height
            .is_some_and(|h| !(h > 0.0 && h <= 20_000.0))
        {
            return Err(Failure::message(
                "the height of the terrain must be in 0..=20000 m",
            ));
        }
        Ok(match terrain.to_str() {
            Some("flat") => Terrain::Flat,
            Some("hills") => Terrain::Hills(self.terrain_height.unwrap_or(3000.0)),
            _ => {
                let width = 1e3 * self.terrain_width;
                Terrain::Field(Field::read(terrain, width, self.terrain_height)?)
            }
        })
    }
}

impl Landscape<'_> {
    /// What the picture of a scene shows besides.
    pub fn describe(&self, options: &Options, about: &mut About) {
        let terrain = options.terrain.iter().map(|t| t.display().to_string());
        about.text("terrain", terrain.collect::<String>());
        // The camera may stand on a hill.
        about.altitude = Some(self.place[2]);
        self.lens.describe(about);
        if let Some(angle) = options.polariser {
            about.number("polariserDeg", angle);
        }
    }

    /// Linear sRGB of every pixel, cd m⁻².
    pub fn pixels(&self, size: [usize; 2]) -> Result<Vec<[f32; 3]>> {
        let [width, height] = size.map(|n| n as f64);
        let look = |[x, y]: [f64; 2]| self.camera.direction([x / width, y / height]);
        let pixels = edges::smooth(size, |place| {
            let (direction, distance) = (look(place), self.distance(look(place)));
            Ok(Seen {
                light: self.light(direction, distance)?,
                distance: distance.map_or(f32::INFINITY, |d| d as f32),
            })
        })?;
        let Some(disc) = &self.disc else {
            return Ok(pixels);
        };
        let is_open = |direction| self.distance(direction).is_none();
        parallel::pixels(size, |pixel| {
            let added = disc.rgb(pixel, &|place| Some(look(place)), is_open)?;
            let light = pixels[pixel[1] * size[0] + pixel[0]];
            Ok(std::array::from_fn(|c| light[c] + added[c]))
        })
    }

    /// Of the terrain in a direction, m.
    fn distance(&self, direction: [f64; 3]) -> Option<f64> {
        let radius = self.aerial.transmittance().planet().radius;
        self.terrain.hit(radius, self.place, direction)
    }

    /// From a direction in which the terrain is so far.
    fn light(&self, direction: [f64; 3], distance: Option<f64>) -> Result<[f32; 3]> {
        let radius = self.aerial.transmittance().planet().radius;
        let Some(distance) = distance else {
            return self.background(direction.map(|v| v as f32));
        };
        let point = std::array::from_fn(|k| self.place[k] + distance.min(FARTHEST) * direction[k]);
        let surface = self.surface(radius, point)?;
        let Some(polariser) = &self.polariser else {
            let (mut light, through) = self.air(point)?;
            if let Some(difference) = &self.difference {
                light = difference.light(&self.aerial, self.place, point)?;
            }
            return Ok(std::array::from_fn(|c| surface[c] * through[c] + light[c]));
        };
        let front = self.aerial.joined_to_polarised(&polariser.sky)?;
        let aerial = match front.camera() == self.place {
            true => front.linear_srgb_stokes(point, polariser.frame)?,
            false => self
                .aerial
                .linear_srgb_stokes(self.place, point, polariser.frame)?,
        };
        let (light, through) = (polariser.pass(&aerial.0), aerial.1);
        Ok(std::array::from_fn(|c| {
            HALF * surface[c] * through[c] + light[c]
        }))
    }

    /// Light that the air before a point adds, and what it leaves of that from there.
    fn air(&self, point: [f64; 3]) -> Result<([f32; 3], [f32; 3])> {
        let front = self.aerial.joined_to(&self.sky)?;
        Ok(match front.camera() == self.place {
            true => front.linear_srgb(point)?,
            // Higher than any sky of the model.
            false => self.aerial.linear_srgb(self.place, point)?,
        })
    }

    fn background(&self, direction: [f32; 3]) -> Result<[f32; 3]> {
        let Some(polariser) = &self.polariser else {
            return Ok(self.sky.linear_srgb(direction)?);
        };
        let light = polariser.sky.xyz(direction, polariser.frame)?;
        Ok(xyz_to_linear_srgb(polariser.pass(&light)))
    }

    /// Radiance that the surface sends out.
    fn surface(&self, radius: f64, point: [f64; 3]) -> Result<[f32; 3]> {
        let normal = self.terrain.normal(radius, point);
        let sun = self.aerial.sun_direction();
        let cosine = (0..3).map(|k| normal[k] * sun[k]).sum::<f64>().max(0.0);
        let direct = self.sunlight(radius, point, sun, cosine)?;
        let open = (0.5 + 0.5 * normal[2]) as f32;
        let cover = cover([point[0], point[1]], altitude(radius, point), normal[2]);
        let reflect = |c: usize| cover[c] / PI as f32 * (direct[c] + open * self.skylight[c]);
        Ok(std::array::from_fn(reflect))
    }

    /// Irradiance by the sun, linear sRGB; none in the shadow of the terrain.
    fn sunlight(
        &self,
        radius: f64,
        point: [f64; 3],
        sun: [f64; 3],
        cosine: f64,
    ) -> Result<[f32; 3]> {
        let raised = std::array::from_fn(|k| point[k] + if k == 2 { 3.0 } else { 0.0 });
        if cosine == 0.0 || self.terrain.hit(radius, raised, sun).is_some() {
            return Ok([0.0; 3]);
        }
        let mut through = vec![0.0; self.xyz.len()];
        self.aerial
            .transmittance()
            .transmittance_to_space(raised, sun, &mut through)?;
        let mut sum = [0.0; 3];
        for (weight, t) in self.xyz.iter().zip(through) {
            sum = std::array::from_fn(|c| sum[c] + weight[c] * f64::from(t) * cosine);
        }
        Ok(xyz_to_linear_srgb(sum.map(|v| v as f32)))
    }
}

impl Polariser {
    fn pass(&self, light: &[Stokes; 3]) -> [f32; 3] {
        light
            .each_ref()
            .map(|part| part.through_polariser(self.angle))
    }
}

/// What grows at a place: meadows on plains and above the trees, woods between, rock where it is steep, snow high up.
fn cover([x, y]: [f64; 2], altitude: f64, level: f64) -> [f32; 3] {
    let mix = |a: [f32; 3], b: [f32; 3], t: f64| -> [f32; 3] {
        let t = t.clamp(0.0, 1.0) as f32;
        std::array::from_fn(|c| a[c] + t * (b[c] - a[c]))
    };
    // Borders follow no contour line.
    let rough: f64 = [(900.0, 0.5), (210.0, 0.4), (47.0, 0.3), (13.0, 0.2)]
        .map(|(size, share)| share * noise(x / size, y / size))
        .iter()
        .sum();
    let (altitude, level) = (altitude + 250.0 * rough, level + 0.03 * rough);
    let is_wood = ((0.985 - level) / 0.01).min((1400.0 - altitude) / 60.0);
    let ground = mix(MEADOW, WOOD, is_wood);
    let ground = mix(
        ground,
        ROCK,
        ((0.82 - level) / 0.08).max((altitude - 1800.0) / 300.0),
    );
    mix(
        ground,
        SNOW,
        ((altitude - 2050.0) / 40.0).min((level - 0.75) / 0.04),
    )
}

/// Irradiance of a level plane by the sky.
fn skylight(sky: &Sky) -> Result<[f32; 3]> {
    const RINGS: usize = 12;
    const SPOKES: usize = 24;
    let mut sum = [0.0; 3];
    for ring in 0..RINGS {
        // Equal shares of sin² of the zenith angle: equal weights under a cosine.
        let sine = ((ring as f64 + 0.5) / RINGS as f64).sqrt();
        let z = (1.0 - sine * sine).sqrt();
        for spoke in 0..SPOKES {
            let (y, x) = (2.0 * PI * spoke as f64 / SPOKES as f64).sin_cos();
            let rgb = sky.linear_srgb([sine * x, sine * y, z].map(|v| v as f32))?;
            sum = std::array::from_fn(|c| sum[c] + rgb[c]);
        }
    }
    Ok(sum.map(|v| v * PI as f32 / (RINGS * SPOKES) as f32))
}
