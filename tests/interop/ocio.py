#!/usr/bin/env python3
"""OpenColorIO with exported CLF and cube files gives Darkroot's colours: ocio.py DARKROOT

Needs opencolorio (PyPI) and numpy; says which is missing. Exit code 1 when a mean is above 1 dE2000.
"""
import sys
import tempfile
from pathlib import Path

import chart
import numpy as np

try:
    import PyOpenColorIO as ocio
except ImportError:
    print("skipped: PyOpenColorIO is not installed (PyPI: opencolorio)")
    sys.exit(0)

# Linear RGB to XYZ relative to D50, by Bradford.
AP0 = np.array([[0.9525523959, 0, 0.0000936786], [0.3439664498, 0.7281660966, -0.0721325464], [0, 0, 1.0088251844]])
REC2020 = np.array([[0.6369580, 0.1446169, 0.1688810], [0.2627002, 0.6779981, 0.0593017], [0, 0.0280727, 1.0609851]])
BRADFORD = np.array([[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]])


def under_d50(matrix):
    gains = (BRADFORD @ chart.D50) / (BRADFORD @ matrix.sum(1))
    return np.linalg.inv(BRADFORD) @ np.diag(gains) @ BRADFORD @ matrix


def through(path, values):
    transform = ocio.FileTransform(str(path), interpolation=ocio.INTERP_BEST)
    cpu = ocio.Config.CreateRaw().getProcessor(transform).getDefaultCPUProcessor()
    return np.array([cpu.applyRGB(v) for v in values.tolist()])


program, good = sys.argv[1], True
with tempfile.TemporaryDirectory() as folder:
    for camera in chart.CAMERAS:
        for light in ["D65", "A"]:
            rgb = chart.chart_rgb(program, camera, light)
            rgb = np.concatenate([rgb, rgb / 16, np.clip(rgb * 1.1, 0, 1)])
            wanted = chart.apply(program, camera, light, rgb)
            for kind, matrix, coded in [("clf", AP0, rgb), ("cube", REC2020, np.sqrt(rgb))]:
                path = str(Path(folder, f"{camera}-{light}.{kind}".replace(" ", "-")))
                chart.darkroot(program, "profile", "export", camera, "--light", light, "--to", kind, "-o", path)
                found = through(path, coded) @ under_d50(matrix).T
                good &= chart.judge(f"{camera}, {light}, OpenColorIO with {kind}", found, wanted)
sys.exit(0 if good else 1)
