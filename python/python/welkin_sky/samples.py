"""What a sampler draws."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Samples(NamedTuple):
    """Directions drawn by `SkySampler.sample`: xyz / pdf estimates the light of sky and sun together."""

    directions: NDArray[np.float32]
    """Unit vectors (…, 3)."""
    pdf: NDArray[np.float32]
    """Density per solid angle, sr⁻¹: (…)."""
    xyz: NDArray[np.float32]
    """CIE 1931 X, Y, Z of sky and, if it is drawn, the sun's disc, cd m⁻²: (…, 3)."""
    is_sun: NDArray[np.bool_]
    """Whether it was drawn for the sun's disc: (…)."""
