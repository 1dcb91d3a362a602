//! Where a model is used: what lies beyond costs nothing.

use crate::dataset::Grid;
use anyhow::{Result, ensure};
use welkin::axis::ElevationAxis;

/// Conditions that a scene needs.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Lowest and highest observer, m.
    pub altitudes: [f64; 2],
    /// Lowest and highest sun, rad.
    pub elevations: [f64; 2],
    /// Wavelengths.
    pub bands: Bands,
}

/// Wavelengths that a model keeps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Bands {
    /// All.
    #[default]
    All,
    /// Those that colours are made of.
    Rgb,
}

/// The default model's, m and degrees.
const ALTITUDES: [f64; 2] = [0.0, 99_000.0];
const ELEVATIONS: [f64; 2] = [-12.0, 90.0];
/// Nodes nearer to an end than this, in cube roots of a metre, are as good as the end.
const NEAR: f64 = 0.5;
/// Fewest intervals of the solar elevation.
const FEWEST: usize = 8;

impl Default for Scene {
    fn default() -> Self {
        Self {
            altitudes: ALTITUDES,
            elevations: ELEVATIONS.map(f64::to_radians),
            bands: Bands::All,
        }
    }
}

impl Scene {
    /// Leaves of `grid` what the scene needs, as finely.
    pub fn narrow(&self, grid: &mut Grid) -> Result<()> {
        let [low, high] = self.altitudes;
        let [lowest, highest] = ALTITUDES;
        in_order("altitudes", [low, high])?;
        ensure!(
            (lowest..=highest).contains(&low) && low <= high && high <= highest,
            "altitudes must be a range in {lowest}..{highest} m, got {low}..{high}"
        );
        let between = grid.altitudes.iter().copied();
        // Nodes beside the ends would only repeat them.
        let apart = |h: &f64| h.cbrt() > low.cbrt() + NEAR && h.cbrt() < high.cbrt() - NEAR;
        let inner: Vec<f64> = between.filter(apart).collect();
        let mut altitudes = [vec![low], inner, vec![high]].concat();
        altitudes.dedup();
        grid.altitudes = altitudes;
        self.narrow_suns(&mut grid.elevation)
    }

    fn narrow_suns(&self, axis: &mut ElevationAxis) -> Result<()> {
        let [low, high] = self.elevations;
        in_order("solar elevations", [low, high].map(f64::to_degrees))?;
        let excess = 1e-9;
        ensure!(
            axis.min - excess <= low && low < high && high <= axis.max + excess,
            "solar elevations must be a range in {:.0}..{:.0}°, got {}..{}",
            axis.min.to_degrees(),
            axis.max.to_degrees(),
            rounded(low.to_degrees()),
            rounded(high.to_degrees())
        );
        let kept = axis.coordinate(high) - axis.coordinate(low);
        axis.intervals = (kept.ceil() as usize).clamp(FEWEST, axis.intervals.max(FEWEST));
        axis.min = low.max(axis.min);
        axis.max = high.min(axis.max);
        Ok(())
    }
}

/// The lower end comes first.
fn in_order(what: &str, [low, high]: [f64; 2]) -> Result<()> {
    let [first, last] = [low, high].map(rounded);
    let is_reversed = low > high;
    ensure!(
        !is_reversed,
        "{what} {first}..{last} are in the wrong order: the lower end comes first, {last}..{first}"
    );
    Ok(())
}

/// Without the digits that the conversion of units makes up.
fn rounded(value: f64) -> f64 {
    let round = (value * 1e9).round() / 1e9;
    if round.is_finite() { round } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_is_the_whole_grid() {
        let mut grid = Grid::default();
        Scene::default().narrow(&mut grid).unwrap();
        assert_eq!(grid, Grid::default());
    }

    #[test]
    fn a_scene_has_the_nodes_within_and_its_ends() {
        let mut grid = Grid::default();
        let scene = Scene {
            altitudes: [100.0, 2600.0],
            elevations: [-6.0, 40.0].map(f64::to_radians),
            bands: Bands::All,
        };
        scene.narrow(&mut grid).unwrap();
        assert_eq!(
            grid.altitudes,
            [100.0, 645.0, 1150.0, 1650.0, 2100.0, 2600.0]
        );
        let whole = Grid::default().elevation;
        let dense = |axis: &ElevationAxis| axis.coordinate(0.05) - axis.coordinate(0.04);
        assert!((dense(&grid.elevation) / dense(&whole) - 1.0).abs() < 0.05);
        assert_eq!(grid.elevation_range(), scene.elevations);
    }

    #[test]
    fn one_altitude_is_one_node() {
        let mut grid = Grid::default();
        let scene = Scene {
            altitudes: [0.0, 0.0],
            ..Scene::default()
        };
        scene.narrow(&mut grid).unwrap();
        assert_eq!(grid.altitudes, [0.0]);
    }

    #[test]
    fn what_no_model_reaches_is_refused() {
        let refused = |altitudes, elevations: [f64; 2]| {
            let elevations = elevations.map(f64::to_radians);
            let scene = Scene {
                altitudes,
                elevations,
                bands: Bands::All,
            };
            scene.narrow(&mut Grid::default()).unwrap_err().to_string()
        };
        assert!(refused([0.0, 2e5], ELEVATIONS).contains("altitudes"));
        assert!(refused([f64::NAN, 2e3], ELEVATIONS).contains("altitudes"));
        assert!(
            refused([2e3, 1e3], ELEVATIONS).contains("altitudes 2000..1000 are in the wrong order")
        );
        assert!(
            refused(ALTITUDES, [40.0, -6.0]).contains("elevations 40..-6 are in the wrong order")
        );
        assert!(refused(ALTITUDES, [-20.0, 10.0]).contains("solar elevations"));
        assert!(refused(ALTITUDES, [10.0, 10.0]).contains("solar elevations"));
    }
}
