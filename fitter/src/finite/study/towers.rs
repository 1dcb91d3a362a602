//! Towers on flat ground (the paper's Fig. 14), all black, so that nothing but the air between is seen.

use super::method::{METHODS, Methods};
use super::scan::all;
use super::segment_case::Case;
use crate::picture::camera::{Camera, Projection};
use crate::picture::ground::{Ground, Pattern};
use crate::picture::scene::{Builder, Place, Scene, Tower};
use crate::picture::{Picture, Settings, render};
use crate::successive_orders::{NW, Spectrum};
use crate::tracer::solids::{Reflectance, Solids};
use crate::tracer::{Options, Tracer};
use crate::units::Solved;
use anyhow::Result;
use glam::DVec3;
use rayon::prelude::*;
use welkin::xyz_to_linear_srgb;

/// Where from, and how finely.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// Index of the visibility.
    pub visibility: usize,
    /// Altitude of the camera, m.
    pub altitude: f64,
    /// Angle of its axis above the horizontal, rad.
    pub pitch: f64,
    /// Width and height, pixels.
    pub size: [usize; 2],
    /// Path-traced walks per pixel; 0 leaves that picture out.
    pub walks: usize,
}

/// The same view in several ways, and how they differ from exact integrals.
#[derive(Clone, Debug)]
pub struct Views {
    /// Names of the pictures from left to right.
    pub names: Vec<String>,
    /// The pictures in a row; below each its relative error in luminance: blue is −10 %, red +10 %, black not
    /// available.
    pub sheet: Picture,
}

/// Towers 1 to 15 km high, 12 to 120 km away.
const TOWERS: [[f64; 4]; 7] = [
    [12.0, 2.2, 1.0, 1.0],
    [20.0, -2.0, 1.5, 2.0],
    [30.0, 1.5, 2.0, 4.0],
    [45.0, -5.5, 3.0, 6.0],
    [60.0, 8.5, 4.0, 9.0],
    [85.0, -4.0, 5.0, 12.0],
    [120.0, 6.0, 7.0, 15.0],
];
/// Vertical field of view, rad.
const FIELD: f64 = 0.3;
const SUN: f64 = 15.0 * std::f64::consts::PI / 180.0;
/// Azimuth of the sun from straight ahead, rad.
const SUN_AZIMUTH: f64 = 1.2;
/// Saturated error.
const WORST: f64 = 0.1;

/// Renders a view in all ways.
pub fn towers(methods: &Methods, solved: &Solved, xyz: &[[f64; 3]], view: &View) -> Result<Views> {
    let air = &solved.medium.atmosphere;
    let scene = scene(air.planet_radius)?;
    let camera = Camera {
        projection: Projection::Perspective(FIELD),
        pitch: view.pitch,
        size: view.size,
    };
    let [width, height] = view.size;
    let pixels = (0..width * height).map(|i| [i % width, i / width]);
    let cases: Vec<Case> = pixels
        .map(|pixel| case(solved, &scene, view, camera.direction(pixel, [0.5; 2])))
        .collect();
    let truth: Vec<Spectrum> = cases.par_iter().map(|c| c.truth(solved)[0]).collect();
    let light = all(methods, &cases)?;
    let mut columns = vec![];
    if view.walks > 0 {
        columns.push((
            "path-traced".to_owned(),
            traced(solved, &scene, &camera, view)?,
        ));
    }
    columns.push(("exact".to_owned(), truth.iter().map(|t| Some(*t)).collect()));
    for (m, method) in METHODS.into_iter().enumerate() {
        columns.push((
            method.name().to_owned(),
            light.iter().map(|l| l[m]).collect(),
        ));
    }
    Ok(Views {
        names: columns.iter().map(|(name, _)| name.clone()).collect(),
        sheet: sheet(view.size, &columns, &truth, xyz),
    })
}

fn scene(radius: f64) -> Result<Scene> {
    let mut builder = Builder::new(radius);
    for tower in TOWERS {
        let [ahead, left, width, height] = tower.map(|km| 1e3 * km);
        let place = Place { ahead, left };
        builder.tower(
            &Tower {
                place,
                width,
                height,
            },
            Reflectance::grey(0.0),
        )?;
    }
    builder.build(Ground {
        pattern: Pattern::Plain,
        albedo: 0.0,
        cell: 1e3,
    })
}

fn case(solved: &Solved, scene: &Scene, view: &View, direction: DVec3) -> Case {
    let planet = crate::column::planet(&solved.medium.atmosphere);
    let elevation = direction.z.clamp(-1.0, 1.0).asin();
    let whole = planet.ray(view.altitude, elevation).length;
    let origin = DVec3::new(0.0, 0.0, planet.radius + view.altitude);
    let hit = scene.hit(origin, direction, whole);
    Case {
        visibility: view.visibility,
        altitude: view.altitude,
        direction: [elevation, direction.y.atan2(direction.x) - SUN_AZIMUTH],
        length: hit.map_or(whole, |h| h.distance),
        sun: SUN,
        albedo: 0.0,
    }
}

fn traced(
    solved: &Solved,
    scene: &Scene,
    camera: &Camera,
    view: &View,
) -> Result<Vec<Option<Spectrum>>> {
    let air = &solved.medium.atmosphere;
    let tracer = Tracer::new(air, Options::default())?;
    let settings = Settings {
        camera: *camera,
        altitude: view.altitude,
        sun_elevation: SUN,
        sun_azimuth: SUN_AZIMUTH,
        samples: view.walks,
        seed: 1,
    };
    let picture = render(&tracer, &air.wavelengths, scene, &settings, &|| ())?;
    let irradiance = crate::picture::irradiance(&air.wavelengths)?;
    let spectrum = |i: usize| -> Spectrum {
        std::array::from_fn(|w| picture.spectrum[w][i] / irradiance[w] as f32)
    };
    Ok((0..picture.rgb.len()).map(|i| Some(spectrum(i))).collect())
}

type Column = (String, Vec<Option<Spectrum>>);

/// Pictures in the upper row, errors in the lower one, a pixel apart.
fn sheet(
    [width, height]: [usize; 2],
    columns: &[Column],
    truth: &[Spectrum],
    xyz: &[[f64; 3]],
) -> Picture {
    let size = [columns.len() * (width + 1) - 1, 2 * height + 1];
    let mut rgb = vec![[0.0; 3]; size[0] * size[1]];
    let exact: Vec<[f64; 3]> = truth.iter().map(|t| colour(t, xyz)).collect();
    let white = 2.5 * exact.iter().map(|c| c[1]).sum::<f64>() / exact.len() as f64;
    for (c, (_, light)) in columns.iter().enumerate() {
        for (i, light) in light.iter().enumerate() {
            let (x, y) = (c * (width + 1) + i % width, i / width);
            let Some(light) = light else { continue };
            let seen = colour(&light.map(|v| v.max(0.0)), xyz);
            let error = seen[1] / exact[i][1] - 1.0;
            rgb[y * size[0] + x] = xyz_to_linear_srgb(seen.map(|v| (v / white) as f32));
            rgb[(y + height + 1) * size[0] + x] = diverging(error / WORST);
        }
    }
    Picture {
        size,
        error: vec![0.0; rgb.len()],
        rgb,
        spectrum: vec![],
    }
}

fn colour(light: &Spectrum, xyz: &[[f64; 3]]) -> [f64; 3] {
    let component = |c: usize| (0..NW).map(|w| f64::from(light[w]) * xyz[w][c]).sum();
    std::array::from_fn(component)
}

/// White at 0, red at 1, blue at −1.
fn diverging(t: f64) -> [f32; 3] {
    let t = t.clamp(-1.0, 1.0) as f32;
    let rest = 1.0 - t.abs();
    [
        if t > 0.0 { 1.0 } else { rest },
        rest,
        if t < 0.0 { 1.0 } else { rest },
    ]
    .map(|v| 0.9 * v)
}
