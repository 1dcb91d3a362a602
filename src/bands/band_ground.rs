//! The albedos that a ground has in bands.
//!
//! Bands are prepared over a black and a white ground: each node of theirs twice. What they are made of takes the share
//! τ of the second and the rest of the first.

use super::band_projection::{Made, Projection};
use super::effective_albedo::{GroundSpectrum, Sum, TypicalLight, fit, white_share};
use super::powers::Power;
use super::response::Response;
use super::spectral_axis::{SpectralAxis, Taps};
use crate::error::{Error, Result};
use crate::format::{Head, MAX_ESTIMATE_WAVELENGTHS, visibility_node};
use crate::ground::Albedo;
use crate::kernel::axis::linear;
use crate::model::{Model, NodeSubset};
use crate::sky::MOST_WAVELENGTHS;

/// Albedos of what a band is made of: the nodes of a sum, and wavelengths between nodes.
#[derive(Clone, Debug)]
pub(super) struct PieceAlbedos {
    sum: Vec<f64>,
    powers: Vec<f64>,
}

/// The albedos in each band, of which `made` has the nodes of the model.
pub(super) fn piece_albedos(
    model: &Model,
    axis: &SpectralAxis,
    albedo: &Albedo,
    (responses, made): (&[Response], &[Made]),
) -> Result<Vec<PieceAlbedos>> {
    let fitter = Fitter {
        model,
        axis,
        ground: GroundSpectrum::new(model, albedo),
        light: TypicalLight::new(model)?,
    };
    let bands = responses.iter().zip(made);
    bands
        .map(|(response, made)| fitter.albedos(response, made))
        .collect()
}

/// Bands over a ground whose albedo depends on wavelength.
#[derive(Clone, Debug)]
pub(super) struct BandGround {
    albedo: Albedo,
    made: Vec<Made>,
    pieces: Vec<PieceAlbedos>,
    floor: bool,
}

impl BandGround {
    /// `made` has the numbers of the nodes that the bands need, of which there are `nodes`.
    pub fn new(
        model: &Model,
        albedo: &Albedo,
        (made, nodes, floor): (Vec<Made>, usize, bool),
        pieces: Vec<PieceAlbedos>,
    ) -> Result<Self> {
        let most = match model.head().estimated {
            true => MAX_ESTIMATE_WAVELENGTHS,
            false => MOST_WAVELENGTHS,
        };
        if 2 * nodes > most {
            return Err(Error::Limit {
                what: "wavelengths of bands over two grounds",
                most,
                got: 2 * nodes,
            });
        }
        Ok(Self {
            albedo: albedo.clone(),
            made,
            pieces,
            floor,
        })
    }

    pub fn albedo(&self) -> &Albedo {
        &self.albedo
    }

    /// What makes bands of light at the nodes of [`twice`], at a visibility (m).
    pub fn projection(&self, twice: &Head, visibility: f64) -> Projection {
        let nodes = twice.wavelengths.len();
        let around = linear(&twice.visibility_nodes(), visibility_node(visibility));
        let spherical = |node: usize| -> f64 {
            let rows = around.taps();
            rows.map(|(v, w)| w * twice.spherical_albedo[v * nodes + 2 * node])
                .sum()
        };
        let bands = self.made.iter().zip(&self.pieces);
        let over: Vec<Made> = bands
            .map(|(made, own)| over(made, own, spherical))
            .collect();
        Projection::new(nodes, &over, self.floor)
    }
}

/// These nodes over a black ground and over a white one, one after the other, and the albedos of these.
pub(super) fn twice(model: &Model, kept: &[usize]) -> (NodeSubset, Vec<f64>) {
    let nodes = kept.iter().flat_map(|&node| [node, node]).collect();
    let albedos = kept.iter().flat_map(|_| [0.0, 1.0]).collect();
    (NodeSubset::new(model, nodes), albedos)
}

/// The same band made of both, where the nodes have these spherical albedos.
fn over(made: &Made, albedos: &PieceAlbedos, spherical: impl Fn(usize) -> f64) -> Made {
    let mut out = Made::default();
    for (&(node, weight), &albedo) in made.sum.iter().zip(&albedos.sum) {
        let white = white_share(albedo, spherical(node));
        out.sum.push((2 * node, weight * (1.0 - white)));
        out.sum.push((2 * node + 1, weight * white));
    }
    for (power, &albedo) in made.powers.iter().zip(&albedos.powers) {
        let white = white_share(albedo, mean_over(&power.taps, &spherical));
        for (ground, share) in [1.0 - white, white].into_iter().enumerate() {
            let taps = power.taps.iter().map(|&(node, w)| (2 * node + ground, w));
            out.powers.push(Power {
                factor: power.factor * share,
                taps: taps.collect(),
            });
        }
    }
    out
}

/// The mean at nodes that count in a wavelength between them.
fn mean_over(taps: &Taps, value: impl Fn(usize) -> f64) -> f64 {
    let (mut sum, mut whole) = (0.0, 0.0);
    for &(node, weight) in taps.iter().filter(|tap| tap.1 > 0.0) {
        sum += weight * value(node);
        whole += weight;
    }
    if whole > 0.0 { sum / whole } else { 0.0 }
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
        let at = |(&(n, _), &tau): (&(usize, f64), &f64)| {
            self.ground.albedo_of(self.ground.spherical(n), tau)
        };
        let between = |(p, &tau): (&Power, &f64)| {
            let s = mean_over(&p.taps, |node| self.ground.spherical(node));
            self.ground.albedo_of(s, tau)
        };
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
