"""What every figure's command understands."""

import argparse
import os

import mitsuba as mi

import plugins

HERE = os.path.dirname(os.path.abspath(__file__))


def parse(description, variant, more=lambda parser: None):
    """Arguments, those of `more` among them, after which Mitsuba runs in `variant` and knows welkin."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--draft", action="store_true", help="small, few samples: half a minute")
    parser.add_argument("--out", default=HERE, help="folder of the pictures; this one by default")
    parser.add_argument("--arrays", help="folder that also gets the linear pictures, as .npz")
    more(parser)
    arguments = parser.parse_args()
    mi.set_variant(variant)
    plugins.register()
    if arguments.arrays:
        os.makedirs(arguments.arrays, exist_ok=True)
    return arguments
