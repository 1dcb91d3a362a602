//! An axis of a model that its maker chose. Format specification, section 7.10.

use super::opened::Model;
use super::ranges::checked_visibility;
use crate::error::{Error, Result};
use crate::format::{AxisTable, Head, Kind};

/// A quantity that the visibilities of a model stand for: ozone, an amount of dust, a humidity.
///
/// ```
/// use welkin::Model;
/// use welkin::format::{AxisTable, Chunk, Payload, encode, unpack};
///
/// let (head, mut chunks) = unpack(welkin::DEFAULT_MODEL)?;
/// let values = (0..head.visibilities.len()).map(|i| 5.0 - i as f64).collect();
/// let table = AxisTable { name: "dust".into(), unit: "g/m²".into(), values };
/// chunks.push(Chunk::new(None, None, Payload::Axis(table)));
/// let model = Model::from_bytes(encode(&head, &chunks)?)?;
///
/// let axis = model.axis()?.expect("it has one");
/// assert_eq!(axis.range()[1], 5.0);
/// let visibility = axis.visibility(4.25)?; // m, for the conditions
/// assert!((axis.value(visibility)? - 4.25).abs() < 1e-12);
/// assert_eq!(axis.visibility(9.0).unwrap_err().class(), "range");
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ModelAxis {
    table: AxisTable,
    /// In the order of the values, m.
    visibilities: Vec<f64>,
}

impl ModelAxis {
    fn new(head: &Head, table: AxisTable) -> Self {
        Self {
            table,
            visibilities: head.visibilities.clone(),
        }
    }

    /// What the quantity is called.
    pub fn name(&self) -> &str {
        &self.table.name
    }

    /// What it is measured in; empty for a number without unit.
    pub fn unit(&self) -> &str {
        &self.table.unit
    }

    /// Its values at the visibilities of the file, strictly increasing or strictly decreasing.
    pub fn values(&self) -> &[f64] {
        &self.table.values
    }

    /// Least and largest value.
    pub fn range(&self) -> [f64; 2] {
        let [a, b] = ends(self.values());
        [a.min(b), a.max(b)]
    }

    /// The visibility (m) that stands for a value: 1/V is linear between nodes.
    ///
    /// # Errors
    /// [`Error::OutOfAxis`] for what is beyond [`ModelAxis::range`].
    pub fn visibility(&self, value: f64) -> Result<f64> {
        let (i, t) = place(self.values(), self.checked(value)?);
        let at = |j: usize| self.visibilities[j];
        Ok(match t {
            0.0 => at(i),
            1.0 => at(i + 1),
            // Rounding must not leave the axis.
            _ => (1.0 / ((1.0 - t) / at(i) + t / at(i + 1))).clamp(at(i), at(i + 1)),
        })
    }

    /// The value that a visibility (m) stands for.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for visibilities beyond those of the file.
    pub fn value(&self, visibility: f64) -> Result<f64> {
        let visibility = checked_visibility(visibility, ends(&self.visibilities))?;
        let nodes: Vec<f64> = self.visibilities.iter().map(|v| 1.0 / v).collect();
        let (i, t) = place(&nodes, 1.0 / visibility);
        let at = |j: usize| self.values()[j];
        Ok(match t {
            0.0 => at(i),
            1.0 => at(i + 1),
            _ => (1.0 - t) * at(i) + t * at(i + 1),
        })
    }

    /// A relative excess of 1e-9 is rounding and gets clamped.
    fn checked(&self, value: f64) -> Result<f64> {
        let [min, max] = self.range();
        let slack = 1e-9 * min.abs().max(max.abs());
        if value >= min - slack && value <= max + slack {
            return Ok(value.clamp(min, max));
        }
        Err(Error::OutOfAxis {
            name: self.name().to_owned(),
            value,
            min,
            max,
            unit: self.unit().to_owned(),
        })
    }
}

fn ends(nodes: &[f64]) -> [f64; 2] {
    [nodes[0], nodes[nodes.len() - 1]]
}

/// The interval of strictly increasing or decreasing nodes that a number within them lies in, and the share of it before
/// the number. With one node the first, at its begin.
fn place(nodes: &[f64], x: f64) -> (usize, f64) {
    let is_before = |w: &[f64]| (w[1] < x) == (w[0] < w[1]) && w[1] != x;
    let passed = nodes.windows(2).take_while(|w| is_before(w)).count();
    let i = passed.min(nodes.len().saturating_sub(2));
    let Some(&next) = nodes.get(i + 1) else {
        return (0, 0.0);
    };
    (i, ((x - nodes[i]) / (next - nodes[i])).clamp(0.0, 1.0))
}

impl Model {
    /// The quantity that the visibilities of the file stand for, if its maker chose another one: in its terms,
    /// [`ModelAxis::visibility`] gives the visibility of [`Conditions`](crate::Conditions).
    ///
    /// # Errors
    /// Those of a damaged chunk; [`Error::Read`].
    pub fn axis(&self) -> Result<Option<ModelAxis>> {
        let Ok(i) = self.find(Kind::Axis, None, None) else {
            return Ok(None);
        };
        let table = AxisTable::read(self.head(), self.chunk(i)?)?;
        Ok(Some(ModelAxis::new(self.head(), table)))
    }
}
