//! Most nodes of a segment.

/// Most panels of a segment; even.
pub(crate) const MOST_PANELS: usize = 12;

/// Most stations of the diffuse source.
pub(crate) const MOST_STATIONS: usize = 3;
/// Most places of a segment: ends of panels, and stations.
pub(crate) const MOST_PLACES: usize = MOST_PANELS + 1 + MOST_STATIONS;
