//! The 81 directions of a scan of Kider et al. 2014, in the order in which they are measured: four rings and the
//! zenith, every ring turning the other way than the one before.

/// Number of directions.
pub const SAMPLES: usize = 81;
/// How far a name may be off, degrees: names are rounded.
const ROUNDED: f64 = 0.06;

/// A ring of directions.
struct Ring {
    /// Degrees.
    elevation: f64,
    count: usize,
    /// Azimuth of the first, degrees.
    first: f64,
    /// To the next one, degrees.
    step: f64,
}

const RINGS: [Ring; 5] = [
    Ring {
        elevation: 12.1151,
        count: 32,
        first: 0.0,
        step: 11.25,
    },
    Ring {
        elevation: 33.749,
        count: 24,
        first: 345.0,
        step: -15.0,
    },
    Ring {
        elevation: 53.3665,
        count: 16,
        first: 0.0,
        step: 22.5,
    },
    Ring {
        elevation: 71.9187,
        count: 8,
        first: 315.0,
        step: -45.0,
    },
    Ring {
        elevation: 90.0,
        count: 1,
        first: 0.0,
        step: 0.0,
    },
];

/// Azimuth and elevation in degrees as the names say them, azimuth counter-clockwise from the north.
pub fn named(index: usize) -> Option<[f64; 2]> {
    let mut before = 0;
    for ring in RINGS {
        if index < before + ring.count {
            let azimuth = ring.first + ring.step * (index - before) as f64;
            return Some([azimuth.rem_euclid(360.0), ring.elevation]);
        }
        before += ring.count;
    }
    None
}

/// Whether a direction is the one of this index.
pub fn is_at(index: usize, [azimuth, elevation]: [f64; 2]) -> bool {
    let Some([wanted, height]) = named(index) else {
        return false;
    };
    let turn = (azimuth - wanted + 180.0).rem_euclid(360.0) - 180.0;
    // The azimuth of the zenith means nothing.
    let turned = height > 89.0 || turn.abs() < ROUNDED;
    turned && (elevation - height).abs() < ROUNDED
}

/// Elevations of the rings, degrees.
pub fn rings() -> [f64; 5] {
    RINGS.map(|ring| ring.elevation)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rings_are_full() {
        assert_eq!(named(20), Some([225.0, 12.1151]));
        assert_eq!(named(21), Some([236.25, 12.1151]));
        assert_eq!(named(32), Some([345.0, 33.749]));
        assert_eq!(named(55), Some([0.0, 33.749]));
        assert_eq!(named(59), Some([67.5, 53.3665]));
        assert_eq!(named(66), Some([225.0, 53.3665]));
        assert_eq!(named(79), Some([0.0, 71.9187]));
        assert_eq!(named(80), Some([0.0, 90.0]));
        assert_eq!(named(SAMPLES), None);
        assert!(is_at(80, [270.0, 90.0]) && !is_at(20, [135.0, 12.1151]));
        assert!(is_at(0, [359.99, 12.12]) && !is_at(81, [0.0, 90.0]));
    }
}
