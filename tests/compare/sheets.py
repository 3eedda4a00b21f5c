#!/usr/bin/env python3
"""Contact sheets of real photographs with the lens corrected, beside other developers, for the eye.

    sheets.py --darkroot target/release/darkroot --work DIR [--lens-name NAME] FILE...

Of each file two sheets are written to DIR, at most 1000 pixels wide: `NAME.png` with the whole picture, under lines that are upright
and level, and `NAME.corner.png` with the most detailed corner, a pixel of the picture for one of the sheet. Cells are Darkroot as
taken, Darkroot with `--lens lensfun` (the file's own correction where it has one), RawTherapee and darktable with all that they
correct of a lens: the database, lateral chromatic aberration, vignetting. darktable is told the lens that Darkroot found, or the one
that exiftool names. Where a DNG has a WarpRectilinear of its own, a cell more has what DNG 1.7 says of it, done here by NumPy from
Darkroot's picture as taken: dngpy gives nothing of Adobe's SDK behind the stored samples, so its rendering cannot stand beside.

How far the developers' corrections lie apart is printed: shifts of blocks of the corner and the edge from those of Darkroot's,
pixels, after the best shift and scale of the whole picture.

Needs what `peers.py` needs, and exiftool; what is not installed is left out.
"""
import argparse
import json
import re
import shutil
import struct
import subprocess
from pathlib import Path

import numpy as np
from peers import read, run
from PIL import Image, ImageDraw
from scipy.ndimage import map_coordinates
from warped import lens_sidecar

WIDTH = 1000
CELL = WIDTH // 2 - 4
# Distortion, lateral chromatic aberration and vignetting, as darktable's module counts them.
ALL = 8 | 2 | 1


def by_darkroot(program, raw, work, lens, name):
    out = work / "darkroot.tif"
    options = ["--bits", "16", "--overwrite", "--lens", lens, "--lens-name", name]
    done = subprocess.run([program, "develop", raw, "-o", out, *options], capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(done.stderr)
    return read(out), done.stderr


def by_rawtherapee(raw, work):
    out, profile = work / "rawtherapee.tif", work / "lens.pp3"
    flags = "UseDistortion=true\nUseVignette=true\nUseCA=true\n"
    profile.write_text(f"[LensProfile]\nLcMode=lfauto\n{flags}\n[RAW]\nCA=true\n")
    run("rawtherapee-cli", "-Y", "-d", "-p", profile, "-t", "-b16", "-o", out, "-c", raw)
    return read(out)


def by_darktable(raw, work, exif, lens):
    out = work / "darktable.tif"
    out.unlink(missing_ok=True)
    sidecar = []
    if lens:
        sidecar = [work / "lens.xmp"]
        shot = [float(exif.get(key) or 0) for key in ("FocalLength", "FNumber")]
        sidecar[0].write_text(lens_sidecar(True, ALL, exif["Model"], lens, *shot))
    options = ["--configdir", work / "darktable", "--library", ":memory:", "--conf", "plugins/imageio/format/tiff/bpp=16"]
    run("darktable-cli", raw, *sidecar, out, "--icc-type", "SRGB", "--core", *options)
    return read(out)


def exif_of(raw):
    words = ["-j", "-n", "-Model", "-LensModel", "-FocalLength", "-FNumber"]
    numbers = json.loads(subprocess.run(["exiftool", *words, raw], capture_output=True, text=True).stdout)[0]
    named = json.loads(subprocess.run(["exiftool", "-j", "-LensID", raw], capture_output=True, text=True).stdout)[0]
    return {**numbers, "LensID": named.get("LensID")}


def warp_of(raw):
    """Coefficients of each plane and the centre of the first WarpRectilinear of OpcodeList3; `None` where there is none."""
    blob = subprocess.run(["exiftool", "-b", "-OpcodeList3", raw], capture_output=True).stdout
    # exiftool -b gives the numbers of the list as they stand; each opcode has 16 bytes of head.
    at = 4
    while at + 16 <= len(blob):
        opcode, _, _, length = struct.unpack(">4I", blob[at : at + 16])
        body = blob[at + 16 : at + 16 + length]
        if opcode == 1:
            planes = struct.unpack(">I", body[:4])[0]
            numbers = np.array(struct.unpack(f">{6 * planes + 2}d", body[4:]))
            return numbers[:-2].reshape(planes, 6), numbers[-2:]
        at += 16 + length
    return None


def by_formula(picture, warp):
    """DNG 1.7, WarpRectilinear, for a picture that is the whole active area; in sRGB, which is enough for the eye."""
    planes, centre = warp
    height, width = picture.shape[:2]
    cx, cy = centre[0] * (width - 1), centre[1] * (height - 1)
    reach = np.hypot(max(cx, width - 1 - cx), max(cy, height - 1 - cy))
    y, x = np.mgrid[0:height, 0:width]
    dx, dy = (x - cx) / reach, (y - cy) / reach
    square = dx**2 + dy**2
    out = np.empty_like(picture)
    for channel in range(3):
        k0, k1, k2, k3, t0, t1 = planes[min(channel, len(planes) - 1)]
        factor = k0 + square * (k1 + square * (k2 + square * k3))
        u = cx + reach * (factor * dx + t0 * 2 * dx * dy + t1 * (square + 2 * dx**2))
        v = cy + reach * (factor * dy + t1 * 2 * dx * dy + t0 * (square + 2 * dy**2))
        out[..., channel] = map_coordinates(picture[..., channel], [v, u], order=1, mode="nearest")
    return out


def eight_bits(picture):
    return Image.fromarray((255 * np.clip(picture, 0, 1)).astype(np.uint8))


def sheet(cells, path):
    """Cells of one size in two columns, each with its name."""
    width, height = cells[0][1].size
    rows = (len(cells) + 1) // 2
    whole = Image.new("RGB", (WIDTH, rows * (height + 22)), "white")
    draw = ImageDraw.Draw(whole)
    for i, (name, cell) in enumerate(cells):
        left, top = i % 2 * (WIDTH // 2), i // 2 * (height + 22)
        draw.text((left + 2, top + 4), name, fill="black")
        whole.paste(cell, (left, top + 20))
    whole.save(path)


def lined(cell):
    draw = ImageDraw.Draw(cell)
    for share in (0.05, 0.25, 0.5, 0.75, 0.95):
        draw.line([(share * cell.width, 0), (share * cell.width, cell.height)], fill=(255, 60, 60))
        draw.line([(0, share * cell.height), (cell.width, share * cell.height)], fill=(255, 60, 60))
    return cell


def corners(shape):
    """Corners of cells in a picture, a little inside of it."""
    height, width = shape[:2]
    w, h = min(CELL, width // 2), min(340, height // 2)
    inside = width // 50
    return [(x, y, w, h) for x in (inside, width - w - inside) for y in (inside, height - h - inside)]


def detailed(picture):
    light = picture.mean(-1)
    energy = lambda x, y, w, h: sum(np.abs(d).sum() for d in np.gradient(light[y : y + h, x : x + w]))
    return max(range(4), key=lambda i: energy(*corners(picture.shape)[i]))


def shift(ours, theirs):
    """Where a block of theirs lies beside ours, and how sure that is, by the phases of both."""
    window = np.outer(*(np.hanning(n) for n in ours.shape))
    spectra = [np.fft.fft2((block - block.mean()) * window) for block in (theirs, ours)]
    cross = spectra[0] * np.conj(spectra[1])
    peak = np.abs(np.fft.ifft2(cross / np.maximum(np.abs(cross), 1e-12)))
    at = np.array(np.unravel_index(peak.argmax(), peak.shape))
    near = [np.take(np.take(peak, (at[0] + d) % len(peak), 0), (at[1] + e) % peak.shape[1], 0) for d in (-1, 0, 1) for e in (-1, 0, 1)]
    near = np.array(near).reshape(3, 3) + 1e-12
    part = np.array([(near * d).sum() / near.sum() for d in np.meshgrid([-1, 0, 1], [-1, 0, 1], indexing="ij")])
    at = at + part
    return np.where(at > np.array(peak.shape) / 2, at - peak.shape, at), peak.max()


def apart(ours, theirs):
    """Median and largest shift of blocks after the best shift and scale of all, pixels of ours; and the number of blocks."""
    height, width = ours.shape[:2]
    theirs = np.asarray(eight_bits(theirs).resize((width, height), Image.LANCZOS)).mean(-1)
    ours = np.asarray(eight_bits(ours)).mean(-1)
    size, found = 256, []
    for y in range(0, height - size, size // 2):
        for x in range(0, width - size, size // 2):
            at, sure = shift(ours[y : y + size, x : x + size], theirs[y : y + size, x : x + size])
            if sure > 0.05 and np.hypot(*at) < 60:
                found.append([y + size / 2 - height / 2, x + size / 2 - width / 2, *at])
    if len(found) < 12:
        return None
    places, shifts = np.array(found)[:, :2], np.array(found)[:, 2:]
    for _ in range(3):
        ones = np.ones((len(places), 1))
        fit = np.linalg.lstsq(np.c_[places, ones], shifts, rcond=None)[0]
        left = np.hypot(*(shifts - np.c_[places, ones] @ fit).T)
        keep = left < max(4 * np.median(left), 1)
        places, shifts = places[keep], shifts[keep]
    return np.median(left), np.percentile(left, 95), len(places)


def of_file(program, raw, work, name):
    exif = exif_of(raw)
    taken, _ = by_darkroot(program, raw, work, "off", name)
    corrected, said = by_darkroot(program, raw, work, "lensfun", name)
    known = re.search(r"lens: (.*?)(, by .*)? \(lensfun\)", said)
    print(f"{raw.name}: {known[1] if known else 'the file’s own correction' if 'as the file says' in said else 'no lens that Darkroot knows'}")
    pictures = [("Darkroot, as taken", taken), ("Darkroot", corrected)]
    lens = known[1] if known else exif.get("LensID")
    peers = []
    if shutil.which("rawtherapee-cli"):
        peers.append(("RawTherapee", lambda: by_rawtherapee(raw, work)))
    if shutil.which("darktable-cli"):
        peers.append(("darktable", lambda: by_darktable(raw, work, exif, lens)))
    warp = warp_of(raw)
    if warp:
        peers.append(("DNG 1.7, by NumPy", lambda: by_formula(taken, warp)))
    for name, develop in peers:
        try:
            pictures.append((name, develop()))
        except (RuntimeError, OSError) as e:
            print(f"    {name}: {' '.join(str(e).split())[-120:]}")
    for name, picture in pictures[:1] + pictures[2:]:
        found = apart(corrected, picture)
        words = "tells too little" if found is None else "%.2f pixels apart in the middle of blocks, %.2f in 95 %% of %d" % found
        print(f"    {name}: {words}", flush=True)
    height = round(CELL * corrected.shape[0] / corrected.shape[1])
    wholes = [(name, lined(eight_bits(picture).resize((CELL, height), Image.LANCZOS))) for name, picture in pictures]
    sheet(wholes, work / f"{raw.stem}.png")
    which, cells = detailed(corrected), []
    for name, picture in pictures:
        x, y, w, h = corners(picture.shape)[which]
        cells.append((name, eight_bits(picture[y : y + h, x : x + w])))
    sheet(cells, work / f"{raw.stem}.corner.png")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--darkroot", required=True)
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("--lens-name", default="auto", help="the lens of these files, where they do not name it")
    parser.add_argument("files", type=Path, nargs="+")
    arguments = parser.parse_args()
    arguments.work.mkdir(exist_ok=True, parents=True)
    for raw in arguments.files:
        of_file(arguments.darkroot, raw, arguments.work, arguments.lens_name)


if __name__ == "__main__":
    main()
