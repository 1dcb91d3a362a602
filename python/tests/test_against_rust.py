"""The same calls in Rust give the same bits. WELKIN_BENCH is the program that `cargo build --example bench` makes."""

import os
import subprocess

import numpy as np
import pytest

import bench
import welkin_sky

PROGRAM = os.environ.get("WELKIN_BENCH")


@pytest.mark.skipif(PROGRAM is None, reason="WELKIN_BENCH does not name the program")
def test_values_are_the_same(model):
    done = subprocess.run([PROGRAM, "values"], check=True, capture_output=True, text=True)
    lines = dict(line.split(maxsplit=1) for line in done.stdout.splitlines())
    directions = welkin_sky.lat_long(8).directions
    calls = bench.calls(model)
    assert {name for name, _, _ in calls} == set(lines)
    for name, _, call in calls:
        expected = np.array(lines[name].split(), dtype=np.float32)
        assert np.array_equal(call(directions).ravel(), expected), name
