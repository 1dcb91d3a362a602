"""General queries, points and hero wavelengths: operands are broadcast as numpy does."""

import numpy as np
import pytest

import welkin_sky
from conftest import SCENE


def test_conditions_are_broadcast_against_directions(model, directions):
    elevations = np.linspace(0.0, 1.0, 5)
    visibilities = np.array([[30e3], [60e3], [90e3]])
    some = directions[:5]
    got = model.radiance(some, solar_elevation=elevations, visibility=visibilities, albedo=0.5)
    assert got.shape == (3, 5, 24)
    for i in range(3):
        for k in range(5):
            one = model.radiance(
                some[k], solar_elevation=elevations[k], visibility=visibilities[i, 0], albedo=0.5
            )
            assert np.array_equal(got[i, k], one)


def test_one_direction_serves_many_conditions(model):
    elevations = np.radians(np.arange(0.0, 60.0, 5.0))
    got = model.radiance([0.0, 0.0, 1.0], solar_elevation=elevations)
    assert got.shape == (12, 24)
    assert np.all(np.diff(got[:, 11]) > 0)
    skies = [model.sky(solar_elevation=e).radiance([0.0, 0.0, 1.0]) for e in elevations]
    assert np.allclose(got, skies, rtol=1e-4)


def test_all_conditions_may_be_arrays(model, rng, directions):
    low_high = {
        "solar_elevation": (0.0, 1.3),
        "solar_azimuth": (-3.0, 3.0),
        "visibility": (25e3, 120e3),
        "albedo": (0.0, 1.0),
        "altitude": (0.0, 12e3),
    }
    scenes = {name: rng.uniform(*limits, 20) for name, limits in low_high.items()}
    got = model.radiance(directions[:20], **scenes)
    polarised = model.stokes(directions[:20], **scenes)
    for i in range(20):
        scene = {name: values[i] for name, values in scenes.items()}
        sky = model.polarised_sky(**scene)
        assert np.allclose(got[i], sky.radiance(directions[i]), rtol=1e-3, atol=1e-7)
        expected = sky.stokes(directions[i])
        assert np.allclose(polarised[i], expected, rtol=1e-3, atol=1e-4 * expected[0].max())


def test_spectra_and_bands_under_any_conditions(model, directions):
    scenes = {"solar_elevation": np.linspace(0.0, 1.0, 4), "visibility": 40e3}
    at = [330.0, 550.0, 762.0, 939.0]
    bands = model.bands([450.0, welkin_sky.Response.table([600.0, 650.0, 700.0], [0.0, 1.0, 0.0])])
    some = directions[:4]
    spectra = model.radiance_at(some, at, **scenes)
    values = model.band_radiance(some, bands, **scenes)
    assert spectra.shape == (4, 4) and values.shape == (4, 2)
    for i, elevation in enumerate(scenes["solar_elevation"]):
        scene = {**scenes, "solar_elevation": elevation}
        assert np.allclose(spectra[i], model.sky(**scene).radiance_at(some[i], at), rtol=1e-3)
        assert np.allclose(values[i], model.band_sky(bands, **scene).radiance(some[i]), rtol=2e-3)
        for k, wavelength in enumerate(at):
            assert np.array_equal(spectra[i, k], model.radiance_at(some[i], wavelength, **scene)[0])


def test_defaults_and_objects_are_taken(model, directions):
    conditions = welkin_sky.Conditions(**SCENE)
    expected = model.radiance(directions, **SCENE)
    assert np.array_equal(model.radiance(directions, conditions), expected)
    changed = model.radiance(directions, conditions, albedo=0.9)
    assert np.all(changed >= expected)
    assert np.array_equal(changed, model.radiance(directions, **{**SCENE, "albedo": 0.9}))
    assert np.array_equal(model.radiance(directions), model.radiance(directions, welkin_sky.Conditions()))


def test_what_does_not_broadcast_is_refused(model, directions):
    with pytest.raises(welkin_sky.LengthError, match=r"albedo \(4,\), directions \(5,\)"):
        model.radiance(directions[:5], albedo=np.zeros(4))
    with pytest.raises(welkin_sky.LengthError, match=r"start \(4,\), end \(5,\)"):
        model.transmittance(40e3).between(np.zeros((4, 3)), np.zeros((5, 3)))


def test_bad_conditions_name_the_parameter(model, directions):
    for name, bad in {
        "solar_elevation": -1.0,
        "solar_azimuth": np.inf,
        "visibility": np.nan,
        "albedo": 1.5,
        "altitude": 1e6,
    }.items():
        values = np.full(500, SCENE[name])
        values[300] = bad
        with pytest.raises(welkin_sky.RangeError) as refused:
            model.radiance(directions, **{**SCENE, name: values})
        assert refused.value.parameter == name
        with pytest.raises(welkin_sky.RangeError) as refused:
            model.radiance(directions, **{**SCENE, name: bad})
        assert refused.value.parameter == name
    with pytest.raises(TypeError):
        model.radiance(directions, sun_elevation=0.1)


def test_no_conditions_at_all(model):
    assert model.radiance(np.zeros((0, 3)), albedo=np.zeros(0)).shape == (0, 24)
    assert model.radiance([0, 0, 1], albedo=np.zeros((3, 0))).shape == (3, 0, 24)


def test_starts_and_ends_are_broadcast(model, rng):
    starts = rng.uniform(0, 3000.0, (4, 1, 3))
    ends = rng.uniform(0, 30e3, (5, 3))
    air = model.transmittance(40e3)
    got = air.between(starts, ends)
    assert got.shape == (4, 5, 24)
    assert np.array_equal(got[2, 3], air.between(starts[2, 0], ends[3]))
    aerial = model.aerial_perspective(**SCENE)
    light, factors = aerial.in_scattering(starts, ends)
    one_light, one_factors = aerial.in_scattering(starts[1, 0], ends[4])
    assert np.array_equal(light[1, 4], one_light) and np.array_equal(factors[1, 4], one_factors)


def test_hero_wavelengths_are_broadcast(sky, rng, directions):
    baked = sky.bake()
    four = rng.uniform(380.0, 720.0, (500, 4)).astype(np.float32)
    got = baked.hero(directions, four)
    assert got.shape == (500, 4)
    for i in (0, 123, 499):
        assert np.array_equal(got[i], baked.radiance_at(directions[i], four[i]))
    same = baked.hero(directions, four[0])
    assert np.array_equal(same, baked.radiance_at(directions, four[0]))
    many = baked.hero(directions[0], four)
    assert np.array_equal(many[7], baked.hero(directions[0], four[7]))
