//! Breaks and conditions of the published data.

use crate::official::layout::{PolarisationBreaks, RadianceBreaks};

/// Visibilities, km.
pub const VISIBILITIES: [f64; 6] = [20.0, 27.6, 40.0, 59.4, 90.0, 131.8];
/// Ground albedos.
pub const ALBEDOS: [f64; 4] = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0];
/// Solar elevations, degrees.
pub const ELEVATIONS: [f64; 30] = [
    -4.2, -4.0, -3.5, -3.0, -2.5, -2.0, -1.5, -1.0, -0.5, 0.0, 1.0, 2.85, 5.23, 8.05, 11.25, 14.79,
    18.64, 22.77, 27.17, 31.82, 36.71, 41.83, 47.16, 52.71, 58.46, 64.40, 70.53, 76.84, 83.34,
    90.0,
];
/// Altitudes of the transmittance, m.
pub const ALTITUDES: [f64; 22] = [
    0.0, 1.875, 15.0, 50.625, 120.0, 234.38, 405.0, 643.12, 960.0, 1366.9, 1875.0, 2000.0, 2495.6,
    3240.0, 4119.4, 5145.0, 6328.1, 7680.0, 9211.9, 10_935.0, 12_861.0, 15_000.0,
];

/// First, last and step, degrees.
type Part = (f64, f64, f64);

fn breaks(parts: &[Part]) -> Vec<f64> {
    let part = |&(first, last, step): &Part| {
        let count = ((last - first) / step).round() as usize;
        (0..=count).map(move |i| (first + step * i as f64).to_radians())
    };
    parts.iter().flat_map(part).collect()
}

/// Breaks of the radiance, as published.
pub fn radiance(rank: usize) -> RadianceBreaks {
    RadianceBreaks {
        rank,
        sun: breaks(&[(-1.0, 90.0, 0.5), (91.0, 182.0, 1.0)]),
        zenith: breaks(&[(-2.0, 80.0, 1.0), (80.5, 100.0, 0.5), (101.0, 182.0, 1.0)]),
        emphasis: breaks(&[
            (0.0, 0.0, 1.0),
            (87.5, 95.0, 0.25),
            (95.5, 95.5, 1.0),
            (96.0, 180.0, 1.0),
        ]),
    }
}

/// Breaks of the polarisation, of our own choice: degrees change slowly but near the sun and the horizon.
pub fn polarisation(rank: usize) -> PolarisationBreaks {
    PolarisationBreaks {
        rank,
        sun: breaks(&[(-2.0, 38.0, 1.0), (40.0, 182.0, 2.0)]),
        zenith: breaks(&[(-2.0, 78.0, 2.0), (79.0, 101.0, 1.0), (102.0, 182.0, 2.0)]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_as_many_breaks_as_published() {
        let radiance = radiance(9);
        assert_eq!(radiance.sun.len(), 275);
        assert_eq!(radiance.zenith.len(), 205);
        assert_eq!(radiance.emphasis.len(), 118);
        // Floats per sky and channel.
        assert_eq!(radiance.bytes(), 8948);
    }
}
