#!/usr/bin/env python3
"""RawTherapee with an exported DCP gives Darkroot's colours: dcp.py DARKROOT

A raw file of the chart's patches is made, developed by rawtherapee-cli with the DCP alone (no tone curve, no look),
and its patches, scaled to the same mean luminance, are compared with `darkroot profile apply`. With DCPs of one light, and
with DCPs of two, under each of them and under 4000 K, where both programs interpolate.

Needs rawtherapee-cli (Debian: rawtherapee), transicc (Debian: liblcms2-utils) and numpy; says which is missing. Exit
code 1 when a mean is above 1 dE2000, or above 0.5 where it interpolates: with one of both lights alone it were 0.9.
"""
import struct
import sys
import tempfile
from pathlib import Path

import chart
import numpy as np
import rawtherapee

KELVIN = {17: 2856, 21: 6504}  # By LightSource of Exif.
SIDE = 64  # pixels of a patch
NEUTRAL = {"D65": [0.47, 1.0, 0.68], "A": [0.75, 1.0, 0.35]}


def tiff(fields, magic, pieces=b""):
    """A TIFF-like file of one directory: tag -> (type, values); tag 273 points at the picture."""
    codes = {1: "B", 2: "s", 3: "H", 4: "I", 5: "II", 10: "ii", 11: "f"}
    start = 8 + 2 + 12 * len(fields) + 4
    head, values = struct.pack("<2sHIH", b"II", magic, 8, len(fields)), b""
    sizes = {tag: 4 for tag in [273]}
    packed = {}
    for tag, (kind, content) in fields.items():
        if kind == 2:
            packed[tag] = (len(content) + 1, content.encode() + b"\0")
        elif kind in (5, 10):
            packed[tag] = (len(content), b"".join(struct.pack("<" + codes[kind], round(v * 10**6), 10**6) for v in content))
        else:
            packed[tag] = (len(content), struct.pack(f"<{len(content)}{codes[kind]}", *content))
    total = start + sum(len(b) + len(b) % 2 for _, b in packed.values() if len(b) > 4)
    for tag in sorted(fields):
        count, content = packed[tag]
        if tag in sizes:
            content = struct.pack("<I", total)
        head += struct.pack("<HHI", tag, fields[tag][0], count)
        if len(content) <= 4:
            head += content.ljust(4, b"\0")
        else:
            head += struct.pack("<I", start + len(values))
            values += content + b"\0" * (len(content) % 2)
    return head + b"\0" * 4 + values + pieces


def read_tiff(content):
    """Tags of the first directory of a TIFF or DCP, little-endian."""
    (at,) = struct.unpack_from("<I", content, 4)
    (count,) = struct.unpack_from("<H", content, at)
    fields = {}
    for i in range(count):
        tag, kind, n = struct.unpack_from("<HHI", content, at + 2 + 12 * i)
        code, size = {3: ("H", 2), 4: ("I", 4), 10: ("i", 8), 11: ("f", 4)}.get(kind, ("B", 1))
        place = at + 10 + 12 * i
        if n * size > 4:
            (place,) = struct.unpack_from("<I", content, place)
        fields[tag] = struct.unpack_from(f"<{n * size // struct.calcsize(code)}{code}", content, place)
    return fields


def dng(camera, rgb, neutral, color_matrix):
    """A mosaic of patches, six in a row, with unbalanced camera RGB."""
    patches = (np.clip(rgb * neutral, 0, 1) * 65535).round().astype("<u2").reshape(4, 6, 3)
    pixels = patches.repeat(SIDE, 0).repeat(SIDE, 1)
    mosaic = pixels[..., 1].copy()
    mosaic[::2, ::2], mosaic[1::2, 1::2] = pixels[::2, ::2, 0], pixels[1::2, 1::2, 2]
    height, width = mosaic.shape
    make, model = camera.split(" ", 1)
    fields = {
        254: (4, [0]), 256: (4, [width]), 257: (4, [height]), 258: (3, [16]), 259: (3, [1]), 262: (3, [32803]),
        271: (2, make), 272: (2, model), 273: (4, [0]), 274: (3, [1]), 277: (3, [1]), 278: (4, [height]),
        279: (4, [mosaic.nbytes]), 284: (3, [1]), 33421: (3, [2, 2]), 33422: (1, [0, 1, 1, 2]),
        50706: (1, [1, 4, 0, 0]), 50707: (1, [1, 1, 0, 0]), 50708: (2, camera), 50714: (4, [0]), 50717: (4, [65535]),
        50721: (10, color_matrix), 50728: (5, neutral), 50778: (3, [21]),
    }
    return tiff(fields, 42, mosaic.tobytes())


def developed(path):
    """Mean of the middle of each patch, as XYZ relative to D50."""
    content = path.read_bytes()
    fields = read_tiff(content)
    width, height, rows = fields[256][0], fields[257][0], fields[278][0]
    strips = b"".join(content[o : o + n] for o, n in zip(fields[273], fields[279]))
    picture = np.frombuffer(strips, "<u2").reshape(height, width, 3) / 65535
    y, x = (height - 4 * SIDE) // 2, (width - 6 * SIDE) // 2
    picture = picture[max(y, 0) :, max(x, 0) :]
    quarter = SIDE // 4
    middle = [
        picture[r * SIDE + quarter : (r + 1) * SIDE - quarter, c * SIDE + quarter : (c + 1) * SIDE - quarter].mean((0, 1))
        for r in range(4)
        for c in range(6)
    ]
    return rawtherapee.xyz(np.array(middle))


def matrix(dcp, tag):
    above, below = np.array(dcp[tag], float).reshape(9, 2).T
    return (above / below).reshape(3, 3)


def neutral_between(dcp, kelvin):
    """What the color matrices of a DCP with two lights say of a black body's white: DNG 1.7.1, chapter 6."""
    low, high = (1 / KELVIN[dcp[tag][0]] for tag in (50778, 50779))
    share = (1 / kelvin - high) / (low - high)
    mixed = share * matrix(dcp, 50721) + (1 - share) * matrix(dcp, 50722)
    # Kim and others, 2002: the Planckian locus below 4000 K.
    t = 1e3 / kelvin
    x = -0.2661239 * t**3 - 0.2343589 * t**2 + 0.8776956 * t + 0.179910
    y = -0.9549476 * x**3 - 1.37418593 * x**2 + 2.09137015 * x - 0.16748867
    neutral = mixed @ [x / y, 1, (1 - x - y) / y]
    return neutral / neutral[1]


class Bench:
    """RawTherapee, and a folder for its files."""

    def __init__(self, program, folder):
        self.program, self.folder, self.dcp = program, folder, folder / "camera.dcp"

    def export(self, camera, lights):
        arguments = ["profile", "export", camera, "--to", "dcp", "-o", str(self.dcp), "--overwrite", "--light", *lights]
        for light in lights:
            arguments += ["--neutral", ",".join(map(str, NEUTRAL[light]))]
        chart.darkroot(self.program, *arguments)
        return read_tiff(self.dcp.read_bytes())

    def agrees(self, what, camera, light, neutral, table="true", limit=chart.LIMIT, profile=None):
        """Whether RawTherapee's colours under a light are Darkroot's, by the camera's own profile or another."""
        rgb = chart.chart_rgb(self.program, camera, light)
        wanted = chart.apply(self.program, profile or camera, light, rgb)
        color_matrix = matrix(read_tiff(self.dcp.read_bytes()), 50721).ravel().tolist()
        raw, out = self.folder / "chart.dng", self.folder / "chart.tif"
        raw.write_bytes(dng(camera, rgb, neutral, color_matrix))
        rawtherapee.develop(raw, out, f"file:{self.dcp}", table)
        found = developed(out)
        found *= wanted[:, 1].mean() / found[:, 1].mean()
        return chart.judge(f"{camera}, {what}", found, wanted, limit)


if __name__ == "__main__":
    for tool, package in rawtherapee.TOOLS.items():
        chart.need(tool, package)
    good = True
    with tempfile.TemporaryDirectory() as name:
        bench = Bench(sys.argv[1], Path(name))
        for camera in chart.CAMERAS:
            for light, neutral in NEUTRAL.items():
                bench.export(camera, [light])
                good &= bench.agrees(f"{light}, RawTherapee", camera, light, np.array(neutral))
                bench.agrees(f"{light}, RawTherapee by the matrix alone", camera, light, np.array(neutral), "false")
            dcp = bench.export(camera, list(NEUTRAL))
            for light, neutral in NEUTRAL.items():
                good &= bench.agrees(f"D65 and A, RawTherapee under {light}", camera, light, np.array(neutral))
            between = neutral_between(dcp, 4000)
            # The camera's own profile knows every light; the DCP knows two, and both programs go between them.
            own = str(bench.dcp)
            good &= bench.agrees("D65 and A, RawTherapee at 4000 K", camera, "4000K", between, limit=0.5, profile=own)
    sys.exit(0 if good else 1)
