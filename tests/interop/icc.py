#!/usr/bin/env python3
"""Other programs with an exported ICC profile give Darkroot's colours: icc.py DARKROOT

LittleCMS with versions 4 and 2 of the format, Argyll's xicclu, which knows none later, with version 2. Needs transicc
(Debian: liblcms2-utils), xicclu (Debian: argyll) and numpy; says which is missing and goes on with the other. Exit code 1
when a mean is above 1 dE2000.
"""
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import chart
import numpy as np


def numbers(command, rows):
    done = subprocess.run(command, input=rows, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}: {done.stderr or done.stdout}")
    return np.array([[float(v) for v in line.split()[-3:]] for line in done.stdout.split("\n") if line.strip()])


def transicc(profile, rgb):
    rows = "".join(f"{r:.9g} {g:.9g} {b:.9g}\n" for r, g, b in 255 * rgb)
    return numbers(["transicc", "-n", "-c0", "-t1", "-i", profile, "-o", "*XYZ"], rows) / 100


def xicclu(profile, rgb):
    rows = "".join(f"{r:.9f} {g:.9f} {b:.9f}\n" for r, g, b in rgb)
    return numbers(["xicclu", "-v0", "-ff", "-ir", "-px", profile], rows)


program, good = sys.argv[1], True
programs = []
for tool, package, ask, versions in [
    ("transicc", "liblcms2-utils", transicc, "42"),
    ("xicclu", "argyll", xicclu, "2"),
]:
    if shutil.which(tool):
        programs += [(tool, ask, version) for version in versions]
    else:
        print(f"skipped: {tool} is not installed (Debian: {package})")
with tempfile.TemporaryDirectory() as folder:
    for camera in chart.CAMERAS if programs else []:
        for light in ["D65", "A"]:
            # Darker and brighter, too; what is above 1 is cut.
            rgb = chart.chart_rgb(program, camera, light)
            rgb = np.concatenate([rgb, rgb / 16, np.clip(rgb * 1.1, 0, 1)])
            wanted = chart.apply(program, camera, light, rgb)
            for tool, ask, version in programs:
                profile = str(Path(folder, "camera.icc"))
                arguments = ["--light", light, "--to", "icc", "--icc-version", version, "-o", profile, "--overwrite"]
                chart.darkroot(program, "profile", "export", camera, *arguments)
                good &= chart.judge(f"{camera}, {light}, version {version}, {tool}", ask(profile, rgb), wanted)
sys.exit(0 if good else 1)
