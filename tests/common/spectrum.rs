//! What lies between the nodes of synthetic models.

use welkin::format::{Chunk, Head, Payload, Spectrum};

/// Cells of the synthetic spectrum.
pub const CELLS: usize = 9;
/// Taps and terms of each.
pub const TAPS: usize = 3;
pub const TERMS: usize = 2;

/// Cells between 2 nm before the first node and 2 nm after the last but one, one of them at a node. Each has three taps
/// whose weights are not the same as a curve through the nodes would have, and a term that absorbs more than the other.
pub fn spectrum(head: &Head) -> Spectrum {
    let (nodes, nk) = (head.wavelengths.len(), head.constituents);
    let (first, last) = (head.wavelengths[0], head.wavelengths[nodes - 1]);
    let step = (last - first) / (CELLS - 1) as f64;
    // Uneven, so that nobody can count them instead of searching; the middle one is in its place.
    let shift = |c: usize| 0.3 * step * (1.7 * (c as f64 - 4.0)).sin();
    let wavelength: Vec<f64> = (0..CELLS)
        .map(|c| (first + step * c as f64 + shift(c)).clamp(first - 2.0, last + 2.0))
        .collect();
    let node = |c: usize, j: usize| (c * (nodes - 1) / (CELLS - 1) + j) % nodes;
    let lean = |c: usize| 0.4 * (0.9 * c as f32).sin();
    let weights = |c: usize| [0.9 - lean(c), 0.35 + lean(c), -0.25];
    let extinction = (0..head.visibilities.len() * nk * CELLS).map(|i| {
        let (v, k, c) = (i / CELLS / nk, i / CELLS % nk, i % CELLS);
        let relative = (550.0 / wavelength[c]) as f32;
        match k {
            0 => 1.2e-5 * relative.powi(4),
            _ => 3.0 / head.visibilities[v] as f32 * relative,
        }
    });
    let share = |c: usize| 0.2 + 0.6 * (c % 3) as f32 / 2.0;
    let lines = |c: usize, g: usize, k: usize| match (g, k) {
        (1, 0) => 1e-5 * (c % 4) as f32,
        (1, _) => 2e-6 * c as f32,
        _ => 0.0,
    };
    let terms = (0..CELLS).flat_map(|c| (0..TERMS).map(move |g| (c, g)));
    Spectrum {
        taps: TAPS,
        terms: TERMS,
        tap_node: (0..CELLS * TAPS)
            .map(|i| node(i / TAPS, i % TAPS) as u32)
            .collect(),
        tap_weight: (0..CELLS).flat_map(weights).collect(),
        extinction: extinction.collect(),
        term_weight: (0..CELLS)
            .flat_map(|c| [1.0 - share(c), share(c)])
            .collect(),
        term_extinction: terms
            .flat_map(|(c, g)| (0..nk).map(move |k| lines(c, g, k)))
            .collect(),
        example: (0..4 * nodes)
            .map(|i| -3.0 - 0.1 * (i % nodes) as f32 - 0.5 * (i / nodes) as f32)
            .collect(),
        wavelength,
    }
}

/// [`spectrum`] as a chunk.
pub fn chunk(head: &Head) -> Chunk {
    Chunk::new(None, None, Payload::Spectrum(spectrum(head)))
}

/// `chunks` and a spectrum.
pub fn with_spectrum(head: &Head, mut chunks: Vec<Chunk>) -> Vec<Chunk> {
    chunks.push(chunk(head));
    chunks
}
