//! `welkin contact-sheet`: skies from all over the model in one picture.

use std::collections::BTreeSet;
use std::io::Write;
use std::path::PathBuf;

use rayon::prelude::*;
use welkin::output::{self, Target};
use welkin::{Conditions, Model};

use crate::Source;
use crate::about::About;
use crate::failure::Result;
use crate::image::{display, png_of_display};
use crate::naming::{self, Named};
use crate::parallel::bar;
use crate::picture::View;
use crate::projection::Projection;
use crate::render::automatic_white;
use crate::scene::moved;

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

/// A sky in a square of the sheet.
struct Tile {
    conditions: Conditions,
    projection: Projection,
    size: usize,
    corner: [usize; 2],
}

impl Tile {
    /// With its own exposure; `None` outside the fish-eye.
    fn pixels(&self, model: &Model) -> Result<Vec<Option<[u8; 3]>>> {
        let sky = model.sky(&self.conditions)?;
        let view = View {
            projection: self.projection,
            size: [self.size; 2],
            azimuth: 0.0,
            ground: None,
        };
        let white = automatic_white(&sky)? as f32;
        let pixel = |k: usize| {
            let direction = view.direction([k % self.size, k / self.size]);
            let rgb = direction.map(|d| sky.linear_srgb(d)).transpose()?;
            Ok(rgb.map(|rgb| display(rgb, white)))
        };
        (0..self.size * self.size).map(pixel).collect()
    }
}

impl Canvas {
    fn new(size: [usize; 2]) -> Self {
        Self {
            size,
            pixels: vec![BACKGROUND; size[0] * size[1]],
        }
    }

    fn paste(&mut self, tile: &Tile, pixels: &[Option<[u8; 3]>]) {
        for (k, pixel) in pixels.iter().enumerate() {
            if let Some(pixel) = pixel {
                let [x, y] = [
                    tile.corner[0] + k % tile.size,
                    tile.corner[1] + k / tile.size,
                ];
                self.pixels[y * self.size[0] + x] = *pixel;
            }
        }
    }
}

pub fn run(options: &Options) -> Result<()> {
    let named = naming::named(&options.out, Some(()), &[((), "png")])?;
    let target = named.map_or_else(|| Target::new(&options.out), |Named { target, .. }| target);
    target.check()?;
    let model = options.source.open()?;
    let size = usize::from(options.size);
    let width = ELEVATIONS.len() * size;
    let rows = places().count();
    let large = width / BETWEEN.len();
    let mut canvas = Canvas::new([width, rows * size + large]);
    let tiles = tiles(&model, size, large)?;
    let bar = bar(tiles.len(), "skies");
    let skies = tiles.par_iter().map(|tile| {
        let pixels = tile.pixels(&model);
        bar.inc(1);
        pixels
    });
    // The first failure, whichever came first.
    let skies: Vec<Result<_>> = skies.collect();
    bar.finish_and_clear();
    for (tile, pixels) in tiles.iter().zip(skies) {
        canvas.paste(tile, &pixels?);
    }
    let png = png_of_display(canvas.size, &canvas.pixels, &About::default())?;
    output::write(&[(&target, &png)])?;
    describe(&mut target.report())?;
    writeln!(target.report(), "wrote {target}")?;
    Ok(())
}

/// All skies of the sheet, and on standard error which are not quite where they should be.
fn tiles(model: &Model, size: usize, large: usize) -> Result<Vec<Tile>> {
    let mut tiles = Vec::new();
    for (row, (visibility, altitude)) in places().enumerate() {
        for (column, elevation) in ELEVATIONS.into_iter().enumerate() {
            tiles.push(Tile {
                conditions: conditions(elevation, visibility, altitude),
                projection: Projection::Side,
                size,
                corner: [column * size, row * size],
            });
        }
    }
    for (column, elevation) in BETWEEN.into_iter().enumerate() {
        tiles.push(Tile {
            conditions: conditions(elevation, BETWEEN_VISIBILITY, 0.0),
            projection: Projection::Up,
            size: large,
            corner: [column * large, places().count() * size],
        });
    }
    let mut lines = BTreeSet::new();
    for tile in &mut tiles {
        let reached = tile.conditions.clamped(model)?;
        lines.extend(moved(&tile.conditions, &reached));
        tile.conditions = reached;
    }
    for line in lines {
        // Nobody is left to tell when standard error is closed.
        let _ = writeln!(std::io::stderr(), "welkin: {line}");
    }
    Ok(tiles)
}

/// Visibilities, km, and altitudes, m, of the rows.
fn places() -> impl Iterator<Item = (f64, f64)> {
    VISIBILITIES
        .into_iter()
        .flat_map(|v| ALTITUDES.map(|h| (v, h)))
}

fn describe(out: &mut dyn Write) -> Result<()> {
    writeln!(out, "columns: sun at {ELEVATIONS:?} degrees; rows:")?;
    for (visibility, altitude) in places() {
        writeln!(
            out,
            "visibility {visibility} km, altitude {altitude} m, towards the sun"
        )?;
    }
    writeln!(
        out,
        "last row: visibility {BETWEEN_VISIBILITY} km, altitude 0 m, upwards, sun at {BETWEEN:?} degrees"
    )?;
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
