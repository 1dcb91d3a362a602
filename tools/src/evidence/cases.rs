//! Under which conditions the models are compared: the sky of the page, and others beside it.

use super::{ALBEDO, Result, SUNS, VISIBILITY};

/// One air over one ground, under some suns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// Name of its files.
    pub key: &'static str,
    /// For people.
    pub name: &'static str,
    /// m.
    pub visibility: f64,
    /// Of the ground.
    pub albedo: f32,
    /// Solar elevations, degrees.
    pub suns: &'static [f64],
}

/// Suns of the cases beside the first: by day, low, and on the horizon.
const FEW_SUNS: &[f64] = &[60.0, 20.0, 0.0];

/// The sky that most of the page is about.
pub const FIRST: Case = Case {
    key: "real",
    name: "visibility 59.4 km, albedo 0.2",
    visibility: VISIBILITY,
    albedo: ALBEDO,
    suns: &SUNS,
};

/// Haze and clear air over dark ground and snow.
pub const OTHERS: [Case; 4] = [
    other("hazy", "visibility 20 km, albedo 0.1", 20e3, 0.1),
    other("hazy-snow", "visibility 20 km, albedo 0.8", 20e3, 0.8),
    other("clear", "visibility 100 km, albedo 0.1", 100e3, 0.1),
    other("clear-snow", "visibility 100 km, albedo 0.8", 100e3, 0.8),
];

const fn other(key: &'static str, name: &'static str, visibility: f64, albedo: f32) -> Case {
    Case {
        key,
        name,
        visibility,
        albedo,
        suns: FEW_SUNS,
    }
}

impl Case {
    /// The case of a name.
    ///
    /// # Errors
    /// For another name.
    pub fn named(key: &str) -> Result<Self> {
        let mut all = std::iter::once(FIRST).chain(OTHERS);
        let found = all.find(|case| case.key == key);
        found.ok_or_else(|| format!("no case {key}").into())
    }

    /// The file of what was traced.
    pub fn traced(&self) -> String {
        format!("{}.csv", self.key)
    }

    /// The file of its air.
    pub fn air(&self) -> String {
        match *self == FIRST {
            true => "air.csv".into(),
            false => format!("air-{}.csv", self.key),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cases_are_found_by_their_names() {
        for case in OTHERS {
            assert_eq!(Case::named(case.key).unwrap(), case);
            assert!(case.name.contains(&format!("{} km", case.visibility / 1e3)));
            assert!(case.name.ends_with(&case.albedo.to_string()));
        }
        assert!(Case::named("foggy").is_err());
    }
}
