//! Tables that depend on nothing but the file: made once, when the first aerial perspective needs them.

use std::sync::Arc;

use super::angular_basis::Directions;
use super::sun_transmittance::Beam;
use crate::error::Result;
use crate::model::Model;
use crate::transmittance::Layers;

/// What all aerial perspectives of a model share.
pub(super) struct FileTables {
    pub directions: Arc<Directions>,
    pub beam: Arc<Beam>,
}

impl FileTables {
    pub fn of(model: &Model) -> Result<Arc<Self>> {
        model.derived(|| {
            let head = model.head();
            let layers = Layers::new(&model.density_chunk()?, head.planet, head.constituents);
            Ok(Self {
                directions: Arc::new(Directions::new(&model.source_basis_chunk()?)),
                beam: Arc::new(Beam::new(&layers)),
            })
        })
    }
}
