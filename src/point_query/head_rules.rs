//! What a reader refuses at open, checked in place. Format specification, sections 3 to 5 and 8.

use core::f64::consts::FRAC_PI_2;

use zerocopy::little_endian::F64;

use super::chunk_directory;
use super::head_counts::require;
use super::head_view::{HeadView, Rest};
use crate::error::{Error, Result};
use crate::format::{FIELD_ESTIMATE_SHIFT, FIELD_GROUND, MAX_ESTIMATES};
#[cfg(not(feature = "std"))]
use crate::kernel::real::Real;

/// The head of a file whose first bytes, up to the end of the head at least, are here.
pub(crate) fn checked_head(bytes: &[u8]) -> Result<HeadView<'_>> {
    let (head, rest) = HeadView::parse(bytes)?;
    check(&head, &rest)?;
    Ok(head)
}

/// Everything that can be said about a head whose counts are right.
fn check(head: &HeadView, rest: &Rest) -> Result<()> {
    check_axes(head)?;
    check_scalars(head)?;
    check_solar(head)?;
    check_tables(head, rest.xyz)?;
    check_fields(head)?;
    require(
        core::str::from_utf8(rest.metadata).is_ok(),
        "metadata",
        "expected UTF-8",
    )?;
    require(
        rest.padding.iter().all(|&b| b == 0),
        "padding",
        "expected zeros after metadata",
    )?;
    chunk_directory::check(head, rest)
}

fn check_axes(head: &HeadView) -> Result<()> {
    let axes = [
        ("wavelength", head.wavelengths, [1.0, 1e6]),
        ("altitude", head.altitudes, [0.0, 1e9]),
        ("visibility", head.visibilities, [1.0, 1e9]),
    ];
    for (what, axis, range) in axes {
        let sound = all_within(axis, range) && rises(axis, |v| v);
        require(sound, what, "must increase strictly within its range")?;
    }
    require(
        rises(head.altitudes, |h| h.cbrt()) && rises(head.visibilities, |v| -1.0 / v),
        "altitude or visibility",
        "nodes are too close to each other",
    )
}

fn check_scalars(head: &HeadView) -> Result<()> {
    let e = &head.elevation;
    let last = head.altitudes[head.altitudes.len() - 1].get();
    let sound = within(head.planet.radius, [1e3, 1e9])
        && within(head.planet.top, [last.next_up(), 1e9])
        && head.alpha.iter().all(|&(_, p)| within(p, [1.0, 8.0]))
        && within(e.min, [-FRAC_PI_2, FRAC_PI_2])
        && within(e.max, [e.min.next_up(), FRAC_PI_2])
        && within(e.centre, [-FRAC_PI_2, FRAC_PI_2])
        && within(e.width, [1e-6, 1e6]);
    require(sound, "header", "a number is out of its range")
}

fn check_solar(head: &HeadView) -> Result<()> {
    let [start, step] = head.solar_axis;
    let ends = [
        head.wavelengths[0],
        head.wavelengths[head.wavelengths.len() - 1],
    ];
    let [first, last] = ends.map(F64::get);
    let steps = (head.solar.len() - 1) as f64;
    let sound = within(start, [0.0, first])
        && within(step, [1e-3, 1e6])
        && start + steps * step >= last
        && head
            .solar
            .iter()
            .all(|v| (0.0..=f32::MAX).contains(&v.get()));
    require(
        sound,
        "solar spectrum",
        "breaks its range or ends too early",
    )
}

fn check_tables(head: &HeadView, xyz: &[F64]) -> Result<()> {
    let below_one = 1f64.next_down();
    for (what, table, range) in [
        ("extinction", head.extinction, [0.0, 1e6]),
        ("spherical_albedo", head.spherical_albedo, [0.0, below_one]),
        ("xyz", xyz, [-1e30, 1e30]),
    ] {
        require(
            all_within(table, range),
            what,
            "a number is out of its range",
        )?;
    }
    Ok(())
}

fn check_fields(head: &HeadView) -> Result<()> {
    let parameters = head.phase_parameter.chunks_exact(head.shape.wavelengths);
    let most = match head.shape.levels {
        0 => MAX_ESTIMATES - 1,
        _ => 0,
    };
    for (code, parameters) in head.fields.iter().zip(parameters) {
        let estimate = (code.get() >> FIELD_ESTIMATE_SHIFT) as usize;
        require(
            estimate <= most,
            "field",
            "is relative to an unknown estimate",
        )?;
        let range = match code.get() & !FIELD_GROUND & ((1 << FIELD_ESTIMATE_SHIFT) - 1) {
            0 => [f64::MIN, f64::MAX],
            1 => [0.0, 1.0],
            2 => [(-1f64).next_up(), 1f64.next_down()],
            _ => return Err(Error::invalid("field", "has an unknown code")),
        };
        let sound = all_within(parameters, range);
        require(sound, "phase_parameter", "a number is out of its range")?;
    }
    Ok(())
}

fn within(value: f64, [low, high]: [f64; 2]) -> bool {
    value.is_finite() && value >= low && value <= high
}

fn all_within(values: &[F64], range: [f64; 2]) -> bool {
    values.iter().all(|v| within(v.get(), range))
}

fn rises(axis: &[F64], scale: impl Fn(f64) -> f64) -> bool {
    let mut pairs = axis.windows(2);
    pairs.all(|pair| scale(pair[0].get()) < scale(pair[1].get()))
}
