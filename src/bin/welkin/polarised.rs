//! Pictures of polarisation: false colours, and Stokes layers for the EXR.

use std::f32::consts::PI;

use welkin::{ColourSpace, PolarisationFrame, PolarisedSky, Stokes, xyz_to_linear_srgb};

use crate::about::About;
use crate::image::Planes;
use crate::parallel;
use crate::view::View;

/// What a picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Quantity {
    /// The sky itself.
    Radiance,
    /// Degree of linear polarisation: black 0, purple, orange, pale yellow 1.
    Dolp,
    /// The sky in grey, red where it is polarised.
    Overlay,
    /// Angle of polarisation: hue red at 0°, green at 60°, blue at 120°; dark where there is little.
    Aolp,
    /// Q/I: green where positive, red where negative; black up to 0.001, a third of full colour more for each factor of
    /// ten, full at 1.
    Q,
    /// U/I in the same colours.
    U,
}

/// Axes that q, u and aolp count from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Axes {
    /// Perpendicular to the plane of view direction and sun.
    Sun,
    /// Vertical.
    Vertical,
}

impl Axes {
    fn frame(self) -> PolarisationFrame {
        match self {
            Axes::Sun => PolarisationFrame::SunAligned,
            Axes::Vertical => PolarisationFrame::Vertical,
        }
    }
}

/// What a false-colour picture is made of.
pub struct Colouring {
    pub quantity: Quantity,
    pub axes: Axes,
    /// nm; the luminance if absent.
    pub wavelength: Option<f64>,
}

impl Colouring {
    /// The light of every pixel; `None` outside the fish-eye.
    pub fn light(&self, view: &View, sky: &PolarisedSky) -> welkin::Result<Vec<Option<Stokes>>> {
        let frame = self.axes.frame();
        let stokes = |direction| match self.wavelength {
            Some(wavelength) => sky.stokes_at(direction, frame, wavelength),
            None => Ok(sky.xyz(direction, frame)?[1]),
        };
        let pixel = |pixel| view.direction(pixel).map(stokes).transpose();
        parallel::pixels(view.size, pixel)
    }

    /// The quantity as a plane of numbers; angles in degrees.
    pub fn plane(&self, size: [usize; 2], light: &[Option<Stokes>], mut about: About) -> Planes {
        let (name, units, comment): (_, _, &'static str) = match self.quantity {
            Quantity::Aolp => ("aolp", "deg", "angle of linear polarisation, degrees"),
            Quantity::Q => ("q", "1", "Q/I"),
            Quantity::U => ("u", "1", "U/I"),
            _ => ("dolp", "1", "degree of linear polarisation"),
        };
        match self.wavelength {
            Some(wavelength) => about.number("wavelengthNm", wavelength),
            None => about.text("wavelengthNm", "luminance"),
        }
        about.text(
            "polarisationAxes",
            match self.axes {
                Axes::Sun => "sun",
                Axes::Vertical => "vertical",
            },
        );
        let number = |stokes: &Option<Stokes>| stokes.map_or(0.0, |s| self.number(&s));
        Planes {
            size,
            planes: vec![(name.to_owned(), light.iter().map(number).collect())],
            about,
            units,
            space: ColourSpace::Srgb,
            comment,
        }
    }

    fn number(&self, light: &Stokes) -> f32 {
        match self.quantity {
            Quantity::Aolp => light.angle().to_degrees(),
            Quantity::Q => light.signed_degree(),
            Quantity::U => light.turned(PI / 4.0).signed_degree(),
            _ => light.degree(),
        }
    }

    /// sRGB pixels; `white` is the luminance of display white.
    pub fn pixels(&self, light: &[Option<Stokes>], white: f32) -> Vec<[u8; 3]> {
        let pixel = |stokes: &Option<Stokes>| stokes.map_or([0; 3], |s| self.colour(&s, white));
        light.iter().map(pixel).collect()
    }

    fn colour(&self, light: &Stokes, white: f32) -> [u8; 3] {
        let rgb = match self.quantity {
            Quantity::Dolp => sequential(light.degree()),
            Quantity::Overlay => overlay(light, white),
            Quantity::Aolp => hue(light.angle() / PI).map(|v| v * light.degree().sqrt()),
            _ => diverging(self.number(light)),
        };
        rgb.map(|v| (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u8)
    }
}

/// Colours of increasing lightness for 0..=1.
fn sequential(x: f32) -> [f32; 3] {
    const STOPS: [[f32; 3]; 6] = [
        [0.0, 0.0, 0.02],
        [0.25, 0.05, 0.42],
        [0.58, 0.15, 0.40],
        [0.87, 0.31, 0.22],
        [0.98, 0.62, 0.12],
        [0.98, 0.99, 0.66],
    ];
    let u = x.clamp(0.0, 1.0) * 5.0;
    let i = (u as usize).min(4);
    let t = u - i as f32;
    core::array::from_fn(|c| STOPS[i][c] + t * (STOPS[i + 1][c] - STOPS[i][c]))
}

/// Green for positive, red for negative numbers in −1..=1, black near 0. Logarithms show what is near the neutral
/// points.
fn diverging(x: f32) -> [f32; 3] {
    let strength = (1.0 + x.abs().log10() / 3.0).clamp(0.0, 1.0);
    if x > 0.0 {
        [0.15 * strength, strength, 0.3 * strength]
    } else {
        [strength, 0.2 * strength, 0.15 * strength]
    }
}

/// A saturated colour; `turn` counts whole turns from red over green and blue.
fn hue(turn: f32) -> [f32; 3] {
    let component = |offset: f32| {
        let x = (turn + offset).rem_euclid(1.0) * 6.0;
        ((x - 3.0).abs() - 1.0).clamp(0.0, 1.0)
    };
    [component(0.0), component(2.0 / 3.0), component(1.0 / 3.0)]
}

/// Grey of the luminance, with the polarised part in red.
fn overlay(light: &Stokes, white: f32) -> [f32; 3] {
    let grey = 1.0 - (-1.3 * (light.i / white).max(0.0)).exp();
    let grey = grey.powf(1.0 / 2.2);
    let rest = 1.0 - light.degree();
    [grey, grey * rest, grey * rest]
}

/// Attributes of pictures with Stokes layers: right-handed about the direction in which the light travels, as renderers
/// with polarisation have it.
pub const ATTRIBUTES: [(&str, &str); 2] = [
    ("polarisationHandedness", "right"),
    (
        "stokesReference",
        "S1: along the right of the camera less along its up, both seen perpendicular to the ray; S2: up to the right less down to the right; S3 = 0",
    ),
];

/// S0, S1 and S2 in the frame of [`ATTRIBUTES`] from a Stokes vector whose `e1` is the up vector of the camera.
fn components(light: &Stokes) -> [f32; 3] {
    [light.i, -light.q, light.u]
}

/// Planes `S0.R` … `S3.B` of linear sRGB.
pub fn colour_layers(view: &View, sky: &PolarisedSky) -> welkin::Result<Vec<(String, Vec<f32>)>> {
    let frame = PolarisationFrame::Axis(view.up());
    let pixel = |pixel, _: &mut (), out: &mut [f32]| {
        let xyz = match view.direction(pixel) {
            Some(direction) => sky.xyz(direction, frame)?.map(|s| components(&s)),
            None => [[0.0; 3]; 3],
        };
        for (s, out) in out.chunks_exact_mut(3).enumerate() {
            let of = |c: usize| if s < 3 { xyz[c][s] } else { 0.0 };
            out.copy_from_slice(&xyz_to_linear_srgb([of(0), of(1), of(2)]));
        }
        Ok(())
    };
    let layers = parallel::planes(view.size, 12, || (), pixel)?;
    let name = |i: usize| format!("S{}.{}", i / 3, ["R", "G", "B"][i % 3]);
    Ok((0..12).map(name).zip(layers).collect())
}

/// Planes of S0 … S3 at every wavelength, W m⁻² sr⁻¹ nm⁻¹; `name` makes the names.
pub fn spectral_layers(
    view: &View,
    sky: &PolarisedSky,
    name: impl Fn(usize, f64) -> String,
) -> welkin::Result<Vec<(String, Vec<f32>)>> {
    let frame = PolarisationFrame::Axis(view.up());
    let wavelengths = sky.sky().wavelengths();
    let n = wavelengths.len();
    let pixel = |pixel, light: &mut Vec<Stokes>, out: &mut [f32]| {
        light.fill(Stokes::default());
        if let Some(direction) = view.direction(pixel) {
            sky.stokes(direction, frame, light)?;
        }
        for (w, light) in light.iter().enumerate() {
            let [i, q, u] = components(light);
            for (s, value) in [i, q, u, 0.0].into_iter().enumerate() {
                out[s * n + w] = value;
            }
        }
        Ok(())
    };
    let scratch = || vec![Stokes::default(); n];
    let layers = parallel::planes(view.size, 4 * n, scratch, pixel)?;
    let name = |i: usize| name(i / n, wavelengths[i % n]);
    Ok((0..4 * n).map(name).zip(layers).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_stay_in_range_and_angles_half_a_turn_apart_are_equal() {
        for k in -20..=40 {
            let x = k as f32 * 0.05;
            for rgb in [sequential(x), hue(x), diverging(x.clamp(-1.0, 1.0))] {
                assert!(rgb.iter().all(|v| (0.0..=1.0).contains(v)), "{x} {rgb:?}");
            }
        }
        let colouring = Colouring {
            quantity: Quantity::Aolp,
            axes: Axes::Sun,
            wavelength: None,
        };
        let (i, q) = (1.0, -0.64);
        let half_a_turn = [1e-9, -1e-9].map(|u| Some(Stokes { i, q, u }));
        let pixels = colouring.pixels(&half_a_turn, 1.0);
        assert_eq!(pixels, [[0, 204, 204]; 2]);
    }

    #[test]
    fn signs_have_colours_that_can_be_read() {
        assert_eq!(diverging(0.0), [0.0; 3]);
        let greens = [0.001, 0.01, 0.1, 1.0].map(|x| (3.0 * diverging(x)[1]).round());
        assert_eq!(greens, [0.0, 1.0, 2.0, 3.0]);
        let [r, g, _] = diverging(-0.03);
        assert!(r > 0.45 && g < 0.15);
    }

    #[test]
    fn u_is_q_of_axes_turned_by_45_degrees() {
        let colouring = Colouring {
            quantity: Quantity::U,
            axes: Axes::Sun,
            wavelength: None,
        };
        let light = Stokes {
            i: 2.0,
            q: 0.3,
            u: -0.5,
        };
        assert!((colouring.number(&light) + 0.25).abs() < 1e-6);
    }
}
