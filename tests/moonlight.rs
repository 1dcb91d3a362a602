//! Skies in moonlight: against the light of the moon itself and against a published model of their brightness.

mod common;

use common::direction;
use welkin::{Budget, Channels, Conditions, Model, Moon, PolarisationFrame, Stokes};

const LINES: [[f64; 2]; 5] = [
    [90.0, 0.0],
    [45.0, 90.0],
    [20.0, 180.0],
    [60.0, 30.0],
    [8.0, 120.0],
];

fn model() -> Model {
    Model::default_model().unwrap()
}

fn moon(elevation: f64, phase_angle: f64) -> Moon {
    Moon {
        elevation: elevation.to_radians(),
        phase_angle: phase_angle.to_radians(),
        ..Moon::default()
    }
}

fn ray([elevation, azimuth]: [f64; 2]) -> [f32; 3] {
    direction(elevation.to_radians(), azimuth.to_radians())
}

#[test]
fn spectra_are_those_of_the_sun_times_the_reflectance_of_the_moon() {
    let (model, moon) = (model(), moon(35.0, 40.0));
    let conditions = moon.conditions(&Conditions::default());
    let by_day = model.sky(&conditions).unwrap();
    let by_night = model.moonlit(&moon).unwrap().sky(&conditions).unwrap();
    let relative = moon.relative_irradiance().unwrap();
    for line in LINES.map(ray) {
        for wavelength in [312.0, 400.0, 555.5, 687.0, 1000.0] {
            let expected =
                by_day.radiance_at(line, wavelength).unwrap() * relative(wavelength) as f32;
            let got = by_night.radiance_at(line, wavelength).unwrap();
            assert!(
                (got / expected - 1.0).abs() < 1e-3,
                "{wavelength}: {got} {expected}"
            );
        }
    }
}

/// Point queries of a moonlit model, with Stokes vectors and without, are in the light of the moon, too.
#[test]
fn point_queries_are_by_the_moon() {
    let (model, moon) = (model(), moon(35.0, 40.0));
    let conditions = moon.conditions(&Conditions::default());
    let moonlit = model.moonlit(&moon).unwrap();
    let sky = moonlit.sky(&conditions).unwrap();
    let plan = |channels| {
        let budget = Budget {
            altitude: [0.0, 100.0],
            visibility: [50e3, 70e3],
            solar_elevation: [-0.05, 1.5],
            tolerance: 0.01,
            channels,
        };
        moonlit.plan(&budget).unwrap()
    };
    let n = model.wavelengths().len();
    let [mut expected, mut got] = [(); 2].map(|()| vec![0.0; n]);
    let mut vectors = vec![Stokes::default(); n];
    let near = |got: &[f32], expected: &[f32]| {
        for (got, expected) in got.iter().zip(expected) {
            assert!((got / expected - 1.0).abs() < 1e-3, "{got} {expected}");
        }
    };
    let query = moonlit.point_query(&plan(Channels::Spectral)).unwrap();
    let stokes = moonlit
        .polarised_point_query(&plan(Channels::Stokes))
        .unwrap();
    for line in LINES.map(ray) {
        sky.radiance(line, &mut expected).unwrap();
        query.radiance(&conditions, line, &mut got).unwrap();
        near(&got, &expected);
        let light = stokes.stokes(&conditions, line, PolarisationFrame::Vertical, &mut vectors);
        light.unwrap();
        let intensities: Vec<f32> = vectors.iter().map(|light| light.i).collect();
        near(&intensities, &expected);
        let at = query.radiance_at(&conditions, line, 612.0).unwrap();
        near(&[at], &[sky.radiance_at(line, 612.0).unwrap()]);
    }
}

/// Colours, of which the weights are fitted to sunlight, against sums of the spectrum at every nanometre.
#[test]
fn colours_are_sums_of_the_spectrum() {
    let moon = moon(35.0, 40.0);
    let sky = model().moonlit(&moon).unwrap();
    let sky = sky.sky(&moon.conditions(&Conditions::default())).unwrap();
    let table = include_str!("../fitter/data/cie1931_2deg_1nm.csv");
    let rows: Vec<Vec<f64>> = table
        .lines()
        .filter_map(|line| line.split(',').map(|v| v.trim().parse().ok()).collect())
        .collect();
    assert!(rows.len() > 400);
    for line in LINES.map(ray) {
        let mut sum = [0.0; 3];
        for row in &rows {
            let radiance = f64::from(sky.radiance_at(line, row[0]).unwrap());
            sum = std::array::from_fn(|c| sum[c] + 683.0 * row[1 + c] * radiance);
        }
        for (got, expected) in sky.xyz(line).unwrap().iter().zip(sum) {
            let off = f64::from(*got) / expected - 1.0;
            assert!(off.abs() < 0.005, "{got} {expected}");
        }
    }
}

/// K. Krisciunas and B. E. Schaefer 1991, *A model of the brightness of moonlight*, PASP 103, 1033, equations 3, 15 and
/// 20 to 21: luminance in cd m⁻² (1 nL is 1/π 10⁻⁵ cd m⁻²), for a zenith angle, that of the moon, the angle between
/// them, and the extinction in magnitudes per air mass. They give it 8 to 23 %, and the zodiacal light is not in it.
fn krisciunas_schaefer(zenith: f64, moon: (f64, f64), between: f64, extinction: f64) -> f64 {
    let air = |z: f64| (1.0 - 0.96 * z.sin().powi(2)).powf(-0.5);
    let through = |z: f64| 10f64.powf(-0.4 * extinction * air(z));
    let (moon_zenith, phase) = moon;
    let outside = 10f64.powf(-0.4 * (3.84 + 0.026 * phase + 4e-9 * phase.powi(4)));
    let degrees = between.to_degrees();
    let scattered =
        10f64.powf(5.36) * (1.06 + between.cos().powi(2)) + 10f64.powf(6.15 - degrees / 40.0);
    let nanolamberts = scattered * outside * through(moon_zenith) * (1.0 - through(zenith));
    nanolamberts * 1e-5 / std::f64::consts::PI
}

/// That model is from Mauna Kea, with 0.172 magnitudes per air mass: so much or a little more as the clearest air of ours
/// has at the ground. Ours has as little particles up there that its sky is darker.
#[test]
fn moonlit_skies_are_as_bright_as_published_ones() {
    let model = model();
    let green = model
        .wavelengths()
        .iter()
        .position(|&l| l >= 545.0)
        .unwrap();
    let outside = model.head().solar_irradiance_at(model.wavelengths()[green]) as f32;
    for visibility in [131e3, 59.4e3] {
        let air = Conditions {
            solar_elevation: (-30f64).to_radians(),
            visibility,
            albedo: 0.1,
            ..Conditions::default()
        };
        let vertical = Conditions {
            solar_elevation: 1.57,
            ..air
        };
        let sun = model.solar_disc(&vertical).unwrap();
        let mut direct = vec![0.0; model.wavelengths().len()];
        sun.irradiance(sun.direction(), &mut direct).unwrap();
        let extinction = -2.5 * f64::from(direct[green] / outside).log10();
        let mut logarithms = Vec::new();
        for (elevation, phase) in [(45.0, 10.0), (45.0, 60.0), (70.0, 30.0), (25.0, 90.0)] {
            let moon = moon(elevation, phase);
            let sky = model.sky_with_moon(&air, &moon).unwrap();
            assert_eq!(sky.parts().len(), 1);
            for line in [[90.0, 0.0], [45.0, 90.0], [45.0, 180.0], [60.0, 60.0]] {
                let view = ray(line);
                let towards = moon.direction();
                let cosine: f64 = (0..3).map(|i| f64::from(view[i]) * towards[i]).sum();
                let expected = krisciunas_schaefer(
                    (90.0 - line[0]).to_radians(),
                    ((90.0 - elevation).to_radians(), phase),
                    cosine.acos(),
                    extinction,
                );
                let got = f64::from(sky.xyz(view).unwrap()[1]);
                logarithms.push((got / expected).ln());
            }
        }
        let mean = logarithms.iter().sum::<f64>() / logarithms.len() as f64;
        let worst = logarithms.iter().map(|l| l.abs()).fold(0.0, f64::max);
        assert!(mean.abs() < 0.2, "{visibility}: {}", mean.exp());
        assert!(worst < 0.25, "{visibility}: {}", worst.exp());
    }
}

#[test]
fn the_disc_is_evenly_bright_and_has_all_the_light() {
    let (model, moon) = (model(), moon(40.0, 0.0));
    let conditions = moon.conditions(&Conditions::default());
    let disc = model
        .moonlit(&moon)
        .unwrap()
        .solar_disc(&conditions)
        .unwrap();
    let sun = model.solar_disc(&conditions).unwrap();
    let relative = moon.relative_irradiance().unwrap();
    let n = model.wavelengths().len();
    let (mut direct, mut sunlight) = (vec![0.0; n], vec![0.0; n]);
    disc.irradiance(disc.direction(), &mut direct).unwrap();
    sun.irradiance(sun.direction(), &mut sunlight).unwrap();
    for (i, wavelength) in model.wavelengths().iter().enumerate() {
        let expected = sunlight[i] * relative(*wavelength) as f32;
        assert!((direct[i] / expected - 1.0).abs() < 2e-3);
    }
    let near_limb = (40.0 + 0.95 * welkin::SOLAR_ANGULAR_RADIUS.to_degrees()).to_radians();
    let (mut centre, mut limb) = (vec![0.0; n], vec![0.0; n]);
    disc.radiance(disc.direction(), &mut centre).unwrap();
    disc.radiance(direction(near_limb, 0.0), &mut limb).unwrap();
    // But for a little less air before the upper limb.
    assert!((0..n).all(|i| (0.999..1.1).contains(&(limb[i] / centre[i]))));
}

#[test]
fn lights_add_and_those_below_the_range_add_nothing() {
    let (model, moon) = (model(), moon(30.0, 20.0));
    let dusk = Conditions {
        solar_elevation: -2f64.to_radians(),
        ..Conditions::default()
    };
    let both = model.sky_with_moon(&dusk, &moon).unwrap();
    let [sun_sky, moon_sky] = both.parts() else {
        panic!("two skies");
    };
    let n = model.wavelengths().len();
    let (mut sum, mut one, mut other) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    for line in LINES.map(ray) {
        both.radiance(line, &mut sum).unwrap();
        sun_sky.radiance(line, &mut one).unwrap();
        moon_sky.radiance(line, &mut other).unwrap();
        assert!((0..n).all(|i| sum[i] == one[i] + other[i]));
        let [got, a, b] =
            [both.xyz(line), sun_sky.xyz(line), moon_sky.xyz(line)].map(Result::unwrap);
        assert!((0..3).all(|c| got[c] == a[c] + b[c]));
    }
    let night = Conditions {
        solar_elevation: -0.9,
        ..dusk
    };
    let set = Moon {
        elevation: -0.9,
        ..moon
    };
    let dark = model.sky_with_moon(&night, &set).unwrap();
    assert!(dark.parts().is_empty());
    assert_eq!(dark.linear_srgb([0.0, 0.0, 1.0]).unwrap(), [0.0; 3]);
    sum.fill(f32::NAN);
    dark.radiance([0.0, 0.0, 1.0], &mut sum).unwrap();
    assert!(sum.iter().all(|&v| v == 0.0));
    for bad in [[0.0; 3], [f32::NAN, 0.0, 1.0]] {
        assert_eq!(dark.xyz(bad).unwrap_err().class(), "direction");
        assert_eq!(both.xyz(bad).unwrap_err().class(), "direction");
    }
    assert_eq!(
        dark.radiance([0.0, 0.0, 1.0], &mut sum[1..])
            .unwrap_err()
            .class(),
        "length"
    );
    for bad in [
        Conditions {
            albedo: 2.0,
            ..night
        },
        Conditions {
            solar_elevation: f64::NAN,
            ..night
        },
    ] {
        assert_eq!(
            model.sky_with_moon(&bad, &set).unwrap_err().class(),
            "range"
        );
    }
}

/// Moonlight of a moonlit model is that of the other moon, not of both.
#[test]
fn a_moonlit_model_can_be_given_another_moon() {
    let model = model();
    let first = model.moonlit(&moon(10.0, 90.0)).unwrap();
    let again = first.moonlit(&moon(10.0, 5.0)).unwrap();
    let once = model.moonlit(&moon(10.0, 5.0)).unwrap();
    assert!(first.is_moonlit() && !model.is_moonlit());
    assert_eq!(again.head().solar_irradiance, once.head().solar_irradiance);
    assert_eq!(again.head().xyz, once.head().xyz);
}
