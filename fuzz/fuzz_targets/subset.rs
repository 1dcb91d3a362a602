//! Any file, cut by any selection: an error, or a file that conforms.
//!
//! The selection is in the bytes of the head's checksum, which is made right before the file is read.
#![no_main]

use libfuzzer_sys::fuzz_target;
use welkin::Model;
use welkin::format::{
    ENCODING_RAW, ENCODING_ZSTD, Selection, crop, encode, recode, unpack, verify,
};
use welkin_fuzz::{forged, interrogate};

fuzz_target!(|data: &[u8]| {
    let Some(bits) = data.get(32..36) else {
        return;
    };
    let bits = u32::from_le_bytes(bits.try_into().expect("four bytes"));
    let file = forged(data);
    let Ok((mut head, mut chunks)) = unpack(&file) else {
        return;
    };
    let all = Selection::all(&head);
    let some = |indices: &[usize], shift: u32| {
        let kept = indices
            .iter()
            .filter(|i| bits >> (shift + (**i as u32 % 8)) & 1 == 1);
        kept.copied().collect()
    };
    let selection = Selection {
        altitudes: some(&all.altitudes, 0),
        visibilities: some(&all.visibilities, 8),
        wavelengths: some(&all.wavelengths, 16),
    };
    let possible = !selection.altitudes.is_empty()
        && !selection.visibilities.is_empty()
        && !selection.wavelengths.is_empty();
    assert_eq!(crop(&mut head, &mut chunks, &selection).is_ok(), possible);
    if !possible {
        return;
    }
    // One wavelength is too few, and without its ends the solar spectrum may end early.
    let Ok(small) = encode(&head, &chunks) else {
        return;
    };
    assert!(verify(&small).is_empty());
    let packed = recode(&small, ENCODING_ZSTD).expect("a valid file");
    assert!(verify(&packed).is_empty());
    assert!(recode(&packed, ENCODING_RAW).expect("a valid file") == small);
    interrogate(&Model::from_bytes(packed).expect("a valid file"));
});
