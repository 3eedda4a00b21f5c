#!/usr/bin/env python3
"""How sharp an edge is before and after the correction of a lens's distortion, beside other developers.

    warped.py --darkroot target/release/darkroot [--blur PIXELS] [--work DIR]

A slanted edge in the middle of a frame and one near a corner are drawn as a lens of the lensfun database would (24 mm of its
`Canon EF 24-70mm f/2.8L USM`: 2.4 % larger in the middle, 1.4 % smaller in the corners), blurred by so many pixels
of the sensor, and written as a DNG with that camera and lens in its Exif. Each developer makes a picture of it twice, without and
with the lens of the database, distortion only. Of each edge are printed MTF50, in cycles a pixel of the sensor wherever the map
puts that, and the overshoot, as `peers.py` measures them; and how far the edge is from straight, in pixels.

darktable and RawTherapee take the coefficients from the lensfun that is installed: 0.3 has the same for this lens. darktable is
told by an XMP, whose parameters are those of version 5 of its module; later versions convert them. A DNG's own WarpRectilinear
was tried first: RawTherapee 5.9 and darktable 4.2.1 leave it alone unasked.

Needs what `peers.py` needs, and exiftool.
"""
import argparse
import shutil
import struct
import tempfile
from pathlib import Path

import numpy as np
from peers import mtf50, overshoot, read, run, whole_white
from denoise import SRGB, bayer, decode, exposed, write_dng
from scipy.special import erf

MAKE, CAMERA, LENS, FOCAL = "Canon", "Canon EOS 5D Mark II", "Canon EF 24-70mm f/2.8L USM", 24
# lensfun's `ptlens`: radii are 1 at half the shorter side.
PTLENS = (0.015298, -0.039413, 0.0)
WIDTH, HEIGHT = 1536, 1024
SLOPE = np.tan(np.radians(5))
# Column and row of edges from the middle of the corrected picture, and half the rows that are looked at.
EDGES = {"middle": (0, 0, 110), "corner": (540, 360, 90)}
RAMP = slice(-440, -340)


def factor(radius):
    a, b, c = PTLENS
    return 1 - a - b - c + radius * (c + radius * (b + radius * a))


def corrected(x, y):
    """Places of the corrected picture that lie at places of the frame, both from the middle."""
    unit = (HEIGHT - 1) / 2
    seen = np.hypot(x, y) / unit
    radius = seen.copy()
    for _ in range(30):
        radius = seen / factor(radius)
    return x / factor(radius), y / factor(radius)


def frame(raw, blur, neutral):
    """Writes the DNG; gives, for each edge, the pixels of the corrected picture along its normal for one of the sensor."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    x, y = corrected(x - (WIDTH - 1) / 2, y - (HEIGHT - 1) / 2)
    grey, sizes = 0.02 + 0.6 * (x / WIDTH + 0.5), {}
    for name, (left, top, _) in EDGES.items():
        distance = (x - left - SLOPE * (y - top)) * np.cos(np.arctan(SLOPE))
        slopes = np.hypot(*np.gradient(distance))
        sizes[name] = slopes[round(top + HEIGHT / 2), round(left + WIDTH / 2)]
        distance /= slopes
        # The mean over a pixel of an edge with a Gaussian blur, by its integral.
        integral = lambda d: d * 0.5 * (1 + erf(d / (blur * np.sqrt(2)))) + blur / np.sqrt(2 * np.pi) * np.exp(-(d**2) / (2 * blur**2))
        here = y > 200 if name == "corner" else (y > -290) & (y <= 200)
        grey = np.where(here, 0.1 + 0.2 * (integral(distance + 0.5) - integral(distance - 0.5)), grey)
    write_dng(raw, exposed(bayer(grey[..., None] * neutral), 1, 0, None), neutral)
    run("exiftool", "-q", "-overwrite_original", f"-Make={MAKE}", f"-Model={CAMERA}", f"-UniqueCameraModel={CAMERA}", f"-LensModel={LENS}",
        f"-FocalLength={FOCAL}", "-FNumber=8", "-ISO=100", "-SubjectDistance=10", raw)  # fmt: skip
    return sizes


def light_of(picture, scale):
    """The picture's light: its grey ramp undoes what the developer made of it."""
    light = decode(picture) @ SRGB[1]
    height, width = light.shape
    ramp = light[height // 2 + RAMP.start : height // 2 + RAMP.stop].mean(0)[60:-60]
    at = (np.arange(60, width - 60) - (width - 1) / 2) / scale
    order = np.argsort(ramp)
    return np.interp(light, ramp[order], (0.02 + 0.6 * (at / WIDTH + 0.5))[order])


def located(light, name, scale):
    """Rows from the picture's middle, and where the edge lies in each."""
    left, top, half = EDGES[name]
    height, width = light.shape
    rows = np.arange(round(scale * (top - half)), round(scale * (top + half)))
    found = []
    for row in rows:
        middle = round((width - 1) / 2 + scale * (left + SLOPE * (row / scale - top)))
        steps = np.diff(light[round((height - 1) / 2) + row, middle - 48 : middle + 48])
        steepest = np.clip(np.argmax(np.convolve(steps, np.ones(3), "same")), 12, len(steps) - 13)
        near = slice(steepest - 12, steepest + 13)
        found.append(middle - 48 + (np.arange(len(steps))[near] + 0.5) @ steps[near] / steps[near].sum() - (width - 1) / 2)
    return rows, np.array(found)


def of_edge(light, name, scale):
    """MTF50 in cycles a pixel, the overshoot as a share of the edge, and the largest distance from straight."""
    rows, found = located(light, name, scale)
    height, width = light.shape
    bent = np.polyfit(rows, found, 3)
    line = np.polyfit(rows, found, 1)
    off = np.abs(np.polyval(bent, rows) - np.polyval(line, rows)).max()
    x = np.arange(width) - (width - 1) / 2
    at = np.polyval(bent, rows)[:, None]
    distance = (x[None] - at) * np.cos(np.arctan(np.polyval(np.polyder(bent), rows)))[:, None]
    near = np.abs(distance) < 32
    bins = np.floor(distance[near] * 4).astype(int) + 128
    band = light[round((height - 1) / 2) + rows]
    profile = np.bincount(bins, band[near], 256) / np.maximum(np.bincount(bins, minlength=256), 1)
    return mtf50(profile), overshoot(profile, slice(40, -40)), off


def by_darkroot(program, raw, work, corrects):
    out = work / "darkroot.tif"
    lens = ["--lens", "lensfun", "--vignetting=false", "--ca=false"] if corrects else ["--lens", "off"]
    run(program, "develop", raw, "-o", out, "--bits", "16", "--overwrite", "-q", *lens)
    return read(out)


def by_rawtherapee(raw, work, corrects):
    out, profile = work / "rawtherapee.tif", work / "lens.pp3"
    mode = "lfauto" if corrects else "none"
    flags = "UseDistortion=true\nUseVignette=false\nUseCA=false\n"
    profile.write_text(f"[LensProfile]\nLcMode={mode}\n{flags}\n[Common Properties for Transformations]\nAutoFill=false\n")
    run("rawtherapee-cli", "-Y", "-d", "-p", profile, "-t", "-b16", "-o", out, "-c", raw)
    return read(out)


def lens_sidecar(corrects, parts, camera, lens, focal, aperture, distance=10.0):
    """An XMP by which darktable corrects these parts of this lens (8: distortion, 2: vignetting, 1: chromatic aberration)."""
    # Version 5: what is corrected, direction, scale, crop factor, focal length, aperture, distance, projection
    # (1: rectilinear), camera, lens, no coefficients of its own, and that a person chose it.
    numbers = struct.pack("<2i5fi128s128si2fi", parts, 0, 1.0, 1.0, focal, aperture, distance, 1, camera.encode(), lens.encode(), 0, 1.0, 1.0, 1)
    return (
        '<x:xmpmeta xmlns:x="adobe:ns:meta/"><rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#">'
        '<rdf:Description rdf:about="" xmlns:darktable="http://darktable.sf.net/" darktable:xmp_version="5" darktable:history_end="1">'
        f'<darktable:history><rdf:Seq><rdf:li darktable:num="0" darktable:operation="lens" darktable:enabled="{int(corrects)}" '
        f'darktable:modversion="5" darktable:params="{numbers.hex()}" darktable:multi_name="" darktable:multi_priority="0" '
        'darktable:blendop_version="1" darktable:blendop_params=""/></rdf:Seq></darktable:history></rdf:Description></rdf:RDF></x:xmpmeta>'
    )


def by_darktable(raw, work, corrects):
    out, sidecar = work / "darktable.tif", work / "lens.xmp"
    out.unlink(missing_ok=True)
    sidecar.write_text(lens_sidecar(corrects, 8, CAMERA, LENS, FOCAL, 8.0))
    options = ["--configdir", work / "darktable", "--library", ":memory:", "--conf", "plugins/imageio/format/tiff/bpp=16"]
    run("darktable-cli", raw, sidecar, out, "--icc-type", "SRGB", "--core", *options)
    return read(out)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--darkroot", required=True)
    parser.add_argument("--blur", type=float, default=0.5)
    parser.add_argument("--work", type=Path, help="keeps the files; without it they are deleted")
    arguments = parser.parse_args()
    developers = {"Darkroot": lambda *of: by_darkroot(arguments.darkroot, *of)}
    if shutil.which("rawtherapee-cli"):
        developers["RawTherapee"] = by_rawtherapee
    if shutil.which("darktable-cli"):
        developers["darktable"] = by_darktable
    with tempfile.TemporaryDirectory() as temporary:
        work = arguments.work or Path(temporary)
        work.mkdir(exist_ok=True, parents=True)
        raw = work / "warped.dng"
        sizes = frame(raw, arguments.blur, whole_white())
        for name, develop in developers.items():
            for corrects in (False, True):
                print(f"{name:<12} {'corrected' if corrects else 'as taken':<10}" + row(develop(raw, work, corrects), corrects, sizes), flush=True)


def row(picture, corrects, sizes):
    # How much larger the corrected picture was made, by the distance of its two edges.
    scale, light = 1.0, decode(picture) @ SRGB[1]
    if corrects:
        for _ in range(3):
            ends = [np.polyval(np.polyfit(*located(light, name, scale), 1), scale * EDGES[name][1]) for name in EDGES]
            scale = (ends[1] - ends[0]) / (EDGES["corner"][0] - EDGES["middle"][0])
    light = light_of(picture, scale)
    cells = []
    for name in EDGES:
        mtf, over, off = of_edge(light, name, scale)
        mtf *= scale * sizes[name] if corrects else 1
        cells.append(f" {name}: MTF50 {mtf:.3f}, overshoot {100 * over:.1f} %, straight to {off:.2f};")
    return "".join(cells) + (f" made {scale:.4f} times as large" if corrects else "")


if __name__ == "__main__":
    main()
