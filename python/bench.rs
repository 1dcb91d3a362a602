//! What the calls that `bench.py` times take in Rust alone, on one thread, and the values that they give.
//!
//! `bench times` prints milliseconds, `bench values` single-precision numbers, a line for each call. Python reads both.

use std::error::Error;
use std::time::Instant;

use welkin::{
    BakedSky, ColourSpace, Conditions, Directions, Model, PointQuery, PolarisationFrame, Response,
    StokesSpectra,
};

const HEIGHT: usize = 256;
const ROUNDS: usize = 7;
const BANDS: [f64; 12] = [
    390.0, 420.0, 450.0, 480.0, 510.0, 540.0, 570.0, 600.0, 630.0, 660.0, 690.0, 720.0,
];

fn main() -> Result<(), Box<dyn Error>> {
    match std::env::args().nth(1).as_deref() {
        Some("times") => each_call(HEIGHT, |name, call| {
            let best = (0..ROUNDS).map(|_| timed(call));
            let best = best.collect::<Result<Vec<_>, _>>()?;
            let least = best.into_iter().fold(f64::INFINITY, f64::min);
            println!("{name} {least}");
            Ok(())
        }),
        Some("values") => each_call(8, |name, call| {
            let values: Vec<_> = call()?.iter().map(f32::to_string).collect();
            println!("{name} {}", values.join(" "));
            Ok(())
        }),
        _ => Err("usage: bench times|values".into()),
    }
}

type Call<'a> = &'a dyn Fn() -> welkin::Result<Vec<f32>>;

fn timed(call: Call) -> Result<f64, Box<dyn Error>> {
    let start = Instant::now();
    std::hint::black_box(call()?);
    Ok(1e3 * start.elapsed().as_secs_f64())
}

/// Hands over each call with its name; each gives all of an image of `height` rows.
fn each_call(
    height: usize,
    mut with: impl FnMut(&str, Call) -> Result<(), Box<dyn Error>>,
) -> Result<(), Box<dyn Error>> {
    let model = Model::default_model()?;
    let conditions = Conditions::default();
    let rays = lat_long(height);
    let [x, y, z] = [0, 1, 2].map(|i| rays.iter().map(|ray| ray[i]).collect::<Vec<_>>());
    let apart = Directions {
        x: &x,
        y: &y,
        z: &z,
    };
    let room = |width: usize| vec![0.0; rays.len() * width];

    let sky = model.sky(&conditions)?;
    let width = sky.wavelengths().len();
    with("sky", &|| {
        let mut out = room(width);
        sky.radiance_batch(&rays, &mut out)?;
        Ok(out)
    })?;
    let baked = sky.bake(BakedSky::TOLERANCE)?;
    with("baked", &|| {
        let mut out = room(width);
        baked.radiance_batch(&apart, &mut out)?;
        Ok(out)
    })?;
    let bands = model.bands(&BANDS.map(Response::wavelength))?;
    let bands = model
        .band_sky(&conditions, &bands)?
        .bake(BakedSky::TOLERANCE)?;
    with("bands", &|| {
        let mut out = room(BANDS.len());
        bands.radiance_batch(&apart, &mut out)?;
        Ok(out)
    })?;
    let colour = model.colour_sky(&conditions)?.bake(BakedSky::TOLERANCE)?;
    with("rgb", &|| {
        let mut out = room(3);
        colour.rgb_batch(&apart, ColourSpace::Srgb, out.as_chunks_mut().0)?;
        Ok(out)
    })?;
    let polarised = model
        .polarised_sky(&conditions)?
        .bake(BakedSky::TOLERANCE)?;
    with("stokes", &|| {
        let [mut i, mut q, mut u] = [room(width), room(width), room(width)];
        let (i_out, q_out, u_out) = (&mut i, &mut q, &mut u);
        let out = StokesSpectra {
            i: i_out,
            q: q_out,
            u: u_out,
        };
        polarised.stokes_batch(&apart, PolarisationFrame::Vertical, out)?;
        let mut all = room(3 * width);
        for (k, row) in all.chunks_exact_mut(3 * width).enumerate() {
            for (part, plane) in row.chunks_exact_mut(width).zip([&i, &q, &u]) {
                part.copy_from_slice(&plane[k * width..][..width]);
            }
        }
        Ok(all)
    })?;
    let query = PointQuery::new(welkin::DEFAULT_MODEL)?;
    with("general", &|| {
        let mut out = room(width);
        for (ray, row) in rays.iter().zip(out.chunks_exact_mut(width)) {
            query.radiance(&conditions, *ray, row)?;
        }
        Ok(out)
    })
}

/// As `welkin_sky.lat_long`.
fn lat_long(height: usize) -> Vec<[f32; 3]> {
    use std::f64::consts::PI;
    let step = PI / height as f64;
    let rows = (0..height).flat_map(|row| (0..2 * height).map(move |column| (row, column)));
    rows.map(|(row, column)| {
        let elevation = PI / 2.0 - (row as f64 + 0.5) * step;
        let azimuth = PI - (column as f64 + 0.5) * step;
        let level = elevation.cos();
        [
            level * azimuth.cos(),
            level * azimuth.sin(),
            elevation.sin(),
        ]
        .map(|v| v as f32)
    })
    .collect()
}
