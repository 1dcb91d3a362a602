//! Pictures: EXR with any channels, PNG as a film shows it.

use std::io::Cursor;

use exr::meta::attribute::Chromaticities;
use exr::prelude::*;
use rayon::prelude::*;
use welkin::ColourSpace;

use crate::about::{About, LUMINANCE, Value};
use crate::encoding::{self, Encoding};
use crate::failure::{Failure, Result};
use crate::header;
use crate::tone::Film;

const SOFTWARE: &str = concat!("welkin ", env!("CARGO_PKG_VERSION"));

/// A picture with named planes of single-precision values.
pub struct Planes {
    pub size: [usize; 2],
    pub planes: Vec<(String, Vec<f32>)>,
    pub about: About,
    /// Of the planes.
    pub units: &'static str,
    /// Of those in cd m⁻².
    pub space: ColourSpace,
    pub comment: &'static str,
}

/// Encodes planes as OpenEXR; says on the error stream what half precision changes.
pub fn exr(mut picture: Planes, encoding: &Encoding) -> Result<Vec<u8>> {
    if picture.units == LUMINANCE && picture.space != encoding.space() {
        encoding.convert(&mut picture.planes);
    }
    encoding.warn(&picture.planes);
    let channels = picture
        .planes
        .into_iter()
        .map(|(name, values)| AnyChannel::new(name.as_str(), samples(values, encoding)));
    let is_colour = picture.units == LUMINANCE;
    let mut about = picture.about.with(&[("units", picture.units)]);
    if is_colour {
        about = about.with(&[("colorInteropID", encoding.interop_id())]);
    }
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
        exr::image::Encoding {
            compression: encoding.compression(),
            // Blocks in the order of the picture, not in that of their completion.
            line_order: LineOrder::Increasing,
            ..exr::image::Encoding::FAST_LOSSLESS
        },
        AnyChannels::sort(channels.collect()),
    );
    let mut image = Image::from_layer(layer);
    image.attributes.chromaticities = is_colour.then(|| chromaticities(encoding));
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

fn samples(values: Vec<f32>, encoding: &Encoding) -> FlatSamples {
    match encoding.is_half() {
        true => FlatSamples::F16(encoding::halves(&values)),
        false => FlatSamples::F32(values),
    }
}

fn chromaticities(encoding: &Encoding) -> Chromaticities {
    let [red, green, blue, white] = encoding.space().chromaticities().map(|[x, y]| Vec2(x, y));
    Chromaticities {
        red,
        green,
        blue,
        white,
    }
}

/// Encodes linear sRGB pixels (cd m⁻²) as PNG.
pub fn png(size: [usize; 2], pixels: &[[f32; 3]], film: &Film, about: &About) -> Result<Vec<u8>> {
    let samples: Vec<[u8; 3]> = pixels.par_iter().map(|&p| film.display(p)).collect();
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
