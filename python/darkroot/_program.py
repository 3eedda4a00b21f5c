"""The program `darkroot` that the wheel installs."""

import functools
import os
import shutil
import subprocess
import sysconfig

from ._core import __version__


@functools.lru_cache(maxsize=None)
def find():
    """The path of the program of this version: beside this Python, else on the ``PATH``; ``None`` where there is none."""
    suffix = sysconfig.get_config_var("EXE") or ""
    beside = os.path.join(sysconfig.get_path("scripts"), "darkroot" + suffix)
    for path in (beside, shutil.which("darkroot")):
        if path and os.access(path, os.X_OK) and _version(path) == __version__:
            return path
    return None


def _version(path):
    try:
        said = subprocess.run([path, "--version"], capture_output=True, text=True, timeout=10, check=True).stdout
    except (OSError, subprocess.SubprocessError):
        return None
    return said.split()[-1] if said.split() else None
