#!/usr/bin/env python3
"""OpenColorIO makes the same of a picture with a table as `develop --lut` does: lut.py DARKROOT RAW

Needs opencolorio, tifffile (PyPI) and numpy; says which is missing. Exit code 1 when a sample differs by more than 0.002.
"""
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import numpy as np
    import PyOpenColorIO as ocio
    import tifffile
except ImportError as missing:
    print(f"skipped: {missing.name} is not installed (PyPI: opencolorio, tifffile, numpy)")
    sys.exit(0)

STEP = 'inBitDepth="{0}" outBitDepth="{1}"'


def cube(size, of):
    """A .cube file of three dimensions."""
    axis = np.linspace(0, 1, size)
    lines = [f"LUT_3D_SIZE {size}"]
    lines += ["%.6f %.6f %.6f" % of(r, g, b) for b in axis for g in axis for r in axis]
    return "\n".join(lines) + "\n"


def film(r, g, b):
    grey = 0.25 * r + 0.6 * g + 0.15 * b
    bent = [0.9 * (grey + 1.3 * (v - grey)) + 0.1 * v * v + shift for v, shift in ((r, 0.02), (g, 0), (b, -0.03))]
    return tuple(min(max(v, 0), 1) for v in bent)


def curves(size):
    """A .cube file of one dimension, another curve for each channel, over 0 to 2."""
    axis = np.linspace(0, 2, size)
    rows = ["%.6f %.6f %.6f" % (min(v, 1) ** 0.8, min(v, 1) ** 1.1, 0.1 + 0.8 * min(v, 1)) for v in axis]
    return f"LUT_1D_SIZE {size}\nDOMAIN_MIN 0 0 0\nDOMAIN_MAX 2 2 2\n" + "\n".join(rows) + "\n"


def clf(*steps):
    head = '<?xml version="1.0" encoding="UTF-8"?>\n<ProcessList id="test" compCLFversion="3">\n'
    return head + "\n".join(steps) + "\n</ProcessList>\n"


def every_step():
    """CLF with each kind of step, in the bits of files as they are met."""
    small = cube(5, film).split("\n", 1)[1].split("\n")
    # In CLF blue changes fastest.
    nodes = np.array([row.split() for row in small if row], float).reshape(5, 5, 5, 3).transpose(2, 1, 0, 3).reshape(-1, 3)
    table = "\n".join(" ".join("%.6f" % v for v in row) for row in nodes)
    curve = "\n".join("%d" % round(1023 * (i / 32) ** 0.9) for i in range(33))
    f = STEP.format("32f", "32f")
    return clf(
        f'<Range {f}><minInValue>0</minInValue><maxInValue>1</maxInValue>'
        '<minOutValue>0.01</minOutValue><maxOutValue>0.98</maxOutValue></Range>',
        f'<Exponent {f} style="monCurveFwd"><ExponentParams exponent="2.4" offset="0.055"/></Exponent>',
        f'<Matrix {f}><Array dim="3 3">0.9 0.08 0.02\n0.05 0.9 0.05\n0.01 0.09 0.9</Array></Matrix>',
        f'<ASC_CDL {f} id="c" style="Fwd"><SOPNode><Slope>1.05 1 0.95</Slope><Offset>0.001 0 0.002</Offset>'
        '<Power>1 0.95 1.05</Power></SOPNode><SatNode><Saturation>0.9</Saturation></SatNode></ASC_CDL>',
        f'<Log {f} style="cameraLinToLog"><LogParams base="10" linSideSlope="5.5" linSideOffset="0.05" logSideSlope="0.25" '
        'logSideOffset="0.38" linSideBreak="0.01"/></Log>',
        f'<Log {f} style="cameraLogToLin"><LogParams base="10" linSideSlope="5.4" linSideOffset="0.05" logSideSlope="0.25" '
        'logSideOffset="0.38" linSideBreak="0.01"/></Log>',
        f'<Exponent {f} style="basicMirrorRev"><ExponentParams exponent="2.2"/></Exponent>',
        f'<LUT1D {STEP.format("32f", "10i")}><Array dim="33 1">{curve}</Array></LUT1D>',
        f'<LUT3D {STEP.format("10i", "32f")} interpolation="tetrahedral"><Array dim="5 5 5 3">{table}</Array></LUT3D>',
    )


def through(path, picture):
    transform = ocio.FileTransform(str(path), interpolation=ocio.INTERP_TETRAHEDRAL)
    cpu = ocio.Config.CreateRaw().getProcessor(transform).getDefaultCPUProcessor()
    flat = np.ascontiguousarray(picture.reshape(-1, 3), np.float32)
    cpu.applyRGB(flat)
    return np.clip(flat.reshape(picture.shape), 0, 1)


program, raw = sys.argv[1:3]
good = True
with tempfile.TemporaryDirectory() as folder:

    def develop(name, *options):
        out = Path(folder, f"{name}.tif")
        subprocess.run([program, "develop", raw, "--resize", "long:600", "-o", str(out), *options], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return tifffile.imread(out).astype(float) / 65535

    for space in ["srgb", "adobe-rgb"]:
        plain = develop(f"plain-{space}", "--space", space)
        for name, text in [("film.cube", cube(17, film)), ("curves.cube", curves(129)), ("steps.clf", every_step())]:
            path = Path(folder, name)
            path.write_text(text)
            ours = develop(f"{name}-{space}", "--space", space, "--lut", str(path), "--lut-space", space)
            away = np.abs(ours - through(path, plain))
            changed = np.abs(ours - plain).mean()
            fits = away.max() < 0.002 and changed > 0.005
            good &= fits
            print(f"{name} in {space}: mean {away.mean():.6f}, largest {away.max():.5f}, the table changes {changed:.3f}"
                  + ("" if fits else "  <-- differs"))
sys.exit(0 if good else 1)
