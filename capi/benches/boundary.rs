//! What the interface costs: the same queries through the shared library and in Rust, in turns, in one run.
//! `cargo build --release && cargo bench --bench boundary`, or with the path of the library in WELKIN_LIBRARY.

use std::hint::black_box;
use std::path::PathBuf;
use std::ptr::null_mut;
use std::time::Instant;

use libloading::{Library, Symbol};
use library::{BakedSky, Budget, Channels, ColourSpace, Conditions, Directions, Model};
use welkin::*;

const COUNT: usize = 4096;
const ROUNDS: usize = 41;

type Error = *mut WelkinError;

/// A function of the shared library, which must have this type.
fn find<'a, T>(library: &'a Library, name: &str) -> Symbol<'a, T> {
    // SAFETY: the types below are those of the functions.
    unsafe { library.get(name.as_bytes()).unwrap() }
}

macro_rules! symbol {
    ($library:ident, $name:ident: fn($($argument:ty),*) -> $result:ty) => {
        let $name = find::<unsafe extern "C" fn($($argument),*) -> $result>(&$library, stringify!($name));
    };
}

/// The path of the shared library.
fn path() -> PathBuf {
    if let Some(path) = std::env::var_os("WELKIN_LIBRARY") {
        return path.into();
    }
    // Benches lie in `release/deps`.
    let own = std::env::current_exe().unwrap();
    own.ancestors()
        .nth(2)
        .unwrap()
        .join(libloading::library_filename("welkin"))
}

/// Nanoseconds per query: the median of the rounds.
fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Times both in turns and prints them with their ratio.
fn compare(name: &str, queries: usize, mut through: impl FnMut(), mut rust: impl FnMut()) {
    let time = |body: &mut dyn FnMut()| {
        let start = Instant::now();
        body();
        start.elapsed().as_secs_f64() * 1e9 / queries as f64
    };
    let (mut a, mut b) = (Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        a.push(time(&mut through));
        b.push(time(&mut rust));
    }
    let [a, b] = [a, b].map(median);
    println!("{name:<34} {a:9.1} ns {b:9.1} ns {:7.2}", a / b);
}

fn main() {
    // SAFETY: a library of this package.
    let so = unsafe { Library::new(path()) }.expect("cargo build --release comes first");
    symbol!(so, welkin_model_default: fn(*mut *mut WelkinModel, Error) -> i32);
    symbol!(so, welkin_conditions_init: fn(*mut WelkinConditions, u64, Error) -> i32);
    symbol!(so, welkin_sky_new: fn(*mut WelkinModel, *const WelkinConditions, *mut *mut WelkinSky, Error) -> i32);
    symbol!(so, welkin_sky_bake: fn(*mut WelkinSky, f64, *mut *mut WelkinBakedSky, Error) -> i32);
    symbol!(so, welkin_sky_bake_colour: fn(*mut WelkinSky, f64, *mut *mut WelkinBakedColourSky, Error) -> i32);
    type Colour = *mut WelkinBakedColourSky;
    symbol!(so, welkin_baked_colour_sky_rgb: fn(Colour, *const f32, i32, *mut f32, Error) -> i32);
    symbol!(so, welkin_baked_colour_sky_rgb_batch: fn(Colour, *const f32, usize, i32, *mut f32, Error) -> i32);
    type Floats = *const f32;
    symbol!(so, welkin_baked_colour_sky_rgb_soa:
        fn(Colour, Floats, Floats, Floats, usize, i32, *mut f32, Error) -> i32);
    type Spectral = *mut WelkinBakedSky;
    symbol!(so, welkin_baked_sky_radiance: fn(Spectral, *const f32, *mut f32, usize, Error) -> i32);
    symbol!(so, welkin_baked_sky_radiance_soa:
        fn(Spectral, Floats, Floats, Floats, usize, *mut f32, usize, Error) -> i32);
    symbol!(so, welkin_baked_sky_hero: fn(Spectral, *const f32, *const f32, *mut f32, Error) -> i32);
    symbol!(so, welkin_model_plan: fn(*mut WelkinModel, *const WelkinBudget, *mut *mut WelkinPlan, Error) -> i32);
    symbol!(so, welkin_point_query_new:
        fn(*mut WelkinModel, *mut WelkinPlan, *mut *mut WelkinPointQuery, Error) -> i32);
    symbol!(so, welkin_point_query_radiance:
        fn(*mut WelkinPointQuery, *const WelkinConditions, *const f32, *mut f32, usize, Error) -> i32);

    let mut error = WelkinError {
        status: 0,
        text: [0; 256],
    };
    let e = &raw mut error;
    let own = Conditions::default();
    let model_r = Model::default_model().unwrap();
    let sky_r = model_r.sky(&own).unwrap();
    let spectral_r = sky_r.bake(BakedSky::TOLERANCE).unwrap();
    let colour_r = sky_r.bake_colour(BakedSky::TOLERANCE).unwrap();
    let budget = WelkinBudget {
        struct_size: size_of::<WelkinBudget>() as u64,
        altitude: [0.0, 100.0],
        visibility: [50e3, 70e3],
        solar_elevation: [0.1, 0.5],
        tolerance: BakedSky::TOLERANCE,
        channels: WELKIN_CHANNELS_SPECTRAL,
        reserved: 0,
    };
    let plan_r = model_r
        .plan(&Budget {
            altitude: budget.altitude,
            visibility: budget.visibility,
            solar_elevation: budget.solar_elevation,
            tolerance: budget.tolerance,
            channels: Channels::Spectral,
        })
        .unwrap();
    let query_r = model_r.point_query(&plan_r).unwrap();

    let (mut model, mut sky, mut spectral) = (null_mut(), null_mut(), null_mut());
    let (mut colour, mut plan, mut query) = (null_mut(), null_mut(), null_mut());
    // SAFETY: a struct of numbers, filled below.
    let mut given: WelkinConditions = unsafe { std::mem::zeroed() };
    // SAFETY: all pointers are those of this function.
    unsafe {
        let statuses = [
            welkin_conditions_init(&mut given, size_of::<WelkinConditions>() as u64, e),
            welkin_model_default(&mut model, e),
            welkin_sky_new(model, &given, &mut sky, e),
            welkin_sky_bake(sky, BakedSky::TOLERANCE, &mut spectral, e),
            welkin_sky_bake_colour(sky, BakedSky::TOLERANCE, &mut colour, e),
            welkin_model_plan(model, &budget, &mut plan, e),
            welkin_point_query_new(model, plan, &mut query, e),
        ];
        assert_eq!(statuses, [0; 7]);
    }

    let directions: Vec<[f32; 3]> = (0..COUNT)
        .map(|i| [0.7, 1.1, 0.9].map(|k: f32| (k * i as f32 + 0.3).sin()))
        .collect();
    let [x, y, z] = [0, 1, 2].map(|c| directions.iter().map(|d| d[c]).collect::<Vec<f32>>());
    let soa = Directions {
        x: &x,
        y: &y,
        z: &z,
    };
    let flat = directions.as_flattened().as_ptr();
    let n = model_r.wavelengths().len();
    let [mut a, mut b] = [(); 2].map(|()| vec![0f32; COUNT * n]);
    let [mut rgb_a, mut rgb_b] = [(); 2].map(|()| vec![[0f32; 3]; COUNT]);
    let heroes = [430.0, 510.0, 590.0, 670.0];
    let srgb = ColourSpace::Srgb;

    println!(
        "{:<34} {:>12} {:>12} {:>7}",
        "one direction", "C interface", "Rust", "ratio"
    );
    // SAFETY (of all below): handles are alive and arrays as long as is said.
    compare(
        "baked RGB, single",
        COUNT,
        || {
            for (d, out) in directions.iter().zip(&mut rgb_a) {
                // SAFETY: as above.
                black_box(unsafe {
                    welkin_baked_colour_sky_rgb(colour, d.as_ptr(), 0, out.as_mut_ptr(), e)
                });
            }
        },
        || {
            for (d, out) in directions.iter().zip(&mut rgb_b) {
                *out = black_box(colour_r.rgb(*d, srgb)).unwrap();
            }
        },
    );
    assert_eq!(rgb_a, rgb_b);
    compare(
        "baked RGB, batch of three arrays",
        COUNT,
        || {
            let out = rgb_a.as_mut_ptr().cast();
            // SAFETY: as above.
            let status = unsafe {
                welkin_baked_colour_sky_rgb_soa(
                    colour,
                    x.as_ptr(),
                    y.as_ptr(),
                    z.as_ptr(),
                    COUNT,
                    0,
                    out,
                    e,
                )
            };
            assert_eq!(status, 0);
        },
        || colour_r.rgb_batch(&soa, srgb, &mut rgb_b).unwrap(),
    );
    compare(
        "baked RGB, interleaved batch",
        COUNT,
        || {
            let out = rgb_a.as_mut_ptr().cast();
            // SAFETY: as above.
            let status =
                unsafe { welkin_baked_colour_sky_rgb_batch(colour, flat, COUNT, 0, out, e) };
            assert_eq!(status, 0);
        },
        || colour_r.rgb_batch(&soa, srgb, &mut rgb_b).unwrap(),
    );
    assert_eq!(rgb_a, rgb_b);
    compare(
        "baked spectrum, single",
        COUNT,
        || {
            for (d, out) in directions.iter().zip(a.chunks_mut(n)) {
                // SAFETY: as above.
                black_box(unsafe {
                    welkin_baked_sky_radiance(spectral, d.as_ptr(), out.as_mut_ptr(), n, e)
                });
            }
        },
        || {
            for (d, out) in directions.iter().zip(b.chunks_mut(n)) {
                black_box(spectral_r.radiance(*d, out)).unwrap();
            }
        },
    );
    assert_eq!(a, b);
    compare(
        "baked spectrum, three arrays",
        COUNT,
        || {
            let (xp, yp, zp) = (x.as_ptr(), y.as_ptr(), z.as_ptr());
            // SAFETY: as above.
            let status = unsafe {
                welkin_baked_sky_radiance_soa(
                    spectral,
                    xp,
                    yp,
                    zp,
                    COUNT,
                    a.as_mut_ptr(),
                    COUNT * n,
                    e,
                )
            };
            assert_eq!(status, 0);
        },
        || spectral_r.radiance_batch(&soa, &mut b).unwrap(),
    );
    let [mut hero_a, mut hero_b] = [(); 2].map(|()| vec![[0f32; 4]; COUNT]);
    compare(
        "four hero wavelengths, single",
        COUNT,
        || {
            for (d, out) in directions.iter().zip(&mut hero_a) {
                // SAFETY: as above.
                black_box(unsafe {
                    welkin_baked_sky_hero(
                        spectral,
                        d.as_ptr(),
                        heroes.as_ptr(),
                        out.as_mut_ptr(),
                        e,
                    )
                });
            }
        },
        || {
            for (d, out) in directions.iter().zip(&mut hero_b) {
                *out = black_box(spectral_r.hero(*d, heroes)).unwrap();
            }
        },
    );
    assert_eq!(hero_a, hero_b);
    let few = COUNT / 8;
    compare(
        "point query",
        few,
        || {
            for (d, out) in directions[..few].iter().zip(a.chunks_mut(n)) {
                let out = out.as_mut_ptr();
                // SAFETY: as above.
                black_box(unsafe {
                    welkin_point_query_radiance(query, &given, d.as_ptr(), out, n, e)
                });
            }
        },
        || {
            for (d, out) in directions[..few].iter().zip(b.chunks_mut(n)) {
                black_box(query_r.radiance(&own, *d, out)).unwrap();
            }
        },
    );
    assert_eq!(a[..few * n], b[..few * n]);
}
