//! The rules that the values of a head obey, for reader and writer alike. Format specification, sections 3, 4 and 8.

use core::f64::consts::FRAC_PI_2;

use super::estimate_view::MAX_ESTIMATES;
use super::head::{Field, Head, PhaseFunction};
use super::layout::MAX_TABLE;
use crate::error::{Error, Number, Range, Result};

impl Head {
    /// Checks every value and length against the format specification.
    ///
    /// # Errors
    /// [`Error::Invalid`] or [`Error::Length`] for the first rule that is broken.
    pub fn validate(&self) -> Result<()> {
        self.check_counts()?;
        self.check_lengths()?;
        self.check_scalars()?;
        self.check_axes()?;
        self.check_tables()?;
        self.fields
            .iter()
            .try_for_each(|field| check_field(field, self.estimated))
    }

    fn check_counts(&self) -> Result<()> {
        count("wavelengths", self.wavelengths.len(), 2, 256)?;
        count("altitudes", self.altitudes.len(), 1, 1024)?;
        count("visibilities", self.visibilities.len(), 1, 1024)?;
        count("fields", self.fields.len(), 1, 16)?;
        count("constituents", self.constituents, 1, 16)?;
        self.check_absorbers()?;
        count("alpha_up_intervals", self.up.intervals, 1, 1024)?;
        count("alpha_down_intervals", self.down.intervals, 1, 1024)?;
        count("phi_intervals", self.phi_intervals, 1, 1024)?;
        count("elevation_intervals", self.elevation.intervals, 1, 1024)?;
        count("solar_samples", self.solar_irradiance.len(), 2, 16384)?;
        count("metadata_length", self.metadata.len(), 0, u32::MAX as usize)?;
        // A few bytes of factors must not make a reader allocate gigabytes.
        let shape = self.shape();
        let table = [shape.up + shape.down, shape.phi, shape.channels];
        // Saturating, for machines of 32 bits.
        let table = table.iter().fold(1, |n: usize, m| n.saturating_mul(*m));
        count("table of a sky", table, 1, MAX_TABLE)
    }

    /// Each is a constituent, and something is left that scatters.
    fn check_absorbers(&self) -> Result<()> {
        let last = (1u32 << self.constituents) - 1;
        if u32::from(self.absorbers) < last {
            return Ok(());
        }
        let got = self.absorbers;
        let detail = format!(
            "must leave one of {} constituents, got {got:#b}",
            self.constituents
        );
        Err(Error::invalid("absorbers", detail))
    }

    fn check_lengths(&self) -> Result<()> {
        let (nw, nv) = (self.wavelengths.len(), self.visibilities.len());
        length(
            "extinction",
            self.extinction.len(),
            nv * self.constituents * nw,
        )?;
        length("spherical_albedo", self.spherical_albedo.len(), nv * nw)?;
        length("xyz", self.xyz.len(), nw)?;
        self.fields
            .iter()
            .try_for_each(|f| length("phase_parameter", f.parameter.len(), nw))
    }

    fn check_scalars(&self) -> Result<()> {
        let last = self.altitudes[self.altitudes.len() - 1];
        scalar("planet_radius", self.planet.radius, 1e3, 1e9, "m")?;
        scalar("top_altitude", self.planet.top, last.next_up(), 1e9, "m")?;
        scalar("alpha_up_exponent", self.up.exponent, 1.0, 8.0, "")?;
        scalar("alpha_down_exponent", self.down.exponent, 1.0, 8.0, "")?;
        let e = &self.elevation;
        scalar("elevation_min", e.min, -FRAC_PI_2, FRAC_PI_2, "rad")?;
        scalar("elevation_max", e.max, e.min.next_up(), FRAC_PI_2, "rad")?;
        scalar("elevation_centre", e.centre, -FRAC_PI_2, FRAC_PI_2, "rad")?;
        scalar("elevation_width", e.width, 1e-6, 1e6, "rad")?;
        scalar("solar_step", self.solar_step, 1e-3, 1e6, "nm")?;
        let first = self.wavelengths[0];
        scalar("solar_start", self.solar_start, 0.0, first, "nm")?;
        let [_, end] = self.solar_range();
        let last = self.wavelengths[self.wavelengths.len() - 1];
        scalar("end of the solar spectrum", end, last, f64::MAX, "nm")
    }

    fn check_axes(&self) -> Result<()> {
        increasing("wavelength", &self.wavelengths, [1.0, 1e6], "nm")?;
        increasing("altitude", &self.altitudes, [0.0, 1e9], "m")?;
        increasing("visibility", &self.visibilities, [1.0, 1e9], "m")?;
        increasing(
            "cube root of altitude",
            &self.altitude_nodes(),
            [0.0, 1e3],
            "",
        )?;
        let mut inverse = self.visibility_nodes();
        inverse.reverse();
        increasing("inverse of visibility", &inverse, [0.0, 1.0], "")
    }

    fn check_tables(&self) -> Result<()> {
        let f64s = |what, values: &[f64], min, max| {
            values
                .iter()
                .try_for_each(|&v| scalar(what, v, min, max, ""))
        };
        let f32s = |what, values: &[f32], min: f64| {
            let max = f64::from(f32::MAX);
            values
                .iter()
                .try_for_each(|&v| scalar(what, f64::from(v), min, max, ""))
        };
        f64s("extinction", &self.extinction, 0.0, 1e6)?;
        let below_one = 1f64.next_down();
        f64s("spherical_albedo", &self.spherical_albedo, 0.0, below_one)?;
        f64s("xyz", self.xyz.as_flattened(), -1e30, 1e30)?;
        f32s("solar_irradiance", &self.solar_irradiance, 0.0)
    }
}

fn check_field(field: &Field, estimated: bool) -> Result<()> {
    let most = if estimated { MAX_ESTIMATES - 1 } else { 0 };
    count("estimate of a field", field.estimate, 0, most)?;
    let (min, max) = match field.phase {
        PhaseFunction::None => (f64::MIN, f64::MAX),
        PhaseFunction::Rayleigh => (0.0, 1.0),
        PhaseFunction::HenyeyGreenstein => ((-1f64).next_up(), 1f64.next_down()),
    };
    field
        .parameter
        .iter()
        .try_for_each(|&p| scalar("phase_parameter", p, min, max, ""))
}

fn count(what: &'static str, got: usize, min: usize, max: usize) -> Result<()> {
    if (min..=max).contains(&got) {
        return Ok(());
    }
    Err(Error::invalid(
        what,
        format!("expected {min}..={max}, got {got}"),
    ))
}

fn length(what: &'static str, got: usize, expected: usize) -> Result<()> {
    if got == expected {
        return Ok(());
    }
    Err(Error::Length {
        what,
        expected: expected as u64,
        got: got as u64,
    })
}

fn scalar(what: &'static str, got: f64, min: f64, max: f64, unit: &str) -> Result<()> {
    if got.is_finite() && got >= min && got <= max {
        return Ok(());
    }
    let range = Range { min, max, unit };
    Err(Error::invalid(
        what,
        format!("must be {range}, got {}", Number(got)),
    ))
}

fn increasing(what: &'static str, nodes: &[f64], [min, max]: [f64; 2], unit: &str) -> Result<()> {
    nodes
        .iter()
        .try_for_each(|&v| scalar(what, v, min, max, unit))?;
    match nodes.windows(2).find(|w| w[0] >= w[1]) {
        None => Ok(()),
        Some(w) => Err(Error::invalid(
            what,
            format!(
                "must increase strictly, got {} before {}",
                Number(w[0]),
                Number(w[1])
            ),
        )),
    }
}
