//! Pictures beside each other: `beside COLUMNS WIDTHxHEIGHT+X+Y OUT.png A.exr B.exr C.exr D.exr …` cuts a rectangle
//! out of each and puts B to the right of A, D to the right of C. Both of a pair have the exposure of the first and one
//! tone curve, so that they differ where light does.

use std::error::Error;
use std::path::Path;

use exr::prelude::read_first_rgba_layer_from_file;
use welkin::output::replace_file;

/// Pixels between pairs.
const GAP: usize = 4;
/// Share of the pixels that are darker than white.
const WHITE: f32 = 0.95;

/// Linear light, row by row.
struct Picture {
    width: usize,
    pixels: Vec<[f32; 3]>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [columns, part, out, files @ ..] = args.as_slice() else {
        return Err("usage: beside COLUMNS WIDTHxHEIGHT+X+Y OUT.png A.exr B.exr …".into());
    };
    let numbers = part.split(['x', '+']).map(str::parse);
    let numbers: Vec<usize> = numbers.collect::<Result<_, _>>()?;
    let [width, height, x, y] = numbers[..] else {
        return Err("WIDTHxHEIGHT+X+Y has four numbers".into());
    };
    let cut = |file: &String| read(file)?.cut([width, height], [x, y]);
    let pictures: Vec<Picture> = files.iter().map(cut).collect::<Result<_, _>>()?;
    let (pairs, []) = pictures.as_chunks::<2>() else {
        return Err("pictures come in pairs".into());
    };
    let columns: usize = columns.parse()?;
    if columns == 0 || pairs.is_empty() {
        return Err("a pair in a column at least".into());
    }
    write(out, pairs, columns, [width, height])
}

impl Picture {
    fn cut(self, [width, height]: [usize; 2], [x, y]: [usize; 2]) -> Result<Self, Box<dyn Error>> {
        let rows = self.pixels.chunks_exact(self.width);
        if x + width > self.width || y + height > rows.len() || width * height == 0 {
            return Err("the rectangle is not in the picture".into());
        }
        let pixels = rows.skip(y).take(height).flat_map(|row| &row[x..][..width]);
        let pixels = pixels.copied().collect();
        Ok(Self { width, pixels })
    }
}

fn read(file: &String) -> Result<Picture, Box<dyn Error>> {
    let image = read_first_rgba_layer_from_file(
        file,
        |size, _| Picture {
            width: size.width(),
            pixels: vec![[0.0; 3]; size.area()],
        },
        |picture, at, (r, g, b, _): (f32, f32, f32, f32)| {
            picture.pixels[at.y() * picture.width + at.x()] = [r, g, b];
        },
    );
    let image = image.map_err(|e| format!("{file}: {e}"))?;
    Ok(image.layer_data.channel_data.pixels)
}

fn write(
    out: &str,
    pairs: &[[Picture; 2]],
    columns: usize,
    [width, height]: [usize; 2],
) -> Result<(), Box<dyn Error>> {
    let rows = pairs.len().div_ceil(columns);
    let (across, down) = (
        columns * (2 * width + GAP) - GAP,
        rows * (height + GAP) - GAP,
    );
    let mut image = vec![255u8; across * down * 3];
    for (i, pair) in pairs.iter().enumerate() {
        let white = white(&pair[0]);
        let corner = [
            i % columns * (2 * width + GAP),
            i / columns * (height + GAP),
        ];
        for (half, picture) in pair.iter().enumerate() {
            for (p, pixel) in picture.pixels.iter().enumerate() {
                let x = corner[0] + half * width + p % width;
                let y = corner[1] + p / width;
                image[(y * across + x) * 3..][..3].copy_from_slice(&display(*pixel, white));
            }
        }
    }
    let mut file = vec![];
    let (across, down) = (u32::try_from(across)?, u32::try_from(down)?);
    let mut encoder = png::Encoder::new(&mut file, across, down);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.write_header()?.write_image_data(&image)?;
    Ok(replace_file(Path::new(out), &file)?)
}

fn white(picture: &Picture) -> f32 {
    let luminance = |p: &[f32; 3]| 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2];
    let mut sorted: Vec<f32> = picture.pixels.iter().map(luminance).collect();
    sorted.sort_by(f32::total_cmp);
    sorted[(WHITE * (sorted.len() - 1) as f32) as usize].max(f32::MIN_POSITIVE)
}

/// sRGB of light: darker parts are lifted, as twilight spans decades.
fn display(pixel: [f32; 3], white: f32) -> [u8; 3] {
    pixel.map(|v| {
        let v = (v.max(0.0) / white).powf(0.7);
        let v = v / (1.0 + 0.4 * v);
        let encoded = match v <= 0.003_130_8 {
            true => 12.92 * v,
            false => 1.055 * v.powf(1.0 / 2.4) - 0.055,
        };
        (encoded.min(1.0) * 255.0 + 0.5) as u8
    })
}
