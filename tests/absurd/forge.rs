//! Files that are valid in form and absurd in content.

use proptest::prelude::*;
use welkin::format::{Chunk, Head, Payload, encode};

use crate::common;

/// What one number, or all numbers of a table, become.
#[derive(Clone, Debug)]
pub struct Edit {
    /// Which table.
    pub table: usize,
    /// Which number of it; `None`: all.
    pub place: Option<prop::sample::Index>,
    pub value: f64,
}

/// Far beyond what air does, on either side of what exponentials and single precision hold.
const VALUES: [f64; 24] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    88.0,
    -88.0,
    104.0,
    -104.0,
    700.0,
    1e6,
    65504.0,
    -65504.0,
    6e-8,
    1e30,
    -1e30,
    1e-30,
    1e-45,
    3.4e38,
    -3.4e38,
    0.999_999_999_999,
    -0.999_999_999_999,
    1e-300,
    1e300,
    320.0,
];

pub fn edits() -> impl Strategy<Value = Vec<Edit>> {
    let place = prop::option::of(any::<prop::sample::Index>());
    let edit = (0..TABLES, place, prop::sample::select(VALUES.to_vec()));
    let edit = edit.prop_map(|(table, place, value)| Edit {
        table,
        place,
        value,
    });
    prop::collection::vec(edit, 1..4)
}

/// A file with everything.
pub fn whole(estimated: bool) -> (Head, Vec<Chunk>) {
    let mut head = common::head_with(&[0.0, 2000.0], &[20e3, 60e3], 6);
    head.elevation.intervals = 4;
    let mut chunks = common::polarised_chunks(&head, 0.02);
    chunks.extend(common::aerial::chunks(&head, 0.3));
    match estimated {
        true => common::estimated(head, chunks),
        false => (head, chunks),
    }
}

/// Numbers of the head, then tables of the chunks; each edit is made to every chunk that has the table.
const HEAD_TABLES: usize = 14;
const CHUNK_TABLES: usize = 30;
pub const TABLES: usize = HEAD_TABLES + CHUNK_TABLES;

/// The file with the edits, and with fields relative to estimates or not; `None` where the writer refuses them.
pub fn forge(edits: &[Edit], estimated: bool) -> Option<Vec<u8>> {
    let (mut head, mut chunks) = whole(estimated);
    for edit in edits {
        match edit.table.checked_sub(HEAD_TABLES) {
            None => edit_head(&mut head, edit),
            Some(table) => {
                let tables = chunks.iter_mut().filter_map(|chunk| of_chunk(chunk, table));
                tables.for_each(|values| put(values, edit));
            }
        }
    }
    encode(&head, &chunks).ok()
}

fn edit_head(head: &mut Head, edit: &Edit) {
    let one = |place: &mut f64| *place = edit.value;
    match edit.table {
        0 => put64(head.xyz.as_flattened_mut(), edit),
        1 => put64(&mut head.extinction, edit),
        2 => put64(&mut head.spherical_albedo, edit),
        3 => put(&mut head.solar_irradiance, edit),
        4 => (head.fields.iter_mut()).for_each(|field| put64(&mut field.parameter, edit)),
        5 => one(&mut head.planet.radius),
        6 => one(&mut head.planet.top),
        7 => one(&mut head.up.exponent),
        8 => one(&mut head.down.exponent),
        9 => one(&mut head.elevation.width),
        10 => one(&mut head.elevation.centre),
        11 => one(&mut head.elevation.min),
        12 => put64(&mut head.wavelengths[..1], edit),
        _ => put64(&mut head.visibilities[..1], edit),
    }
}

/// The tables of the chunks, by number.
fn of_chunk(chunk: &mut Chunk, table: usize) -> Option<&mut [f32]> {
    let values = match (&mut chunk.payload, table) {
        (Payload::Column(column), 0) => &mut column.values,
        (Payload::Estimate(estimate), 24) => &mut estimate.albedo,
        (Payload::Estimate(estimate), 25) => &mut estimate.density,
        (Payload::Estimate(estimate), 26) => &mut estimate.column,
        (Payload::Estimate(estimate), 27) => &mut estimate.light,
        (Payload::Estimate(estimate), 28) => &mut estimate.ring,
        (Payload::Estimate(estimate), 29) => &mut estimate.level[1..2],
        (Payload::Radiance(factors), 1) => &mut factors.scale,
        (Payload::Radiance(factors), 2) => &mut factors.alpha_up,
        (Payload::Radiance(factors), 3) => &mut factors.alpha_down,
        (Payload::Radiance(factors), 4) => &mut factors.elevation,
        (Payload::Radiance(factors), 5) => &mut factors.level,
        (Payload::RadianceBasis(basis), 6) => &mut basis.phi,
        (Payload::RadianceBasis(basis), 7) => &mut basis.channel,
        (Payload::Polarisation(factors), 8) => &mut factors.scale,
        (Payload::Polarisation(factors), 9) => &mut factors.alpha_up,
        (Payload::Polarisation(factors), 10) => &mut factors.elevation,
        (Payload::PolarisationBasis(basis), 11) => &mut basis.phi,
        (Payload::PolarisationBasis(basis), 12) => &mut basis.channel,
        (Payload::Transmittance(densities), 13) => &mut densities.density,
        (Payload::Source(source), 14) => &mut source.parameter,
        (Payload::Source(source), 15) => &mut source.scattering,
        (Payload::Source(source), 16) => &mut source.level,
        (Payload::Source(source), 17) => &mut source.core,
        (Payload::SourceBasis(basis), 18..=21) => &mut basis.factors[table - 18],
        (Payload::Column(column), 22) => {
            let half = column.values.len() / 2;
            return Some(&mut column.values[..half]);
        }
        (Payload::Radiance(factors), 23) => {
            let half = factors.level.len() / 2;
            return Some(&mut factors.level[..half]);
        }
        _ => return None,
    };
    Some(values)
}

fn put(values: &mut [f32], edit: &Edit) {
    match &edit.place {
        None => values.fill(edit.value as f32),
        Some(_) if values.is_empty() => {}
        Some(place) => values[place.index(values.len())] = edit.value as f32,
    }
}

fn put64(values: &mut [f64], edit: &Edit) {
    match &edit.place {
        None => values.fill(edit.value),
        Some(place) => values[place.index(values.len())] = edit.value,
    }
}
