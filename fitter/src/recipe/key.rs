//! A name for air: the same for the same air, another for any other.

use super::file::{Aerosol, File, Gases, Layer, Planet};
use serde::Serialize;
use std::collections::BTreeMap;

/// What the air depends on.
#[derive(Serialize)]
struct Air<'a> {
    planet: &'a Planet,
    gases: &'a Gases,
    aerosol: &'a Aerosol,
    layers: &'a BTreeMap<String, Layer>,
}

/// 32 hexadecimal digits.
pub fn key(file: &File) -> String {
    let air = Air {
        planet: &file.planet,
        gases: &file.gases,
        aerosol: &file.aerosol,
        layers: &file.layers,
    };
    let text = serde_json::to_vec(&air).expect("fields and finite numbers");
    format!("{:032x}", fowler_noll_vo(&text))
}

/// FNV-1a of 128 bits.
fn fowler_noll_vo(bytes: &[u8]) -> u128 {
    const BASIS: u128 = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
    const PRIME: u128 = 0x0000_0000_0100_0000_0000_0000_0000_013b;
    let step = |hash: u128, byte: &u8| (hash ^ u128::from(*byte)).wrapping_mul(PRIME);
    bytes.iter().fold(BASIS, step)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Test vectors of draft-eastlake-fnv.
    #[test]
    fn the_hash_is_the_published_one() {
        assert_eq!(
            fowler_noll_vo(b""),
            0x6c62_272e_07bb_0142_62b8_2175_6295_c58d
        );
        assert_eq!(
            fowler_noll_vo(b"a"),
            0xd228_cb69_6f1a_8caf_7891_2b70_4e4a_8964
        );
    }
}
