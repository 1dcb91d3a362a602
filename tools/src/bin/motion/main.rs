//! Whether baked skies pop: `cargo run --release -p welkin-tools --bin motion` walks along climbs, sunsets and changes
//! of the visibility, and prints by how much small steps (0.1 m, 0.001°, 1 m of visibility) change pixels beyond the
//! sky's own change, where the size of the tables changes and elsewhere; `-- --strips FOLDER` writes a climb and a
//! sunset as strips of frames.

#[allow(dead_code)]
mod steps;
mod strip;

use std::path::Path;

use steps::{Axis, KINDS, Kind, View, bisect, jump};
use welkin::{BakedSky, Conditions, Error, Model, Result};

/// Places on a path.
const FRAMES: u32 = 300;

fn main() -> std::result::Result<(), Box<dyn std::error::Error>> {
    let model = Model::default_model()?;
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [option, folder] = &arguments[..]
        && option == "--strips"
    {
        return strip::write(&model, Path::new(folder));
    }
    println!(
        "path                                     kind       frames  sizes   median     p99  largest step  lost  refused"
    );
    for (name, axis, base, range) in paths() {
        for kind in KINDS {
            walk(&model, kind, axis, &base, range)?.print(&name, kind);
        }
    }
    Ok(())
}

type Path_ = (String, Axis, Conditions, [f64; 2]);

/// Climbs at several suns, sunsets at several altitudes, changing air.
fn paths() -> Vec<Path_> {
    let at = |elevation: f64, altitude: f64, visibility: f64| Conditions {
        solar_elevation: elevation.to_radians(),
        altitude,
        visibility,
        ..Conditions::default()
    };
    let mut paths = Vec::new();
    for (sun, visibility) in [(20.0, 59.4e3), (1.5, 90e3), (-3.0, 40e3), (60.0, 25e3)] {
        let name = format!("climb 0..15 km, sun {sun}°, {} km", visibility / 1e3);
        paths.push((name, Axis::Climb, at(sun, 0.0, visibility), [0.0, 15e3]));
    }
    for (altitude, visibility) in [(0.0, 59.4e3), (3e3, 90e3), (11e3, 59.4e3)] {
        let name = format!("sun 30..-4.2°, {altitude} m, {} km", visibility / 1e3);
        paths.push((name, Axis::Sun, at(0.0, altitude, visibility), [-4.2, 30.0]));
    }
    for (sun, altitude) in [(5.0, 100.0), (40.0, 2500.0)] {
        let name = format!("visibility 20..131 km, sun {sun}°, {altitude} m");
        paths.push((
            name,
            Axis::Visibility,
            at(sun, altitude, 0.0),
            [20e3, 131e3],
        ));
    }
    paths
}

/// What was found along a path.
#[derive(Default)]
struct Walk {
    jumps: Vec<f64>,
    sizes: usize,
    refused: usize,
    worst: f64,
    place: f64,
    lost: f64,
}

impl Walk {
    fn print(mut self, name: &str, kind: Kind) {
        self.jumps.sort_by(f64::total_cmp);
        let at = |share: f64| 100.0 * self.jumps[(share * (self.jumps.len() - 1) as f64) as usize];
        println!(
            "{name:40} {:10} {:6} {:6} {:7.4}% {:6.4}% {:7.4}% at {:.4}  {:.2}% {}",
            format!("{kind:?}"),
            self.jumps.len(),
            self.sizes,
            at(0.5),
            at(0.99),
            100.0 * self.worst,
            self.place,
            100.0 * self.lost,
            self.refused
        );
    }

    fn step(&mut self, view: &impl Fn(f64) -> Result<View>, [low, high]: [f64; 2]) -> Result<()> {
        let found = jump(&view(low)?, &view(high)?)?;
        let jump = found.largest;
        self.lost = self.lost.max(found.lost);
        self.jumps.push(jump);
        if jump > self.worst {
            (self.worst, self.place) = (jump, low);
        }
        Ok(())
    }
}

fn walk(
    model: &Model,
    kind: Kind,
    axis: Axis,
    base: &Conditions,
    [from, to]: [f64; 2],
) -> Result<Walk> {
    let view = |value: f64| View::new(model, kind, &axis.at(base, value), BakedSky::TOLERANCE);
    let mut walk = Walk::default();
    let mut last: Option<(f64, usize)> = None;
    for frame in 0..=FRAMES {
        // Denser towards the ground and the horizon.
        let share = f64::from(frame) / f64::from(FRAMES);
        let value = from + share * share * (to - from);
        let [low, high] = match value + axis.step() <= to {
            true => [value, value + axis.step()],
            false => [value - axis.step(), value],
        };
        let bytes = match view(low) {
            Err(Error::Tolerance { .. }) => {
                walk.refused += 1;
                last = None;
                continue;
            }
            other => other?.bytes(),
        };
        match walk.step(&view, [low, high]) {
            Err(Error::Tolerance { .. }) => continue,
            other => other?,
        }
        if let Some((before, size)) = last
            && size != bytes
        {
            walk.sizes += 1;
            let switch = bisect(view, [before, low], 0.5 * axis.step())?;
            walk.step(&view, switch)?;
        }
        last = Some((low, bytes));
    }
    Ok(walk)
}
