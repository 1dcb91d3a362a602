//! Fish-eyes of every model, sun by sun, each sun in one exposure for all.

use welkin::xyz_to_linear_srgb;

use super::entry::Entry;
use super::quantities::quantile;
use super::{Result, SUNS, table};
use crate::peers::sky::{Observer, SkyModel};

/// Width and height of one sky.
const SIZE: usize = 160;
/// Pixels between two.
const GAP: usize = 8;
/// Share of the sky of this model that is darker than white.
const WHITE: f64 = 0.95;

/// sRGB of light: a curve that bends towards white, as film does.
fn display(rgb: [f32; 3], white: f32) -> [u8; 3] {
    rgb.map(|v| {
        let v = 1.0 - (-1.6 * v.max(0.0) / white).exp();
        let encoded = match v <= 0.003_130_8 {
            true => 12.92 * v,
            false => 1.055 * v.powf(1.0 / 2.4) - 0.055,
        };
        (encoded.min(1.0) * 255.0 + 0.5) as u8
    })
}

/// Where a pixel looks: up, the sun towards the top, the horizon at the edge.
fn direction(i: usize) -> Option<[f32; 3]> {
    let place = |i: usize| (2.0 * i as f32 + 1.0) / SIZE as f32 - 1.0;
    let [right, down] = [place(i % SIZE), place(i / SIZE)];
    let radius = right.hypot(down);
    if radius > 1.0 {
        return None;
    }
    let (r, z) = (radius * std::f32::consts::FRAC_PI_2).sin_cos();
    let [x, y] = [-down, -right].map(|v| r * v / radius.max(1e-6));
    Some([x, y, z.max(1e-4)])
}

/// Light of a sky at all pixels that look at it; black where there is none.
fn sky(model: &dyn SkyModel, sun: f64) -> Vec<Option<[f32; 3]>> {
    let sky = model.sky(Observer::on_the_ground(sun.to_radians()));
    let pixel = |i| {
        let xyz = direction(i).map(|d| sky.as_ref().and_then(|sky| sky.xyz(d)));
        xyz.map(Option::unwrap_or_default)
    };
    (0..SIZE * SIZE).map(pixel).collect()
}

/// Writes a strip per model that was run; those of others stay.
///
/// # Errors
/// Where a picture cannot be written.
pub fn write(models: &[Entry]) -> Result<()> {
    let first = models.first().ok_or("no models")?;
    let white = SUNS.map(|sun| {
        let light = sky(first.model.as_ref(), sun);
        let mut light: Vec<_> = light
            .iter()
            .flatten()
            .map(|xyz| (f64::from(xyz[1]), 1.0))
            .collect();
        quantile(&mut light, WHITE) as f32
    });
    for entry in models.iter().filter(|entry| entry.was_run()) {
        let png = strip(entry.model.as_ref(), &white)?;
        table::write(&format!("{}.png", entry.key), &png)?;
    }
    Ok(())
}

fn strip(model: &dyn SkyModel, white: &[f32]) -> Result<Vec<u8>> {
    let width = SUNS.len() * (SIZE + GAP) - GAP;
    let mut image = vec![0u8; width * SIZE * 4];
    for (n, (sun, white)) in SUNS.into_iter().zip(white).enumerate() {
        for (i, xyz) in sky(model, sun).into_iter().enumerate() {
            let Some(xyz) = xyz else { continue };
            let [r, g, b] = display(xyz_to_linear_srgb(xyz), *white);
            let at = i / SIZE * width + n * (SIZE + GAP) + i % SIZE;
            image[4 * at..][..4].copy_from_slice(&[r, g, b, 255]);
        }
    }
    let mut file = vec![];
    let mut encoder = png::Encoder::new(&mut file, u32::try_from(width)?, SIZE as u32);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.write_header()?.write_image_data(&image)?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sun_is_above_the_middle() {
        let middle = direction(SIZE / 2 * SIZE + SIZE / 2).unwrap();
        assert!(middle[2] > 0.999);
        let [x, y, z] = direction(SIZE / 4 * SIZE + SIZE / 2).unwrap();
        assert!(x > 0.6 && y.abs() < 0.02 && z > 0.6, "{x} {y} {z}");
        assert!(direction(0).is_none());
    }
}
