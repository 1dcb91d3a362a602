"""The examples of README.md, run from its folder as a reader would."""

import doctest
import os
import unittest
from pathlib import Path

README = Path(__file__).resolve().parent.parent / "README.md"


class Readme(unittest.TestCase):
    def setUp(self):
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(README.parent)

    def test_examples(self):
        failed, attempted = doctest.testfile(str(README), module_relative=False)
        self.assertGreater(attempted, 20)
        self.assertEqual(failed, 0)
