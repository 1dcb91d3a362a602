"""The tables of baked skies, evaluated in numpy by the formulae that `SkyBuffers` gives."""

import numpy as np
import pytest

import welkin_sky

MODEL = welkin_sky.default_model()
CONDITIONS = welkin_sky.Conditions(solar_elevation=0.3, solar_azimuth=0.8, altitude=1200.0)


def taps(x, intervals):
    u = x * intervals
    cell = np.clip(np.floor(u), 0, intervals - 1)
    t = u - cell
    s = 1.0 - t
    inner = lambda t: 3.0 * t**3 - 6.0 * t * t + 4.0
    return cell.astype(int), np.stack([s**3, inner(t), inner(s), t**3]) / 6.0


def values(tables, d):
    """(…, channels) of unit vectors."""
    side = d[:, 2] - tables["horizon"]
    k = (side < 0.0).astype(int)
    shrink, crowding = np.array(tables["shrink"])[k], np.array(tables["crowding"])[k]
    sine = np.sqrt(np.minimum(np.abs(side) * shrink, 1.0))
    cosine = np.sqrt(np.clip((1.0 - (1 - 2 * k) * d[:, 2]) * shrink, 0.0, 1.0))
    row = sine * (1.0 + crowding) / (crowding * sine + 1.0 + tables["pole"] * cosine)
    cos_phi = (d[:, :2] @ tables["azimuth"]) / np.hypot(d[:, 0], d[:, 1])
    up, down, columns = tables["intervals"]
    first, rows = taps(row, np.where(k == 0, up, down))
    first = first + k * (up + 3)
    column, across = taps(np.sqrt(np.clip((1.0 - cos_phi) / 2.0, 0.0, 1.0)), columns)
    angle = np.minimum(np.linalg.norm(d - tables["sun"], axis=1) / 2.0, 1.0)
    around, weights = taps(angle, tables["sun_intervals"])
    root = np.sqrt(np.maximum(d[:, 2] ** 2 - tables["horizon"] ** 2, 0.0)) + np.abs(d[:, 2])
    opacity = np.where(k == 0, 1.0, tables["opaque"] / (tables["opaque"] + root))
    # (groups, cells, 4) to (cells, channels).
    flat = lambda name: np.moveaxis(tables[name], 1, 0).reshape(tables[name].shape[1], -1)
    cells, envelope = flat("cells"), flat("envelope")
    logarithm = sum(weights[k][:, None] * envelope[around + k] for k in range(4))
    for r in range(4):
        for c in range(4):
            weight = (rows[r] * across[c])[:, None]
            logarithm = logarithm + weight * cells[(first + r) * (columns + 3) + column + c]
    scale = tables["scale"].reshape(-1)
    return (2.0**logarithm * opacity[:, None] * scale)[:, : tables["channels"]]


@pytest.mark.parametrize("kind", ["colour", "spectrum", "bands"])
def test_tables_give_the_sky(kind):
    directions = welkin_sky.fish_eye(24).directions.reshape(-1, 3)
    directions = directions[np.isfinite(directions).all(1) & (np.hypot(*directions.T[:2]) > 1e-3)]
    if kind == "colour":
        sky = MODEL.colour_sky(CONDITIONS).bake()
        expected = sky.xyz(directions)
    elif kind == "spectrum":
        sky = MODEL.sky(CONDITIONS).bake()
        expected = sky.radiance(directions)
    else:
        sky = MODEL.band_sky(MODEL.bands([430.0, 510.0, 555.0, 620.0, 700.0]), CONDITIONS).bake()
        expected = sky.radiance(directions)
    tables = sky.buffers()
    assert tables["polarisation"] is None
    np.testing.assert_allclose(values(tables, directions.astype(float)), expected, rtol=2e-3)


def test_polarised_bands_have_tables_of_their_polarisation():
    bands = MODEL.bands([450.0, 650.0])
    tables = MODEL.polarised_band_sky(bands, CONDITIONS).buffers()
    assert tables["polarisation"].shape[0] == 2 * tables["cells"].shape[0]
    assert tables["polarisation"].shape[1:] == tables["cells"].shape[1:]
