//! The wavelength nodes that something is prepared at: all of a file, or some of them.

use std::borrow::Cow;
use std::sync::Arc;

use zerocopy::little_endian::{F32, U16};

use super::opened::{Model, SPECTRUM};
use crate::error::Result;
use crate::estimate::Estimates;
use crate::format::{EstimateView, Head, Key, SourceBasisView, SourceView, columns};
use crate::kernel::half::widen;
use crate::spectrum::SpectralInterpolation;

/// All nodes of a model, or some. `Copy`: it only points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nodes<'a> {
    /// With the tables of these nodes and no others.
    pub head: &'a Head,
    /// Which they are of those in the file; `None` for all.
    kept: Option<&'a [usize]>,
    /// How many the file has.
    stored: usize,
}

/// Some nodes of a model, in sunlight of 1 W m⁻² nm⁻¹: what is prepared at them is relative.
#[derive(Clone, Debug)]
pub(crate) struct NodeSubset {
    head: Head,
    kept: Vec<usize>,
    stored: usize,
}

impl NodeSubset {
    /// `kept` are indices into the wavelengths of the model, strictly increasing.
    pub fn new(model: &Model, kept: Vec<usize>) -> Self {
        let head = model.head();
        Self {
            head: head.at_wavelengths(&kept).in_unit_sunlight(),
            stored: head.wavelengths.len(),
            kept,
        }
    }

    pub fn nodes(&self) -> Nodes<'_> {
        Nodes {
            head: &self.head,
            kept: Some(&self.kept),
            stored: self.stored,
        }
    }

    /// How many nodes the model has.
    pub fn stored(&self) -> usize {
        self.stored
    }

    /// Which nodes they are of those in the file.
    pub fn kept(&self) -> &[usize] {
        &self.kept
    }
}

impl Model {
    /// All its nodes.
    pub(crate) fn nodes(&self) -> Nodes<'_> {
        let head = self.head();
        Nodes {
            head,
            kept: None,
            stored: head.wavelengths.len(),
        }
    }
}

impl<'a> Nodes<'a> {
    /// Numbers at the nodes in row `i` of a table of the file.
    #[inline(always)]
    pub fn row<'t>(self, table: &'t [U16], i: usize) -> impl Iterator<Item = f32> + use<'a, 't> {
        let row = &table[i * self.stored..][..self.stored];
        let n = self.head.wavelengths.len();
        (0..n).map(move |w| widen(row[self.kept.map_or(w, |kept| kept[w])]))
    }

    /// The channel of the file that is `part` at node `w`.
    #[inline(always)]
    pub fn channel(&self, part: usize, w: usize) -> usize {
        part * self.stored + self.kept.map_or(w, |kept| kept[w])
    }

    /// The channels of the file that are `parts` parts at the nodes, `[part][node]`.
    pub fn channels(self, parts: usize) -> impl Iterator<Item = usize> + use<'a> {
        let n = self.head.wavelengths.len();
        (0..parts * n).map(move |i| self.channel(i / n, i % n))
    }

    /// The chunk that [`Nodes::interpolation`] reads.
    pub fn spectrum(self) -> Option<Key> {
        self.kept.is_none().then_some(SPECTRUM)
    }

    /// What lies between the nodes. Some of a model's do not make what its spectrum says, so that this is not read.
    pub fn interpolation(self, model: &Model) -> Result<Arc<SpectralInterpolation>> {
        match self.kept {
            None => model.shared_interpolation().cloned(),
            Some(_) => Ok(Arc::new(SpectralInterpolation::of_nodes(self.head))),
        }
    }

    /// The estimates at the nodes, of which alone `extinction` (`[constituent][node]`, m⁻¹) is given.
    pub fn estimates(&self, view: &EstimateView, extinction: &[f64]) -> Estimates {
        let planet = self.head.planet;
        match self.kept {
            None => Estimates::new(planet, view, extinction),
            Some(kept) => Estimates::at_nodes(planet, view, extinction, kept),
        }
    }

    /// A source chunk of the file at the nodes.
    pub fn source<'c>(&self, view: SourceView<'c>) -> SourceAtNodes<'c> {
        SourceAtNodes {
            parameter: self.columns(view.parameter),
            scattering: self.columns(view.scattering),
            level: self.columns(view.level),
            view,
        }
    }

    /// The channel factors of the source basis, `[field][node][component]`.
    pub fn source_channels<'c>(&self, basis: &SourceBasisView<'c>) -> Cow<'c, [F32]> {
        let (all, rank) = (basis.factors[3], basis.ranks[3]);
        if self.kept.is_none() {
            return Cow::Borrowed(all);
        }
        let fields = all.len() / (rank * self.stored);
        let row = |channel: usize| &all[channel * rank..][..rank];
        self.channels(fields).flat_map(row).copied().collect()
    }

    fn columns<'c>(&self, table: &'c [F32]) -> Cow<'c, [F32]> {
        match self.kept {
            None => Cow::Borrowed(table),
            Some(kept) => Cow::Owned(columns(table, self.stored, kept)),
        }
    }
}

/// A source chunk at some nodes.
pub(crate) struct SourceAtNodes<'a> {
    view: SourceView<'a>,
    parameter: Cow<'a, [F32]>,
    scattering: Cow<'a, [F32]>,
    level: Cow<'a, [F32]>,
}

impl SourceAtNodes<'_> {
    /// As if the file had only these nodes.
    pub fn view(&self) -> SourceView<'_> {
        SourceView {
            parameter: &self.parameter,
            scattering: &self.scattering,
            level: &self.level,
            ..self.view
        }
    }
}
