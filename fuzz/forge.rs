//! Makes lengths and checksums of a file right, so that the fuzzer spends its time behind them; and asks a model
//! everything.

#![forbid(unsafe_code)]

use welkin::{
    AerialPerspective, Conditions, Model, PolarisationFrame, PolarisedSky, Stokes, StokesSpectra,
    Transmittance,
};

/// `data` with the length of the file and all checksums that can be found set right.
pub fn forged(data: &[u8]) -> Vec<u8> {
    let mut bytes = data.to_vec();
    if bytes.len() < 128 {
        return bytes;
    }
    let length = bytes.len() as u64;
    bytes[16..24].copy_from_slice(&length.to_le_bytes());
    let head = usize::try_from(u64_at(&bytes, 24))
        .unwrap_or(0)
        .min(bytes.len());
    let count = u32::from_le_bytes(bytes[36..40].try_into().expect("four bytes")) as usize;
    let directory = head.saturating_sub(count.saturating_mul(64));
    for entry in (directory..head)
        .step_by(64)
        .filter(|e| *e >= 128 && e + 64 <= head)
    {
        let (offset, stored) = (u64_at(&bytes, entry + 8), u64_at(&bytes, entry + 16));
        let end = offset.saturating_add(stored);
        if (head as u64..=length).contains(&offset) && end <= length {
            let crc = crc32fast::hash(&bytes[offset as usize..end as usize]);
            bytes[entry + 36..entry + 40].copy_from_slice(&crc.to_le_bytes());
        }
    }
    bytes[32..36].fill(0);
    let crc = crc32fast::hash(&bytes[..head]);
    bytes[32..36].copy_from_slice(&crc.to_le_bytes());
    bytes
}

fn u64_at(bytes: &[u8], at: usize) -> u64 {
    u64::from_le_bytes(bytes[at..at + 8].try_into().expect("eight bytes"))
}

/// Segments that are level, rise out of the air, dip below the ground, are short, or have no length.
const SEGMENTS: [[[f64; 3]; 2]; 5] = [
    [[0.0, 0.0, 2.0], [9e4, 0.0, 2.0]],
    [[0.0, 0.0, 9e3], [1e5, 2e5, 3e5]],
    [[0.0, 0.0, 500.0], [3e4, 1e4, -4e3]],
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
    [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
];

/// Transmittance of segments is in 0..=1.
pub fn look_through(air: &Transmittance) {
    let mut through = vec![0.0; air.wavelengths().len()];
    for [from, to] in SEGMENTS {
        air.transmittance(from, to, &mut through)
            .expect("valid points");
        assert!(
            through.iter().all(|t| (0.0..=1.0).contains(t)),
            "{through:?}"
        );
    }
}

/// Light of segments is finite and not negative.
pub fn look_into(aerial: &AerialPerspective) {
    for [from, to] in SEGMENTS {
        scatter(aerial, from, to);
    }
}

/// Light and transmittance of one segment.
pub fn scatter(aerial: &AerialPerspective, from: [f64; 3], to: [f64; 3]) {
    let mut light = vec![0.0; aerial.wavelengths().len()];
    let mut through = light.clone();
    if aerial
        .in_scattering(from, to, &mut light, &mut through)
        .is_ok()
    {
        assert!(
            light.iter().all(|l| l.is_finite() && *l >= 0.0),
            "{light:?}"
        );
        assert!(
            through.iter().all(|t| (0.0..=1.0).contains(t)),
            "{through:?}"
        );
        let (mut i, mut q, mut u) = (light.clone(), light.clone(), light.clone());
        let spectra = StokesSpectra {
            i: &mut i,
            q: &mut q,
            u: &mut u,
        };
        aerial
            .in_scattering_stokes(from, to, PolarisationFrame::Vertical, spectra, &mut through)
            .expect("the same points");
        let parts = i.iter().zip(&q).zip(&u);
        let stokes: Vec<_> = parts.map(|((&i, &q), &u)| Stokes { i, q, u }).collect();
        check_polarised(&stokes);
        let (colour, factor) = aerial.xyz(from, to).expect("the same points");
        assert!(colour.iter().chain(&factor).all(|v| v.is_finite()));
    }
}

/// Everything at one wavelength is finite and in its range.
fn look_between(model: &Model, conditions: &Conditions, wavelength: f64) {
    let (frame, [from, to]) = (PolarisationFrame::Vertical, SEGMENTS[1]);
    let bright = |l: f32| assert!(l.is_finite() && l >= 0.0, "{l}");
    if let Ok(air) = model.transmittance(conditions.visibility) {
        let through = air
            .transmittance_at(from, to, wavelength)
            .expect("valid points");
        assert!((0.0..=1.0).contains(&through), "{through}");
    }
    if let Ok(disc) = model.solar_disc(conditions) {
        bright(
            disc.radiance_at(disc.direction(), wavelength)
                .expect("a wavelength of the model"),
        );
    }
    if let Ok(sky) = model.polarised_sky(conditions) {
        let light = sky.stokes_at([0.3, -0.2, 0.5], frame, wavelength);
        check_polarised(&[light.expect("a wavelength of the model")]);
    }
    if let Ok(aerial) = model.aerial_perspective(conditions) {
        bright(
            aerial
                .in_scattering_at(from, to, wavelength)
                .expect("valid points"),
        );
        let light = aerial.relative_stokes_at(from, to, frame, wavelength);
        check_polarised(&[light.expect("valid points")]);
    }
}

/// Stokes vectors are finite, and no light is more than polarised.
pub fn look_polarised(sky: &PolarisedSky, direction: [f32; 3]) {
    let mut light = vec![Stokes::default(); sky.sky().wavelengths().len()];
    if sky
        .relative_stokes(direction, PolarisationFrame::Vertical, &mut light)
        .is_ok()
    {
        check_polarised(&light);
    }
}

fn check_polarised(light: &[Stokes]) {
    for stokes in light {
        assert!(stokes.i.is_finite() && stokes.q.is_finite() && stokes.u.is_finite());
        // Subnormal numbers have few digits.
        assert!(
            stokes.q.hypot(stokes.u) <= 1.001 * stokes.i + 1e-40,
            "{stokes:?}"
        );
    }
}

/// Skies, Stokes vectors and aerial perspective at the ends and in the middle of the model: errors, or finite numbers
/// in their ranges.
pub fn interrogate(model: &Model) {
    let _ = model.verify();
    let [altitudes, visibilities, elevations] = [
        model.altitude_range(),
        model.visibility_range(),
        model.solar_elevation_range(),
    ];
    for t in [0.0, 0.3, 1.0] {
        let within = |[low, high]: [f64; 2]| (low + t * (high - low)).clamp(low, high);
        let conditions = Conditions {
            altitude: within(altitudes),
            visibility: within(visibilities),
            solar_elevation: within(elevations),
            albedo: t,
            ..Conditions::default()
        };
        if let Ok(air) = model.transmittance(conditions.visibility) {
            look_through(&air);
        }
        if let Ok(range) = model.wavelength_range() {
            look_between(model, &conditions, within(range));
        }
        if let Ok(aerial) = model.aerial_perspective(&conditions) {
            look_into(&aerial);
        }
        if let Ok(sky) = model.polarised_sky(&conditions) {
            look_polarised(&sky, [0.3, -0.2, 0.5]);
        }
        if let Ok(sky) = model.sky(&conditions) {
            let mut out = vec![0.0; sky.wavelengths().len()];
            for direction in [[0.0, 0.0, 1.0], [1.0, 0.0, 0.01], [0.3, -0.2, -0.5]] {
                sky.radiance(direction, &mut out)
                    .expect("a valid direction");
                assert!(out.iter().all(|l| l.is_finite() && *l >= 0.0));
                let xyz = sky.xyz(direction).expect("a valid direction");
                assert!(xyz.iter().all(|v| v.is_finite()));
                let range = model
                    .wavelength_range()
                    .expect("the sky has read the spectrum");
                let wavelength = within(range);
                let l = sky
                    .radiance_at(direction, wavelength)
                    .expect("a wavelength of the model");
                assert!(l.is_finite() && l >= 0.0);
            }
        }
    }
}
