//! No more of a model than a scene needs.

use crate::baked::{check_tolerance, largest_colour, largest_polarised, largest_spectral};
use crate::error::{Error, Result};
use crate::format::{Entry, KIND_COLUMN, KIND_RADIANCE, KIND_RADIANCE_BASIS, Kind};
use crate::model::{Key, Model, SPECTRUM};
use crate::point_query::{Chunks, Factors, PointQuery, checked_head};
use crate::polarisation::PolarisedPointQuery;

/// What the skies of a scene are asked for.
///
/// ```
/// use welkin::{BakedSky, Budget, Channels, Model};
///
/// let model = Model::default_model()?;
/// let budget = |channels| Budget {
///     altitude: [0.0, 100.0],
///     visibility: [40e3, 60e3],
///     solar_elevation: [0.1, 1.0],
///     tolerance: BakedSky::TOLERANCE,
///     channels,
/// };
/// let [colour, stokes] = [Channels::Colour, Channels::Stokes].map(|c| model.plan(&budget(c)));
/// assert!(colour?.sky_bytes < stokes?.sky_bytes);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channels {
    /// Radiance at the wavelengths of the model, or at any between them.
    Spectral,
    /// XYZ or RGB.
    Colour,
    /// Stokes vectors at the wavelengths of the model.
    Stokes,
}

/// The conditions that a scene can meet, and what it tolerates. Albedo is free: every chunk holds all of it.
///
/// ```
/// use welkin::{BakedSky, Budget, Channels, Model};
///
/// let model = Model::default_model()?;
/// let plan = model.plan(&Budget {
///     altitude: [0.0, 100.0],
///     visibility: [40e3, 60e3],
///     solar_elevation: [0.1, 1.0],
///     tolerance: BakedSky::TOLERANCE,
///     channels: Channels::Colour,
/// })?;
/// assert!(plan.file_bytes < model.file_bytes() / 4);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Lowest and highest altitude of observers, m.
    pub altitude: [f64; 2],
    /// Lowest and highest visibility, m.
    pub visibility: [f64; 2],
    /// Lowest and highest elevation of the sun, rad. A narrow range saves nothing, as every chunk holds the whole of
    /// it.
    pub solar_elevation: [f64; 2],
    /// Relative error that baking may add at 95 % of directions and channels.
    pub tolerance: f64,
    /// What skies are asked for.
    pub channels: Channels,
}

/// What a scene needs of a model, and what it gets.
///
/// ```
/// use welkin::{BakedSky, Budget, Channels, Conditions, Model};
///
/// let model = Model::stream(welkin::DEFAULT_MODEL.to_vec())?; // or what a server has
/// let plan = model.plan(&Budget {
///     altitude: [0.0, 100.0],
///     visibility: [40e3, 60e3],
///     solar_elevation: [0.1, 1.0],
///     tolerance: BakedSky::TOLERANCE,
///     channels: Channels::Spectral,
/// })?;
/// model.load(&plan)?;
/// let loaded = model.traffic();
/// model.sky(&Conditions { visibility: 50e3, ..Conditions::default() })?;
/// assert_eq!(model.traffic(), loaded); // nothing more is read
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    budget: Budget,
    chunks: Vec<usize>,
    /// Bytes of the file that are read, all in all: the head and the chunks.
    pub file_bytes: usize,
    /// Chunks that are read.
    pub chunk_count: usize,
    /// Most bytes that a baked sky of the scene holds.
    pub sky_bytes: usize,
    /// Largest median of the relative error of a chunk against its traced data.
    pub error_median: f32,
    /// Largest 99th percentile of the relative error of a chunk against its traced data. Between altitudes and
    /// visibilities of the model errors are larger; the documentation of the model says how much.
    pub error_p99: f32,
    /// Where Stokes vectors are asked for: largest median and largest 99th percentile of the error of the degree of
    /// linear polarisation of a chunk against its traced data.
    pub degree_error: Option<[f32; 2]>,
    /// Relative error that baking adds at most at 95 % of directions and channels: to the radiance, and to (Q, U)
    /// relative to it.
    pub bake_p95: f64,
}

impl Plan {
    /// The budget that it keeps.
    pub fn budget(&self) -> &Budget {
        &self.budget
    }
}

impl Model {
    /// Finds what a scene needs; reads nothing.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a range that is not within the model or a tolerance that baking refuses for every sky
    /// (whether a hard sky keeps it shows when that is baked), [`Error::MissingChunk`] if the file lacks a chunk, such
    /// as those of the polarisation.
    pub fn plan(&self, budget: &Budget) -> Result<Plan> {
        let head = self.head();
        check("altitude", budget.altitude, self.altitude_range())?;
        check("visibility", budget.visibility, self.visibility_range())?;
        let elevations = self.solar_elevation_range();
        check_range("solar_elevation", budget.solar_elevation, elevations, "rad")?;
        check_tolerance(budget.tolerance)?;
        let altitudes = around(&head.altitudes, budget.altitude);
        let visibilities = around(&head.visibilities, budget.visibility);
        let polarised = budget.channels == Channels::Stokes;
        let kinds = &FACTORS[..if polarised { 2 } else { 1 }];
        let mut keys: Vec<Key> = kinds
            .iter()
            .map(|&[basis, _]| (basis, None, None))
            .collect();
        for a in altitudes {
            if !head.estimated {
                keys.push((Kind::Column, Some(a), None));
            }
            for v in visibilities.clone() {
                keys.extend(kinds.iter().map(|&[_, own]| (own, Some(a), Some(v))));
            }
        }
        if self.has_spectrum() {
            keys.push(SPECTRUM);
        }
        if head.estimated {
            keys.push((Kind::Estimate, None, None));
        }
        let chunks = keys
            .into_iter()
            .map(|(kind, a, v)| self.find(kind, a, v))
            .collect::<Result<Vec<_>>>()?;
        let entries = || chunks.iter().map(|&i| &self.directory()[i]);
        let worst = |kind: Kind, error: fn(&Entry) -> f32| {
            let of_kind = entries().filter(|entry| entry.kind == kind);
            of_kind.map(error).fold(0.0, f32::max)
        };
        let [median, p99]: [fn(&Entry) -> f32; 2] = [|e| e.error_median, |e| e.error_p99];
        Ok(Plan {
            budget: *budget,
            file_bytes: self.head_bytes() + entries().map(|entry| entry.length).sum::<usize>(),
            chunk_count: chunks.len(),
            sky_bytes: match budget.channels {
                Channels::Spectral => largest_spectral(head),
                Channels::Colour => largest_colour(),
                Channels::Stokes => largest_polarised(head),
            },
            error_median: worst(Kind::Radiance, median),
            error_p99: worst(Kind::Radiance, p99),
            degree_error: polarised.then(|| [median, p99].map(|e| worst(Kind::Polarisation, e))),
            bake_p95: budget.tolerance,
            chunks,
        })
    }

    /// Reads and verifies what a plan of this model asks for, with as few requests as possible; after that no sky of
    /// the scene reads anything.
    ///
    /// # Errors
    /// [`Error::Read`], [`Error::Checksum`], [`Error::Encoding`] or [`Error::Invalid`].
    pub fn load(&self, plan: &Plan) -> Result<()> {
        self.load_chunks(&plan.chunks)
    }

    /// Prepares point queries within a plan of this model, and reads what it asks for. They are not polarised.
    ///
    /// # Errors
    /// As [`Model::load`]; [`Error::Limit`] for models that are too large for [`PointQuery`]; [`Error::Invalid`] for one
    /// with a ground of its own ([`Model::over`]): every query says its albedo, at one wavelength that of its ground there.
    pub fn point_query(&self, plan: &Plan) -> Result<PointQuery<'_>> {
        self.refuse_ground()?;
        self.load(plan)?;
        let head = checked_head(self.front())?;
        let mut chunks = Chunks::new(&head)?;
        for &i in &plan.chunks {
            let entry = &self.directory()[i];
            let kind = match entry.kind {
                Kind::Radiance => KIND_RADIANCE,
                Kind::Column => KIND_COLUMN,
                Kind::RadianceBasis => KIND_RADIANCE_BASIS,
                _ => continue,
            };
            let place = [entry.altitude, entry.visibility].map(Option::unwrap_or_default);
            chunks.insert(&head, kind, place, entry.rank, self.chunk(i)?)?;
        }
        let estimate = match self.head().estimated {
            true => Some(self.estimate_chunk()?),
            false => None,
        };
        let query = PointQuery::assemble(head, chunks, self.spectrum_chunk()?, estimate)?;
        let light = self.head().solar_irradiance.as_slice();
        Ok(query.under(self.is_moonlit().then_some(light)))
    }
}

impl Model {
    /// Prepares point queries with Stokes vectors within a plan of this model for [`Channels::Stokes`], and reads what
    /// it asks for.
    ///
    /// # Errors
    /// As [`Model::point_query`]; [`Error::MissingChunk`] for a plan without polarisation.
    pub fn polarised_point_query(&self, plan: &Plan) -> Result<PolarisedPointQuery<'_>> {
        self.refuse_ground()?;
        let query = self.point_query(plan)?;
        let head = self.head();
        let visibilities = head.visibilities.len();
        let mut chunks = vec![None; head.altitudes.len() * visibilities];
        if plan.budget.channels != Channels::Stokes {
            return Err(Error::MissingChunk {
                kind: Kind::Polarisation.name(),
                altitude: None,
                visibility: None,
            });
        }
        let entries = plan.chunks.iter().map(|&i| &self.directory()[i]);
        for entry in entries.filter(|entry| entry.kind == Kind::Polarisation) {
            let [a, v] = [entry.altitude, entry.visibility].map(Option::unwrap_or_default);
            chunks[a * visibilities + v] = Some(self.polarisation_chunk(a, v)?);
        }
        let factors = Factors::new(self.polarisation_basis()?, chunks, visibilities)?;
        Ok(PolarisedPointQuery::new(query, factors))
    }
}

/// Factor matrices of the radiance and of its polarisation: what all chunks share, and what each has.
const FACTORS: [[Kind; 2]; 2] = [
    [Kind::RadianceBasis, Kind::Radiance],
    [Kind::PolarisationBasis, Kind::Polarisation],
];

/// The nodes that interpolation between two values touches: one more on either side of those around them.
fn around(nodes: &[f64], [low, high]: [f64; 2]) -> std::ops::Range<usize> {
    let last = nodes.len() - 1;
    let below = nodes.partition_point(|&node| node <= low).max(1) - 1;
    let above = nodes.partition_point(|&node| node < high).min(last);
    if below >= above && nodes[above.min(below)] == low {
        return below..below + 1;
    }
    below.saturating_sub(1)..(above + 1).min(last) + 1
}

fn check(parameter: &'static str, range: [f64; 2], of_model: [f64; 2]) -> Result<()> {
    check_range(parameter, range, of_model, "m")
}

fn check_range(
    parameter: &'static str,
    [low, high]: [f64; 2],
    [min, max]: [f64; 2],
    unit: &'static str,
) -> Result<()> {
    let within = |v: f64| v >= min && v <= max;
    if within(low) && within(high) && low <= high {
        return Ok(());
    }
    Err(Error::OutOfRange {
        parameter,
        value: if within(low) { high } else { low },
        min: if within(low) && within(high) {
            low
        } else {
            min
        },
        max,
        unit,
    })
}

#[cfg(test)]
mod tests {
    use super::around;

    #[test]
    fn nodes_around_ranges_are_those_of_the_interpolation() {
        let nodes = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0];
        for (range, expected) in [
            ([0.0, 0.0], 0..1),
            ([2.0, 2.0], 2..3),
            ([5.0, 5.0], 5..6),
            ([2.5, 2.5], 1..5),
            ([0.5, 0.5], 0..3),
            ([4.5, 4.6], 3..6),
            ([2.0, 3.0], 1..5),
            ([0.0, 5.0], 0..6),
        ] {
            assert_eq!(around(&nodes, range), expected, "{range:?}");
        }
        assert_eq!(around(&[7.0], [7.0, 7.0]), 0..1);
    }
}
