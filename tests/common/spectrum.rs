//! What lies between the nodes of synthetic models.

use welkin::format::{Chunk, Head, Payload, Spectrum};

/// Cells of the synthetic spectrum.
pub const CELLS: usize = 9;
/// Taps of each term.
pub const TAPS: usize = 3;
/// First term of each cell: the odd ones are bands with two terms.
pub const FIRST_TERM: [u32; CELLS + 1] = [0, 1, 3, 4, 6, 7, 9, 10, 12, 13];
/// Terms of all cells.
pub const TERMS: usize = 13;

/// Cells from 2 nm before the first node to 2 nm after the last at most, one of them in the middle between those. Terms
/// have three taps with weights that no curve through the nodes has; the second of a band absorbs more than the first.
pub fn spectrum(head: &Head) -> Spectrum {
    let (nodes, nk) = (head.wavelengths.len(), head.constituents);
    let (first, last) = (head.wavelengths[0], head.wavelengths[nodes - 1]);
    let step = (last - first) / (CELLS - 1) as f64;
    // Uneven, so that nobody can count them instead of searching; the middle one is in its place.
    let shift = |c: usize| 0.3 * step * (1.7 * (c as f64 - 4.0)).sin();
    let wavelength: Vec<f64> = (0..CELLS)
        .map(|c| (first + step * c as f64 + shift(c)).clamp(first - 2.0, last + 2.0))
        .collect();
    // Cell and place in it of each term.
    let terms: Vec<(usize, usize)> = (0..CELLS)
        .flat_map(|c| (0..(FIRST_TERM[c + 1] - FIRST_TERM[c]) as usize).map(move |g| (c, g)))
        .collect();
    let node = |c: usize, g: usize, j: usize| (c * (nodes - 1) / (CELLS - 1) + g + j) % nodes;
    let lean = |c: usize, g: usize| 0.4 * (0.9 * c as f32 + 2.0 * g as f32).sin();
    let weights = |c: usize, g: usize| {
        let lean = lean(c, g);
        [0.9 - lean, 0.35 + lean, -0.25]
    };
    let share = |c: usize, g: usize| match (c % 2, g) {
        (0, _) => 1.0,
        (_, 0) => 0.7 - 0.05 * c as f32,
        _ => 1.0 - (0.7 - 0.05 * c as f32),
    };
    let lines = |c: usize, g: usize, k: usize| match (g, k) {
        (1, 0) => 1e-5 * (c % 4) as f32,
        (1, _) => 2e-6 * c as f32,
        _ => 0.0,
    };
    let extinction = (0..head.visibilities.len() * nk * CELLS).map(|i| {
        let (v, k, c) = (i / CELLS / nk, i / CELLS % nk, i % CELLS);
        let relative = (550.0 / wavelength[c]) as f32;
        match k {
            0 => 1.2e-5 * relative.powi(4),
            _ => 3.0 / head.visibilities[v] as f32 * relative,
        }
    });
    Spectrum {
        taps: TAPS,
        extinction: extinction.collect(),
        first_term: FIRST_TERM.to_vec(),
        term_weight: terms.iter().map(|&(c, g)| share(c, g)).collect(),
        term_extinction: (terms.iter())
            .flat_map(|&(c, g)| (0..nk).map(move |k| lines(c, g, k)))
            .collect(),
        tap_node: (terms.iter())
            .flat_map(|&(c, g)| (0..TAPS).map(move |j| node(c, g, j) as u32))
            .collect(),
        tap_weight: terms.iter().flat_map(|&(c, g)| weights(c, g)).collect(),
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
