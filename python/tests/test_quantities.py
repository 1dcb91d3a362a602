"""What the quantities are to each other."""

import pickle

import numpy as np
import pytest

import welkin_sky
from conftest import MODEL_FILE, SCENE

trapezoid = getattr(np, "trapezoid", None) or np.trapz


def test_baking_adds_what_it_says(sky, model, polarised, directions):
    exact = sky.radiance(directions)
    baked = sky.bake()
    median, p95, p99, p999, largest = baked.bake_error
    assert 0 < median < p95 <= 2.5e-3 and p95 < p99 < p999 < largest
    off = np.abs(baked.radiance(directions) / exact - 1)
    assert np.percentile(off, 95) <= 2.5e-3
    assert np.array_equal(polarised.bake().stokes(directions)[:, 0], polarised.bake().radiance(directions))
    with pytest.raises(welkin_sky.RangeError) as refused:
        sky.bake(1e-9)
    assert refused.value.parameter == "tolerance"
    bands = model.bands([450.0, 550.0])
    assert model.band_sky(bands, **SCENE).bake().bake_error[1] <= 2.5e-3


def test_colour_spaces_are_matrices(sky, model, baked_colour, directions):
    for one in (sky, model.colour_sky(**SCENE), baked_colour):
        xyz = one.xyz(directions)
        for space in ("srgb", "rec2020", "acescg", "xyz"):
            matrix = np.array(welkin_sky.colour_space_matrix(space))
            got = one.rgb(directions, space)
            assert np.allclose(got, xyz @ matrix.T, rtol=1e-4, atol=1e-5 * xyz.max())
        assert np.array_equal(one.rgb(directions), one.rgb(directions, "srgb"))
        with pytest.raises(welkin_sky.InvalidValueError):
            one.rgb(directions, "p3")


def test_radiance_at_nodes_is_that_of_the_nodes_without_absorption(sky, directions):
    at = [380.0, 430.0, 470.0, 510.0]
    nodes = np.isin(sky.wavelengths, at)
    got, expected = sky.radiance_at(directions, at), sky.radiance(directions)[:, nodes]
    assert np.allclose(got, expected, rtol=0.05)
    solar = welkin_sky.default_model().solar_irradiance(at)
    assert np.allclose(sky.relative_radiance_at(directions, at) * solar, got, rtol=1e-6)


def test_turning_the_sun_turns_the_sky(sky, model, polarised, baked_colour, directions):
    cosine, sine = np.cos(0.7), np.sin(0.7)
    turn = np.array([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]])
    turned = directions @ turn.T
    azimuth = SCENE["solar_azimuth"] + 0.7
    for one, ask in (
        (sky, "radiance"),
        (sky.bake(), "radiance"),
        (model.colour_sky(**SCENE), "xyz"),
        (baked_colour, "xyz"),
        (polarised, "stokes"),
        (polarised.bake(), "stokes"),
    ):
        other = one.with_solar_azimuth(azimuth)
        assert other.conditions.solar_azimuth == azimuth
        expected = getattr(one, ask)(directions)
        got = getattr(other, ask)(turned)
        assert np.allclose(got, expected, rtol=2e-3, atol=1e-3 * expected.max())
        assert one.conditions.solar_azimuth == SCENE["solar_azimuth"]
        with pytest.raises(welkin_sky.RangeError):
            one.with_solar_azimuth(np.inf)


def test_stokes_frames(polarised, directions):
    units = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    vertical = polarised.stokes(directions)
    degree = welkin_sky.degree_of_polarisation(vertical)
    assert np.all((degree >= 0) & (degree <= 1 + 1e-6)) and degree.max() > 0.5
    for frame in ("sun_aligned", [0.3, 0.4, 0.5]):
        other = polarised.stokes(directions, frame)
        assert np.allclose(other[:, 0], vertical[:, 0], rtol=1e-5)
        # The angle between the two choices of axes is not defined in every direction, the degree is.
        assert np.allclose(welkin_sky.degree_of_polarisation(other), degree, atol=1e-4)
    # An axis straight up is the vertical frame.
    up = polarised.stokes(directions, [0.0, 0.0, 1.0])
    away = np.abs(units[:, 2]) < 0.99
    assert np.allclose(up[away], vertical[away], rtol=1e-3, atol=1e-4 * vertical.max())
    with pytest.raises(welkin_sky.DirectionError):
        polarised.stokes(directions, [0.0, 0.0, 0.0])
    with pytest.raises(welkin_sky.LengthError):
        polarised.stokes(directions, [0.0, 1.0])
    with pytest.raises(welkin_sky.InvalidValueError):
        polarised.stokes(directions, "horizontal")


def test_polarisers(polarised, directions):
    for wrong in (np.ones((5, 24)), np.ones(3), 1.0, np.ones((3, 4, 3))):
        for ask in (welkin_sky.degree_of_polarisation, welkin_sky.angle_of_polarisation):
            with pytest.raises(welkin_sky.LengthError, match="stokes"):
                ask(wrong)
    stokes = polarised.stokes(directions)
    angle = welkin_sky.angle_of_polarisation(stokes)
    across = welkin_sky.through_polariser(stokes, 0.4)
    assert np.allclose(across + welkin_sky.through_polariser(stokes, 0.4 + np.pi / 2), stokes[:, 0])
    assert np.all(np.abs(angle) <= np.pi / 2 + 1e-6)
    k = np.unravel_index(np.argmax(welkin_sky.degree_of_polarisation(stokes)), angle.shape)
    least = welkin_sky.through_polariser(stokes, angle[k] + np.pi / 2)[k]
    i, q, u = stokes[k[0], :, k[1]]
    assert np.isclose(least, (i - np.hypot(q, u)) / 2, rtol=1e-4)


def test_sampling_is_a_density(model, baked_colour, rng):
    disc = model.solar_disc(**SCENE)
    grid = welkin_sky.lat_long(256)
    assert abs((baked_colour.sampler().pdf(grid.directions) * grid.solid_angle).sum() - 1) < 0.01
    sampler = baked_colour.sampler(disc)
    drawn = sampler.sample(rng.random((40_000, 2), dtype=np.float32))
    assert drawn.is_sun.dtype == bool and 0.05 < drawn.is_sun.mean() < 0.95
    assert np.allclose(np.linalg.norm(drawn.directions, axis=1), 1, atol=1e-6)
    assert np.allclose(sampler.pdf(drawn.directions), drawn.pdf, rtol=1e-3)
    assert np.allclose(sampler.xyz(drawn.directions), drawn.xyz, rtol=1e-3)
    # The light of the sky alone, from samples and from pixels.
    sky_only = baked_colour.sampler().sample(rng.random((40_000, 2), dtype=np.float32))
    expected = (baked_colour.xyz(grid.directions)[..., 1] * grid.solid_angle).sum()
    assert abs((sky_only.xyz[:, 1] / sky_only.pdf).mean() / expected - 1) < 0.02
    assert sampler.sample(np.zeros((0, 2))).pdf.shape == (0,)
    assert sampler.sample([0.5, 0.5]).directions.shape == (3,)
    for bad in ([0.5, 1.5], [np.nan, 0.5]):
        with pytest.raises(welkin_sky.RangeError):
            sampler.sample(bad)


def test_irradiance_is_an_integral(sky, model):
    grid = welkin_sky.lat_long(128)
    cosine = np.maximum(grid.directions[..., 2], 0) * grid.solid_angle
    baked = sky.bake()
    expected = np.einsum("rc,rcw->w", cosine, baked.radiance(grid.directions))
    assert np.allclose(baked.irradiance([0, 0, 1]), expected, rtol=0.01)
    disc = model.solar_disc(**SCENE)
    towards = np.array(disc.direction)
    mean = disc.irradiance(towards) / disc.solid_angle
    assert np.all(disc.radiance(towards) > mean) and np.all(mean > 0)
    assert np.all(disc.radiance(-towards) == 0)


def test_transmittance_multiplies(model, rng):
    air = model.transmittance(60e3)
    start, end = rng.uniform(0, 5e3, (2, 30, 3))
    middle = (start + end) / 2
    whole = air.between(start, end)
    assert np.allclose(whole, air.between(start, middle) * air.between(middle, end), rtol=1e-4)
    assert np.allclose(whole, np.exp(-air.optical_depth(start, end)), rtol=1e-4)
    assert np.allclose(whole, air.between(end, start), rtol=1e-4)
    assert np.all(air.between(start, start) == 1)
    assert np.all(air.to_space([0, 0, 10.0], [0, 0, -1.0]) == 0)
    assert np.all(air.to_end([0, 0, 10.0], [0, 0, -1.0]) > 0)
    assert np.all(air.to_space_at([0, 0, 0], [0, 0, 1.0], [400.0, 700.0]) < 1)
    with pytest.raises(welkin_sky.PointError):
        air.between([0, 0, np.nan], [0, 0, 1])
    with pytest.raises(welkin_sky.DirectionError):
        air.to_space([0, 0, 1], [0, 0, 0])


def test_aerial_perspective(model, rng):
    aerial = model.aerial_perspective(**SCENE)
    colour = model.colour_aerial_perspective(**SCENE)
    camera = [0.0, 0.0, 800.0]
    points = rng.uniform(-20e3, 20e3, (600, 3)) * [1, 1, 0.05] + [0, 0, 1000.0]
    light, factors = aerial.in_scattering(camera, points)
    assert np.array_equal(light, aerial.in_scattering(camera, points, threads=1)[0])
    assert np.allclose(factors, aerial.transmittance.between(camera, points), rtol=1e-4)
    for space in ("srgb", "acescg"):
        one, passed = aerial.rgb(camera, points, space)
        other, _ = colour.rgb(camera, points, space)
        assert np.allclose(one, other, rtol=0.02, atol=0.01 * one.max())
        assert passed.shape == (600, 3)
    stokes, _ = aerial.linear_srgb_stokes(camera, points)
    assert np.allclose(stokes[:, 0], aerial.rgb(camera, points)[0], rtol=1e-3, atol=1e-3 * stokes.max())
    at = aerial.in_scattering_at(camera, points[:3], [450.0, 550.0])
    assert at.shape == (3, 2) and np.all(at > 0)
    along, _ = aerial.in_scattering_along(camera, [1, 0, 0], [1e3, 5e3, 20e3])
    assert along.shape == (3, 24) and np.all(np.diff(along, axis=0) > 0)
    end, _ = aerial.to_end(camera, [1.0, 0.0, 0.3])
    sky = model.sky(**{**SCENE, "altitude": 800.0})
    assert np.allclose(end[9:], sky.radiance([1.0, 0.0, 0.3])[9:], rtol=0.1)
    with pytest.raises(welkin_sky.RangeError):
        aerial.in_scattering_along(camera, [1, 0, 0], [5e3, 1e3])
    with pytest.raises(welkin_sky.PointError):
        # On the ground, half a radian around the planet.
        aerial.in_scattering(camera, [3.05e6, 0.0, -0.78e6])


def test_far_things_vanish_in_the_sky(model):
    sky = model.sky(**SCENE)
    joined = model.aerial_perspective(**SCENE).joined_to(sky)
    direction = np.array([0.8, 0.3, 0.5])
    assert np.allclose(joined.camera, [0, 0, SCENE["altitude"]])
    light, factors = joined.in_scattering(np.array(joined.camera) + direction * 1e6)
    assert np.allclose(light, sky.radiance(direction), rtol=1e-4)
    rgb, _ = joined.rgb(np.array(joined.camera) + direction * 1e6)
    assert np.allclose(rgb, sky.rgb(direction), rtol=1e-3)
    with pytest.raises(welkin_sky.RangeError):
        model.aerial_perspective(**SCENE).joined_to(model.sky())
    with pytest.raises(welkin_sky.InvalidValueError):
        joined.rgb([0, 0, 2e3], "acescg")


def test_volumes(model):
    colour = model.colour_aerial_perspective(**SCENE)
    camera = dict(camera=[0, 0, 500.0], axis=[1.0, 0, 0], right=[0, -1.0, 0], up=[0, 0, 0.5])
    depths = [1e3, 5e3, 20e3]
    light, factors = colour.linear_srgb_volume(**camera, size=(12, 8), depths=depths)
    assert light.shape == factors.shape == (8, 12, 3, 3)
    again, _ = colour.linear_srgb_volume(**camera, size=(12, 8), depths=depths, threads=1)
    assert np.array_equal(light, again)
    # The first ray is marched: row 0, column 0.
    ray = np.array([1.0, 1.0 - 1.0 / 12, 0.5 * (1 - 1.0 / 8)])
    steps = np.array(depths) * np.linalg.norm(ray)
    marched, _ = colour.linear_srgb_along([0, 0, 500.0], ray, steps)
    assert np.allclose(light[0, 0], marched, rtol=0.02)
    assert colour.linear_srgb_volume(**camera, size=(0, 8), depths=depths)[0].shape == (8, 0, 3, 3)


def test_sun_course(model, directions):
    course = model.sun_course((0.0, 0.1), albedo=0.4, visibility=50e3)
    assert np.allclose(course.elevations, (0.0, 0.1)) and course.skies > 1
    sky = course.at(0.05, 0.3)
    # For an observer on the ground there is no light from below.
    directions = np.abs(directions)
    exact = model.colour_sky(solar_elevation=0.05, solar_azimuth=0.3, albedo=0.4, visibility=50e3)
    off = np.abs(sky.xyz(directions) / exact.xyz(directions) - 1)
    assert np.percentile(off, 95) < 5e-3
    with pytest.raises(welkin_sky.RangeError):
        course.at(0.2)


def test_the_next_frame(model, baked_colour, directions):
    moved = model.colour_sky(**{**SCENE, "solar_elevation": 0.301})
    off = moved.bake_like(baked_colour).xyz(directions) / moved.xyz(directions) - 1
    assert np.percentile(np.abs(off), 95) < 5e-3


def test_bands(model, sky, directions):
    wavelengths = np.linspace(500.0, 600.0, 11)
    values = np.minimum(np.arange(11), np.arange(11)[::-1]) / 5
    curve = welkin_sky.Response.table(wavelengths, values)
    assert np.isclose(curve.integral, trapezoid(values, wavelengths))
    assert curve.range == (500.0, 600.0)
    bands = model.bands([curve, curve.normalised(), welkin_sky.Response.wavelength(450.0), 650])
    assert len(bands) == 4 and len(bands.residuals) == 4 and bands.nodes.size > 1
    got = model.band_sky(bands, **SCENE).radiance(directions)
    fine = np.linspace(500.0, 600.0, 501)
    weights = np.interp(fine, wavelengths, values)
    expected = trapezoid(sky.radiance_at(directions, fine) * weights, fine)
    assert np.percentile(np.abs(got[:, 0] / expected - 1), 95) < 0.01
    assert np.allclose(got[:, 1] * curve.integral, got[:, 0], rtol=1e-5)
    assert np.percentile(np.abs(got[:, 2:] / sky.radiance_at(directions, [450.0, 650.0]) - 1), 95) < 0.01
    projected = bands.project(sky.relative_radiance(directions))
    assert np.allclose(projected, got, rtol=1e-3, atol=1e-6)
    air = model.band_transmittance(47e3, bands)
    assert np.allclose(air.between([0, 0, 0], [0, 0, 0]), 1)
    aerial = model.band_aerial_perspective(bands, **SCENE)
    light, factors = aerial.in_scattering([0, 0, 10.0], [5e3, 0, 10.0])
    assert light.shape == factors.shape == (4,) and np.all(light > 0) and np.all(factors < 1)
    with pytest.raises(welkin_sky.LengthError):
        bands.project(np.zeros((2, 3)))
    with pytest.raises(welkin_sky.LengthError):
        bands.project(np.zeros((2, 0)))
    for bad in ([], [curve, 5000.0]):
        with pytest.raises(welkin_sky.WelkinError):
            model.bands(bad)
    for bad in (["red"], 3, [None]):
        with pytest.raises(TypeError):
            model.bands(bad)
    with pytest.raises(welkin_sky.InvalidValueError):
        welkin_sky.Response.table([500.0, 400.0], [1.0, 1.0])
    with pytest.raises(welkin_sky.LengthError):
        welkin_sky.Response.table([500.0, 600.0], [1.0])


def test_moonlight(model, directions):
    moon = welkin_sky.Moon(elevation=0.8, azimuth=2.0)
    assert moon.direction[2] == pytest.approx(np.sin(0.8))
    night = welkin_sky.Conditions(solar_elevation=-0.6)
    both = model.sky_with_moon(moon, night)
    moonlit = model.moonlit(moon).sky(moon.conditions(welkin_sky.Conditions()))
    assert both.parts == 1
    assert np.allclose(both.xyz(directions), moonlit.xyz(directions), rtol=1e-5)
    assert np.array_equal(both.rgb(directions, "xyz"), both.xyz(directions))
    by_moon, conditions = model.moonlit(moon), moon.conditions(welkin_sky.Conditions())
    up, at = np.abs(directions), [450.0, 555.0]
    assert np.allclose(by_moon.radiance(up, conditions), moonlit.radiance(up), rtol=1e-3)
    assert np.allclose(by_moon.radiance_at(up, at, conditions), moonlit.radiance_at(up, at), rtol=1e-3)
    stokes = by_moon.polarised_sky(conditions).stokes(up)
    room = 1e-3 * stokes[:, :1]
    assert np.all(np.abs(by_moon.stokes(up, conditions) - stokes) <= room)
    day = model.sky_with_moon(moon, **SCENE).radiance(directions)
    assert np.all(day > model.sky(**SCENE).radiance(directions) * 0.999999)
    full = welkin_sky.Moon.phase_angle_between((0, 0, 1), (0, 0, -1))
    assert full < 0.05
    with pytest.raises(welkin_sky.RangeError):
        model.moonlit(welkin_sky.Moon(distance=1.0))
    for bad in ({"elevation": 45.0}, {"elevation": np.nan}, {"azimuth": np.inf}):
        for light in (model.moonlit, model.sky_with_moon):
            with pytest.raises(welkin_sky.RangeError) as refused:
                light(welkin_sky.Moon(**bad))
            assert [refused.value.parameter] == list(bad)
    for twice in (by_moon.moonlit, by_moon.sky_with_moon):
        with pytest.raises(welkin_sky.InvalidValueError, match="moonlit already"):
            twice(moon)


def test_conditions(model):
    assert welkin_sky.Conditions() == model.sky().conditions
    wild = welkin_sky.Conditions(solar_elevation=-1.0, visibility=1.0, albedo=7.0, altitude=1e9)
    tame = model.clamped(wild)
    assert tame.solar_elevation == model.solar_elevation_range[0]
    assert tame.visibility == model.visibility_range[0] and tame.albedo == 1.0
    with pytest.raises(welkin_sky.RangeError):
        model.clamped(welkin_sky.Conditions(visibility=float("nan")))
    scene = welkin_sky.Conditions(**SCENE)
    assert np.allclose(model.sky(scene).sun_direction, scene.sun_direction)
    assert model.sky(scene, albedo=0.1).conditions.albedo == 0.1
    for bad in (3, "noon", {}):
        with pytest.raises(TypeError):
            model.sky(bad)
    with pytest.raises(TypeError, match="albedo must be a real number, got 'white'"):
        model.sky(albedo="white")
    for many in (np.array([0.1, 0.2]), [0.1], (0.1,)):
        with pytest.raises(welkin_sky.LengthError, match="solar_elevation .* model.radiance"):
            model.sky(solar_elevation=many)
    assert model.sky(solar_elevation=np.array(0.1)).conditions.solar_elevation == 0.1


def test_degrees_are_suspected(model):
    for ask in (
        lambda: model.sky(solar_elevation=10.0),
        lambda: model.radiance([0, 0, 1], solar_elevation=np.array([0.1, -6.0])),
        lambda: model.sun_course((10.0, 20.0)),
        lambda: model.plan(solar_elevation=(0.0, 40.0)),
        lambda: model.moonlit(welkin_sky.Moon(elevation=45.0)),
    ):
        with pytest.raises(welkin_sky.RangeError, match="in degrees"):
            ask()
    for elevation in (-0.5, 400.0, np.nan):
        with pytest.raises(welkin_sky.RangeError) as refused:
            model.sky(solar_elevation=elevation)
        assert "degrees" not in str(refused.value)


def test_ranges_are_pairs(model):
    for name, reverse, wide in (
        ("altitude", (1000.0, 0.0), (0.0, 1e9)),
        ("visibility", (60e3, 40e3), (1.0, 60e3)),
        ("solar_elevation", (0.2, 0.1), (-1.0, 0.1)),
    ):
        with pytest.raises(welkin_sky.InvalidValueError, match=name):
            model.plan(**{name: reverse})
        with pytest.raises(welkin_sky.RangeError) as refused:
            model.plan(**{name: wide})
        assert refused.value.parameter == name
        for wrong in (0.1, (0.1,), [[0.1, 0.2]]):
            with pytest.raises(welkin_sky.LengthError, match=name):
                model.plan(**{name: wrong})
    with pytest.raises(welkin_sky.InvalidValueError, match="elevations"):
        model.sun_course((0.2, 0.1))
    with pytest.raises(welkin_sky.RangeError) as refused:
        model.sun_course((0.1, 2.0))
    assert refused.value.parameter == "elevations"


def test_nodes_are_no_spectra_within_absorption_bands(sky, polarised):
    up, nodes = [0.0, 0.0, 1.0], sky.wavelengths
    off = np.abs(sky.radiance(up) / sky.radiance_at(up, nodes) - 1)
    assert off[nodes == 939] > 0.2 and off[nodes < 570].max() < 5e-3
    baked = polarised.bake()
    at = [450.0, 762.0, 939.0, 550.0, 600.0]
    exact = polarised.stokes_at(up, at)
    assert np.allclose(baked.stokes_at(up, at), exact, atol=0.02 * exact[0])
    assert np.array_equal(baked.stokes_at(up, at)[:, :4], baked.hero(up, at[:4]))


def test_names_of_colour_spaces_may_have_any_case(sky):
    up = [0.0, 0.0, 1.0]
    for name in ("sRGB", "Rec2020", "ACEScg", "XYZ"):
        assert np.array_equal(sky.rgb(up, name), sky.rgb(up, name.lower()))
        matrix = welkin_sky.colour_space_matrix(name)
        assert np.allclose(matrix @ sky.xyz(up), sky.rgb(up, name), rtol=1e-5, atol=1e-3)
    with pytest.raises(welkin_sky.InvalidValueError, match="Adobe"):
        sky.rgb(up, "Adobe")


def test_grounds_by_wavelength(model, directions):
    wavelengths, albedos = [450.0, 680.0, 750.0], np.array([0.04, 0.05, 0.45])
    meadow = model.over(wavelengths, albedos)
    assert meadow.has_ground and not model.has_ground
    sky = meadow.sky(**SCENE)
    assert sky.conditions.albedo == pytest.approx(0.04 + 0.01 * 100 / 230)
    for at, albedo in ((600.0, 0.04 + 0.01 * 150 / 230), (740.0, 0.05 + 0.4 * 60 / 70)):
        grey = model.sky(**{**SCENE, "albedo": albedo})
        assert np.allclose(sky.radiance_at(directions, at), grey.radiance_at(directions, at), rtol=1e-5)
    heroes = sky.bake().hero(directions, np.full((len(directions), 4), 740.0, np.float32))
    assert np.allclose(heroes[:, :1], sky.radiance_at(directions, [740.0]), rtol=2e-2)
    assert not np.array_equal(sky.xyz(directions), model.sky(**SCENE).xyz(directions))
    assert np.array_equal(sky.xyz(directions), meadow.colour_sky(**SCENE).xyz(directions))
    again = pickle.loads(pickle.dumps(meadow)).sky(**SCENE)
    assert np.array_equal(again.xyz(directions), sky.xyz(directions))
    with pytest.raises(welkin_sky.InvalidValueError, match="ground of its own"):
        meadow.radiance(directions)
    for bad in (([500.0, 400.0], [0.1, 0.2]), ([], [])):
        with pytest.raises(welkin_sky.InvalidValueError):
            model.over(*bad)
    with pytest.raises(welkin_sky.RangeError):
        model.over([400.0, 500.0], [0.1, 1.2])
    with pytest.raises(welkin_sky.LengthError):
        model.over([400.0, 500.0], [0.1])


def test_the_axis_of_a_file(model):
    assert model.axis is None
    file = MODEL_FILE.parents[1] / "format-spec" / "conformance" / "files" / "axis.welkin"
    axis = welkin_sky.open(file).axis
    assert (axis.name, axis.unit, axis.range) == ("ozone", "DU", (100.0, 500.0))
    assert axis.values.tolist() == [500.0, 380.0, 250.0, 100.0]
    middle = axis.visibility(315.0)
    assert np.isclose(1 / middle, 0.5 / 30e3 + 0.5 / 59.4e3, rtol=1e-12)
    assert np.isclose(axis.value(middle), 315.0, rtol=1e-12)
    with pytest.raises(welkin_sky.RangeError, match="ozone must be in 100..=500 DU, got 600 DU") as caught:
        axis.visibility(600.0)
    assert (caught.value.parameter, caught.value.unit) == ("ozone", "DU")
