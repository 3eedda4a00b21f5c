#!/usr/bin/env python3
"""Other programs find in a linear DNG of Darkroot's what Darkroot finds in the raw file: linear_dng.py DARKROOT RAW...

Each raw file is developed to a DNG and, in the linear look, to a TIFF. Adobe's DNG SDK must read the samples bit for bit as the
TIFF of camera RGB has them, and LibRaw them balanced; what the DNG specification makes of samples, matrix and table must be the
colours of the TIFF, and RawTherapee must show them. darktable knows matrices only: its colours are shown, not judged.

Needs numpy and tifffile; dngpy and rawpy (PyPI), rawtherapee-cli with transicc (Debian: rawtherapee, liblcms2-utils) and
darktable-cli where they can be had; says which is missing. Exit code 1 when samples differ by more than a step, or colours by
a mean of more than 0.1 dE2000 by the specification and 1 in RawTherapee.
"""
import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import chart

try:
    import numpy as np
    import tifffile
except ImportError as missing:
    print(f"skipped: {missing.name} is not installed (PyPI: numpy, tifffile)")
    sys.exit(0)

import rawtherapee

BLOCK, LIMIT = 16, 1.0
PROPHOTO = np.array([[0.7976749, 0.1351917, 0.0313534], [0.2880402, 0.7118741, 0.0000857], [0, 0, 0.8252100]])


def blocks(picture):
    """Means of squares of pixels."""
    height, width = (n // BLOCK for n in picture.shape[:2])
    cut = picture[: height * BLOCK, : width * BLOCK].astype(float)
    return cut.reshape(height, BLOCK, width, BLOCK, 3).mean((1, 3)).reshape(-1, 3)


def flat(picture):
    """Which of the squares are even: means of coded numbers tell their colours."""
    spread = np.sqrt(np.maximum(blocks(picture.astype(float) ** 2) - blocks(picture) ** 2, 0))
    return (spread < 0.03 * blocks(picture)).all(1)


def cut_to(picture, size):
    """The middle of a picture."""
    y, x = ((have - want) // 2 for have, want in zip(picture.shape[:2], size))
    return picture[y : y + size[0], x : x + size[1]]


def judged(what, found, wanted, good, limit=LIMIT):
    """Colours as XYZ, of the same luminance together; the reddest of what a screen does not show left out."""
    found, wanted = found[good], wanted[good]
    found = found * (wanted[:, 1].mean() / found[:, 1].mean())
    return chart.judge(what, found, wanted, limit)


def sdk(path, raw, multipliers):
    try:
        import dngpy
    except ImportError:
        print("  skipped: dngpy is not installed")
        return True
    photo = dngpy.Dng(str(path))
    samples = np.asarray(photo.raw_pixels).astype(int)
    wanted = np.clip(65535 * raw / multipliers, 0, 65535).round().astype(int)
    off = np.abs(samples - wanted).max()
    print(f"  Adobe's SDK: samples within {off} of 65535, baseline exposure {photo.get_baseline_exposure():+.2f}")
    return off <= 1


def libraw(path, raw):
    try:
        import rawpy
    except ImportError:
        print("  skipped: rawpy is not installed")
        return True
    with rawpy.imread(str(path)) as photo:
        found = photo.postprocess(
            use_camera_wb=True, output_color=rawpy.ColorSpace.raw, gamma=(1, 1), no_auto_bright=True, output_bps=16, user_flip=0,
            highlight_mode=rawpy.HighlightMode.Ignore, user_sat=65535, adjust_maximum_thr=0,
        ).astype(float)
    found, wanted = blocks(found), blocks(raw)
    good = (wanted.max(1) < 0.8) & (wanted.min(1) > 0.02)
    ratio = found[good] / wanted[good]
    spread = np.abs(ratio / np.median(ratio) - 1)
    print(f"  LibRaw: balanced samples in proportion to {np.median(spread):.4f}, at most {np.quantile(spread, 0.999):.4f}")
    return np.quantile(spread, 0.999) < 0.02


def specification(path, balanced):
    """XYZ by forward matrix and table: DNG 1.7.1, chapter 6."""
    with tifffile.TiffFile(path) as file:
        tags = {tag.code: tag.value for tag in file.pages[0].tags}
    matrix = np.array(tags[50964], float).reshape(9, 2)
    xyz = balanced @ (matrix[:, 0] / matrix[:, 1]).reshape(3, 3).T
    hues, saturations, _ = tags[50937]
    table = np.array(tags[50938], float).reshape(hues, saturations, 3)
    rgb = np.maximum(xyz @ np.linalg.inv(PROPHOTO).T, 0)
    red, green, blue = rgb.T
    value = rgb.max(1)
    range_ = np.maximum(value - rgb.min(1), 1e-12)
    hue = np.select([value == red, value == green], [(green - blue) / range_, 2 + (blue - red) / range_], 4 + (red - green) / range_) % 6
    saturation = range_ / np.maximum(value, 1e-12)
    across, up = hue * hues / 6, saturation * (saturations - 1)
    h, s = np.minimum(across.astype(int), hues - 1), np.minimum(up.astype(int), saturations - 2)
    share_h, share_s = (across - h)[:, None], (up - s)[:, None]
    along = [table[i % hues, s] * (1 - share_s) + table[i % hues, s + 1] * share_s for i in (h, h + 1)]
    shift, factor, gain = (along[0] * (1 - share_h) + along[1] * share_h).T
    hue, saturation, value = (hue + shift / 60) % 6, np.minimum(saturation * factor, 1), value * gain
    channel = lambda n: value * (1 - saturation * np.clip(np.minimum((n + hue) % 6, 4 - (n + hue) % 6), 0, 1))
    return np.stack([channel(5), channel(3), channel(1)], 1) @ PROPHOTO.T


def in_rawtherapee(path, folder, wanted, good, size):
    if not all(map(shutil.which, rawtherapee.TOOLS)):
        print(f"  skipped: not all of {', '.join(rawtherapee.TOOLS)} are installed")
        return True
    out = folder / "rt.tif"
    rawtherapee.develop(path, out, "(embedded)")
    found = blocks(cut_to(tifffile.imread(out), size)) / 65535
    return judged("RawTherapee", rawtherapee.xyz(found), wanted, good)


def darktable(path, folder, wanted, good, size):
    if not shutil.which("darktable-cli"):
        print("  skipped: darktable-cli is not installed")
        return
    out = folder / "dt.tif"
    command = ["darktable-cli", path, out, "--icc-type", "LIN_REC2020", "--apply-custom-presets", "false", "--core"]
    command += ["--configdir", folder / "dt", "--library", ":memory:"]
    command += ["--conf", "plugins/darkroom/workflow=none", "--conf", "plugins/imageio/format/tiff/bpp=32",
                "--conf", "plugins/imageio/format/tiff/compress=0"]
    done = subprocess.run(command, capture_output=True, text=True)
    if not out.exists():
        print(f"  darktable: {done.stdout.strip()[-200:]} {done.stderr.strip()[-200:]}")
        return
    found = blocks(cut_to(tifffile.imread(out), size))
    # Linear Rec. 2020 to XYZ, Bradford-adapted to D50.
    matrix = np.array([[0.6734241, 0.1656411, 0.1251286], [0.2790177, 0.6753402, 0.0456377], [-0.0019300, 0.0299784, 0.7973330]])
    judged("darktable, by the matrix alone", found @ matrix.T, wanted, good, limit=np.inf)


def compared(program, raw_file, folder):
    print(raw_file.name)
    dng, tif, camera = folder / "linear.dng", folder / "linear.tif", folder / "camera.tif"
    for out, options in ((dng, []), (tif, ["--space", "prophoto-linear", "--bits", "32"]), (camera, ["--space", "camera"])):
        command = ["develop", str(raw_file), "-o", str(out), "--overwrite", "--look", "linear", "--json", *options]
        about = json.loads(chart.darkroot(program, *command))
    multipliers = np.array(about["multipliers"])
    raw, shown = tifffile.imread(camera), tifffile.imread(tif)
    # The linear look brightens nothing, so neither picture has a gain.
    wanted = blocks(shown) @ PROPHOTO.T
    light = blocks(raw)
    good = (light.max(1) < 0.9) & (wanted[:, 1] > 0.01) & flat(raw)
    right = sdk(dng, raw, multipliers)
    right &= libraw(dng, raw)
    right &= judged("the specification", specification(dng, light), wanted, good, limit=0.1)
    right &= in_rawtherapee(dng, folder, wanted, good, raw.shape[:2])
    darktable(dng, folder, wanted, good, raw.shape[:2])
    return right


if __name__ == "__main__":
    good = True
    for name in sys.argv[2:]:
        with tempfile.TemporaryDirectory() as folder:
            good &= compared(sys.argv[1], Path(name), Path(folder))
    sys.exit(0 if good else 1)
