//! What a ground is in colours.

use crate::bands::coloured_over;
use crate::conditions::Conditions;
use crate::error::Result;
use crate::model::Model;

impl Model {
    /// The albedos of the ground at [`Model::wavelengths`] with which what it reflects is seen in its colours, as a sum
    /// over these with the `xyz` of [`Model::head`]: over a ground whose albedo depends on wavelength means over what a
    /// wavelength stands for. `None` without a ground of the model's own ([`Model::over`]).
    ///
    /// ```
    /// use welkin::{Albedo, Model};
    ///
    /// let grass = Albedo::table(&[500.0, 550.0, 600.0], &[0.04, 0.10, 0.05])?;
    /// let meadow = Model::default_model()?.over(&grass);
    /// let albedos = meadow.albedos_in_colours()?.expect("a ground");
    /// assert_eq!(albedos.len(), meadow.wavelengths().len());
    /// # Ok::<(), welkin::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of damaged chunks.
    pub fn albedos_in_colours(&self) -> Result<Option<Vec<f64>>> {
        let Some(ground) = self.ground() else {
            return Ok(None);
        };
        let conditions = Conditions::default().clamped(self)?;
        let mut albedos: Vec<f64> = self.wavelengths().iter().map(|&l| ground.at(l)).collect();
        let (nodes, in_colours) = coloured_over(self, &conditions)?;
        for (&node, albedo) in nodes.kept().iter().zip(in_colours) {
            albedos[node] = albedo;
        }
        Ok(Some(albedos))
    }
}
