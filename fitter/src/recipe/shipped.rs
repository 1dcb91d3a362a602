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
