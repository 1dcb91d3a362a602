//! Appends checked numbers to the payload of a chunk.

use half::f16;
use zerocopy::IntoBytes;
use zerocopy::little_endian::{F32, U16};

use super::layout::{MAX_RANK, ceil16};
use crate::error::{Error, Number, Result};

pub(super) fn push_f32(file: &mut Vec<u8>, values: &[f32]) {
    for &v in values {
        file.extend_from_slice(F32::new(v).as_bytes());
    }
}

pub(super) fn check_rank(rank: usize) -> Result<()> {
    if (1..=MAX_RANK).contains(&rank) {
        return Ok(());
    }
    let detail = format!("expected 1..={MAX_RANK}, got {rank}");
    Err(Error::invalid("rank", detail))
}

/// Appends the weights of `rank` components, padded to a multiple of 16.
pub(super) fn push_scale(bytes: &mut Vec<u8>, scale: &[f32], rank: usize) -> Result<()> {
    check("scale", scale, rank)?;
    push_f32(bytes, scale);
    bytes.resize(bytes.len() + 4 * (ceil16(rank) - rank), 0);
    Ok(())
}

/// Appends a matrix with rows padded to a multiple of 16.
pub(super) fn push_half(
    bytes: &mut Vec<u8>,
    what: &'static str,
    values: &[f32],
    rows: usize,
    columns: usize,
) -> Result<()> {
    check(what, values, rows * columns)?;
    for row in values.chunks_exact(columns) {
        push_halves(bytes, what, row)?;
        bytes.resize(bytes.len() + 2 * (ceil16(columns) - columns), 0);
    }
    Ok(())
}

pub(super) fn push_halves(bytes: &mut Vec<u8>, what: &'static str, values: &[f32]) -> Result<()> {
    for &value in values {
        let half = f16::from_f32(value);
        if !half.is_finite() {
            let detail = format!(
                "{} overflows half precision: move the size into scale",
                Number(value.into())
            );
            return Err(Error::invalid(what, detail));
        }
        bytes.extend_from_slice(U16::new(half.to_bits()).as_bytes());
    }
    Ok(())
}

pub(super) fn check(what: &'static str, values: &[f32], expected: usize) -> Result<()> {
    if values.len() != expected {
        return Err(Error::Length {
            what,
            expected: expected as u64,
            got: values.len() as u64,
        });
    }
    match values.iter().find(|v| !v.is_finite()) {
        None => Ok(()),
        Some(v) => Err(Error::invalid(
            what,
            format!("expected finite values, got {v}"),
        )),
    }
}
