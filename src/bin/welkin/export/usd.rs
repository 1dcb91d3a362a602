//! USD: `DomeLight` and `DistantLight` of UsdLux in a layer of text.

use std::fmt::Write;

use super::axes::Up;
use super::lights::{Lights, Sun};

/// What `inputs:intensity` of the sun is.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Intensity {
    /// Illuminance of a plane that faces it, lx: with `inputs:normalize`.
    Illuminance,
    /// Luminance of its disc, cd m⁻²: without.
    Luminance,
}

/// The text of a layer, to be referenced or opened.
pub fn scene(lights: &Lights, intensity: Intensity) -> String {
    let mut text = "#usda 1.0\n(\n    defaultPrim = \"sky\"\n    metersPerUnit = 1\n".to_owned();
    let axis = match lights.up {
        Up::Y => "Y",
        Up::Z => "Z",
    };
    let _ = writeln!(text, "    upAxis = \"{axis}\"\n)\n");
    text += &lights.comments();
    let _ = writeln!(text, "\ndef Xform \"sky\" (");
    let _ = writeln!(text, "    prepend apiSchemas = [\"ColorSpaceAPI\"]\n)\n{{");
    let _ = writeln!(
        text,
        "    uniform token colorSpace:name = \"{}\"\n",
        lights.space_id
    );
    dome(&mut text, lights);
    if let Some(sun) = &lights.sun {
        distant(&mut text, sun, lights, intensity);
    }
    text + "}\n"
}

fn dome(text: &mut String, lights: &Lights) {
    let _ = writeln!(text, "    def DomeLight \"dome\"\n    {{");
    let _ = writeln!(text, "        color3f inputs:color = (1, 1, 1)");
    exposure(text, lights);
    let _ = writeln!(text, "        float inputs:intensity = 1");
    let _ = writeln!(
        text,
        "        asset inputs:texture:file = @./{}@",
        lights.picture
    );
    let _ = writeln!(text, "        token inputs:texture:format = \"latlong\"");
    // Domes have +y up, whatever the stage has.
    if lights.up == Up::Z {
        turns(text, &[("rotateX:orientToStageUpAxis", 90.0)]);
    }
    let _ = writeln!(text, "    }}");
}

fn distant(text: &mut String, sun: &Sun, lights: &Lights, intensity: Intensity) {
    let [r, g, b] = sun.colour;
    let (value, normalize) = match intensity {
        Intensity::Illuminance => (sun.illuminance, 1),
        Intensity::Luminance => (sun.luminance(), 0),
    };
    let _ = writeln!(text, "\n    def DistantLight \"sun\"\n    {{");
    let _ = writeln!(text, "        float inputs:angle = {}", Sun::angle() as f32);
    let _ = writeln!(text, "        color3f inputs:color = ({r}, {g}, {b})");
    exposure(text, lights);
    let _ = writeln!(text, "        float inputs:intensity = {value}");
    let _ = writeln!(text, "        bool inputs:normalize = {normalize}");
    let elevation = sun.conditions.solar_elevation.to_degrees();
    let azimuth = sun.conditions.solar_azimuth.to_degrees();
    // It shines along −z; the last of the turns is the first.
    match lights.up {
        Up::Y => turns(
            text,
            &[("rotateY", 90.0 + azimuth), ("rotateX", -elevation)],
        ),
        Up::Z => turns(text, &[("rotateZ", azimuth), ("rotateY", 90.0 - elevation)]),
    }
    let _ = writeln!(text, "    }}");
}

/// Rotations about an axis, degrees.
fn turns(text: &mut String, turns: &[(&str, f64)]) {
    for (name, degrees) in turns {
        let _ = writeln!(text, "        float xformOp:{name} = {}", *degrees as f32);
    }
    let names: Vec<String> = turns
        .iter()
        .map(|(name, _)| format!("\"xformOp:{name}\""))
        .collect();
    let _ = writeln!(
        text,
        "        uniform token[] xformOpOrder = [{}]",
        names.join(", ")
    );
}

fn exposure(text: &mut String, lights: &Lights) {
    if lights.exposure.is_some() {
        let _ = writeln!(
            text,
            "        float inputs:exposure = {}",
            lights.stops() as f32
        );
    }
}
