"""Pictures that are kept: what a change of them shows is looked at, then WELKIN_BLESS=1 keeps the new ones."""

import os
import pathlib
import unittest

import mitsuba as mi
import numpy as np
from variants import InVariants

FOLDER = pathlib.Path(__file__).parent / "references"
SKIES = {
    "morning": {"solar_elevation": 9.0, "solar_azimuth": 60.0, "visibility": 40e3},
    "dusk": {"solar_elevation": -2.5, "solar_azimuth": 100.0},
    "night": {"solar_elevation": -30.0, "moon_phase": 20.0, "moon_elevation": 35.0, "moon_azimuth": 70.0},
}
SIZE, BLOCK = (32, 24), 8


def street(sky):
    """Towers that stand up to 30 km away, as seen from a hill."""
    up = mi.ScalarTransform4f()
    towers = {
        f"tower_{k}": {
            "type": "cube",
            "to_world": up.translate([-900.0 + 700.0 * k, 900.0 * 2.0**k, 150.0]).scale([80.0 * 1.6**k, 80.0, 150.0 * 1.4**k]),
            "bsdf": {"type": "diffuse", "reflectance": {"type": "rgb", "value": [0.5, 0.4, 0.3]}},
        }
        for k in range(6)}
    return mi.load_dict({
        "type": "scene",
        "integrator": {"type": "welkin_path", "max_depth": 4},
        "sky": {"type": "welkin", **sky},
        "ground": {
            "type": "disk", "to_world": up.scale([60e3, 60e3, 1]),
            "bsdf": {"type": "diffuse", "reflectance": {"type": "rgb", "value": 0.2}}},
        "sensor": {
            "type": "perspective", "fov": 50, "far_clip": 1e6,
            "to_world": up.look_at([0, -1500, 250], [400, 3000, 200], [0, 0, 1]),
            "film": {"type": "hdrfilm", "width": SIZE[0], "height": SIZE[1], "pixel_format": "rgb"},
        },
        **towers,
    })


class References(InVariants):
    def test_pictures_are_as_they_were(self):
        for variant in self.each("llvm"):
            for name, sky in SKIES.items():
                image = np.array(mi.render(street(sky), spp=512))
                path = FOLDER / f"{name}.npy"
                if os.environ.get("WELKIN_BLESS") and variant == "llvm_ad_rgb":
                    np.save(path, image.astype(np.float32))
                blocks = lambda a: a.reshape(SIZE[1] // BLOCK, BLOCK, SIZE[0] // BLOCK, BLOCK, 3).mean((1, 3))
                kept = blocks(np.load(path))
                error = np.abs(blocks(image) - kept) / kept.max(2, keepdims=True)
                self.assertLess(error.max(), 0.03, f"{name} in {variant}")


if __name__ == "__main__":
    unittest.main()
