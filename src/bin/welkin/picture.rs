//! Pictures of skies, encoded.

use welkin::{PolarisedSky, Sky};

use crate::failure::Result;
use crate::ground::Ground;
use crate::image::{Planes, exr, png, png_of_display};
use crate::polarised::{self, Colouring};
use crate::projection::Projection;

/// Which encodings are asked for.
#[derive(Clone, Copy)]
pub struct Wanted {
    pub exr: bool,
    pub png: bool,
}

/// An encoded picture, as far as it is wanted.
pub struct Picture {
    pub exr: Option<Vec<u8>>,
    pub png: Option<Vec<u8>>,
}

impl Picture {
    /// The sky itself, with Stokes layers if it is `polarised`; `white` is the luminance of display white.
    pub fn of_sky(
        view: &View,
        sky: &Sky,
        polarised: Option<&PolarisedSky>,
        spectral: bool,
        white: f32,
        wanted: Wanted,
    ) -> Result<Self> {
        let pixels = view.rgb(sky)?;
        let encode_exr = || exr(planes(view, sky, polarised, spectral, &pixels)?);
        let encode_png = || png(view.size, &pixels, white);
        Ok(Self {
            exr: wanted.exr.then(encode_exr).transpose()?,
            png: wanted.png.then(encode_png).transpose()?,
        })
    }

    /// Finished pixels: linear sRGB, cd m⁻².
    pub fn of_pixels(
        size: [usize; 2],
        pixels: &[[f32; 3]],
        white: f32,
        wanted: Wanted,
    ) -> Result<Self> {
        let channel = |c: usize| pixels.iter().map(|p| p[c]).collect();
        let encode_exr = || {
            exr(Planes {
                size,
                planes: ["R", "G", "B"]
                    .iter()
                    .zip(0..)
                    .map(|(n, c)| ((*n).to_owned(), channel(c)))
                    .collect(),
                attributes: Vec::new(),
                comment: "linear sRGB, cd m^-2",
            })
        };
        let encode_png = || png(size, pixels, white);
        Ok(Self {
            exr: wanted.exr.then(encode_exr).transpose()?,
            png: wanted.png.then(encode_png).transpose()?,
        })
    }

    /// Its polarisation in false colours.
    pub fn of_polarisation(
        view: &View,
        sky: &PolarisedSky,
        colouring: &Colouring,
        white: f32,
        wanted: Wanted,
    ) -> Result<Self> {
        let light = colouring.light(view, sky)?;
        let encode_exr = || exr(colouring.plane(view.size, &light));
        let encode_png = || png_of_display(view.size, &colouring.pixels(&light, white));
        Ok(Self {
            exr: wanted.exr.then(encode_exr).transpose()?,
            png: wanted.png.then(encode_png).transpose()?,
        })
    }
}

/// The pixels of a picture.
pub struct View {
    pub projection: Projection,
    pub size: [usize; 2],
    /// Azimuth of the view, rad.
    pub azimuth: f64,
    /// What is below the horizon; black if absent.
    pub ground: Option<Ground>,
}

impl View {
    /// Up vector of the camera.
    pub fn up(&self) -> [f32; 3] {
        self.projection.up(self.azimuth)
    }

    /// Row by row; `None` outside the fish-eye.
    pub fn directions(&self) -> impl Iterator<Item = Option<[f32; 3]>> + '_ {
        let [width, height] = self.size;
        let pixels = (0..height).flat_map(move |row| (0..width).map(move |column| [column, row]));
        pixels.map(|pixel| self.projection.direction(pixel, self.size, self.azimuth))
    }

    /// Linear sRGB, cd m⁻²; black outside the fish-eye.
    pub fn rgb(&self, sky: &Sky) -> welkin::Result<Vec<[f32; 3]>> {
        let pixel = |direction: Option<[f32; 3]>| {
            let Some(direction) = direction else {
                return Ok([0.0; 3]);
            };
            let mut rgb = sky.linear_srgb(direction)?;
            if let Some(ground) = &self.ground {
                ground.add_srgb(direction, &mut rgb)?;
            }
            Ok(rgb)
        };
        self.directions().map(pixel).collect()
    }

    fn spectral(&self, sky: &Sky) -> welkin::Result<Vec<Vec<f32>>> {
        let count = self.size[0] * self.size[1];
        let mut planes = vec![vec![0.0; count]; sky.wavelengths().len()];
        let mut radiance = vec![0.0; planes.len()];
        for (i, direction) in self.directions().enumerate() {
            if let Some(direction) = direction {
                sky.radiance(direction, &mut radiance)?;
                if let Some(ground) = &self.ground {
                    ground.add(direction, &mut radiance)?;
                }
                planes
                    .iter_mut()
                    .zip(&radiance)
                    .for_each(|(p, &l)| p[i] = l);
            }
        }
        Ok(planes)
    }
}

fn planes(
    view: &View,
    sky: &Sky,
    polarised: Option<&PolarisedSky>,
    spectral: bool,
    pixels: &[[f32; 3]],
) -> Result<Planes> {
    let mut attributes = Vec::new();
    if spectral {
        attributes.push(("spectralLayoutVersion", "1.0"));
        attributes.push(("emissiveUnits", "W.m^-2.sr^-1.nm^-1"));
    }
    if polarised.is_some() {
        attributes.extend(polarised::ATTRIBUTES);
    }
    let planes = match (spectral, polarised) {
        (true, Some(sky)) => polarised::spectral_layers(view, sky, channel_name)?,
        (true, None) => {
            let names = sky.wavelengths().iter().map(|&l| channel_name(0, l));
            names.zip(view.spectral(sky)?).collect()
        }
        (false, polarised) => {
            let plane = |i: usize| pixels.iter().map(|p| p[i]).collect();
            let names = ["R", "G", "B"].into_iter().enumerate();
            let mut planes: Vec<_> = names.map(|(i, n)| (n.to_owned(), plane(i))).collect();
            if let Some(sky) = polarised {
                planes.extend(polarised::colour_layers(view, sky)?);
            }
            planes
        }
    };
    let comment = match spectral {
        true => "spectral radiance, W m^-2 sr^-1 nm^-1",
        false => "linear sRGB, cd m^-2",
    };
    Ok(Planes {
        size: view.size,
        planes,
        attributes,
        comment,
    })
}

/// A dot would separate layers, so the decimal mark is a comma.
fn channel_name(component: usize, wavelength: f64) -> String {
    format!(
        "S{component}.{}nm",
        wavelength.to_string().replace('.', ",")
    )
}
