//! Wavelengths between nodes: powers of light at nodes, eight at a time.

use crate::kernel::lanes::Lanes;
use crate::polarisation::Stokes;
use crate::sky::MOST_WAVELENGTHS;

const WIDTH: usize = 8;
/// As many nodes as most projections have at most: what a query sets up goes with that.
const FEW: usize = 32;

/// A wavelength between nodes, with the weight of its radiance and those of the logarithms.
#[derive(Clone, Debug)]
pub(super) struct Power {
    pub factor: f64,
    pub taps: Vec<(usize, f64)>,
}

/// factor · exp2(Σ W log2 L) over nodes, each part of a band. Format specification, section 7.3.
#[derive(Clone, Debug)]
pub(super) struct Powers {
    /// Of each power.
    bands: Vec<usize>,
    /// Zero beyond the last.
    factors: Vec<Lanes<WIDTH>>,
    /// `[block][node]`.
    weights: Vec<Lanes<WIDTH>>,
    /// Whether darkness at a node counts as little light: with a spectrum.
    floor: bool,
}

/// Light at the nodes as it counts, with binary logarithms.
struct Light<const N: usize> {
    light: [f32; N],
    logarithms: [f32; N],
    /// Whether there is none somewhere.
    dark: bool,
}

impl Powers {
    /// Bands with what they are made of.
    pub fn new(nodes: usize, powers: &[(usize, &Power)], floor: bool) -> Self {
        let blocks = powers.len().div_ceil(WIDTH);
        let mut factors = vec![Lanes::splat(0.0); blocks];
        let mut weights = vec![Lanes::splat(0.0); blocks * nodes];
        for (i, (_, power)) in powers.iter().enumerate() {
            let (block, lane) = (i / WIDTH, i % WIDTH);
            factors[block].0[lane] = power.factor as f32;
            for &(node, weight) in &power.taps {
                weights[block * nodes + node].0[lane] += weight as f32;
            }
        }
        Self {
            bands: powers.iter().map(|(band, _)| *band).collect(),
            factors,
            weights,
            floor,
        }
    }

    pub fn is_empty(&self) -> bool {
        self.bands.is_empty()
    }

    pub fn bytes(&self) -> usize {
        size_of_val(self.bands.as_slice())
            + size_of_val(self.factors.as_slice())
            + size_of_val(self.weights.as_slice())
    }

    /// Band and light of each, from relative radiance at the nodes.
    #[inline(always)]
    pub fn each(&self, relative: &[f32], emit: impl FnMut(usize, f32)) {
        match relative.len() {
            0..=FEW => self.each_of::<FEW>(relative, emit),
            _ => self.each_of::<MOST_WAVELENGTHS>(relative, emit),
        }
    }

    #[inline(always)]
    fn each_of<const N: usize>(&self, relative: &[f32], mut emit: impl FnMut(usize, f32)) {
        let light = Light::<N>::new(relative.iter().copied(), self.floor);
        let bands = self.bands.chunks(WIDTH);
        for (block, bands) in bands.enumerate() {
            let values = light.powers(self.factors[block], self.rows(block, relative.len()));
            let pairs = bands.iter().zip(values.0);
            pairs.for_each(|(&band, value)| emit(band, value));
        }
    }

    /// The same of polarised light. Section 7.5: Q/L and U/L are summed, to a degree of 1 at most.
    pub fn each_stokes(&self, relative: &[Stokes], mut emit: impl FnMut(usize, Stokes)) {
        let intensities = relative.iter().map(|stokes| stokes.i);
        let light = Light::<MOST_WAVELENGTHS>::new(intensities, self.floor);
        for (block, bands) in self.bands.chunks(WIDTH).enumerate() {
            let rows = self.rows(block, relative.len());
            let values = light.powers(self.factors[block], rows);
            let [mut q, mut u] = [Lanes::splat(0.0); 2];
            for (row, stokes) in rows.iter().zip(relative) {
                let share = 1.0 / stokes.i.max(f32::MIN_POSITIVE);
                q = q + *row * (share * stokes.q);
                u = u + *row * (share * stokes.u);
            }
            for (lane, &band) in bands.iter().enumerate() {
                let (i, q, u) = (values.0[lane], q.0[lane], u.0[lane]);
                let share = i / (q.hypot(u) * (1.0 + 4.0 * f32::EPSILON)).max(1.0);
                let (q, u) = (q * share, u * share);
                emit(band, Stokes { i, q, u });
            }
        }
    }

    /// Weights of a block, one row per node.
    #[inline(always)]
    fn rows(&self, block: usize, nodes: usize) -> &[Lanes<WIDTH>] {
        &self.weights[block * nodes..][..nodes]
    }
}

impl<const N: usize> Light<N> {
    #[inline(always)]
    fn new(relative: impl ExactSizeIterator<Item = f32>, floor: bool) -> Self {
        /// Format specification, section 7.3: 2⁻²⁷ of the brightest.
        const DARKEST: f32 = 1.0 / (1 << 27) as f32;
        let nodes = relative.len();
        let mut light = [0.0; N];
        light.iter_mut().zip(relative).for_each(|(l, r)| *l = r);
        if floor {
            let least = DARKEST * light[..nodes].iter().fold(0.0, |a: f32, &b| a.max(b));
            light[..nodes].iter_mut().for_each(|l| *l = l.max(least));
        }
        let mut logarithms = light;
        let blocks = logarithms.as_chunks_mut::<WIDTH>().0.iter_mut();
        for block in blocks.take(nodes.div_ceil(WIDTH)) {
            *block = Lanes(*block).max(Lanes::splat(f32::MIN_POSITIVE)).log2().0;
        }
        Self {
            dark: light[..nodes].iter().any(|&l| l <= 0.0),
            light,
            logarithms,
        }
    }

    #[inline(always)]
    fn powers(&self, factors: Lanes<WIDTH>, rows: &[Lanes<WIDTH>]) -> Lanes<WIDTH> {
        let mut sum = Lanes::splat(0.0);
        for (row, &logarithm) in rows.iter().zip(&self.logarithms) {
            sum = sum + *row * logarithm;
        }
        let mut values = sum.exp2();
        if self.dark {
            self.beside_darkness(rows, &mut values.0);
        }
        values * factors
    }

    /// Where a node that counts is dark, light itself is summed.
    #[cold]
    fn beside_darkness(&self, rows: &[Lanes<WIDTH>], values: &mut [f32; WIDTH]) {
        for (lane, value) in values.iter_mut().enumerate() {
            let taps = || rows.iter().map(|row| row.0[lane]).zip(self.light);
            if taps().any(|(weight, light)| weight != 0.0 && light <= 0.0) {
                let positive = || taps().filter(|tap| tap.0 > 0.0);
                let whole: f32 = positive().map(|tap| tap.0).sum();
                let sum: f32 = positive().map(|(weight, light)| weight * light).sum();
                *value = sum / whole.max(f32::MIN_POSITIVE);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn some(nodes: usize, count: usize) -> Vec<Power> {
        let weight = |i: usize, k: usize| ((i * 31 + k * 17) as f64).sin();
        let power = |i: usize| Power {
            factor: 0.5 + i as f64,
            taps: (0..3)
                .map(|k| ((7 * i + 5 * k) % nodes, weight(i, k)))
                .collect(),
        };
        (0..count).map(power).collect()
    }

    fn expected(power: &Power, light: &[f32]) -> f64 {
        let terms = power.taps.iter();
        let sum: f64 = terms.map(|&(n, w)| w * f64::from(light[n]).ln()).sum();
        power.factor * sum.exp()
    }

    #[test]
    fn all_blocks_and_numbers_of_nodes_are_powers() {
        for (nodes, count) in [(1, 1), (12, 8), (24, 21), (33, 9), (256, 40)] {
            let powers = some(nodes, count);
            let pairs: Vec<(usize, &Power)> = powers.iter().enumerate().collect();
            let made = Powers::new(nodes, &pairs, true);
            let light: Vec<f32> = (0..nodes).map(|n| 0.01 + (n as f32).cos().abs()).collect();
            let mut seen = 0;
            made.each(&light, |band, value| {
                let error = f64::from(value) / expected(&powers[band], &light) - 1.0;
                assert!(error.abs() < 1e-5, "{nodes} {band} {error}");
                seen += 1;
            });
            assert_eq!(seen, count);
            let stokes = light.iter().map(|&i| Stokes {
                i,
                q: 0.2 * i,
                u: 0.0,
            });
            let stokes: Vec<Stokes> = stokes.collect();
            made.each_stokes(&stokes, |band, value| {
                let error = f64::from(value.i) / expected(&powers[band], &light) - 1.0;
                // Q/L is the same everywhere, and the sum of the weights times that.
                let whole: f64 = powers[band].taps.iter().map(|tap| 0.2 * tap.1).sum();
                let degree = f64::from(value.q / value.i);
                assert!(error.abs() < 1e-5 && (degree - whole.clamp(-1.0, 1.0)).abs() < 1e-5);
            });
        }
    }

    /// Without a spectrum a dark node leaves the mean of the others; with one it counts as little light.
    #[test]
    fn darkness_is_no_infinity() {
        let taps = vec![(0, 1.25), (1, 0.5), (2, -0.75)];
        let powers = [Power { factor: 2.0, taps }];
        let light = [0.0, 3.5, 1.0, 0.0];
        let one = |floor: bool, light: &[f32]| {
            let mut out = f32::NAN;
            Powers::new(4, &[(0, &powers[0])], floor).each(light, |_, value| out = value);
            out
        };
        assert!((one(false, &light) - 2.0).abs() < 1e-6);
        let darkest = 3.5 / f64::from(1 << 27);
        let floored = expected(&powers[0], &[darkest as f32, 3.5, 1.0]);
        assert!((f64::from(one(true, &light)) / floored - 1.0).abs() < 1e-4);
        // A node that does not count may be dark.
        let lit = [1.0, 3.5, 1.0, 0.0];
        let all = expected(&powers[0], &lit);
        assert!((f64::from(one(false, &lit)) / all - 1.0).abs() < 1e-5);
        assert_eq!([one(false, &[0.0; 4]), one(true, &[0.0; 4])], [0.0; 2]);
    }
}
