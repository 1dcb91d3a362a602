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
/// Below its bottom a layer grows downwards no faster than to e times as much along so many widths of the edge there,
/// however small its scale height: the edge wins.
const SLOWEST: f64 = 10.0;
/// How far beyond its first and last row a profile is nothing, m.
const CLIFF: f64 = 10.0;

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
    Table(Curve),
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
                table.only_altitudes()?;
                let curve = table.curve("relative", 0.0, 1e30)?;
                if curve.nodes().iter().all(|&km| curve.at(km) == 0.0) {
                    return Err(field(place, "relative is 0 everywhere"));
                }
                Within::Table(curve)
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
            Within::Exponential(height) => self.exponential(altitude, *height),
            Within::Constant => 1.0,
            Within::Table(curve) => {
                let (km, [first, last]) = (altitude / 1000.0, ends(curve));
                match (first..=last).contains(&km) {
                    true => curve.at(km),
                    false => 0.0,
                }
            }
        };
        bottom * top * within
    }

    fn exponential(&self, altitude: f64, height: f64) -> f64 {
        match self.bottom {
            Some(edge) if altitude < edge.altitude && height < SLOWEST * edge.width => {
                let below = (edge.altitude - altitude) / (SLOWEST * edge.width);
                (below - edge.altitude / height).exp()
            }
            _ => (-altitude / height).exp(),
        }
    }

    /// Both ends that are edges.
    pub fn edges(&self) -> impl Iterator<Item = Edge> {
        self.bottom.into_iter().chain(self.top)
    }

    /// Altitudes where a table bends, m, and where it has become nothing beyond its ends.
    pub fn bends(&self) -> Vec<f64> {
        let Within::Table(curve) = &self.within else {
            return vec![];
        };
        let [first, last] = ends(curve).map(|km| km * 1000.0);
        let rows = curve.nodes().iter().map(|km| km * 1000.0);
        let cliffs = [first - CLIFF, last + CLIFF];
        rows.chain(cliffs).collect()
    }

    /// Whether it reaches down to the ground.
    pub fn on_ground(&self) -> bool {
        self.bottom.is_none() && self.at(0.0) > 0.0
    }
}

/// First and last row, km.
fn ends(curve: &Curve) -> [f64; 2] {
    let nodes = curve.nodes();
    [nodes[0], nodes[nodes.len() - 1]]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shape(layer: Layer) -> Shape {
        Shape::new("layers.a", &layer).unwrap()
    }

    /// Whatever the scale height, there is less of a layer below its bottom than in it, and ever less further down.
    #[test]
    fn an_exponential_layer_aloft_does_not_grow_below_its_bottom() {
        for (height, edge) in [(0.05, 0.5), (0.4, 0.5), (0.5, 0.5), (1.0, 1.0), (8.0, 0.15)] {
            let ash = shape(Layer {
                bottom_km: Some(12.0),
                top_km: Some(20.0),
                scale_height_km: Some(height),
                bottom_edge_km: Some(edge),
                ..Layer::default()
            });
            let below: Vec<f64> = (0..=120).map(|i| ash.at(100.0 * f64::from(i))).collect();
            assert!(below.windows(2).all(|w| w[0] < w[1]), "{height} {edge}");
            assert!(below[0] < 1e-3 * below[120], "{height} {edge}");
        }
    }

    /// Gentle layers are exponential through the edge, as in the model's own air.
    #[test]
    fn an_exponential_layer_is_one_at_sea_level() {
        let free = shape(Layer {
            bottom_km: Some(2.0),
            scale_height_km: Some(8.0),
            ..Layer::default()
        });
        for z in [1000.0, 1900.0, 2000.0, 5000.0_f64] {
            let edge = 1.0 / (1.0 + (-(z - 2000.0) / 150.0).exp());
            let expected = edge * (-z / 8000.0).exp();
            assert!((free.at(z) / expected - 1.0).abs() < 1e-12, "{z}");
        }
    }
}
