#!/usr/bin/env python3
"""Develops raw files with Darkroot (--look linear, the camera's matrix) and with LibRaw, and compares them.

usage: compare.py DARKROOT FILE...   exit code 1 when a file differs by a mean of more than 0.5 dE2000

Both pictures are linear sRGB. They are averaged over 8 x 8 pixels, so that demosaicing does not count; blocks with
clipped samples are left out. Prints "skipped" when rawpy, numpy or tifffile is not installed.
"""
import subprocess
import sys
import tempfile

try:
    import numpy as np
    import rawpy
    import tifffile
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(0)

LIMIT = 0.5
BLOCK = 8


def lab(rgb):
    """CIELAB (D65) of linear sRGB."""
    m = np.array([[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]])
    xyz = rgb @ m.T / m.sum(axis=1)
    f = np.where(xyz > 216 / 24389, np.cbrt(np.maximum(xyz, 1e-12)), (24389 / 27 * xyz + 16) / 116)
    return np.stack([116 * f[..., 1] - 16, 500 * (f[..., 0] - f[..., 1]), 200 * (f[..., 1] - f[..., 2])], -1)


def de2000(one, two):
    """CIEDE2000 after Sharma, Wu, Dalal 2005."""
    l1, a1, b1 = np.moveaxis(one, -1, 0)
    l2, a2, b2 = np.moveaxis(two, -1, 0)
    c7 = ((np.hypot(a1, b1) + np.hypot(a2, b2)) / 2) ** 7
    g = 0.5 * (1 - np.sqrt(c7 / (c7 + 25.0**7)))
    a1, a2 = a1 * (1 + g), a2 * (1 + g)
    c1, c2 = np.hypot(a1, b1), np.hypot(a2, b2)
    h1, h2 = np.degrees(np.arctan2(b1, a1)) % 360, np.degrees(np.arctan2(b2, a2)) % 360
    dh = (h2 - h1 + 180) % 360 - 180
    big = 2 * np.sqrt(c1 * c2) * np.sin(np.radians(dh / 2))
    h = (h1 + dh / 2) % 360
    l, c = (l1 + l2) / 2, (c1 + c2) / 2
    cos = lambda d: np.cos(np.radians(d))
    t = 1 - 0.17 * cos(h - 30) + 0.24 * cos(2 * h) + 0.32 * cos(3 * h + 6) - 0.2 * cos(4 * h - 63)
    sl = 1 + 0.015 * (l - 50) ** 2 / np.sqrt(20 + (l - 50) ** 2)
    sc, sh = 1 + 0.045 * c, 1 + 0.015 * c * t
    rt = -2 * np.sqrt(c**7 / (c**7 + 25.0**7)) * np.sin(np.radians(60 * np.exp(-(((h - 275) / 25) ** 2))))
    dl, dc, dh = (l2 - l1) / sl, (c2 - c1) / sc, big / sh
    return np.sqrt(np.maximum(dl**2 + dc**2 + dh**2 + rt * dc * dh, 0))


def small(picture):
    h, w = (n // BLOCK * BLOCK for n in picture.shape[:2])
    return picture[:h, :w].reshape(h // BLOCK, BLOCK, w // BLOCK, BLOCK, 3)


def libraw(path, matrix):
    with rawpy.imread(path) as raw:
        # No scaling by the frame's own maximum: levels as the file has them.
        rgb = raw.postprocess(
            use_camera_wb=True, no_auto_bright=True, gamma=(1, 1), output_bps=16, output_color=rawpy.ColorSpace.sRGB,
            highlight_mode=rawpy.HighlightMode.Clip, adjust_maximum_thr=0, user_flip=0,
        )
        sizes = raw.sizes
        return rgb / 65535.0, (sizes.left_margin, sizes.top_margin)


def darkroot(program, path, folder):
    out = f"{folder}/out.tif"
    command = [program, "develop", "-q", "--overwrite", "--look", "linear", "--highlights", "keep", "--profile", "matrix",
               "--bits", "16", "--crop", "active", "-o", out, path]
    subprocess.run(command, check=True)
    return tifffile.imread(out) / 65535.0


def align(one, two):
    """Shifts the larger picture over the smaller one to where they agree best: crops differ by a few pixels."""
    h, w = min(one.shape[0], two.shape[0]), min(one.shape[1], two.shape[1])
    best = None
    for dy in range(one.shape[0] - h + 1):
        for dx in range(one.shape[1] - w + 1):
            for ey in range(two.shape[0] - h + 1):
                for ex in range(two.shape[1] - w + 1):
                    if dy > 40 or dx > 60 or ey > 40 or ex > 60:
                        continue
                    a = one[dy + 100 : dy + h - 100 : 7, dx + 100 : dx + w - 100 : 7, 1]
                    b = two[ey + 100 : ey + h - 100 : 7, ex + 100 : ex + w - 100 : 7, 1]
                    error = np.abs(a - b).mean()
                    if best is None or error < best[0]:
                        best = (error, dy, dx, ey, ex)
    _, dy, dx, ey, ex = best
    return one[dy : dy + h, dx : dx + w], two[ey : ey + h, ex : ex + w]


def main():
    program, files = sys.argv[1], sys.argv[2:]
    failed = False
    for path in files:
        with tempfile.TemporaryDirectory() as folder:
            ours, (theirs, _) = darkroot(program, path, folder), libraw(path, True)
        ours, theirs = align(ours, theirs)
        a, b = small(ours), small(theirs)
        clipped = (np.maximum(a, b) > 0.98).any(axis=(1, 3, 4))
        a, b = a.mean(axis=(1, 3)), b.mean(axis=(1, 3))
        keep = ~clipped
        gain = np.median(a[keep][:, 1] / np.maximum(b[keep][:, 1], 1e-6))
        difference = de2000(lab(a[keep]), lab(b[keep]))
        verdict = "ok" if difference.mean() < LIMIT else "DIFFERENT"
        failed |= verdict != "ok"
        print(f"{verdict}: {path.split('/')[-1]}: dE2000 mean {difference.mean():.3f}, 95 % {np.percentile(difference, 95):.3f}, "
              f"max {difference.max():.2f}; {keep.mean():.0%} of blocks; median ratio of green {gain:.4f}")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
