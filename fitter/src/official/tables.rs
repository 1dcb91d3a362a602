//! The factors of one sky in one channel.

use super::error::{OfficialError, Result, Section};
use super::layout::{PolarisationBreaks, RadianceBreaks};
use half::f16;

/// A place between two breaks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    segment: usize,
    weight: f64,
}

impl Place {
    /// Of an angle among increasing `breaks`; beyond them the nearest.
    pub fn new(breaks: &[f64], angle: f64) -> Self {
        let angle = angle.clamp(breaks[0], breaks[breaks.len() - 1]);
        let after = breaks.partition_point(|b| *b <= angle);
        let segment = after.clamp(1, breaks.len() - 1) - 1;
        let [low, high] = [breaks[segment], breaks[segment + 1]];
        Self {
            segment,
            weight: (angle - low) / (high - low),
        }
    }

    /// The first of the two breaks.
    pub fn segment(self) -> usize {
        self.segment
    }

    /// What the two breaks count.
    pub fn weights(self) -> [f64; 2] {
        [1.0 - self.weight, self.weight]
    }

    /// What a table over the breaks says here.
    pub fn of(self, table: &[f32]) -> f64 {
        let [low, high] = [table[self.segment], table[self.segment + 1]].map(f64::from);
        low + self.weight * (high - low)
    }
}

/// Σ_r sun_r · zenith_r at a place.
fn sum(sun: &[f32], zenith: &[f32], lengths: [usize; 2], at: [Place; 2]) -> f64 {
    let rows = sun
        .chunks_exact(lengths[0])
        .zip(zenith.chunks_exact(lengths[1]));
    rows.map(|(s, z)| at[0].of(s) * at[1].of(z)).sum()
}

/// Factors of the radiance, W m⁻² sr⁻¹ nm⁻¹.
#[derive(Clone, Debug, PartialEq)]
pub struct RadianceTables {
    /// `[rank][sun break]`.
    pub sun: Vec<f32>,
    /// `[rank][zenith break]`.
    pub zenith: Vec<f32>,
    /// `[emphasis break]`.
    pub emphasis: Vec<f32>,
}

impl RadianceTables {
    /// From the bytes of the file, of which there are as many as the breaks say.
    pub(super) fn decode(breaks: &RadianceBreaks, bytes: &[u8]) -> Result<Self> {
        let mut rest = bytes;
        let mut tables = Self {
            sun: vec![],
            zenith: vec![],
            emphasis: vec![],
        };
        for _ in 0..breaks.rank {
            tables.sun.extend(halves(&mut rest, breaks.sun.len()));
            let scale = scale(&mut rest)?;
            let zenith = halves(&mut rest, breaks.zenith.len());
            // Single precision is what the official code keeps.
            tables
                .zenith
                .extend(zenith.map(|z| (f64::from(z) / scale) as f32));
        }
        tables
            .emphasis
            .extend(halves(&mut rest, breaks.emphasis.len()));
        tables.check()?;
        Ok(tables)
    }

    /// As [`RadianceTables::decode`] reads it. The scale of a component makes the most of half precision.
    pub(super) fn encode(&self, breaks: &RadianceBreaks) -> Result<Vec<u8>> {
        self.check_lengths(breaks)?;
        self.check()?;
        let mut bytes = Vec::with_capacity(breaks.bytes() as usize);
        let suns = self.sun.chunks_exact(breaks.sun.len());
        for (sun, zenith) in suns.zip(self.zenith.chunks_exact(breaks.zenith.len())) {
            push_halves(&mut bytes, "a sun factor", sun.iter().copied())?;
            let scale = fitting_scale(zenith);
            bytes.extend_from_slice(&scale.to_le_bytes());
            let scaled = zenith.iter().map(|z| (f64::from(*z) * scale) as f32);
            push_halves(&mut bytes, "a zenith factor", scaled)?;
        }
        push_halves(&mut bytes, "emphasis", self.emphasis.iter().copied())?;
        Ok(bytes)
    }

    /// Memory of the factors.
    pub fn bytes(&self) -> usize {
        let numbers = self.sun.len() + self.zenith.len() + self.emphasis.len();
        numbers * size_of::<f32>()
    }

    /// Radiance at places among the breaks of the angle to the sun, of the zenith angle and of the emphasis.
    pub fn at(&self, breaks: &RadianceBreaks, [sun, zenith, emphasis]: [Place; 3]) -> f64 {
        let lengths = [breaks.sun.len(), breaks.zenith.len()];
        let sum = sum(&self.sun, &self.zenith, lengths, [sun, zenith]);
        (emphasis.of(&self.emphasis) * sum).max(0.0)
    }

    fn check(&self) -> Result<()> {
        let parts = [
            ("a sun factor", &self.sun),
            ("a zenith factor", &self.zenith),
            ("emphasis", &self.emphasis),
        ];
        for (what, values) in parts {
            check_finite(Section::Radiance, what, values)?;
        }
        Ok(())
    }

    fn check_lengths(&self, breaks: &RadianceBreaks) -> Result<()> {
        let got = [self.sun.len(), self.zenith.len(), self.emphasis.len()];
        let expected = [
            breaks.rank * breaks.sun.len(),
            breaks.rank * breaks.zenith.len(),
            breaks.emphasis.len(),
        ];
        match got == expected {
            true => Ok(()),
            false => Err(OfficialError::value(
                Section::Radiance,
                "lengths of tables",
                format!("expected {expected:?}, got {got:?}"),
            )),
        }
    }
}

/// Factors of the degree of polarisation.
#[derive(Clone, Debug, PartialEq)]
pub struct PolarisationTables {
    /// `[rank][sun break]`.
    pub sun: Vec<f32>,
    /// `[rank][zenith break]`.
    pub zenith: Vec<f32>,
}

impl PolarisationTables {
    /// From the numbers of the file, of which there are as many as the breaks say.
    pub(super) fn decode(breaks: &PolarisationBreaks, values: &[f32]) -> Result<Self> {
        check_finite(Section::Polarisation, "a factor", values)?;
        let mut tables = Self {
            sun: vec![],
            zenith: vec![],
        };
        for component in values.chunks_exact(breaks.sun.len() + breaks.zenith.len()) {
            let (sun, zenith) = component.split_at(breaks.sun.len());
            tables.sun.extend(sun);
            tables.zenith.extend(zenith);
        }
        Ok(tables)
    }

    /// As [`PolarisationTables::decode`] reads it.
    pub(super) fn encode(&self, breaks: &PolarisationBreaks) -> Result<Vec<u8>> {
        let got = [self.sun.len(), self.zenith.len()];
        let expected = [breaks.sun.len(), breaks.zenith.len()].map(|n| n * breaks.rank);
        if got != expected {
            return Err(OfficialError::value(
                Section::Polarisation,
                "lengths of tables",
                format!("expected {expected:?}, got {got:?}"),
            ));
        }
        let suns = self.sun.chunks_exact(breaks.sun.len());
        let rows = suns.zip(self.zenith.chunks_exact(breaks.zenith.len()));
        let values: Vec<f32> = rows.flat_map(|(s, z)| [s, z].concat()).collect();
        check_finite(Section::Polarisation, "a factor", &values)?;
        Ok(values.iter().flat_map(|v| v.to_le_bytes()).collect())
    }

    /// The stored number at places among the breaks of the angle to the sun and of the zenith angle: the degree of
    /// polarisation with the opposite sign.
    pub fn at(&self, breaks: &PolarisationBreaks, at: [Place; 2]) -> f64 {
        let lengths = [breaks.sun.len(), breaks.zenith.len()];
        sum(&self.sun, &self.zenith, lengths, at)
    }
}

pub(super) fn check_finite(section: Section, what: &'static str, values: &[f32]) -> Result<()> {
    match values.iter().find(|v| !v.is_finite()) {
        None => Ok(()),
        Some(bad) => Err(OfficialError::value(section, what, format!("got {bad}"))),
    }
}

/// The next numbers in half precision.
fn halves<'a>(rest: &mut &'a [u8], count: usize) -> impl Iterator<Item = f32> + use<'a> {
    let (part, tail) = rest.split_at(2 * count);
    *rest = tail;
    let (words, _) = part.as_chunks();
    words.iter().map(|w| f16::from_le_bytes(*w).to_f32())
}

/// What the zenith factors of the next component are stored times.
fn scale(rest: &mut &[u8]) -> Result<f64> {
    let (bytes, tail) = rest.split_at(8);
    *rest = tail;
    let scale = f64::from_le_bytes(std::array::from_fn(|i| bytes[i]));
    match scale.is_finite() && scale != 0.0 {
        true => Ok(scale),
        false => Err(OfficialError::value(
            Section::Radiance,
            "a zenith scale",
            format!("got {scale}"),
        )),
    }
}

/// The power of two by which the largest value comes to 8192 or above: into half precision, and far from its subnormals.
fn fitting_scale(values: &[f32]) -> f64 {
    let largest = values
        .iter()
        .fold(0.0, |m: f64, v| m.max(f64::from(v.abs())));
    match largest > 0.0 {
        true => (13.0 - largest.log2().floor()).exp2(),
        false => 1.0,
    }
}

fn push_halves(
    bytes: &mut Vec<u8>,
    what: &'static str,
    values: impl Iterator<Item = f32>,
) -> Result<()> {
    for value in values {
        let half = f16::from_f32(value);
        if !half.is_finite() {
            let detail = format!("{value} is too large for half precision");
            return Err(OfficialError::value(Section::Radiance, what, detail));
        }
        bytes.extend_from_slice(&half.to_le_bytes());
    }
    Ok(())
}
