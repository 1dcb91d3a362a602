//! The recipes that come with the program.

macro_rules! recipes {
    ($($name:literal),* $(,)?) => {
        /// Names and texts.
        pub const RECIPES: &[(&str, &str)] =
            &[$(($name, include_str!(concat!("../../recipes/", $name, ".toml")))),*];
    };
}

recipes!(
    "continental-clean",
    "continental-average",
    "continental-polluted",
    "urban",
    "desert",
    "maritime-clean",
    "maritime-polluted",
    "tropical",
    "arctic",
    "antarctic",
    "fog",
    "mars",
);

/// Particles of OPAC's aerosol types as published.
///
/// ```
/// let urban = welkin_fitter::recipe::OPAC.iter().find(|opac| opac.name == "urban").unwrap();
/// assert_eq!(urban.optical_depth, 0.643);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Published {
    /// The recipe that is made after it.
    pub name: &'static str,
    /// Extinction at the ground, 1/km.
    pub extinction: f64,
    /// Vertical optical depth.
    pub optical_depth: f64,
}

/// Hess, Koepke and Schult 1998, Tables 4 and 5: 550 nm, 80 % humidity.
pub const OPAC: [Published; 10] = [
    published("continental-clean", 0.026, 0.064),
    published("continental-average", 0.075, 0.151),
    published("continental-polluted", 0.175, 0.327),
    published("urban", 0.353, 0.643),
    published("desert", 0.145, 0.286),
    published("maritime-clean", 0.090, 0.096),
    published("maritime-polluted", 0.115, 0.117),
    published("tropical", 0.043, 0.056),
    published("arctic", 0.023, 0.063),
    published("antarctic", 0.011, 0.072),
];

/// Humidity for which those hold, percent.
pub const OPAC_HUMIDITY: f64 = 80.0;

const fn published(name: &'static str, extinction: f64, optical_depth: f64) -> Published {
    Published {
        name,
        extinction,
        optical_depth,
    }
}
