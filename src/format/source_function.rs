//! The source function of multiply scattered light (kinds 5 and 8). Format specification, sections 6.5 and 6.8.

use core::mem::offset_of;
use core::ops::Range;

use half::f16;
use zerocopy::little_endian::{F32, F64, U16, U32};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use super::head::PhaseFunction;
use super::matrix::{columns, narrow, rows};
use super::payload_bytes::check;
use super::views::{Payload16, check_length, half_is_finite, take};
use crate::error::{Error, Number, Result};
use crate::kernel::half::widen;

/// Components of the tensor that describes light for Rayleigh scattering.
pub const TENSOR: usize = 4;
/// Fields of the source: scattered by the air only; reflected by the ground before.
pub const SOURCE_FIELDS: usize = 2;
/// Most nodes of an axis.
const MAX_NODES: usize = 256;
/// Most altitudes times wavelengths times components of the moments.
const MAX_SOURCE_TABLE: usize = 1 << 18;
/// Largest degree of the harmonics.
const MAX_DEGREE: usize = 24;
/// Most components along one mode.
const MAX_COMPONENTS: usize = 64;
/// Most components along the mode of the moments: evaluation takes time for each.
pub const MAX_MOMENTS: usize = 32;
/// Most species of scatterers.
const MAX_SPECIES: usize = 16;

/// Components along the modes altitude, sun, moment, channel.
///
/// ```
/// use welkin::format::{Payload, Ranks, unpack};
///
/// let (_, chunks) = unpack(welkin::DEFAULT_MODEL)?;
/// let basis = chunks.iter().find_map(|chunk| match &chunk.payload {
///     Payload::SourceBasis(basis) => Some(basis),
///     _ => None,
/// });
/// let ranks: Ranks = basis.expect("the default model has one").ranks;
/// for chunk in &chunks {
///     if let Payload::Source(core) = &chunk.payload {
///         assert_eq!(core.core.len(), ranks.iter().product::<usize>());
///     }
/// }
/// # Ok::<(), welkin::Error>(())
/// ```
pub type Ranks = [usize; 4];

#[derive(Clone, Copy, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
struct BasisCounts {
    altitudes: U32,
    suns: U32,
    degree: U32,
    orders: U32,
    ranks: [U32; 4],
}

#[derive(Clone, Copy, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
struct SourceCounts {
    species: U32,
    suns: U32,
    ranks: [U32; 4],
    scale: F32,
    reserved: U32,
}

/// Bytes of `reserved` in the payload of a source.
pub(super) const RESERVED: Range<usize> =
    offset_of!(SourceCounts, reserved)..offset_of!(SourceCounts, reserved) + size_of::<U32>();

/// Number of harmonics `(l, m)` up to `degree` with m ≤ `orders`.
pub const fn harmonics(degree: usize, orders: usize) -> usize {
    let rest = degree - orders;
    ((degree + 1) * (degree + 2) - rest * (rest + 1)) / 2
}

/// What the sources of all visibilities share.
///
/// ```
/// use welkin::format::{Kind, SourceBasisView, TENSOR, harmonics, parse};
///
/// let file = welkin::DEFAULT_MODEL;
/// let contents = parse(file)?;
/// let mut directory = contents.directory.iter();
/// let entry = directory.find(|e| e.kind == Kind::SourceBasis).expect("the default model has one");
/// let bytes = &file[entry.offset..][..entry.length];
/// let basis = SourceBasisView::new(bytes, contents.head.wavelengths.len())?;
/// let moments = TENSOR + harmonics(basis.degree, basis.orders);
/// assert_eq!(basis.factors[2].len(), moments * basis.ranks[2]);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct SourceBasisView<'a> {
    /// Highest degree of the harmonics.
    pub degree: usize,
    /// Highest azimuthal order.
    pub orders: usize,
    /// Components per mode.
    pub ranks: Ranks,
    /// Altitude nodes, m.
    pub altitude: &'a [F64],
    /// Sun nodes: sines of the sun's elevation.
    pub sun: &'a [F64],
    /// `[nodes or moments or channels][components]` of each mode.
    pub factors: [&'a [F32]; 4],
}

impl<'a> SourceBasisView<'a> {
    /// Views the bytes of a raw chunk of a model with the given number of wavelengths.
    ///
    /// # Errors
    /// [`Error::Invalid`] if they break the specification.
    pub fn new(bytes: &'a [u8], wavelengths: usize) -> Result<Self> {
        let mut rest = bytes;
        let counts = take::<BasisCounts>(&mut rest, 1)?[0];
        let altitudes = within("altitudes", counts.altitudes, 2, MAX_NODES)?;
        let suns = within("suns", counts.suns, 2, MAX_NODES)?;
        let degree = within("degree", counts.degree, 0, MAX_DEGREE)?;
        let orders = within("orders", counts.orders, 0, degree)?;
        let ranks = ranks(&counts.ranks)?;
        // A few bytes of factors must not make a reader allocate gigabytes.
        within_table(altitudes * wavelengths * ranks[2])?;
        let moments = TENSOR + harmonics(degree, orders);
        let rows = [altitudes, suns, moments, SOURCE_FIELDS * wavelengths];
        let factors: usize = rows.iter().zip(ranks).map(|(n, r)| n * r).sum();
        let expected = size_of::<BasisCounts>() + 8 * (altitudes + suns) + 4 * factors;
        check_length("source basis chunk", bytes, expected)?;
        let altitude = take(&mut rest, altitudes)?;
        let sun = take(&mut rest, suns)?;
        let [a, s, m, c] = [0, 1, 2, 3].map(|i| rows[i] * ranks[i]);
        let view = Self {
            degree,
            orders,
            ranks,
            altitude,
            sun,
            factors: [
                take(&mut rest, a)?,
                take(&mut rest, s)?,
                take(&mut rest, m)?,
                take(&mut rest, c)?,
            ],
        };
        increasing("altitude of the source basis", altitude, [0.0, 1e9], 1e-3)?;
        increasing("sun of the source basis", sun, [-1.0, 1.0], 1e-9)?;
        finite(
            "source basis chunk",
            view.factors.iter().flat_map(|f| f.iter()),
        )?;
        Ok(view)
    }
}

/// The source at one visibility.
///
/// ```
/// use welkin::format::{Kind, SourceView, parse};
///
/// let file = welkin::DEFAULT_MODEL;
/// let contents = parse(file)?;
/// let mut directory = contents.directory.iter();
/// let entry = directory.find(|e| e.kind == Kind::Source).expect("the default model has one");
/// let (bytes, head) = (&file[entry.offset..][..entry.length], &contents.head);
/// let source = SourceView::new(bytes, head.constituents, head.wavelengths.len())?;
/// assert_eq!(source.parameter.len(), source.phase.len() * head.wavelengths.len());
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct SourceView<'a> {
    /// Components per mode, as in the basis.
    pub ranks: Ranks,
    /// Sun nodes, as in the basis.
    pub suns: usize,
    /// Largest magnitude in the core.
    pub scale: f32,
    /// Codes of phase functions, `[species]`.
    pub phase: &'a [U32],
    /// Parameters of the phase functions, `[species][wavelengths]`.
    pub parameter: &'a [F32],
    /// Scattering coefficients where the profile of the constituent is 1, m⁻¹, `[species][constituents][wavelengths]`.
    pub scattering: &'a [F32],
    /// Logarithms of the levels, `[fields][suns][wavelengths]`.
    pub level: &'a [F32],
    /// `[altitude][sun][moment][channel]` components.
    pub core: &'a Payload16,
}

impl<'a> SourceView<'a> {
    /// Views the bytes of a raw chunk of a model with these numbers of constituents and wavelengths.
    ///
    /// # Errors
    /// [`Error::Invalid`] if they break the specification.
    pub fn new(bytes: &'a [u8], constituents: usize, wavelengths: usize) -> Result<Self> {
        let mut rest = bytes;
        let counts = take::<SourceCounts>(&mut rest, 1)?[0];
        let species = within("species", counts.species, 1, MAX_SPECIES)?;
        let suns = within("suns", counts.suns, 2, MAX_NODES)?;
        let ranks = ranks(&counts.ranks)?;
        let core: usize = ranks.iter().product();
        let coefficients = species * constituents * wavelengths;
        let levels = SOURCE_FIELDS * suns * wavelengths;
        let singles = species + species * wavelengths + coefficients + levels;
        let expected = size_of::<SourceCounts>() + 4 * singles + 2 * core;
        check_length("source chunk", bytes, expected)?;
        let view = Self {
            ranks,
            suns,
            scale: counts.scale.get(),
            phase: take(&mut rest, species)?,
            parameter: take(&mut rest, species * wavelengths)?,
            scattering: take(&mut rest, coefficients)?,
            level: take(&mut rest, levels)?,
            core: take(&mut rest, core)?,
        };
        view.check(wavelengths)?;
        Ok(view)
    }

    /// Checks what is said about source chunks together: they fit the basis, and have the species of any `other`.
    pub(crate) fn check_with(&self, basis: &SourceBasisView, other: &SourceView) -> Result<()> {
        if self.ranks != basis.ranks || self.suns != basis.sun.len() {
            let detail = "ranks or suns differ from those of the source basis";
            return Err(Error::invalid("source chunk", detail));
        }
        let [own, others] = [self, other].map(|view| view.phase.iter().map(|code| code.get()));
        if !own.eq(others) {
            let detail = "species differ from those of another source chunk";
            return Err(Error::invalid("source chunk", detail));
        }
        Ok(())
    }

    fn check(&self, wavelengths: usize) -> Result<()> {
        let broken = |detail: String| Err(Error::invalid("source chunk", detail));
        finite("source chunk", self.parameter.iter().chain(self.level))?;
        if !self.scale.is_finite() || !half_is_finite(self.core) {
            return broken("holds NaN or infinity".to_owned());
        }
        if let Some(s) = self
            .scattering
            .iter()
            .find(|s| !(0.0..=1e6).contains(&s.get()))
        {
            let got = Number(s.get().into());
            return broken(format!("scattering must lie in 0..=1e6, got {got}"));
        }
        for (code, parameters) in self.phase.iter().zip(self.parameter.chunks(wavelengths)) {
            let range = match phase_function(code.get()) {
                Some(PhaseFunction::Rayleigh) => 0.0..=1.0,
                Some(PhaseFunction::HenyeyGreenstein) => (-1f32).next_up()..=1f32.next_down(),
                _ => return broken(format!("unknown phase function {code}")),
            };
            if let Some(p) = parameters.iter().find(|p| !range.contains(&p.get())) {
                let got = Number(p.get().into());
                return broken(format!("phase parameter {got} is outside {range:?}"));
            }
        }
        Ok(())
    }
}

/// The phase function of a species.
pub(crate) fn phase_function(code: u32) -> Option<PhaseFunction> {
    match code {
        1 => Some(PhaseFunction::Rayleigh),
        2 => Some(PhaseFunction::HenyeyGreenstein),
        _ => None,
    }
}

fn within_table(size: usize) -> Result<()> {
    if size <= MAX_SOURCE_TABLE {
        return Ok(());
    }
    let detail =
        format!("expected altitudes · wavelengths · rm up to {MAX_SOURCE_TABLE}, got {size}");
    Err(Error::invalid("source basis chunk", detail))
}

fn within(what: &'static str, got: U32, min: usize, max: usize) -> Result<usize> {
    let got = got.get() as usize;
    if (min..=max).contains(&got) {
        return Ok(got);
    }
    let detail = format!("expected {min}..={max}, got {got}");
    Err(Error::invalid(what, detail))
}

fn ranks(raw: &[U32; 4]) -> Result<Ranks> {
    let mut out = [0; 4];
    for (out, &raw) in out.iter_mut().zip(raw) {
        *out = within("rank of the source", raw, 1, MAX_COMPONENTS)?;
    }
    within("rank of the source's moments", raw[2], 1, MAX_MOMENTS)?;
    Ok(out)
}

fn increasing(what: &'static str, nodes: &[F64], [min, max]: [f64; 2], gap: f64) -> Result<()> {
    let sound = nodes.iter().all(|n| (min..=max).contains(&n.get()))
        && nodes.windows(2).all(|n| n[1].get() - n[0].get() >= gap);
    if sound {
        return Ok(());
    }
    let detail = format!("nodes must increase strictly within {min}..={max}");
    Err(Error::invalid(what, detail))
}

fn finite<'a>(what: &'static str, values: impl IntoIterator<Item = &'a F32>) -> Result<()> {
    if values.into_iter().all(|v| v.get().is_finite()) {
        return Ok(());
    }
    Err(Error::invalid(what, "holds NaN or infinity"))
}

/// What the sources of all visibilities share, to be written.
///
/// ```
/// use welkin::format::{Payload, SOURCE_FIELDS, unpack};
///
/// let (head, chunks) = unpack(welkin::DEFAULT_MODEL)?;
/// let basis = chunks.iter().find_map(|chunk| match &chunk.payload {
///     Payload::SourceBasis(basis) => Some(basis),
///     _ => None,
/// });
/// let basis = basis.expect("the default model has one");
/// let channels = SOURCE_FIELDS * head.wavelengths.len();
/// assert_eq!(basis.factors[0].len(), basis.altitude.len() * basis.ranks[0]);
/// assert_eq!(basis.factors[3].len(), channels * basis.ranks[3]);
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SourceBasis {
    /// Highest degree of the harmonics.
    pub degree: usize,
    /// Highest azimuthal order.
    pub orders: usize,
    /// Components per mode.
    pub ranks: Ranks,
    /// Altitude nodes, m.
    pub altitude: Vec<f64>,
    /// Sun nodes: sines of the sun's elevation.
    pub sun: Vec<f64>,
    /// `[nodes or moments or channels][components]` of each mode.
    pub factors: [Vec<f32>; 4],
}

/// The source at one visibility, to be written.
///
/// ```
/// use welkin::format::{Payload, unpack};
///
/// let (head, chunks) = unpack(welkin::DEFAULT_MODEL)?;
/// let cores = chunks.iter().filter_map(|chunk| match &chunk.payload {
///     Payload::Source(core) => Some(core),
///     _ => None,
/// });
/// assert_eq!(cores.clone().count(), head.visibilities.len());
/// for core in cores {
///     assert_eq!(core.parameter.len(), core.phase.len() * head.wavelengths.len());
/// }
/// # Ok::<(), welkin::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SourceCore {
    /// Components per mode, as in the basis.
    pub ranks: Ranks,
    /// Phase function of each species: Rayleigh or Henyey-Greenstein.
    pub phase: Vec<PhaseFunction>,
    /// Parameters of the phase functions, `[species][wavelengths]`.
    pub parameter: Vec<f32>,
    /// Scattering coefficients where the profile of the constituent is 1, m⁻¹, `[species][constituents][wavelengths]`.
    pub scattering: Vec<f32>,
    /// Logarithms of the levels, `[fields][suns][wavelengths]`.
    pub level: Vec<f32>,
    /// `[altitude][sun][moment][channel]` components.
    pub core: Vec<f32>,
}

impl From<&SourceBasisView<'_>> for SourceBasis {
    fn from(view: &SourceBasisView) -> Self {
        Self {
            degree: view.degree,
            orders: view.orders,
            ranks: view.ranks,
            altitude: view.altitude.iter().map(|v| v.get()).collect(),
            sun: view.sun.iter().map(|v| v.get()).collect(),
            factors: view.factors.map(narrow),
        }
    }
}

impl From<&SourceView<'_>> for SourceCore {
    fn from(view: &SourceView) -> Self {
        let phase = |code: &U32| phase_function(code.get()).unwrap_or(PhaseFunction::None);
        Self {
            ranks: view.ranks,
            phase: view.phase.iter().map(phase).collect(),
            parameter: narrow(view.parameter),
            scattering: narrow(view.scattering),
            level: narrow(view.level),
            core: view.core.iter().map(|&h| view.scale * widen(h)).collect(),
        }
    }
}

impl SourceBasis {
    /// Leaves out all but the wavelengths with these indices.
    pub(super) fn keep(&mut self, wavelengths: usize, kept: &[usize]) {
        let fields = 0..SOURCE_FIELDS;
        let channels = fields.flat_map(|f| kept.iter().map(move |w| f * wavelengths + w));
        let channels: Vec<usize> = channels.collect();
        self.factors[3] = rows(&self.factors[3], self.ranks[3], &channels);
    }

    pub(super) fn encode(&self, wavelengths: usize) -> Result<Vec<u8>> {
        let count = |n: usize| U32::new(n as u32);
        let counts = BasisCounts {
            altitudes: count(self.altitude.len()),
            suns: count(self.sun.len()),
            degree: count(self.degree),
            orders: count(self.orders),
            ranks: self.ranks.map(count),
        };
        let mut bytes = counts.as_bytes().to_vec();
        for nodes in [&self.altitude, &self.sun] {
            bytes.extend(nodes.iter().flat_map(|v| v.to_le_bytes()));
        }
        bytes.extend(self.factors.iter().flatten().flat_map(|v| v.to_le_bytes()));
        SourceBasisView::new(&bytes, wavelengths)?;
        Ok(bytes)
    }
}

impl SourceCore {
    /// Leaves out all but the wavelengths with these indices.
    pub(super) fn keep(&mut self, wavelengths: usize, kept: &[usize]) {
        for table in [&mut self.parameter, &mut self.scattering, &mut self.level] {
            *table = columns(table, wavelengths, kept);
        }
    }

    pub(super) fn encode(&self, constituents: usize, wavelengths: usize) -> Result<Vec<u8>> {
        check("source core", &self.core, self.ranks.iter().product())?;
        let scale = self
            .core
            .iter()
            .fold(f32::MIN_POSITIVE, |m, v| m.max(v.abs()));
        let suns = self.level.len() / (SOURCE_FIELDS * wavelengths);
        let count = |n: usize| U32::new(n as u32);
        let counts = SourceCounts {
            species: count(self.phase.len()),
            suns: count(suns),
            ranks: self.ranks.map(count),
            scale: F32::new(scale),
            reserved: U32::ZERO,
        };
        let mut bytes = counts.as_bytes().to_vec();
        for phase in &self.phase {
            let code: u32 = match phase {
                PhaseFunction::None => 0,
                PhaseFunction::Rayleigh => 1,
                PhaseFunction::HenyeyGreenstein => 2,
            };
            bytes.extend(code.to_le_bytes());
        }
        for values in [&self.parameter, &self.scattering, &self.level] {
            bytes.extend(values.iter().flat_map(|v| v.to_le_bytes()));
        }
        let halves = self.core.iter().map(|v| f16::from_f32(v / scale));
        bytes.extend(halves.flat_map(|h| U16::new(h.to_bits()).to_bytes()));
        SourceView::new(&bytes, constituents, wavelengths)?;
        Ok(bytes)
    }
}
