//! Light scattered once, and sunlit ground seen directly: deterministic quadrature along the line of sight.

use super::line_of_sight::Sight;
use super::medium::Medium;
use super::phase::Aerosol;
use super::stokes::{Mueller, Scattering};
use glam::DVec3;
use std::f64::consts::{FRAC_1_PI, PI};

/// Pieces whose estimated error exceeds this part of the whole are halved. The estimate is the 7-point rule's error,
/// far above the 15-point rule's.
const TOLERANCE: f64 = 2e-6;
const DEEPEST: usize = 14;

/// Positive nodes of the 15-point Kronrod rule, their weights, and the weights of the embedded 7-point Gauss rule.
const KRONROD: [(f64, f64, f64); 8] = [
    (0.991_455_371_120_812_6, 0.022_935_322_010_529_224, 0.0),
    (
        0.949_107_912_342_758_5,
        0.063_092_092_629_978_55,
        0.129_484_966_168_869_7,
    ),
    (0.864_864_423_359_769_1, 0.104_790_010_322_250_18, 0.0),
    (
        0.741_531_185_599_394_4,
        0.140_653_259_715_525_92,
        0.279_705_391_489_276_64,
    ),
    (0.586_087_235_467_691_1, 0.169_004_726_639_267_9, 0.0),
    (
        0.405_845_151_377_397_2,
        0.190_350_578_064_785_4,
        0.381_830_050_505_118_9,
    ),
    (0.207_784_955_007_898_46, 0.204_432_940_075_298_89, 0.0),
    (0.0, 0.209_482_141_084_727_82, 0.417_959_183_673_469_4),
];

/// Weighted sums of F11 and F12 over a piece.
type Pair<const N: usize> = [[f64; N]; 2];

struct Integrand<'a, const N: usize> {
    medium: &'a Medium<N>,
    sight: &'a Sight<N>,
    sun: DVec3,
    cosine: f64,
    aerosol: Aerosol,
}

/// Stokes vectors of light scattered exactly once on the way to the observer.
pub fn scattered_once<const N: usize>(
    medium: &Medium<N>,
    sight: &Sight<N>,
    sun: DVec3,
    aerosol: Aerosol,
) -> [[f64; N]; 3] {
    let integrand = Integrand {
        medium,
        sight,
        sun,
        cosine: sight.frame.w.dot(sun).clamp(-1.0, 1.0),
        aerosol,
    };
    let [f11, f12] = integrand.integrate();
    let f = Scattering {
        f11,
        f12,
        ..Scattering::ZERO
    };
    Mueller::identity().natural(sight.frame.angle_to(sun), &f)
}

/// Radiance of directly sunlit ground at the end of the line of sight, for albedo 1.
pub fn sunlit_ground<const N: usize>(medium: &Medium<N>, sight: &Sight<N>, sun: DVec3) -> [f64; N] {
    let point = sight.line.at(sight.end);
    let cosine = point.normalize().dot(sun);
    let light = (cosine > 0.0)
        .then(|| medium.sunlight(point, sun))
        .flatten();
    light.map_or([0.0; N], |light| {
        std::array::from_fn(|w| sight.transmittance[w] * light[w] * cosine * FRAC_1_PI)
    })
}

impl<const N: usize> Integrand<'_, N> {
    fn integrate(&self) -> Pair<N> {
        let pieces: Vec<(f64, f64)> = self.pieces();
        let first: Vec<_> = pieces.iter().map(|&(a, b)| self.rule(a, b)).collect();
        let mut scale = [1e-300; N];
        for (value, _) in &first {
            for (s, v) in scale.iter_mut().zip(&value[0]) {
                *s += v;
            }
        }
        let mut sum = [[0.0; N]; 2];
        for (&(a, b), rule) in pieces.iter().zip(first) {
            self.refine(a, b, rule, &scale, 0, &mut sum);
        }
        sum
    }

    fn pieces(&self) -> Vec<(f64, f64)> {
        let end = self.sight.end;
        let edges = self.sight.line.shadow_edges(self.sun, self.medium.radius);
        let mut breaks = self.sight.node_breaks(self.medium);
        breaks.extend(edges.into_iter().filter(|&t| t > 0.0 && t < end));
        breaks.sort_by(f64::total_cmp);
        breaks.windows(2).map(|p| (p[0], p[1])).collect()
    }

    fn refine(
        &self,
        a: f64,
        b: f64,
        (value, error): (Pair<N>, [f64; N]),
        scale: &[f64; N],
        depth: usize,
        sum: &mut Pair<N>,
    ) {
        let good = (0..N).all(|w| error[w] <= TOLERANCE * scale[w]);
        if good || depth == DEEPEST {
            for (s, v) in sum.iter_mut().flatten().zip(value.iter().flatten()) {
                *s += v;
            }
            return;
        }
        let middle = 0.5 * (a + b);
        for (from, to) in [(a, middle), (middle, b)] {
            self.refine(from, to, self.rule(from, to), scale, depth + 1, sum);
        }
    }

    /// The 15-point rule over a piece, and how far the 7-point rule is from it in F11.
    fn rule(&self, a: f64, b: f64) -> (Pair<N>, [f64; N]) {
        let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
        let (mut value, mut coarse) = ([[0.0; N]; 2], [0.0; N]);
        for (x, kronrod, gauss) in KRONROD {
            let signs: &[f64] = if x == 0.0 { &[1.0] } else { &[1.0, -1.0] };
            for sign in signs {
                let f = self.at(middle + sign * x * half);
                for w in 0..N {
                    value[0][w] += half * kronrod * f[0][w];
                    value[1][w] += half * kronrod * f[1][w];
                    coarse[w] += half * gauss * f[0][w];
                }
            }
        }
        let error = std::array::from_fn(|w| (value[0][w] - coarse[w]).abs());
        (value, error)
    }

    fn at(&self, t: f64) -> Pair<N> {
        let point = self.sight.line.at(t);
        let Some(light) = self.medium.sunlight(point, self.sun) else {
            return [[0.0; N]; 2];
        };
        let altitude = self.sight.line.radius(self.sight.line.start + t) - self.medium.radius;
        let profile = self.medium.profile(altitude);
        let mut f = Scattering::ZERO;
        for lobe in &self.medium.lobes {
            lobe.add(profile[lobe.constituent], self.cosine, self.aerosol, &mut f);
        }
        let through = self
            .medium
            .transmittance(&self.sight.columns_to(self.medium, t));
        let factor: [f64; N] = std::array::from_fn(|w| light[w] * through[w] / (4.0 * PI));
        [f.f11, f.f12].map(|f| std::array::from_fn(|w| f[w] * factor[w]))
    }
}
