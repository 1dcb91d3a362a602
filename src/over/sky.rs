//! Skies over the ground of a model.

use crate::bands::coloured_over;
use crate::conditions::Conditions;
use crate::error::Result;
use crate::ground::{BetweenGrounds, OverGround};
use crate::model::Model;
use crate::polarisation::PolarisedSky;
use crate::sky::Sky;
use crate::sky::prepare::NodeWeights;

impl Model {
    /// Prepares a sky: after this, queries cost no allocation and no system call.
    ///
    /// Touches the chunks of at most four altitudes and four visibilities around the conditions, and only one where
    /// altitude or visibility is a node of the model. The first touch of a chunk verifies it.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for conditions outside the model (see [`Conditions::clamped`]), [`Error::MissingChunk`] if
    /// the file lacks a needed chunk, [`Error::Checksum`], [`Error::Encoding`] or [`Error::Invalid`] if one is damaged,
    /// [`Error::Read`] if the source of a streamed model fails.
    ///
    /// [`Error::OutOfRange`]: crate::Error::OutOfRange
    /// [`Error::MissingChunk`]: crate::Error::MissingChunk
    /// [`Error::Checksum`]: crate::Error::Checksum
    /// [`Error::Encoding`]: crate::Error::Encoding
    /// [`Error::Invalid`]: crate::Error::Invalid
    /// [`Error::Read`]: crate::Error::Read
    pub fn sky(&self, conditions: &Conditions) -> Result<Sky> {
        let conditions = conditions.checked(self)?;
        let at = |albedos: &[f64]| Sky::prepare(self, self.nodes(), &conditions, albedos);
        let first = at(&self.albedos_at_nodes(&conditions))?;
        let Some(grounds) = self.grounds(&conditions) else {
            return Ok(first);
        };
        let (nodes, albedos) = coloured_over(self, &conditions)?;
        Ok(first.with_ground(OverGround {
            second: at(grounds.second())?,
            colour: Sky::prepare(self, nodes.nodes(), &conditions, &albedos)?,
            grounds,
        }))
    }

    /// Prepares a sky with its polarisation: after this, queries cost no allocation and no system call.
    ///
    /// # Errors
    /// As [`Model::sky`]; [`Error::MissingChunk`](crate::Error::MissingChunk) for a file without polarisation.
    pub fn polarised_sky(&self, conditions: &Conditions) -> Result<PolarisedSky> {
        let conditions = conditions.checked(self)?;
        let at = |albedos: &[f64]| PolarisedSky::prepare(self, self.nodes(), &conditions, albedos);
        let first = at(&self.albedos_at_nodes(&conditions))?;
        let Some(grounds) = self.grounds(&conditions) else {
            return Ok(first);
        };
        let (nodes, albedos) = coloured_over(self, &conditions)?;
        let colour = PolarisedSky::prepare(self, nodes.nodes(), &conditions, &albedos)?;
        let second = at(grounds.second())?;
        Ok(first.with_ground(grounds, second, colour))
    }

    /// The two grounds that make all others, where the albedo depends on wavelength.
    pub(super) fn grounds(&self, conditions: &Conditions) -> Option<BetweenGrounds> {
        let ground = self.spectral_ground()?;
        let head = self.head();
        let spherical = NodeWeights::new(head, conditions).spherical_albedo(head);
        Some(BetweenGrounds::new(ground, &head.wavelengths, spherical))
    }
}
