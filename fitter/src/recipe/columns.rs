//! Columns of a table as functions, once they are known to be some.

use super::error::{RecipeError, field};
use super::file::Columns;
use crate::atmosphere::table::Curve;
use std::collections::BTreeMap;

/// Highest row of a table, km: more are metres.
const HIGHEST: f64 = 200.0;

/// A table with a place in the recipe.
#[derive(Clone, Copy)]
pub struct Functions<'a> {
    place: &'a str,
    of: &'a str,
    columns: &'a BTreeMap<String, Vec<f64>>,
}

impl<'a> Functions<'a> {
    /// Columns that are functions of the column `of`, which increases.
    pub fn new(place: &'a str, columns: &'a Columns, of: &'a str) -> Result<Self, RecipeError> {
        let Columns::Inline(columns) = columns else {
            return Err(field(place, "the table has not been read"));
        };
        let this = Self { place, of, columns };
        let x = this.column(of)?;
        if x.len() < 2 {
            return Err(field(place, format!("{of} has fewer than two values")));
        }
        if let Some(i) = x.windows(2).position(|w| w[0] >= w[1]) {
            let what = format!("{of} does not increase from {} to {}", x[i], x[i + 1]);
            return Err(field(place, what));
        }
        Ok(this)
    }

    /// A column without which there is no recipe; its values are finite.
    pub fn column(&self, name: &str) -> Result<&'a [f64], RecipeError> {
        let column = self.columns.get(name);
        let column = column.ok_or_else(|| field(self.place, format!("no column {name}")))?;
        if let Some(bad) = column.iter().find(|v| !v.is_finite()) {
            return Err(field(self.place, format!("{name} has the value {bad}")));
        }
        Ok(column)
    }

    /// Whether there is such a column.
    pub fn has(&self, name: &str) -> bool {
        self.columns.contains_key(name)
    }

    /// Refuses columns that nobody reads.
    pub fn only(&self, known: impl Fn(&str) -> bool) -> Result<(), RecipeError> {
        match self
            .columns
            .keys()
            .find(|name| *name != self.of && !known(name))
        {
            Some(name) => Err(field(self.place, format!("unknown column {name}"))),
            None => Ok(()),
        }
    }

    /// A column as a function; its values are in `least..=most`.
    pub fn curve(&self, name: &str, least: f64, most: f64) -> Result<Curve, RecipeError> {
        let (x, y) = (self.column(self.of)?, self.column(name)?);
        if y.len() != x.len() {
            let what = format!(
                "{name} has {} values for {} of {}",
                y.len(),
                x.len(),
                self.of
            );
            return Err(field(self.place, what));
        }
        if let Some(bad) = y.iter().find(|v| !(least..=most).contains(*v)) {
            let what = match least == f64::MIN_POSITIVE && *bad <= most {
                true => format!("{name} = {bad:?} is not above 0"),
                false => format!("{name} = {bad:?} is outside {least:?}..{most:?}"),
            };
            return Err(field(self.place, what));
        }
        Curve::new(x.to_vec(), y.to_vec()).map_err(|e| field(self.place, e.to_string()))
    }

    /// Refuses altitudes in km that there are not.
    pub fn only_altitudes(&self) -> Result<(), RecipeError> {
        let bad = self
            .range()
            .into_iter()
            .find(|km| !(0.0..=HIGHEST).contains(km));
        bad.map_or(Ok(()), |km| {
            let what = format!("{} = {km:?} is outside 0..{HIGHEST}", self.of);
            Err(field(self.place, what))
        })
    }

    /// First and last value of the column that all others are functions of.
    pub fn range(&self) -> [f64; 2] {
        let x = &self.columns[self.of];
        [x[0], x[x.len() - 1]]
    }
}
