"""What every figure's command understands."""

import argparse
import os

import mitsuba as mi

import plugins

HERE = os.path.dirname(os.path.abspath(__file__))


def parse(description, variant):
    """Arguments, after which Mitsuba runs in `variant` and knows welkin."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--draft", action="store_true", help="small, few samples: half a minute")
    parser.add_argument("--out", default=HERE, help="folder of the pictures; this one by default")
    parser.add_argument("--arrays", help="folder that also gets the linear pictures, as .npz")
    arguments = parser.parse_args()
    mi.set_variant(variant)
    plugins.register()
    return arguments
