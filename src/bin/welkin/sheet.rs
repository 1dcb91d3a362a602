//! `welkin contact-sheet`: skies from all over the model, or of a day, in one picture.

use std::io::Write;
use std::path::PathBuf;

use rayon::prelude::*;
use welkin::output::{self, Target};
use welkin::{Conditions, Model};

use crate::Source;
use crate::about::About;
use crate::exposure::Exposure;
use crate::failure::{Failure, Result, plain};
use crate::image::png_of_display;
use crate::naming::{self, Named};
use crate::parallel::bar;
use crate::parameter;
use crate::position::Position;
use crate::projection::Projection;
use crate::scene::{Scene, move_into};
use crate::view::View;

/// Columns: solar elevations, degrees.
const ELEVATIONS: [f64; 7] = [-4.0, -2.0, 0.0, 2.0, 8.0, 30.0, 70.0];
/// Rows: visibilities, km, and altitudes, m.
const VISIBILITIES: [f64; 2] = [20.0, 131.8];
const ALTITUDES: [f64; 4] = [0.0, 1e3, 4e3, 12e3];
/// Solar elevations in the last row, degrees, seen from the ground at 59.4 km: the published model, whose nodes are
/// elsewhere, shows a second glow and a crescent at the zenith in such places.
const BETWEEN: [f64; 4] = [5.23, 27.17, 58.46, 70.53];
const BETWEEN_VISIBILITY: f64 = 59.4;
const BACKGROUND: [u8; 3] = [24; 3];

/// What is given is the same in all skies.
#[derive(clap::Args)]
pub struct Options {
    #[command(flatten)]
    source: Source,
    #[command(flatten)]
    scene: Scene,
    /// How many skies the course of the sun has.
    #[arg(long, default_value_t = 7, value_parser = clap::value_parser!(u16).range(1..=64), value_name = "COUNT")]
    columns: u16,
    /// Height of each sky, pixels.
    #[arg(long, default_value_t = 96, value_parser = clap::value_parser!(u16).range(16..=512), value_name = "PIXELS")]
    size: u16,
    /// How each is laid onto its square.
    #[arg(long, value_enum, default_value = "side")]
    projection: Projection,
    #[command(flatten)]
    exposure: Exposure,
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

impl Options {
    /// Whether nothing is given, so that the sheet is of all the model.
    fn shows_all(&self) -> bool {
        let scene = &self.scene;
        !(scene.sun.is_given() || scene.has_visibility() || scene.altitude.is_some())
    }

    /// Rows over visibilities and altitudes, columns over suns, as far as they are not given; and how many columns.
    fn grid(&self, model: &Model) -> Result<(Vec<Tile>, usize)> {
        let (scene, size) = (&self.scene, usize::from(self.size));
        let air = scene.air(model)?;
        let suns = match (scene.sun.is_given(), scene.sun.is_course()) {
            (false, _) => scene.sun.at_elevations(&ELEVATIONS),
            (true, false) => scene.sun.positions(1)?,
            (true, true) => scene.sun.positions(self.columns.into())?,
        };
        let visibilities = match scene.has_visibility() {
            true => vec![air.visibility],
            false => VISIBILITIES.map(|km| 1e3 * km).to_vec(),
        };
        let altitudes = scene.altitude.map_or(ALTITUDES.to_vec(), |h| vec![h]);
        let places = visibilities.iter().flat_map(|&visibility| {
            altitudes
                .iter()
                .map(move |&altitude| [visibility, altitude])
        });
        let mut tiles = Vec::new();
        for (row, [visibility, altitude]) in places.enumerate() {
            let air = Conditions {
                visibility,
                altitude,
                ..air
            };
            tiles.extend(suns.iter().enumerate().map(|(column, sun)| Tile {
                conditions: sun.over(&air),
                projection: self.projection,
                size,
                corner: [column * size, row * size],
            }));
        }
        Ok((tiles, suns.len()))
    }

    /// The row below a grid of this size.
    fn between(&self, model: &Model, [width, height]: [usize; 2]) -> Result<Vec<Tile>> {
        let size = width / BETWEEN.len();
        let air = Conditions {
            visibility: 1e3 * BETWEEN_VISIBILITY,
            ..self.scene.air(model)?
        };
        let suns = self.scene.sun.at_elevations(&BETWEEN);
        let tile = |(column, sun): (usize, &Position)| Tile {
            conditions: sun.over(&air),
            projection: Projection::Up,
            size,
            corner: [column * size, height],
        };
        Ok(suns.iter().enumerate().map(tile).collect())
    }
}

impl Tile {
    /// `None` outside the fish-eye.
    fn pixels(&self, model: &Model, exposure: &Exposure) -> Result<Vec<Option<[u8; 3]>>> {
        let sky = model.sky(&self.conditions)?;
        let view = View {
            projection: self.projection,
            size: [self.size; 2],
            azimuth: self.conditions.solar_azimuth,
            ground: None,
            disc: None,
            moon: None,
        };
        let film = exposure.of_sky(&view, &sky)?;
        let pixel = |k: usize| {
            let direction = view.direction([k % self.size, k / self.size]);
            let rgb = direction.map(|d| sky.linear_srgb(d)).transpose()?;
            Ok(rgb.map(|rgb| film.display(rgb)))
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
    let model = options.scene.over_ground(options.source.open()?);
    let sheet = Sheet::new(options, &model)?;
    let tiles = &sheet.tiles;
    let mut canvas = Canvas::new(sheet.size);
    let bar = bar(tiles.len(), "skies");
    let skies = tiles.par_iter().map(|tile| {
        let pixels = tile.pixels(&model, &options.exposure);
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
    sheet.describe(&model, &mut target.report())?;
    writeln!(target.report(), "wrote {target}")?;
    Ok(())
}

/// What is where.
struct Sheet {
    size: [usize; 2],
    tiles: Vec<Tile>,
    /// How many of the tiles are in rows of how many; the rest stands below.
    grid: usize,
    columns: usize,
}

impl Sheet {
    fn new(options: &Options, model: &Model) -> Result<Self> {
        if ![Projection::Up, Projection::Side].contains(&options.projection) {
            let text = "a sheet has squares: --projection up or side";
            return Err(Failure::message(text));
        }
        let (mut tiles, columns) = options.grid(model)?;
        let grid = tiles.len();
        let size = usize::from(options.size);
        let [width, mut height] = [columns * size, grid / columns * size];
        let mut conditions: Vec<_> = tiles.iter().map(|tile| tile.conditions).collect();
        if options.shows_all() {
            tiles.extend(options.between(model, [width, height])?);
            height += width / BETWEEN.len();
            conditions = tiles.iter().map(|tile| tile.conditions).collect();
            // A small model shows what it has.
            move_into(model, &mut conditions)?;
        } else {
            conditions = options.scene.reached(model, conditions)?;
        }
        let all = tiles.iter_mut().zip(conditions);
        all.for_each(|(tile, reached)| tile.conditions = reached);
        Ok(Self {
            size: [width, height],
            tiles,
            grid,
            columns,
        })
    }

    fn describe(&self, model: &Model, out: &mut dyn Write) -> Result<()> {
        let mut rows = Vec::new();
        let (grid, between) = self.tiles.split_at(self.grid);
        let degrees = |tiles: &[Tile]| {
            let each = tiles.iter().map(|tile| {
                let degrees = tile.conditions.solar_elevation.to_degrees();
                plain((degrees * 1e4).round() / 1e4)
            });
            each.collect::<Vec<_>>().join(", ")
        };
        rows.push(format!(
            "columns: sun at {} degrees; rows:",
            degrees(&grid[..self.columns])
        ));
        let place = |tile: &Tile| -> Result<String> {
            let air = parameter::air(model, tile.conditions.visibility)?;
            Ok(format!(
                "{air}, altitude {} m",
                plain(tile.conditions.altitude)
            ))
        };
        for tile in grid.iter().step_by(self.columns) {
            rows.push(format!("{}, towards the sun", place(tile)?));
        }
        if let Some(tile) = between.first() {
            rows.push(format!(
                "last row: {}, upwards, sun at {} degrees",
                place(tile)?,
                degrees(between)
            ));
        }
        for row in rows {
            writeln!(out, "{row}")?;
        }
        Ok(())
    }
}
