//! The examples of README.md and the book, run; and a check that they are those.
#![cfg(feature = "default-model")]

use welkin::Albedo;
use welkin::Response;
use welkin::{BakedSky, Budget, Channels, Directions, PointQuery};
use welkin::{Conditions, Model, PolarisationFrame};

/// Code without comments, spaces, and the commas that a formatter adds.
fn compact(code: &str) -> String {
    let lines = code.lines().map(|line| line.split("//").next().unwrap());
    let text: String = lines
        .flat_map(str::chars)
        .filter(|c| !c.is_whitespace())
        .collect();
    text.replace(",)", ")").replace(",}", "}")
}

#[test]
fn every_rust_example_is_run_here() {
    let here = compact(include_str!("readme.rs"));
    let pages = std::fs::read_dir("docs").unwrap();
    let mut pages: Vec<_> = pages.map(|entry| entry.unwrap().path()).collect();
    pages.retain(|path| path.extension().is_some_and(|e| e == "md"));
    pages.push("README.md".into());
    let mut blocks = 0;
    for path in pages {
        let page = std::fs::read_to_string(&path).unwrap();
        for block in page.split("```rust\n").skip(1) {
            blocks += 1;
            let code = block.split("```").next().unwrap();
            for statement in compact(code).split_inclusive(';') {
                assert!(here.contains(statement), "{path:?}, not run: {statement}");
            }
        }
    }
    assert!(blocks >= 4);
}

#[test]
fn first_page() -> welkin::Result<()> {
    use welkin::{BakedSky, Conditions, Model};

    let model = Model::default_model()?;
    let sky = model.colour_sky(&Conditions {
        solar_elevation: 5f64.to_radians(),
        visibility: 40e3,
        altitude: 120.0,
        ..Conditions::default()
    })?;
    let baked = sky.bake(BakedSky::TOLERANCE)?;
    let rgb = baked.linear_srgb([0.3, 0.1, 0.9])?;
    assert!(rgb[2] > rgb[0] && rgb[0] > 0.0);
    Ok(())
}

#[test]
fn getting_started() -> welkin::Result<()> {
    let camera_up = [0.0, 0.0, 1.0];

    let model = Model::default_model()?;
    let sky = model.sky(&Conditions {
        solar_elevation: 5f64.to_radians(),
        visibility: 40e3,
        altitude: 120.0,
        ..Conditions::default()
    })?;
    let mut radiance = vec![0.0; sky.wavelengths().len()];
    sky.radiance([0.3, 0.1, 0.9], &mut radiance)?;
    let rgb = sky.linear_srgb([0.3, 0.1, 0.9])?;
    assert!(rgb[2] > rgb[0] && radiance.iter().all(|&r| r > 0.0));

    let sky = model.polarised_sky(&Conditions::default())?;
    let light = sky.stokes_at([0.3, 0.1, 0.9], PolarisationFrame::Axis(camera_up), 550.0)?;
    let (degree, angle) = (light.degree(), light.angle());
    assert!((0.05..1.0).contains(&degree) && angle.is_finite());
    Ok(())
}

#[test]
fn which_type() -> welkin::Result<()> {
    let model = Model::default_model()?;
    let conditions = Conditions::default();
    let sky = model.sky(&conditions)?;
    let polarised_sky = model.polarised_sky(&Conditions::default())?;
    let directions = Directions {
        x: &[0.3, 0.0],
        y: &[0.1, 0.0],
        z: &[0.9, 1.0],
    };
    let mut radiance = vec![0.0; directions.x.len() * sky.wavelengths().len()];
    let budget = Budget {
        altitude: [0.0, 100.0],
        visibility: [40e3, 60e3],
        solar_elevation: [0.1, 1.0],
        tolerance: BakedSky::TOLERANCE,
        channels: Channels::Stokes,
    };

    let baked = sky.bake(BakedSky::TOLERANCE)?;
    baked.radiance_batch(&directions, &mut radiance)?;
    let stokes = polarised_sky.bake(BakedSky::TOLERANCE)?;
    let colour = model.colour_sky(&conditions)?.bake(BakedSky::TOLERANCE)?;
    let disc = model.solar_disc(&conditions)?;
    let sampler = colour.sampler().with_sun(&disc);
    let query = PointQuery::new(welkin::DEFAULT_MODEL)?;
    let mut other = vec![0.0; query.wavelengths().len()];
    query.radiance(&conditions, [0.0, 0.0, 1.0], &mut other)?;
    assert!(other.iter().all(|&r| r > 0.0));
    let plan = model.plan(&budget)?;
    let query = model.polarised_point_query(&plan)?;
    let frame = PolarisationFrame::Axis([0.0, 1.0, 0.0]);
    let light = query.stokes_at(&conditions, [0.3, 0.1, 0.9], frame, 550.0)?;
    assert!((0.05..1.0).contains(&light.degree()));

    assert!(radiance.iter().all(|&r| r > 0.0));
    assert!(baked.bytes() > colour.bytes() && stokes.bytes() > baked.bytes());
    assert!(sampler.bytes() > 0);
    assert!(plan.file_bytes < welkin::DEFAULT_MODEL.len());
    Ok(())
}

#[test]
fn bands() -> welkin::Result<()> {
    let model = Model::default_model()?;
    let conditions = Conditions::default();

    let red = Response::table(&[580.0, 620.0, 680.0], &[0.0, 1.0, 0.0])?;
    let line = Response::wavelength(550.0);
    let bands = model.bands(&[red.normalised(), line])?;

    let sky = model.band_sky(&conditions, &bands)?;
    let mut values = [0.0; 2];
    sky.radiance([0.0, 0.0, 1.0], &mut values)?;
    let baked = sky.bake(BakedSky::TOLERANCE)?;
    let polarised = model.polarised_band_sky(&conditions, &bands)?;
    let aerial = model.band_aerial_perspective(&conditions, &bands)?;
    let air = model.band_transmittance(40e3, &bands)?;
    let disc = model.band_solar_disc(&conditions, &bands)?;
    let mut fast = [0.0; 2];
    baked.radiance([0.0, 0.0, 1.0], &mut fast)?;
    assert!((fast[0] / values[0] - 1.0).abs() < 0.01);
    assert_eq!(
        [polarised.bands(), aerial.bands(), air.bands(), disc.bands()],
        [2; 4]
    );

    let colour = model.colour_sky(&conditions)?.bake(BakedSky::TOLERANCE)?;
    assert!(colour.bytes() > 0);
    Ok(())
}

#[test]
fn finite_distances() -> welkin::Result<()> {
    let model = Model::default_model()?;
    let conditions = Conditions::default();
    let sky = model.sky(&conditions)?;
    let (camera, point, camera_up) = ([0.0; 3], [9e3, 1e3, 500.0], [0.0, 0.0, 1.0]);
    let points = [point, [0.0, 0.0, 2e3]];
    let n = model.wavelengths().len();
    let [mut in_scattering, mut transmittance] = [(); 2].map(|()| vec![0.0; points.len() * n]);

    let aerial = model.aerial_perspective(&conditions)?;
    aerial.in_scattering_batch(camera, &points, &mut in_scattering, &mut transmittance)?;
    let (light, factors) = aerial.linear_srgb(camera, point)?;
    assert!(light[2] > 0.0 && factors[0] > factors[2]);
    let (light, factors) = aerial.joined_to(&sky)?.linear_srgb(point)?;
    assert!(light[2] > 0.0 && factors[0] > factors[2]);
    let frame = PolarisationFrame::Axis(camera_up);
    let (light, factors) = aerial.linear_srgb_stokes(camera, point, frame)?;
    assert!(light[2].through_polariser(0.0) > 0.0 && factors[0] > factors[2]);
    assert!(in_scattering.iter().chain(&transmittance).all(|&x| x > 0.0));

    let [mut light, mut transmittance] = [(); 2].map(|()| vec![0.0; n]);
    let mut aerial = model.aerial_perspective_query()?;
    aerial.in_scattering(&conditions, camera, point, &mut light, &mut transmittance)?;
    assert!(light.iter().chain(&transmittance).all(|&x| x > 0.0));
    Ok(())
}

#[test]
fn a_ground_with_a_spectrum() -> welkin::Result<()> {
    let model = Model::default_model()?;
    let conditions = Conditions::default();

    let grass = Albedo::table(&[450.0, 550.0, 670.0, 750.0], &[0.04, 0.10, 0.05, 0.45])?;
    let meadow = model.over(&grass);
    let sky = meadow.sky(&conditions)?;
    let colour = meadow.colour_sky(&conditions)?;

    let up = [0.0, 0.0, 1.0];
    let grey = model.sky(&Conditions {
        albedo: 0.45,
        ..conditions
    })?;
    let ratio = sky.radiance_at(up, 750.0)? / grey.radiance_at(up, 750.0)?;
    assert!((ratio - 1.0).abs() < 1e-4, "{ratio}");
    assert!(colour.xyz(up)?[1] > 0.0);
    Ok(())
}
