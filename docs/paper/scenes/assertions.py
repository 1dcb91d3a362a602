"""What must hold in the drafts of a folder: `python assertions.py FOLDER` after figures with --draft and --arrays."""

import os
import sys

import numpy as np
from PIL import Image

from development import luminance

# Pictures of each figure, and their size in drafts.
PICTURES = {
    "figure_01": (["mountains_2", "mountains_15", "city_before", "city_after"], (192, 108)),
    "figure_03": (["full", "no_in_scattering", "no_air", "no_altitude"], (192, 108)),
    "figure_14": (["20", "2", "minus_1"], (3 * 75 + 2 * 4, 50)),
    "figure_15": (["polarising", "plain", "difference", "degree", "filter_across", "filter_upright"], (160, 120)),
}


def holds(what, value, condition):
    print(f"{'ok   ' if condition else 'WRONG'} {what}: {value}")
    return bool(condition)


def files(folder):
    for figure, (names, size) in PICTURES.items():
        for name in names:
            image = Image.open(os.path.join(folder, f"{figure}_{name}.png"))
            pixels = np.asarray(image)
            good = image.size == size and pixels.mean() > 8 and pixels.std() > 4
            yield holds(f"{figure}_{name}.png is a picture", f"{image.size}, mean {pixels.mean():.0f}", good)


def arrays(folder, figure):
    with np.load(os.path.join(folder, f"{figure}.npz")) as file:
        return {name: file[name] for name in file.files}


def finite(folder):
    for figure in PICTURES:
        for name, values in arrays(folder, figure).items():
            yield holds(f"{figure}, {name} is finite", f"{values.min():.3g} to {values.max():.3g}",
                        np.isfinite(values).all())


def warmth(rgb):
    red, _, blue = rgb.reshape(-1, 3).mean(0)
    return red / blue


def figure_01(a):
    light = {name: luminance(picture).mean() for name, picture in a.items()}
    ratio = light["mountains_15"] / light["mountains_2"]
    yield holds("mountains are brighter under the higher sun", f"{ratio:.2f} times", ratio > 1.5)
    ratio = light["city_before"] / light["city_after"]
    yield holds("the city is darker after sunset", f"{ratio:.0f} times", ratio > 20.0)
    after = a["city_after"]
    ratio = warmth(after[30:38]) / warmth(after[:8])
    yield holds("after sunset the horizon is redder than what is above", f"{ratio:.2f} times", ratio > 1.2)


def figure_03(a):
    # The horizon is 2.87° down, 4.1° above the middle of 108 rows over 28°.
    sky, far, near = slice(0, 30), slice(44, 54), slice(80, 108)
    light = lambda name, rows: luminance(a[name][rows]).mean()
    ratio = light("full", far) / light("no_in_scattering", far)
    yield holds("far mountains are brighter with in-scattering", f"{ratio:.1f} times", ratio > 2.0)
    gain = light("full", near) / light("no_in_scattering", near)
    yield holds("more so than near ones", f"{gain:.1f} times", 1.0 < gain < ratio)
    lost = light("no_in_scattering", far) / light("no_air", far)
    yield holds("air takes light away from far mountains", f"{lost:.2f} is left", lost < 0.9)
    kept = light("no_in_scattering", near) / light("no_air", near)
    yield holds("less from near ones", f"{kept:.2f} is left", lost < kept < 1.0)
    bluer = warmth(a["no_air"][far]) / warmth(a["no_in_scattering"][far])
    yield holds("attenuation alone makes far mountains redder", f"{bluer:.2f}", bluer < 1.0)
    bluer = warmth(a["no_in_scattering"][far]) / warmth(a["full"][far])
    yield holds("in-scattering makes far mountains bluer", f"{bluer:.2f}", bluer > 1.0)
    apart = abs(light("full", sky) / light("no_air", sky) - 1.0)
    yield holds("the sky is the same with and without air in front of things", f"{apart:.1e}", apart < 1e-3)
    ground = light("no_altitude", sky) / light("full", sky)
    yield holds("a sky of the ground is another one", f"{ground:.2f} times", abs(ground - 1.0) > 0.2)


def figure_14(a):
    solid = a["solid"]
    for elevation in ("20", "2", "-1"):
        model, truth, error = (a[f"{kind}_{elevation}"] for kind in ("model", "truth", "error"))
        for what, where in (("sky", solid == 0.0), ("things", solid == 1.0)):
            mean = luminance(truth)[where].mean()
            apart = luminance(model)[where].mean() / mean - 1.0
            # Of the mean of blocks that are independent; 4 % are the model's, which lights air in the shadow of towers.
            noise = np.sqrt((error[where] ** 2).sum()) / where.sum() / mean
            yield holds(f"sun at {elevation}°, {what}: model and path tracer agree",
                        f"{apart:+.2%}, noise {noise:.2%}", abs(apart) < 0.04 + 3.0 * noise)


def figure_15(a):
    light = lambda name: luminance(a[name][..., 0, :])
    linear = lambda name: np.hypot(*(luminance(a[name][..., k, :]) for k in (1, 2))) / np.maximum(light(name), 1e-9)
    relative = light("polarised") / np.maximum(light("plain"), 1e-9) - 1.0
    sky = (slice(0, 12), slice(0, 12))
    apart = np.abs(relative[sky]).max()
    yield holds("the sky itself is as bright", f"{apart:.1e}", apart < 1e-3)
    degree = linear("polarised")[sky].mean()
    yield holds("and polarised", f"{degree:.2f}", degree > 0.1)
    degree = linear("plain")[sky].max()
    yield holds("or not", f"{degree:.1e}", degree < 1e-4)
    share = np.mean(np.abs(relative) > 0.03)
    yield holds("what is mirrored is brighter or darker by 3 %", f"{share:.0%} of pixels", share > 0.1)
    degree = np.quantile(linear("plain"), 0.99)
    yield holds("glass polarises light that was not", f"{degree:.2f}", degree > 0.3)
    intensity, q = (luminance(a["plain"][105:, 60:100, k]).mean() for k in (0, 1))
    ratio = (intensity + q) / (intensity - q)
    yield holds("water mirrors horizontal vibrations", f"{ratio:.2f} times the vertical ones", ratio > 1.2)


def main():
    folder = sys.argv[1]
    results = [*files(folder), *finite(folder)]
    for figure in (figure_01, figure_03, figure_14, figure_15):
        results += figure(arrays(folder, figure.__name__))
    print(f"{sum(results)} of {len(results)} hold")
    sys.exit(not all(results))


if __name__ == "__main__":
    main()
