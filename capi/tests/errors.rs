//! What is wrong is an error with a code and a text, and changes nothing.

#![allow(
    clippy::macro_metavars_in_unsafe,
    reason = "the macros of the tests are such calls"
)]

mod common;

use std::f64::consts::TAU;
use std::ffi::CString;
use std::io::Write;
use std::ptr::{null, null_mut};

use common::{conditions, default_model};
use welkin::*;

const UP: [f32; 3] = [0.0, 0.0, 1.0];

/// A model, a sky of it and the sky baked in colour, freed at the end.
struct Scene {
    model: *mut WelkinModel,
    sky: *mut WelkinSky,
    baked: *mut WelkinBakedColourSky,
    count: usize,
}

impl Scene {
    fn new() -> Self {
        let model = default_model();
        let sky = make!(welkin_sky_new(model, &conditions().0));
        let baked = make!(welkin_sky_bake_colour(sky, WELKIN_BAKE_TOLERANCE));
        // SAFETY: the handle is alive.
        let count = unsafe { welkin_sky_wavelength_count(sky) };
        Self {
            model,
            sky,
            baked,
            count,
        }
    }
}

impl Drop for Scene {
    fn drop(&mut self) {
        // SAFETY: each is freed once.
        unsafe {
            welkin_baked_colour_sky_free(self.baked);
            welkin_sky_free(self.sky);
            welkin_model_free(self.model);
        }
    }
}

#[test]
fn null_pointers_are_refused_by_name() {
    let scene = Scene::new();
    let (given, _) = conditions();
    let mut rgb = [7.0; 3];
    let (d, out) = (UP.as_ptr(), rgb.as_mut_ptr());
    assert!(bad!(Null: welkin_sky_xyz(null(), d, out)).contains("sky"));
    assert!(bad!(Null: welkin_sky_xyz(scene.sky, null(), out)).contains("direction"));
    assert!(bad!(Null: welkin_sky_xyz(scene.sky, d, null_mut())).contains("xyz"));
    bad!(Null: welkin_sky_radiance(scene.sky, d, null_mut(), scene.count));
    bad!(Null: welkin_baked_colour_sky_rgb_batch(scene.baked, null(), 5, 0, out));
    bad!(Null: welkin_baked_colour_sky_rgb_soa(scene.baked, d, d, null(), 1, 0, out));
    bad!(Null: welkin_model_default(null_mut()));
    bad!(Null: welkin_sky_new(scene.model, &given, null_mut()));
    bad!(Null: welkin_check_abi(null()));
    bad!(Null: welkin_conditions_init(null_mut(), 48));
    bad!(Null: welkin_sky_set_solar_azimuth(null_mut(), 0.0));
    bad!(Null: welkin_space_by_name(null(), &mut 0));
    // Where nothing is made, the handle is null.
    let mut sky = scene.sky;
    bad!(Null: welkin_sky_new(null(), &given, &mut sky));
    assert!(sky.is_null());
    let mut model = scene.model;
    bad!(Null: welkin_model_open(null(), &mut model));
    assert!(model.is_null());
    // Empty arrays may be null.
    good!(welkin_baked_colour_sky_rgb_batch(
        scene.baked,
        null(),
        0,
        0,
        null_mut()
    ));
    assert_eq!(rgb, [7.0; 3]);
    // What cannot fail answers nothing.
    // SAFETY: null is allowed.
    unsafe {
        assert_eq!(welkin_sky_wavelength_count(null()), 0);
        assert_eq!(welkin_solar_disc_solid_angle(null()), 0.0);
        assert!(!welkin_model_is_polarised(null()));
        welkin_model_free(null_mut());
    }
}

#[test]
fn arrays_of_wrong_lengths_alignments_and_places_are_refused() {
    let scene = Scene::new();
    let mut out = vec![7.0f32; scene.count + 1];
    let (d, p) = (UP.as_ptr(), out.as_mut_ptr());
    for count in [0, scene.count - 1, scene.count + 1] {
        bad!(Length: welkin_sky_radiance(scene.sky, d, p, count));
    }
    bad!(Length: welkin_sky_wavelengths(scene.sky, [0.0; 1].as_mut_ptr(), 1));
    bad!(Length: welkin_sky_radiance_batch(scene.sky, d, 1, p, scene.count + 1));
    bad!(Length: welkin_sky_radiance(scene.sky, d, p, usize::MAX / 2));
    let crooked = p.wrapping_byte_add(1);
    bad!(Alignment: welkin_sky_radiance(scene.sky, d, crooked, scene.count));
    bad!(Alignment: welkin_sky_xyz(scene.sky, crooked, p));
    // An output over an input.
    let mut both = [0.5f32; 12];
    let (input, output) = (both.as_ptr(), both.as_mut_ptr().wrapping_add(3));
    bad!(Overlap: welkin_baked_colour_sky_rgb_batch(scene.baked, input, 2, 0, output));
    bad!(Overlap: welkin_baked_colour_sky_rgb_soa(scene.baked, input, input, input, 4, 0, output));
    good!(welkin_baked_colour_sky_rgb_batch(
        scene.baked,
        input,
        1,
        0,
        output
    ));
    assert!(out.iter().all(|&v| v == 7.0));
}

#[test]
fn bad_directions_points_and_ranges_are_refused() {
    let scene = Scene::new();
    let mut rgb = [7.0f32; 3];
    let out = rgb.as_mut_ptr();
    for direction in [[0.0; 3], [f32::NAN, 0.0, 1.0], [f32::INFINITY, 0.0, 0.0]] {
        let d = direction.as_ptr();
        bad!(Direction: welkin_sky_xyz(scene.sky, d, out));
        bad!(Direction: welkin_baked_colour_sky_rgb(scene.baked, d, 0, out));
        bad!(Direction: welkin_baked_colour_sky_rgb_soa(scene.baked, d, &d.read0(1), &d.read0(2), 1, 0, out));
    }
    let text = bad!(Range: welkin_sky_radiance_at(scene.sky, UP.as_ptr(), 1e6, out));
    assert!(text.contains("wavelength"), "{text}");
    bad!(Range: welkin_sky_set_solar_azimuth(scene.sky, f64::NAN));
    bad!(Argument: welkin_baked_colour_sky_rgb(scene.baked, UP.as_ptr(), 4, out));
    bad!(Argument: welkin_baked_colour_sky_rgb(scene.baked, UP.as_ptr(), -1, out));
    let mut baked = null_mut();
    bad!(Range: welkin_sky_bake(scene.sky, 1e-9, &mut baked));
    assert!(baked.is_null());
    let (mut given, _) = conditions();
    given.solar_elevation = -1.0;
    let mut sky = null_mut();
    assert!(bad!(Range: welkin_sky_new(scene.model, &given, &mut sky)).contains("solar_elevation"));
    let air = make!(welkin_transmittance_new(scene.model, 50e3));
    let far = [1e10, 0.0, 0.0];
    let mut one = 0.0;
    bad!(Point: welkin_transmittance_between_at(air, far.as_ptr(), [0.0; 3].as_ptr(), 500.0, &mut one));
    // SAFETY: freed once.
    unsafe { welkin_transmittance_free(air) };
    let polarised = make!(welkin_polarised_sky_new(scene.model, &conditions().0));
    let frame = WelkinPolarisationFrame {
        kind: 3,
        axis: [0.0; 3],
    };
    let axis = WelkinPolarisationFrame {
        kind: WELKIN_FRAME_AXIS,
        axis: [0.0; 3],
    };
    let mut stokes = WelkinStokes::default();
    bad!(Argument: welkin_polarised_sky_stokes_at(polarised, UP.as_ptr(), &frame, 500.0, &mut stokes));
    bad!(Direction: welkin_polarised_sky_stokes_at(polarised, UP.as_ptr(), &axis, 500.0, &mut stokes));
    // SAFETY: freed once.
    unsafe { welkin_polarised_sky_free(polarised) };
    assert_eq!((rgb, stokes), ([7.0; 3], WelkinStokes::default()));
}

/// A component of a direction.
trait Component {
    fn read0(self, i: usize) -> f32;
}

impl Component for *const f32 {
    fn read0(self, i: usize) -> f32 {
        // SAFETY: the tests hand over pointers to three.
        unsafe { self.add(i).read() }
    }
}

/// Conditions of a program that is newer than the library.
#[repr(C)]
struct Newer {
    known: WelkinConditions,
    unknown: [f64; 2],
}

#[test]
fn structs_of_other_versions() {
    let model = default_model();
    let (given, _) = conditions();
    let mut sky = null_mut();
    for struct_size in [0, 8, 47, 5000, u64::MAX] {
        let wrong = WelkinConditions {
            struct_size,
            ..given
        };
        bad!(Struct: welkin_sky_new(model, &wrong, &mut sky));
        let mut fresh = given;
        bad!(Struct: welkin_conditions_init(&mut fresh, struct_size));
        assert_eq!(fresh.visibility, given.visibility);
    }
    let mut newer = Newer {
        known: given,
        unknown: [1.0; 2],
    };
    let p = (&raw mut newer).cast::<WelkinConditions>();
    // Filled as far as it goes, the rest with zeros.
    good!(welkin_conditions_init(p, size_of::<Newer>() as u64));
    assert_eq!(
        (newer.known.struct_size, newer.unknown),
        (size_of::<Newer>() as u64, [0.0; 2])
    );
    let p = (&raw mut newer).cast::<WelkinConditions>();
    let sky = make!(welkin_sky_new(model, p));
    newer.unknown[1] = 1.0;
    let p = (&raw mut newer).cast::<WelkinConditions>();
    let mut none = null_mut();
    assert!(bad!(Struct: welkin_sky_new(model, p, &mut none)).contains("newer"));
    // Written no farther than it goes.
    let mut back = Newer {
        known: given,
        unknown: [5.0; 2],
    };
    good!(welkin_sky_conditions(sky, &mut back.known));
    assert_eq!(back.unknown, [5.0; 2]);
    // SAFETY: each is freed once.
    unsafe {
        welkin_sky_free(sky);
        welkin_model_free(model);
    }
}

#[test]
fn the_abi_is_checked() {
    let good = WelkinAbi {
        version: WELKIN_ABI_VERSION,
        pointer: size_of::<usize>() as u32,
        error: size_of::<WelkinError>() as u32,
        conditions: size_of::<WelkinConditions>() as u32,
        polarisation_frame: size_of::<WelkinPolarisationFrame>() as u32,
        stokes: size_of::<WelkinStokes>() as u32,
        bake_error: size_of::<WelkinBakeError>() as u32,
        sample: size_of::<WelkinSample>() as u32,
        ranges: size_of::<WelkinRanges>() as u32,
        moon: size_of::<WelkinMoon>() as u32,
        budget: size_of::<WelkinBudget>() as u32,
        plan_summary: size_of::<WelkinPlanSummary>() as u32,
        camera_volume: size_of::<WelkinCameraVolume>() as u32,
        reserved: [0; 3],
    };
    good!(welkin_check_abi(&good));
    assert_eq!(welkin_abi_version(), WELKIN_ABI_VERSION);
    let other_major = WelkinAbi {
        version: WELKIN_ABI_VERSION + 65536,
        ..good
    };
    let newer = WelkinAbi {
        version: WELKIN_ABI_VERSION + 1,
        ..good
    };
    let larger = WelkinAbi {
        sample: good.sample + 4,
        ..good
    };
    let grown = WelkinAbi {
        conditions: good.conditions + 8,
        ..good
    };
    for wrong in [other_major, newer, larger, grown] {
        bad!(Abi: welkin_check_abi(&wrong));
    }
    assert!(bad!(Abi: welkin_check_abi(&larger)).contains("WelkinSample"));
}

#[test]
fn files_that_are_none_or_damaged() {
    let mut model = null_mut();
    assert!(
        bad!(Io: welkin_model_open(c"/no/such/file".as_ptr(), &mut model))
            .contains("/no/such/file")
    );
    bad!(Io: welkin_model_read(c"".as_ptr(), &mut model));
    bad!(Magic: welkin_model_from_bytes(b"no model at all".as_ptr(), 15, &mut model));
    let whole = library::DEFAULT_MODEL;
    bad!(Length: welkin_model_from_bytes(whole.as_ptr(), whole.len() / 2, &mut model));
    let mut head = whole.to_vec();
    head[200] ^= 1;
    bad!(Checksum: welkin_model_from_bytes(head.as_ptr(), head.len(), &mut model));
    assert!(model.is_null());
    // A chunk is found when it is touched.
    let mut chunk = whole.to_vec();
    let last = chunk.len() - 5000;
    chunk[last] ^= 0x55;
    let mut file = tempfile::NamedTempFile::new().unwrap();
    file.write_all(&chunk).unwrap();
    let path = CString::new(file.path().to_str().unwrap()).unwrap();
    let model = make!(welkin_model_open(path.as_ptr()));
    assert!(bad!(Checksum: welkin_model_verify(model)).contains("damaged"));
    // SAFETY: freed once.
    unsafe { welkin_model_free(model) };
}

#[test]
fn texts_are_cut_and_end() {
    let name = CString::new("ö".repeat(300)).unwrap();
    let mut space = 5;
    let text = bad!(Value: welkin_space_by_name(name.as_ptr(), &mut space));
    assert!(text.len() <= 255 && text.len() >= 250);
    bad!(Argument: welkin_space_by_name(c"\xff".as_ptr(), &mut space));
    assert_eq!(space, 5);
    good!(welkin_space_by_name(c"acescg".as_ptr(), &mut space));
    assert_eq!(space, WELKIN_SPACE_ACESCG);
}

#[test]
fn statuses_have_the_names_of_classes() {
    let name = |status: i32| {
        // SAFETY: static text.
        unsafe { std::ffi::CStr::from_ptr(welkin_status_name(status)) }
            .to_str()
            .unwrap()
    };
    assert_eq!(name(WelkinStatus::Ok as i32), "ok");
    assert_eq!(name(WelkinStatus::Range as i32), "range");
    assert_eq!(name(12345), "unknown");
}

#[test]
fn skies_that_do_not_belong_together_are_refused() {
    let scene = Scene::new();
    let (mut given, _) = conditions();
    given.visibility = 90e3;
    let aerial = make!(welkin_aerial_perspective_new(scene.model, &given));
    let ([mut light, mut factors], to) = ([[0.0; 3]; 2], [1e3, 0.0, 10.0]);
    let (l, f) = (light.as_mut_ptr(), factors.as_mut_ptr());
    let text =
        bad!(Range: welkin_aerial_perspective_joined_srgb(aerial, scene.sky, to.as_ptr(), l, f));
    assert!(text.contains("visibility"));
    // SAFETY: freed once.
    unsafe { welkin_aerial_perspective_free(aerial) };
}

#[test]
fn discs_of_another_sun_are_refused() {
    let scene = Scene::new();
    let (mut given, _) = conditions();
    let disc = make!(welkin_solar_disc_new(scene.model, &given));
    let mut sampler = make!(welkin_baked_colour_sky_sampler(scene.baked, disc));
    // SAFETY: freed once.
    unsafe { welkin_sky_sampler_free(sampler) };
    // A sky that was turned since, by more and by less than counts.
    for (turn, good) in [(1e-3, false), (-2e-4, false), (5e-5, true), (TAU, true)] {
        good!(welkin_baked_colour_sky_set_solar_azimuth(
            scene.baked,
            given.solar_azimuth + turn
        ));
        if good {
            sampler = make!(welkin_baked_colour_sky_sampler(scene.baked, disc));
            // SAFETY: freed once.
            unsafe { welkin_sky_sampler_free(sampler) };
        } else {
            sampler = std::ptr::dangling_mut();
            let text =
                bad!(Range: welkin_baked_colour_sky_sampler(scene.baked, disc, &mut sampler));
            assert!(text.contains("the disc is of a sun") && sampler.is_null());
        }
    }
    given.solar_elevation += 0.01;
    let higher = make!(welkin_solar_disc_new(scene.model, &given));
    bad!(Range: welkin_baked_colour_sky_sampler(scene.baked, higher, &mut sampler));
    // SAFETY: each is freed once.
    unsafe {
        welkin_solar_disc_free(disc);
        welkin_solar_disc_free(higher);
    }
}

#[test]
fn random_numbers_are_numbers() {
    let scene = Scene::new();
    let sampler = make!(welkin_baked_colour_sky_sampler(scene.baked, null()));
    let untouched = WelkinSample {
        direction: [7.0; 3],
        pdf: 7.0,
        xyz: [7.0; 3],
        part: 7,
    };
    let mut samples = [untouched; 2];
    for point in [[f32::NAN, 0.5], [0.5, f32::NAN]] {
        bad!(Range: welkin_sky_sampler_sample(sampler, point.as_ptr(), &mut samples[0]));
        let points = [0.5, 0.5, point[0], point[1]];
        bad!(Range: welkin_sky_sampler_sample_batch(sampler, points.as_ptr(), 2, samples.as_mut_ptr()));
    }
    assert_eq!(samples, [untouched; 2]);
    good!(welkin_sky_sampler_sample(
        sampler,
        [-1.0, f32::INFINITY].as_ptr(),
        &mut samples[0]
    ));
    assert!(samples[0].pdf > 0.0);
    // SAFETY: freed once.
    unsafe { welkin_sky_sampler_free(sampler) };
}
