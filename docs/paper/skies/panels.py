"""Pictures beside each other, with labels."""

import matplotlib
import numpy as np
from PIL import Image

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402

from .ask import replace  # noqa: E402

DPI = 100
LABEL = 9


def sheet(rows, columns, size, left=0.25, gap=0.06):
    """A figure of rows × columns of axes without ticks, each `size` inches wide and high."""
    width, height = size
    total = (left + columns * (width + gap), 0.32 + rows * (height + gap))
    figure = plt.figure(figsize=total, dpi=DPI)
    axes = np.empty((rows, columns), object)
    for row in range(rows):
        for column in range(columns):
            x = left + column * (width + gap)
            y = total[1] - 0.27 - (row + 1) * height - row * gap
            box = [x / total[0], y / total[1], width / total[0], height / total[1]]
            axes[row, column] = figure.add_axes(box)
            axes[row, column].set_axis_off()
    return figure, axes


def titles(axes, texts):
    for axis, text in zip(axes[0], texts):
        axis.set_title(text, fontsize=LABEL, pad=4)


def row_labels(axes, texts):
    for axis, text in zip(axes[:, 0], texts):
        place = {"rotation": 90, "ha": "right", "va": "center", "fontsize": LABEL}
        axis.text(-0.02, 0.5, text, transform=axis.transAxes, **place)


def show(axis, display, seen=None):
    """Shows display values (0..1) where something is seen."""
    if seen is not None:
        display = np.concatenate([display, seen[..., None].astype(float)], -1)
    axis.imshow(np.clip(display, 0, 1), interpolation="bilinear", aspect="auto")


def show_signed(axis, values, limit):
    """Red for positive, blue for negative values, white for 0."""
    image = plt.get_cmap("RdBu_r")(0.5 + 0.5 * np.nan_to_num(values) / limit)
    image[~np.isfinite(values)] = 0
    axis.imshow(image, interpolation="bilinear", aspect="auto")
    return matplotlib.cm.ScalarMappable(matplotlib.colors.Normalize(-limit, limit), "RdBu_r")


def scale_bar(figure, axis, mappable, label):
    """A small scale within the lower corner of a picture."""
    inset = axis.inset_axes([0.02, 0.03, 0.3, 0.035])
    bar = figure.colorbar(mappable, cax=inset, orientation="horizontal")
    low, high = mappable.get_clim()
    bar.set_ticks([low, high], labels=[f"{low:g}", f"{high:g}"])
    bar.ax.tick_params(labelsize=6, length=0, pad=1)
    bar.ax.xaxis.set_ticks_position("top")
    bar.ax.set_xlabel(label, fontsize=6, labelpad=1)


def save(figure, path):
    """Writes a small file: no transparency, no name of a program."""
    figure.canvas.draw()
    image = Image.fromarray(np.asarray(figure.canvas.buffer_rgba())[..., :3].copy())
    replace(path, lambda to: image.save(to, optimize=True))
    plt.close(figure)
