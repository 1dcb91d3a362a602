//! Arrays that are broadcast against each other, as numpy does.

use numpy::{
    Element, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods, dtype,
};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::arrays::{numbers, shown};
use crate::errors::refuse;

/// Numbers, or vectors of `N` of them, that may be one for all rows.
pub struct Operand<'py, T: Element, const N: usize> {
    name: &'static str,
    array: PyReadonlyArrayDyn<'py, T>,
    /// Whether the last length is that of vectors.
    is_vectors: bool,
}

/// A leading shape, and what has it.
pub type Named<'a> = (&'static str, &'a [usize]);

/// What an operand has for each row of the common shape.
#[derive(Clone, Copy)]
pub enum Values<'a, T, const N: usize> {
    One([T; N]),
    Many(&'a [[T; N]]),
}

impl<T: Copy, const N: usize> Values<'_, T, N> {
    pub fn at(&self, row: usize) -> [T; N] {
        match self {
            Self::One(value) => *value,
            Self::Many(values) => values[row],
        }
    }
}

impl<'py, T: Element + Copy, const N: usize> Operand<'py, T, N> {
    /// Vectors (…, N).
    pub fn vectors(values: &Bound<'py, PyAny>, name: &'static str) -> PyResult<Self> {
        let array = numbers(values, name)?;
        if array.shape().last() == Some(&N) {
            return Ok(Self {
                name,
                array,
                is_vectors: true,
            });
        }
        let message = format!(
            "{name} must have the shape (…, {N}), got {}",
            shown(array.shape())
        );
        Err(refuse(values.py(), "length", &message))
    }

    pub fn lead(&self) -> &[usize] {
        let shape = self.array.shape();
        match self.is_vectors {
            true => &shape[..shape.len() - 1],
            false => shape,
        }
    }

    pub fn named(&self) -> Named<'_> {
        (self.name, self.lead())
    }

    /// Repeats what is neither one for all nor one for each.
    pub fn spread(self, lead: &[usize]) -> PyResult<Self> {
        let is_one = self.lead().iter().product::<usize>() == 1;
        if is_one || self.lead() == lead {
            return Ok(self);
        }
        let py = self.array.py();
        let numpy = py.import("numpy")?;
        let tail: &[usize] = if self.is_vectors { &[N] } else { &[] };
        let shape = PyTuple::new(py, [lead, tail].concat())?;
        let spread = numpy.call_method1("broadcast_to", (self.array.as_any(), shape))?;
        let whole = numpy.call_method1("require", (spread, dtype::<T>(py), ("C", "A")))?;
        Ok(Self {
            name: self.name,
            array: whole.cast_into::<PyArrayDyn<T>>()?.try_readonly()?,
            is_vectors: self.is_vectors,
        })
    }

    pub fn values(&self) -> PyResult<Values<'_, T, N>> {
        let values = self.array.as_slice()?.as_chunks().0;
        Ok(match values {
            [one] => Values::One(*one),
            _ => Values::Many(values),
        })
    }
}

impl<'py> Operand<'py, f64, 1> {
    pub fn scalars(values: &Bound<'py, PyAny>, name: &'static str) -> PyResult<Self> {
        Ok(Self {
            name,
            array: numbers(values, name)?,
            is_vectors: false,
        })
    }
}

/// The shape that shapes have in common.
pub fn common(py: Python<'_>, operands: &[Named<'_>]) -> PyResult<Vec<usize>> {
    let tuples = operands.iter();
    let tuples = tuples.map(|(_, shape)| PyTuple::new(py, shape.iter()));
    let tuples = PyTuple::new(py, tuples.collect::<PyResult<Vec<_>>>()?)?;
    let shape = py
        .import("numpy")?
        .getattr("broadcast_shapes")?
        .call1(tuples);
    let told = |_| {
        let several = operands.iter().filter(|(_, shape)| !shape.is_empty());
        let all = several.map(|(name, shape)| format!("{name} {}", shown(shape)));
        let all = all.collect::<Vec<_>>().join(", ");
        let message = format!("leading shapes do not broadcast: {all}");
        refuse(py, "length", &message)
    };
    shape.map_err(told)?.extract()
}
