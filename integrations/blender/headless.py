"""Blender as a Python module (`bpy`) with the extension installed from its zip, as a user installs it.

Import it before `bpy`: Blender then reads and changes nothing of the user's.
"""

import atexit
import os
import shutil
import sys
import tempfile
from pathlib import Path

# Blender reads the environment when it is imported.
assert "bpy" not in sys.modules, "import headless before bpy"
WORK = Path(tempfile.mkdtemp(prefix="welkin-blender-"))
atexit.register(shutil.rmtree, WORK, ignore_errors=True)
os.environ["BLENDER_USER_RESOURCES"] = str(WORK / "user")

import bpy  # noqa: E402

PACKAGE = "bl_ext.user_default.welkin"


def extension() -> Path:
    zips = sorted((Path(__file__).resolve().parent / "dist").glob("welkin-*.zip"))
    assert len(zips) == 1, f"build makes one zip in dist, found {len(zips)}"
    return zips[0]


bpy.ops.extensions.package_install_files(
    filepath=str(extension()), repo="user_default", enable_on_install=True
)
