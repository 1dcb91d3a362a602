"""Pictures as lines of sight: +z is the zenith, the sun stands over +x; angles in radians."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class View:
    """Unit vectors of pixels, rows from the top; all-NaN where nothing is seen."""

    directions: np.ndarray

    @property
    def seen(self):
        return np.isfinite(self.directions[..., 0])

    @property
    def lines(self):
        """The directions of the pixels that see something, one a row."""
        return self.directions[self.seen]

    def picture(self, values):
        """Puts one value (or vector) for each line into its pixel; NaN elsewhere."""
        values = np.asarray(values)
        out = np.full(self.directions.shape[:2] + values.shape[1:], np.nan)
        out[self.seen] = values
        return out


def angles(lines):
    """Angles from the zenith and azimuths from the sun, counter-clockwise from above."""
    zenith = np.arctan2(np.hypot(lines[:, 0], lines[:, 1]), lines[:, 2])
    return zenith, np.arctan2(lines[:, 1], lines[:, 0])


def _disc(pixels, rows):
    middle = (np.arange(pixels) + 0.5) / pixels * 2 - 1
    right, above = np.meshgrid(middle, -middle[:rows])
    radius = np.hypot(right, above)
    angle = np.where(radius < 1, radius * np.pi / 2, np.nan)
    scale = np.sin(angle) / radius
    return right * scale, above * scale, np.cos(angle)


def up(pixels):
    """The upper half of an equidistant fish-eye of the sky, the sun to the right.

    Clear skies are alike on both sides of the sun: `mirrored` makes the whole.
    """
    right, above, axis = _disc(pixels, pixels // 2)
    return View(np.stack([right, above, axis], -1))


def mirrored(picture):
    """A whole fish-eye from its upper half."""
    return np.concatenate([picture, picture[::-1]])


def sideways(pixels):
    """An equidistant fish-eye of the hemisphere to the left of the sun, which stands at the right edge."""
    right, above, axis = _disc(pixels, pixels)
    return View(np.stack([right, axis, above], -1))


def strip(size, azimuths, elevations):
    """A panorama: azimuths from left to right, elevations from top to bottom."""
    across, down = [(np.arange(n) + 0.5) / n for n in size]
    azimuth, elevation = np.meshgrid(
        azimuths[0] + across * (azimuths[1] - azimuths[0]),
        elevations[0] + down * (elevations[1] - elevations[0]),
    )
    level = np.cos(elevation)
    return View(np.stack([level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation)], -1))


def perspective(size, axis_azimuth, pitch, field_of_view):
    """A flat picture with the given vertical field of view."""
    width, height = size
    scale = np.tan(field_of_view / 2)
    right = ((np.arange(width) + 0.5) / width * 2 - 1) * scale * width / height
    above = -((np.arange(height) + 0.5) / height * 2 - 1) * scale
    right, above = np.meshgrid(right, above)
    ahead = np.cos(pitch) - above * np.sin(pitch)
    up_ = np.sin(pitch) + above * np.cos(pitch)
    cos, sin = np.cos(axis_azimuth), np.sin(axis_azimuth)
    out = np.stack([cos * ahead + sin * right, sin * ahead - cos * right, up_], -1)
    return View(out / np.linalg.norm(out, axis=-1, keepdims=True))
