"""What lies between the nodes of a file with a spectrum (sections 6.9, 7.3 and 7.6)."""

from dataclasses import dataclass

import numpy as np

from ._axes import interval
from ._head import check_solar_span, require, require_increasing, require_within


@dataclass(frozen=True)
class Spectrum:
    """The spectrum chunk, the taps of each cell summed.

    axis (C,) nm, node_weight (C, nw), extinction (nv, nk, C), term_weight (C, G),
    term_extinction (C, G, nk).
    """

    axis: np.ndarray
    node_weight: np.ndarray
    extinction: np.ndarray
    term_weight: np.ndarray
    term_extinction: np.ndarray

    def weights(self, wavelength):
        """Weights of the nodes in ln L at wavelengths (K,): (K, nw)."""
        return self._between(self.node_weight, wavelength)

    def plain_weights(self, wavelength):
        """Weights of the nodes in L, for where one of them is dark: (K, nw)."""
        positive = np.maximum(0.0, self.weights(wavelength))
        total = positive.sum(axis=1, keepdims=True)
        return positive / np.where(total > 0.0, total, 1.0)

    def transmittance(self, columns, visibility_weights, wavelength):
        """Mean transmittance (N, K) of lines with integrals of the profiles columns (N, nk)."""
        extinction = np.tensordot(visibility_weights, self.extinction, 1)
        smooth = np.exp(-(columns @ self._between(extinction.T, wavelength).T))
        i, t = interval(self.axis, wavelength)
        cells, near = np.unique(np.concatenate([i, i + 1]), return_inverse=True)
        lines = self._lines(columns, cells)
        lines = (1.0 - t) * lines[:, near[: len(i)]] + t * lines[:, near[len(i) :]]
        # The shares of a cell have a sum of about 1: a little more must not make light.
        return np.minimum(1.0, smooth * lines)

    def _lines(self, columns, cells):
        """What absorption lines leave of the light of cells (c,): (N, c)."""
        weight, extinction = self.term_weight[cells], self.term_extinction[cells]
        terms = range(weight.shape[1])
        return sum(weight[:, g] * np.exp(-(columns @ extinction[:, g].T)) for g in terms)

    def _between(self, table, wavelength):
        """Rows of a table (C, M), linear between cells: (K, M)."""
        i, t = interval(self.axis, wavelength)
        return (1.0 - t)[:, None] * table[i] + t[:, None] * table[i + 1]


def decode_spectrum(payload, entry, head):
    nw, nv, nk = (head.counts[name] for name in ("nw", "nv", "nk"))
    cells, taps, terms, examples = map(int, payload.take("<u4", 4))
    require(2 <= cells <= 4096, "cells outside 2 to 4096")
    require(1 <= taps <= 16, "taps outside 1 to 16")
    require(1 <= terms <= 16, "terms outside 1 to 16")
    require(examples <= 1024, "more than 1024 examples")
    axis = payload.take("<f8", cells)
    node = payload.take("<u4", cells, taps)
    weight = payload.take("<f4", cells, taps)
    extinction = payload.take("<f4", nv, nk, cells).astype(np.float64)
    term_weight = payload.take("<f4", cells, terms).astype(np.float64)
    term_extinction = payload.take("<f4", cells, terms, nk).astype(np.float64)
    example = payload.take("<f4", examples, nw)
    payload.end()
    require_within(axis, 1.0, 1e6, "wavelength of a cell")
    require_increasing(axis, "wavelength of cells")
    check_solar_span(head, axis)
    require(np.all(node < nw), "a tap beyond the nodes")
    require_within(weight, -1e3, 1e3, "weight of a tap")
    require_within(extinction, 0.0, 1e6, "extinction of a cell")
    require_within(term_weight, 0.0, 1.0, "share of a term")
    require_within(term_weight.sum(axis=1) - 1.0, -1e-5, 1e-5, "excess of the shares of a cell")
    require_within(term_extinction, 0.0, 1e6, "extinction of a term")
    require_within(example, -100.0, 100.0, "example")
    return Spectrum(axis, _summed(node, weight, nw), extinction, term_weight, term_extinction)


def _summed(node, weight, nodes):
    """Weights (C, nodes) of what taps (C, taps) name."""
    table = np.zeros((len(node), nodes))
    np.add.at(table, (np.arange(len(node))[:, None], node), weight)
    return table
