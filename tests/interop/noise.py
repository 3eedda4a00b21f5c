#!/usr/bin/env python3
"""Noise of finished pictures by `verify` and by NumPy and colour-science: noise.py DARKROOT

Makes a picture of a chart of 24 (16 bits, sRGB) whose patches have the noise of a sensor with a known full well and read noise,
blurred a little, with noise of its own in each channel, and an even picture with streaks of known strength. Asks `darkroot verify
--json` for visual noise, dynamic range and banding. Visual noise is computed again here, from the pixels of the file, by NumPy's
FFT and colour-science's colour spaces; dynamic range and banding are compared with what was put in.

Needs colour-science, tifffile and numpy (PyPI). Exit code 1 when a visual noise is more than 1 % apart, the deviation of the
streaks more than 10 % from the truth, or the range off by more than it says itself.
"""
import json
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

try:
    import numpy as np
    import tifffile

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        import colour
except ImportError as missing:
    print(f"skipped: {missing.name} is not installed")
    sys.exit(0)

PATCH, GAP, EDGE = 200, 30, 60
FULL_WELL, READ_NOISE = 20_000.0, 60.0
PIXELS_PER_DEGREE = 41.0
SRGB = colour.RGB_COLOURSPACES["sRGB"]
D65 = colour.CCS_ILLUMINANTS["CIE 1931 2 Degree Standard Observer"]["D65"]
E = colour.CCS_ILLUMINANTS["CIE 1931 2 Degree Standard Observer"]["E"]


def smooth(plane, amount):
    """A blur of three pixels in each direction: `amount` goes to each neighbour."""
    for axis in (0, 1):
        plane = (1 - 2 * amount) * plane + amount * (np.roll(plane, 1, axis) + np.roll(plane, -1, axis))
    return plane


def written(path, linear):
    encoded = colour.models.eotf_inverse_sRGB(np.clip(linear, 0, 1))
    tifffile.imwrite(path, np.round(encoded * 65535).astype(np.uint16), photometric="rgb")


def chart(path, random):
    """The chart; returns its corners."""
    reference = colour.CCS_COLOURCHECKERS["ColorChecker24 - After November 2014"]
    step = PATCH + GAP
    linear = np.full((2 * EDGE + 4 * step - GAP, 2 * EDGE + 6 * step - GAP, 3), 0.02)
    for i, xyy in enumerate(reference.data.values()):
        xyz = colour.xyY_to_XYZ(xyy)
        rgb = np.clip(colour.XYZ_to_RGB(xyz, SRGB, reference.illuminant, "Bradford"), 0.002, 0.98)
        x, y = EDGE + step * (i % 6), EDGE + step * (i // 6)
        linear[y : y + PATCH, x : x + PATCH] = rgb
    # Saturation is 1; the noise of luminance is that of the sensor, that of colours is its own and blurred.
    electrons = linear @ SRGB.matrix_RGB_to_XYZ[1] * FULL_WELL
    noise = np.sqrt(electrons + READ_NOISE**2) / FULL_WELL * random.standard_normal(electrons.shape)
    of_colour = np.stack([smooth(random.standard_normal(electrons.shape), 0.2) for _ in range(3)], -1)
    of_colour -= (of_colour @ SRGB.matrix_RGB_to_XYZ[1])[..., None]
    written(path, linear + noise[..., None] + 0.002 * of_colour)
    far = [EDGE + 6 * step - GAP - 0.5, EDGE + 4 * step - GAP - 0.5]
    near = EDGE - 0.5
    return [[near, near], [far[0], near], far, [near, far[1]]]


def visual_noise(path, window):
    """ISO 15739:2013, annex B, of the square in the middle of an upright window, at most 128 pixels wide."""
    low, high = np.min(window, 0), np.max(window, 0)
    side = min(128, int(np.min(np.floor(high) - np.ceil(low))) + 1)
    left, top = (np.floor((low + high) / 2 - (side - 1) / 2 + 0.5)).astype(int)
    encoded = tifffile.imread(path)[top : top + side, left : left + side] / 65535
    xyz = colour.models.eotf_sRGB(encoded) @ SRGB.matrix_RGB_to_XYZ.T
    white = [colour.xy_to_XYZ(xy) for xy in (D65, E)]
    to_e = colour.adaptation.matrix_chromatic_adaptation_VonKries(white[0], white[1], "Bradford")
    x, y, z = np.moveaxis(xyz @ to_e.T, -1, 0)
    frequency = np.hypot(*np.meshgrid(np.fft.fftfreq(side), np.fft.fftfreq(side))) * PIXELS_PER_DEGREE
    sensitivities = [
        75 * frequency**0.8 * np.exp(-0.2 * frequency) / 34.05,
        (109.1413 * np.exp(-0.00038 * frequency**3.42436) + 93.59711 * np.exp(-0.00367 * frequency**2.16771)) / 202.73841,
        (7.032845 * np.exp(-0.000004 * frequency**4.258205) + 40.69095 * np.exp(-0.103909 * frequency**1.648658)) / 47.723795,
    ]
    down, across = np.mgrid[:side, :side] - (side - 1) / 2
    basis = np.stack([np.ones(side * side), across.ravel(), down.ravel()], -1)

    def seen(plane, sensitivity):
        plane_fit = (basis @ np.linalg.lstsq(basis, plane.ravel(), rcond=None)[0]).reshape(side, side)
        return plane.mean() + np.fft.ifft2(np.fft.fft2(plane - plane_fit) * sensitivity).real

    a, c1, c2 = map(seen, (y, x - y, 0.4 * (y - z)), sensitivities)
    back = np.stack([a + c1, a, a - c2 / 0.4], -1) @ np.linalg.inv(to_e).T
    luv = colour.XYZ_to_Luv(np.clip(back, 0, None), D65).reshape(-1, 3)
    return float(np.std(luv, axis=0, ddof=1) @ [1, 0.852, 0.323])


def verify(darkroot, *arguments):
    run = subprocess.run([darkroot, "verify", "-q", "--accept", "--json", *map(str, arguments)], capture_output=True, text=True)
    if run.returncode:
        sys.exit(run.stderr)
    return json.loads(run.stdout)


def main(darkroot):
    random = np.random.default_rng(15739)
    with tempfile.TemporaryDirectory() as folder:
        picture, flat = Path(folder, "chart.tif"), Path(folder, "flat.tif")
        corners = chart(picture, random)
        gains = 1 + 0.004 * random.standard_normal(700)
        even = 0.4 * gains[None, :] * np.linspace(1, 0.97, 500)[:, None]
        even = even + 0.004 * random.standard_normal(even.shape)
        written(flat, np.repeat(even[..., None], 3, -1))
        text = ",".join(f"{x},{y}" for x, y in corners)
        found = verify(darkroot, picture, "--corners", text, "--flat", flat, "--pixels-per-degree", PIXELS_PER_DEGREE)
        wrong = 0
        print("| grey | visual noise by Darkroot | by NumPy and colour-science |\n|---|---|---|")
        for i, grey in enumerate(found["greys"]):
            own, theirs = grey["visual_noise"]["weighted"], visual_noise(picture, found["windows"][18 + i])
            print(f"| {grey['name']} | {own:.4f} | {theirs:.4f} |")
            wrong += abs(own / theirs - 1) > 0.01
    truth = np.log2(FULL_WELL / ((1 + np.sqrt(1 + 4 * READ_NOISE**2)) / 2))
    spread = found["dynamic_range"]
    print(f"\ndynamic range: {spread['stops']:.2f} stops, at least {spread['least']:.2f}; put in {truth:.2f}")
    wrong += not spread["least"] - 0.2 < truth < spread["stops"] + 2 * (spread["stops"] - spread["least"])
    columns, rows = found["banding"]["columns"], found["banding"]["rows"]
    # What is left of random columns once slow changes are taken off, in L* by its slope at this luminance.
    y = 0.4 * 0.985
    truth = 0.004 * 116 / 3 * y ** (1 / 3)
    print(f"banding of columns: L* {columns['deviation']:.4f}, put in {truth:.4f}; of rows {rows['deviation']:.4f}, put in none")
    wrong += abs(columns["deviation"] / truth - 1) > 0.1 or rows["deviation"] > 0
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
