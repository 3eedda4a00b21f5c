#!/usr/bin/env python3
"""How much noise the program takes from simulated captures, and what detail that costs.

    denoise.py --darkroot target/release/darkroot --pictures DATA/demosaic [--work DIR] [--set tune|judge]

Each capture is written as a DNG twice, with noise and without, and developed by the program in the linear look with the
file's matrix. Printed is the peak signal-to-noise ratio of one against the other in sRGB coding, dE2000 and SSIM, without
denoising and with each way of it. Exposure is undone, so that dark captures count as they are shown.

The smooth scene has gradients, soft blobs and a few edges. Textures are pictures of the Kodak and McMaster sets as a sensor
of 20000, 5000 and 1250 electrons at white would see them. Numbers of the filter were tuned on the set "tune"; on "seen" the
measurement of noise was looked at; "judge" has others. Needs numpy, scipy, tifffile and Pillow.
"""
import argparse
import subprocess
import tempfile
from pathlib import Path

import numpy as np
import tifffile
from PIL import Image
from scipy.ndimage import gaussian_filter

SETS = {
    "tune": ["kodak/kodim01", "kodak/kodim05", "kodak/kodim23", "mcm/01", "mcm/09", "mcm/13"],
    "seen": ["kodak/kodim03", "kodak/kodim13", "kodak/kodim19", "mcm/05", "mcm/11", "mcm/17"],
    "judge": ["kodak/kodim07", "kodak/kodim11", "kodak/kodim17", "mcm/03", "mcm/07", "mcm/15"],
}
SRGB = np.array([[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]])
# Of a common full-frame camera, XYZ under D65 to camera RGB.
CAMERA = np.array([[0.9020, -0.2890, -0.0715], [-0.4535, 1.2436, 0.2348], [-0.0934, 0.1919, 0.7086]])
BLACK, WHITE = 512, 15892
CUT = 12


def decode(v):
    return np.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4)


def encode(v):
    v = np.clip(v, 0, 1)
    return np.where(v <= 0.0031308, 12.92 * v, 1.055 * v ** (1 / 2.4) - 0.055)


def smooth_scene(height=768, width=1152):
    """Linear sRGB: gradients, soft blobs, a few discs with edges as a lens leaves them."""
    random = np.random.default_rng(1)
    y, x = np.mgrid[0:height, 0:width] / width
    scene = (0.08 + 0.35 * x)[..., None] * [1.0, 0.9, 0.8] + (0.1 * y)[..., None] * [0.6, 0.9, 1.3]

    def lay(cover, colour):
        nonlocal scene
        scene = scene * (1 - cover[..., None]) + cover[..., None] * colour

    for _ in range(24):
        at, size, colour = random.random(2) * [1, height / width], 0.02 + 0.1 * random.random(), 0.6 * random.random(3)
        lay(0.8 * np.exp(-((x - at[0]) ** 2 + (y - at[1]) ** 2) / (2 * size**2)), colour)
    for _ in range(12):
        at, size, colour = random.random(2) * [1, height / width], 0.01 + 0.06 * random.random(), 0.6 * random.random(3)
        edge = (np.hypot(x - at[0], y - at[1]) - size) * width / 0.7
        lay(1 / (1 + np.exp(np.clip(edge, -50, 50))), colour)
    return np.clip(scene, 0, 1)


def texture(path):
    pixels = decode(np.asarray(Image.open(path).convert("RGB")) / 255.0)
    return pixels[: pixels.shape[0] // 2 * 2, : pixels.shape[1] // 2 * 2]


def bayer(light):
    """What an RGGB array lets through of camera RGB."""
    out = np.empty(light.shape[:2])
    for y, x, c in [(0, 0, 0), (0, 1, 1), (1, 0, 1), (1, 1, 2)]:
        out[y::2, x::2] = light[y::2, x::2, c]
    return out


def mosaic(scene):
    """Light under an RGGB array, 1 = the largest channel of white; and camera RGB of white."""
    matrix = CAMERA @ SRGB
    neutral = matrix @ np.ones(3)
    return bayer(np.maximum(scene @ (matrix / neutral.max()).T, 0)), neutral / neutral.max()


def exposed(light, electrons, read, seed):
    """Counts of a sensor with so many electrons at saturation; without noise where there is no seed."""
    share = light
    if seed is not None:
        random = np.random.default_rng(seed)
        share = (random.poisson(light * electrons) + read * random.standard_normal(light.shape)) / electrons
    return np.clip(np.round(BLACK + share * (WHITE - BLACK)), 0, WHITE).astype(np.uint16)


def write_dng(path, counts, neutral, camera=CAMERA):
    rational = lambda numbers: [n for v in numbers for n in (int(round(v * 10000)), 10000)]
    tags = [
        (271, "s", 0, "Darkroot", True),
        (272, "s", 0, "Compared", True),
        (33421, "H", 2, (2, 2), True),
        (33422, "B", 4, (0, 1, 1, 2), True),
        (50706, "B", 4, (1, 4, 0, 0), True),
        (50708, "s", 0, "Darkroot Compared", True),
        (50714, "H", 1, BLACK, True),
        (50717, "H", 1, WHITE, True),
        (50721, "2i", 9, rational(camera.ravel()), True),
        (50778, "H", 1, 21, True),
    ]
    if neutral is not None:
        tags.append((50728, "2I", 3, rational(neutral), True))
    tifffile.imwrite(path, counts, photometric=32803, compression=None, extratags=tags, metadata=None, software=False)


def develop(program, raw, out, options, stops):
    command = [program, "develop", raw, "-o", out, "--look", "linear", "--profile", "matrix", "--exposure", str(stops)]
    command += ["--bits", "32", "--crop", "active", "-q", "--overwrite", *options]
    subprocess.run([str(word) for word in command], check=True)
    return tifffile.imread(out).astype(np.float64)


def lab(rgb):
    xyz = np.clip(decode(rgb), 0, 1) @ SRGB.T / (SRGB @ np.ones(3))
    f = np.where(xyz > 216 / 24389, np.cbrt(xyz), (24389 / 27 * xyz + 16) / 116)
    return np.stack([116 * f[..., 1] - 16, 500 * (f[..., 0] - f[..., 1]), 200 * (f[..., 1] - f[..., 2])], -1)


def de2000(one, two):
    l1, a1, b1 = np.moveaxis(one, -1, 0)
    l2, a2, b2 = np.moveaxis(two, -1, 0)
    mean = (np.hypot(a1, b1) + np.hypot(a2, b2)) / 2
    g = 0.5 * (1 - np.sqrt(mean**7 / (mean**7 + 25.0**7)))
    a1, a2 = a1 * (1 + g), a2 * (1 + g)
    c1, c2 = np.hypot(a1, b1), np.hypot(a2, b2)
    h1, h2 = np.degrees(np.arctan2(b1, a1)) % 360, np.degrees(np.arctan2(b2, a2)) % 360
    turn = (h2 - h1 + 180) % 360 - 180
    turn = np.where(c1 * c2 == 0, 0, turn)
    dh = 2 * np.sqrt(c1 * c2) * np.sin(np.radians(turn) / 2)
    hue = np.where(c1 * c2 == 0, h1 + h2, (h1 + turn / 2) % 360)
    light, chroma = (l1 + l2) / 2, (c1 + c2) / 2
    cos = lambda k, off: np.cos(np.radians(k * hue + off))
    t = 1 - 0.17 * cos(1, -30) + 0.24 * cos(2, 0) + 0.32 * cos(3, 6) - 0.20 * cos(4, -63)
    sl = 1 + 0.015 * (light - 50) ** 2 / np.sqrt(20 + (light - 50) ** 2)
    sc, sh = 1 + 0.045 * chroma, 1 + 0.015 * chroma * t
    rt = -2 * np.sqrt(chroma**7 / (chroma**7 + 25.0**7)) * np.sin(np.radians(60 * np.exp(-(((hue - 275) / 25) ** 2))))
    l, c, h = (l2 - l1) / sl, (c2 - c1) / sc, dh / sh
    return np.sqrt(l * l + c * c + h * h + rt * c * h)


def ssim(one, two):
    one, two = one @ [0.2126, 0.7152, 0.0722], two @ [0.2126, 0.7152, 0.0722]
    blur = lambda v: gaussian_filter(v, 1.5, truncate=3.5)
    m1, m2 = blur(one), blur(two)
    v1, v2, v12 = blur(one * one) - m1 * m1, blur(two * two) - m2 * m2, blur(one * two) - m1 * m2
    c1, c2 = 0.01**2, 0.03**2
    return ((2 * m1 * m2 + c1) * (2 * v12 + c2) / ((m1**2 + m2**2 + c1) * (v1 + v2 + c2))).mean()


def figures(truth, seen):
    one, two = encode(truth)[CUT:-CUT, CUT:-CUT], encode(seen)[CUT:-CUT, CUT:-CUT]
    psnr = -10 * np.log10(((one - two) ** 2).mean())
    return psnr, de2000(lab(one), lab(two)).mean(), ssim(one, two)


def cases(pictures, names, stops):
    light, neutral = mosaic(smooth_scene())
    for stop in stops:
        yield f"smooth {stop}", "smooth", 0.55 * light * 2.0**stop, neutral, 60000, 5, -stop - np.log2(0.55)
    for electrons in (20000, 5000, 1250):
        for name in names:
            light, neutral = mosaic(texture(pictures / f"{name}.png"))
            yield f"textures {electrons}", name, 0.95 * light, neutral, electrons / 0.95, 3, -np.log2(0.95)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--darkroot", required=True)
    parser.add_argument("--pictures", type=Path, required=True)
    parser.add_argument("--work", type=Path, help="keeps the files; without it they are deleted")
    parser.add_argument("--set", choices=SETS, default="judge")
    parser.add_argument("--with", dest="options", nargs="*", default=["auto", "best"], help="values of --denoise to compare")
    parser.add_argument("--each", action="store_true", help="a line for each picture")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        work = arguments.work or Path(temporary)
        work.mkdir(exist_ok=True, parents=True)
        run(arguments, work)


def run(arguments, work):
    ways = {"off": ["--denoise", "off"]}
    for option in arguments.options:
        ways[option] = ["--denoise", "1" if option == "auto" else option]
    table = {}
    for group, name, light, neutral, electrons, read, stops in cases(arguments.pictures, SETS[arguments.set], (-4, -6)):
        raw, out = work / "capture.dng", work / "developed.tif"
        write_dng(raw, exposed(light, electrons, read, None), neutral)
        truth = develop(arguments.darkroot, raw, out, ways["off"], stops)
        write_dng(raw, exposed(light, electrons, read, 5), neutral)
        row = [figures(truth, develop(arguments.darkroot, raw, out, way, stops)) for way in ways.values()]
        table.setdefault(group, []).append(row)
        if arguments.each:
            print(f"{group:<16} {name:<14}", *["%6.2f dB %5.2f dE %.4f" % f for f in row], flush=True)
    print(f"{'':<16}", *[f"{way:>24}" for way in ways])
    for group, rows in table.items():
        print(f"{group:<16}", *["%7.2f dB %5.2f dE %.4f" % tuple(f) for f in np.mean(rows, 0)])


if __name__ == "__main__":
    main()
