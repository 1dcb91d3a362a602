//! Makes lengths and checksums of a file right, so that the fuzzer spends its time behind them; and asks a model
//! everything.

use welkin::{Conditions, Model};

/// `data` with the length of the file and all checksums that can be found set right.
pub fn forged(data: &[u8]) -> Vec<u8> {
    let mut bytes = data.to_vec();
    if bytes.len() < 128 {
        return bytes;
    }
    let length = bytes.len() as u64;
    bytes[16..24].copy_from_slice(&length.to_le_bytes());
    let head = usize::try_from(u64_at(&bytes, 24)).unwrap_or(0).min(bytes.len());
    let count = u32::from_le_bytes(bytes[36..40].try_into().expect("four bytes")) as usize;
    let directory = head.saturating_sub(count.saturating_mul(64));
    for entry in (directory..head).step_by(64).filter(|e| *e >= 128 && e + 64 <= head) {
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

/// Skies at the ends and in the middle of the model: errors, or finite radiances that are not negative.
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
        if let Ok(sky) = model.sky(&conditions) {
            let mut out = vec![0.0; sky.wavelengths().len()];
            for direction in [[0.0, 0.0, 1.0], [1.0, 0.0, 0.01], [0.3, -0.2, -0.5]] {
                sky.radiance(direction, &mut out).expect("a valid direction");
                assert!(out.iter().all(|l| l.is_finite() && *l >= 0.0));
                let xyz = sky.xyz(direction).expect("a valid direction");
                assert!(xyz.iter().all(|v| v.is_finite()));
                let wavelength = within(model.wavelength_range());
                let l = sky.radiance_at(direction, wavelength).expect("a wavelength of the model");
                assert!(l.is_finite() && l >= 0.0);
            }
        }
    }
}
