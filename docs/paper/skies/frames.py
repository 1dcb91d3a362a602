"""Figure 10: Stokes components in the standard and in sun-aligned frames."""

import colorsys

import numpy as np

from . import panels, stokes, views
from .ask import GREEN, Air, Scene

SUN = np.radians(20.0)
LIMIT = 0.8
FRAMES = {"standard": "#178a2c", "sun-aligned": "#1f50c8"}


def make(commands, pick):
    view = views.up(pick(36, 90, 180))
    light = commands.trace(Air(), [Scene(SUN)], view.lines, GREEN, pick(64, 256, 768))[0]
    q, u = (np.ravel(part / light.radiance) for part in (light.q, light.u))
    components = {"standard": (q, u), "sun-aligned": stokes.aligned(q, u, view.lines, SUN)}
    figure, axes = panels.sheet(2, 4, (2.0, 2.0))
    panels.titles(axes, ["frames", "Q/I", "U/I", "orientation and degree"])
    panels.row_labels(axes, [*FRAMES])
    facts = {}
    for row, (name, (q, u)) in zip(axes, components.items()):
        _draw_frames(row[0], name)
        # Mirrored at the plane through sun and zenith, Q stays and U changes its sign.
        whole = [whole_disc(view.picture(part), sign) for part, sign in [(q, 1), (u, -1)]]
        for axis, part in zip(row[1:], whole):
            scale = panels.show_signed(axis, part, LIMIT)
            panels.scale_bar(figure, axis, scale, "")
        panels.show(row[3], orientation(*whole), np.isfinite(whole[0]))
        facts[f"rms of Q/I, {name}"], facts[f"rms of U/I, {name}"] = (float(np.sqrt(np.mean(p**2))) for p in (q, u))
        facts[f"largest U/I, {name}"] = float(np.abs(u).max())
    facts["median standard error of I, %"] = float(100 * np.median(light.error / light.radiance))
    return figure, facts


def whole_disc(half, sign):
    return np.concatenate([half, sign * half[::-1]])


def orientation(q, u):
    """Hue for the angle of polarisation in the frame, brightness for its degree."""
    hue = np.nan_to_num(np.arctan2(u, q) / (2 * np.pi)) % 1
    value = np.clip(np.nan_to_num(np.hypot(q, u)), 0, 1) ** 0.7
    wheel = np.array([colorsys.hsv_to_rgb(h / 255, 1, 1) for h in range(256)])
    return wheel[np.minimum((hue * 256).astype(int), 255)] * value[..., None]


def _draw_frames(axis, name):
    """Where Q is largest, with a thick line, and where it is least, with a thin one."""
    axis.set_aspect("equal")
    axis.set_xlim(-1, 1)
    axis.set_ylim(-1, 1)
    turn = np.linspace(0, 2 * np.pi, 200)
    axis.plot(np.cos(turn), np.sin(turn), color="0.7", linewidth=0.8)
    sun = (np.pi / 2 - SUN) / (np.pi / 2)
    axis.plot([sun], [0], "o", color="orange", markersize=5)
    places = [(r, a) for r, n in [(0.3, 6), (0.62, 12), (0.92, 18)] for a in 2 * np.pi * (np.arange(n) + 0.25) / n]
    radius, azimuth = np.array(places).T
    zenith = radius * np.pi / 2
    lines = np.stack([np.sin(zenith) * np.cos(azimuth), np.sin(zenith) * np.sin(azimuth), np.cos(zenith)], -1)
    first = stokes.standard_axes(lines)[0] if name == "standard" else stokes.aligned_axis(lines, SUN)
    for vector, width in [(first, 1.8), (np.cross(lines, first), 0.6)]:
        start, end = _flat(lines), _flat(lines + 1e-4 * vector)
        step = end - start
        step *= 0.075 / np.linalg.norm(step, axis=-1, keepdims=True)
        ends = np.stack([start - step, start + step])
        axis.plot(*ends.transpose(2, 0, 1), color=FRAMES[name], linewidth=width)


def _flat(vectors):
    zenith, azimuth = views.angles(vectors)
    return np.stack([np.cos(azimuth), np.sin(azimuth)], -1) * (zenith / (np.pi / 2))[:, None]


def check(facts):
    q, u = facts["rms of Q/I, sun-aligned"], facts["rms of U/I, sun-aligned"]
    assert u < 0.15 * q, f"U is not weak in the sun-aligned frame: {u} against {q}"
    assert facts["rms of U/I, standard"] > 3 * u, "alignment does not help"
