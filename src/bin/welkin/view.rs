//! What a picture of the sky looks at.

use welkin::{BandSky, Sky};

use crate::disc::{Disc, Look};
use crate::ground::Ground;
use crate::parallel;
use crate::projection::Projection;

/// The pixels of a picture.
pub struct View {
    pub projection: Projection,
    pub size: [usize; 2],
    /// Azimuth of the view, rad.
    pub azimuth: f64,
    /// What is below the horizon; black if absent.
    pub ground: Option<Ground>,
    /// The sun's disc; none if absent.
    pub disc: Option<Disc>,
    /// What the moon adds.
    pub moon: Option<Moonlight>,
}

/// The sky in the light of the moon, the ground under it, and the moon's disc.
pub struct Moonlight {
    pub sky: Sky,
    pub ground: Option<Ground>,
    pub disc: Option<Disc>,
}

/// What one light makes.
type Light<'a> = (&'a Sky, Option<&'a Ground>, Option<&'a Disc>);

impl View {
    /// Up vector of the camera.
    pub fn up(&self) -> [f32; 3] {
        self.projection.up(self.azimuth)
    }

    /// Of the pixel in a column and a row; `None` outside the fish-eye.
    pub fn direction(&self, pixel: [usize; 2]) -> Option<[f32; 3]> {
        self.projection.direction(pixel, self.size, self.azimuth)
    }

    fn look(&self) -> impl Look {
        |place| self.projection.look(place, self.size, self.azimuth)
    }

    /// Linear sRGB, cd m⁻²; black outside the fish-eye.
    pub fn rgb(&self, sky: &Sky) -> welkin::Result<Vec<[f32; 3]>> {
        parallel::pixels(self.size, |pixel| {
            let Some(direction) = self.direction(pixel) else {
                return Ok([0.0; 3]);
            };
            let mut rgb = [0.0; 3];
            for (sky, ground, disc) in self.lights(sky) {
                let mut light = sky.linear_srgb(direction)?;
                if let Some(ground) = ground {
                    ground.add_srgb(direction, &mut light)?;
                }
                if let Some(disc) = disc {
                    let added = disc.rgb(pixel, &self.look(), |_| true)?;
                    light = std::array::from_fn(|c| light[c] + added[c]);
                }
                rgb = std::array::from_fn(|c| rgb[c] + light[c]);
            }
            Ok(rgb)
        })
    }

    /// The first light, and the moon's.
    fn lights<'a>(&'a self, sky: &'a Sky) -> impl Iterator<Item = Light<'a>> {
        let first = (sky, self.ground.as_ref(), self.disc.as_ref());
        let moon = self.moon.iter();
        std::iter::once(first).chain(moon.map(|m| (&m.sky, m.ground.as_ref(), m.disc.as_ref())))
    }

    /// CIE XYZ of the sky towards a direction, with what the moon adds.
    pub fn xyz(&self, sky: &Sky, direction: [f32; 3]) -> welkin::Result<[f32; 3]> {
        let mut sum = sky.xyz(direction)?;
        if let Some(moon) = &self.moon {
            let added = moon.sky.xyz(direction)?;
            sum = std::array::from_fn(|c| sum[c] + added[c]);
        }
        Ok(sum)
    }

    /// Planes of the bands of a sensor; black outside the fish-eye.
    pub fn bands(&self, sky: &BandSky) -> welkin::Result<Vec<Vec<f32>>> {
        let pixel = |pixel, _: &mut (), out: &mut [f32]| match self.direction(pixel) {
            Some(direction) => sky.radiance(direction, out),
            None => {
                out.fill(0.0);
                Ok(())
            }
        };
        parallel::planes(self.size, sky.bands(), || (), pixel)
    }

    /// Planes of spectral radiance, W m⁻² sr⁻¹ nm⁻¹.
    pub fn spectral(&self, sky: &Sky) -> welkin::Result<Vec<Vec<f32>>> {
        let count = sky.wavelengths().len();
        let pixel = |pixel, light: &mut Vec<f32>, out: &mut [f32]| {
            out.fill(0.0);
            let Some(direction) = self.direction(pixel) else {
                return Ok(());
            };
            for (sky, ground, disc) in self.lights(sky) {
                sky.radiance(direction, light)?;
                if let Some(ground) = ground {
                    ground.add(direction, light)?;
                }
                if let Some(disc) = disc {
                    disc.add(pixel, &self.look(), light)?;
                }
                let pairs = out.iter_mut().zip(&*light);
                pairs.for_each(|(sum, value)| *sum += value);
            }
            Ok(())
        };
        parallel::planes(self.size, count, || vec![0.0; count], pixel)
    }
}
