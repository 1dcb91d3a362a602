//! How EXR files are written: colour space, type of the numbers, compression.

use exr::prelude::{Compression, f16};
use rayon::prelude::*;
use welkin::ColourSpace;

/// Planes by name.
pub type Planes = [(String, Vec<f32>)];

#[derive(clap::Args, Clone, Copy)]
#[command(next_help_heading = "EXR files")]
pub struct Encoding {
    /// Linear colour space of R, G and B in EXR files; PNG files are sRGB. ACEScg is adapted from D65 to the white of
    /// ACES, XYZ is not adapted.
    #[arg(long, value_enum, default_value = "srgb")]
    colour_space: Space,
    /// Type of the numbers in EXR files. Half precision ends at 65504 and is coarse below 6·10⁻⁵: a warning says when.
    #[arg(long, value_enum, default_value = "float")]
    exr_type: Type,
    /// Compression of EXR files, all without loss.
    #[arg(long, value_enum, default_value = "rle")]
    exr_compression: Method,
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Space {
    Srgb,
    Rec2020,
    Acescg,
    Xyz,
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Type {
    Float,
    Half,
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Method {
    None,
    Rle,
    /// Single lines.
    Zips,
    /// Blocks of 16 lines.
    Zip,
    /// Wavelets.
    Piz,
}

impl Encoding {
    pub fn space(&self) -> ColourSpace {
        match self.colour_space {
            Space::Srgb => ColourSpace::Srgb,
            Space::Rec2020 => ColourSpace::Rec2020,
            Space::Acescg => ColourSpace::AcesCg,
            Space::Xyz => ColourSpace::Xyz,
        }
    }

    pub fn is_half(&self) -> bool {
        self.exr_type == Type::Half
    }

    pub fn compression(&self) -> Compression {
        match self.exr_compression {
            Method::None => Compression::Uncompressed,
            Method::Rle => Compression::RLE,
            Method::Zips => Compression::ZIP1,
            Method::Zip => Compression::ZIP16,
            Method::Piz => Compression::PIZ,
        }
    }

    /// What colours are, in words.
    pub fn comment(&self) -> &'static str {
        match self.colour_space {
            Space::Srgb => "linear sRGB, cd m^-2",
            Space::Rec2020 => "linear Rec. 2020, cd m^-2",
            Space::Acescg => "ACEScg, cd m^-2",
            Space::Xyz => "CIE 1931 XYZ, cd m^-2",
        }
    }

    /// The name of the Color Interop Forum.
    pub fn interop_id(&self) -> &'static str {
        match self.colour_space {
            Space::Srgb => "lin_rec709_scene",
            Space::Rec2020 => "lin_rec2020_scene",
            Space::Acescg => "lin_ap1_scene",
            Space::Xyz => "lin_ciexyzd65_scene",
        }
    }

    /// Takes the planes R, G and B of each layer of a picture in linear sRGB to the colour space.
    pub fn convert(&self, planes: &mut Planes) {
        let layers: Vec<String> = planes.iter().filter_map(|(name, _)| red(name)).collect();
        for layer in layers {
            let channels = ["R", "G", "B"].map(|channel| {
                let name = format!("{layer}{channel}");
                planes.iter().position(|plane| plane.0 == name)
            });
            if let [Some(r), Some(g), Some(b)] = channels {
                let [r, g, b] = [r, g, b].map(|i| core::mem::take(&mut planes[i].1));
                let converted = converted(self.space(), [&r, &g, &b]);
                for (i, values) in channels.into_iter().flatten().zip(converted) {
                    planes[i].1 = values;
                }
            }
        }
    }

    /// Says what half precision does to a picture that is about to be written.
    pub fn warn(&self, planes: &Planes) {
        if !self.is_half() {
            return;
        }
        let largest = f16::MAX.to_f32();
        let smallest = f16::MIN_POSITIVE.to_f32();
        let count = |is: &(dyn Fn(f32) -> bool + Sync)| -> usize {
            let planes = planes.par_iter();
            planes
                .map(|(_, values)| values.iter().filter(|v| is(v.abs())).count())
                .sum()
        };
        let above = count(&|v| v > largest);
        if above > 0 {
            eprintln!(
                "warning: {above} numbers are beyond {largest}, the largest of half precision, and are written as that: use --exr-type float"
            );
        }
        let below = count(&|v| v > 0.0 && v < smallest);
        if below > 0 {
            eprintln!(
                "warning: {below} numbers are below {smallest:.1e}, where half precision is coarse: use --exr-type float"
            );
        }
    }
}

/// What comes before the R of a red channel.
fn red(name: &str) -> Option<String> {
    let layer = name.strip_suffix('R')?;
    (layer.is_empty() || layer.ends_with('.')).then(|| layer.to_owned())
}

fn converted(space: ColourSpace, [r, g, b]: [&[f32]; 3]) -> [Vec<f32>; 3] {
    let mut out = [Vec::with_capacity(r.len()), Vec::new(), Vec::new()];
    for ((&r, &g), &b) in r.iter().zip(g).zip(b) {
        let rgb = space.from_linear_srgb([r, g, b]);
        (0..3).for_each(|c| out[c].push(rgb[c]));
    }
    out
}

/// In half precision; what is beyond its range becomes its largest number.
pub fn halves(values: &[f32]) -> Vec<f16> {
    let largest = f16::MAX.to_f32();
    values
        .iter()
        .map(|v| f16::from_f32(v.clamp(-largest, largest)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_saturate() {
        assert_eq!(
            halves(&[1.0, 1e9, -1e9, 65504.0]),
            [1.0, 65504.0, -65504.0, 65504.0].map(f16::from_f32)
        );
    }

    #[test]
    fn layers_are_found() {
        assert_eq!(red("R").as_deref(), Some(""));
        assert_eq!(red("S1.R").as_deref(), Some("S1."));
        assert_eq!(red("slice001.TR"), None);
    }
}
