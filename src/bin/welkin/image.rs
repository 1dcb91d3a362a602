//! Pictures: EXR with any channels, PNG through an exposure and a soft shoulder.

use std::io::Cursor;

use exr::meta::attribute::Chromaticities;
use exr::prelude::*;
use rayon::prelude::*;

use crate::about::{About, CHROMATICITIES, LUMINANCE, Value};
use crate::failure::{Failure, Result};
use crate::header;

const SOFTWARE: &str = concat!("welkin ", env!("CARGO_PKG_VERSION"));

/// A picture with named planes of single-precision values.
pub struct Planes {
    pub size: [usize; 2],
    pub planes: Vec<(String, Vec<f32>)>,
    pub about: About,
    /// Of the planes; those in cd m⁻² are linear sRGB.
    pub units: &'static str,
    pub comment: &'static str,
}

/// Encodes planes as OpenEXR, losslessly.
pub fn exr(picture: Planes) -> Result<Vec<u8>> {
    let channels = picture
        .planes
        .into_iter()
        .map(|(name, values)| AnyChannel::new(name.as_str(), FlatSamples::F32(values)));
    let about = picture.about.with(&[("units", picture.units)]);
    let is_colour = picture.units == LUMINANCE;
    let mut attributes = LayerAttributes {
        comments: Some(picture.comment.into()),
        software_name: Some(SOFTWARE.into()),
        altitude: about.altitude.map(|m| m as f32),
        white_luminance: is_colour.then_some(1.0),
        ..LayerAttributes::default()
    };
    for (name, value) in about.entries {
        attributes.other.insert(name.into(), attribute(value));
    }
    let layer = Layer::new(
        (picture.size[0], picture.size[1]),
        attributes,
        Encoding {
            // Blocks in the order of the picture, not in that of their completion.
            line_order: LineOrder::Increasing,
            ..Encoding::FAST_LOSSLESS
        },
        AnyChannels::sort(channels.collect()),
    );
    let mut image = Image::from_layer(layer);
    image.attributes.chromaticities = is_colour.then(chromaticities);
    let mut bytes = Cursor::new(Vec::new());
    let written = image.write().to_buffered(&mut bytes);
    written.map_err(|e| Failure::message(format!("cannot encode the EXR: {e}")))?;
    let mut bytes = bytes.into_inner();
    header::sort(&mut bytes);
    Ok(bytes)
}

fn attribute(value: Value) -> AttributeValue {
    match value {
        Value::Text(text) => AttributeValue::Text(Text::from_slice_unchecked(text.as_bytes())),
        Value::Number(value) => AttributeValue::F32(value as f32),
        Value::Vector([x, y, z]) => AttributeValue::FloatVec3((x as f32, y as f32, z as f32)),
    }
}

fn chromaticities() -> Chromaticities {
    let [red, green, blue, white] = CHROMATICITIES.map(|[x, y]| Vec2(x, y));
    Chromaticities {
        red,
        green,
        blue,
        white,
    }
}

/// Encodes linear sRGB pixels (cd m⁻²) as PNG; `white` is the luminance of display white.
pub fn png(size: [usize; 2], pixels: &[[f32; 3]], white: f32, about: &About) -> Result<Vec<u8>> {
    let samples: Vec<[u8; 3]> = pixels.par_iter().map(|&p| display(p, white)).collect();
    png_of_display(size, &samples, about)
}

/// Encodes sRGB pixels as PNG.
pub fn png_of_display(size: [usize; 2], pixels: &[[u8; 3]], about: &About) -> Result<Vec<u8>> {
    let failed = |e: png::EncodingError| Failure::message(format!("cannot encode the PNG: {e}"));
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size[0] as u32, size[1] as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
    let mut text = about.with(&[("Software", SOFTWARE)]);
    if let Some(altitude) = about.altitude {
        text.number("altitude", altitude);
    }
    for (name, value) in text.entries {
        let added = encoder.add_itxt_chunk(name.to_owned(), value.to_string());
        added.map_err(failed)?;
    }
    let mut writer = encoder.write_header().map_err(failed)?;
    writer
        .write_image_data(pixels.as_flattened())
        .map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(bytes)
}

/// An sRGB pixel from a linear one; `white` is the luminance of display white.
pub fn display(pixel: [f32; 3], white: f32) -> [u8; 3] {
    let rgb = pixel.map(|v| (v / white).max(0.0));
    soften(rgb).map(|v| (encode_srgb(v) * 255.0 + 0.5) as u8)
}

/// Compresses the brightest component smoothly below 1 and lets what is far above fade to white, so that the glow
/// around the sun keeps its hue instead of clipping one component after the other.
fn soften(rgb: [f32; 3]) -> [f32; 3] {
    const KNEE: f32 = 0.7;
    let peak = rgb.into_iter().fold(0.0, f32::max);
    if peak <= KNEE {
        return rgb;
    }
    let excess = (peak - KNEE) / (1.0 - KNEE);
    let target = KNEE + (1.0 - KNEE) * (1.0 - (-excess).exp());
    let fade = excess / (excess + 12.0);
    rgb.map(|v| {
        let scaled = v / peak * target;
        scaled + fade * (target - scaled)
    })
}

/// The transfer function of IEC 61966-2-1.
fn encode_srgb(v: f32) -> f32 {
    if v <= 0.003_130_8 {
        12.92 * v
    } else {
        1.055 * v.min(1.0).powf(1.0 / 2.4) - 0.055
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn display_is_monotone_and_ends_in_white() {
        let grey = |v: f32| display([v, v, v], 1.0)[0];
        assert!((0..1000).all(|i| grey(i as f32 * 0.01) <= grey((i + 1) as f32 * 0.01)));
        assert_eq!(display([-1.0, 0.0, 0.0], 1.0), [0, 0, 0]);
        assert!(display([1e6, 5e5, 1e5], 1.0).iter().all(|&v| v > 250));
    }
}
