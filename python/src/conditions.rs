//! Conditions from an object with their fields, from keywords, or both.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use welkin::Conditions;

use crate::arrays::scalar;
use crate::broadcast::{Named, Operand, Values};

pub const NAMES: [&str; 5] = [
    "solar_elevation",
    "solar_azimuth",
    "visibility",
    "albedo",
    "altitude",
];

const ELSE_ASK: &str = ": for arrays of conditions ask the model, as model.radiance(directions, …)";

/// One set of conditions: the defaults, what `base` has, and over that the keywords.
pub fn read(
    base: Option<&Bound<'_, PyAny>>,
    keywords: Option<&Bound<'_, PyDict>>,
) -> PyResult<Conditions> {
    let mut conditions = Conditions::default();
    for (name, value) in NAMES.iter().zip(fields(&mut conditions)) {
        if let Some(given) = given(name, base, keywords)? {
            *value = scalar(&given, name, ELSE_ASK)?;
        }
    }
    Ok(conditions)
}

/// The same in Python.
pub fn shown<'py>(py: Python<'py>, conditions: &Conditions) -> PyResult<Bound<'py, PyAny>> {
    let keywords = PyDict::new(py);
    let mut conditions = *conditions;
    for (name, value) in NAMES.iter().zip(fields(&mut conditions)) {
        keywords.set_item(name, *value)?;
    }
    let class = py.import("welkin_sky.conditions")?.getattr("Conditions")?;
    class.call((), Some(&keywords))
}

/// Conditions of which every one may be an array.
pub struct Columns<'py> {
    operands: [Operand<'py, f64, 1>; 5],
}

impl<'py> Columns<'py> {
    pub fn read(
        py: Python<'py>,
        base: Option<&Bound<'py, PyAny>>,
        keywords: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Self> {
        let mut conditions = Conditions::default();
        let mut operands = Vec::with_capacity(5);
        for (name, value) in NAMES.iter().zip(fields(&mut conditions)) {
            let given = match given(name, base, keywords)? {
                Some(given) => given,
                None => (*value).into_pyobject(py)?.into_any(),
            };
            operands.push(Operand::scalars(&given, name)?);
        }
        let operands = <[_; 5]>::try_from(operands)
            .ok()
            .expect("one for each name");
        Ok(Self { operands })
    }

    pub fn shapes(&self) -> impl Iterator<Item = Named<'_>> {
        self.operands.iter().map(Operand::named)
    }

    pub fn spread(self, lead: &[usize]) -> PyResult<Self> {
        let [a, b, c, d, e] = self.operands;
        let operands = [
            a.spread(lead)?,
            b.spread(lead)?,
            c.spread(lead)?,
            d.spread(lead)?,
            e.spread(lead)?,
        ];
        Ok(Self { operands })
    }

    pub fn rows(&self) -> PyResult<Rows<'_>> {
        let [a, b, c, d, e] = &self.operands;
        Ok(Rows {
            values: [
                a.values()?,
                b.values()?,
                c.values()?,
                d.values()?,
                e.values()?,
            ],
        })
    }
}

/// The conditions of each row.
#[derive(Clone, Copy)]
pub struct Rows<'a> {
    values: [Values<'a, f64, 1>; 5],
}

impl Rows<'_> {
    pub fn at(&self, row: usize) -> Conditions {
        let mut conditions = Conditions::default();
        for (field, values) in fields(&mut conditions).into_iter().zip(&self.values) {
            [*field] = values.at(row);
        }
        conditions
    }

    /// All numbers of one condition.
    pub fn of(&self, name: &str) -> &[[f64; 1]] {
        let which = NAMES.iter().position(|known| *known == name);
        match which.map(|i| &self.values[i]) {
            Some(Values::One(one)) => std::slice::from_ref(one),
            Some(Values::Many(many)) => many,
            None => &[],
        }
    }
}

/// In the order of [`NAMES`].
fn fields(conditions: &mut Conditions) -> [&mut f64; 5] {
    [
        &mut conditions.solar_elevation,
        &mut conditions.solar_azimuth,
        &mut conditions.visibility,
        &mut conditions.albedo,
        &mut conditions.altitude,
    ]
}

fn given<'py>(
    name: &str,
    base: Option<&Bound<'py, PyAny>>,
    keywords: Option<&Bound<'py, PyDict>>,
) -> PyResult<Option<Bound<'py, PyAny>>> {
    if let Some(keywords) = keywords {
        known(keywords)?;
        if let Some(value) = keywords.get_item(name)?.filter(|value| !value.is_none()) {
            return Ok(Some(value));
        }
    }
    let told = |_| PyTypeError::new_err("conditions must be welkin_sky.Conditions or keywords");
    base.map(|base| base.getattr(name).map_err(told))
        .transpose()
}

fn known(keywords: &Bound<'_, PyDict>) -> PyResult<()> {
    for name in keywords.keys() {
        let name: String = name.extract()?;
        if !NAMES.contains(&name.as_str()) {
            let all = NAMES.join(", ");
            let message = format!("unknown condition {name:?}: known are {all}");
            return Err(PyTypeError::new_err(message));
        }
    }
    Ok(())
}
