"""What differs between variants: numbers or arrays."""

import math

import drjit as dr
import mitsuba as mi
import numpy as np


def number(value):
    return float(dr.slice(value)) if dr.is_jit_v(value) else float(value)


def given_number(props, name, default):
    """A property that is a finite number."""
    value = props.get(name, default)
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise ValueError(f"{name} must be a number, got {value!r}")
    return float(value)


def blank(kind):
    """All zeros; `dr.zeros` makes no structures of scalar variants."""
    return dr.zeros(kind) if dr.is_jit_v(mi.Float) else kind()


def storage(values):
    """An array that `gather` reads from."""
    return type(mi.TensorXf([0.0]).array)(np.ascontiguousarray(values, np.float32).ravel())


def gather(source, index, active=True):
    """A number of a storage; `dr.gather` knows no scalar variants."""
    if dr.is_jit_v(mi.Float):
        return dr.gather(mi.Float, source, index, active)
    return source[int(index)] if active else 0.0


def gather_packet(source, size, index, active=True):
    """2, 4 or 8 numbers that stand together; not in scalar variants."""
    if size == 8:
        return [*gather_packet(source, 4, 2 * index, active), *gather_packet(source, 4, 2 * index + 1, active)]
    return list(dr.gather(mi.Vector2f if size == 2 else mi.Vector4f, source, index, active))
