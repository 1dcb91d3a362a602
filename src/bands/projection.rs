//! From the radiance at nodes to that in bands.

use crate::kernel::math::finite;
use crate::polarisation::Stokes;

/// What makes bands of relative radiance at nodes: positive, whatever the light is.
#[derive(Clone, Debug)]
pub(crate) struct Projection {
    bands: usize,
    /// `[node][band]`, with the solar irradiance in them; 0 for bands that are no sums.
    sums: Vec<f32>,
    powers: Vec<Power>,
}

/// A band that is a wavelength between nodes, at which no sum is right: irradiance · exp(Σ W ln L).
#[derive(Clone, Debug)]
struct Power {
    band: usize,
    irradiance: f32,
    taps: Vec<(usize, f32)>,
}

/// What a band is made of, with indices of the nodes that are kept.
pub(super) enum Made {
    Sum(Vec<(usize, f64)>),
    Power(f64, Vec<(usize, f64)>),
}

impl Made {
    /// Nodes with weights.
    pub fn taps(&self) -> &[(usize, f64)] {
        match self {
            Self::Sum(taps) | Self::Power(_, taps) => taps,
        }
    }

    pub fn taps_mut(&mut self) -> &mut [(usize, f64)] {
        match self {
            Self::Sum(taps) | Self::Power(_, taps) => taps,
        }
    }
}

impl Projection {
    pub(super) fn new(nodes: usize, made: &[Made]) -> Self {
        let bands = made.len();
        let mut sums = vec![0.0; nodes * bands];
        let mut powers = Vec::new();
        for (band, made) in made.iter().enumerate() {
            match made {
                Made::Sum(weights) => {
                    for &(node, weight) in weights {
                        sums[node * bands + band] = weight as f32;
                    }
                }
                Made::Power(irradiance, taps) => powers.push(Power {
                    band,
                    irradiance: *irradiance as f32,
                    taps: taps.iter().map(|&(node, w)| (node, w as f32)).collect(),
                }),
            }
        }
        Self { bands, sums, powers }
    }

    /// How many bands there are.
    pub fn bands(&self) -> usize {
        self.bands
    }

    pub fn bytes(&self) -> usize {
        let taps = self.powers.iter().map(|p| size_of_val(p.taps.as_slice()));
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
        for power in &self.powers {
            out[power.band] = power.of(|node| relative[node]);
        }
        out.iter_mut().for_each(|value| *value = value.min(f32::MAX));
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
        for power in &self.powers {
            out[power.band] = power.stokes(relative);
        }
        for light in out {
            *light = Stokes {
                i: finite(light.i),
                q: finite(light.q),
                u: finite(light.u),
            };
        }
    }

    /// Weight of a node in a band that is a sum.
    pub fn weight(&self, node: usize, band: usize) -> f32 {
        self.sums[node * self.bands + band]
    }
}

impl Power {
    /// Format specification, section 7.3.
    fn of(&self, light: impl Fn(usize) -> f32) -> f32 {
        if self.taps.iter().all(|&(node, _)| light(node) > 0.0) {
            let logarithm: f32 = self.taps.iter().map(|&(node, w)| w * light(node).ln()).sum();
            return self.irradiance * logarithm.exp();
        }
        let positive = || self.taps.iter().filter(|tap| tap.1 > 0.0);
        let whole: f32 = positive().map(|tap| tap.1).sum();
        let sum: f32 = positive().map(|&(node, w)| w * light(node)).sum();
        self.irradiance * sum / whole.max(f32::MIN_POSITIVE)
    }

    /// Section 7.5: Q/L and U/L are summed, to a degree of 1 at most.
    fn stokes(&self, light: &[Stokes]) -> Stokes {
        let i = self.of(|node| light[node].i);
        let (mut q, mut u) = (0.0, 0.0);
        for &(node, weight) in &self.taps {
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
