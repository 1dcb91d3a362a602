"""What tests share: the model, some skies, and random directions."""

import pathlib

import numpy as np
import pytest

import welkin_sky

MODEL_FILE = pathlib.Path(__file__).resolve().parents[2] / "models/default.welkin"
SCENE = {
    "solar_elevation": 0.3,
    "solar_azimuth": 1.1,
    "visibility": 47e3,
    "albedo": 0.35,
    "altitude": 640.0,
}


@pytest.fixture(scope="session")
def model():
    return welkin_sky.default_model()


@pytest.fixture(scope="session")
def sky(model):
    return model.sky(**SCENE)


@pytest.fixture(scope="session")
def polarised(model):
    return model.polarised_sky(**SCENE)


@pytest.fixture(scope="session")
def baked_colour(model):
    return model.colour_sky(**SCENE).bake()


@pytest.fixture
def rng():
    return np.random.default_rng(20261130)


@pytest.fixture
def directions(rng):
    """Of any length, all over the sphere: (500, 3)."""
    return rng.normal(size=(500, 3)).astype(np.float32)
