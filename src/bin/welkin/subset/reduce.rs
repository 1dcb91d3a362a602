//! Leaves out of a model what a wish does not need.

use welkin::Model;
use welkin::format::{Chunk, Head, Payload, Selection, Spectrum, crop, encode};

use super::cells;
use super::colour::{Quadrature, check_weights};
use super::nodes::{covers, needed};
use super::samples::{Differences, Quantity, Samples, Scope};
use crate::failure::{Failure, Result, plain};

/// Skies of each comparison of the search.
const SKIES: usize = 64;
/// Share of the tolerance that the choice of wavelengths may use.
const COLOUR_SHARE: f64 = 0.6;
/// Where colour needs more wavelengths than this, all are kept: the search grows with the fifth power.
const MOST_COLOUR_WAVELENGTHS: usize = 24;
/// Tolerance of colours, if none is given.
const COLOUR_TOLERANCE: f64 = 0.01;

pub struct Wish {
    pub scope: Scope,
    /// nm.
    pub wavelengths: Option<[f64; 2]>,
    pub rgb: bool,
    /// Largest 99th percentile of relative differences; `None`: no differences.
    pub tolerance: Option<f64>,
}

pub struct Reducer<'a> {
    model: &'a Model,
    head: Head,
    chunks: Vec<Chunk>,
    wish: Wish,
    samples: Samples,
    /// Share of the tolerance that the search may use.
    share: f64,
}

impl<'a> Reducer<'a> {
    pub fn new(
        model: &'a Model,
        (head, mut chunks): (Head, Vec<Chunk>),
        wish: Wish,
    ) -> Result<Self> {
        if let Some(range) = wish.wavelengths {
            check_wavelengths(range, model.wavelength_range()?)?;
            for chunk in &mut chunks {
                if let Payload::Spectrum(spectrum) = &mut chunk.payload {
                    cells::cut(spectrum, head.constituents, range);
                }
            }
        }
        let samples = Samples::new(model, &wish.scope, SKIES, 0);
        Ok(Self {
            model,
            head,
            chunks,
            wish,
            samples,
            share: 1.0,
        })
    }

    /// What the 99th percentile of the differences must not exceed.
    pub fn promise(&self) -> f64 {
        let colour = if self.wish.rgb { COLOUR_TOLERANCE } else { 0.0 };
        self.wish.tolerance.unwrap_or(colour)
    }

    /// Lets the next search use less of the tolerance; false if that would be less than `least`.
    pub fn strive(&mut self, least: f64) -> bool {
        self.share *= 0.75;
        self.share >= least
    }

    /// The smaller model, and which wavelengths of the source it has.
    pub fn reduce(&self) -> Result<(Head, Vec<Chunk>, Vec<usize>)> {
        let mut selection = self.lossless()?;
        let quadrature = Quadrature::measure(self.model, &self.samples)?;
        if self.wish.rgb {
            selection.wavelengths = self.colour_wavelengths(&selection, &quadrature)?;
        }
        if let Some(tolerance) = self.wish.tolerance {
            self.thin(&mut selection, &quadrature, self.share * tolerance)?;
        }
        let (head, mut chunks) = self.build(&selection, &quadrature)?;
        if head.altitudes == [0.0] {
            chunks
                .iter_mut()
                .for_each(|chunk| hide_ground(&mut chunk.payload));
        }
        Ok((head, chunks, selection.wavelengths))
    }

    /// All nodes that queries within the wish meet.
    fn lossless(&self) -> Result<Selection> {
        let [low, high] = self.wish.scope.altitudes.map(f64::cbrt);
        let [far, near] = self.wish.scope.visibilities.map(f64::recip);
        let mut selection = Selection::all(&self.head);
        selection.altitudes = needed(&self.head.altitude_nodes(), low, high);
        selection.visibilities = needed(&self.head.visibility_nodes(), near, far);
        if let Some([low, high]) = self.wish.wavelengths {
            let nodes = &self.head.wavelengths;
            let spectrum = self.chunks.iter().find_map(spectrum_of);
            selection.wavelengths = match spectrum {
                Some(spectrum) => cells::nodes(spectrum, nodes, [low, high]),
                None => needed(nodes, low, high),
            };
        }
        Ok(selection)
    }

    /// The fewest wavelengths that keep colours.
    fn colour_wavelengths(&self, all: &Selection, quadrature: &Quadrature) -> Result<Vec<usize>> {
        quadrature.check_light()?;
        let share = COLOUR_SHARE * self.share * self.promise();
        for count in 3..all.wavelengths.len().min(1 + MOST_COLOUR_WAVELENGTHS) {
            let selection = Selection {
                wavelengths: quadrature.best(count),
                ..all.clone()
            };
            if self.difference(&selection, quadrature)? <= share {
                return Ok(selection.wavelengths);
            }
        }
        Ok(all.wavelengths.clone())
    }

    /// Tries to do without each node, those first that stand closest to their neighbours.
    fn thin(
        &self,
        selection: &mut Selection,
        quadrature: &Quadrature,
        tolerance: f64,
    ) -> Result<()> {
        for (axis, node) in self.candidates(selection) {
            let mut fewer = selection.clone();
            axis.of(&mut fewer).retain(|&i| i != node);
            if self.covers(&fewer) && self.difference(&fewer, quadrature)? <= tolerance {
                *selection = fewer;
            }
        }
        Ok(())
    }

    fn candidates(&self, selection: &Selection) -> Vec<(Axis, usize)> {
        let gaps = |axis: Axis, nodes: Vec<f64>, kept: &[usize]| {
            let range = (nodes[kept[kept.len() - 1]] - nodes[kept[0]]).abs();
            let gap = |k: usize| match (k.checked_sub(1), kept.get(k + 1)) {
                (Some(before), Some(&after)) => (nodes[after] - nodes[kept[before]]).abs() / range,
                _ => 0.0,
            };
            (0..kept.len())
                .map(|k| (gap(k), axis, kept[k]))
                .collect::<Vec<_>>()
        };
        let altitudes = gaps(
            Axis::Altitude,
            self.head.altitude_nodes(),
            &selection.altitudes,
        );
        let visibilities = gaps(
            Axis::Visibility,
            self.head.visibility_nodes(),
            &selection.visibilities,
        );
        let mut all = [altitudes, visibilities].concat();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        all.into_iter()
            .map(|(_, axis, node)| (axis, node))
            .collect()
    }

    fn covers(&self, selection: &Selection) -> bool {
        covers(
            &self.head.altitudes,
            &selection.altitudes,
            self.wish.scope.altitudes,
        ) && covers(
            &self.head.visibilities,
            &selection.visibilities,
            self.wish.scope.visibilities,
        )
    }

    /// 99th percentile of the relative differences to the source.
    fn difference(&self, selection: &Selection, quadrature: &Quadrature) -> Result<f64> {
        let (head, chunks) = self.build(selection, quadrature)?;
        let smaller = Model::from_bytes(encode(&head, &chunks)?)?;
        let quantity = match self.wish.rgb {
            true => Quantity::Colour,
            false => Quantity::Spectrum,
        };
        let all: Vec<usize> = (0..selection.wavelengths.len()).collect();
        let differences = Differences::between(
            &self.samples.values(&smaller, quantity, &all)?,
            &self
                .samples
                .values(self.model, quantity, &selection.wavelengths)?,
        );
        Ok(differences.quantile(0.99))
    }

    fn build(&self, selection: &Selection, quadrature: &Quadrature) -> Result<(Head, Vec<Chunk>)> {
        let (mut head, mut chunks) = (self.head.clone(), self.chunks.clone());
        crop(&mut head, &mut chunks, selection)?;
        if selection.wavelengths.len() < self.head.wavelengths.len() {
            head.xyz = quadrature.weights(&selection.wavelengths);
            check_weights(head.xyz.as_flattened())?;
        }
        Ok((head, chunks))
    }
}

fn check_wavelengths([low, high]: [f64; 2], [first, last]: [f64; 2]) -> Result<()> {
    if first <= low && low < high && high <= last {
        return Ok(());
    }
    let [first, last, low, high] = [first, last, low, high].map(plain);
    Err(Failure::message(format!(
        "wavelengths must be a range in {first}..{last} nm, got {low}..{high}"
    )))
}

fn spectrum_of(chunk: &Chunk) -> Option<&Spectrum> {
    match &chunk.payload {
        Payload::Spectrum(spectrum) => Some(spectrum),
        _ => None,
    }
}

/// From the ground nothing is seen below the horizon: zeros compress well.
fn hide_ground(payload: &mut Payload) {
    match payload {
        Payload::Radiance(factors) => factors.alpha_down.fill(0.0),
        Payload::Polarisation(factors) => factors.alpha_down.fill(0.0),
        _ => {}
    }
}

#[derive(Clone, Copy)]
enum Axis {
    Altitude,
    Visibility,
}

impl Axis {
    fn of(self, selection: &mut Selection) -> &mut Vec<usize> {
        match self {
            Axis::Altitude => &mut selection.altitudes,
            Axis::Visibility => &mut selection.visibilities,
        }
    }
}
