"""Float images whose pixels are made here."""

import bpy

COLOUR_SPACE = "Linear Rec.709"


def float_image(name: str, columns: int, rows: int, colour_space: str) -> bpy.types.Image:
    image = bpy.data.images.new(name, columns, rows, alpha=False, float_buffer=True)
    image.colorspace_settings.name = colour_space
    # Half precision ends at 65504, and the disc is brighter.
    image.use_half_precision = False
    return image


def is_writable(image: bpy.types.Image) -> bool:
    """Whether pixels of any brightness can be written. One that was packed counts as a file."""
    is_of_pixels = image.source in {"GENERATED", "FILE"} and min(image.size) > 0
    return is_of_pixels and image.is_float and image.library is None


def write(image: bpy.types.Image, pixels) -> None:
    """Float32 pixels (rows, columns, 4), lowest row first; the image is of that size from now on."""
    rows, columns, _ = pixels.shape
    if tuple(image.size) != (columns, rows):
        image.scale(columns, rows)
    image.pixels.foreach_set(pixels.ravel())
    image.update()


_ALPHA_MODES = ("STRAIGHT", "PREMUL", "CHANNEL_PACKED", "NONE")


def make_cycles_look(image: bpy.types.Image) -> None:
    """Cycles keeps its copy of an image, in viewports and with Persistent Data, until a parameter of it changes: one
    that makes no difference where alpha is 1. Comes before `write`, as it may read a packed image anew."""
    following = (_ALPHA_MODES.index(image.alpha_mode) + 1) % len(_ALPHA_MODES)
    image.alpha_mode = _ALPHA_MODES[following]
