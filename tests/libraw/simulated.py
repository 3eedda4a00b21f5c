#!/usr/bin/env python3
"""LibRaw opens simulated raw files and finds the same samples: simulated.py MAKE_RAW

MAKE_RAW is the example of `darkroot-simulate`. Prints "skipped" when rawpy or numpy is not installed.
"""
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import numpy
    import rawpy
except ImportError as missing:
    print(f"skipped: {missing.name} is not installed")
    sys.exit(0)

CASES = [
    "--format nef --storage uncompressed",
    "--format nef --storage lossless",
    "--format nef --storage lossless --bits 12",
    "--format dng --storage uncompressed",
    "--format dng --storage jpeg-strip",
    "--format dng --storage jpeg-tiles",
    "--format dng --storage jpeg-tiles --cfa xtrans",
    "--format dng --storage uncompressed --cfa GBRG --orientation 6",
    "--format dng --storage uncompressed --masked 16x8",
]

failed = 0
with tempfile.TemporaryDirectory() as folder:
    for case in CASES:
        raw, counts = Path(folder, "a.raw"), Path(folder, "counts")
        size = "--width 360 --height 240"
        command = f"{sys.argv[1]} {case} {size} --out {raw} --counts {counts}"
        subprocess.run(command.split(), check=True, capture_output=True)
        ours = numpy.fromfile(counts, "<u2")
        with rawpy.imread(str(raw)) as opened:
            theirs = opened.raw_image.copy()
        # LibRaw keeps a right or bottom border of some files; ours is the frame as it is stored.
        same = theirs.size == ours.size and (theirs.ravel() == ours).all()
        if not same and theirs.size > ours.size:
            rows = ours.size // 360
            same = (theirs[:rows, :360] == ours.reshape(rows, 360)).all()
        print(f"{'same' if same else 'DIFFERENT':10} {case}")
        failed += not same
sys.exit(1 if failed else 0)
