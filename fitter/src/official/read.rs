//! Opens a file of the official model: everything before the factors is read and checked, the factors when they are
//! asked for.
//!
//! The layout has neither magic nor checksums, so that every count is checked before anything is allocated for it, and
//! every section against the length of the file before it is used.

use super::cursor::Cursor;
use super::error::{OfficialError, Result, Section};
use super::layout::{
    Axes, Channels, Header, MOST_BREAKS, MOST_CHANNELS, MOST_NODES, MOST_RANK, Node,
    PolarisationBreaks, RadianceBreaks,
};
use super::selection::Selection;
use super::tables::{PolarisationTables, RadianceTables};
use super::transmittance::{Shape, Transmittance};
use std::fs::File;
use std::path::Path;
use welkin::ReadAt;

/// What a file lacks or has too much of, though what is whole can be used.
#[derive(Clone, Debug, PartialEq)]
pub enum Note {
    /// It ends before this section.
    Absent(Section),
    /// It ends within this section.
    Truncated {
        /// The section.
        section: Section,
        /// Bytes of the section.
        needed: u64,
        /// Bytes of them that the file has.
        present: u64,
    },
    /// Bytes follow the last section.
    Trailing(u64),
}

impl std::fmt::Display for Note {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Self::Absent(section) => write!(f, "no {section} section"),
            Self::Truncated {
                section,
                needed,
                present,
            } => write!(
                f,
                "the {section} section is truncated: {present} of {needed} bytes"
            ),
            Self::Trailing(bytes) => write!(f, "{bytes} bytes follow the last section"),
        }
    }
}

/// An open file of the official model.
pub struct OfficialData {
    source: Box<dyn ReadAt>,
    length: u64,
    /// Of the file.
    whole: Header,
    selection: Selection,
    /// Of what is selected.
    header: Header,
    radiance: u64,
    transmittance: Option<(Shape, u64)>,
    polarisation: Option<(PolarisationBreaks, u64)>,
    notes: Vec<Note>,
}

impl OfficialData {
    /// Opens a file.
    ///
    /// # Errors
    /// [`OfficialError`] if it cannot be read, or if its header and radiance are not whole and sound.
    pub fn open(path: impl AsRef<Path>) -> Result<Self> {
        let read = |source| OfficialError::Read { offset: 0, source };
        let file = File::open(path).map_err(read)?;
        let length = file.metadata().map_err(read)?.len();
        Self::new(file, length)
    }

    /// Opens the bytes of a file.
    ///
    /// # Errors
    /// As [`OfficialData::open`].
    pub fn from_bytes(bytes: Vec<u8>) -> Result<Self> {
        let length = bytes.len() as u64;
        Self::new(bytes, length)
    }

    fn new(source: impl ReadAt + 'static, length: u64) -> Result<Self> {
        let mut cursor = Cursor::new(&source, length);
        let header = header(&mut cursor)?;
        cursor.section = Section::Radiance;
        let radiance = cursor.offset;
        cursor.skip(size(header.configurations(), header.breaks.bytes()))?;
        let mut notes = vec![];
        let transmittance = optional(&mut cursor, &mut notes, Section::Transmittance, |c| {
            let shape = transmittance_shape(c)?;
            let bytes = shape.bytes(header.channels.count);
            Ok((shape, bytes))
        })?;
        let polarisation = match transmittance {
            None => None,
            Some(_) => optional(&mut cursor, &mut notes, Section::Polarisation, |c| {
                let breaks = polarisation_breaks(c)?;
                let bytes = size(header.configurations(), breaks.bytes());
                Ok((breaks, bytes))
            })?,
        };
        if polarisation.is_some() && cursor.rest() > 0 {
            notes.push(Note::Trailing(cursor.rest()));
        }
        Ok(Self {
            source: Box::new(source),
            length,
            selection: Selection::all(&header),
            whole: header.clone(),
            header,
            radiance,
            transmittance,
            polarisation,
            notes,
        })
    }

    /// The same file, of which only a part is looked at.
    ///
    /// # Errors
    /// [`OfficialError::Value`] if the file does not have that part.
    pub fn select(mut self, selection: Selection) -> Result<Self> {
        self.header = selection.of(&self.whole)?;
        self.selection = selection;
        Ok(self)
    }

    /// What is looked at.
    pub fn selection(&self) -> &Selection {
        &self.selection
    }

    /// Axes, channels and breaks of what is selected.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// What the file lacks or has too much of.
    pub fn notes(&self) -> &[Note] {
        &self.notes
    }

    /// Bytes of the file.
    pub fn bytes(&self) -> u64 {
        self.length
    }

    /// Breaks of the polarisation, if the file has all of it.
    pub fn polarisation(&self) -> Option<&PolarisationBreaks> {
        self.polarisation.as_ref().map(|(breaks, _)| breaks)
    }

    /// Lengths of the transmittance, if the file has all of it.
    pub fn transmittance_shape(&self) -> Option<Shape> {
        self.transmittance.as_ref().map(|(shape, _)| *shape)
    }

    /// Reads the radiance of a sky in a channel.
    ///
    /// # Errors
    /// [`OfficialError::Read`]; [`OfficialError::Value`] if it is not finite.
    pub fn radiance_tables(&self, node: Node, channel: usize) -> Result<RadianceTables> {
        let breaks = &self.header.breaks;
        let mut cursor = self.at(Section::Radiance, self.radiance);
        cursor.skip(self.selection.place(&self.whole, node, channel) * breaks.bytes())?;
        RadianceTables::decode(breaks, &cursor.bytes(breaks.bytes())?)
    }

    /// Reads the polarisation of a sky in a channel.
    ///
    /// # Errors
    /// As [`OfficialData::radiance_tables`]; [`OfficialError::Missing`] if the file has none.
    pub fn polarisation_tables(&self, node: Node, channel: usize) -> Result<PolarisationTables> {
        let Some((breaks, start)) = &self.polarisation else {
            return Err(OfficialError::Missing(Section::Polarisation));
        };
        let mut cursor = self.at(Section::Polarisation, *start);
        cursor.skip(self.selection.place(&self.whole, node, channel) * breaks.bytes())?;
        let values = cursor.f32s((breaks.bytes() / 4) as usize)?;
        PolarisationTables::decode(breaks, &values)
    }

    /// Reads the whole transmittance (37 MB in the published data) in the selected channels.
    ///
    /// # Errors
    /// As [`OfficialData::polarisation_tables`].
    pub fn transmittance(&self) -> Result<Transmittance> {
        let Some((shape, start)) = &self.transmittance else {
            return Err(OfficialError::Missing(Section::Transmittance));
        };
        let mut cursor = self.at(Section::Transmittance, *start);
        let channels = self.whole.channels;
        let altitudes = cursor.f32s(shape.altitudes)?;
        let visibilities = cursor.f32s(shape.visibilities)?;
        let paths = cursor.f32s(shape.paths())?;
        let airs = cursor.f32s(shape.airs(channels.count))?;
        let whole = Transmittance::new(*shape, channels, [altitudes, visibilities], [paths, airs])?;
        Ok(whole.only(self.selection.channels.clone()))
    }

    fn at(&self, section: Section, offset: u64) -> Cursor<'_> {
        let mut cursor = Cursor::new(self.source.as_ref(), self.length);
        cursor.section = section;
        cursor.offset = offset;
        cursor
    }
}

/// Without overflow: what does not fit is longer than any file.
fn size(count: u64, bytes: u64) -> u64 {
    count.saturating_mul(bytes)
}

/// Reads the counts of a section that a file may lack and goes over the rest of it; where it is not whole, a note says
/// so.
fn optional<T>(
    cursor: &mut Cursor,
    notes: &mut Vec<Note>,
    section: Section,
    counts: impl FnOnce(&mut Cursor) -> Result<(T, u64)>,
) -> Result<Option<(T, u64)>> {
    let (start, rest) = (cursor.offset, cursor.rest());
    cursor.section = section;
    if rest == 0 {
        notes.push(Note::Absent(section));
        return Ok(None);
    }
    let whole = counts(cursor).and_then(|(counts, bytes)| {
        let begin = cursor.offset;
        cursor.skip(bytes).map(|()| (counts, begin))
    });
    match whole {
        Ok(found) => Ok(Some(found)),
        Err(OfficialError::Truncated { needed, .. }) => {
            notes.push(Note::Truncated {
                section,
                needed: needed - start,
                present: rest,
            });
            Ok(None)
        }
        Err(error) => Err(error),
    }
}

fn header(cursor: &mut Cursor) -> Result<Header> {
    let header = Header {
        axes: Axes {
            visibilities: numbers(cursor, "visibilities", MOST_NODES)?,
            albedos: numbers(cursor, "albedos", MOST_NODES)?,
            altitudes: numbers(cursor, "altitudes", MOST_NODES)?,
            elevations: numbers(cursor, "solar elevations", MOST_NODES)?,
        },
        channels: Channels {
            count: cursor.count("number of channels", MOST_CHANNELS)?,
            start: cursor.f64()?,
            width: cursor.f64()?,
        },
        breaks: RadianceBreaks {
            rank: cursor.count("rank", MOST_RANK)?,
            sun: numbers(cursor, "breaks of the angle to the sun", MOST_BREAKS)?,
            zenith: numbers(cursor, "breaks of the zenith angle", MOST_BREAKS)?,
            emphasis: numbers(cursor, "breaks of the emphasis", MOST_BREAKS)?,
        },
    };
    header.check()?;
    Ok(header)
}

/// A count and as many numbers.
fn numbers(cursor: &mut Cursor, what: &'static str, most: usize) -> Result<Vec<f64>> {
    let count = cursor.count(what, most)?;
    cursor.f64s(count)
}

fn transmittance_shape(cursor: &mut Cursor) -> Result<Shape> {
    Ok(Shape {
        arcs: cursor.count("nodes of the arc", MOST_BREAKS)?,
        heights: cursor.count("nodes of the altitude", MOST_BREAKS)?,
        visibilities: cursor.count("visibilities", MOST_NODES)?,
        altitudes: cursor.count("altitudes", MOST_NODES)?,
        rank: cursor.count("rank", MOST_RANK)?,
    })
}

fn polarisation_breaks(cursor: &mut Cursor) -> Result<PolarisationBreaks> {
    let breaks = PolarisationBreaks {
        rank: cursor.count("rank", MOST_RANK)?,
        sun: numbers(cursor, "breaks of the angle to the sun", MOST_BREAKS)?,
        zenith: numbers(cursor, "breaks of the zenith angle", MOST_BREAKS)?,
    };
    breaks.check()?;
    Ok(breaks)
}
