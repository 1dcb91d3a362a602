"""Values at nodes, and how much of each is found between them."""

import numpy as np


def weights(nodes, values):
    """Share of each node (n, …) with which something linear between increasing `nodes` is found at `values`."""
    values = np.clip(values, nodes[0], nodes[-1])
    one = np.eye(len(nodes))
    return np.stack([np.interp(values, nodes, one[k]) for k in range(len(nodes))])
