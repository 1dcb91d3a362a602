"""From light to PNG: one exposure for all that is compared, sRGB, labels, sheets."""

import os
import tempfile

import numpy as np
from PIL import Image, ImageDraw, ImageFont

LUMINANCE = np.array([0.2126, 0.7152, 0.0722], np.float32)
KNEE = 0.75


def luminance(rgb):
    return rgb[..., :3] @ LUMINANCE


def white_of(picture, share=0.97):
    """The light that becomes display white: that which `share` of the pixels do not reach."""
    return float(np.quantile(picture.max(-1), share))


def display(rgb, white):
    """8-bit sRGB; from three quarters of white on, light is compressed and keeps its hue."""
    rgb = np.maximum(rgb / white, 0.0)
    peak = np.maximum(rgb.max(-1, keepdims=True), 1e-9)
    bent = np.where(peak > KNEE, KNEE + (1.0 - KNEE) * np.tanh((peak - KNEE) / (1.0 - KNEE) * 0.6), peak)
    rgb = np.clip(rgb * (bent / peak), 0.0, 1.0)
    encoded = np.where(rgb <= 0.0031308, 12.92 * rgb, 1.055 * rgb ** (1.0 / 2.4) - 0.055)
    return (255.0 * encoded + 0.5).astype(np.uint8)


def diverging(relative, worst):
    """White where nothing differs, red at +`worst`, blue at −`worst`."""
    t = np.clip(np.nan_to_num(relative / worst), -1.0, 1.0)[..., None]
    red, blue = np.array([0.75, 0.1, 0.1]), np.array([0.1, 0.25, 0.75])
    colour = 1.0 - np.abs(t) * (1.0 - np.where(t > 0.0, red, blue))
    return (255.0 * colour + 0.5).astype(np.uint8)


def ramp(share):
    """Dark to bright for 0 to 1."""
    nodes = np.array([[10, 10, 35], [70, 30, 120], [185, 55, 105], [245, 140, 60], [255, 245, 190]], float)
    t = np.clip(share, 0.0, 1.0)
    channels = [np.interp(t, np.linspace(0.0, 1.0, len(nodes)), nodes[:, c]) for c in range(3)]
    return np.stack(channels, -1).astype(np.uint8)


def labelled(picture, text):
    """A picture (8-bit) with a line of text in its lower left corner."""
    image = Image.fromarray(picture)
    size = max(9, image.height // 28)
    draw, font = ImageDraw.Draw(image), ImageFont.load_default(size)
    at = (size // 2, image.height - 1.6 * size)
    draw.text(at, text, font=font, fill=(255, 255, 255), stroke_width=max(1, size // 9), stroke_fill=(0, 0, 0))
    return np.asarray(image)


def sheet(rows, gap=4):
    """Pictures of one size in rows, on white."""
    height, width = rows[0][0].shape[:2]
    columns = max(len(row) for row in rows)
    page = np.full((len(rows) * (height + gap) - gap, columns * (width + gap) - gap, 3), 255, np.uint8)
    for i, row in enumerate(rows):
        for j, picture in enumerate(row):
            page[i * (height + gap) :, j * (width + gap) :][:height, :width] = picture
    return page


def save(folder, name, picture):
    """Writes a PNG beside its name and renames it, so that there is never half of one."""
    os.makedirs(folder, exist_ok=True)
    handle, path = tempfile.mkstemp(suffix=".png", dir=folder)
    try:
        with os.fdopen(handle, "wb") as file:
            Image.fromarray(picture).save(file, "PNG", optimize=True)
        os.chmod(path, 0o644)
        os.replace(path, os.path.join(folder, name))
    except BaseException:
        os.unlink(path)
        raise
    print(f"{name}: {picture.shape[1]} x {picture.shape[0]}")
