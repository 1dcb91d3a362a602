"""Asks the published C++ code of the official model, as compiled into the Python wheel `pyhelios3d`.

    python peer.py WHEEL_FOLDER rows COUNT SEED             random conditions as CSV
    python peer.py WHEEL_FOLDER ask FILE.dat ROWS.csv       its answers to them as CSV
    python peer.py WHEEL_FOLDER compare OURS.csv THEIRS.csv largest differences; fails where they are too large

The wheel exports the class PragueSkyModel under its mangled names; objects are asked for through them and otherwise
left opaque. Only names and signatures of the library are used here.
"""

import csv
import ctypes
import math
import random
import struct
import sys
from pathlib import Path

COLUMNS = ["x", "y", "z", "dx", "dy", "dz", "solar_elevation", "solar_azimuth"]
COLUMNS += ["visibility", "albedo", "wavelength", "distance"]
ANSWERS = ["radiance", "polarisation", "transmittance"]
# What differs is the order of sums, and the distance that the official code takes from an arccosine.
LIMITS = {"radiance": 1e-6, "polarisation": 1e-6, "transmittance": 1e-6}


def old_string(text):
    """A std::string of the ABI before C++11: a pointer to characters with a header before them."""
    data = text.encode()
    header = struct.pack("<QQq", len(data), len(data), 0)
    buffer = ctypes.create_string_buffer(header + data + b"\0")
    pointer = ctypes.c_void_p(ctypes.addressof(buffer) + len(header))
    pointer.buffer = buffer
    return pointer


class Peer:
    def __init__(self, wheel, dataset):
        library = ctypes.CDLL(str(Path(wheel) / "pyhelios/plugins/libhelios.so"))
        number, pointer = ctypes.c_double, ctypes.c_void_p

        def method(name, arguments, result):
            function = getattr(library, "_ZN" + name)
            function.argtypes, function.restype = [pointer] + arguments, result
            return function

        own = "K14PragueSkyModel"
        initialize = method("14PragueSkyModel10initializeERKSsd", [pointer, number], None)
        # Here the first argument is where the result goes, the second the object.
        vectors = "17computeParametersERKNS_7Vector3ES2_dddd"
        self.parameters_of = method(own + vectors, [pointer] * 3 + [number] * 4, None)
        asked = [pointer, number]
        self.radiance_of = method(own + "11skyRadianceERKNS_10ParametersEd", asked, number)
        self.polarisation_of = method(own + "12polarisationERKNS_10ParametersEd", asked, number)
        self.transmittance_of = method(own + "13transmittanceERKNS_10ParametersEdd", asked + [number], number)
        # Larger than any object of the class; empty vectors are zeros.
        self.model = ctypes.create_string_buffer(1 << 14)
        self.parameters = ctypes.create_string_buffer(1 << 10)
        name = old_string(str(dataset))
        initialize(self.model, ctypes.byref(name), 0.0)

    def ask(self, row, whole):
        vector = ctypes.c_double * 3
        x, y, z, dx, dy, dz, elevation, azimuth, visibility, albedo, wavelength, distance = row
        angles = math.radians(elevation), math.radians(azimuth)
        at, to = vector(x, y, z), vector(dx, dy, dz)
        self.parameters_of(self.parameters, self.model, at, to, *angles, visibility, albedo)
        answers = [self.radiance_of(self.model, self.parameters, wavelength)]
        if "polarisation" in whole:
            answers.append(self.polarisation_of(self.model, self.parameters, wavelength))
        else:
            answers.append("")
        if "transmittance" in whole:
            answers.append(self.transmittance_of(self.model, self.parameters, wavelength, distance))
        else:
            answers.append("")
        return answers


def rows(count, seed):
    draw = random.Random(seed)
    for _ in range(count):
        altitude = draw.choice([0.0, draw.uniform(0, 200), draw.uniform(0, 14_000)])
        view = [draw.gauss(0, 1) for _ in range(3)]
        if draw.random() < 0.3:
            view[2] *= 0.02
        distance = draw.choice([math.inf, 10 ** draw.uniform(1, 5.5)])
        place = [draw.uniform(-3e4, 3e4), draw.uniform(-3e4, 3e4), altitude]
        sun = [draw.uniform(-4.2, 90), draw.uniform(0, 360)]
        yield place + view + sun + [draw.uniform(20, 131.8), draw.random(), draw.uniform(361, 719), distance]


def number(text):
    return float(text) if text else None


def compare(ours, theirs):
    with open(ours) as a, open(theirs) as b:
        pairs = list(zip(csv.DictReader(a), csv.DictReader(b), strict=True))
    sound = bool(pairs)
    for answer in ANSWERS:
        both = [(number(a[answer]), number(b[answer])) for a, b in pairs]
        both = [(a, b) for a, b in both if a is not None and b is not None]
        if not both:
            print(f"{answer:<14} not in the file")
            continue
        # Relative, but of what is nearly dark absolute.
        scale = sum(abs(b) for _, b in both) / len(both)
        worst = max(abs(a - b) / max(abs(b), 1e-3 * scale) for a, b in both)
        sound &= worst <= LIMITS[answer]
        print(f"{answer:<14} {len(both)} answers, largest difference {worst:.1e}")
    return sound


def main():
    wheel, task, *rest = sys.argv[1:]
    out = csv.writer(sys.stdout, lineterminator="\n")
    if task == "rows":
        out.writerow(COLUMNS)
        out.writerows(rows(int(rest[0]), int(rest[1])))
    elif task == "ask":
        dataset, table, *whole = rest
        peer = Peer(wheel, dataset)
        out.writerow(ANSWERS)
        with open(table) as file:
            for row in list(csv.reader(file))[1:]:
                out.writerow(peer.ask([float(n) for n in row], whole))
    else:
        sys.exit(0 if compare(*rest) else 1)


main()
