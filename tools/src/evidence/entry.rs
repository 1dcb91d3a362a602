//! A model that is compared, with the terms on which it is.

use crate::peers::sky::SkyModel;

/// A model on its terms.
pub struct Entry {
    /// Name of its files.
    pub key: &'static str,
    /// For people.
    pub name: &'static str,
    /// Which parameters it has.
    pub terms: String,
    /// Whether it has a luminance and a colour of its own.
    pub own_light: bool,
    /// What is said of it where it has no sky.
    pub absent: &'static str,
    /// The model.
    pub model: Box<dyn SkyModel>,
}

/// Said of suns that a model does not know.
pub const NO_SKY: &str = "no sky";
/// Said of a model whose data were not at hand.
pub const NOT_RUN: &str = "not run";

impl Entry {
    /// Whether its data were at hand.
    pub fn was_run(&self) -> bool {
        self.absent != NOT_RUN
    }
}
