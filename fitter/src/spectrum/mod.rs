//! What lies between the nodes: the weights of the nodes at every wavelength, learned from traced spectra.
//!
//! Data flow: [`cells`] → [`training`] → weights.

pub mod cells;
pub mod training;
pub mod weights;
