"""The same scene under welkin, with and without air between things, Mitsuba's own `sunsky` and a constant sky: seconds and
noise as ratios to `sunsky`. Needs LLVM.

    python compare.py [llvm_ad_rgb] [--quick]
"""

import argparse
import time

import drjit as dr
import mitsuba as mi
import numpy as np

ELEVATION, AZIMUTH = 25.0, 40.0


def scene(sky, integrator, size):
    up = mi.ScalarTransform4f()
    return mi.load_dict({
        "type": "scene",
        "integrator": {"type": integrator, "max_depth": 6},
        "sensor": {
            "type": "perspective", "fov": 60,
            "to_world": up.look_at([0, -6, 2], [0, 0, 1.2], [0, 0, 1]),
            "film": {"type": "hdrfilm", "width": size[0], "height": size[1]},
        },
        "ground": {
            "type": "rectangle", "to_world": up.scale([500, 500, 1]),
            "bsdf": {"type": "diffuse", "reflectance": {"type": "rgb", "value": [0.3, 0.3, 0.3]}},
        },
        "ball": {"type": "sphere", "center": [0, 0, 1], "bsdf": {"type": "diffuse"}},
        "mirror": {"type": "sphere", "center": [2.2, 0, 1], "bsdf": {"type": "conductor"}},
        "sky": sky,
    })


def measure(prepared, passes, samples):
    """Seconds of the fastest pass, and the median over pixels of the deviation between passes over the mean."""
    dr.eval(mi.render(prepared, spp=samples))
    times, images = [], []
    for seed in range(passes):
        dr.sync_thread()
        start = time.perf_counter()
        image = mi.render(prepared, spp=samples, seed=seed + 1)
        dr.eval(image)
        dr.sync_thread()
        times.append(time.perf_counter() - start)
        images.append(np.array(image)[:, :, 1])
    images = np.array(images)
    # Of most pixels: in those where a mirror shows the disc, no path tracer draws it.
    return min(times), np.median(np.sqrt(images.var(0, ddof=1)) / np.maximum(images.mean(0), 1e-9))


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("variant", nargs="?", default="llvm_ad_rgb")
    arguments.add_argument("--quick", action="store_true")
    given = arguments.parse_args()
    mi.set_variant(given.variant)
    mi.set_log_level(mi.LogLevel.Error)
    import mitsuba_welkin

    mitsuba_welkin.register()
    e, a = np.radians([ELEVATION, AZIMUTH])
    sun = [float(np.cos(e) * np.cos(a)), float(np.cos(e) * np.sin(a)), float(np.sin(e))]
    welkin = {"type": "welkin", "solar_elevation": ELEVATION, "solar_azimuth": AZIMUTH}
    cases = {
        "sunsky": ({"type": "sunsky", "sun_direction": sun}, "path"),
        "constant": ({"type": "constant"}, "path"),
        "welkin": (welkin, "path"),
        "welkin with air": (welkin, "welkin_path"),
    }
    size, passes = ((128, 96), 2) if given.quick else ((512, 384), 6)
    results = {name: measure(scene(*case, size), passes, 32) for name, case in cases.items()}
    seconds, noise = results["sunsky"]
    print(f"{given.variant}, {size[0]} × {size[1]}, 32 samples; sunsky takes {seconds:.3f} s")
    for name, (time_, noise_) in results.items():
        equal = time_ / seconds * (noise_ / noise) ** 2
        print(f"{name:16} time {time_ / seconds:5.2f}, noise {noise_ / noise:5.2f}, time for equal noise {equal:5.2f}")


if __name__ == "__main__":
    main()
