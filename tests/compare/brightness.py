#!/usr/bin/env python3
"""How bright the default look is beside what cameras show.

    brightness.py DARKROOT FILE.. [--option ..]

Develops each raw file with the program's defaults, takes the JPEG that the camera embedded, brings both to one size, and
prints L* (D65) of the two: their means, their 99th percentiles, the differences, and the share of pixels that the preview
shows below L* 97 and the developed picture at 99.5 or above. Files without a preview are left out. What comes after a file
name and begins with a dash goes to `darkroot develop`.

Needs numpy and Pillow. Exits with 1 where a mean is more than 5 away, the mean of the distances more than 2.5, or a 99th
percentile more than 4.
"""

import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from PIL import Image

LONG_SIDE = 640


def light(pixels):
    """Linear light of sRGB, 0..=1."""
    v = np.asarray(pixels, dtype=np.float64) / 255
    return np.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4)


def lightness(pixels):
    """L* of sRGB pixels."""
    y = light(pixels) @ [0.2126, 0.7152, 0.0722]
    return np.where(y > 216 / 24389, 116 * np.cbrt(y) - 16, y * 24389 / 27)


def reduced(path, like=None):
    """The picture at most LONG_SIDE long; turned and cut about its middle to the shape of `like`."""
    picture = Image.open(path).convert("RGB")
    if like is not None:
        w, h = like
        if (w > h) != (picture.width > picture.height):
            picture = picture.rotate(90, expand=True)
        share = min(picture.width / w, picture.height / h)
        x, y = (picture.width - w * share) / 2, (picture.height - h * share) / 2
        return picture.resize(like, Image.Resampling.BOX, box=(x, y, x + w * share, y + h * share))
    scale = min(1, LONG_SIDE / max(picture.size))
    return picture.resize([max(1, round(scale * v)) for v in picture.size], Image.Resampling.BOX)


def run(*command):
    return subprocess.run([str(c) for c in command], capture_output=True, text=True)


def main():
    program, *rest = sys.argv[1:]
    files = [pathlib.Path(a) for a in rest if not a.startswith("-")]
    options = [a for a in rest if a.startswith("-")]
    print(f"{'file':42} {'L* mean':>13} {'differs':>8} {'p99':>13} {'differs':>8} {'cut':>7}")
    means, tops = [], []
    with tempfile.TemporaryDirectory() as folder:
        preview, ours = pathlib.Path(folder, "preview.jpg"), pathlib.Path(folder, "ours.png")
        for file in files:
            preview.unlink(missing_ok=True)
            ours.unlink(missing_ok=True)
            run(program, "inspect", file, "--preview", preview)
            if not preview.exists():
                continue
            done = run(program, "develop", file, "-o", ours, *options)
            if done.returncode != 0:
                print(f"{file.name:42} {done.stderr.strip()}")
                continue
            shown = reduced(preview)
            theirs, own = lightness(shown), lightness(reduced(ours, shown.size))
            tops.append(np.percentile(own, 99) - np.percentile(theirs, 99))
            means.append(own.mean() - theirs.mean())
            cut = ((own >= 99.5) & (theirs < 97)).mean()
            print(
                f"{file.name:42} {own.mean():6.1f} {theirs.mean():6.1f} {means[-1]:+8.1f}"
                f" {np.percentile(own, 99):6.1f} {np.percentile(theirs, 99):6.1f} {tops[-1]:+8.1f} {cut:7.2%}"
            )
    if not means:
        sys.exit("no file with a preview")
    means, tops = np.abs(means), np.abs(tops)
    print(f"mean of the distances {means.mean():.2f}, largest {means.max():.2f}; p99 {tops.mean():.2f}, {tops.max():.2f}")
    sys.exit(means.mean() > 2.5 or means.max() > 5 or tops.max() > 4)


if __name__ == "__main__":
    main()
