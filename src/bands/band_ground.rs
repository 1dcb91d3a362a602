//! The albedos that a ground has in bands.
//!
//! A node that several bands are made of has an albedo for each of them: so it is prepared once for each albedo.

use super::band_projection::Made;
use super::effective_albedo::{GroundSpectrum, Sum, TypicalLight, fit};
use super::powers::Power;
use super::response::Response;
use super::spectral_axis::{SpectralAxis, Taps};
use crate::error::{Error, Result};
use crate::format::MAX_ESTIMATE_WAVELENGTHS;
use crate::ground::Albedo;
use crate::model::Model;
use crate::sky::MOST_WAVELENGTHS;

/// What bands are made of: nodes of the model with the albedos of the ground there, in their order.
pub(super) struct Slots {
    pub nodes: Vec<usize>,
    pub albedos: Vec<f64>,
}

/// Numbers the nodes of bands by slots, of which as few as possible.
pub(super) fn slots(
    model: &Model,
    axis: &SpectralAxis,
    albedo: &Albedo,
    (responses, made): (&[Response], &mut [Made]),
) -> Result<Slots> {
    let ground = GroundSpectrum::new(model, albedo);
    let light = TypicalLight::new(model)?;
    let fitter = Fitter {
        model,
        axis,
        ground,
        light,
    };
    let mut albedos = Vec::new();
    for (response, made) in responses.iter().zip(&*made) {
        albedos.push(fitter.albedos(response, made)?);
    }
    let pairs = made.iter().zip(&albedos);
    let mut all: Vec<Slot> = pairs.flat_map(|(made, own)| slots_of(made, own)).collect();
    all.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    all.dedup();
    check(model, all.len())?;
    for (made, own) in made.iter_mut().zip(&albedos) {
        let mut slots = slots_of(made, own).collect::<Vec<_>>().into_iter();
        made.renumber(|node| {
            let slot = slots.next().filter(|slot| slot.0 == node);
            slot.and_then(|slot| all.iter().position(|other| *other == slot))
                .unwrap_or(0)
        });
    }
    Ok(Slots {
        nodes: all.iter().map(|slot| slot.0).collect(),
        albedos: all.iter().map(|slot| slot.1).collect(),
    })
}

/// A node and the albedo there.
type Slot = (usize, f64);

/// The slots of a band in the order in which it names its nodes, given the albedo of each of its pieces.
fn slots_of<'a>(made: &'a Made, albedos: &'a PieceAlbedos) -> impl Iterator<Item = Slot> + 'a {
    let sum = made.sum.iter().zip(&albedos.sum);
    let sum = sum.map(|(&(node, _), &albedo)| (node, albedo));
    let powers = made.powers.iter().zip(&albedos.powers);
    let powers = powers.flat_map(|(power, &albedo)| power.taps.iter().map(move |t| (t.0, albedo)));
    sum.chain(powers)
}

/// Albedos of the nodes of a sum, and of the wavelengths between nodes.
struct PieceAlbedos {
    sum: Vec<f64>,
    powers: Vec<f64>,
}

fn check(model: &Model, got: usize) -> Result<()> {
    let most = match model.head().estimated {
        true => MAX_ESTIMATE_WAVELENGTHS,
        false => MOST_WAVELENGTHS,
    };
    if got <= most {
        return Ok(());
    }
    Err(Error::Limit {
        what: "wavelengths of bands over a ground whose albedo depends on wavelength",
        most,
        got,
    })
}

struct Fitter<'a> {
    model: &'a Model,
    axis: &'a SpectralAxis,
    ground: GroundSpectrum<'a>,
    light: TypicalLight,
}

impl Fitter<'_> {
    fn albedos(&self, response: &Response, made: &Made) -> Result<PieceAlbedos> {
        let [first, last] = response.range();
        if first == last {
            // At one wavelength all nodes have the ground of that.
            let albedo = self.ground.exact(first);
            return Ok(PieceAlbedos {
                sum: vec![albedo; made.sum.len()],
                powers: vec![albedo; made.powers.len()],
            });
        }
        let (mean, middle) = self.means(response)?;
        let nodes = made
            .sum
            .iter()
            .map(|&(n, w)| scaled(self.light.at_node(n), w));
        let powers = made.powers.iter().map(|p| self.light.power(p));
        let parts: Vec<Vec<f64>> = nodes.chain(powers).collect();
        let around = self.around(response, made, middle)?;
        let tau = fit(&[Sum { parts, mean }], &around);
        let (sum, powers) = tau.split_at(made.sum.len());
        let at = |(&(n, _), &tau): (&(usize, f64), &f64)| self.ground.albedo(n, tau);
        let between = |(p, &tau): (&Power, &f64)| self.ground.albedo(main_node(&p.taps), tau);
        Ok(PieceAlbedos {
            sum: made.sum.iter().zip(sum).map(at).collect(),
            powers: made.powers.iter().zip(powers).map(between).collect(),
        })
    }

    /// The mean of τ over the response for each example, and over all.
    fn means(&self, response: &Response) -> Result<(Vec<f64>, f64)> {
        let mut sums = vec![[0.0; 2]; self.light.examples()];
        for [wavelength, weight] in self.quadrature(response)? {
            let tau = self.ground.tau(wavelength);
            let light = self.light.at(self.axis, wavelength);
            for (sum, light) in sums.iter_mut().zip(light) {
                sum[0] += weight * light * tau;
                sum[1] += weight * light;
            }
        }
        let means: Vec<f64> = sums.iter().map(|[part, whole]| part / whole).collect();
        let [part, whole] = sums
            .iter()
            .fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
        Ok((means, part / whole))
    }

    /// Wavelengths, and weights with the sunlight in them.
    fn quadrature(&self, response: &Response) -> Result<Vec<[f64; 2]>> {
        let head = self.model.head();
        let mut nodes = self.axis.quadrature(head, response)?;
        for node in &mut nodes {
            node[1] *= head.solar_irradiance_at(node[0]);
        }
        Ok(nodes)
    }

    /// The mean of τ around each node of the sum, up to its neighbours there; between nodes that of the band.
    fn around(&self, response: &Response, made: &Made, middle: f64) -> Result<Vec<f64>> {
        let head = self.model.head();
        let nodes: Vec<f64> = made.sum.iter().map(|s| head.wavelengths[s.0]).collect();
        let mut sums = vec![[0.0; 2]; nodes.len()];
        if !nodes.is_empty() {
            for [wavelength, weight] in self.quadrature(response)? {
                let tau = self.ground.tau(wavelength);
                for (n, near) in crate::kernel::axis::linear(&nodes, wavelength).taps() {
                    sums[n][0] += near * weight * tau;
                    sums[n][1] += near * weight;
                }
            }
        }
        let mean = |[part, whole]: [f64; 2]| if whole > 0.0 { part / whole } else { middle };
        let powers = core::iter::repeat_n(middle, made.powers.len());
        Ok(sums.into_iter().map(mean).chain(powers).collect())
    }
}

fn scaled(mut values: Vec<f64>, factor: f64) -> Vec<f64> {
    values.iter_mut().for_each(|v| *v *= factor);
    values
}

/// The node that counts most.
fn main_node(taps: &Taps) -> usize {
    let most = taps.iter().max_by(|a, b| a.1.total_cmp(&b.1));
    most.map_or(0, |tap| tap.0)
}
