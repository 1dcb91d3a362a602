"""The Python reader as a child process.

Input: length of the file (u32, little-endian), the file, length of the questions (u32), the questions as lines of the conformance
suite. Output: one line per question. Starts with a line that says which features are lacking.
"""

import importlib.machinery
import importlib.util
import pathlib
import struct
import sys

READER = pathlib.Path(__file__).resolve().parents[3] / "format-spec/readers/python/conformance"


def load():
    loader = importlib.machinery.SourceFileLoader("conformance", str(READER))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("conformance", loader))
    loader.exec_module(module)
    return module


def read_block(stream):
    length = stream.read(4)
    return stream.read(*struct.unpack("<I", length)) if len(length) == 4 else None


def main():
    reader, stream = load(), sys.stdin.buffer
    welkin_sky = reader.welkin_sky
    print("lacks" if welkin_sky.ZSTD else "lacks zstd", flush=True)
    while (file := read_block(stream)) is not None:
        lines = read_block(stream).decode().splitlines()
        try:
            model, refusal = welkin_sky.from_bytes(file), None
        except welkin_sky.WelkinError as error:
            model, refusal = None, error
        for line in lines:
            try:
                if refusal:
                    raise refusal
                print(*(repr(float(number)) for number in reader.answer(model, line).ravel()))
            except welkin_sky.WelkinError as error:
                print("error", error.error_class)
        sys.stdout.flush()


main()
