"""Asks other programs that read the official model's files.

    python peer.py rows COUNT SEED                          random conditions as CSV
    python peer.py ask pyhelios3d FOLDER FILE.dat ROWS.csv  radiance by the published C++ code, as compiled into a wheel
    python peer.py ask skylight FOLDER FILE.dat ROWS.csv    all that the file has by a port to Python; needs scipy
    python peer.py cut FILE.dat SHORT.dat                   an export as pyhelios3d reads it
    python peer.py compare OURS.csv THEIRS.csv              differences; fails where they are too large

FOLDER is that of the unpacked wheel. That of pyhelios3d exports the class PragueSkyModel under its mangled names:
objects are asked for through them and otherwise left opaque. It takes the transmittance for (arcs + heights) numbers
for each visibility, altitude and component, where the published data have arcs times heights for each altitude: its own
file is cut so, and so must be others.
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
# Largest difference in terms of the mean answer, and 99th percentile of the relative difference. Some of their
# arithmetic is in single precision, which shows where radiance falls to nothing within half a degree at the horizon.
LIMITS = (1e-6, 1e-6)


def old_string(text):
    """A std::string of the ABI before C++11: a pointer to characters with a header before them."""
    data = text.encode()
    header = struct.pack("<QQq", len(data), len(data), 0)
    buffer = ctypes.create_string_buffer(header + data + b"\0")
    pointer = ctypes.c_void_p(ctypes.addressof(buffer) + len(header))
    pointer.buffer = buffer
    return pointer


class Compiled:
    """The C++ code in pyhelios3d."""

    def __init__(self, folder, dataset):
        library = ctypes.CDLL(str(Path(folder) / "pyhelios/plugins/libhelios.so"))
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
        self.radiance_of = method(own + "11skyRadianceERKNS_10ParametersEd", [pointer, number], number)
        # Larger than any object of the class; empty vectors are zeros.
        self.model = ctypes.create_string_buffer(1 << 14)
        self.parameters = ctypes.create_string_buffer(1 << 10)
        name = old_string(str(dataset))
        initialize(self.model, ctypes.byref(name), 0.0)

    def ask(self, row):
        vector = ctypes.c_double * 3
        x, y, z, dx, dy, dz, elevation, azimuth, visibility, albedo, wavelength, _ = row
        angles = math.radians(elevation), math.radians(azimuth)
        at, to = vector(x, y, z), vector(dx, dy, dz)
        self.parameters_of(self.parameters, self.model, at, to, *angles, visibility, albedo)
        return [self.radiance_of(self.model, self.parameters, wavelength), "", ""]


class Skylight:
    """The port in the package skylight."""

    def __init__(self, folder, dataset):
        sys.path.insert(0, str(folder))
        import numpy
        from skylight.prague.prague import PragueSkyModelManager

        self.numpy = numpy
        self.model = PragueSkyModelManager()
        self.model.initialise(str(dataset))

    def ask(self, row):
        array = self.numpy.array
        elevation, azimuth, visibility, albedo, wavelength, distance = row[6:]
        at, to = array(row[:3]), array([row[3:6]])
        angles = math.radians(elevation), math.radians(azimuth)
        parameters = self.model.compute_parameters(at, to, *angles, visibility, albedo)
        wavelength = array([wavelength])
        radiance = self.model.sky_radiance(parameters, wavelength)
        degree = self.model.polarisation(parameters, wavelength)
        distance = min(distance, sys.float_info.max)
        through = self.model.transmittance(parameters, wavelength, distance)
        return [float(self.numpy.ravel(answer)[0]) for answer in (radiance, degree, through)]


PEERS = {"pyhelios3d": Compiled, "skylight": Skylight}


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


def cut(source, target):
    """Copies a file up to where pyhelios3d takes the transmittance to end."""
    with open(source, "rb") as file:
        data = file.read()
    at = 0

    def counts(number):
        nonlocal at
        values = struct.unpack_from(f"<{number}i", data, at)
        at += 4 * number
        return values

    configurations = 1
    for _ in range(4):
        (nodes,) = counts(1)
        configurations *= nodes
        at += 8 * nodes
    (channels,) = counts(1)
    at += 16
    (rank,) = counts(1)
    breaks = []
    for _ in range(3):
        breaks += counts(1)
        at += 8 * breaks[-1]
    table = rank * (2 * breaks[0] + 8 + 2 * breaks[1]) + 2 * breaks[2]
    at += configurations * channels * table
    arcs, heights, visibilities, altitudes, rank = counts(5)
    at += 4 * (altitudes + visibilities) + 4 * (arcs + heights) * visibilities * altitudes * rank
    with open(target, "wb") as file:
        file.write(data[:at])


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
            print(f"{answer:<14} not asked")
            continue
        mean = sum(abs(b) for _, b in both) / len(both)
        largest = max(abs(a - b) for a, b in both) / mean
        relative = sorted(abs(a / b - 1) for a, b in both if b != 0)
        median, p99 = (relative[int(q * (len(relative) - 1))] for q in (0.5, 0.99))
        sound &= largest <= LIMITS[0] and p99 <= LIMITS[1]
        text = f"largest difference {largest:.1e} of the mean; relative {median:.1e} median, {p99:.1e} p99"
        print(f"{answer:<14} {len(both)} answers, {text}, {relative[-1]:.1e} largest")
    return sound


def main():
    task, *rest = sys.argv[1:]
    out = csv.writer(sys.stdout, lineterminator="\n")
    if task == "rows":
        out.writerow(COLUMNS)
        out.writerows(rows(int(rest[0]), int(rest[1])))
    elif task == "ask":
        name, folder, dataset, table = rest
        peer = PEERS[name](folder, dataset)
        out.writerow(ANSWERS)
        with open(table) as file:
            for row in list(csv.reader(file))[1:]:
                out.writerow(peer.ask([float(n) for n in row]))
    elif task == "cut":
        cut(*rest)
    else:
        sys.exit(0 if compare(*rest) else 1)


main()
