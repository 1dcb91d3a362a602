//! Grounds whose albedo depends on wavelength: exact at every wavelength, and in colours and bands the sum over the
//! spectrum.

mod common;

use std::sync::LazyLock;

use proptest::prelude::*;
use welkin::{
    Albedo, BakedSky, Conditions, Directions, Model, PolarisationFrame, Response, Sky, Stokes,
};

static MODEL: LazyLock<Model> = LazyLock::new(|| Model::default_model().unwrap());

const VIEWS: [[f32; 3]; 4] = [
    [0.0, 0.0, 1.0],
    [0.6, 0.3, 0.2],
    [-0.7, 0.2, 0.02],
    [0.5, -0.5, -0.2],
];
const FRAME: PolarisationFrame = PolarisationFrame::Vertical;

fn conditions() -> Conditions {
    Conditions {
        solar_elevation: 0.4,
        solar_azimuth: 0.3,
        visibility: 47e3,
        altitude: 800.0,
        ..Conditions::default()
    }
}

fn grass() -> Albedo {
    let wavelengths = [
        400.0, 500.0, 550.0, 600.0, 680.0, 700.0, 720.0, 750.0, 1000.0,
    ];
    let shares = [0.03, 0.04, 0.105, 0.065, 0.04, 0.09, 0.26, 0.45, 0.49];
    Albedo::table(&wavelengths, &shares).unwrap()
}

/// Black, then white: where any rule that is not exact shows.
fn cliff() -> Albedo {
    Albedo::table(&[549.0, 551.0], &[0.0, 1.0]).unwrap()
}

fn over_grey(albedo: f64) -> Conditions {
    Conditions {
        albedo,
        ..conditions()
    }
}

fn ratio(got: f32, wanted: f32) -> f32 {
    (got / wanted - 1.0).abs()
}

/// However it is given, one albedo for all wavelengths gives the bits of [`Conditions::albedo`].
#[test]
fn grey_is_what_it_was() {
    let flat = Albedo::table(&[400.0, 500.0, 900.0], &[0.37; 3]).unwrap();
    assert_eq!(flat, Albedo::grey(0.37).unwrap());
    let over = MODEL.over(&flat);
    let (grey, given) = (over_grey(0.37), over_grey(0.9));
    let (wanted, got) = (
        MODEL.polarised_sky(&grey).unwrap(),
        over.polarised_sky(&given).unwrap(),
    );
    assert_eq!(got.sky().conditions(), &grey);
    let air = MODEL.aerial_perspective(&grey).unwrap();
    let same = over.aerial_perspective(&given).unwrap();
    for view in VIEWS {
        assert_eq!(
            got.sky().xyz(view).unwrap(),
            wanted.sky().xyz(view).unwrap()
        );
        for wavelength in [400.0, 551.3, 762.0] {
            let [a, b] = [&got, &wanted].map(|sky| sky.stokes_at(view, FRAME, wavelength).unwrap());
            assert_eq!(a, b);
        }
        let to = view.map(|v| 2e4 * f64::from(v.abs()));
        let from = [0.0, 0.0, 10.0];
        assert_eq!(air.xyz(from, to).unwrap(), same.xyz(from, to).unwrap());
        let [a, b] = [&air, &same].map(|air| air.in_scattering_at(from, to, 612.0).unwrap());
        assert_eq!(a, b);
    }
    let responses = [
        Response::wavelength(612.0),
        Response::table(&[500.0, 700.0], &[1.0; 2]).unwrap(),
    ];
    let (mut a, mut b) = ([0.0; 2], [0.0; 2]);
    let bands = MODEL.bands(&responses).unwrap();
    MODEL
        .band_sky(&grey, &bands)
        .unwrap()
        .radiance(VIEWS[1], &mut a)
        .unwrap();
    over.band_sky(&given, &bands)
        .unwrap()
        .radiance(VIEWS[1], &mut b)
        .unwrap();
    assert_eq!(a, b);
    let [a, b] = [MODEL.colour_sky(&grey), over.colour_sky(&given)]
        .map(|sky| sky.unwrap().xyz(VIEWS[1]).unwrap());
    assert_eq!(a, b);
}

proptest! {
    #![proptest_config(common::cases(12))]

    /// No light changes its wavelength: at each it is that over a grey ground of the albedo there.
    #[test]
    fn every_wavelength_has_its_own_albedo(
        shares in prop::collection::vec(0.0..=1.0f64, 5),
        wavelengths in prop::collection::vec(330.0..1050.0f64, 4),
        elevation in -0.05..1.5f64,
        albedo in 0.0..=1.0f64,
    ) {
        let ground = Albedo::table(&[400.0, 500.0, 600.0, 700.0, 720.0], &shares).unwrap();
        let over = MODEL.over(&ground);
        let conditions = Conditions { solar_elevation: elevation, albedo, ..conditions() };
        let sky = over.polarised_sky(&conditions).unwrap();
        let air = over.aerial_perspective(&conditions).unwrap();
        for wavelength in wavelengths {
            let grey = Conditions { albedo: ground.at(wavelength), ..conditions };
            let wanted = MODEL.polarised_sky(&grey).unwrap();
            let grey_air = MODEL.aerial_perspective(&grey).unwrap();
            for view in VIEWS {
                let [a, b] = [&sky, &wanted].map(|sky| sky.stokes_at(view, FRAME, wavelength).unwrap());
                prop_assert!(ratio(a.i, b.i) < 2e-5, "{wavelength} {view:?} {a:?} {b:?}");
                prop_assert!((a.q - b.q).hypot(a.u - b.u) < 5e-5 * b.i, "{wavelength} {view:?} {a:?} {b:?}");
                let to = view.map(|v| 3e4 * f64::from(v.abs()));
                let [a, b] = [&air, &grey_air].map(|air| {
                    air.relative_stokes_at([0.0, 0.0, 10.0], to, FRAME, wavelength).unwrap()
                });
                prop_assert!(ratio(a.i, b.i) < 2e-5, "air {wavelength} {view:?} {a:?} {b:?}");
                prop_assert!((a.q - b.q).hypot(a.u - b.u) < 5e-5 * b.i, "{a:?} {b:?}");
            }
        }
        // And so at the nodes.
        let mut spectrum = vec![0.0; MODEL.wavelengths().len()];
        sky.sky().radiance(VIEWS[1], &mut spectrum).unwrap();
        let grey = Conditions { albedo: ground.at(MODEL.wavelengths()[7]), ..conditions };
        let mut wanted = spectrum.clone();
        MODEL.sky(&grey).unwrap().radiance(VIEWS[1], &mut wanted).unwrap();
        prop_assert!(ratio(spectrum[7], wanted[7]) < 1e-6);
    }
}

/// At a node light is black + A / (1 − A s) · ground: three grounds tell black, ground and s, and a fourth follows.
#[test]
fn light_is_linear_in_what_the_ground_sends() {
    let node = common::nearest(MODEL.wavelengths(), 550.0);
    let nm = MODEL.wavelengths()[node];
    let light = |albedo: f64| -> f64 {
        let ground = Albedo::table(&[nm - 1.0, nm, nm + 1.0], &[0.5, albedo, 0.2]).unwrap();
        let sky = MODEL.over(&ground).sky(&conditions()).unwrap();
        let mut out = vec![0.0; MODEL.wavelengths().len()];
        sky.radiance(VIEWS[1], &mut out).unwrap();
        f64::from(out[node])
    };
    let [black, half, white] = [light(0.0), light(0.5), light(1.0)];
    assert!(black < light(0.1) && light(0.1) < half && half < white);
    // (half − black) / (white − black) = ½ (1 − s) / (1 − s/2).
    let share = (half - black) / (white - black);
    let s = (1.0 - 2.0 * share) / (1.0 - share);
    assert!((0.01..0.5).contains(&s), "{s}");
    let ground = (white - black) * (1.0 - s);
    for albedo in [0.05, 0.3, 0.8] {
        let wanted = black + albedo / (1.0 - albedo * s) * ground;
        assert!((light(albedo) / wanted - 1.0).abs() < 1e-5, "{albedo}");
    }
}

#[test]
fn heroes_have_the_ground_of_their_wavelengths() {
    let wavelengths = [420.0, 548.0f32, 552.0, 715.0];
    for ground in [grass(), cliff()] {
        let over = MODEL.over(&ground);
        let mut sky = over.polarised_sky(&conditions()).unwrap();
        let mut baked = sky.bake(BakedSky::TOLERANCE).unwrap();
        sky.set_solar_azimuth(1.1).unwrap();
        baked.set_solar_azimuth(1.1).unwrap();
        let component = |k: usize| VIEWS.map(|view| view[k]);
        let [x, y, z] = [component(0), component(1), component(2)];
        let directions = Directions {
            x: &x,
            y: &y,
            z: &z,
        };
        let mut batch = [[Stokes::default(); 4]; 4];
        baked
            .hero_batch(&directions, FRAME, &[wavelengths; 4], &mut batch)
            .unwrap();
        for (view, batch) in VIEWS.into_iter().zip(batch) {
            assert_eq!(baked.hero(view, FRAME, wavelengths).unwrap(), batch);
            let radiance = baked.sky().hero(view, wavelengths).unwrap();
            for ((got, i), wavelength) in batch.into_iter().zip(radiance).zip(wavelengths) {
                let wanted = sky.stokes_at(view, FRAME, wavelength.into()).unwrap();
                assert!(
                    ratio(got.i, wanted.i) < 0.01,
                    "{wavelength} {view:?} {got:?} {wanted:?}"
                );
                assert!((got.q - wanted.q).hypot(got.u - wanted.u) < 0.01 * wanted.i);
                assert!(ratio(got.i, i) < 1e-5);
            }
        }
    }
}

/// Wavelength, x̄, ȳ and z̄ at every nanometre.
fn observer() -> Vec<[f64; 4]> {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/fitter/data/cie1931_2deg_1nm.csv"
    );
    let table = std::fs::read_to_string(path).unwrap();
    let rows = table
        .lines()
        .filter(|l| l.starts_with(|c: char| c.is_ascii_digit()));
    let cells = |row: &str| -> Vec<f64> { row.split(',').map(|v| v.parse().unwrap()).collect() };
    rows.map(|row| cells(row)[..4].try_into().unwrap())
        .collect()
}

/// The integral over the spectrum at every nanometre.
fn integrated(sky: &Sky, view: [f32; 3], observer: &[[f64; 4]]) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for row in observer {
        let light = f64::from(sky.radiance_at(view, row[0]).unwrap());
        sums.iter_mut()
            .zip(&row[1..])
            .for_each(|(sum, m)| *sum += 683.0 * light * m);
    }
    sums
}

/// What the ground changes of the colours is what it changes of the integrals, but for a fit that is no worse than that
/// of the colours of the file.
#[test]
fn colours_are_sums_over_the_spectrum() {
    let observer = observer();
    let sand = Albedo::table(&[400.0, 500.0, 600.0, 700.0], &[0.12, 0.22, 0.34, 0.40]).unwrap();
    let [shortest, longest] = MODEL.wavelength_range().unwrap();
    assert!(shortest <= observer[0][0]);
    let observer: Vec<_> = observer
        .into_iter()
        .filter(|row| row[0] <= longest)
        .collect();
    let leaf = Albedo::table(&[500.0, 550.0, 600.0], &[0.02, 0.5, 0.02]).unwrap();
    for (ground, most) in [(grass(), 2e-3), (sand, 2e-3), (leaf, 1e-2)] {
        let over = MODEL.over(&ground);
        let sky = over.sky(&conditions()).unwrap();
        let colour = over.colour_sky(&conditions()).unwrap();
        let polarised = over.polarised_sky(&conditions()).unwrap();
        let black = MODEL.sky(&over_grey(0.0)).unwrap();
        for view in VIEWS {
            let (got, base) = (sky.xyz(view).unwrap(), black.xyz(view).unwrap());
            assert_eq!(got, colour.xyz(view).unwrap());
            let stokes = polarised.xyz(view, FRAME).unwrap();
            let (sum, base_sum) = (
                integrated(&sky, view, &observer),
                integrated(&black, view, &observer),
            );
            for c in 0..3 {
                let change = f64::from(got[c] / base[c]);
                let wanted = sum[c] / base_sum[c];
                assert!(
                    (change / wanted - 1.0).abs() < most,
                    "{view:?} {c}: {change} {wanted}"
                );
                assert!(ratio(stokes[c].i, got[c]) < 1e-5);
            }
        }
    }
}

/// As well as the page on types says: to 0.1 % at one wavelength, to 1 % in a band that reaches over an edge.
#[test]
fn bands_are_integrals() {
    let wide = ([500.0, 600.0, 750.0], [0.0, 1.0, 0.0]);
    let responses = [
        Response::table(&wide.0, &wide.1).unwrap(),
        Response::wavelength(715.0),
        Response::wavelength(550.5),
    ];
    for ground in [grass(), cliff()] {
        let over = MODEL.over(&ground);
        let bands = over.bands(&responses).unwrap();
        let band_sky = over.band_sky(&conditions(), &bands).unwrap();
        let baked = band_sky.bake(BakedSky::TOLERANCE).unwrap();
        let polarised = over.polarised_band_sky(&conditions(), &bands).unwrap();
        let sky = over.sky(&conditions()).unwrap();
        for view in VIEWS {
            let [mut got, mut fast] = [[0.0; 3]; 2];
            band_sky.radiance(view, &mut got).unwrap();
            baked.radiance(view, &mut fast).unwrap();
            let mut stokes = [Stokes::default(); 3];
            polarised.stokes(view, FRAME, &mut stokes).unwrap();
            let step = 0.5;
            let at = |l: f64| f64::from(sky.radiance_at(view, l).unwrap());
            let rising = |l: f64| ((l - 500.0) / 100.0).min((750.0 - l) / 150.0);
            let sum: f64 = (0..500)
                .map(|i| 500.0 + step * (f64::from(i) + 0.5))
                .map(|l| step * rising(l) * at(l))
                .sum();
            let wanted = [sum, at(715.0), at(550.5)];
            for b in 0..3 {
                let off = f64::from(got[b]) / wanted[b] - 1.0;
                assert!(off.abs() < [1e-2, 1e-3, 1e-3][b], "{view:?} {b}: {off}");
                assert!(ratio(fast[b], got[b]) < 0.01 && ratio(stokes[b].i, got[b]) < 1e-5);
            }
        }
        // Elsewhere they are refused, and what is made elsewhere is refused here.
        let refused = MODEL.band_sky(&conditions(), &bands).unwrap_err();
        assert!(refused.to_string().contains("another ground"), "{refused}");
        let others = MODEL.bands(&responses).unwrap();
        assert!(over.band_sky(&conditions(), &others).is_err());
        let nodes = vec![1.0; MODEL.wavelengths().len()];
        assert!(bands.project(&nodes, &mut [0.0; 3]).is_err());
    }
}

/// What is far vanishes in the sky: so both must have one ground.
#[test]
fn air_and_sky_share_the_ground() {
    let over = MODEL.over(&grass());
    let (sky, air) = (
        over.polarised_sky(&conditions()).unwrap(),
        over.aerial_perspective(&conditions()).unwrap(),
    );
    let joined = air.joined_to(sky.sky()).unwrap();
    let beyond = [0.0, 0.8e6, 0.6e6 + 800.0];
    let (light, _) = joined.linear_srgb(beyond).unwrap();
    let wanted = sky.sky().linear_srgb([0.0, 0.8, 0.6]).unwrap();
    let polarised = air.joined_to_polarised(&sky).unwrap();
    let (stokes, _) = polarised.linear_srgb_stokes(beyond, FRAME).unwrap();
    for c in 0..3 {
        assert!(ratio(light[c], wanted[c]) < 1e-4 && ratio(stokes[c].i, wanted[c]) < 1e-4);
    }
    let colour = over.colour_aerial_perspective(&conditions()).unwrap();
    let (from, to) = ([0.0, 0.0, 10.0], [9e3, 4e3, 300.0]);
    assert_eq!(colour.xyz(from, to).unwrap(), air.xyz(from, to).unwrap());
    let other = MODEL
        .over(&cliff())
        .sky(&Conditions {
            albedo: 0.1,
            ..conditions()
        })
        .unwrap();
    assert!(air.joined_to(&other).is_err());
    let grey = MODEL.sky(&over_grey(grass().at(550.0))).unwrap();
    assert_eq!(air.joined_to(&grey).unwrap_err().class(), "value");
}

#[test]
fn what_says_its_own_conditions_is_refused() {
    let over = MODEL.over(&grass());
    assert!(over.aerial_perspective_query().is_err());
    assert!(over.sky_difference(&conditions()).is_err());
    let night = over.moonlit(&welkin::Moon::default()).unwrap();
    assert_eq!(night.ground(), Some(&grass()));
}

proptest! {
    /// Whatever is given: an albedo within 0..=1 at all wavelengths, or an error.
    #[test]
    fn odd_albedos_are_refused(
        pairs in prop::collection::vec((any_number(), any_number()), 0..5),
        extra in 0..2usize,
        at in any_number(),
    ) {
        let wavelengths: Vec<f64> = pairs.iter().map(|p| p.0).collect();
        let mut shares: Vec<f64> = pairs.iter().map(|p| p.1).collect();
        shares.extend(std::iter::repeat_n(0.5, extra));
        let is_sound = extra == 0
            && !pairs.is_empty()
            && wavelengths.iter().all(|l| l.is_finite() && *l > 0.0)
            && wavelengths.windows(2).all(|w| w[0] < w[1])
            && shares.iter().all(|a| (0.0..=1.0).contains(a));
        let albedo = Albedo::table(&wavelengths, &shares);
        prop_assert_eq!(albedo.is_ok(), is_sound);
        if let Ok(albedo) = albedo {
            prop_assert!((0.0..=1.0).contains(&albedo.at(at)));
        }
    }
}

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        0.0..=1.0f64,
        300.0..900.0f64,
        prop::sample::select(vec![
            0.0,
            -0.0,
            1.0,
            f64::NAN,
            f64::INFINITY,
            -0.1,
            1.1,
            5e-324,
            f64::MAX
        ]),
    ]
}
