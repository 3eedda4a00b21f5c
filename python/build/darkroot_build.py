"""Builds the package: the program `darkroot` first, which goes into the wheel, then maturin the extension.

The wheel has the program itself and not a Python script that does its work: it keeps its sandbox, starts its workers by itself, and
begins in milliseconds. pip and `python -m build` call the hooks; `python python/build/darkroot_build.py` puts only the program
in its place, and then `maturin build` makes the wheel. `CARGO_BUILD_TARGET` is heeded, and `DARKROOT_PROGRAM` names a
program that is there already (a static one, say).
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys

try:
    import maturin
    from maturin import (  # noqa: F401
        get_requires_for_build_editable,
        get_requires_for_build_sdist,
        get_requires_for_build_wheel,
    )
except ImportError:
    # As a script it needs no maturin.
    maturin = None

ROOT = pathlib.Path(__file__).resolve().parents[2]


def program():
    """Compiles the program and puts it where maturin takes it from."""
    made = os.environ.get("DARKROOT_PROGRAM")
    if made is None:
        subprocess.run(["cargo", "build", "--release", "--locked", "-p", "darkroot-cli"], cwd=ROOT, check=True)
        told = subprocess.run(
            ["cargo", "metadata", "--no-deps", "--format-version", "1"], cwd=ROOT, check=True, capture_output=True
        )
        target = pathlib.Path(json.loads(told.stdout)["target_directory"])
        suffix = ".exe" if os.name == "nt" else ""
        made = target / os.environ.get("CARGO_BUILD_TARGET", "") / "release" / f"darkroot{suffix}"
    scripts = ROOT / "target/wheel/scripts"
    shutil.rmtree(scripts, ignore_errors=True)
    scripts.mkdir(parents=True)
    shutil.copy(made, scripts)
    placed = scripts / pathlib.Path(made).name
    if shutil.which("strip"):
        subprocess.run(["strip", placed], check=False)
    # What is inside of it and of the extension, with its licences.
    doc = ROOT / "target/wheel/data/share/doc/darkroot"
    doc.mkdir(parents=True, exist_ok=True)
    command = [sys.executable, ROOT / "package/licences.py", "darkroot-cli", "darkroot-python"]
    told = subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
    (doc / "THIRD-PARTY.txt").write_bytes(told.stdout)
    return placed


def build_sdist(*arguments, **keywords):
    """The sources, of which whoever installs them builds the program, too."""
    (ROOT / "target/wheel").mkdir(parents=True, exist_ok=True)
    return maturin.build_sdist(*arguments, **keywords)


def build_wheel(*arguments, **keywords):
    """The wheel."""
    program()
    return maturin.build_wheel(*arguments, **keywords)


def build_editable(*arguments, **keywords):
    """A wheel that leads to the sources."""
    program()
    return maturin.build_editable(*arguments, **keywords)


if __name__ == "__main__":
    print(program())
