//! What is prepared besides over a ground whose albedo depends on wavelength.

use super::between_grounds::BetweenGrounds;

/// What goes with a sky, or with air, that has at each node the ground of that.
#[derive(Clone, Debug)]
pub(crate) struct OverGround<T> {
    pub grounds: BetweenGrounds,
    /// Over the other ground.
    pub second: T,
    /// For colours, over the albedos that the ground has in them.
    pub colour: T,
}
