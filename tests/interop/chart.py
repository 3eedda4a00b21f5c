"""Colours of a chart as a camera with a Darkroot profile sees them, and how far two sets of colours are apart.

Used by dcp.py, icc.py and ocio.py, which compare other programs with `darkroot profile apply`.
"""
import csv
import io
import shutil
import subprocess
import sys

try:
    import numpy as np
except ImportError:
    print("skipped: numpy is not installed")
    sys.exit(0)

D50 = np.array([0.9642, 1.0, 0.8249])
CAMERAS = ["Nikon D700", "Canon EOS 5D Mark II", "Sony ILCE-7RM2"]
LIMIT = 1.0
# CIELAB, D50, of the classic 24 patches, as X-Rite publishes them for charts made after 2014.
LAB = np.array([
    [37.54, 14.37, 14.92], [64.66, 19.27, 17.5], [49.32, -3.82, -22.54], [43.46, -12.74, 22.72],
    [54.94, 9.61, -24.79], [70.48, -32.26, -0.37], [62.73, 35.83, 56.5], [39.43, 10.75, -45.17],
    [50.57, 48.64, 16.67], [30.1, 22.54, -20.87], [71.77, -24.13, 58.19], [71.51, 18.24, 67.37],
    [28.37, 15.42, -49.8], [54.38, -39.72, 32.27], [42.43, 51.05, 28.62], [81.8, 2.67, 80.41],
    [50.63, 51.28, -14.12], [49.57, -29.71, -28.32], [95.19, -1.03, 2.93], [81.29, -0.57, 0.44],
    [66.89, -0.75, -0.06], [50.76, -0.13, 0.14], [35.63, -0.46, -0.48], [20.64, 0.07, -0.46],
])


def need(tool, package):
    """Ends the script when a tool is not there, and says so."""
    if shutil.which(tool) is None:
        print(f"skipped: {tool} is not installed (Debian: {package})")
        sys.exit(0)


def darkroot(program, *arguments, text=None):
    done = subprocess.run([program, *arguments], input=text, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"darkroot {' '.join(arguments)}: {done.stderr}")
    return done.stdout


def table(text):
    return np.array([[float(v) for v in row] for row in list(csv.reader(io.StringIO(text)))[1:]])


def apply(program, camera, light, rgb):
    """XYZ relative to D50 of balanced camera RGB."""
    rows = "".join(f"{r!r},{g!r},{b!r}\n" for r, g, b in rgb.tolist())
    return table(darkroot(program, "profile", "apply", camera, "--light", light, text="r,g,b\n" + rows))


def xyz_of_lab(lab):
    fy = (lab[:, 0] + 16) / 116
    f = np.stack([fy + lab[:, 1] / 500, fy, fy - lab[:, 2] / 200], 1)
    return np.where(f > 6 / 29, f**3, (116 * f - 16) * 27 / 24389) * D50


def lab_of_xyz(xyz):
    t = xyz / D50
    f = np.where(t > 216 / 24389, np.cbrt(np.maximum(t, 1e-12)), (24389 / 27 * t + 16) / 116)
    return np.stack([116 * f[:, 1] - 16, 500 * (f[:, 0] - f[:, 1]), 200 * (f[:, 1] - f[:, 2])], 1)


def chart_rgb(program, camera, light):
    """Balanced camera RGB of the chart: Newton's method on the profile itself."""
    wanted, h = xyz_of_lab(LAB), 1e-6
    rgb = np.repeat(wanted[:, 1:2], 3, 1)
    for _ in range(12):
        at = np.concatenate([rgb] + [rgb + h * np.eye(3)[c] for c in range(3)])
        found = apply(program, camera, light, at).reshape(4, -1, 3)
        jacobian = np.stack([(found[c + 1] - found[0]) / h for c in range(3)], 2)
        step = np.linalg.solve(jacobian, (wanted - found[0])[..., None])[..., 0]
        rgb = np.maximum(rgb + step, 0.2 * rgb)
    assert np.abs(apply(program, camera, light, rgb) - wanted).max() < 1e-6, "the profile cannot be inverted"
    return rgb


def de2000(one, two):
    """CIEDE2000 after Sharma, Wu and Dalal (2005)."""
    (l1, a1, b1), (l2, a2, b2) = one.T, two.T
    mean7 = ((np.hypot(a1, b1) + np.hypot(a2, b2)) / 2) ** 7
    g = 1.5 - 0.5 * np.sqrt(mean7 / (mean7 + 25.0**7))
    c1, c2 = np.hypot(g * a1, b1), np.hypot(g * a2, b2)
    h1, h2 = np.degrees(np.arctan2(b1, g * a1)) % 360, np.degrees(np.arctan2(b2, g * a2)) % 360
    dh = (h2 - h1 + 180) % 360 - 180
    h = (h1 + dh / 2) % 360
    dl, dc = l2 - l1, c2 - c1
    big_dh = 2 * np.sqrt(c1 * c2) * np.sin(np.radians(dh / 2))
    l, c = (l1 + l2) / 2, (c1 + c2) / 2
    cos = lambda degrees: np.cos(np.radians(degrees))
    t = 1 - 0.17 * cos(h - 30) + 0.24 * cos(2 * h) + 0.32 * cos(3 * h + 6) - 0.2 * cos(4 * h - 63)
    sl = 1 + 0.015 * (l - 50) ** 2 / np.sqrt(20 + (l - 50) ** 2)
    sc, sh = 1 + 0.045 * c, 1 + 0.015 * c * t
    turn = 30 * np.exp(-(((h - 275) / 25) ** 2))
    rt = -2 * np.sqrt(c**7 / (c**7 + 25.0**7)) * np.sin(np.radians(2 * turn))
    return np.sqrt((dl / sl) ** 2 + (dc / sc) ** 2 + (big_dh / sh) ** 2 + rt * dc / sc * big_dh / sh)


def judge(what, found, wanted, limit=LIMIT):
    """Prints how far two sets of XYZ are apart; whether the mean is within the limit."""
    apart = de2000(lab_of_xyz(found), lab_of_xyz(wanted))
    print(f"{what}: dE2000 mean {apart.mean():.3f}, max {apart.max():.3f}")
    return apart.mean() <= limit
