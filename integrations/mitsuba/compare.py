"""The same scene under welkin, Mitsuba's own `sunsky` and a constant sky: seconds and variance. Needs LLVM."""

import sys
import time

import drjit as dr
import mitsuba as mi
import numpy as np

ELEVATION, AZIMUTH = 25.0, 40.0


def scene(sky):
    up = mi.ScalarTransform4f()
    return mi.load_dict({
        "type": "scene",
        "integrator": {"type": "path", "max_depth": 6},
        "sensor": {
            "type": "perspective", "fov": 60,
            "to_world": up.look_at([0, -6, 2], [0, 0, 1.2], [0, 0, 1]),
            "film": {"type": "hdrfilm", "width": 512, "height": 384},
        },
        "ground": {
            "type": "rectangle", "to_world": up.scale([500, 500, 1]),
            "bsdf": {"type": "diffuse", "reflectance": {"type": "rgb", "value": [0.3, 0.3, 0.3]}},
        },
        "ball": {"type": "sphere", "center": [0, 0, 1], "bsdf": {"type": "diffuse"}},
        "mirror": {"type": "sphere", "center": [2.2, 0, 1], "bsdf": {"type": "conductor"}},
        "sky": sky,
    })


def main():
    mi.set_variant(sys.argv[1] if len(sys.argv) > 1 else "llvm_ad_rgb")
    import mitsuba_welkin

    mitsuba_welkin.register()
    e, a = np.radians([ELEVATION, AZIMUTH])
    sun = [float(np.cos(e) * np.cos(a)), float(np.cos(e) * np.sin(a)), float(np.sin(e))]
    skies = {
        "welkin": {"type": "welkin", "solar_elevation": ELEVATION, "solar_azimuth": AZIMUTH},
        "sunsky": {"type": "sunsky", "sun_direction": sun},
        "constant": {"type": "constant"},
    }
    for name, sky in skies.items():
        prepared = scene(sky)
        dr.eval(mi.render(prepared, spp=16))
        times, images = [], []
        for seed in range(4):
            dr.sync_thread()
            start = time.perf_counter()
            image = mi.render(prepared, spp=32, seed=seed + 1)
            dr.eval(image)
            dr.sync_thread()
            times.append(time.perf_counter() - start)
            images.append(np.array(image)[:, :, 1])
        images = np.array(images)
        # Of most pixels: in those where a mirror shows the disc, no path tracer draws it.
        noise = np.median(np.sqrt(images.var(0, ddof=1)) / images.mean(0))
        print(f"{name:10} {min(times):.3f} s, noise {noise:.4f} of a pixel")


if __name__ == "__main__":
    main()
