//! Which wavelengths a model covers: the nodes that are traced, and the cells that are made of them.

use crate::atmosphere::Monochromatic;
use crate::successive_orders::NW;

/// Wavelengths that a model covers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coverage {
    /// The nodes, by increasing wavelength.
    pub nodes: [Monochromatic; NW],
    /// Index of the node that air stops most.
    pub guard: usize,
    /// Ranges of cells (nm), one after another, and the steps in them.
    pub steps: &'static [(f64, f64, f64)],
}

/// Light beside lines.
const fn clear(wavelength: f64) -> Monochromatic {
    Monochromatic::beside_lines(wavelength)
}

/// 300..1100 nm. Nodes are as dense in wavelength as ozone bends; those about 762.5 nm are absorption terms of oxygen,
/// those about 825 and 940 nm of water vapour, weak enough to leave light at the ground. Cells: ozone bends on the scale
/// of a nanometre below 345 nm, absorption bands on that of their data.
pub const VISIBLE: Coverage = Coverage {
    nodes: [
        clear(300.0),
        clear(303.0),
        clear(307.0),
        clear(312.0),
        clear(318.0),
        clear(324.0),
        clear(332.0),
        clear(343.0),
        clear(380.0),
        clear(430.0),
        clear(470.0),
        clear(510.0),
        clear(550.0),
        clear(580.0),
        clear(605.0),
        clear(650.0),
        clear(740.0),
        Monochromatic::mixed(762.0, 0.05),
        Monochromatic::mixed(763.0, 0.17),
        Monochromatic::vapour(825.0, 0.035),
        clear(870.0),
        Monochromatic::vapour(939.0, 0.1),
        Monochromatic::vapour(941.0, 0.3),
        clear(1030.0),
    ],
    guard: 0,
    steps: &[
        (300.0, 345.0, 1.0),
        (345.0, 665.0, 5.0),
        (665.0, 780.0, 2.5),
        (780.0, 1100.0, 5.0),
    ],
};

/// 1100..2500 nm: smooth scattering, absorption by water vapour and by carbon dioxide and methane (mixed gases).
pub const SHORT_WAVE_INFRARED: Coverage = Coverage {
    nodes: [
        clear(1100.0),
        Monochromatic::vapour(1130.0, 0.04),
        Monochromatic::vapour(1132.0, 0.3),
        Monochromatic::vapour(1134.0, 1.5),
        clear(1240.0),
        Monochromatic::mixed(1270.0, 0.05),
        clear(1350.0),
        Monochromatic::vapour(1395.0, 0.04),
        Monochromatic::vapour(1400.0, 0.3),
        Monochromatic::vapour(1405.0, 1.5),
        clear(1550.0),
        Monochromatic::mixed(1600.0, 0.05),
        Monochromatic::mixed(1605.0, 0.5),
        clear(1750.0),
        Monochromatic::vapour(1870.0, 0.04),
        Monochromatic::vapour(1875.0, 0.3),
        Monochromatic::vapour(1880.0, 1.5),
        Monochromatic::mixed(2000.0, 0.05),
        Monochromatic::mixed(2005.0, 0.5),
        Monochromatic::mixed(2010.0, 2.5),
        clear(2150.0),
        clear(2350.0),
        Monochromatic::vapour(2450.0, 0.3),
        clear(2500.0),
    ],
    guard: 19,
    steps: &[(1100.0, 2500.0, 10.0)],
};

/// Optical depth of a vertical path from which on gases absorb strongly: light under them varies unlike all other.
const STRONG: f64 = 0.5;
/// Precipitable water, cm.
const WATER: f64 = 1.42;

impl Coverage {
    /// Indices of the nodes that gases absorb little, and of the others.
    pub fn groups(&self) -> [Vec<usize>; 2] {
        let strong = |n: &usize| {
            let node = self.nodes[*n];
            node.water * WATER + node.mixed > STRONG
        };
        (0..NW).partition(|n| !strong(n)).into()
    }

    /// Shortest and longest wavelength of the cells, nm.
    pub fn range(&self) -> [f64; 2] {
        [self.steps[0].0, self.steps[self.steps.len() - 1].1]
    }

    /// Wavelengths of the nodes, nm.
    pub fn wavelengths(&self) -> [f64; NW] {
        self.nodes.map(|n| n.wavelength)
    }
}
