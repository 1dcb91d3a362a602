//! pbrt-v4: `LightSource "infinite"` and `"distant"`.
//!
//! Both are scaled so that an unscaled light is 1 nit or 1 lx: colours by the white of their space, a spectrum by its
//! own luminance. So the map in cd m⁻² is right as it is, and a spectrum only says the colour beside `illuminance`.

use std::fmt::Write;

use welkin::ColourSpace;

use crate::failure::{Failure, Result};

use super::axes::Up;
use super::lights::{Lights, Sun};

/// An error in colour spaces that pbrt does not know.
pub fn check(space: ColourSpace) -> Result<()> {
    match space {
        ColourSpace::Srgb | ColourSpace::Rec2020 => Ok(()),
        _ => Err(Failure::message(format!(
            "pbrt reads maps in srgb and rec2020, not in {}",
            space.name()
        ))),
    }
}

/// The text of a file to include after `WorldBegin`, with the irradiance by the sun at wavelengths (nm).
pub fn scene(lights: &Lights, spectrum: &[(f64, f32)]) -> String {
    let mut text = lights.comments();
    text += "# right-handed, as is pbrt with \"Scale -1 1 1\" before LookAt: without, pictures are mirrored\n";
    text += "AttributeBegin\n";
    if lights.up == Up::Y {
        text += "  Rotate -90 1 0 0\n";
    }
    let _ = writeln!(text, "  ColorSpace \"{}\"", lights.space.name());
    let _ = writeln!(text, "  LightSource \"infinite\"");
    let _ = writeln!(text, "    \"string filename\" \"{}\"", lights.picture);
    scale(&mut text, lights);
    if let Some(sun) = &lights.sun {
        distant(&mut text, sun, lights, spectrum);
    }
    text + "AttributeEnd\n"
}

fn scale(text: &mut String, lights: &Lights) {
    if lights.exposure.is_some() {
        let _ = writeln!(text, "    \"float scale\" {}", lights.scale() as f32);
    }
}

fn distant(text: &mut String, sun: &Sun, lights: &Lights, spectrum: &[(f64, f32)]) {
    // In the frame of the map, which is turned with it.
    let [x, y, z] = sun.direction(Up::Z);
    let [r, g, b] = sun.colour.map(|v| v * sun.illuminance);
    let _ = writeln!(
        text,
        "  # in RGB: \"rgb L\" [ {r} {g} {b} ] without illuminance"
    );
    let _ = writeln!(text, "  LightSource \"distant\"");
    let _ = writeln!(
        text,
        "    \"point3 from\" [ {x} {y} {z} ] \"point3 to\" [ 0 0 0 ]"
    );
    let _ = writeln!(text, "    \"float illuminance\" {}", sun.illuminance);
    scale(text, lights);
    let _ = writeln!(text, "    \"spectrum L\" [");
    for (nm, value) in spectrum {
        let _ = writeln!(text, "      {nm} {value:e}");
    }
    let _ = writeln!(text, "    ]");
}
