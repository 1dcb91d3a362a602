//! What the visibilities stand for (kind 11). Format specification, section 6.11.

use core::ops::{Range, RangeInclusive};

use zerocopy::little_endian::{F64, U32};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use super::head::Head;
use super::views::{check_length, take};
use crate::error::{Error, Number, Result};

/// Most bytes of the name of an axis.
pub const MAX_AXIS_NAME: usize = 64;
/// Most bytes of the unit of an axis.
pub const MAX_AXIS_UNIT: usize = 32;
/// Largest size of a value.
const LARGEST: f64 = 1e30;

/// Where the reserved field stands in the payload.
pub(super) const RESERVED: Range<usize> = 12..16;

/// Values of a quantity that the nodes of the visibility axis stand for.
///
/// ```
/// use welkin::Model;
/// use welkin::format::{AxisTable, Chunk, Payload, encode, unpack};
///
/// let (head, mut chunks) = unpack(welkin::DEFAULT_MODEL)?;
/// let table = AxisTable {
///     name: "extinction".into(),
///     unit: "1/km".into(),
///     values: head.visibilities.iter().map(|v| 3912.0 / v).collect(),
/// };
/// chunks.push(Chunk::new(None, None, Payload::Axis(table)));
/// let model = Model::from_bytes(encode(&head, &chunks)?)?;
/// let axis = model.axis()?.expect("it was written");
/// assert_eq!((axis.name(), axis.unit()), ("extinction", "1/km"));
/// assert!((axis.visibility(0.0978)? - 40e3).abs() < 1.0);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AxisTable {
    /// What the quantity is called, 1..=64 bytes.
    pub name: String,
    /// What it is measured in, at most 32 bytes.
    pub unit: String,
    /// One for each visibility, strictly increasing or strictly decreasing, within ±10³⁰.
    pub values: Vec<f64>,
}

#[derive(Clone, Copy, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
struct Counts {
    nodes: U32,
    name_length: U32,
    unit_length: U32,
    reserved: U32,
}

impl AxisTable {
    /// The payload of an axis chunk in a file with this head, checked.
    pub(crate) fn read(head: &Head, bytes: &[u8]) -> Result<Self> {
        let (counts, mut rest) = Counts::read_from_prefix(bytes)
            .map_err(|_| invalid("is shorter than its counts".to_owned()))?;
        let [nodes, name, unit] = [counts.nodes, counts.name_length, counts.unit_length]
            .map(|n| usize::try_from(n.get()).unwrap_or(usize::MAX));
        count("visibilities", nodes, exactly(head.visibilities.len()))?;
        count("bytes of the name", name, 1..=MAX_AXIS_NAME)?;
        count("bytes of the unit", unit, 0..=MAX_AXIS_UNIT)?;
        check_length("axis chunk", rest, size_of::<F64>() * nodes + name + unit)?;
        let values: &[F64] = take(&mut rest, nodes)?;
        let (name, unit) = rest.split_at(name);
        let table = Self {
            name: text("name", name)?,
            unit: text("unit", unit)?,
            values: values.iter().map(|v| v.get()).collect(),
        };
        check_values(&table.values)?;
        Ok(table)
    }

    /// The payload in a file with this head.
    pub(super) fn encode(&self, head: &Head) -> Result<Vec<u8>> {
        // Lengths of other sizes would not fit their fields.
        count("bytes of the name", self.name.len(), 1..=MAX_AXIS_NAME)?;
        count("bytes of the unit", self.unit.len(), 0..=MAX_AXIS_UNIT)?;
        count(
            "visibilities",
            self.values.len(),
            exactly(head.visibilities.len()),
        )?;
        let n = |length: usize| U32::new(length as u32);
        let counts = Counts {
            nodes: n(self.values.len()),
            name_length: n(self.name.len()),
            unit_length: n(self.unit.len()),
            reserved: U32::ZERO,
        };
        let mut bytes = counts.as_bytes().to_vec();
        bytes.extend(self.values.iter().flat_map(|v| v.to_le_bytes()));
        bytes.extend_from_slice(self.name.as_bytes());
        bytes.extend_from_slice(self.unit.as_bytes());
        check_values(&self.values)?;
        Ok(bytes)
    }
}

fn exactly(n: usize) -> RangeInclusive<usize> {
    n..=n
}

fn count(what: &str, got: usize, expected: RangeInclusive<usize>) -> Result<()> {
    if expected.contains(&got) {
        return Ok(());
    }
    let (least, most) = expected.into_inner();
    Err(invalid(match least == most {
        true => format!("expected values for {least} {what}, got {got}"),
        false => format!("expected {least}..={most} {what}, got {got}"),
    }))
}

fn text(what: &str, bytes: &[u8]) -> Result<String> {
    let text = core::str::from_utf8(bytes);
    text.map(str::to_owned)
        .map_err(|error| invalid(format!("expected a {what} in UTF-8: {error}")))
}

fn check_values(values: &[f64]) -> Result<()> {
    // NaN is within no range.
    if let Some(&v) = values.iter().find(|v| !(-LARGEST..=LARGEST).contains(*v)) {
        let got = Number(v);
        return Err(invalid(format!("values must be within ±1e30, got {got}")));
    }
    let steps = |holds: fn(f64, f64) -> bool| values.windows(2).all(|w| holds(w[0], w[1]));
    if steps(|a, b| a < b) || steps(|a, b| a > b) {
        return Ok(());
    }
    let detail = "values must increase strictly, or decrease strictly";
    Err(invalid(detail.to_owned()))
}

fn invalid(detail: String) -> Error {
    Error::invalid("axis", detail)
}
