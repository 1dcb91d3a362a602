"""What the visibilities stand for (sections 6.11 and 7.10)."""

from dataclasses import dataclass

import numpy as np

from ._head import require, require_within
from .errors import InvalidValueError, RangeError

LONGEST_NAME = 64
LONGEST_UNIT = 32
LARGEST = 1e30


@dataclass(frozen=True)
class Axis:
    """A quantity that the visibilities of a file stand for.

    name, unit: text from whoever wrote the file
    values (nv,): at the visibilities (nv,) in m, all increasing or all decreasing
    """

    name: str
    unit: str
    values: np.ndarray
    visibilities: np.ndarray

    @property
    def range(self):
        """Least and largest value."""
        return float(self.values.min()), float(self.values.max())

    def visibility(self, value):
        """The visibility in m that stands for a value: what scenes take. Raises RangeError."""
        low, high = self.range
        slack = 1e-9 * max(abs(low), abs(high))
        value = float(value)
        if not low - slack <= value <= high + slack:
            raise RangeError(f"{self.name!a} {value:g} outside {low:g} to {high:g}")
        order = slice(None, None, 1 if self.values[0] <= self.values[-1] else -1)
        inverse = np.interp(value, self.values[order], 1.0 / self.visibilities[order])
        # Rounding does not leave the axis.
        return float(np.clip(1.0 / inverse, self.visibilities[0], self.visibilities[-1]))


def decode_axis(payload, entry, head):
    nodes, name_length, unit_length, _ = map(int, payload.take("<u4", 4))
    require(nodes == head.counts["nv"], "values for another number of visibilities")
    require(1 <= name_length <= LONGEST_NAME, "name of the axis outside 1 to 64 bytes")
    require(unit_length <= LONGEST_UNIT, "unit of the axis above 32 bytes")
    values = payload.take("<f8", nodes).astype(np.float64)
    texts = [payload.take("u1", n).tobytes() for n in (name_length, unit_length)]
    payload.end()
    require_within(values, -LARGEST, LARGEST, "value of the axis")
    steps = np.diff(values)
    require(np.all(steps > 0.0) or np.all(steps < 0.0), "values of the axis that turn or stand still")
    try:
        name, unit = (text.decode("utf-8") for text in texts)
    except UnicodeDecodeError as error:
        raise InvalidValueError("name or unit of the axis is not UTF-8") from error
    return Axis(name, unit, values, head.visibility.copy())
