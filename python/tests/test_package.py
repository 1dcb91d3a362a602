"""Documentation, stubs, grids, plots and data sets."""

import copy
import importlib.util
import inspect
import os
import pathlib
import pickle
import subprocess
import sys

import numpy as np
import pytest

import welkin_sky
from conftest import MODEL_FILE, SCENE

ROOM = pathlib.Path(__file__).resolve().parents[1]


def public():
    """All names that users see, with what they stand for."""
    for name in welkin_sky.__all__:
        value = getattr(welkin_sky, name)
        yield name, value
        if inspect.isclass(value):
            for member, inner in vars(value).items():
                if not member.startswith("_"):
                    yield f"{name}.{member}", inner


def test_everything_public_is_documented():
    said_by_fields = {"Conditions", "Moon", "RangeError", "Grid", "Samples"}
    bare = [
        name
        for name, value in public()
        if not (getattr(value, "__doc__", None) or "").strip()
        and name.split(".")[0] not in said_by_fields
        and not name.endswith(".error_class")
    ]
    assert bare == []


def test_results_say_shapes():
    for kind in ("Sky", "BakedSky", "PolarisedSky", "Transmittance", "AerialPerspective"):
        for name, method in vars(getattr(welkin_sky, kind)).items():
            if callable(method) and "directions" in (getattr(method, "__text_signature__", "") or ""):
                assert "→" in method.__doc__ or "as `to_space`" in method.__doc__, f"{kind}.{name}"


def test_signatures_show_conditions():
    shown = inspect.signature(welkin_sky.Model.sky).parameters
    fields = welkin_sky.Conditions.__dataclass_fields__
    assert list(shown) == ["self", "conditions", *fields]


@pytest.mark.skipif(importlib.util.find_spec("mypy") is None, reason="no mypy")
def test_stubs_are_right(tmp_path):
    command = [sys.executable, "-m", "mypy.stubtest", "welkin_sky"]
    package = pathlib.Path(welkin_sky.__file__).resolve().parents[1]
    path = {} if package.name == "site-packages" else {"MYPYPATH": str(package), "PYTHONPATH": str(package)}
    environment = {**os.environ, **path}
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, env=environment)
    assert done.returncode == 0, done.stdout + done.stderr


def test_versions_agree():
    manifest = (ROOM / "Cargo.toml").read_text()
    assert f'\nversion = "{welkin_sky.__version__}"\n' in manifest


def test_error_classes_are_those_of_the_specification():
    kinds = [v for _, v in public() if inspect.isclass(v) and issubclass(v, welkin_sky.WelkinError)]
    assert len({kind.error_class for kind in kinds}) >= 14
    for kind in kinds:
        assert str(kind("what happened", parameter="x")) == "what happened"


def test_fish_eye():
    grid = welkin_sky.fish_eye(64)
    assert grid.directions.shape == (64, 64, 3) and grid.inside.shape == (64, 64)
    assert np.allclose(np.linalg.norm(grid.visible, axis=1), 1, atol=1e-6)
    assert np.isnan(grid.directions[0, 0]).all() and not grid.inside[0, 0]
    assert abs(grid.solid_angle.sum() / (2 * np.pi) - 1) < 0.01
    # +x to the right, +y up.
    assert grid.directions[32, 60, 0] > 0.9 and grid.directions[3, 32, 1] > 0.9
    image = grid.image(grid.visible)
    assert np.array_equal(image, grid.directions, equal_nan=True)
    odd = welkin_sky.fish_eye(33)
    assert np.allclose(odd.directions[16, 16], [0, 0, 1])
    for make, few in ((welkin_sky.fish_eye, 0), (welkin_sky.lat_long, 1)):
        with pytest.raises(welkin_sky.InvalidValueError):
            make(few)
        with pytest.raises(TypeError, match="whole number"):
            make(8.5)


def test_lat_long():
    grid = welkin_sky.lat_long(32)
    assert grid.directions.shape == (32, 64, 3) and grid.inside.all()
    assert np.isclose(grid.solid_angle.sum(), 4 * np.pi)
    assert np.all(grid.directions[0, :, 2] > 0.99)
    # The middle looks along +x, the quarter left of it along +y.
    assert np.all(grid.directions[15, 31:33, 0] > 0.99) and grid.directions[15, 15, 1] > 0.99


def test_exposure():
    grey = np.linspace(0, 1000.0, 50)[:, None] * np.ones(3)
    shown = welkin_sky.expose(grey, white=1000.0)
    assert np.all(np.diff(shown[:, 0]) > 0) and shown[0, 0] == 0 and np.isclose(shown[-1, 0], 1)
    assert np.all(welkin_sky.expose([[-1.0, 2.0, 1e9]]) >= 0)
    assert np.all(welkin_sky.expose(np.zeros((2, 2, 3))) == 0)
    with pytest.raises(ValueError):
        welkin_sky.expose(grey, white=0.0)


def test_plots(model, sky, polarised, baked_colour):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    moonlit = model.sky_with_moon(welkin_sky.Moon(), solar_elevation=-0.5)
    for one in (sky, baked_colour, model.colour_sky(), polarised, moonlit):
        image = one.plot(size=32).images[0].get_array()
        assert image.shape == (32, 32, 3) and np.all((image >= 0) & (image <= 1))
    for one in (sky, sky.bake(), polarised, polarised.bake()):
        values = one.plot(550.0, size=32).images[0].get_array()
        expected = sky.radiance_at([0.03, 0.03, 1.0], 550.0)[0]
        assert np.isclose(values[15, 16], expected, rtol=0.05)
    for one in (polarised, polarised.bake()):
        degree = one.plot(quantity="degree", size=32).images[0].get_array()
        assert 0.4 < np.nanmax(degree) <= 1
    _, ax = plt.subplots()
    assert sky.plot(ax=ax, size=16) is ax
    with pytest.raises(ValueError):
        sky.plot(quantity="beauty")
    for one, wrong in (
        (sky, {"quantity": "degree"}),
        (sky.bake(), {}),
        (baked_colour, {"wavelength": 550.0}),
    ):
        with pytest.raises(TypeError):
            one.plot(**wrong, size=16)
    plt.close("all")


def test_data_sets(model, sky, polarised, baked_colour):
    pytest.importorskip("xarray")
    data = sky.to_xarray([0.1, 0.5], [0.0, 1.0, 2.0])
    assert data.radiance.dims == ("elevation", "azimuth", "wavelength")
    assert data.radiance.shape == (2, 3, 24) and data.radiance.attrs["units"] == "W m-2 sr-1 nm-1"
    direction = [np.cos(0.5) * np.cos(2.0), np.cos(0.5) * np.sin(2.0), np.sin(0.5)]
    expected = sky.radiance_at(direction, sky.wavelengths)
    assert "radiance_at" in data.radiance.attrs["comment"]
    assert np.allclose(data.radiance.sel(elevation=0.5, azimuth=2.0), expected, rtol=1e-5)
    assert np.allclose(data.xyz.sel(primary="Y"), sky.xyz(_towards(data))[..., 1])
    assert data.attrs["visibility"] == SCENE["visibility"]
    at = sky.to_xarray([0.5], [2.0], wavelengths=[450.0, 550.0])
    assert np.allclose(at.radiance[0, 0], sky.radiance_at(direction, [450.0, 550.0]), rtol=1e-5)
    stokes = polarised.to_xarray([0.5], [2.0]).stokes
    assert stokes.dims == ("elevation", "azimuth", "component", "wavelength")
    assert np.allclose(stokes[0, 0].sel(component="I"), expected, rtol=1e-5)
    baked, of_light = (one.bake().to_xarray([0.5], [2.0]) for one in (sky, polarised))
    for spectra in (baked.radiance, of_light.stokes[:, :, 0]):
        assert np.allclose(spectra[0, 0], expected, rtol=0.02)
    assert baked_colour.to_xarray().xyz.shape == (91, 72, 3)
    bands = model.band_sky(model.bands([450.0, 550.0]), **SCENE).to_xarray([0.5], [2.0])
    assert bands.radiance.dims == ("elevation", "azimuth", "band")


def test_what_never_changes_is_its_own_copy(model, sky, tmp_path, monkeypatch):
    curve = welkin_sky.Response.wavelength(550.0)
    bands = model.bands([curve])
    aerial = model.aerial_perspective(**SCENE)
    made = [sky, sky.bake(), bands, curve, aerial, aerial.transmittance, model.solar_disc(), model.plan()]
    for one in (model, *made):
        assert copy.copy(one) is one and copy.deepcopy([one])[0] is one
        assert repr(one).startswith(f"<welkin_sky.{type(one).__name__}: ")
    for one in made:
        with pytest.raises(TypeError, match="pickle"):
            pickle.dumps(one)
    assert "visibility 47 km" in repr(sky) and "550 to 550 nm" in repr(curve)
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(MODEL_FILE.parent)
    pickled = pickle.dumps(welkin_sky.open(MODEL_FILE.name))
    monkeypatch.chdir(tmp_path / "elsewhere")
    assert pickle.loads(pickled).file_bytes == MODEL_FILE.stat().st_size


def _towards(data):
    return welkin_sky.directions(data.elevation.values[:, None], data.azimuth.values)
