//! What comes through the interface is what the library says, bit for bit.

#![allow(
    clippy::macro_metavars_in_unsafe,
    reason = "the macros of the tests are such calls"
)]

mod common;

use std::ptr::{null, null_mut};

use common::{DIRECTIONS, conditions, default_model};
use library::{
    Albedo, BakedSky, Budget, CameraVolume, Channels, ColourSpace, Directions, Model, Moon,
    PolarisationFrame, Stokes, StokesSpectra,
};
use welkin::*;

const SPACES: [(i32, ColourSpace); 4] = [
    (WELKIN_SPACE_SRGB, ColourSpace::Srgb),
    (WELKIN_SPACE_REC2020, ColourSpace::Rec2020),
    (WELKIN_SPACE_ACESCG, ColourSpace::AcesCg),
    (WELKIN_SPACE_XYZ, ColourSpace::Xyz),
];

fn model() -> Model {
    Model::default_model().unwrap()
}

/// Components of directions as three arrays.
fn components(directions: &[[f32; 3]]) -> [Vec<f32>; 3] {
    [0, 1, 2].map(|c| directions.iter().map(|d| d[c]).collect())
}

/// More directions than a block of the interface.
fn many() -> Vec<[f32; 3]> {
    (0..300)
        .map(|i| [0.7, 1.1, 0.9].map(|k: f32| (k * i as f32 + 0.3).sin()))
        .collect()
}

fn frames() -> [(WelkinPolarisationFrame, PolarisationFrame); 3] {
    let of = |kind, axis| WelkinPolarisationFrame { kind, axis };
    [
        (
            of(WELKIN_FRAME_VERTICAL, [0.0; 3]),
            PolarisationFrame::Vertical,
        ),
        (
            of(WELKIN_FRAME_SUN_ALIGNED, [0.0; 3]),
            PolarisationFrame::SunAligned,
        ),
        (
            of(WELKIN_FRAME_AXIS, [0.1, 0.2, 1.0]),
            PolarisationFrame::Axis([0.1, 0.2, 1.0]),
        ),
    ]
}

fn stokes(values: &[WelkinStokes]) -> Vec<Stokes> {
    values
        .iter()
        .map(|&WelkinStokes { i, q, u }| Stokes { i, q, u })
        .collect()
}

/// Whether the bits are the same, NaNs included.
fn same(a: &[f32], b: &[f32]) {
    let bits = |v: &[f32]| v.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(a), bits(b));
}

#[test]
fn skies() {
    let (given, own) = conditions();
    let (model, library) = (default_model(), model());
    let sky = make!(welkin_sky_new(model, &given));
    let expected = library.sky(&own).unwrap();
    // SAFETY: the handles are alive.
    let n = unsafe { welkin_sky_wavelength_count(sky) };
    assert_eq!(n, expected.wavelengths().len());
    let mut nm = vec![0.0; n];
    good!(welkin_sky_wavelengths(sky, nm.as_mut_ptr(), n));
    assert_eq!(nm, expected.wavelengths());
    // SAFETY: the handles are alive.
    assert_eq!(unsafe { welkin_sky_bytes(sky) }, expected.bytes());
    let [mut got, mut wanted] = [(); 2].map(|()| vec![0.0; n]);
    for direction in DIRECTIONS {
        let d = direction.as_ptr();
        good!(welkin_sky_radiance(sky, d, got.as_mut_ptr(), n));
        expected.radiance(direction, &mut wanted).unwrap();
        same(&got, &wanted);
        good!(welkin_sky_relative_radiance(sky, d, got.as_mut_ptr(), n));
        expected.relative_radiance(direction, &mut wanted).unwrap();
        same(&got, &wanted);
        let mut one = 0.0;
        good!(welkin_sky_radiance_at(sky, d, 551.5, &mut one));
        same(&[one], &[expected.radiance_at(direction, 551.5).unwrap()]);
        let mut xyz = [0.0; 3];
        good!(welkin_sky_xyz(sky, d, xyz.as_mut_ptr()));
        same(&xyz, &expected.xyz(direction).unwrap());
        for (constant, space) in SPACES {
            good!(welkin_sky_rgb(sky, d, constant, xyz.as_mut_ptr()));
            same(&xyz, &space.from_xyz(expected.xyz(direction).unwrap()));
        }
    }
    let [mut got, mut wanted] = [(); 2].map(|()| vec![0.0; DIRECTIONS.len() * n]);
    let flat = DIRECTIONS.as_flattened().as_ptr();
    good!(welkin_sky_radiance_batch(
        sky,
        flat,
        DIRECTIONS.len(),
        got.as_mut_ptr(),
        got.len()
    ));
    expected.radiance_batch(&DIRECTIONS, &mut wanted).unwrap();
    same(&got, &wanted);
    // A sun that turns.
    good!(welkin_sky_set_solar_azimuth(sky, -0.7));
    let mut sun = [0.0; 3];
    good!(welkin_sky_sun_direction(sky, sun.as_mut_ptr()));
    let mut turned = expected.clone();
    turned.set_solar_azimuth(-0.7).unwrap();
    same(&sun, &turned.sun_direction());
    let mut back = given;
    good!(welkin_sky_conditions(sky, &mut back));
    assert_eq!(
        (back.solar_azimuth, back.visibility, back.albedo),
        (-0.7, own.visibility, own.albedo)
    );
    // SAFETY: freed once; the sky outlives its model.
    unsafe { welkin_model_free(model) };
    good!(welkin_sky_xyz(
        sky,
        DIRECTIONS[1].as_ptr(),
        sun.as_mut_ptr()
    ));
    same(&sun, &turned.xyz(DIRECTIONS[1]).unwrap());
    // SAFETY: freed once; null is none.
    unsafe {
        welkin_sky_free(sky);
        welkin_sky_free(null_mut());
    }
}

#[test]
fn baked_spectra() {
    let (given, own) = conditions();
    let (model, library) = (default_model(), model());
    let sky = make!(welkin_sky_new(model, &given));
    let baked = make!(welkin_sky_bake(sky, WELKIN_BAKE_TOLERANCE));
    let expected = library
        .sky(&own)
        .unwrap()
        .bake(BakedSky::TOLERANCE)
        .unwrap();
    let mut error = WelkinBakeError::default();
    good!(welkin_baked_sky_bake_error(baked, &mut error));
    assert_eq!(error, expected.bake_error().into());
    let n = expected.wavelengths().len();
    let [mut got, mut wanted] = [(); 2].map(|()| vec![0.0; n]);
    for direction in DIRECTIONS {
        good!(welkin_baked_sky_radiance(
            baked,
            direction.as_ptr(),
            got.as_mut_ptr(),
            n
        ));
        expected.radiance(direction, &mut wanted).unwrap();
        same(&got, &wanted);
        good!(welkin_baked_sky_irradiance(
            baked,
            direction.as_ptr(),
            got.as_mut_ptr(),
            n
        ));
        expected.irradiance(direction, &mut wanted).unwrap();
        same(&got, &wanted);
        let heroes = [400.0, 480.5, 551.0, 699.0];
        let mut four = [0.0; 4];
        good!(welkin_baked_sky_hero(
            baked,
            direction.as_ptr(),
            heroes.as_ptr(),
            four.as_mut_ptr()
        ));
        same(&four, &expected.hero(direction, heroes).unwrap());
    }
    let directions = many();
    let [x, y, z] = components(&directions);
    let [xp, yp, zp] = [&x, &y, &z].map(|c| c.as_ptr());
    let (soa, count) = (
        Directions {
            x: &x,
            y: &y,
            z: &z,
        },
        directions.len(),
    );
    let flat = directions.as_flattened().as_ptr();
    let [mut got, mut other, mut wanted] = [(); 3].map(|()| vec![0.0; count * n]);
    expected.radiance_batch(&soa, &mut wanted).unwrap();
    good!(welkin_baked_sky_radiance_batch(
        baked,
        flat,
        count,
        got.as_mut_ptr(),
        got.len()
    ));
    good!(welkin_baked_sky_radiance_soa(
        baked,
        xp,
        yp,
        zp,
        count,
        other.as_mut_ptr(),
        other.len()
    ));
    same(&got, &wanted);
    same(&other, &wanted);
    let heroes: Vec<[f32; 4]> = (0..count)
        .map(|i| [400.0, 500.0, 600.0, 700.0].map(|l| l + 0.1 * i as f32))
        .collect();
    let [mut got, mut other, mut wanted] = [(); 3].map(|()| vec![[0.0; 4]; count]);
    expected.hero_batch(&soa, &heroes, &mut wanted).unwrap();
    let wavelengths = heroes.as_flattened().as_ptr();
    good!(welkin_baked_sky_hero_batch(
        baked,
        flat,
        wavelengths,
        count,
        got.as_mut_ptr().cast()
    ));
    good!(welkin_baked_sky_hero_soa(
        baked,
        xp,
        yp,
        zp,
        wavelengths,
        count,
        other.as_mut_ptr().cast()
    ));
    same(got.as_flattened(), wanted.as_flattened());
    same(other.as_flattened(), wanted.as_flattened());
    // SAFETY: each is freed once.
    unsafe {
        welkin_sky_free(sky);
        welkin_baked_sky_free(baked);
        welkin_model_free(model);
    }
}

#[test]
fn baked_colours_and_draws() {
    let (given, own) = conditions();
    let (model, library) = (default_model(), model());
    let sky = make!(welkin_colour_sky_new(model, &given));
    let baked = make!(welkin_colour_sky_bake(sky, WELKIN_BAKE_TOLERANCE));
    let expected_sky = library.colour_sky(&own).unwrap();
    let expected = expected_sky.bake(BakedSky::TOLERANCE).unwrap();
    let like = make!(welkin_colour_sky_bake_like(sky, baked));
    let directions = many();
    let count = directions.len();
    let [x, y, z] = components(&directions);
    let [xp, yp, zp] = [&x, &y, &z].map(|c| c.as_ptr());
    let (soa, flat) = (
        Directions {
            x: &x,
            y: &y,
            z: &z,
        },
        directions.as_flattened().as_ptr(),
    );
    let mut rgb = [0.0; 3];
    for (constant, space) in SPACES {
        let [mut got, mut other, mut wanted] = [(); 3].map(|()| vec![[0.0; 3]; count]);
        expected.rgb_batch(&soa, space, &mut wanted).unwrap();
        good!(welkin_baked_colour_sky_rgb_batch(
            baked,
            flat,
            count,
            constant,
            got.as_mut_ptr().cast()
        ));
        good!(welkin_baked_colour_sky_rgb_soa(
            baked,
            xp,
            yp,
            zp,
            count,
            constant,
            other.as_mut_ptr().cast()
        ));
        same(got.as_flattened(), wanted.as_flattened());
        same(other.as_flattened(), wanted.as_flattened());
        for direction in DIRECTIONS {
            good!(welkin_baked_colour_sky_rgb(
                baked,
                direction.as_ptr(),
                constant,
                rgb.as_mut_ptr()
            ));
            same(&rgb, &expected.rgb(direction, space).unwrap());
            good!(welkin_baked_colour_sky_rgb(
                like,
                direction.as_ptr(),
                constant,
                rgb.as_mut_ptr()
            ));
            same(
                &rgb,
                &expected_sky
                    .bake_like(&expected)
                    .rgb(direction, space)
                    .unwrap(),
            );
            good!(welkin_colour_sky_rgb(
                sky,
                direction.as_ptr(),
                constant,
                rgb.as_mut_ptr()
            ));
            same(&rgb, &space.from_xyz(expected_sky.xyz(direction).unwrap()));
        }
    }
    let disc = make!(welkin_solar_disc_new(model, &given));
    let expected_disc = library.solar_disc(&own).unwrap();
    for (disc, sampler) in [
        (null(), expected.sampler()),
        (
            disc.cast_const(),
            expected.sampler().with_sun(&expected_disc),
        ),
    ] {
        let got = make!(welkin_baked_colour_sky_sampler(baked, disc));
        let points: Vec<[f32; 2]> = (0..200)
            .map(|i| [0.37, 0.73].map(|k: f32| (k * i as f32).fract()))
            .collect();
        let mut samples = vec![WelkinSample::default(); points.len()];
        let flat = points.as_flattened().as_ptr();
        good!(welkin_sky_sampler_sample_batch(
            got,
            flat,
            points.len(),
            samples.as_mut_ptr()
        ));
        for (point, sample) in points.iter().zip(&samples) {
            assert_eq!(*sample, sampler.sample(*point).into());
            let mut one = WelkinSample::default();
            good!(welkin_sky_sampler_sample(got, point.as_ptr(), &mut one));
            assert_eq!(one, *sample);
            let mut pdf = 0.0;
            good!(welkin_sky_sampler_pdf(
                got,
                sample.direction.as_ptr(),
                &mut pdf
            ));
            same(&[pdf], &[sample.pdf]);
            good!(welkin_sky_sampler_xyz(
                got,
                sample.direction.as_ptr(),
                rgb.as_mut_ptr()
            ));
            same(&rgb, &sampler.xyz(sample.direction).unwrap());
        }
        let suns = samples
            .iter()
            .filter(|sample| sample.part == WELKIN_PART_SUN)
            .count();
        assert_eq!(suns > 0, !disc.is_null());
        // SAFETY: freed once.
        unsafe { welkin_sky_sampler_free(got) };
    }
    let n = expected_disc.wavelengths().len();
    let [mut got, mut wanted] = [(); 2].map(|()| vec![0.0; n]);
    let centre = expected_disc.direction();
    good!(welkin_solar_disc_direction(disc, rgb.as_mut_ptr()));
    same(&rgb, &centre);
    good!(welkin_solar_disc_radiance(
        disc,
        centre.as_ptr(),
        got.as_mut_ptr(),
        n
    ));
    expected_disc.radiance(centre, &mut wanted).unwrap();
    same(&got, &wanted);
    assert!(got[3] > 1.0);
    good!(welkin_solar_disc_irradiance(
        disc,
        centre.as_ptr(),
        got.as_mut_ptr(),
        n
    ));
    expected_disc.irradiance(centre, &mut wanted).unwrap();
    same(&got, &wanted);
    let mut one = 0.0;
    good!(welkin_solar_disc_radiance_at(
        disc,
        centre.as_ptr(),
        600.5,
        &mut one
    ));
    same(&[one], &[expected_disc.radiance_at(centre, 600.5).unwrap()]);
    good!(welkin_solar_disc_xyz(
        disc,
        centre.as_ptr(),
        rgb.as_mut_ptr()
    ));
    same(&rgb, &expected_disc.xyz(centre).unwrap());
    // SAFETY: each is freed once.
    unsafe {
        assert!(welkin_solar_disc_is_visible(disc));
        assert_eq!(
            welkin_solar_disc_solid_angle(disc),
            expected_disc.solid_angle()
        );
        welkin_solar_disc_free(disc);
        welkin_baked_colour_sky_free(like);
        welkin_baked_colour_sky_free(baked);
        welkin_colour_sky_free(sky);
        welkin_model_free(model);
    }
}

#[test]
fn polarisation() {
    let (given, own) = conditions();
    let (model, library) = (default_model(), model());
    let sky = make!(welkin_polarised_sky_new(model, &given));
    let baked = make!(welkin_polarised_sky_bake(sky, WELKIN_BAKE_TOLERANCE));
    let expected = library.polarised_sky(&own).unwrap();
    let expected_baked = expected.bake(BakedSky::TOLERANCE).unwrap();
    let n = expected.sky().wavelengths().len();
    let directions = many();
    let count = directions.len();
    let [x, y, z] = components(&directions);
    let [xp, yp, zp] = [&x, &y, &z].map(|c| c.as_ptr());
    let (soa, flat) = (
        Directions {
            x: &x,
            y: &y,
            z: &z,
        },
        directions.as_flattened().as_ptr(),
    );
    let heroes = [400.0, 480.5, 551.0, 699.0];
    let all_heroes = vec![heroes; count];
    for (given_frame, frame) in frames() {
        for direction in DIRECTIONS {
            let d = direction.as_ptr();
            let mut got = vec![WelkinStokes::default(); n];
            good!(welkin_polarised_sky_stokes(
                sky,
                d,
                &given_frame,
                got.as_mut_ptr(),
                n
            ));
            let mut wanted = vec![Stokes::default(); n];
            expected.stokes(direction, frame, &mut wanted).unwrap();
            assert_eq!(stokes(&got), wanted);
            let mut one = WelkinStokes::default();
            good!(welkin_polarised_sky_stokes_at(
                sky,
                d,
                &given_frame,
                512.5,
                &mut one
            ));
            assert_eq!(
                one,
                expected.stokes_at(direction, frame, 512.5).unwrap().into()
            );
            // SAFETY: a struct of the test.
            let degree = unsafe { welkin_stokes_degree(&one) };
            assert_eq!(degree, stokes(&[one])[0].degree());
            let mut xyz = [WelkinStokes::default(); 3];
            good!(welkin_polarised_sky_xyz(
                sky,
                d,
                &given_frame,
                xyz.as_mut_ptr()
            ));
            assert_eq!(stokes(&xyz), expected.xyz(direction, frame).unwrap());
            let mut four = [WelkinStokes::default(); 4];
            good!(welkin_baked_polarised_sky_hero(
                baked,
                d,
                &given_frame,
                heroes.as_ptr(),
                four.as_mut_ptr()
            ));
            assert_eq!(
                stokes(&four),
                expected_baked.hero(direction, frame, heroes).unwrap()
            );
        }
        let [mut i, mut q, mut u, mut wi, mut wq, mut wu] = [(); 6].map(|()| vec![0.0; count * n]);
        let out = StokesSpectra {
            i: &mut wi,
            q: &mut wq,
            u: &mut wu,
        };
        expected_baked.stokes_batch(&soa, frame, out).unwrap();
        let [ip, qp, up] = [&mut i, &mut q, &mut u].map(|part| part.as_mut_ptr());
        good!(welkin_baked_polarised_sky_stokes_soa(
            baked,
            xp,
            yp,
            zp,
            count,
            &given_frame,
            ip,
            qp,
            up,
            count * n
        ));
        same(&i, &wi);
        same(&q, &wq);
        same(&u, &wu);
        good!(welkin_baked_polarised_sky_stokes(
            baked,
            flat,
            &given_frame,
            ip,
            qp,
            up,
            n
        ));
        same(&q[..n], &wq[..n]);
        let mut got = vec![[WelkinStokes::default(); 4]; count];
        let mut wanted = vec![[Stokes::default(); 4]; count];
        expected_baked
            .hero_batch(&soa, frame, &all_heroes, &mut wanted)
            .unwrap();
        let wavelengths = all_heroes.as_flattened().as_ptr();
        let out = got.as_mut_ptr().cast();
        good!(welkin_baked_polarised_sky_hero_batch(
            baked,
            flat,
            &given_frame,
            wavelengths,
            count,
            out
        ));
        assert_eq!(stokes(got.as_flattened()), wanted.as_flattened());
    }
    // SAFETY: each is freed once.
    unsafe {
        welkin_polarised_sky_free(sky);
        welkin_baked_polarised_sky_free(baked);
        welkin_model_free(model);
    }
}

#[test]
fn air() {
    let (given, own) = conditions();
    let (model, library) = (default_model(), model());
    let air = make!(welkin_transmittance_new(model, own.visibility));
    let expected = library.transmittance(own.visibility).unwrap();
    let n = expected.wavelengths().len();
    let (from, to, direction) = ([0.0, 0.0, 100.0], [20e3, -3e3, 900.0], [1.0, 0.0, 0.2]);
    let [mut got, mut wanted] = [(); 2].map(|()| vec![0.0; n]);
    good!(welkin_transmittance_between(
        air,
        from.as_ptr(),
        to.as_ptr(),
        got.as_mut_ptr(),
        n
    ));
    expected.transmittance(from, to, &mut wanted).unwrap();
    same(&got, &wanted);
    good!(welkin_transmittance_optical_depth(
        air,
        from.as_ptr(),
        to.as_ptr(),
        got.as_mut_ptr(),
        n
    ));
    expected.optical_depth(from, to, &mut wanted).unwrap();
    same(&got, &wanted);
    good!(welkin_transmittance_to_space(
        air,
        from.as_ptr(),
        direction.as_ptr(),
        got.as_mut_ptr(),
        n
    ));
    expected
        .transmittance_to_space(from, direction, &mut wanted)
        .unwrap();
    same(&got, &wanted);
    good!(welkin_transmittance_to_end(
        air,
        from.as_ptr(),
        direction.as_ptr(),
        got.as_mut_ptr(),
        n
    ));
    expected
        .transmittance_to_end(from, direction, &mut wanted)
        .unwrap();
    same(&got, &wanted);
    let mut one = 0.0;
    good!(welkin_transmittance_between_at(
        air,
        from.as_ptr(),
        to.as_ptr(),
        555.5,
        &mut one
    ));
    same(
        &[one],
        &[expected.transmittance_at(from, to, 555.5).unwrap()],
    );

    let aerial = make!(welkin_aerial_perspective_new(model, &given));
    let sky = make!(welkin_sky_new(model, &given));
    let expected = library.aerial_perspective(&own).unwrap();
    let expected_sky = library.sky(&own).unwrap();
    let joined = expected.joined_to(&expected_sky).unwrap();
    let (f, t) = (from.as_ptr(), to.as_ptr());
    let [mut left, mut wanted_left] = [(); 2].map(|()| vec![0.0; n]);
    let (g, l) = (got.as_mut_ptr(), left.as_mut_ptr());
    good!(welkin_aerial_perspective_in_scattering(
        aerial, f, t, g, l, n
    ));
    expected
        .in_scattering(from, to, &mut wanted, &mut wanted_left)
        .unwrap();
    same(&got, &wanted);
    same(&left, &wanted_left);
    good!(welkin_aerial_perspective_to_end(
        aerial,
        f,
        direction.as_ptr(),
        g,
        l,
        n
    ));
    expected
        .to_end(from, direction, &mut wanted, &mut wanted_left)
        .unwrap();
    same(&got, &wanted);
    good!(welkin_aerial_perspective_joined_in_scattering(
        aerial, sky, t, g, l, n
    ));
    joined
        .in_scattering(to, &mut wanted, &mut wanted_left)
        .unwrap();
    same(&got, &wanted);
    good!(welkin_aerial_perspective_in_scattering_at(
        aerial, f, t, 601.5, &mut one
    ));
    same(
        &[one],
        &[expected.in_scattering_at(from, to, 601.5).unwrap()],
    );
    let ([mut light, mut factors], lf) = ([[0.0; 3]; 2], |(a, b): ([f32; 3], [f32; 3])| [a, b]);
    for (constant, space) in SPACES {
        good!(welkin_aerial_perspective_rgb(
            aerial,
            f,
            t,
            constant,
            light.as_mut_ptr(),
            factors.as_mut_ptr()
        ));
        assert_eq!([light, factors], lf(expected.rgb(from, to, space).unwrap()));
        good!(welkin_aerial_perspective_joined_rgb(
            aerial,
            sky,
            t,
            constant,
            light.as_mut_ptr(),
            factors.as_mut_ptr()
        ));
        assert_eq!([light, factors], lf(joined.rgb(to, space).unwrap()));
    }
    good!(welkin_aerial_perspective_joined_srgb(
        aerial,
        sky,
        t,
        light.as_mut_ptr(),
        factors.as_mut_ptr()
    ));
    assert_eq!([light, factors], lf(joined.linear_srgb(to).unwrap()));
    good!(welkin_aerial_perspective_joined_xyz(
        aerial,
        sky,
        t,
        light.as_mut_ptr(),
        factors.as_mut_ptr()
    ));
    assert_eq!([light, factors], lf(joined.xyz(to).unwrap()));
    let points = [to, [1e3, 2e3, 50.0], [0.0, 40e3, 3e3]];
    let [mut got, mut left, mut wanted, mut wanted_left] = [(); 4].map(|()| vec![0.0; 3 * n]);
    let (g, l) = (got.as_mut_ptr(), left.as_mut_ptr());
    let flat = points.as_flattened().as_ptr();
    good!(welkin_aerial_perspective_in_scattering_batch(
        aerial,
        f,
        flat,
        3,
        g,
        l,
        3 * n
    ));
    expected
        .in_scattering_batch(from, &points, &mut wanted, &mut wanted_left)
        .unwrap();
    same(&got, &wanted);
    same(&left, &wanted_left);
    good!(welkin_aerial_perspective_joined_batch(
        aerial,
        sky,
        flat,
        3,
        g,
        l,
        3 * n
    ));
    joined
        .in_scattering_batch(&points, &mut wanted, &mut wanted_left)
        .unwrap();
    same(&got, &wanted);
    let distances = [1e2, 1e3, 2e4];
    good!(welkin_aerial_perspective_in_scattering_along(
        aerial,
        f,
        direction.as_ptr(),
        distances.as_ptr(),
        3,
        g,
        l,
        3 * n
    ));
    expected
        .in_scattering_along(from, direction, &distances, &mut wanted, &mut wanted_left)
        .unwrap();
    same(&got, &wanted);
    for (given_frame, frame) in frames() {
        let mut three = [WelkinStokes::default(); 3];
        let (s, k) = (three.as_mut_ptr(), factors.as_mut_ptr());
        good!(welkin_aerial_perspective_rgb_stokes(
            aerial,
            f,
            t,
            &given_frame,
            s,
            k
        ));
        let (wanted, wanted_factors) = expected.linear_srgb_stokes(from, to, frame).unwrap();
        assert_eq!((stokes(&three), factors), (wanted.to_vec(), wanted_factors));
        let [
            mut i,
            mut q,
            mut u,
            mut left,
            mut wi,
            mut wq,
            mut wu,
            mut wl,
        ] = [(); 8].map(|()| vec![0.0; n]);
        let [ip, qp, up, lp] = [&mut i, &mut q, &mut u, &mut left].map(|part| part.as_mut_ptr());
        good!(welkin_aerial_perspective_in_scattering_stokes(
            aerial,
            f,
            t,
            &given_frame,
            ip,
            qp,
            up,
            lp,
            n
        ));
        let out = StokesSpectra {
            i: &mut wi,
            q: &mut wq,
            u: &mut wu,
        };
        expected
            .in_scattering_stokes(from, to, frame, out, &mut wl)
            .unwrap();
        same(&u, &wu);
        same(&q, &wq);
        same(&left, &wl);
    }
    let polarised = make!(welkin_polarised_sky_new(model, &given));
    let mut three = [WelkinStokes::default(); 3];
    let (s, k) = (three.as_mut_ptr(), factors.as_mut_ptr());
    good!(welkin_aerial_perspective_joined_srgb_stokes(
        aerial,
        polarised,
        t,
        null(),
        s,
        k
    ));
    let expected_polarised = library.polarised_sky(&own).unwrap();
    let joined = expected.joined_to_polarised(&expected_polarised).unwrap();
    let (wanted, _) = joined
        .linear_srgb_stokes(to, PolarisationFrame::Vertical)
        .unwrap();
    assert_eq!(stokes(&three), wanted);
    // SAFETY: each is freed once.
    unsafe {
        welkin_polarised_sky_free(polarised);
        welkin_aerial_perspective_free(aerial);
        welkin_sky_free(sky);
        welkin_transmittance_free(air);
        welkin_model_free(model);
    }
}

#[test]
fn air_in_colour() {
    let (given, own) = conditions();
    let (model, library) = (default_model(), model());
    let aerial = make!(welkin_colour_aerial_perspective_new(model, &given));
    let expected = library.colour_aerial_perspective(&own).unwrap();
    let (from, direction, distances) = ([0.0, 0.0, 100.0], [1.0, 0.3, 0.1], [1e2, 1e3, 1e4]);
    let [mut light, mut factors, mut wanted, mut wanted_factors] = [[[0.0; 3]; 3]; 4];
    good!(welkin_colour_aerial_perspective_srgb_along(
        aerial,
        from.as_ptr(),
        direction.as_ptr(),
        distances.as_ptr(),
        3,
        light.as_mut_ptr().cast(),
        factors.as_mut_ptr().cast()
    ));
    expected
        .linear_srgb_along(
            from,
            direction,
            &distances,
            &mut wanted,
            &mut wanted_factors,
        )
        .unwrap();
    assert_eq!((light, factors), (wanted, wanted_factors));
    let size = [16, 9];
    let volume = WelkinCameraVolume {
        struct_size: size_of::<WelkinCameraVolume>() as u64,
        from,
        axis: [1.0, 0.0, 0.0],
        right: [0.0, -0.6, 0.0],
        up: [0.0, 0.0, 0.4],
        columns: size[0] as u64,
        rows: size[1] as u64,
        depth_count: 3,
        depths: distances.as_ptr(),
    };
    let count = size[0] * size[1] * 3;
    let [mut light, mut factors, mut wanted, mut wanted_factors] =
        [(); 4].map(|()| vec![[0.0f32; 3]; count]);
    let (l, k) = (light.as_mut_ptr().cast(), factors.as_mut_ptr().cast());
    good!(welkin_colour_aerial_perspective_srgb_volume(
        aerial, &volume, l, k, count
    ));
    let own = CameraVolume {
        from,
        axis: volume.axis,
        right: volume.right,
        up: volume.up,
        size,
        depths: &distances,
    };
    expected
        .linear_srgb_volume(&own, &mut wanted, &mut wanted_factors)
        .unwrap();
    same(light.as_flattened(), wanted.as_flattened());
    same(factors.as_flattened(), wanted_factors.as_flattened());
    // SAFETY: each is freed once.
    unsafe {
        welkin_colour_aerial_perspective_free(aerial);
        welkin_model_free(model);
    }
}

#[test]
fn suns_that_move_and_the_moon() {
    let (given, own) = conditions();
    let (model, library) = (default_model(), model());
    let elevations = [0.3, 0.45];
    let course = make!(welkin_sun_course_new(
        model,
        &given,
        elevations.as_ptr(),
        WELKIN_BAKE_TOLERANCE
    ));
    let expected = library
        .sun_course(&own, elevations, BakedSky::TOLERANCE)
        .unwrap();
    let sky = make!(welkin_sun_course_at(course, 0.33, 0.1));
    let mut rgb = [0.0; 3];
    for elevation in [0.33, 0.41] {
        good!(welkin_sun_course_write(course, elevation, 0.2, sky));
        let wanted = expected.at(elevation, 0.2).unwrap();
        good!(welkin_baked_colour_sky_xyz(
            sky,
            DIRECTIONS[1].as_ptr(),
            rgb.as_mut_ptr()
        ));
        same(&rgb, &wanted.xyz(DIRECTIONS[1]).unwrap());
    }
    let mut error = WelkinBakeError::default();
    good!(welkin_sun_course_interpolation_error(course, &mut error));
    assert_eq!(error, expected.interpolation_error().into());

    let mut moon = WelkinMoon {
        struct_size: 0,
        elevation: 0.0,
        azimuth: 0.0,
        phase_angle: 0.0,
        distance: 0.0,
    };
    good!(welkin_moon_init(&mut moon, size_of::<WelkinMoon>() as u64));
    let own_moon = Moon::default();
    assert_eq!(
        (moon.elevation, moon.distance),
        (own_moon.elevation, own_moon.distance)
    );
    let sum = make!(welkin_sky_sum_new(model, &given, &moon));
    let wanted = library.sky_with_moon(&own, &own_moon).unwrap();
    good!(welkin_sky_sum_xyz(
        sum,
        DIRECTIONS[1].as_ptr(),
        rgb.as_mut_ptr()
    ));
    same(&rgb, &wanted.xyz(DIRECTIONS[1]).unwrap());
    let moonlit = make!(welkin_model_moonlit(model, &moon));
    let night = make!(welkin_sky_new(moonlit, &given));
    let wanted = library.moonlit(&own_moon).unwrap().sky(&own).unwrap();
    good!(welkin_sky_xyz(
        night,
        DIRECTIONS[1].as_ptr(),
        rgb.as_mut_ptr()
    ));
    same(&rgb, &wanted.xyz(DIRECTIONS[1]).unwrap());
    // SAFETY: each is freed once.
    unsafe {
        assert!(welkin_model_is_moonlit(moonlit) && !welkin_model_is_moonlit(model));
        welkin_sky_free(night);
        welkin_model_free(moonlit);
        welkin_sky_sum_free(sum);
        welkin_baked_colour_sky_free(sky);
        welkin_sun_course_free(course);
        welkin_model_free(model);
    }
}

/// Over a ground whose albedo depends on wavelength: of skies, colours, bands and segments.
#[test]
fn grounds_by_wavelength() {
    let (given, own) = conditions();
    let (model, library) = (default_model(), model());
    let (wavelengths, albedos) = ([450.0, 680.0, 750.0], [0.04, 0.05, 0.45]);
    let over = make!(welkin_model_over(
        model,
        wavelengths.as_ptr(),
        albedos.as_ptr(),
        3
    ));
    let wanted = library.over(&Albedo::table(&wavelengths, &albedos).unwrap());
    let [sky, plain] = [over, model].map(|model| make!(welkin_sky_new(model, &given)));
    let (mut light, mut rgb) = (0.0, [0.0; 3]);
    good!(welkin_sky_radiance_at(
        sky,
        DIRECTIONS[1].as_ptr(),
        715.0,
        &mut light
    ));
    let expected = wanted.sky(&own).unwrap();
    same(
        &[light],
        &[expected.radiance_at(DIRECTIONS[1], 715.0).unwrap()],
    );
    good!(welkin_sky_xyz(
        sky,
        DIRECTIONS[1].as_ptr(),
        rgb.as_mut_ptr()
    ));
    same(&rgb, &expected.xyz(DIRECTIONS[1]).unwrap());
    let green = rgb;
    good!(welkin_sky_xyz(
        plain,
        DIRECTIONS[1].as_ptr(),
        rgb.as_mut_ptr()
    ));
    assert_ne!(rgb, green);
    let mut none = null_mut();
    let falling = [500.0, 400.0];
    let text =
        bad!(Value: welkin_model_over(model, falling.as_ptr(), albedos.as_ptr(), 2, &mut none));
    assert!(text.contains("increase"), "{text}");
    let bright = [0.1, 1.2];
    bad!(Range: welkin_model_over(model, wavelengths.as_ptr(), bright.as_ptr(), 2, &mut none));
    bad!(Value: welkin_model_over(model, null(), null(), 0, &mut none));
    assert!(none.is_null());
    // SAFETY: each is freed once.
    unsafe {
        assert!(welkin_model_has_ground(over) && !welkin_model_has_ground(model));
        welkin_sky_free(sky);
        welkin_sky_free(plain);
        welkin_model_free(over);
        welkin_model_free(model);
    }
}

#[test]
fn plans_and_point_queries() {
    let (given, own) = conditions();
    let (model, library) = (default_model(), model());
    let budget = WelkinBudget {
        struct_size: size_of::<WelkinBudget>() as u64,
        altitude: [0.0, 1000.0],
        visibility: [40e3, 50e3],
        solar_elevation: [0.1, 0.5],
        tolerance: WELKIN_BAKE_TOLERANCE,
        channels: WELKIN_CHANNELS_STOKES,
        reserved: 0,
    };
    let plan = make!(welkin_model_plan(model, &budget));
    let expected = library
        .plan(&Budget {
            altitude: budget.altitude,
            visibility: budget.visibility,
            solar_elevation: budget.solar_elevation,
            tolerance: budget.tolerance,
            channels: Channels::Stokes,
        })
        .unwrap();
    let mut summary = WelkinPlanSummary {
        struct_size: size_of::<WelkinPlanSummary>() as u64,
        file_bytes: 0,
        chunk_count: 0,
        sky_bytes: 0,
        error_median: 0.0,
        error_p99: 0.0,
        bake_p95: 0.0,
    };
    good!(welkin_plan_summary(plan, &mut summary));
    assert_eq!(summary.file_bytes, expected.file_bytes as u64);
    assert_eq!(summary.error_p99, f64::from(expected.error_p99));
    good!(welkin_model_load(model, plan));
    let query = make!(welkin_point_query_new(model, plan));
    let polarised = make!(welkin_polarised_point_query_new(model, plan));
    // SAFETY: the queries keep what they need.
    unsafe {
        welkin_plan_free(plan);
        welkin_model_free(model);
    }
    let wanted_query = library.point_query(&expected).unwrap();
    let wanted_polarised = library.polarised_point_query(&expected).unwrap();
    let n = library.wavelengths().len();
    let [mut got, mut wanted] = [(); 2].map(|()| vec![0.0; n]);
    for direction in DIRECTIONS {
        let d = direction.as_ptr();
        good!(welkin_point_query_radiance(
            query,
            &given,
            d,
            got.as_mut_ptr(),
            n
        ));
        wanted_query.radiance(&own, direction, &mut wanted).unwrap();
        same(&got, &wanted);
        let mut one = 0.0;
        good!(welkin_point_query_radiance_at(
            query, &given, d, 500.5, &mut one
        ));
        same(
            &[one],
            &[wanted_query.radiance_at(&own, direction, 500.5).unwrap()],
        );
        let mut stokes = WelkinStokes::default();
        good!(welkin_polarised_point_query_stokes_at(
            polarised,
            &given,
            d,
            null(),
            500.5,
            &mut stokes
        ));
        let frame = PolarisationFrame::Vertical;
        assert_eq!(
            stokes,
            wanted_polarised
                .stokes_at(&own, direction, frame, 500.5)
                .unwrap()
                .into()
        );
    }
    // SAFETY: each is freed once.
    unsafe {
        welkin_point_query_free(query);
        welkin_polarised_point_query_free(polarised);
    }
}

#[test]
fn models() {
    let (model, library) = (default_model(), model());
    let mut ranges = WelkinRanges::default();
    good!(welkin_model_ranges(model, &mut ranges));
    assert_eq!(ranges.solar_elevation, library.solar_elevation_range());
    assert_eq!(ranges.visibility, library.visibility_range());
    assert_eq!(ranges.altitude, library.altitude_range());
    assert_eq!(ranges.wavelength, library.wavelength_range().unwrap());
    assert_eq!(ranges.planet_radius, library.head().planet.radius);
    good!(welkin_model_verify(model));
    // SAFETY: the handle is alive.
    unsafe {
        assert_eq!(welkin_model_file_bytes(model), library.file_bytes());
        library.verify().unwrap();
        assert_eq!(welkin_model_touched_bytes(model), library.touched_bytes());
        assert!(welkin_model_is_polarised(model));
        welkin_model_free(model);
    }
    let bytes = make!(welkin_model_from_bytes(
        library::DEFAULT_MODEL.as_ptr(),
        library::DEFAULT_MODEL.len()
    ));
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/default.welkin\0")
        .as_ptr()
        .cast();
    let opened = make!(welkin_model_open(path));
    let read = make!(welkin_model_read(path));
    for model in [bytes, opened, read] {
        // SAFETY: freed once.
        unsafe {
            assert_eq!(
                welkin_model_wavelength_count(model),
                library.wavelengths().len()
            );
            welkin_model_free(model);
        }
    }
}

#[test]
fn axes() {
    let file = include_bytes!("../../format-spec/conformance/files/axis.welkin");
    let library = library::Model::from_bytes(file.to_vec()).unwrap();
    let own = library.axis().unwrap().unwrap();
    let model = make!(welkin_model_from_bytes(file.as_ptr(), file.len()));
    let mut axis = std::mem::MaybeUninit::<WelkinAxis>::uninit();
    good!(welkin_model_axis(model, axis.as_mut_ptr()));
    // SAFETY: the call filled it.
    let axis = unsafe { axis.assume_init() };
    assert_eq!((axis.range, axis.nodes), (own.range(), 4));
    let text = |characters: &[std::ffi::c_char]| {
        let bytes = characters.iter().map(|c| *c as u8);
        String::from_utf8(bytes.take_while(|b| *b != 0).collect()).unwrap()
    };
    assert_eq!(text(&axis.name), own.name());
    assert_eq!(text(&axis.unit), own.unit());
    let mut values = [0.0; 4];
    good!(welkin_model_axis_values(model, values.as_mut_ptr(), 4));
    assert_eq!(values, own.values());
    let (mut visibility, mut value) = (0.0, 0.0);
    good!(welkin_model_axis_visibility(model, 315.0, &mut visibility));
    assert_eq!(visibility, own.visibility(315.0).unwrap());
    good!(welkin_model_axis_value(model, visibility, &mut value));
    assert_eq!(value, own.value(visibility).unwrap());
    let text = bad!(Range: welkin_model_axis_visibility(model, 501.0, &mut visibility));
    assert!(text.contains("ozone"), "{text}");
    let plain = default_model();
    bad!(Missing: welkin_model_axis_visibility(plain, 315.0, &mut visibility));
    // SAFETY: each is freed once.
    unsafe {
        welkin_model_free(model);
        welkin_model_free(plain);
    }
}
