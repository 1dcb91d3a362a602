//! Arrays from Python and to Python.

use numpy::{
    Element, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyReadwriteArrayDyn,
    PyUntypedArrayMethods, dtype,
};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};
use welkin::Result;

use crate::errors::{out_of_range, refuse};
use crate::rows::{self, block_rows};
use crate::threads::Threads;

pub type Array<'py, T = f32> = Bound<'py, PyArrayDyn<T>>;

/// Numbers of any shape, contiguous: a view of what came if it was like that, else a copy.
pub fn numbers<'py, T: Element>(
    values: &Bound<'py, PyAny>,
    what: &str,
) -> PyResult<PyReadonlyArrayDyn<'py, T>> {
    let py = values.py();
    if let Ok(array) = values.cast::<PyArrayDyn<T>>()
        && array.is_c_contiguous()
        && array.data().is_aligned()
    {
        return Ok(array.try_readonly()?);
    }
    let numpy = py.import("numpy")?;
    let array = numpy.call_method1("asarray", (values,))?;
    let kind: String = array.getattr("dtype")?.getattr("kind")?.extract()?;
    if !matches!(kind.as_str(), "b" | "i" | "u" | "f") {
        let message = format!("{what} must be real numbers, got an array of kind {kind:?}");
        return Err(PyTypeError::new_err(message));
    }
    let array = numpy.call_method1("require", (array, dtype::<T>(py), ("C", "A")))?;
    Ok(array.cast_into::<PyArrayDyn<T>>()?.try_readonly()?)
}

/// Rows of `N` numbers, from an array (…, N).
pub struct Vectors<'py, T: Element, const N: usize> {
    array: PyReadonlyArrayDyn<'py, T>,
}

/// Directions (…, 3).
pub type Directions<'py> = Vectors<'py, f32, 3>;

impl<'py, T: Element + Copy, const N: usize> Vectors<'py, T, N> {
    pub fn read(values: &Bound<'py, PyAny>, what: &str) -> PyResult<Self> {
        let array = numbers(values, what)?;
        if array.shape().last() == Some(&N) {
            return Ok(Self { array });
        }
        let message = format!(
            "{what} must have the shape (…, {N}), got {}",
            shown(array.shape())
        );
        Err(refuse(values.py(), "length", &message))
    }

    /// The shape without its last length.
    pub fn lead(&self) -> &[usize] {
        let shape = self.array.shape();
        &shape[..shape.len() - 1]
    }

    pub fn rows(&self) -> PyResult<&[[T; N]]> {
        Ok(self.array.as_slice()?.as_chunks().0)
    }
}

impl<'py> Directions<'py> {
    pub fn directions(values: &Bound<'py, PyAny>) -> PyResult<Self> {
        Self::read(values, "directions")
    }
}

/// One vector, from what has the shape (3,).
pub fn vector<T: Element + Copy>(values: &Bound<'_, PyAny>, what: &str) -> PyResult<[T; 3]> {
    let vectors = Vectors::<T, 3>::read(values, what)?;
    match (vectors.lead(), vectors.rows()?) {
        ([], [one]) => Ok(*one),
        (lead, _) => {
            let shape = [lead, &[3]].concat();
            let message = format!("{what} must have the shape (3,), got {}", shown(&shape));
            Err(refuse(values.py(), "length", &message))
        }
    }
}

/// Wavelengths (nm), a number or an array (K,).
pub fn wavelengths(values: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let array = numbers::<f64>(values, "wavelengths")?;
    if array.shape().len() < 2 {
        return Ok(array.as_slice()?.to_vec());
    }
    let message = format!(
        "wavelengths must be a number or have the shape (K,), got {}",
        shown(array.shape())
    );
    Err(refuse(values.py(), "length", &message))
}

/// One number, from anything that is one; `else_ask` says who takes arrays.
pub fn scalar(value: &Bound<'_, PyAny>, what: &str, else_ask: &str) -> PyResult<f64> {
    if is_array(value) {
        let array = numbers::<f64>(value, what)?;
        let got = shown(array.shape());
        let message = format!("{what} must be one number, got the shape {got}{else_ask}");
        return Err(refuse(value.py(), "length", &message));
    }
    let told = |_| {
        let got = value
            .repr()
            .map_or_else(|_| "something else".into(), |r| r.to_string());
        PyTypeError::new_err(format!("{what} must be a real number, got {got}"))
    };
    value.extract().map_err(told)
}

/// Whether it has any axes, as arrays, lists and the columns of tables do.
fn is_array(value: &Bound<'_, PyAny>) -> bool {
    match value
        .getattr("ndim")
        .and_then(|axes| axes.extract::<usize>())
    {
        Ok(axes) => axes > 0,
        Err(_) => value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>(),
    }
}

/// Lowest and highest of a range, within another.
pub fn pair(
    values: &Bound<'_, PyAny>,
    what: &'static str,
    [min, max]: [f64; 2],
    unit: &'static str,
) -> PyResult<[f64; 2]> {
    let py = values.py();
    let array = numbers::<f64>(values, what)?;
    let (class, got) = match *array.as_slice()? {
        [low, high] if low > high => ("value", format!("({low}, {high})")),
        [low, high] if array.shape() == [2] => {
            let is_outside = |value: &f64| !(min..=max).contains(value);
            return match [low, high].into_iter().find(is_outside) {
                Some(value) => Err(out_of_range(py, what, [value, min, max], unit)),
                None => Ok([low, high]),
            };
        }
        _ => ("length", format!("the shape {}", shown(array.shape()))),
    };
    let message = format!("{what} must be a pair (lowest, highest), got {got}");
    Err(refuse(py, class, &message))
}

/// A shape as Python shows it.
pub fn shown(shape: &[usize]) -> String {
    match shape {
        [one] => format!("({one},)"),
        _ => {
            let lengths: Vec<_> = shape.iter().map(usize::to_string).collect();
            format!("({})", lengths.join(", "))
        }
    }
}

/// An array of zeros. Numpy allocates, so that too large a one is a `MemoryError`.
pub fn zeros<'py, T: Element>(
    py: Python<'py>,
    lead: &[usize],
    tail: &[usize],
) -> PyResult<Array<'py, T>> {
    let shape = PyTuple::new(py, [lead, tail].concat())?;
    let array = py
        .import("numpy")?
        .call_method1("zeros", (shape, dtype::<T>(py)))?;
    Ok(array.cast_into()?)
}

/// A new array that rows are written to.
pub struct Output<'py, T: Element = f32> {
    pub array: Array<'py, T>,
    guard: PyReadwriteArrayDyn<'py, T>,
    width: usize,
}

impl<'py, T: Element> Output<'py, T> {
    pub fn new(py: Python<'py>, lead: &[usize], tail: &[usize]) -> PyResult<Self> {
        let array = zeros(py, lead, tail)?;
        let guard = array.try_readwrite()?;
        let width = tail.iter().product();
        Ok(Self {
            array,
            guard,
            width,
        })
    }

    pub fn all(&mut self) -> PyResult<&mut [T]> {
        Ok(self.guard.as_slice_mut()?)
    }

    /// Parts of some rows each; nothing where rows are empty.
    pub fn blocks(&mut self, rows: usize) -> PyResult<std::slice::ChunksMut<'_, T>> {
        let size = (self.width * rows).max(1);
        Ok(self.guard.as_slice_mut()?.chunks_mut(size))
    }
}

/// Fills an array (…, tail) for directions or other vectors (…, N), blocks of rows at a time.
pub fn fill<'py, T, U, const N: usize>(
    py: Python<'py>,
    threads: Option<Threads>,
    vectors: &Vectors<'py, U, N>,
    tail: &[usize],
    work: impl Fn(&[[U; N]], &mut [T]) -> Result<()> + Sync,
) -> PyResult<Array<'py, T>>
where
    T: Element,
    U: Element + Copy + Sync,
{
    let mut output = Output::new(py, vectors.lead(), tail)?;
    let all = vectors.rows()?;
    let size = block_rows(all.len());
    let blocks = all.chunks(size).zip(output.blocks(size)?);
    rows::run(py, threads, blocks, |_, (vectors, out)| work(vectors, out))?;
    Ok(output.array)
}

/// The same, one row at a time.
pub fn fill_each<'py, T, U, const N: usize>(
    py: Python<'py>,
    threads: Option<Threads>,
    vectors: &Vectors<'py, U, N>,
    tail: &[usize],
    work: impl Fn([U; N], &mut [T]) -> Result<()> + Sync,
) -> PyResult<Array<'py, T>>
where
    T: Element,
    U: Element + Copy + Sync,
{
    let width = tail.iter().product::<usize>().max(1);
    fill(py, threads, vectors, tail, |vectors, out| {
        let mut rows = vectors.iter().zip(out.chunks_exact_mut(width));
        rows.try_for_each(|(&vector, row)| work(vector, row))
    })
}

/// A small array of doubles.
pub fn list<'py>(py: Python<'py>, values: &[f64]) -> PyResult<Array<'py, f64>> {
    let array = zeros(py, &[values.len()], &[])?;
    array
        .try_readwrite()?
        .as_slice_mut()?
        .copy_from_slice(values);
    Ok(array)
}
