//! From the radiance at nodes to that in bands.

use super::powers::{Power, Powers};
use crate::kernel::math::finite;
use crate::polarisation::Stokes;

/// What makes bands of relative radiance at nodes: positive, whatever the light is. A band is a sum over nodes, or over
/// wavelengths between them, at which the logarithm of the radiance is a sum. Format specification, sections 7.3, 7.9.
#[derive(Clone, Debug)]
pub(crate) struct Projection {
    bands: usize,
    /// `[node][band]`, with the solar irradiance in them.
    sums: Vec<f32>,
    /// Wavelengths between nodes.
    powers: Powers,
}

/// What a band is made of.
#[derive(Clone, Debug, Default)]
pub(super) struct Made {
    /// Nodes with weights.
    pub sum: Vec<(usize, f64)>,
    pub powers: Vec<Power>,
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
            powers.extend(made.powers.iter().map(|power| (band, power)));
        }
        Self {
            bands,
            sums,
            powers: Powers::new(nodes, &powers, floor),
        }
    }

    /// How many bands there are.
    pub fn bands(&self) -> usize {
        self.bands
    }

    pub fn bytes(&self) -> usize {
        size_of_val(self.sums.as_slice()) + self.powers.bytes()
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
            self.powers.each(relative, |band, light| out[band] += light);
        }
        out.iter_mut()
            .for_each(|value| *value = value.min(f32::MAX));
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
            self.powers.each_stokes(relative, |band, light| {
                let sum = &mut out[band];
                (sum.i, sum.q, sum.u) = (sum.i + light.i, sum.q + light.q, sum.u + light.u);
            });
        }
        for light in out {
            *light = Stokes {
                i: finite(light.i),
                q: finite(light.q),
                u: finite(light.u),
            };
        }
    }
}
