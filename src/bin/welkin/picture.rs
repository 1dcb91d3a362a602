//! Pictures of skies, encoded.

use welkin::{BandSky, ColourSpace, PolarisedSky, Sky};

use crate::about::{About, BAND_RADIANCE, LUMINANCE, RADIANCE};
use crate::encoding::Encoding;
use crate::failure::Result;
use crate::image::{Planes, exr, png, png_of_display};
use crate::polarised::{self, Colouring};
use crate::sensor::Sensor;
use crate::tone::Film;
use crate::view::View;

/// Of files with one channel per wavelength.
const SPECTRUM: [(&str, &str); 2] = [
    ("spectralLayoutVersion", "1.0"),
    ("emissiveUnits", RADIANCE),
];
const SPECTRAL_RADIANCE: &str = "spectral radiance, W m^-2 sr^-1 nm^-1";

/// Which encodings are asked for, and what is the same in all of them.
pub struct Wanted {
    pub exr: bool,
    pub png: bool,
    pub film: Film,
    pub about: About,
    pub encoding: Encoding,
}

/// An encoded picture, as far as it is wanted.
pub struct Picture {
    pub exr: Option<Vec<u8>>,
    pub png: Option<Vec<u8>>,
}

impl Picture {
    /// The sky itself, with Stokes layers if it is `polarised`.
    pub fn of_sky(
        view: &View,
        sky: &Sky,
        polarised: Option<&PolarisedSky>,
        spectral: bool,
        wanted: &Wanted,
    ) -> Result<Self> {
        // A spectral EXR alone needs none.
        let pixels = match wanted.png || !spectral {
            true => view.rgb(sky)?,
            false => Vec::new(),
        };
        Self::encoded(
            wanted,
            || {
                let planes = planes(view, sky, polarised, spectral, &pixels, wanted)?;
                exr(planes, &wanted.encoding)
            },
            || png(view.size, &pixels, &wanted.film, &wanted.about),
        )
    }

    /// The sky in the bands of a sensor, beside its colours as PNG.
    pub fn of_bands(
        view: &View,
        sky: &Sky,
        (sensor, bands): (&Sensor, &BandSky),
        wanted: &Wanted,
    ) -> Result<Self> {
        let pixels = match wanted.png {
            true => view.rgb(sky)?,
            false => Vec::new(),
        };
        let planes = || {
            let values = view.bands(bands)?;
            let (names, about) = (sensor.names.clone(), wanted.about.clone());
            let planes = match &sensor.wavelengths {
                Some(wavelengths) => Planes {
                    size: view.size,
                    planes: wavelengths
                        .iter()
                        .map(|&l| channel_name(0, l))
                        .zip(values)
                        .collect(),
                    about: about.with(&SPECTRUM),
                    units: RADIANCE,
                    space: ColourSpace::Srgb,
                    comment: SPECTRAL_RADIANCE,
                },
                None => Planes {
                    size: view.size,
                    planes: names.into_iter().zip(values).collect(),
                    about,
                    units: BAND_RADIANCE,
                    space: ColourSpace::Srgb,
                    comment: "integrals of response times spectral radiance, W m^-2 sr^-1",
                },
            };
            exr(planes, &wanted.encoding)
        };
        Self::encoded(wanted, planes, || {
            png(view.size, &pixels, &wanted.film, &wanted.about)
        })
    }

    /// Both encodings at the same time.
    fn encoded(
        wanted: &Wanted,
        exr: impl FnOnce() -> Result<Vec<u8>> + Send,
        png: impl FnOnce() -> Result<Vec<u8>> + Send,
    ) -> Result<Self> {
        let (exr, png) = rayon::join(
            || wanted.exr.then(exr).transpose(),
            || wanted.png.then(png).transpose(),
        );
        Ok(Self {
            exr: exr?,
            png: png?,
        })
    }

    /// Finished pixels: linear sRGB, cd m⁻².
    pub fn of_pixels(size: [usize; 2], pixels: &[[f32; 3]], wanted: &Wanted) -> Result<Self> {
        let channel = |c: usize| pixels.iter().map(|p| p[c]).collect();
        let encode_exr = || {
            let planes = Planes {
                size,
                planes: ["R", "G", "B"]
                    .iter()
                    .zip(0..)
                    .map(|(n, c)| ((*n).to_owned(), channel(c)))
                    .collect(),
                about: wanted.about.clone(),
                units: LUMINANCE,
                space: ColourSpace::Srgb,
                comment: wanted.encoding.comment(),
            };
            exr(planes, &wanted.encoding)
        };
        Self::encoded(wanted, encode_exr, || {
            png(size, pixels, &wanted.film, &wanted.about)
        })
    }

    /// Its polarisation in false colours.
    pub fn of_polarisation(
        view: &View,
        sky: &PolarisedSky,
        colouring: &Colouring,
        wanted: &Wanted,
    ) -> Result<Self> {
        let light = colouring.light(view, sky)?;
        Self::encoded(
            wanted,
            || {
                let plane = colouring.plane(view.size, &light, wanted.about.clone());
                exr(plane, &wanted.encoding)
            },
            || {
                png_of_display(
                    view.size,
                    &colouring.pixels(&light, wanted.film.white),
                    &wanted.about,
                )
            },
        )
    }
}

fn planes(
    view: &View,
    sky: &Sky,
    polarised: Option<&PolarisedSky>,
    spectral: bool,
    pixels: &[[f32; 3]],
    wanted: &Wanted,
) -> Result<Planes> {
    let mut about = wanted.about.clone();
    if spectral {
        about = about.with(&SPECTRUM);
    }
    if polarised.is_some() {
        about = about.with(&polarised::ATTRIBUTES);
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
    let (units, comment) = match spectral {
        true => (RADIANCE, SPECTRAL_RADIANCE),
        false => (LUMINANCE, wanted.encoding.comment()),
    };
    Ok(Planes {
        size: view.size,
        planes,
        about,
        units,
        space: ColourSpace::Srgb,
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
