//! What readers are asked, and what they say.

use crate::bytes::Bytes;
use welkin::{Conditions, Model};

/// In the order of the C reader's enumeration.
pub const QUANTITIES: [&str; 14] = [
    "relative_radiance",
    "relative_radiance_at",
    "radiance_at",
    "xyz",
    "stokes",
    "stokes_at",
    "transmittance",
    "in_scattering",
    "in_scattering_stokes",
    "transmittance_at",
    "in_scattering_at",
    "in_scattering_stokes_at",
    "wavelength_range",
    "sunlight_at",
];

/// Cells as in the conformance suite: altitude, visibility, albedo, elevation and azimuth of the sun, direction,
/// wavelength, distance.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Question {
    pub quantity: u32,
    pub dense: u32,
    pub cells: [f64; 10],
}

/// Values, or the class of an error.
pub type Answer = Result<Vec<f64>, String>;

/// Ranges of conditions, as far as the head can be read.
pub struct Ranges {
    altitude: [f64; 2],
    visibility: [f64; 2],
    elevation: [f64; 2],
    wavelength: [f64; 2],
    nodes: Vec<f64>,
}

impl Ranges {
    pub fn of(model: Option<&Model>) -> Self {
        let Some(model) = model else {
            return Self {
                altitude: [0.0, 1e3],
                visibility: [2e4, 8e4],
                elevation: [0.0, 1.0],
                wavelength: [400.0, 700.0],
                nodes: vec![550.0],
            };
        };
        Self {
            altitude: model.altitude_range(),
            visibility: model.visibility_range(),
            elevation: model.solar_elevation_range(),
            wavelength: model.wavelength_range().unwrap_or([400.0, 700.0]),
            nodes: model.wavelengths().to_vec(),
        }
    }
}

impl Question {
    pub fn name(&self) -> &'static str {
        QUANTITIES[self.quantity as usize]
    }

    /// Of the light or the air of a segment.
    pub fn is_segment(&self) -> bool {
        self.is_transmittance() || self.name().starts_with("in_scattering")
    }

    pub fn is_transmittance(&self) -> bool {
        self.name().starts_with("transmittance")
    }

    pub fn has_wavelength(&self) -> bool {
        self.name().ends_with("_at")
    }

    /// Whether what lies between the nodes decides.
    pub fn needs_spectrum(&self) -> bool {
        self.has_wavelength() || self.name() == "wavelength_range"
    }

    pub fn conditions(&self) -> Conditions {
        let [
            altitude,
            visibility,
            albedo,
            solar_elevation,
            solar_azimuth,
            ..,
        ] = self.cells;
        Conditions {
            altitude,
            visibility,
            albedo,
            solar_elevation,
            solar_azimuth,
        }
    }

    pub fn line(&self) -> String {
        let cells = self.cells.iter().map(|cell| format!("{cell:?}"));
        let cells: Vec<String> = cells.collect();
        format!("{}\t{}", self.name(), cells.join("\t"))
    }

    /// Whether a condition is out of its range, by more than rounding.
    pub fn is_outside(&self, ranges: &Ranges) -> bool {
        let outside = |value: f64, [low, high]: [f64; 2]| {
            let slack = 1e-9 * low.abs().max(high.abs());
            !(low - slack..=high + slack).contains(&value)
        };
        if self.name() == "wavelength_range" {
            return false;
        }
        let [altitude, visibility, albedo, elevation, ..] = self.cells;
        // In a depression.
        let altitude = if (-500.0..0.0).contains(&altitude) {
            0.0
        } else {
            altitude
        };
        let scene = outside(albedo, [0.0, 1.0]) || outside(elevation, ranges.elevation);
        outside(visibility, ranges.visibility)
            || !self.is_transmittance() && scene
            || !self.is_segment() && outside(altitude, ranges.altitude)
    }
}

/// Every quantity about a few scenes; the first question of each scene is the radiance of the zenith.
pub fn questions(bytes: &mut Bytes, ranges: &Ranges) -> Vec<Question> {
    let scenes = 1 + bytes.below(2);
    (0..scenes).flat_map(|_| scene(bytes, ranges)).collect()
}

pub const PER_SCENE: usize = QUANTITIES.len() + 1;

fn scene(bytes: &mut Bytes, ranges: &Ranges) -> Vec<Question> {
    let altitude = coordinate(bytes, ranges.altitude);
    let visibility = coordinate(bytes, ranges.visibility);
    let albedo = coordinate(bytes, [0.0, 1.0]);
    let elevation = coordinate(bytes, ranges.elevation);
    let azimuth = 6.0 * bytes.unit() - 3.0;
    let wavelength = match bytes.below(8) {
        0 => bytes.one_of(&ranges.nodes),
        _ => coordinate(bytes, ranges.wavelength),
    };
    let direction = direction(bytes, [elevation, azimuth]);
    let distance = [1.0, 37.0, 900.0, 2e4, 5e4, 1e6][bytes.below(6)];
    let dense = bytes.below(2) as u32;
    let ask = |quantity: usize, direction: [f64; 3]| {
        let [x, y, z] = direction;
        Question {
            quantity: quantity as u32,
            dense,
            cells: [
                altitude, visibility, albedo, elevation, azimuth, x, y, z, wavelength, distance,
            ],
        }
    };
    let zenith = ask(0, [0.0, 0.0, 1.0]);
    let others = (0..QUANTITIES.len()).map(|quantity| ask(quantity, direction));
    std::iter::once(zenith).chain(others).collect()
}

/// An end, near an end, beyond an end, or anything within.
fn coordinate(bytes: &mut Bytes, [low, high]: [f64; 2]) -> f64 {
    let size = low.abs().max(high.abs());
    match bytes.below(24) {
        0 => low,
        1 => high,
        2 => high + 5e-10 * size,
        3 => low - 5e-10 * size,
        4 => high + 0.01 * size,
        5 => low - 0.01 * size,
        _ => low + (high - low) * bytes.unit(),
    }
}

/// Any direction; up, down, level, or towards the sun.
fn direction(bytes: &mut Bytes, [elevation, azimuth]: [f64; 2]) -> [f64; 3] {
    let length = [1.0, 1.0, 1.0, 1e-3, 1e20][bytes.below(5)];
    let (high, turned) = match bytes.below(12) {
        0 => (1.5707963, 0.0),
        1 => (-1.5707963, 0.0),
        2 => (0.0, 6.28 * bytes.unit()),
        3 => (elevation, azimuth),
        4 => (elevation + 0.01, azimuth + 0.01),
        _ => ((2.0 * bytes.unit() - 1.0).asin(), 6.28 * bytes.unit()),
    };
    let (z, level) = high.sin_cos();
    let (y, x) = turned.sin_cos();
    [level * x, level * y, z].map(|v| f64::from((v * length) as f32))
}
