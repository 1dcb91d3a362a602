//! Most nodes of a segment.

/// Most panels of a segment; even.
pub(crate) const MOST_PANELS: usize = 12;

/// Most stations of the diffuse source.
pub(crate) const MOST_SOURCE_NODES: usize = 3;
/// Most places of a segment: ends of panels, and stations.
pub(crate) const MOST_PATH_POINTS: usize = MOST_PANELS + 1 + MOST_SOURCE_NODES;
