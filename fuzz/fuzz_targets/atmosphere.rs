//! Any text as a JSON atmosphere: an error, or an atmosphere whose numbers are finite.
#![no_main]

#[path = "../../fitter/src/atmosphere/mod.rs"]
#[allow(dead_code)]
mod atmosphere;
#[path = "../../fitter/src/non_negative.rs"]
#[allow(dead_code)]
mod non_negative;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let Ok(case) = atmosphere::json::Case::parse(text) else {
        return;
    };
    let air = &case.atmosphere;
    for altitude in [0.0, 1.0, 0.5 * air.top(), air.top()] {
        let extinction = air.extinction(altitude, 0);
        assert!(
            extinction.is_finite() && extinction >= 0.0,
            "{extinction} at {altitude} m"
        );
    }
});
