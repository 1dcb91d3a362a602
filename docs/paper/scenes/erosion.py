"""Valleys: the stream power law on a lattice of heights, implicit in time, as in Braun and Willett 2013.

A river cuts at a rate of `rate * sqrt(area) * slope` where `area` drains through it. Trees of rivers are followed by
doubling: after n rounds every cell has met its 2ⁿ cells downstream.
"""

import numpy as np


def _shifted(height, di, dj):
    padded = np.pad(height, 1, constant_values=np.inf)
    rows, columns = height.shape
    return padded[1 + di : 1 + di + rows, 1 + dj : 1 + dj + columns]


def receivers(height, cell):
    """Index of the steepest of eight neighbours below each cell, or of itself, and how far that is, m."""
    rows, columns = height.shape
    index = np.arange(rows * columns).reshape(rows, columns)
    best, receiver = np.zeros_like(height), index.copy()
    length = np.full_like(height, cell)
    for di in (-1, 0, 1):
        for dj in (-1, 0, 1):
            if di == 0 and dj == 0:
                continue
            far = cell * np.hypot(di, dj)
            slope = (height - _shifted(height, di, dj)) / far
            better = slope > best
            best = np.where(better, slope, best)
            receiver = np.where(better, index + di * columns + dj, receiver)
            length = np.where(better, far, length)
    return receiver.ravel(), length.ravel()


def _doublings(receiver):
    """Cells 1, 2, 4, … downstream of each, until all are past their outlets: index `len(receiver)`."""
    nowhere = len(receiver)
    following = np.append(np.where(receiver == np.arange(nowhere), nowhere, receiver), nowhere)
    while (following != nowhere).any():
        yield following
        following = following[following]


def drained_area(doublings, cell):
    """Area that drains through each cell, m²; after n rounds from less than 2ⁿ cells away."""
    area = np.full(len(doublings[0]), cell * cell)
    for following in doublings:
        area = area + np.bincount(following, area, len(area))
    return area[:-1]


def step(height, cell, uplift, rate, time):
    """Heights after `time`: lifted by `uplift` (m per unit of time) and cut by rivers; what lies lowest stays."""
    receiver, length = receivers(height, cell)
    doublings = list(_doublings(receiver))
    cut = rate * time * np.sqrt(drained_area(doublings, cell)) / length
    cut[receiver == np.arange(len(receiver))] = 0.0
    lifted = (height + uplift * time).ravel()
    # h = a + b h(downstream), and that of the cell downstream put in, twice as far each time.
    a, b = np.append(lifted / (1.0 + cut), 0.0), np.append(cut / (1.0 + cut), 0.0)
    for following in doublings:
        a, b = a + b * a[following], b * b[following]
    return a[:-1].reshape(height.shape)
