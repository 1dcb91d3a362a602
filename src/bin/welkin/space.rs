//! Pictures from beyond the air: each ray is asked where it meets the highest altitude of the model.

use welkin::geometry::Planet;
use welkin::{Conditions, Error, Model, Place, PointQuery};

use crate::failure::Result;
use crate::parallel;
use crate::view::View;

/// What a camera in orbit sees.
pub struct Space<'a> {
    query: PointQuery<'a>,
    camera: Place,
    sun: [f64; 3],
    conditions: Conditions,
    ceiling: f64,
    /// To linear sRGB from relative radiance, `[wavelength]`.
    srgb: Vec<[f32; 3]>,
}

/// Of the altitude where the air ends: whoever is above a model that reaches so high is in space.
const NEARLY_ALL: f64 = 0.9;

/// Whether a model reaches so high that hardly any air is above it.
pub fn is_reached_by(model: &Model) -> bool {
    model.altitude_range()[1] >= NEARLY_ALL * model.head().planet.top
}

/// Whether an observer is above all that the model has.
pub fn is_beyond(model: &Model, conditions: &Conditions) -> bool {
    conditions.altitude > model.altitude_range()[1]
}

impl<'a> Space<'a> {
    /// From the bytes of the model.
    pub fn new(model: &Model, bytes: &'a [u8], conditions: &Conditions) -> Result<Self> {
        let Planet { radius, .. } = model.head().planet;
        let position = [0.0, 0.0, radius + conditions.altitude];
        let weights = model.head().xyz.iter();
        Ok(Self {
            query: PointQuery::new(bytes)?,
            camera: Place::new(&model.head().planet, [0.0; 3], position)?,
            sun: conditions.sun_direction(),
            conditions: *conditions,
            ceiling: model.altitude_range()[1],
            srgb: weights
                .map(|xyz| welkin::xyz_to_linear_srgb(xyz.map(|v| v as f32)))
                .collect(),
        })
    }

    /// Linear sRGB, cd m⁻².
    pub fn rgb(&self, view: &View) -> welkin::Result<Vec<[f32; 3]>> {
        parallel::pixels(view.size, |pixel| {
            let Some(direction) = view.direction(pixel) else {
                return Ok([0.0; 3]);
            };
            let mut rgb = self.air(direction)?;
            if let Some(ground) = &view.ground {
                ground.add_srgb(direction, &mut rgb)?;
            }
            Ok(rgb)
        })
    }

    fn air(&self, direction: [f32; 3]) -> welkin::Result<[f32; 3]> {
        let ray = direction.map(f64::from);
        let Some(entry) = self.camera.entry(ray, self.ceiling)? else {
            return Ok([0.0; 3]);
        };
        let conditions = entry.conditions(self.sun, &self.conditions)?;
        let mut radiance = vec![0.0; self.srgb.len()];
        let there = self
            .query
            .relative_radiance(&conditions, entry.direction(ray), &mut radiance);
        match there {
            // The night side.
            Err(Error::OutOfRange {
                parameter: "solar_elevation",
                ..
            }) => return Ok([0.0; 3]),
            other => other?,
        }
        let terms = self.srgb.iter().zip(&radiance);
        Ok(terms.fold([0.0; 3], |sum, (weight, l)| {
            std::array::from_fn(|c| sum[c] + weight[c] * l)
        }))
    }
}
