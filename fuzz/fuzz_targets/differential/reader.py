"""The Python reader as a child process.

Input: length of the file (u32, little-endian), the file, length of the questions (u32), the questions as lines of the conformance
suite. Output: one line per question. Starts with a line that says which features are lacking.
"""

import importlib.machinery
import importlib.util
import math
import pathlib
import struct
import sys

READER = pathlib.Path(__file__).resolve().parents[3] / "format-spec/readers/python/conformance"


def load():
    loader = importlib.machinery.SourceFileLoader("conformance", str(READER))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("conformance", loader))
    loader.exec_module(module)
    return module


def answer(reader, model, line):
    """The conformance reader's answers, and two that its suite does not ask for."""
    quantity, *cells = line.split("\t")
    if quantity == "wavelength_range":
        return model.wavelength_range
    if quantity == "sunlight_at":
        return sunlight(model, *map(float, cells))
    return reader.answer(model, line).ravel()


def sunlight(model, altitude, visibility, albedo, elevation, azimuth, *rest):
    """Irradiance times transmittance towards the sun."""
    wavelength = rest[3]
    level = math.cos(elevation)
    sun = [level * math.cos(azimuth), level * math.sin(azimuth), math.sin(elevation)]
    through = model.transmittance_at(sun, math.inf, wavelength, altitude=max(0.0, altitude), visibility=visibility)
    return through * model.solar_irradiance(wavelength)


def read_block(stream):
    length = stream.read(4)
    return stream.read(*struct.unpack("<I", length)) if len(length) == 4 else None


def main():
    reader, stream = load(), sys.stdin.buffer
    welkin_reader = reader.welkin_reader
    print("lacks" if welkin_reader.ZSTD else "lacks zstd", flush=True)
    while (file := read_block(stream)) is not None:
        lines = read_block(stream).decode().splitlines()
        try:
            model, refusal = welkin_reader.from_bytes(file), None
        except welkin_reader.WelkinError as error:
            model, refusal = None, error
        for line in lines:
            try:
                if refusal:
                    raise refusal
                print(*(repr(float(number)) for number in answer(reader, model, line)))
            except welkin_reader.WelkinError as error:
                print("error", error.error_class)
        sys.stdout.flush()


main()
