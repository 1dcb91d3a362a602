//! `welkin contact-sheet`: skies from all over the model in one picture.

use std::io::Write;
use std::path::PathBuf;

use welkin::output::{self, Target};
use welkin::{Conditions, Model};

use crate::Source;
use crate::failure::Result;
use crate::image::{display, png_of_display};
use crate::naming::{self, Named};
use crate::picture::View;
use crate::projection::Projection;
use crate::render::automatic_white;

/// Columns: solar elevations, degrees.
const ELEVATIONS: [f64; 7] = [-4.0, -2.0, 0.0, 2.0, 8.0, 30.0, 70.0];
/// Rows: visibilities, km, and altitudes, m.
const VISIBILITIES: [f64; 2] = [20.0, 131.8];
const ALTITUDES: [f64; 4] = [0.0, 1e3, 4e3, 12e3];
/// Solar elevations in the last row, degrees, seen from the ground at 59.4 km: the published model, whose nodes are elsewhere, shows
/// a second glow and a crescent at the zenith in such places.
const BETWEEN: [f64; 4] = [5.23, 27.17, 58.46, 70.53];
const BETWEEN_VISIBILITY: f64 = 59.4;
const BACKGROUND: [u8; 3] = [24; 3];

#[derive(clap::Args)]
pub struct Options {
    #[command(flatten)]
    source: Source,
    /// Height of each sky, pixels.
    #[arg(long, default_value_t = 96, value_parser = clap::value_parser!(u16).range(16..=512), value_name = "PIXELS")]
    size: u16,
    /// The PNG; - for standard output.
    #[arg(long, default_value = "contact-sheet.png", value_name = "FILE")]
    out: PathBuf,
}

/// A picture to which smaller ones are pasted.
struct Canvas {
    size: [usize; 2],
    pixels: Vec<[u8; 3]>,
}

impl Canvas {
    fn new(size: [usize; 2]) -> Self {
        Self {
            size,
            pixels: vec![BACKGROUND; size[0] * size[1]],
        }
    }

    /// Renders a sky with its own exposure into the square at `corner`.
    fn paste(
        &mut self,
        model: &Model,
        conditions: &Conditions,
        projection: Projection,
        size: usize,
        corner: [usize; 2],
    ) -> Result<()> {
        let sky = model.sky(conditions)?;
        let view = View {
            projection,
            size: [size, size],
            azimuth: 0.0,
            ground: None,
        };
        let white = automatic_white(&sky)? as f32;
        let inside = view.directions().map(|direction| direction.is_some());
        for (k, (pixel, inside)) in view.rgb(&sky)?.into_iter().zip(inside).enumerate() {
            if inside {
                let [x, y] = [corner[0] + k % size, corner[1] + k / size];
                self.pixels[y * self.size[0] + x] = display(pixel, white);
            }
        }
        Ok(())
    }
}

pub fn run(options: &Options) -> Result<()> {
    let named = naming::named(&options.out, Some(()), &[((), "png")])?;
    let target = named.map_or_else(|| Target::new(&options.out), |Named { target, .. }| target);
    target.check()?;
    let model = options.source.open()?;
    let size = usize::from(options.size);
    let width = ELEVATIONS.len() * size;
    let rows = VISIBILITIES.len() * ALTITUDES.len();
    let large = width / BETWEEN.len();
    let mut canvas = Canvas::new([width, rows * size + large]);
    let mut out = target.report();
    writeln!(out, "columns: sun at {ELEVATIONS:?} degrees; rows:")?;
    let places = VISIBILITIES
        .into_iter()
        .flat_map(|v| ALTITUDES.map(|h| (v, h)));
    for (row, (visibility, altitude)) in places.enumerate() {
        writeln!(
            out,
            "visibility {visibility} km, altitude {altitude} m, towards the sun"
        )?;
        for (column, elevation) in ELEVATIONS.into_iter().enumerate() {
            let conditions = conditions(elevation, visibility, altitude).clamped(&model)?;
            let corner = [column * size, row * size];
            canvas.paste(&model, &conditions, Projection::Side, size, corner)?;
        }
    }
    writeln!(
        out,
        "last row: visibility {BETWEEN_VISIBILITY} km, altitude 0 m, upwards, sun at {BETWEEN:?} degrees"
    )?;
    for (column, elevation) in BETWEEN.into_iter().enumerate() {
        let conditions = conditions(elevation, BETWEEN_VISIBILITY, 0.0).clamped(&model)?;
        let corner = [column * large, rows * size];
        canvas.paste(&model, &conditions, Projection::Up, large, corner)?;
    }
    let png = png_of_display(canvas.size, &canvas.pixels)?;
    output::write(&[(&target, &png)])?;
    writeln!(out, "wrote {target}")?;
    Ok(())
}

fn conditions(elevation: f64, visibility: f64, altitude: f64) -> Conditions {
    Conditions {
        solar_elevation: elevation.to_radians(),
        visibility: visibility * 1e3,
        altitude,
        ..Conditions::default()
    }
}
