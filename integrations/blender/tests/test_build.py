"""The package: what Blender itself says of it, and what the build refuses."""

import re
import subprocess
import sys
import tomllib
import unittest
import zipfile
from pathlib import Path

from blender_case import WORK, bpy, extension

ROOT = Path(__file__).resolve().parent.parent


class Build(unittest.TestCase):
    def test_blender_accepts_it(self):
        """What `blender --command extension validate` runs."""
        tool = Path(bpy.utils.system_resource("SCRIPTS")) / "addons_core" / "bl_pkg" / "cli" / "blender_ext.py"
        done = subprocess.run([sys.executable, tool, "validate", extension()], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertNotIn("ERROR", done.stdout)

    def test_manifest(self):
        with zipfile.ZipFile(extension()) as archive:
            manifest = tomllib.loads(archive.read("blender_manifest.toml").decode())
            names = archive.namelist()
        self.assertEqual(manifest["schema_version"], "1.0.0")
        self.assertEqual(manifest["type"], "add-on")
        self.assertEqual(manifest["license"], ["SPDX:MIT"])
        self.assertLessEqual(len(manifest["tagline"]), 64)
        self.assertRegex(manifest["tagline"], r"[\w)]$")
        self.assertEqual(len(manifest["wheels"]), len(manifest["platforms"]))
        for wheel in manifest["wheels"]:
            self.assertIn(wheel.removeprefix("./"), names)
        self.assertIn("LICENSE-MIT", names)
        self.assertIn("LICENSE-APACHE", names)
        self.assertFalse([name for name in names if "__pycache__" in name])

    def test_versions_are_the_same(self):
        manifest = tomllib.loads((ROOT / "welkin" / "blender_manifest.toml").read_text())
        library = (ROOT.parent.parent / "Cargo.toml").read_text()
        self.assertEqual(manifest["version"], re.search(r'^version = "(.+)"', library, re.M)[1])

    def test_platforms(self):
        names = {
            "welkin_sky-0.1.0-cp310-abi3-manylinux_2_35_x86_64.whl": "linux-x64",
            "welkin_sky-0.1.0-cp310-abi3-manylinux_2_28_aarch64.whl": "linux-arm64",
            "welkin_sky-0.1.0-cp310-abi3-macosx_11_0_arm64.whl": "macos-arm64",
            "welkin_sky-0.1.0-cp310-abi3-macosx_10_12_x86_64.whl": "macos-x64",
            "welkin_sky-0.1.0-cp310-abi3-win_amd64.whl": "windows-x64",
        }
        scope = {"__file__": str(ROOT / "build"), "__name__": "build"}
        exec(compile((ROOT / "build").read_text(), "build", "exec"), scope)
        for name, platform in names.items():
            self.assertEqual(scope["platform_of"](Path(name)), platform)

    def test_what_is_refused_leaves_the_zip(self):
        before = extension().read_bytes()
        wheel = WORK / "welkin_sky-0.1.0-cp310-abi3-plan9_mips.whl"
        wheel.write_bytes(b"")
        for arguments, message in (([wheel], "no platform"), (["nowhere.whl"], "no such wheel")):
            done = subprocess.run([sys.executable, ROOT / "build", *arguments], capture_output=True, text=True)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn(message, done.stderr)
            self.assertNotIn("Traceback", done.stderr)
        self.assertEqual(extension().read_bytes(), before)
        self.assertEqual(len(list((ROOT / "dist").iterdir())), 1)


if __name__ == "__main__":
    unittest.main()
