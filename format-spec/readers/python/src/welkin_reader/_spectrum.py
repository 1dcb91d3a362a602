"""What lies between the nodes of a file with a spectrum (sections 6.9, 7.3, 7.5 and 7.6)."""

from dataclasses import dataclass

import numpy as np

from ._axes import interval
from ._head import check_solar_span, require, require_increasing, require_within

_DARKEST = 2.0**-27
"""Least share of the brightest node that a node counts with."""


@dataclass(frozen=True)
class Spectrum:
    """The spectrum chunk: cells C, terms G of all cells together, taps T of each term.

    axis (C,) nm, first_term (C+1,), term_weight (G,), term_extinction (G, nk), tap_node (G, T),
    tap_weight (G, T), extinction (nv, nk, C).
    """

    axis: np.ndarray
    first_term: np.ndarray
    term_weight: np.ndarray
    term_extinction: np.ndarray
    tap_node: np.ndarray
    tap_weight: np.ndarray
    extinction: np.ndarray

    def width(self, wavelength):
        """How many numbers an answer at wavelengths (K,) needs at once for each direction."""
        return len(_Neighbours(self, wavelength).terms)

    def radiance(self, radiance, wavelength):
        """Radiance (N, nw) of the nodes at wavelengths (K,): (N, K)."""
        near = _Neighbours(self, wavelength)
        logarithm, _ = near.cells(radiance)
        return near.light(radiance, logarithm)

    def stokes(self, stokes, wavelength):
        """L, Q, U (N, 3, nw) of the nodes at wavelengths (K,): L, Q/L and U/L (N, 3, K)."""
        near = _Neighbours(self, wavelength)
        radiance = stokes[:, 0]
        logarithm, share = near.cells(radiance)
        lit = np.where(radiance > 0.0, radiance, 1.0)
        weights = near.node_weights(radiance.shape[1]).T
        parts = [near.per_cell(share * (stokes[:, k] / lit @ weights)) for k in (1, 2)]
        light = near.light(radiance, logarithm)
        return np.stack([light, *(near.between(part) for part in parts)], axis=1)

    def transmittance(self, columns, visibility_weights, wavelength):
        """Mean transmittance (N, K) of lines with integrals of the profiles columns (N, nk)."""
        near = _Neighbours(self, wavelength)
        extinction = np.tensordot(visibility_weights, self.extinction, 1)[:, near.cell]
        smooth = np.exp(-near.between(columns @ extinction))
        lines = np.exp(-(columns @ self.term_extinction[near.terms].T))
        # The shares of a cell have a sum of about 1: a little more must not make light.
        return np.minimum(1.0, smooth * near.between(near.per_cell(near.weight * lines)))


class _Neighbours:
    """The cells c around wavelengths (K,), and their terms g."""

    def __init__(self, spectrum, wavelength):
        self._spectrum = spectrum
        i, self._t = interval(spectrum.axis, wavelength)
        self.cell, place = np.unique(np.concatenate([i, i + 1]), return_inverse=True)
        self._low, self._high = place[: len(i)], place[len(i) :]
        first, end = spectrum.first_term[self.cell], spectrum.first_term[self.cell + 1]
        self._count = end - first
        self._start = np.cumsum(self._count) - self._count
        self.terms = np.arange(self._count.sum()) + np.repeat(first - self._start, self._count)
        self.weight = spectrum.term_weight[self.terms]

    def node_weights(self, nodes):
        """Weights of the nodes in each term: (g, nodes)."""
        table = np.zeros((len(self.terms), nodes))
        rows = np.arange(len(self.terms))[:, None]
        np.add.at(table, (rows, self._spectrum.tap_node[self.terms]), self._spectrum.tap_weight[self.terms])
        return table

    def per_cell(self, values, combine=np.add):
        """Combines values (N, g) of the terms of each cell: (N, c)."""
        return combine.reduceat(values, self._start, axis=1)

    def between(self, values):
        """Values (N, c), linear between cells: (N, K)."""
        return (1.0 - self._t) * values[:, self._low] + self._t * values[:, self._high]

    def cells(self, radiance):
        """ln L of the cells (N, c), and the share of each term (N, g) in the light of its cell."""
        floor = _DARKEST * radiance.max(axis=1, keepdims=True)
        nodes = np.log(np.where(floor > 0.0, np.maximum(radiance, floor), 1.0))
        terms = nodes @ self.node_weights(radiance.shape[1]).T
        terms = np.where(self.weight > 0.0, terms, -np.inf)
        # Exponentials are of differences from the brightest term, which neither overflow nor vanish.
        brightest = self.per_cell(terms, np.maximum)
        share = self.weight * np.exp(terms - np.repeat(brightest, self._count, axis=1))
        total = self.per_cell(share)
        return brightest + np.log(total), share / np.repeat(total, self._count, axis=1)

    def light(self, radiance, logarithm):
        """L (N, K) from ln L (N, c) of the cells, 0 where all nodes are dark."""
        lit = radiance.max(axis=1, keepdims=True) != 0.0
        return np.where(lit, np.exp(self.between(logarithm)), 0.0)


def decode_spectrum(payload, entry, head):
    nw, nv, nk = (head.counts[name] for name in ("nw", "nv", "nk"))
    cells, taps, terms, examples = map(int, payload.take("<u4", 4))
    require(2 <= cells <= 4096, "cells outside 2 to 4096")
    require(1 <= taps <= 16, "taps outside 1 to 16")
    require(cells <= terms <= 65536, "fewer terms than cells, or more than 65536")
    require(examples <= 1024, "more than 1024 examples")
    axis = payload.take("<f8", cells)
    first_term = payload.take("<u4", cells + 1).astype(np.int64)
    term_weight = payload.take("<f4", terms).astype(np.float64)
    term_extinction = payload.take("<f4", terms, nk).astype(np.float64)
    tap_node = payload.take("<u4", terms, taps)
    tap_weight = payload.take("<f4", terms, taps)
    extinction = payload.take("<f4", nv, nk, cells).astype(np.float64)
    example = payload.take("<f4", examples, nw)
    payload.end()
    require_within(axis, 1.0, 1e6, "wavelength of a cell")
    require_increasing(axis, "wavelength of cells")
    check_solar_span(head, axis)
    require(first_term[0] == 0 and first_term[-1] == terms, "terms that belong to no cell")
    require_within(np.diff(first_term), 1, 64, "number of terms of a cell")
    require_within(term_weight, 0.0, 1.0, "share of a term")
    sums = np.add.reduceat(term_weight, first_term[:-1])
    require_within(sums - 1.0, -1e-5, 1e-5, "excess of the shares of a cell")
    require_within(term_extinction, 0.0, 1e6, "extinction of a term")
    require(np.all(tap_node < nw), "a tap beyond the nodes")
    require_within(tap_weight, -1e3, 1e3, "weight of a tap")
    require_within(extinction, 0.0, 1e6, "extinction of a cell")
    require_within(example, -100.0, 100.0, "example")
    return Spectrum(axis, first_term, term_weight, term_extinction, tap_node, tap_weight, extinction)
