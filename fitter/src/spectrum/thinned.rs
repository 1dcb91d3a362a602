//! Which cells a file needs: readers interpolate ln L between cells, and where that is as good a cell is not stored.

use super::colour::between;

/// What leaving a cell out may change of the light of 95 % of the lines of sight.
const TOLERANCE: f64 = 3e-3;

/// Indices of the cells that are kept: all but single ones between two neighbours, of which ln L is `logarithms[cell][line of
/// sight]`.
pub fn needed(wavelengths: &[f64], logarithms: &[Vec<f64>]) -> Vec<usize> {
    let mut kept = vec![0];
    for c in 1..wavelengths.len() - 1 {
        let before = c - 1;
        let alone = kept.last() == Some(&before);
        if !(alone && is_between(wavelengths, logarithms, c)) {
            kept.push(c);
        }
    }
    kept.push(wavelengths.len() - 1);
    kept
}

fn is_between(wavelengths: &[f64], logarithms: &[Vec<f64>], c: usize) -> bool {
    let around = [wavelengths[c - 1], wavelengths[c + 1]];
    let [before, here, after] = [c - 1, c, c + 1].map(|c| &logarithms[c]);
    let lines = before.iter().zip(after).zip(here);
    let mut errors: Vec<f64> = lines
        .map(|((a, b), truth)| (between(&around, &[*a, *b], wavelengths[c]) - truth).abs())
        .collect();
    errors.sort_by(f64::total_cmp);
    errors[errors.len() * 19 / 20] < TOLERANCE
}

/// Weight of the weakest terms that a cell may lose.
const WEAK: f64 = 1e-3;

/// Which terms of a cell are kept, of these weights: all but the weakest ones that are nothing together.
pub fn strong(weights: &[f64]) -> Vec<bool> {
    let mut order: Vec<usize> = (0..weights.len()).collect();
    order.sort_by(|&a, &b| weights[a].total_cmp(&weights[b]));
    let mut kept = vec![true; weights.len()];
    let mut lost = 0.0;
    for i in order {
        lost += weights[i];
        if lost > WEAK {
            break;
        }
        kept[i] = false;
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_keeps_all_but_a_thousandth() {
        let kept = strong(&[0.0004, 0.6, 0.0005, 0.3985, 0.0006]);
        assert_eq!(kept, [false, true, false, true, true]);
        assert_eq!(strong(&[1.0]), [true]);
    }

    #[test]
    fn every_other_cell_of_a_line_goes_and_a_corner_stays() {
        let wavelengths: Vec<f64> = (0..9).map(f64::from).collect();
        let line: Vec<Vec<f64>> = wavelengths.iter().map(|l| vec![0.5 * l; 40]).collect();
        assert_eq!(needed(&wavelengths, &line), [0, 2, 4, 6, 8]);
        let mut corner = line;
        corner[3] = vec![7.0; 40];
        assert_eq!(needed(&wavelengths, &corner), [0, 2, 3, 4, 6, 8]);
    }
}
