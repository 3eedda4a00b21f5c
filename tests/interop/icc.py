#!/usr/bin/env python3
"""LittleCMS with an exported ICC profile gives Darkroot's colours: icc.py DARKROOT

Needs transicc (Debian: liblcms2-utils) and numpy; says which is missing. Exit code 1 when a mean is above 1 dE2000.
Argyll's xicclu reads profiles of version 2 only, so it is not asked.
"""
import subprocess
import sys
import tempfile
from pathlib import Path

import chart
import numpy as np

chart.need("transicc", "liblcms2-utils")
program, good = sys.argv[1], True
with tempfile.TemporaryDirectory() as folder:
    for camera in chart.CAMERAS:
        for light in ["D65", "A"]:
            profile = str(Path(folder, "camera.icc"))
            chart.darkroot(
                program, "profile", "export", camera, "--light", light, "--to", "icc", "-o", profile, "--overwrite"
            )
            rgb = chart.chart_rgb(program, camera, light)
            # Darker and brighter, too: transicc counts to 255.
            rgb = np.concatenate([rgb, rgb / 16, np.clip(rgb * 1.1, 0, 1)])
            rows = "".join(f"{r:.9g} {g:.9g} {b:.9g}\n" for r, g, b in 255 * rgb)
            command = ["transicc", "-n", "-c0", "-t1", "-i", profile, "-o", "*XYZ"]
            out = subprocess.run(command, input=rows, capture_output=True, text=True, check=True).stdout
            found = np.array([[float(v) for v in line.split()] for line in out.split("\n") if line.strip()]) / 100
            good &= chart.judge(f"{camera}, {light}, transicc", found, chart.apply(program, camera, light, rgb))
sys.exit(0 if good else 1)
