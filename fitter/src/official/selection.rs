//! A part of a file as if it were all there is: some of its channels and solar elevations.

use super::error::{OfficialError, Result, Section};
use super::layout::{Header, Node};
use std::ops::Range;

/// Which channels and solar elevations of a file are looked at.
#[derive(Clone, Debug, PartialEq)]
pub struct Selection {
    /// Channels, one after the other.
    pub channels: Range<usize>,
    /// Indices of solar elevations, increasing.
    pub elevations: Vec<usize>,
}

impl Selection {
    /// Everything.
    pub fn all(header: &Header) -> Self {
        Self {
            channels: 0..header.channels.count,
            elevations: (0..header.axes.elevations.len()).collect(),
        }
    }

    /// Those of the channels whose centres are within a range, nm.
    #[must_use]
    pub fn within(mut self, header: &Header, [low, high]: [f64; 2]) -> Self {
        let centre = |c: &usize| header.channels.centre(*c);
        let first = self.channels.clone().find(|c| centre(c) >= low);
        let last = self.channels.clone().rfind(|c| centre(c) <= high);
        self.channels = match (first, last) {
            (Some(first), Some(last)) if first <= last => first..last + 1,
            _ => 0..0,
        };
        self
    }

    /// Every second elevation, with the first and the last.
    #[must_use]
    pub fn every_second_elevation(mut self) -> Self {
        let last = self.elevations.len().saturating_sub(1);
        let mut position = 0..;
        self.elevations
            .retain(|_| position.next().is_some_and(|i| i % 2 == 0 || i == last));
        self
    }

    /// What of the header is left.
    pub(super) fn of(&self, header: &Header) -> Result<Header> {
        let outside = |what, got: String| Err(OfficialError::value(Section::Header, what, got));
        let Range { start, end } = self.channels;
        if start >= end || end > header.channels.count {
            return outside(
                "the selection of channels",
                format!("got {start}..{end} of {}", header.channels.count),
            );
        }
        let known = header.axes.elevations.len();
        let increasing = self.elevations.windows(2).all(|pair| pair[0] < pair[1]);
        if !increasing || self.elevations.last().is_none_or(|last| *last >= known) {
            return outside(
                "the selection of solar elevations",
                format!("got {:?} of {known}", self.elevations),
            );
        }
        let mut part = header.clone();
        part.channels.start += start as f64 * part.channels.width;
        part.channels.count = end - start;
        let elevations = self.elevations.iter();
        part.axes.elevations = elevations.map(|i| header.axes.elevations[*i]).collect();
        Ok(part)
    }

    /// Where the whole file has what the part calls by these indices.
    pub(super) fn place(&self, whole: &Header, node: Node, channel: usize) -> u64 {
        let elevation = self.elevations[node.elevation];
        whole.index(Node { elevation, ..node }, self.channels.start + channel)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::official::layout::{Axes, Channels, RadianceBreaks};

    fn header() -> Header {
        Header {
            axes: Axes {
                visibilities: vec![20.0, 59.4],
                albedos: vec![0.5],
                altitudes: vec![0.0],
                elevations: vec![-4.0, -1.0, 3.0, 10.0, 25.0, 60.0],
            },
            channels: Channels {
                count: 11,
                start: 320.0,
                width: 40.0,
            },
            breaks: RadianceBreaks {
                rank: 1,
                sun: vec![0.0, 3.0],
                zenith: vec![0.0, 3.0],
                emphasis: vec![0.0, 3.0],
            },
        }
    }

    #[test]
    fn channels_go_by_their_centres() {
        let header = header();
        let part = |range| Selection::all(&header).within(&header, range).of(&header);
        let channels = part([380.0, 760.0]).unwrap().channels;
        assert_eq!((channels.count, channels.start), (10, 360.0));
        assert_eq!(channels.centre(0), 380.0);
        assert!(part([381.0, 399.0]).is_err() && part([900.0, 1e3]).is_err());
    }

    #[test]
    fn ends_stay_among_every_second_elevation() {
        let header = header();
        let count = header.axes.elevations.len();
        let part = Selection::all(&header).every_second_elevation();
        assert_eq!(part.elevations[..2], [0, 2]);
        assert_eq!(part.elevations.last(), Some(&(count - 1)));
        let elevations = part.of(&header).unwrap().axes.elevations;
        assert_eq!(elevations[1], header.axes.elevations[2]);
        let node = Node {
            visibility: 1,
            albedo: 0,
            altitude: 0,
            elevation: 1,
        };
        let same = Node {
            elevation: 2,
            ..node
        };
        assert_eq!(part.place(&header, node, 3), header.index(same, 3));
    }

    #[test]
    fn what_a_file_does_not_have_is_refused() {
        let header = header();
        let all = || Selection::all(&header);
        for wrong in [
            Selection {
                channels: 3..12,
                ..all()
            },
            Selection {
                elevations: vec![],
                ..all()
            },
            Selection {
                elevations: vec![2, 1],
                ..all()
            },
            Selection {
                elevations: vec![99],
                ..all()
            },
        ] {
            assert!(wrong.of(&header).is_err(), "{wrong:?}");
        }
    }
}
