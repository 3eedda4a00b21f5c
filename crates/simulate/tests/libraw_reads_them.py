#!/usr/bin/env python3
"""LibRaw (rawpy) and Adobe's DNG SDK (dngpy) read the files of `make_raw`: the samples, levels, white balance and
filters are those that went in.

Run from the workspace: python3 crates/simulate/tests/libraw_reads_them.py
"""
import os
import re
import subprocess
import sys
import tempfile

try:
    import numpy as np
    import rawpy
except ImportError:
    print("skipped")
    sys.exit(0)
try:
    import dngpy
except ImportError:
    dngpy = None
    print("dngpy is missing: DNG files are checked with LibRaw only")

MAKE = ["cargo", "run", "-q", "--release", "-p", "darkroot-simulate", "--example", "make_raw", "--"]
XTRANS = "GBGGRG/RGRBGB/GBGGRG/GRGGBG/BGBRGR/GRGGBG"

CASES = [
    ("nef", "lossless 14", []),
    ("nef", "lossless 12", ["--bits", "12"]),
    ("nef", "uncompressed 14", ["--storage", "uncompressed"]),
    ("nef", "uncompressed 12", ["--storage", "uncompressed", "--bits", "12"]),
    ("nef", "turned", ["--orientation", "8"]),
    ("nef", "tungsten", ["--tungsten"]),
    ("nef", "clipped", ["--stops", "3"]),
    ("dng", "tiles", []),
    ("dng", "strip", ["--storage", "jpeg-strip"]),
    ("dng", "uncompressed", ["--storage", "uncompressed"]),
    ("dng", "GRBG", ["--cfa", "GRBG"]),
    ("dng", "GBRG", ["--cfa", "GBRG"]),
    ("dng", "BGGR", ["--cfa", "BGGR"]),
    ("dng", "X-Trans", ["--cfa", "xtrans"]),
    ("dng", "linear", ["--linear"]),
    ("dng", "linear uncompressed", ["--linear", "--storage", "uncompressed"]),
    ("dng", "masked", ["--masked", "10x6"]),
    ("dng", "turned", ["--orientation", "6"]),
    ("dng", "tungsten", ["--tungsten"]),
    ("dng", "clipped", ["--stops", "3"]),
    ("dng", "no noise", ["--no-noise"]),
    ("dng", "odd width", ["--width", "301"]),
]


def check(folder, kind, name, options):
    path, counts = os.path.join(folder, "a." + kind), os.path.join(folder, "counts")
    size = ["--width", "300", "--height", "200"]
    arguments = ["--format", kind, "--out", path, "--counts", counts] + size + options
    facts = subprocess.run(MAKE + arguments, check=True, capture_output=True, text=True).stderr
    width, height, black, white = (
        int(re.search(word + r":? (\d+)", facts)[1]) for word in ("width", "height", "black", "white"))
    neutral = [float(v) for v in re.search(r"neutral (\S+) (\S+) (\S+)", facts).groups()]
    planes = 3 if "--linear" in options else 1
    truth = np.fromfile(counts, "<u2").reshape(height, width, planes)

    with rawpy.imread(path) as raw:
        samples = raw.raw_image
        samples = samples[..., :3] if planes == 3 else samples[..., None]
        assert np.array_equal(samples, truth), "LibRaw: samples"
        assert all(b == black for b in raw.black_level_per_channel[:3]), raw.black_level_per_channel
        assert raw.white_level == white, raw.white_level
        balance = np.array(raw.camera_whitebalance[:3])
        ratio = balance * neutral
        assert np.ptp(ratio) / ratio.mean() < 1e-3, ("LibRaw: white balance", balance, neutral)
        if planes == 1:
            letters = np.array(list("RGBG"))[raw.raw_pattern]
            rows = "/".join("".join(row) for row in letters)
            given = options[options.index("--cfa") + 1] if "--cfa" in options else "RGGB"
            expected = XTRANS if given == "xtrans" else given[:2] + "/" + given[2:]
            left, top = raw.sizes.left_margin, raw.sizes.top_margin
            if name == "masked":
                assert (left, top) == (10, 6), (left, top)
                shifted = np.roll(np.array([list(r) for r in expected.split("/")]), (-top, -left), (0, 1))
                expected = "/".join("".join(r) for r in shifted)
            assert rows == expected, (rows, expected)
        assert raw.postprocess(half_size=True).mean() > 5

    if kind == "dng" and dngpy:
        adobe = np.asarray(dngpy.Dng(path).raw_pixels).reshape(truth.shape)
        assert np.array_equal(adobe, truth), "Adobe DNG SDK: samples"
    print("ok", kind, name, os.path.getsize(path), "bytes")


def main():
    failures = 0
    with tempfile.TemporaryDirectory() as folder:
        for case in CASES:
            try:
                check(folder, *case)
            except Exception as error:  # One bad file must not hide the others.
                print("FAILED", *case[:2], repr(error))
                failures += 1
    sys.exit(1 if failures else 0)


main()
