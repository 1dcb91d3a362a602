//! Where a layer is: its profile over the altitude.

use super::columns::Functions;
use super::error::{RecipeError, field};
use super::file::Layer;
use crate::atmosphere::table::Curve;

/// Top of the atmosphere, m.
const TOP: f64 = 100_000.0;
/// Widths of the logistic edges of a layer where none are given, m: those of the model's own air at its inversion and
/// at the tropopause, with the altitude between them.
const EDGES: [f64; 2] = [150.0, 500.0];
const HIGH: f64 = 10_000.0;

/// A smooth end of a layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// Where half is left, m.
    pub altitude: f64,
    /// Width of the logistic function, m.
    pub width: f64,
}

impl Edge {
    fn new(altitude: f64, width: Option<f64>) -> Self {
        let usual = if altitude < HIGH { EDGES[0] } else { EDGES[1] };
        Self {
            altitude,
            width: width.map_or(usual, |km| km * 1000.0),
        }
    }

    /// How much of what is above it is there, 0..1.
    fn above(self, altitude: f64) -> f64 {
        1.0 / (1.0 + (-(altitude - self.altitude) / self.width).exp())
    }
}

/// Profile of a layer, without unit.
#[derive(Clone, Debug)]
pub struct Shape {
    /// Its lower end, unless that is the ground.
    pub bottom: Option<Edge>,
    /// Its upper end, unless that is the top of the atmosphere.
    pub top: Option<Edge>,
    within: Within,
}

#[derive(Clone, Debug)]
enum Within {
    /// Falls to 1/e along this, m.
    Exponential(f64),
    Constant,
    /// By altitude, km.
    Table {
        curve: Curve,
        end: f64,
    },
}

impl Shape {
    /// That of the layer at `place`.
    pub fn new(place: &str, layer: &Layer) -> Result<Self, RecipeError> {
        let bottom = layer.bottom_km.unwrap_or(0.0) * 1000.0;
        let top = layer.top_km.map_or(TOP, |km| km * 1000.0);
        let within = match (&layer.profile, layer.scale_height_km) {
            (Some(columns), _) => {
                let place = format!("{place}.profile");
                let table = Functions::new(&place, columns, "altitude_km")?;
                table.only(|name| name == "relative")?;
                if table.range()[0] < 0.0 {
                    return Err(field(place, "altitude_km is negative"));
                }
                Within::Table {
                    curve: table.curve("relative", 0.0, 1e30)?,
                    end: table.range()[1],
                }
            }
            (None, Some(km)) => Within::Exponential(km * 1000.0),
            (None, None) => Within::Constant,
        };
        Ok(Self {
            bottom: (bottom > 0.0).then(|| Edge::new(bottom, layer.bottom_edge_km)),
            top: (top < TOP).then(|| Edge::new(top, layer.top_edge_km)),
            within,
        })
    }

    /// Value at an altitude, m. An exponential layer is 1 at sea level, or would be.
    pub fn at(&self, altitude: f64) -> f64 {
        let bottom = self.bottom.map_or(1.0, |edge| edge.above(altitude));
        let top = self.top.map_or(1.0, |edge| 1.0 - edge.above(altitude));
        let within = match &self.within {
            Within::Exponential(height) => (-altitude / height).exp(),
            Within::Constant => 1.0,
            Within::Table { end, .. } if altitude > end * 1000.0 => 0.0,
            Within::Table { curve, .. } => curve.at(altitude / 1000.0),
        };
        bottom * top * within
    }

    /// Both ends that are edges.
    pub fn edges(&self) -> impl Iterator<Item = Edge> {
        self.bottom.into_iter().chain(self.top)
    }

    /// Altitudes where a table bends, m.
    pub fn bends(&self) -> Vec<f64> {
        match &self.within {
            Within::Table { curve, .. } => curve.nodes().iter().map(|km| km * 1000.0).collect(),
            _ => vec![],
        }
    }

    /// Whether it reaches down to the ground.
    pub fn on_ground(&self) -> bool {
        self.bottom.is_none()
    }
}
