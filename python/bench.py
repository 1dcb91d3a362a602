"""Times images of 512 × 256 directions in Python, in Rust alone, and with the pure reader, in one run.

    python bench.py --rust ../target/release/examples/bench
    cargo build --release --example bench          # in this folder, makes the other one

The least of seven rounds each, on one thread and on all; the reader of one, with a sixteenth of the directions.
"""

import argparse
import subprocess
import time

import numpy as np

import welkin_sky

ROUNDS = 7
BANDS = np.arange(390.0, 721.0, 30.0)
"""Twelve wavelengths, nm."""


def calls(model):
    """What is timed: what it is called by the Rust program, what it is, and the call."""
    sky = model.sky()
    baked, polarised = sky.bake(), model.polarised_sky().bake()
    colour = model.colour_sky().bake()
    bands = model.band_sky(model.bands(BANDS)).bake()
    return [
        ("bands", "baked, 12 wavelengths (bands)", bands.radiance),
        ("baked", "baked, the 24 nodes", baked.radiance),
        ("rgb", "baked, linear sRGB", colour.rgb),
        ("stokes", "baked, Stokes vectors of the 24 nodes", polarised.stokes),
        ("sky", "prepared sky, the 24 nodes", sky.radiance),
        ("general", "general query, the 24 nodes", model.radiance),
    ]


def least(call):
    """Milliseconds."""
    times = []
    for _ in range(ROUNDS):
        start = time.perf_counter()
        call()
        times.append(time.perf_counter() - start)
    return 1e3 * min(times)


def rust_times(program):
    if program is None:
        return {}
    lines = subprocess.run([program, "times"], check=True, capture_output=True, text=True).stdout
    return {name: float(value) for name, value in map(str.split, lines.splitlines())}


def reader_time(directions):
    """Of the pure reader for all directions, from a sixteenth of them; None where it is not installed."""
    try:
        import welkin_reader
    except ImportError:
        return None
    import pathlib

    path = pathlib.Path(__file__).resolve().parents[1] / "models/default.welkin"
    sky = welkin_reader.open(path).sky(
        solar_elevation=np.radians(20.0), visibility=59.4e3, albedo=0.2, altitude=0.0
    )
    some = directions.reshape(-1, 3)[::16]
    start = time.perf_counter()
    sky.radiance(some)
    return 1e3 * 16 * (time.perf_counter() - start)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rust", help="the program that times the same in Rust")
    options = parser.parse_args()
    model = welkin_sky.default_model()
    directions = welkin_sky.lat_long(256).directions
    rust = rust_times(options.rust)
    print("| 512 × 256 directions | Rust, ms | Python, 1 thread, ms | all threads, ms |")
    print("| --- | --- | --- | --- |")
    for name, what, call in calls(model):
        one, all_ = (least(lambda: call(directions, threads=n)) for n in (1, None))
        known = f"{rust[name]:.1f}" if name in rust else ""
        print(f"| {what} | {known} | {one:.1f} | {all_:.1f} |")
    reader = reader_time(directions)
    if reader is not None:
        print(f"| pure reader, the 24 nodes | | {reader:.0f} | |")
    whole = least(lambda: model.sky().bake().radiance(directions, threads=1))
    print(f"\nprepare, bake and ask the 24 nodes: {whole:.1f} ms")
    up, sky = np.float32([0, 0, 1]), model.sky().bake()
    alone = least(lambda: [sky.radiance(up) for _ in range(1000)])
    print(f"a call with one direction: {alone:.2f} µs")


if __name__ == "__main__":
    main()
