# SPDX-License-Identifier: BSD-3-Clause
"""Where the program `slabhull` is that belongs to this package."""
import os
import shutil
from pathlib import Path


def find_program() -> str:
    """Its path: $SLABHULL_PROGRAM, that of the same build tree or prefix, or what the shell would run."""
    package = Path(__file__).resolve().parent
    near = [package.parents[1] / "tools" / "slabhull"]  # build/python/slabhull
    near += [folder / "bin" / "slabhull" for folder in package.parents[3:5]]  # PREFIX/lib/python3*/dist-packages/slabhull
    wanted = [os.environ.get("SLABHULL_PROGRAM"), *near, shutil.which("slabhull")]
    for path in wanted:
        if path and os.path.isfile(path) and os.access(path, os.X_OK):
            return str(path)
    raise FileNotFoundError("the program slabhull is not installed beside the Python package; "
                            "say where it is in SLABHULL_PROGRAM")
