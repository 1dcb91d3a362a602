//! From the radiance at nodes to that in bands.

use crate::kernel::lanes::Lanes;
use crate::kernel::math::finite;
use crate::polarisation::Stokes;
use crate::sky::MOST_WAVELENGTHS;

/// What makes bands of relative radiance at nodes: positive, whatever the light is. A band is a sum over nodes, or over
/// wavelengths between them, at which the logarithm of the radiance is a sum. Format specification, sections 7.3, 7.9.
#[derive(Clone, Debug)]
pub(crate) struct Projection {
    bands: usize,
    /// `[node][band]`, with the solar irradiance in them.
    sums: Vec<f32>,
    /// Bands with wavelengths between nodes.
    powers: Vec<(usize, Taps)>,
    /// Whether darkness at a node counts as little light: with a spectrum.
    floor: bool,
}

/// factor · exp(Σ W ln L).
#[derive(Clone, Debug)]
struct Taps {
    factor: f32,
    nodes: Vec<(usize, f32)>,
}

/// What a band is made of.
#[derive(Clone, Debug, Default)]
pub(super) struct Made {
    /// Nodes with weights.
    pub sum: Vec<(usize, f64)>,
    pub powers: Vec<Power>,
}

/// A wavelength between nodes, with the weight of its radiance and those of the logarithms.
#[derive(Clone, Debug)]
pub(super) struct Power {
    pub factor: f64,
    pub taps: Vec<(usize, f64)>,
}

impl Made {
    /// Nodes that it needs.
    pub fn nodes(&self) -> impl Iterator<Item = usize> {
        let taps = self.powers.iter().flat_map(|power| &power.taps);
        self.sum.iter().chain(taps).map(|tap| tap.0)
    }

    /// Numbers the nodes anew.
    pub fn renumber(&mut self, number: impl Fn(usize) -> usize) {
        let taps = self.powers.iter_mut().flat_map(|power| &mut power.taps);
        let taps = self.sum.iter_mut().chain(taps);
        taps.for_each(|tap| tap.0 = number(tap.0));
    }
}

impl Projection {
    pub(super) fn new(nodes: usize, made: &[Made], floor: bool) -> Self {
        let bands = made.len();
        let mut sums = vec![0.0; nodes * bands];
        let mut powers = Vec::new();
        for (band, made) in made.iter().enumerate() {
            for &(node, weight) in &made.sum {
                sums[node * bands + band] = weight as f32;
            }
            let taps = |power: &Power| Taps {
                factor: power.factor as f32,
                nodes: power.taps.iter().map(|&(n, w)| (n, w as f32)).collect(),
            };
            powers.extend(made.powers.iter().map(|power| (band, taps(power))));
        }
        Self {
            bands,
            sums,
            powers,
            floor,
        }
    }

    /// How many bands there are.
    pub fn bands(&self) -> usize {
        self.bands
    }

    pub fn bytes(&self) -> usize {
        let taps = self
            .powers
            .iter()
            .map(|(_, p)| size_of_val(p.nodes.as_slice()));
        size_of_val(self.sums.as_slice()) + taps.sum::<usize>()
    }

    /// The bands of relative radiance at the nodes.
    #[inline]
    pub fn apply(&self, relative: &[f32], out: &mut [f32]) {
        out.fill(0.0);
        for (light, row) in relative.iter().zip(self.sums.chunks_exact(self.bands)) {
            for (sum, weight) in out.iter_mut().zip(row) {
                *sum += light * weight;
            }
        }
        if !self.powers.is_empty() {
            self.add_powers(relative, out);
        }
        out.iter_mut()
            .for_each(|value| *value = value.min(f32::MAX));
    }

    fn add_powers(&self, relative: &[f32], out: &mut [f32]) {
        let [logarithms, light] = self.logarithms(relative);
        for (band, power) in &self.powers {
            out[*band] += power.of(&light[..relative.len()], &logarithms);
        }
    }

    /// The same of polarised light.
    pub fn apply_stokes(&self, relative: &[Stokes], out: &mut [Stokes]) {
        out.fill(Stokes::default());
        for (light, row) in relative.iter().zip(self.sums.chunks_exact(self.bands)) {
            for (sum, weight) in out.iter_mut().zip(row) {
                sum.i += light.i * weight;
                sum.q += light.q * weight;
                sum.u += light.u * weight;
            }
        }
        if !self.powers.is_empty() {
            self.add_stokes(relative, out);
        }
        for light in out {
            *light = Stokes {
                i: finite(light.i),
                q: finite(light.q),
                u: finite(light.u),
            };
        }
    }

    fn add_stokes(&self, relative: &[Stokes], out: &mut [Stokes]) {
        let mut radiance = [0.0; MOST_WAVELENGTHS];
        let radiance = &mut radiance[..relative.len()];
        let pairs = radiance.iter_mut().zip(relative);
        pairs.for_each(|(radiance, light)| *radiance = light.i);
        let [logarithms, lit] = self.logarithms(radiance);
        for (band, power) in &self.powers {
            let light = power.polarised(relative, power.of(&lit, &logarithms));
            let sum = &mut out[*band];
            (sum.i, sum.q, sum.u) = (sum.i + light.i, sum.q + light.q, sum.u + light.u);
        }
    }

    /// Binary logarithms of relative radiance at the nodes, and that as it counts.
    fn logarithms(&self, relative: &[f32]) -> [[f32; MOST_WAVELENGTHS]; 2] {
        const WIDTH: usize = 8;
        /// Format specification, section 7.3: 2⁻²⁷ of the brightest.
        const DARKEST: f32 = 1.0 / (1 << 27) as f32;
        let mut light = [0.0; MOST_WAVELENGTHS];
        light[..relative.len()].copy_from_slice(relative);
        if self.floor {
            let least = DARKEST * relative.iter().fold(0.0, |a: f32, &b| a.max(b));
            light[..relative.len()]
                .iter_mut()
                .for_each(|l| *l = l.max(least));
        }
        let mut logarithms = light;
        let blocks = logarithms.as_chunks_mut::<WIDTH>().0.iter_mut();
        for block in blocks.take(relative.len().div_ceil(WIDTH)) {
            *block = Lanes(*block).max(Lanes::splat(f32::MIN_POSITIVE)).log2().0;
        }
        [logarithms, light]
    }
}

impl Taps {
    #[inline]
    fn of(&self, light: &[f32], logarithms: &[f32]) -> f32 {
        let (mut sum, mut dark) = (0.0, false);
        for &(node, weight) in &self.nodes {
            sum += weight * logarithms[node];
            dark |= light[node] <= 0.0;
        }
        match dark {
            true => self.factor * self.beside_darkness(light),
            false => self.factor * Lanes([sum]).exp2().0[0],
        }
    }

    #[cold]
    fn beside_darkness(&self, light: &[f32]) -> f32 {
        let positive = || self.nodes.iter().filter(|tap| tap.1 > 0.0);
        let whole: f32 = positive().map(|tap| tap.1).sum();
        let sum: f32 = positive().map(|&(node, w)| w * light[node]).sum();
        sum / whole.max(f32::MIN_POSITIVE)
    }

    /// Section 7.5: Q/L and U/L are summed, to a degree of 1 at most.
    fn polarised(&self, light: &[Stokes], i: f32) -> Stokes {
        let (mut q, mut u) = (0.0, 0.0);
        for &(node, weight) in &self.nodes {
            let share = weight / light[node].i.max(f32::MIN_POSITIVE);
            q += share * light[node].q;
            u += share * light[node].u;
        }
        let share = i / (q.hypot(u) * (1.0 + 4.0 * f32::EPSILON)).max(1.0);
        Stokes {
            i,
            q: q * share,
            u: u * share,
        }
    }
}
