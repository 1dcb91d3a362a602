"""Stages as OpenUSD opens them: prims, attributes, and where the lights are."""

import math
import tempfile
import unittest
from pathlib import Path

import numpy as np
from pxr import Gf, Usd, UsdGeom, UsdLux, UsdValidation

from exported import export, light, pixels, sky, sun

SUNS = [(25.0, 40.0), (3.0, -170.0), (70.0, 200.0)]
AXES = [("usd", "z"), ("usd", "y"), ("karma", "y"), ("karma", "z")]


def to_world(prim: Usd.Prim, direction: np.ndarray) -> np.ndarray:
    """A direction of a prim in the axes of the stage."""
    matrix = UsdGeom.Xformable(prim).ComputeLocalToWorldTransform(Usd.TimeCode.Default())
    return np.array(matrix.TransformDir(Gf.Vec3d(*map(float, direction))))


def lat_long(row: float, column: float, shape: tuple[int, ...]) -> np.ndarray:
    """The direction of a pixel as OpenEXR has it: +y up, longitudes from +z to +x, +π at the left edge."""
    latitude = math.pi * (0.5 - (row + 0.5) / shape[0])
    longitude = math.pi * (1.0 - 2.0 * (column + 0.5) / shape[1])
    level = math.cos(latitude)
    return np.array([level * math.sin(longitude), math.sin(latitude), level * math.cos(longitude)])


def brightest(map: np.ndarray) -> np.ndarray:
    """The middle of the brightest pixels, each by its light."""
    sum = np.zeros(3)
    for row, column in np.argwhere(map[..., 1] > 0.3 * map[..., 1].max()):
        solid_angle = math.cos(math.pi * (0.5 - (row + 0.5) / map.shape[0]))
        sum += map[row, column, 1] * solid_angle * lat_long(row, column, map.shape)
    return sum / np.linalg.norm(sum)


class Stage(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def open(self, renderer: str, up: str, *options: str) -> Usd.Stage:
        self.layer = export(self.folder, renderer, "--up", up, *options)
        stage = Usd.Stage.Open(str(self.layer))
        self.assertTrue(stage)
        self.assertEqual(UsdGeom.GetStageUpAxis(stage), up.upper())
        self.assertEqual(UsdGeom.GetStageMetersPerUnit(stage), 1.0)
        self.assertEqual(stage.GetDefaultPrim().GetPath(), "/sky")
        return stage

    def test_both_lights_are_valid(self) -> None:
        for renderer, up in AXES:
            stage = self.open(renderer, up, "--size", "16", *sky(*SUNS[0]))
            dome = UsdLux.DomeLight(stage.GetPrimAtPath("/sky/dome"))
            distant = UsdLux.DistantLight(stage.GetPrimAtPath("/sky/sun"))
            lights = [prim for prim in stage.Traverse() if prim.HasAPI(UsdLux.LightAPI)]
            self.assertEqual(lights, [dome.GetPrim(), distant.GetPrim()])
            self.assertEqual(dome.GetTextureFormatAttr().Get(), UsdLux.Tokens.latlong)
            texture = Path(dome.GetTextureFileAttr().Get().resolvedPath)
            self.assertEqual(texture.resolve(), self.layer.with_suffix(".exr").resolve())
            self.assertEqual(pixels(texture).shape, (16, 32, 3))
            self.assertEqual(dome.GetIntensityAttr().Get(), 1.0)
            self.assertEqual(dome.GetExposureAttr().Get(), 0.0)
            # Nothing but what the schemas know.
            for prim in (dome.GetPrim(), distant.GetPrim()):
                for attribute in prim.GetAuthoredAttributes():
                    name = attribute.GetName()
                    known = prim.GetPrimDefinition().GetPropertyNames()
                    self.assertTrue(name in known or name.startswith("xformOp:"), name)
            space = Usd.ColorSpaceAPI(stage.GetDefaultPrim()).GetColorSpaceNameAttr().Get()
            self.assertEqual(space, Gf.ColorSpaceNames.LinearRec709)

    def test_the_dome_stands_as_the_schema_wants_it(self) -> None:
        for renderer, up in AXES:
            stage = self.open(renderer, up, "--size", "16")
            dome = UsdLux.DomeLight(stage.GetPrimAtPath("/sky/dome"))
            before = dome.GetOrderedXformOps()
            # Does nothing where it is oriented already, or where +y is up.
            dome.OrientToStageUpAxis()
            self.assertEqual(dome.GetOrderedXformOps(), before)
            zenith = to_world(dome.GetPrim(), [0, 1, 0])
            np.testing.assert_allclose(zenith, sun(90, 0, up), atol=1e-6)

    def test_a_bright_spot_of_the_map_is_in_the_direction_of_the_sun(self) -> None:
        for renderer, up in AXES:
            for position in SUNS:
                stage = self.open(renderer, up, "--size", "360", "--sun", *sky(*position))
                self.assertFalse(stage.GetPrimAtPath("/sky/sun"))
                dome = stage.GetPrimAtPath("/sky/dome")
                spot = to_world(dome, brightest(pixels(self.layer.with_suffix(".exr"))))
                angle = math.degrees(math.acos(min(1.0, spot @ sun(*position, up))))
                # Half a pixel.
                self.assertLess(angle, 0.25, (renderer, up, position))

    def test_the_sun_shines_from_its_direction_with_its_irradiance(self) -> None:
        for renderer, up in AXES:
            for position in SUNS:
                stage = self.open(renderer, up, "--size", "16", *sky(*position))
                distant = UsdLux.DistantLight(stage.GetPrimAtPath("/sky/sun"))
                from_sun = to_world(distant.GetPrim(), [0, 0, -1])
                np.testing.assert_allclose(-from_sun, sun(*position, up), atol=1e-6)
                described = light(*sky(*position))
                angle = distant.GetAngleAttr().Get()
                self.assertAlmostEqual(angle, described["sun"]["angular_diameter_deg"], 5)
                intensity = distant.GetIntensityAttr().Get() * 2.0 ** distant.GetExposureAttr().Get()
                # The documentation of UsdLuxLightAPI::GetNormalizeAttr.
                if not distant.GetNormalizeAttr().Get():
                    intensity *= math.pi * math.sin(math.radians(angle) / 2) ** 2
                irradiance = intensity * np.array(distant.GetColorAttr().Get())
                expected = described["direct_normal"]["linear_srgb"]
                np.testing.assert_allclose(irradiance, expected, atol=1e-5 * max(expected))

    def test_stages_pass_the_checks_of_the_library(self) -> None:
        for renderer, up in AXES:
            stage = self.open(renderer, up, "--size", "16")
            validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
            self.assertGreater(len(validators), 5)
            errors = UsdValidation.ValidationContext(validators).Validate(stage)
            self.assertEqual([error.GetMessage() for error in errors], [])


if __name__ == "__main__":
    unittest.main()
