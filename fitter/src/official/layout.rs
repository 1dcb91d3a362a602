//! What the numbers of a file stand for: axes, channels, breaks, and the sizes that follow from them.

use super::error::{OfficialError, Result, Section};
use std::f64::consts::PI;

/// Most nodes of an axis.
pub const MOST_NODES: usize = 1024;
/// Most channels.
pub const MOST_CHANNELS: usize = 4096;
/// Most components.
pub const MOST_RANK: usize = 1024;
/// Most breaks of a table, and nodes of an axis of the transmittance.
pub const MOST_BREAKS: usize = 65_536;

/// The conditions at which skies are stored, in the units of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Axes {
    /// Visibilities, km.
    pub visibilities: Vec<f64>,
    /// Ground albedos.
    pub albedos: Vec<f64>,
    /// Observer altitudes, m.
    pub altitudes: Vec<f64>,
    /// Solar elevations, degrees.
    pub elevations: Vec<f64>,
}

impl Axes {
    fn check(&self) -> Result<()> {
        let axes = [
            ("visibilities", &self.visibilities, [1e-3, 1e6]),
            ("albedos", &self.albedos, [0.0, 1.0]),
            ("altitudes", &self.altitudes, [0.0, 1e6]),
            ("solar elevations", &self.elevations, [-90.0, 90.0]),
        ];
        let mut axes = axes.into_iter();
        axes.try_for_each(|(what, nodes, range)| check_axis(Section::Header, what, nodes, range))
    }
}

/// Bins of wavelength, nm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Channels {
    /// How many.
    pub count: usize,
    /// Lower edge of the first.
    pub start: f64,
    /// Width of each.
    pub width: f64,
}

impl Channels {
    /// Centre of a bin, nm.
    pub fn centre(&self, channel: usize) -> f64 {
        self.start + (channel as f64 + 0.5) * self.width
    }

    /// Centres of all bins, nm.
    pub fn centres(&self) -> Vec<f64> {
        (0..self.count).map(|c| self.centre(c)).collect()
    }

    /// The bin that a wavelength (nm) is in.
    pub fn of(&self, wavelength: f64) -> Option<usize> {
        let bin = ((wavelength - self.start) / self.width).floor();
        (bin >= 0.0 && bin < self.count as f64).then_some(bin as usize)
    }

    pub(super) fn check(&self) -> Result<()> {
        let broken = |what, got: f64| {
            Err(OfficialError::value(
                Section::Header,
                what,
                format!("got {got} nm"),
            ))
        };
        match (self.start, self.width) {
            (start, _) if !(1.0..=1e6).contains(&start) => broken("channel start", start),
            (_, width) if !(1e-3..=1e5).contains(&width) => broken("channel width", width),
            _ => Ok(()),
        }
    }
}

/// Breaks of the tables of the radiance, rad, and the number of components.
#[derive(Clone, Debug, PartialEq)]
pub struct RadianceBreaks {
    /// Number of components.
    pub rank: usize,
    /// Angles to the sun.
    pub sun: Vec<f64>,
    /// Angles to the zenith, or to the axis of the Earth's shadow.
    pub zenith: Vec<f64>,
    /// Zenith angles of the emphasis.
    pub emphasis: Vec<f64>,
}

/// Breaks of the tables of the polarisation, rad, and the number of components.
#[derive(Clone, Debug, PartialEq)]
pub struct PolarisationBreaks {
    /// Number of components.
    pub rank: usize,
    /// Angles to the sun.
    pub sun: Vec<f64>,
    /// Angles to the zenith.
    pub zenith: Vec<f64>,
}

/// Everything before the radiance.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    /// Conditions.
    pub axes: Axes,
    /// Wavelengths.
    pub channels: Channels,
    /// Breaks.
    pub breaks: RadianceBreaks,
}

/// Indices of a stored sky.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Node {
    /// Visibility.
    pub visibility: usize,
    /// Albedo.
    pub albedo: usize,
    /// Altitude.
    pub altitude: usize,
    /// Solar elevation.
    pub elevation: usize,
}

impl Header {
    /// Refuses what [`super::OfficialData`] would not read.
    ///
    /// # Errors
    /// [`OfficialError::Value`].
    pub fn check(&self) -> Result<()> {
        let (axes, breaks) = (&self.axes, &self.breaks);
        let counts = [
            ("visibilities", axes.visibilities.len(), MOST_NODES),
            ("albedos", axes.albedos.len(), MOST_NODES),
            ("altitudes", axes.altitudes.len(), MOST_NODES),
            ("solar elevations", axes.elevations.len(), MOST_NODES),
            ("number of channels", self.channels.count, MOST_CHANNELS),
            ("rank", breaks.rank, MOST_RANK),
        ];
        for (what, count, most) in counts {
            check_count(Section::Header, what, count as i64, most)?;
        }
        axes.check()?;
        self.channels.check()?;
        check_breaks(
            Section::Header,
            "breaks of the angle to the sun",
            &breaks.sun,
        )?;
        check_breaks(
            Section::Header,
            "breaks of the zenith angle",
            &breaks.zenith,
        )?;
        check_breaks(Section::Header, "breaks of the emphasis", &breaks.emphasis)
    }

    /// Number of stored tables: one per sky and channel.
    pub fn configurations(&self) -> u64 {
        let axes = &self.axes;
        let lengths = [
            axes.visibilities.len(),
            axes.albedos.len(),
            axes.altitudes.len(),
            axes.elevations.len(),
            self.channels.count,
        ];
        lengths
            .iter()
            .fold(1, |product: u64, &n| product.saturating_mul(n as u64))
    }

    /// Position of a table among all.
    pub fn index(&self, node: Node, channel: usize) -> u64 {
        let axes = &self.axes;
        let mut index = node.visibility;
        index = index * axes.albedos.len() + node.albedo;
        index = index * axes.altitudes.len() + node.altitude;
        index = index * axes.elevations.len() + node.elevation;
        index as u64 * self.channels.count as u64 + channel as u64
    }

    /// All stored skies in the order of the file.
    pub fn nodes(&self) -> impl Iterator<Item = Node> + use<> {
        let axes = &self.axes;
        let [a, h, e] = [&axes.albedos, &axes.altitudes, &axes.elevations].map(Vec::len);
        (0..axes.visibilities.len() * a * h * e).map(move |i| Node {
            visibility: i / (a * h * e),
            albedo: i / (h * e) % a,
            altitude: i / e % h,
            elevation: i % e,
        })
    }
}

impl RadianceBreaks {
    /// Bytes of the table of a sky and channel.
    pub fn bytes(&self) -> u64 {
        let component = 2 * (self.sun.len() + self.zenith.len()) as u64 + 8;
        self.rank as u64 * component + 2 * self.emphasis.len() as u64
    }
}

impl PolarisationBreaks {
    /// Bytes of the table of a sky and channel.
    pub fn bytes(&self) -> u64 {
        4 * self.rank as u64 * (self.sun.len() + self.zenith.len()) as u64
    }
}

impl PolarisationBreaks {
    pub(super) fn check(&self) -> Result<()> {
        let section = Section::Polarisation;
        check_count(section, "rank", self.rank as i64, MOST_RANK)?;
        check_breaks(section, "breaks of the angle to the sun", &self.sun)?;
        check_breaks(section, "breaks of the zenith angle", &self.zenith)
    }
}

/// Refuses a count beyond `1..=most`.
pub(super) fn check_count(
    section: Section,
    what: &'static str,
    got: i64,
    most: usize,
) -> Result<usize> {
    match usize::try_from(got) {
        Ok(count) if (1..=most).contains(&count) => Ok(count),
        _ => Err(OfficialError::value(
            section,
            what,
            format!("expected 1..={most}, got {got}"),
        )),
    }
}

/// Refuses breaks between which nothing can be interpolated.
fn check_breaks(section: Section, what: &'static str, breaks: &[f64]) -> Result<()> {
    match breaks.len() {
        2..=MOST_BREAKS => check_axis(section, what, breaks, [-2.0 * PI, 2.0 * PI]),
        got => Err(OfficialError::value(
            section,
            what,
            format!("expected 2..={MOST_BREAKS}, got {got}"),
        )),
    }
}

/// Refuses nodes that do not increase within `range`.
pub(super) fn check_axis(
    section: Section,
    what: &'static str,
    nodes: &[f64],
    range: [f64; 2],
) -> Result<()> {
    let broken = |detail| Err(OfficialError::value(section, what, detail));
    if let Some(bad) = nodes.iter().find(|n| !(range[0]..=range[1]).contains(*n)) {
        return broken(format!("expected {}..={}, got {bad}", range[0], range[1]));
    }
    match nodes.windows(2).find(|pair| pair[0] >= pair[1]) {
        Some(pair) => broken(format!("{} must lie above {}", pair[1], pair[0])),
        None => Ok(()),
    }
}
