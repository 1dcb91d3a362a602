//! What a range of wavelengths needs of a spectrum.

use welkin::format::Spectrum;

/// Leaves out all cells but those between which `low..=high` (nm, within the cells) lies.
pub fn cut(spectrum: &mut Spectrum, constituents: usize, [low, high]: [f64; 2]) {
    let cells = &spectrum.wavelength;
    let first = cells.partition_point(|&cell| cell <= low).max(1) - 1;
    let last = cells
        .partition_point(|&cell| cell < high)
        .min(cells.len() - 1);
    let [start, end] = [first, last + 1].map(|cell| spectrum.first_term[cell] as usize);
    let of_cells = |row: &[f32]| row[first..=last].to_vec();
    let rows = spectrum.extinction.chunks_exact(cells.len());
    spectrum.extinction = rows.flat_map(of_cells).collect();
    spectrum.wavelength = cells[first..=last].to_vec();
    let firsts = spectrum.first_term[first..=last + 1].iter();
    spectrum.first_term = firsts.map(|&term| term - start as u32).collect();
    let of_terms = |table: &[f32], width: usize| table[start * width..end * width].to_vec();
    spectrum.term_weight = of_terms(&spectrum.term_weight, 1);
    spectrum.term_extinction = of_terms(&spectrum.term_extinction, constituents);
    spectrum.tap_weight = of_terms(&spectrum.tap_weight, spectrum.taps);
    spectrum.tap_node = spectrum.tap_node[start * spectrum.taps..end * spectrum.taps].to_vec();
}

/// Indices of the nodes that a spectrum is made of, and of those that are in a range themselves.
pub fn nodes(spectrum: &Spectrum, wavelengths: &[f64], [low, high]: [f64; 2]) -> Vec<usize> {
    let taps = spectrum.tap_node.iter().zip(&spectrum.tap_weight);
    let mut kept: Vec<bool> = wavelengths.iter().map(|&l| low <= l && l <= high).collect();
    taps.filter(|&(_, weight)| *weight != 0.0)
        .for_each(|(&node, _)| kept[node as usize] = true);
    // A file has two nodes at least.
    for i in 0..kept.len() {
        kept[i] |= kept.iter().filter(|&&is_kept| is_kept).count() < 2;
    }
    (0..kept.len()).filter(|&i| kept[i]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spectrum() -> Spectrum {
        Spectrum {
            taps: 1,
            wavelength: vec![400.0, 500.0, 600.0, 700.0],
            first_term: vec![0, 1, 3, 4, 5],
            term_weight: vec![1.0, 0.25, 0.75, 1.0, 1.0],
            term_extinction: (0..10).map(|i| i as f32).collect(),
            tap_node: vec![0, 1, 2, 0, 1],
            tap_weight: vec![1.0, 1.0, 1.0, 0.0, 1.0],
            extinction: (0..16).map(|i| i as f32).collect(),
            example: vec![],
        }
    }

    #[test]
    fn cells_around_a_range_stay_with_their_terms() {
        for range in [[500.0, 600.0], [510.0, 520.0], [500.0, 500.1]] {
            let mut cut_one = spectrum();
            cut(&mut cut_one, 2, range);
            let expected = Spectrum {
                taps: 1,
                wavelength: vec![500.0, 600.0],
                first_term: vec![0, 2, 3],
                term_weight: vec![0.25, 0.75, 1.0],
                term_extinction: (2..8).map(|i| i as f32).collect(),
                tap_node: vec![1, 2, 0],
                tap_weight: vec![1.0, 1.0, 0.0],
                extinction: vec![1.0, 2.0, 5.0, 6.0, 9.0, 10.0, 13.0, 14.0],
                example: vec![],
            };
            assert_eq!(cut_one, expected, "{range:?}");
        }
        let mut whole = spectrum();
        cut(&mut whole, 2, [400.0, 700.0]);
        assert_eq!(whole, spectrum());
    }

    #[test]
    fn nodes_with_a_weight_or_in_the_range_stay() {
        let mut few = spectrum();
        cut(&mut few, 2, [510.0, 520.0]);
        let wavelengths = [400.0, 450.0, 515.0, 600.0];
        assert_eq!(nodes(&few, &wavelengths, [510.0, 520.0]), [1, 2]);
        few.tap_weight.fill(0.0);
        assert_eq!(nodes(&few, &wavelengths, [510.0, 520.0]), [0, 2]);
        assert_eq!(nodes(&few, &wavelengths, [430.0, 900.0]), [1, 2, 3]);
    }
}
