"""Shapes, dtypes, memory and threads."""

import numpy as np
import pytest

import welkin_sky
from conftest import SCENE


def evaluators(model, sky, polarised, baked_colour):
    """Everything that takes directions, by name."""
    baked, baked_polarised = sky.bake(), polarised.bake()
    disc, colour = model.solar_disc(**SCENE), model.colour_sky(**SCENE)
    bands = model.bands([450.0, 550.0, 650.0])
    band_sky = model.band_sky(bands, **SCENE)
    band_disc = model.band_solar_disc(bands, **SCENE)
    at = [440.0, 550.0, 680.0]
    return {
        "sky.radiance": sky.radiance,
        "sky.relative_radiance": sky.relative_radiance,
        "sky.radiance_at": lambda d, **k: sky.radiance_at(d, at, **k),
        "sky.xyz": sky.xyz,
        "sky.rgb": lambda d, **k: sky.rgb(d, "rec2020", **k),
        "colour.xyz": colour.xyz,
        "colour.rgb": colour.rgb,
        "baked.radiance": baked.radiance,
        "baked.radiance_at": lambda d, **k: baked.radiance_at(d, at, **k),
        "baked.hero": lambda d, **k: baked.hero(d, [400, 500, 600, 700], **k),
        "baked_colour.xyz": baked_colour.xyz,
        "baked_colour.rgb": lambda d, **k: baked_colour.rgb(d, "acescg", **k),
        "polarised.stokes": polarised.stokes,
        "polarised.stokes_at": lambda d, **k: polarised.stokes_at(d, at, **k),
        "baked_polarised.stokes_at": lambda d, **k: baked_polarised.stokes_at(d, at, **k),
        "polarised.xyz_stokes": polarised.xyz_stokes,
        "baked_polarised.stokes": baked_polarised.stokes,
        "baked_polarised.hero": lambda d, **k: baked_polarised.hero(d, [400, 500, 600, 700], **k),
        "disc.radiance": disc.radiance,
        "disc.xyz": disc.xyz,
        "disc.irradiance": disc.irradiance,
        "band_sky.radiance": band_sky.radiance,
        "band_sky.bake.radiance": band_sky.bake().radiance,
        "band_disc.radiance": band_disc.radiance,
        "polarised_band_sky.stokes": model.polarised_band_sky(bands, **SCENE).stokes,
        "sampler.pdf": baked_colour.sampler(disc).pdf,
        "sampler.xyz": baked_colour.sampler(disc).xyz,
        "model.radiance": lambda d, **k: model.radiance(d, **SCENE, **k),
        "model.relative_radiance": lambda d, **k: model.relative_radiance(d, **SCENE, **k),
        "model.radiance_at": lambda d, **k: model.radiance_at(d, at, **SCENE, **k),
        "model.band_radiance": lambda d, **k: model.band_radiance(d, bands, **SCENE, **k),
        "model.stokes": lambda d, **k: model.stokes(d, **SCENE, **k),
        "sky_with_moon.radiance": model.sky_with_moon(welkin_sky.Moon(), **SCENE).radiance,
    }


@pytest.fixture(scope="module")
def all_evaluators(model, sky, polarised, baked_colour):
    return evaluators(model, sky, polarised, baked_colour)


def each(all_evaluators):
    return all_evaluators.items()


def test_threads_do_not_change_a_bit(all_evaluators, rng):
    directions = rng.normal(size=(5000, 3)).astype(np.float32)
    for name, evaluate in each(all_evaluators):
        alone = evaluate(directions, threads=1)
        assert np.array_equal(alone, evaluate(directions, threads=2)), name
        assert np.array_equal(alone, evaluate(directions)), name


def test_a_direction_does_not_depend_on_its_neighbours(all_evaluators, directions):
    for name, evaluate in each(all_evaluators):
        together = evaluate(directions)
        for i in (0, 7, 499):
            assert np.array_equal(evaluate(directions[i]), together[i]), name


def test_leading_shapes_stay(all_evaluators, directions):
    for name, evaluate in each(all_evaluators):
        flat = evaluate(directions[:24])
        assert flat.dtype == np.float32, name
        tail = flat.shape[1:]
        assert evaluate(directions[0]).shape == tail, name
        cube = evaluate(directions[:24].reshape(2, 3, 4, 3))
        assert np.array_equal(cube, flat.reshape(2, 3, 4, *tail)), name


def test_no_directions_give_nothing(all_evaluators):
    for name, evaluate in each(all_evaluators):
        tail = evaluate([0.0, 0.0, 1.0]).shape
        assert evaluate(np.zeros((0, 3))).shape == (0, *tail), name
        assert evaluate(np.zeros((2, 0, 3), np.float32)).shape == (2, 0, *tail), name


def test_layouts_and_dtypes_do_not_matter(sky, directions):
    expected = sky.radiance(directions)
    for other in (
        np.asfortranarray(directions),
        np.repeat(directions, 2, axis=0)[::2],
        directions[::-1][::-1],
        directions.astype(np.float64),
        directions.astype(directions.dtype.newbyteorder()),
        directions.tolist(),
        np.ma.masked_array(directions),
    ):
        assert np.array_equal(sky.radiance(other), expected)
    shifted = np.frombuffer(b"x" + directions.tobytes(), np.uint8)[1:].view(np.float32)
    assert not shifted.flags.aligned
    assert np.array_equal(sky.radiance(shifted.reshape(-1, 3)), expected)
    read_only = directions.copy()
    read_only.flags.writeable = False
    assert np.array_equal(sky.radiance(read_only), expected)
    whole = [[0, 0, 1], [3, 4, 5]]
    for dtype in (np.int8, np.int64, np.uint16, np.float16, np.longdouble):
        assert np.array_equal(sky.radiance(np.array(whole, dtype)), sky.radiance(whole))


def test_length_does_not_matter(sky, directions):
    assert np.allclose(sky.radiance(directions * 1e3), sky.radiance(directions), rtol=1e-5)


def test_bad_directions_are_refused_wherever_they_are(all_evaluators, directions):
    for bad in ([0, 0, 0], [np.nan, 0, 1], [np.inf, 0, 1]):
        for place in (0, 250, 499):
            some = directions.copy()
            some[place] = bad
            for name, evaluate in each(all_evaluators):
                with pytest.raises(welkin_sky.DirectionError) as refused:
                    evaluate(some)
                assert np.array_equal(refused.value.got, bad, equal_nan=True), name


def test_the_first_bad_direction_is_the_one_told(sky, rng):
    directions = rng.normal(size=(20000, 3))
    directions[3000] = [0.0, 0.0, np.inf]
    directions[19000] = [0.0, 0.0, 0.0]
    for threads in (1, 2, 8):
        with pytest.raises(welkin_sky.DirectionError) as refused:
            sky.radiance(directions, threads=threads)
        assert refused.value.got[2] == np.inf


def test_wrong_shapes_are_refused(all_evaluators):
    for name, evaluate in each(all_evaluators):
        for shape in ((3, 2), (4,), (), (3, 0), (3, 1)):
            with pytest.raises(welkin_sky.LengthError):
                evaluate(np.ones(shape))
        for wrong in ("up", None, [1j, 0, 1], object(), {}):
            with pytest.raises(TypeError):
                evaluate(wrong)
        with pytest.raises((ValueError, TypeError)):
            evaluate([[1.0, 2.0, 3.0], [1.0, 2.0]])


def test_wavelengths_are_checked(model, sky, polarised):
    up = [0.0, 0.0, 1.0]
    radiance = (sky.radiance_at, sky.relative_radiance_at, sky.bake().radiance_at)
    for ask in (*radiance, polarised.stokes_at, polarised.bake().stokes_at):
        assert ask(up, []).shape[-1] == 0
        assert ask(up, 550).shape[-1] == 1
        for bad in (100.0, np.nan, [550.0, 5000.0]):
            with pytest.raises(welkin_sky.RangeError):
                ask(up, bad)
        with pytest.raises(welkin_sky.LengthError):
            ask(up, [[550.0]])
    with pytest.raises(welkin_sky.RangeError):
        model.solar_irradiance(100.0)


def test_threads_are_checked(sky):
    for bad in (0, 257, -1, 10**30):
        with pytest.raises(welkin_sky.InvalidValueError):
            sky.radiance([0, 0, 1], threads=bad)
    assert sky.radiance([0, 0, 1], threads=np.int64(2)).shape == (24,)
    for bad in (1.5, "two"):
        with pytest.raises(TypeError, match="threads"):
            sky.radiance([0, 0, 1], threads=bad)


def test_contiguous_singles_are_not_copied(sky, monkeypatch):
    """No call of numpy but the one that makes room for the result."""
    directions = np.ones((100, 3), np.float32)
    expected = sky.radiance(directions)

    def refuse(*arguments, **keywords):
        raise AssertionError("a copy")

    for name in ("asarray", "require", "ascontiguousarray", "array"):
        monkeypatch.setattr(np, name, refuse)
    got = sky.radiance(directions)
    monkeypatch.undo()
    assert np.array_equal(got, expected)
    assert got.flags.owndata and got.flags.writeable and got.flags.c_contiguous


def test_too_much_is_a_memory_error(model):
    rows, columns = np.zeros((1 << 22, 1)), np.zeros((1, 1 << 22))
    # The conditions alone would take more than there is.
    with pytest.raises(MemoryError):
        model.radiance([0, 0, 1], albedo=rows, altitude=columns)
