"""Phase functions, normalised to mean 1 over the sphere (section 7.2)."""

import numpy as np

from ._head import PHASE_NONE, PHASE_RAYLEIGH


class Angle:
    """The angles between unit vectors and the sun.

    Both 1 − cos γ and 1 + cos γ come from chords, so that neither cancels.
    """

    def __init__(self, units, sun):
        self.one_minus_cos = 0.5 * np.sum((units - sun) ** 2, axis=-1)[:, None]
        self.one_plus_cos = 0.5 * np.sum((units + sun) ** 2, axis=-1)[:, None]
        self.cos = (units @ sun)[:, None]


def rayleigh_share(depolarisation):
    """Δ: the share of light that is scattered like by a dipole."""
    return (1.0 - depolarisation) / (1.0 + 0.5 * depolarisation)


def phase_function(code, parameter, angle):
    """Values (N, nw) of a phase function with the parameters (nw,) at N angles."""
    if code == PHASE_NONE:
        return 1.0
    if code == PHASE_RAYLEIGH:
        share = rayleigh_share(parameter)
        return share * 0.75 * (1.0 + angle.cos**2) + 1.0 - share
    g = np.asarray(parameter)
    # 1 + g² − 2g cos γ, written so that nothing cancels for g near ±1.
    rest = np.where(g < 0.0, angle.one_plus_cos, angle.one_minus_cos)
    base = (1.0 - np.abs(g)) ** 2 + 2.0 * np.abs(g) * rest
    return (1.0 - g) * (1.0 + g) / base**1.5
