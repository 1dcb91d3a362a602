//! Writes files that the official code reads.

use super::error::{OfficialError, Result, Section};
use super::layout::{Header, PolarisationBreaks};
use super::tables::{PolarisationTables, RadianceTables};
use super::transmittance::Transmittance;
use std::io::Write;

/// Writes a file section by section: the radiance of every sky and channel in their order, the transmittance, and the
/// polarisation of every sky and channel, if there is one.
pub struct Writer<W: Write> {
    out: W,
    written: u64,
    header: Header,
    tables: u64,
    section: Section,
    polarisation: Option<PolarisationBreaks>,
}

impl<W: Write> Writer<W> {
    /// Writes the header.
    ///
    /// # Errors
    /// [`OfficialError::Value`] for a header that nobody would read, [`OfficialError::Write`].
    pub fn new(out: W, header: Header) -> Result<Self> {
        header.check()?;
        let mut writer = Self {
            out,
            written: 0,
            header,
            tables: 0,
            section: Section::Radiance,
            polarisation: None,
        };
        let Header {
            axes,
            channels,
            breaks,
        } = writer.header.clone();
        writer.numbers(&axes.visibilities)?;
        writer.numbers(&axes.albedos)?;
        writer.numbers(&axes.altitudes)?;
        writer.numbers(&axes.elevations)?;
        writer.count(channels.count)?;
        writer.bytes(&channels.start.to_le_bytes())?;
        writer.bytes(&channels.width.to_le_bytes())?;
        writer.count(breaks.rank)?;
        writer.numbers(&breaks.sun)?;
        writer.numbers(&breaks.zenith)?;
        writer.numbers(&breaks.emphasis)?;
        Ok(writer)
    }

    /// Writes the radiance of the next sky and channel.
    ///
    /// # Errors
    /// [`OfficialError::Value`] for tables of other lengths, that are not finite or do not fit into half precision;
    /// [`OfficialError::Order`] if there are enough already; [`OfficialError::Write`].
    pub fn radiance(&mut self, tables: &RadianceTables) -> Result<()> {
        self.expect(
            Section::Radiance,
            self.tables < self.header.configurations(),
        )?;
        let bytes = tables.encode(&self.header.breaks)?;
        self.tables += 1;
        self.bytes(&bytes)
    }

    /// Writes the transmittance.
    ///
    /// # Errors
    /// [`OfficialError::Value`] if it has other channels; [`OfficialError::Order`] before the last radiance or after a
    /// transmittance; [`OfficialError::Write`].
    pub fn transmittance(&mut self, table: &Transmittance) -> Result<()> {
        self.expect(
            Section::Radiance,
            self.tables == self.header.configurations(),
        )?;
        if table.channels() != self.header.channels {
            return Err(OfficialError::value(
                Section::Transmittance,
                "channels",
                "other ones than those of the radiance",
            ));
        }
        self.section = Section::Transmittance;
        let shape = table.shape();
        for count in [
            shape.arcs,
            shape.heights,
            shape.visibilities,
            shape.altitudes,
            shape.rank,
        ] {
            self.count(count)?;
        }
        for nodes in [table.altitudes(), table.visibilities()] {
            let nodes: Vec<f32> = nodes.iter().map(|n| *n as f32).collect();
            self.singles(&nodes)?;
        }
        for factors in table.factors() {
            self.singles(factors)?;
        }
        Ok(())
    }

    /// Begins the polarisation.
    ///
    /// # Errors
    /// [`OfficialError::Value`] for breaks that nobody would read; [`OfficialError::Order`] before the transmittance;
    /// [`OfficialError::Write`].
    pub fn polarisation(&mut self, breaks: &PolarisationBreaks) -> Result<()> {
        self.expect(Section::Transmittance, true)?;
        breaks.check()?;
        self.section = Section::Polarisation;
        self.tables = 0;
        self.count(breaks.rank)?;
        self.numbers(&breaks.sun)?;
        self.numbers(&breaks.zenith)?;
        self.polarisation = Some(breaks.clone());
        Ok(())
    }

    /// Writes the polarisation of the next sky and channel.
    ///
    /// # Errors
    /// As [`Writer::radiance`].
    pub fn polarisation_tables(&mut self, tables: &PolarisationTables) -> Result<()> {
        self.expect(
            Section::Polarisation,
            self.tables < self.header.configurations(),
        )?;
        let Some(breaks) = &self.polarisation else {
            return Err(OfficialError::Order(Section::Polarisation));
        };
        let bytes = tables.encode(breaks)?;
        self.tables += 1;
        self.bytes(&bytes)
    }

    /// Gives back what was written to, and how many bytes went there.
    ///
    /// # Errors
    /// [`OfficialError::Order`] if skies or the transmittance are missing; [`OfficialError::Write`].
    pub fn finish(mut self) -> Result<(W, u64)> {
        let whole = match self.section {
            Section::Polarisation => self.tables == self.header.configurations(),
            section => section == Section::Transmittance,
        };
        if !whole {
            return Err(OfficialError::Order(self.section));
        }
        self.out.flush().map_err(OfficialError::Write)?;
        Ok((self.out, self.written))
    }

    fn expect(&self, section: Section, ready: bool) -> Result<()> {
        match self.section == section && ready {
            true => Ok(()),
            false => Err(OfficialError::Order(section)),
        }
    }

    fn numbers(&mut self, numbers: &[f64]) -> Result<()> {
        self.count(numbers.len())?;
        let bytes: Vec<u8> = numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
        self.bytes(&bytes)
    }

    fn singles(&mut self, numbers: &[f32]) -> Result<()> {
        for part in numbers.chunks(1 << 16) {
            let bytes: Vec<u8> = part.iter().flat_map(|n| n.to_le_bytes()).collect();
            self.bytes(&bytes)?;
        }
        Ok(())
    }

    /// The counts were checked, so they fit.
    fn count(&mut self, count: usize) -> Result<()> {
        self.bytes(&(count as i32).to_le_bytes())
    }

    fn bytes(&mut self, bytes: &[u8]) -> Result<()> {
        self.written += bytes.len() as u64;
        self.out.write_all(bytes).map_err(OfficialError::Write)
    }
}
