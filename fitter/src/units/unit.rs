//! Units by name, so that any process can do any of them.

/// What a unit computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The light field of a visibility; everything else of that visibility starts from it.
    Light,
    /// The tensor of a visibility and an altitude.
    Tensor,
    /// Held-out samples of a visibility and an altitude.
    Truth,
    /// Differences of some held-out samples to the unbiased tracer. A model can be built without.
    Check,
}

/// A pure function of a plan to one file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// What it computes.
    pub kind: Kind,
    /// Visibility, m.
    pub visibility: f64,
    /// Index of the altitude, except for light fields.
    pub altitude: Option<usize>,
}

impl Kind {
    /// All kinds, in the order of the list of units.
    pub const ALL: [Self; 4] = [Self::Light, Self::Tensor, Self::Truth, Self::Check];

    /// First word of the names of its units.
    pub fn name(self) -> &'static str {
        match self {
            Self::Light => "light",
            Self::Tensor => "tensor",
            Self::Truth => "truth",
            Self::Check => "check",
        }
    }

    /// Name of the unit of a visibility and an altitude (m).
    pub fn unit(self, visibility: f64, altitude: Option<f64>) -> String {
        let name = self.name();
        match altitude {
            Some(altitude) => format!("{name}-{visibility}-{altitude}"),
            None => format!("{name}-{visibility}"),
        }
    }
}
