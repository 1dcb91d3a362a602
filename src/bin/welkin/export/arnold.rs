//! Arnold: `skydome_light` and `distant_light` in its scene format.
//!
//! The lat-long format of the dome is that of OpenEXR, with +y up; a normalised distant light has as colour times
//! intensity the irradiance of a plane that faces it.

use std::fmt::Write;

use super::axes::Up;
use super::lights::{Lights, Sun};

/// The text of a file to read before the scene.
pub fn scene(lights: &Lights) -> String {
    let mut text = lights.comments();
    image(&mut text, lights);
    dome(&mut text, lights);
    if let Some(sun) = &lights.sun {
        distant(&mut text, sun, lights);
    }
    text
}

fn image(text: &mut String, lights: &Lights) {
    let _ = writeln!(text, "\nimage\n{{");
    let _ = writeln!(text, " name welkin_map");
    let _ = writeln!(text, " filename \"{}\"", lights.picture);
    // Columns go around, rows end at the poles.
    let _ = writeln!(
        text,
        " filter \"bilinear\"\n swrap \"periodic\"\n twrap \"clamp\"\n}}"
    );
}

fn dome(text: &mut String, lights: &Lights) {
    let _ = writeln!(text, "\nskydome_light\n{{");
    let _ = writeln!(text, " name welkin_sky");
    let _ = writeln!(text, " format \"latlong\"");
    if lights.up == Up::Z {
        // Rows are images of the axes: +y of the dome to +z, its +z to −y.
        let _ = writeln!(text, " matrix\n 1 0 0 0\n 0 0 1 0\n 0 -1 0 0\n 0 0 0 1");
    }
    let _ = writeln!(text, " color \"welkin_map\"\n intensity 1");
    exposure(text, lights);
    // Of the table that it is sampled by: as fine as the map.
    let _ = writeln!(text, " resolution {}\n}}", 2 * lights.size);
}

fn distant(text: &mut String, sun: &Sun, lights: &Lights) {
    let [x, y, z] = sun.direction(lights.up).map(|v| -v);
    let [r, g, b] = sun.colour;
    let _ = writeln!(text, "\ndistant_light\n{{");
    let _ = writeln!(text, " name welkin_sun");
    let _ = writeln!(text, " direction {x} {y} {z}");
    let _ = writeln!(text, " angle {}", Sun::angle() as f32);
    let _ = writeln!(text, " normalize on");
    let _ = writeln!(text, " color {r} {g} {b}\n intensity {}", sun.illuminance);
    exposure(text, lights);
    let _ = writeln!(text, "}}");
}

fn exposure(text: &mut String, lights: &Lights) {
    if lights.exposure.is_some() {
        let _ = writeln!(text, " exposure {}", lights.stops() as f32);
    }
}
