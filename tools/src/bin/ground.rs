//! What a grey ground gets wrong: `ground` compares skies over grass, sand and snow with skies over a grey ground that
//! sends as much luminance up. Errors at wavelengths are medians and the largest over directions, of the sky and of the
//! air before a thing 20 km away; colours differ by ΔE00, exposed so that the brighter is half as bright as white.

use palette::color_difference::Ciede2000;
use palette::white_point::D65;
use palette::{FromColor, Lab, Xyz};
use welkin::{Albedo, Conditions, Model, Result, Sky};

/// Typical of green vegetation, dry sand and fresh snow: wavelengths, nm, and albedos.
const GROUNDS: [(&str, &[[f64; 2]]); 3] = [
    (
        "grass",
        &[
            [400.0, 0.03],
            [450.0, 0.035],
            [500.0, 0.04],
            [520.0, 0.06],
            [550.0, 0.105],
            [580.0, 0.075],
            [630.0, 0.055],
            [670.0, 0.04],
            [690.0, 0.05],
            [700.0, 0.09],
            [720.0, 0.25],
            [740.0, 0.41],
            [760.0, 0.45],
            [800.0, 0.47],
            [1000.0, 0.49],
        ],
    ),
    (
        "sand",
        &[
            [350.0, 0.09],
            [400.0, 0.12],
            [450.0, 0.16],
            [500.0, 0.22],
            [550.0, 0.28],
            [600.0, 0.34],
            [700.0, 0.40],
            [1000.0, 0.50],
        ],
    ),
    (
        "snow",
        &[
            [350.0, 0.98],
            [500.0, 0.98],
            [600.0, 0.97],
            [700.0, 0.94],
            [800.0, 0.89],
            [900.0, 0.84],
            [1000.0, 0.72],
            [1100.0, 0.68],
        ],
    ),
];
const WAVELENGTHS: [f64; 8] = [350.0, 400.0, 450.0, 550.0, 650.0, 700.0, 750.0, 900.0];
const SUNS: [f64; 3] = [5.0, 30.0, 60.0];

fn main() -> Result<()> {
    let model = Model::default_model()?;
    for (name, samples) in GROUNDS {
        let [wavelengths, shares] =
            [0, 1].map(|k| samples.iter().map(|s| s[k]).collect::<Vec<_>>());
        let albedo = Albedo::table(&wavelengths, &shares)?;
        let over = model.over(&albedo);
        for sun in SUNS {
            let conditions = Conditions {
                solar_elevation: f64::to_radians(sun),
                ..Conditions::default()
            };
            report(name, &model, &over, &conditions)?;
        }
    }
    Ok(())
}

fn report(name: &str, model: &Model, over: &Model, conditions: &Conditions) -> Result<()> {
    let sky = over.sky(conditions)?;
    let grey = Conditions {
        albedo: grey(model, over, conditions)?,
        ..*conditions
    };
    let plain = model.sky(&grey)?;
    let sun = conditions.solar_elevation.to_degrees();
    println!("{name}, sun {sun:.0}°: grey {:.3}", grey.albedo);
    let air = over.aerial_perspective(conditions)?;
    let plain_air = model.aerial_perspective(&grey)?;
    for wavelength in WAVELENGTHS {
        let off = |[got, wanted]: [f32; 2]| 100.0 * f64::from(got / wanted - 1.0);
        let mut errors = Vec::new();
        for view in views() {
            let [a, b] = [&plain, &sky].map(|sky| sky.radiance_at(view, wavelength));
            errors.push(off([a?, b?]));
        }
        errors.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
        let (from, to) = ([0.0, 0.0, 2.0], [0.0, 20e3, 200.0]);
        let [a, b] = [&plain_air, &air].map(|air| air.in_scattering_at(from, to, wavelength));
        println!(
            "  {wavelength:6.0} nm: sky median {:+6.2} %, largest {:+6.2} %; air of 20 km {:+6.2} %",
            errors[errors.len() / 2],
            errors[errors.len() - 1],
            off([a?, b?]),
        );
    }
    let mut differences = Vec::new();
    for view in views() {
        differences.push(difference(&plain, &sky, view)?);
    }
    differences.sort_by(f32::total_cmp);
    let (middle, last) = (differences.len() / 2, differences.len() - 1);
    println!(
        "  colour of the sky: ΔE00 median {:.2}, largest {:.2}",
        differences[middle], differences[last]
    );
    Ok(())
}

/// The grey albedo that reflects as much luminance of sunlight.
fn grey(model: &Model, over: &Model, conditions: &Conditions) -> Result<f64> {
    let head = model.head();
    let mut light = vec![0.0; head.wavelengths.len()];
    let direct = model.solar_disc(conditions)?;
    direct.irradiance(direct.direction(), &mut light)?;
    let albedos = over.albedos_in_colours()?.unwrap_or_default();
    let (mut reflected, mut whole) = (0.0, 0.0);
    for (i, wavelength) in head.wavelengths.iter().enumerate() {
        let sun = head.solar_irradiance_at(*wavelength).max(f64::MIN_POSITIVE);
        let y = head.xyz[i][1] * f64::from(light[i]) / sun;
        reflected += y * albedos[i];
        whole += y;
    }
    Ok(reflected / whole)
}

/// Directions all over the upper half, at equal solid angles.
fn views() -> impl Iterator<Item = [f32; 3]> {
    const COUNT: usize = 200;
    (0..COUNT).map(|i| {
        let z = (i as f64 + 0.5) / COUNT as f64;
        let (y, x) = (2.399_963 * i as f64).sin_cos();
        let level = (1.0 - z * z).sqrt();
        [level * x, level * y, z].map(|v| v as f32)
    })
}

fn difference(a: &Sky, b: &Sky, view: [f32; 3]) -> Result<f32> {
    let [a, b] = [a.xyz(view)?, b.xyz(view)?];
    let scale = 0.5 / a[1].max(b[1]);
    let [a, b] = [a, b].map(|xyz| {
        let [x, y, z] = xyz.map(|v| v * scale);
        Lab::<D65, f32>::from_color(Xyz::<D65, f32>::new(x, y, z))
    });
    Ok(a.difference(b))
}
