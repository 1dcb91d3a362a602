//! Any bytes: an error or a model whose skies are finite.
#![no_main]

use libfuzzer_sys::fuzz_target;
use welkin::{Conditions, Model};

fuzz_target!(|data: &[u8]| {
    let Ok(model) = Model::from_bytes(repaired(data)) else {
        return;
    };
    let Ok(conditions) = Conditions::default().clamped(&model) else {
        return;
    };
    let Ok(sky) = model.sky(&conditions) else {
        return;
    };
    let mut out = vec![0.0; sky.wavelengths().len()];
    for direction in [[0.0, 0.0, 1.0], [1.0, 0.0, 0.01], [0.3, -0.2, -0.5]] {
        sky.radiance(direction, &mut out).expect("a valid direction");
        assert!(out.iter().all(|l| l.is_finite() && *l >= 0.0));
    }
});

/// Sets the head's length field and checksum right, so that the fuzzer spends its time behind them.
fn repaired(data: &[u8]) -> Vec<u8> {
    let mut bytes = data.to_vec();
    if bytes.len() < 128 {
        return bytes;
    }
    let length = bytes.len() as u64;
    bytes[16..24].copy_from_slice(&length.to_le_bytes());
    let head = u64::from_le_bytes(bytes[24..32].try_into().expect("eight bytes"));
    let head = usize::try_from(head).unwrap_or(0).min(bytes.len());
    bytes[32..36].fill(0);
    let crc = crc32fast::hash(&bytes[..head]);
    bytes[32..36].copy_from_slice(&crc.to_le_bytes());
    bytes
}
