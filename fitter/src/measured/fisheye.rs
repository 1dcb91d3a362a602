//! Fig. 7 of Wilkie et al. 2021 for every scan: fish-eyes of what was measured, of the model, and of their difference.
//! North is up and east is left, as for somebody who lies on the back; every place has the colour of the nearest sample.

use super::false_colour::rainbow;
use super::fit::Fitted;
use super::model_sky::{between, direction};
use super::scan::Scan;
use anyhow::Result;

/// Pixels of a fish-eye and of the space around it.
const SIZE: usize = 240;
const SPACE: usize = 8;
/// From the darkest to the brightest colour, as a factor.
const CONTRAST: f64 = 30.0;
/// Of the colours of the difference: half as bright as the model to twice.
const OFF: f64 = std::f64::consts::LN_2;

/// A picture of rows and columns of pixels.
pub struct Sheet {
    width: usize,
    pixels: Vec<[u8; 3]>,
}

impl Sheet {
    /// One row per scan: measured, fitted, and the logarithm of measured over fitted. `measured` is by wavelength and
    /// sample. The brightness is the mean over the wavelengths; samples that were left out stay black in the third.
    pub fn new(rows: &[(&Scan, &[Vec<f64>], &Fitted)]) -> Self {
        let step = SIZE + SPACE;
        let width = 3 * step + SPACE;
        let mut sheet = Self {
            width,
            pixels: vec![[255; 3]; width * (rows.len() * step + SPACE)],
        };
        for (row, (scan, measured, fitted)) in rows.iter().enumerate() {
            for (column, colours) in colours(scan, measured, fitted).iter().enumerate() {
                let corner = [SPACE + column * step, SPACE + row * step];
                sheet.draw(corner, scan, fitted.north, colours);
            }
        }
        sheet
    }

    fn draw(&mut self, corner: [usize; 2], scan: &Scan, north: f64, colours: &[[u8; 3]]) {
        let places: Vec<[f32; 3]> = scan
            .samples
            .iter()
            .map(|s| direction(s.elevation, s.azimuth + north))
            .collect();
        let half = 0.5 * SIZE as f64;
        for i in 0..SIZE * SIZE {
            let (x, y) = (i % SIZE, i / SIZE);
            let west = (x as f64 + 0.5 - half) / half;
            let up = (half - y as f64 - 0.5) / half;
            let from_zenith = west.hypot(up);
            if from_zenith > 1.0 {
                continue;
            }
            let elevation = std::f64::consts::FRAC_PI_2 * (1.0 - from_zenith);
            let here = direction(elevation, up.atan2(-west));
            let apart = |i: &usize| between(here, places[*i]);
            let nearest = (0..places.len()).min_by(|a, b| apart(a).total_cmp(&apart(b)));
            if let Some(sample) = nearest {
                self.pixels[(corner[1] + y) * self.width + corner[0] + x] = colours[sample];
            }
        }
    }

    /// As PNG.
    pub fn png(&self) -> Result<Vec<u8>> {
        let mut bytes = Vec::new();
        let height = self.pixels.len() / self.width;
        let mut encoder = png::Encoder::new(&mut bytes, self.width as u32, height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(self.pixels.as_flattened())?;
        writer.finish()?;
        Ok(bytes)
    }
}

fn colours(scan: &Scan, measured: &[Vec<f64>], fitted: &Fitted) -> [Vec<[u8; 3]>; 3] {
    let count = measured.len().max(1) as f64;
    let samples = 0..scan.samples.len();
    let seen: Vec<f64> = samples
        .clone()
        .map(|i| measured.iter().map(|band| band[i]).sum::<f64>() / count)
        .collect();
    let mean = |row: &Vec<f64>| row.iter().sum::<f64>() / count;
    let model: Vec<f64> = fitted.radiance.iter().map(mean).collect();
    let brightest = model.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let tone = |v: &f64| rainbow(1.0 + (v / brightest).max(1e-9).ln() / CONTRAST.ln());
    let off = |i: usize| {
        let errors: Vec<f64> = fitted
            .residuals
            .iter()
            .filter(|r| r.sample == i)
            .map(|r| r.error)
            .collect();
        match errors.is_empty() {
            true => [0; 3],
            false => {
                let mean = errors.iter().sum::<f64>() / errors.len() as f64;
                rainbow(0.5 + 0.5 * mean / OFF)
            }
        }
    };
    [
        seen.iter().map(tone).collect(),
        model.iter().map(tone).collect(),
        samples.map(off).collect(),
    ]
}
