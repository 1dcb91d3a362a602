"""Float images whose pixels are made here."""

import bpy


def float_image(name: str, columns: int, rows: int, colour_space: str) -> bpy.types.Image:
    image = bpy.data.images.new(name, columns, rows, alpha=False, float_buffer=True)
    image.colorspace_settings.name = colour_space
    # Half precision ends at 65504, and the disc is brighter.
    image.use_half_precision = False
    return image


def write(image: bpy.types.Image, pixels) -> None:
    """Float32 pixels (rows, columns, 4), lowest row first; the image is of that size from now on."""
    rows, columns, _ = pixels.shape
    if tuple(image.size) != (columns, rows):
        image.scale(columns, rows)
    image.pixels.foreach_set(pixels.ravel())
    image.update()
