//! Pictures as files.

use super::render::Picture;
use anyhow::{Context, Result};
use exr::meta::attribute::Chromaticities;
use exr::prelude::*;
use std::io::Cursor;

/// Encodes a picture as OpenEXR: R, G, B, the luminance's standard error, and with `wavelengths` (nm) the spectrum.
pub fn exr(picture: &Picture, wavelengths: Option<&[f64]>) -> Result<Vec<u8>> {
    let channel = |name: &str, values: Vec<f32>| AnyChannel::new(name, FlatSamples::F32(values));
    let mut channels: Vec<_> = ["R", "G", "B"]
        .iter()
        .enumerate()
        .map(|(c, name)| channel(name, picture.rgb.iter().map(|rgb| rgb[c]).collect()))
        .collect();
    channels.push(channel("luminance_error", picture.error.clone()));
    for (nm, plane) in wavelengths.into_iter().flatten().zip(&picture.spectrum) {
        let name = format!("S0.{}nm", nm.to_string().replace('.', ","));
        channels.push(channel(&name, plane.clone()));
    }
    let mut attributes = LayerAttributes {
        // Of R, G and B of 1, cd m⁻².
        white_luminance: Some(1.0),
        comments: Some("R, G, B: linear sRGB, cd m^-2 at white; S0: W m^-2 sr^-1 nm^-1".into()),
        ..LayerAttributes::default()
    };
    let text = |text: &str| AttributeValue::Text(text.into());
    if wavelengths.is_some() {
        let units = text("W.m^-2.sr^-1.nm^-1");
        attributes.other.insert("emissiveUnits".into(), units);
    }
    let layer = Layer::new(
        (picture.size[0], picture.size[1]),
        attributes,
        // In order, so that the same picture is the same file.
        Encoding {
            line_order: LineOrder::Increasing,
            ..Encoding::FAST_LOSSLESS
        },
        AnyChannels::sort(channels.into_iter().collect()),
    );
    let mut bytes = Cursor::new(Vec::new());
    let mut image = Image::from_layer(layer);
    image.attributes.chromaticities = Some(Chromaticities {
        red: Vec2(0.64, 0.33),
        green: Vec2(0.30, 0.60),
        blue: Vec2(0.15, 0.06),
        white: Vec2(0.3127, 0.3290),
    });
    if wavelengths.is_some() {
        // Two in one place would be written in an order of their own every time.
        let other = &mut image.attributes.other;
        other.insert("spectralLayoutVersion".into(), text("1.0"));
    }
    let written = image.write().to_buffered(&mut bytes);
    written.context("cannot encode the EXR")?;
    Ok(bytes.into_inner())
}

/// Encodes a picture as PNG; `white` is the luminance (cd m⁻²) of display white. What is brighter is compressed.
pub fn png(picture: &Picture, white: f32) -> Result<Vec<u8>> {
    let samples: Vec<u8> = picture
        .rgb
        .iter()
        .flat_map(|rgb| display(rgb.map(|v| v / white)))
        .collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, picture.size[0] as u32, picture.size[1] as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&samples)?;
    writer.finish()?;
    Ok(bytes)
}

/// Three times the geometric mean luminance of what is seen.
pub fn automatic_white(picture: &Picture) -> f32 {
    let luminances = picture
        .rgb
        .iter()
        .map(|[r, g, b]| 0.2126 * r + 0.7152 * g + 0.0722 * b);
    let logarithms: Vec<f32> = luminances.filter(|y| *y > 0.0).map(f32::ln).collect();
    let mean = logarithms.iter().sum::<f32>() / logarithms.len().max(1) as f32;
    3.0 * mean.exp()
}

/// sRGB codes; the brightest component of each pixel is rolled off so that hues stay.
fn display(rgb: [f32; 3]) -> [u8; 3] {
    const KNEE: f32 = 0.6;
    let rgb = rgb.map(|v| v.max(0.0));
    let peak = rgb.into_iter().fold(0.0, f32::max);
    let scale = if peak > KNEE {
        let over = (peak - KNEE) / (1.0 - KNEE);
        (KNEE + (1.0 - KNEE) * over / (1.0 + over)) / peak
    } else {
        1.0
    };
    rgb.map(|v| (encode(v * scale) * 255.0).round() as u8)
}

/// The transfer function of IEC 61966-2-1.
fn encode(v: f32) -> f32 {
    if v <= 0.003_130_8 {
        12.92 * v
    } else {
        1.055 * v.powf(1.0 / 2.4) - 0.055
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture() -> Picture {
        Picture {
            size: [2, 1],
            rgb: vec![[1.0, 2.0, 3.0], [1e6, 5.0, 0.0]],
            error: vec![0.1, 0.2],
            spectrum: vec![vec![0.5, 0.25]],
        }
    }

    #[test]
    fn files_hold_what_was_put_in() {
        let bytes = exr(&picture(), Some(&[550.5])).unwrap();
        let image = read_all_flat_layers_from_memory(&bytes);
        let names: Vec<String> = image.layer_data[0]
            .channel_data
            .list
            .iter()
            .map(|c| c.name.to_string())
            .collect();
        assert_eq!(names, ["B", "G", "R", "S0.550,5nm", "luminance_error"]);
        let primaries = image.attributes.chromaticities.unwrap();
        assert_eq!(primaries.white, Vec2(0.3127, 0.3290));
        assert!(png(&picture(), 3.0).unwrap().starts_with(b"\x89PNG"));
    }

    fn read_all_flat_layers_from_memory(bytes: &[u8]) -> FlatImage {
        read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .all_layers()
            .all_attributes()
            .from_buffered(Cursor::new(bytes))
            .unwrap()
    }

    #[test]
    fn display_is_monotone() {
        let grey = |v: f32| display([v, v, v])[0];
        assert!((0..1000).all(|i| grey(i as f32 * 0.01) <= grey((i + 1) as f32 * 0.01)));
        assert_eq!(display([-1.0, 0.0, 0.0]), [0, 0, 0]);
    }
}
