#!/usr/bin/env python3
"""Automatic white balance beside RawTherapee's, on simulated pictures under lights that people measured.

    white.py --darkroot target/release/darkroot --spectra DATA/spectra [--scenes 3]

Pictures are patches of surfaces (Simon Fraser University, 1995) in uneven light, a third of them mostly of one hue, with a grey
patch of 1 % in a corner; two cameras (Jiang and others, 2013) that no prior of the program holds, 19 of Simon Fraser
University's lights. They are written as DNG that do not tell their white. Printed is the chroma (CIELAB, at L* 50) that each
developer leaves in the grey patch: mean, median, mean of the worst quarter, and the mean for daylight, lamps and mixtures.
Needs numpy, scipy and tifffile.
"""
import argparse
import csv
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import tifffile

sys.path.insert(0, str(Path(__file__).parent))
from denoise import SRGB, bayer, decode, encode, exposed, lab, write_dng  # noqa: E402

# The same lights as in tests/colour_correction/auto_white.rs.
LIGHTS = [2, 4, 6, 10, 11, 19, 24, 26, 29, 32, 43, 55, 59, 67, 72, 78, 87, 88, 91]
CAMERAS = ["cam_camspec_canon_40d", "cam_camspec_nikon_d90"]
WAVES = np.arange(400, 701, 10.0)
PATCH, ACROSS, DOWN = 24, 24, 16
RECIPE = """[Version]
AppVersion=5.9
Version=349
[White Balance]
Enabled=true
Setting={setting}
[Exposure]
Auto=false
HistogramMatching=false
"""


def read(path, name=None):
    """The spectra of a table, or the one of that name."""
    head, *rows = csv.reader(path.read_text().splitlines())
    waves = np.array([float(v) for v in head[1:]])
    rows = [row for row in rows if name in (None, row[0])]
    return np.array([np.interp(WAVES, waves, [float(v) for v in row[1:]]) for row in rows])


def picture(random, surfaces, sensitivities, light):
    """Camera RGB of a picture, its brightest channel 0.9, in places of a grid; the grey patch is the first row's begin."""
    responses = surfaces @ (sensitivities * light).T
    white = (sensitivities * light).sum(1)
    share = responses / white
    hue = np.arctan2(share[:, 0] - share[:, 2], share[:, 1] - share.mean(1))
    some = np.arange(len(surfaces))
    if random.random() < 1 / 3:
        turn = np.abs((hue - random.uniform(-np.pi, np.pi) + np.pi) % (2 * np.pi) - np.pi)
        some = np.argsort(turn)[: len(surfaces) // 8]
    chosen = random.choice(some, random.integers(8, 60))
    places = random.random((len(chosen), 2)) * [DOWN, ACROSS]
    y, x = np.mgrid[0:DOWN, 0:ACROSS] + 0.5
    nearest = ((y[..., None] - places[:, 0]) ** 2 + (x[..., None] - places[:, 1]) ** 2).argmin(-1)
    uneven = 0.4 + 0.6 * np.cos((x / ACROSS - random.random()) * 1.2) * np.cos((y / DOWN - random.random()) * 1.2)
    out = responses[chosen][nearest] * uneven[..., None]
    out[:2, :2] = 0.3 * white
    return 0.9 * out / out.max()


def matrix(sensitivities, daylight, observer, chart):
    """XYZ to camera RGB under daylight, as makers publish it: white to white."""
    xyz, camera = chart @ (observer * daylight).T, chart @ (sensitivities * daylight).T
    xyz /= (observer[1] * daylight).sum()
    camera /= (sensitivities * daylight).sum(1).max()
    return np.linalg.lstsq(xyz, camera, rcond=None)[0].T


def left(rgb):
    """Chroma of encoded sRGB, brought to L* 50."""
    light = np.maximum(decode(rgb), 1e-6)
    colour = lab(encode(light * 0.184 / (light @ SRGB[1])))
    return np.hypot(colour[1], colour[2])


def by_darkroot(program, raw, out):
    command = [program, "develop", raw, "-o", out, "--white-balance", "auto", "--bits", "16", "--overwrite", "-q"]
    subprocess.run([str(w) for w in command], check=True)


def by_rawtherapee(setting, raw, out):
    recipe = out.with_suffix(".pp3")
    recipe.write_text(RECIPE.format(setting=setting))
    command = ["rawtherapee-cli", "-Y", "-o", out, "-p", recipe, "-t", "-b16", "-c", raw]
    subprocess.run([str(w) for w in command], check=True, capture_output=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--darkroot", required=True)
    parser.add_argument("--spectra", type=Path, required=True)
    parser.add_argument("--scenes", type=int, default=3)
    arguments = parser.parse_args()
    ways = {"Darkroot": lambda raw, out: by_darkroot(arguments.darkroot, raw, out)}
    if shutil.which("rawtherapee-cli"):
        ways["RawTherapee, grey"] = lambda raw, out: by_rawtherapee("autold", raw, out)
        ways["RawTherapee, temperature"] = lambda raw, out: by_rawtherapee("autitcgreen", raw, out)
    surfaces = np.clip(read(arguments.spectra / "sfu1995_380-780_4.csv"), 0, 1)
    lights = read(arguments.spectra / "illum_sfu_measured.csv")[LIGHTS]
    observer = read(arguments.spectra / "cie1931_cmf_380-780_5.csv")
    daylight = read(arguments.spectra / "cie_illuminants_380-780_5.csv", "D65")[0]
    chart = read(arguments.spectra / "colorchecker_classic24_babelcolor_380-730_10.csv")
    errors = {way: [] for way in ways}
    with tempfile.TemporaryDirectory() as temporary:
        raw, out = Path(temporary) / "white.dng", Path(temporary) / "white.tif"
        for name in CAMERAS:
            sensitivities = read(arguments.spectra / f"{name}.csv")
            camera = matrix(sensitivities, daylight, observer, chart)
            for number, light in zip(LIGHTS, lights):
                xyz = observer @ light
                for scene in range(arguments.scenes):
                    blocks = picture(np.random.default_rng([number, scene]), surfaces, sensitivities, light)
                    whole = np.repeat(np.repeat(blocks, PATCH, 0), PATCH, 1)
                    write_dng(raw, exposed(bayer(whole), 40000, 4, scene), None, camera)
                    for way, develop in ways.items():
                        out.unlink(missing_ok=True)
                        develop(raw, out)
                        pixels = tifffile.imread(out)[..., :3] / 65535
                        errors[way].append((xyz[0] / xyz.sum(), left(pixels[12:36, 12:36].reshape(-1, 3).mean(0))))
    for way, found in errors.items():
        x, found = np.array(found).T
        worst = np.sort(found)[-len(found) // 4 :].mean()
        kinds = [found[kind].mean() for kind in (x < 0.36, (x >= 0.36) & (x < 0.42), x >= 0.42)]
        print(f"{way:<26} mean {found.mean():.1f}, median {np.median(found):.1f}, worst quarter {worst:.1f};", end=" ")
        print("daylight %.1f, mixtures %.1f, lamps %.1f" % tuple(kinds))


if __name__ == "__main__":
    main()
