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
}

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
            let mut rgb = sky.linear_srgb(direction)?;
            if let Some(ground) = &self.ground {
                ground.add_srgb(direction, &mut rgb)?;
            }
            if let Some(disc) = &self.disc {
                let added = disc.rgb(pixel, &self.look(), |_| true)?;
                rgb = std::array::from_fn(|c| rgb[c] + added[c]);
            }
            Ok(rgb)
        })
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
        let pixel = |pixel, _: &mut (), out: &mut [f32]| {
            let Some(direction) = self.direction(pixel) else {
                out.fill(0.0);
                return Ok(());
            };
            sky.radiance(direction, out)?;
            if let Some(ground) = &self.ground {
                ground.add(direction, out)?;
            }
            match &self.disc {
                Some(disc) => disc.add(pixel, &self.look(), out),
                None => Ok(()),
            }
        };
        parallel::planes(self.size, count, || (), pixel)
    }
}
