#!/usr/bin/env python3
"""The look `dcp` is what the DNG specification says of a DCP's look table and tone curve: dcp_look.py DARKROOT RAW [DCP]

A DCP with a look table, a tone curve and an exposure offset is made for the camera of the raw file (or one is given). The file is
developed once as linear light, through which numpy takes the specification's steps (DNG 1.7.1, chapter 6): hue, saturation and
value of linear ProPhoto RGB by trilinear interpolation, round in hue, then the curve for the largest and the smallest channel; and
once with `--look dcp`. Exit code 1 when a sample differs by more than 0.004 of its code, or the mean by more than 0.0002. Then
RawTherapee, where it is installed, renders a chart's patches with the same DCP: mean dE2000 at most 1.

Needs numpy and tifffile (PyPI); says which is missing.
"""
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import numpy as np
    import tifffile
except ImportError as missing:
    print(f"skipped: {missing.name} is not installed (PyPI: numpy, tifffile)")
    sys.exit(0)

import chart
import dcp
import rawtherapee

CAMERA = "Nikon D700"
OFFSET = -0.25
PLAIN = ["--denoise", "off", "--sharpen", "off", "--hot-pixels", "off", "--banding", "off", "--lens", "off",
         "--highlights", "clip", "--overwrite"]
PLAIN_RAWTHERAPEE = {"ToneCurve=false": "ToneCurve=true", "ApplyLookTable=false": "ApplyLookTable=true",
                     "ApplyBaselineExposureOffset=false": "ApplyBaselineExposureOffset=true"}


def made(fields, camera):
    """A DCP of these matrices with a look: more contrast, warmer reds, deeper blues, duller bright colours."""
    hues, saturations, values = 24, 8, 9
    hue, saturation, value = np.meshgrid(np.arange(hues) * 360 / hues, np.linspace(0, 1, saturations),
                                         np.linspace(0, 1, values), indexing="ij")
    around = np.cos(np.radians(hue - 30))
    nodes = np.stack([9 * np.sin(np.radians(2 * hue)) * saturation, 1 + 0.25 * around * saturation * (1 - 0.6 * value),
                      1 - 0.12 * saturation * (1 - around)], -1)
    nodes = nodes.transpose(2, 0, 1, 3)  # Value slowest, then hue, saturation fastest.
    light = np.linspace(0, 1, 33)
    curve = np.stack([light, np.clip(light**0.6 + 0.08 * np.sin(2 * np.pi * light**0.6) * -light * (1 - light), 0, 1)], 1)
    curve[0], curve[-1] = 0, 1
    kept = {tag: (kind, list(fields[tag])) for tag, kind in ((50937, 4), (50938, 11), (50778, 3)) if tag in fields}
    matrices = {tag: (10, dcp.matrix(fields, tag).ravel().tolist()) for tag in (50721, 50964)}
    return dcp.tiff({
        50708: (2, camera), 50936: (2, "look"), **kept, **matrices, 51107: (4, [0]), 50940: (11, curve.ravel().tolist()),
        50981: (4, [hues, saturations, values]), 50982: (11, nodes.ravel().tolist()), 51108: (4, [1]),
        51109: (10, [OFFSET]), 51110: (4, [1]),
    }, 0x4352)


def srgb(v):
    return np.where(v <= 0.0031308, 12.92 * v, 1.055 * np.maximum(v, 1e-9) ** (1 / 2.4) - 0.055)


def linear(v):
    return np.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4)


def looked_up(rgb, fields):
    """Linear ProPhoto RGB, 0 to 1, through the look table."""
    hues, saturations, values = fields[50981][:3]
    nodes = np.array(fields[50982]).reshape(values, hues, saturations, 3)
    high, low = rgb.max(1), rgb.min(1)
    span = high - low
    r, g, b = rgb.T
    safe = np.where(span > 0, span, 1)
    hue = np.where(r == high, (g - b) / safe % 6, np.where(g == high, 2 + (b - r) / safe, 4 + (r - g) / safe))
    hue = np.where(span > 0, hue, 0)
    saturation = np.where(high > 0, span / np.where(high > 0, high, 1), 0)
    coded = fields.get(51108, (0,))[0] == 1 and values > 1
    value = srgb(high) if coded else high
    place = [value * (values - 1), hue * hues / 6, saturation * (saturations - 1)]
    first = [np.minimum(np.floor(p).astype(int), most) for p, most in zip(place, (max(values - 2, 0), hues - 1, saturations - 2))]
    found = 0
    for corner in range(8):
        step = [corner >> 2, corner >> 1 & 1, corner & 1]
        weight = np.ones(len(rgb))
        for p, f, s in zip(place, first, step):
            weight = weight * (p - f if s else 1 - (p - f))
        at = nodes[np.minimum(first[0] + step[0], values - 1), (first[1] + step[1]) % hues, first[2] + step[2]]
        found = found + weight[:, None] * at
    hue = (hue + found[:, 0] / 60) % 6
    saturation = np.clip(saturation * found[:, 1], 0, 1)
    value = np.clip(value * found[:, 2], 0, 1)
    value = linear(value) if coded else value
    sector, part = np.floor(hue).astype(int) % 6, hue - np.floor(hue)
    p, q, t = value * (1 - saturation), value * (1 - saturation * part), value * (1 - saturation * (1 - part))
    rows = np.array([[value, t, p], [q, value, p], [p, value, t], [p, q, value], [t, p, value], [value, p, q]])
    return rows[sector, :, np.arange(len(rgb))]


def spline(points):
    """The natural cubic spline through points, by its second derivatives."""
    x, y = points.T
    h = np.diff(x)
    size = len(x)
    system, right = np.zeros((3, size)), np.zeros(size)
    system[1, [0, -1]] = 1
    for i in range(1, size - 1):
        system[:, i] = h[i - 1], 2 * (h[i - 1] + h[i]), h[i]
        right[i] = 6 * ((y[i + 1] - y[i]) / h[i] - (y[i] - y[i - 1]) / h[i - 1])
    for i in range(1, size):
        factor = system[0, i] / system[1, i - 1]
        system[1, i] -= factor * system[2, i - 1]
        right[i] -= factor * right[i - 1]
    bend = np.zeros(size)
    for i in reversed(range(size)):
        bend[i] = (right[i] - (system[2, i] * bend[i + 1] if i + 1 < size else 0)) / system[1, i]

    def at(v):
        i = np.clip(np.searchsorted(x, v, side="right") - 1, 0, size - 2)
        a, b = (x[i + 1] - v) / h[i], (v - x[i]) / h[i]
        return a * y[i] + b * y[i + 1] + ((a**3 - a) * bend[i] + (b**3 - b) * bend[i + 1]) * h[i] ** 2 / 6

    return at


def toned(rgb, curve):
    high, low = rgb.max(1, keepdims=True), rgb.min(1, keepdims=True)
    share = (rgb - low) / np.where(high > low, high - low, 1)
    to_high, to_low = curve(high), curve(low)
    return to_low + share * (to_high - to_low)


def by_specification(rgb, fields):
    rgb = np.clip(rgb, 0, 1)
    if 50982 in fields:
        rgb = looked_up(rgb, fields)
    return np.clip(toned(rgb, spline(np.array(fields[50940]).reshape(-1, 2))), 0, 1)


def code(v):
    """ROMM RGB (ISO 22028-2), as files in ProPhoto RGB are coded."""
    return np.where(v < 1 / 512, 16 * v, v ** (1 / 1.8))


def agrees(program, raw, profile, fields, folder):
    shown, light = folder / "shown.tif", folder / "light.tif"
    stops = fields[51109][0] / fields[51109][1] if 51109 in fields else 0
    tags = subprocess.run(["exiftool", "-s3", "-BaselineExposure", raw], capture_output=True, text=True).stdout
    stops += float(tags or 0)
    chart.darkroot(program, "develop", str(raw), "-o", str(shown), "--profile", str(profile), "--look", "dcp",
                   "--space", "prophoto", "--bits", "16", "--gamut", "clip", *PLAIN)
    chart.darkroot(program, "develop", str(raw), "-o", str(light), "--profile", str(profile), "--look", "linear",
                   "--space", "prophoto-linear", "--bits", "32", "--exposure", f"{stops:.9f}", *PLAIN)
    light = tifffile.imread(light).reshape(-1, 3).astype(float)
    shown = tifffile.imread(shown).reshape(-1, 3) / 65535
    # Light beyond white is one's own affair: the specification's renderer has cut it by then.
    inside = (light < 1).all(1)
    light, shown = light[inside], shown[inside]
    off = np.abs(code(by_specification(light, fields)) - shown)
    plain = np.abs(code(np.clip(light, 0, 1)) - shown)
    print(f"{Path(raw).name}, {Path(profile).name}: largest difference {off.max():.5f}, mean {off.mean():.6f} "
          f"({len(off)} pixels; from light as it is {plain.mean():.3f})")
    return off.max() <= 0.004 and off.mean() <= 0.0002


def rawtherapee_agrees(program, profile, fields, folder):
    """Patches of a chart with the DCP: RawTherapee's colours and ours."""
    raw, theirs, ours = folder / "chart.dng", folder / "theirs.tif", folder / "ours.tif"
    rgb = 0.6 * chart.chart_rgb(program, CAMERA, "D65")
    raw.write_bytes(dcp.dng(CAMERA, rgb, np.array(dcp.NEUTRAL["D65"]), dcp.matrix(fields, 50721).ravel().tolist()))
    for off, on in PLAIN_RAWTHERAPEE.items():
        rawtherapee.RECIPE = rawtherapee.RECIPE.replace(off, on)
    rawtherapee.develop(raw, theirs, f"file:{profile}")
    chart.darkroot(program, "develop", str(raw), "-o", str(ours), "--profile", str(profile), "--look", "dcp",
                   "--space", "prophoto-linear", "--bits", "16", "--gamut", "clip", *PLAIN)
    picture = tifffile.imread(ours) / 65535
    side, quarter = dcp.SIDE, dcp.SIDE // 4
    middle = np.array([picture[r * side + quarter : (r + 1) * side - quarter, c * side + quarter : (c + 1) * side - quarter]
                       .mean((0, 1)) for r in range(4) for c in range(6)])
    to_xyz = np.array([[0.7976749, 0.1351917, 0.0313534], [0.2880402, 0.7118741, 0.0000857], [0, 0, 0.82521]])
    return chart.judge(f"{CAMERA}, RawTherapee with look table and tone curve", dcp.developed(theirs), middle @ to_xyz.T)


if __name__ == "__main__":
    program, raw = sys.argv[1:3]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        chart.need("exiftool", "libimage-exiftool-perl")
        bench = dcp.Bench(program, folder)
        fields = bench.export(CAMERA, ["D65"])
        tags = ["exiftool", "-s3", "-UniqueCameraModel", raw]
        camera = subprocess.run(tags, capture_output=True, text=True).stdout.strip()
        if len(sys.argv) > 3:
            profile = Path(sys.argv[3])
            good = agrees(program, raw, profile, dcp.read_tiff(profile.read_bytes()), folder)
        else:
            profile = folder / "look.dcp"
            profile.write_bytes(made(fields, camera))
            good = agrees(program, raw, profile, dcp.read_tiff(profile.read_bytes()), folder)
        if all(shutil.which(tool) for tool in rawtherapee.TOOLS):
            own = folder / "own.dcp"
            own.write_bytes(made(fields, CAMERA))
            good &= rawtherapee_agrees(program, own, dcp.read_tiff(own.read_bytes()), folder)
    sys.exit(0 if good else 1)
