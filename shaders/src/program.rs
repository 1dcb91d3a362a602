//! Programs as the files that they are made of.

use naga::valid::{Capabilities, ValidationFlags, Validator};

/// A shader with one entry point, `main`.
///
/// ```
/// use welkin_shaders::PROGRAMS;
///
/// let names: Vec<_> = PROGRAMS.iter().map(|program| program.name).collect();
/// assert!(names.contains(&"fill_volume"));
/// assert!(PROGRAMS[0].source().contains("fn main"));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Program {
    /// Of its file in `wgsl/programs`.
    pub name: &'static str,
    parts: &'static [&'static str],
}

impl Program {
    /// Its files one after the other.
    pub fn source(&self) -> String {
        self.parts.join("\n")
    }
}

macro_rules! program {
    ($name:literal: $($part:literal)*) => {
        Program {
            name: $name,
            parts: &[
                $(include_str!(concat!("../wgsl/", $part, ".wgsl")),)*
                include_str!(concat!("../wgsl/programs/", $name, ".wgsl")),
            ],
        }
    };
}

/// All programs.
pub const PROGRAMS: [Program; 6] = [
    program!("sky_directions": "table" "spline" "direction" "sky"),
    program!("disc_directions": "table" "disc"),
    program!("sampler_draws": "table" "direction" "disc" "disc_draw" "sampler"),
    program!("air_segments": "table" "air"),
    program!("fill_volume": "table" "spline" "direction" "colour" "aerial"),
    program!("fish_eye": "table" "spline" "direction" "colour" "sky" "disc"),
];

/// A program as naga sees it, validated.
///
/// # Errors
/// What naga says of source that it cannot read or that is not valid.
pub fn module(source: &str) -> Result<(naga::Module, naga::valid::ModuleInfo), String> {
    let module = naga::front::wgsl::parse_str(source).map_err(|e| e.emit_to_string(source))?;
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    let info = validator
        .validate(&module)
        .map_err(|e| e.emit_to_string(source))?;
    Ok((module, info))
}
