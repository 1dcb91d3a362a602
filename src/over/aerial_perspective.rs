//! Aerial perspective over the ground of a model.

use crate::aerial_perspective::AerialPerspective;
use crate::bands::coloured_over;
use crate::conditions::Conditions;
use crate::error::Result;
use crate::ground::OverGround;
use crate::model::Model;

impl Model {
    /// Prepares transmittance and in-scattering for a scene.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) for conditions outside the model;
    /// [`Error::MissingChunk`](crate::Error::MissingChunk) if the file has no transmittance or no source;
    /// [`Error::Checksum`](crate::Error::Checksum), [`Error::Encoding`](crate::Error::Encoding),
    /// [`Error::Length`](crate::Error::Length) or [`Error::Invalid`](crate::Error::Invalid) if one is damaged.
    pub fn aerial_perspective(&self, conditions: &Conditions) -> Result<AerialPerspective> {
        let conditions = conditions.checked(self)?;
        let at =
            |albedos: &[f64]| AerialPerspective::prepare(self, self.nodes(), &conditions, albedos);
        let first = at(&self.albedos_at_nodes(&conditions))?;
        let Some(grounds) = self.grounds(&conditions) else {
            return Ok(first);
        };
        let (nodes, albedos) = coloured_over(self, &conditions)?;
        Ok(first.with_ground(OverGround {
            second: at(grounds.second())?,
            colour: AerialPerspective::prepare(self, nodes.nodes(), &conditions, &albedos)?,
            grounds,
        }))
    }
}
