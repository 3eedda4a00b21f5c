#!/usr/bin/env python3
"""Deliveries against the truth: delivered.py DARKROOT CHART_SHOTS SPECTRA [--quick]

For three measured cameras, four lights and two charts: a simulated shot (CHART_SHOTS is the example `chart_shots` of the
package `darkroot-tests`, SPECTRA the folder of spectra), its profile, a TIFF in eciRGB v2 by `develop --look reproduction`, and
its patches by `verify`, by colour-science and by Argyll (which knows the classic chart) against the spectra under the light. The slanted edges of the first TIFF are read
by quickMTF, too. Prints a Markdown table.

Needs colour-science, tifffile and numpy (PyPI), and quickMTF for the edges, scanin and
profcheck (Debian: argyll). Exit code 1 when a mean dE2000 is more than 0.1 above
the profile's own figure, a grey more than 0.5 L* off, or two programs more than 0.05 apart.
"""
import argparse
import csv
import json
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

warnings.filterwarnings("ignore")
try:
    import colour
    import numpy as np
    import tifffile
except ImportError as missing:
    print(f"skipped: {missing.name} is not installed (PyPI: colour-science, tifffile, numpy)")
    sys.exit(0)

CAMERAS = ["nikon_d90", "canon_40d", "pentax_k5"]
LIGHTS = ["D50", "A", "LED-B3", "FL2"]
D50 = np.array([0.9642, 1.0, 0.8249])
BRADFORD = np.array([[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]])
SPACE = colour.RGB_COLOURSPACES["ECI RGB v2"]


def run(*command, cwd):
    done = subprocess.run([str(c) for c in command], cwd=cwd, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: {done.stderr}")
    return done.stdout + done.stderr


def truths(reference, light):
    """Lab of each patch under the light, adapted to D50."""
    shape = colour.SpectralShape(380, 780, 5)
    observer = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"].copy().align(shape).values
    power = colour.SDS_ILLUMINANTS[light].copy().align(shape).values
    scale = 1 / np.sum(power * observer[:, 1])
    white = scale * (power @ observer)
    adapt = np.linalg.inv(BRADFORD) @ np.diag((BRADFORD @ D50) / (BRADFORD @ white)) @ BRADFORD
    rows = list(csv.reader(open(reference)))[1:]
    colours = [adapt @ (scale * ((power * np.array(row[1:], float)) @ observer)) for row in rows]
    return [colour.XYZ_to_Lab(xyz, colour.XYZ_to_xy(D50)) for xyz in colours]


def found(picture, chart):
    """Lab of each patch of a picture in eciRGB v2, by colour-science."""
    image = tifffile.imread(picture) / 65535
    half = int(0.22 * chart["patch_pixels"])
    white = SPACE.matrix_RGB_to_XYZ @ np.ones(3)
    labs = []
    for x, y in np.rint(chart["centres"]).astype(int):
        linear = SPACE.cctf_decoding(image[y - half : y + half + 1, x - half : x + half + 1].reshape(-1, 3))
        xyz = SPACE.matrix_RGB_to_XYZ @ linear.mean(0) * (D50 / white)
        labs.append(colour.XYZ_to_Lab(xyz, colour.XYZ_to_xy(D50)))
    return labs


def sfr50(picture, chart):
    """Median SFR50 over the edges of four greys of the classic chart, by quickMTF."""
    try:
        import matplotlib

        matplotlib.use("Agg")
        from quickMTF.SFR_MTF import sfr_mtfcal
    except ImportError:
        return None
    linear = SPACE.cctf_decoding(tifffile.imread(picture) / 65535) @ SPACE.matrix_RGB_to_XYZ[1]
    centres, side = np.array(chart["centres"]), chart["patch_pixels"]
    across, down = (v / np.linalg.norm(v) for v in (centres[1] - centres[0], centres[6] - centres[0]))
    halves = []
    for i in (18, 19, 20, 21):
        for way in (across, -across, down, -down):
            x, y = np.rint(centres[i] + way * side / 2).astype(int)
            long, wide = int(0.28 * side), 9
            upright = abs(way[0]) > 0.7
            h, w = (long, wide) if upright else (wide, long)
            edge = linear[y - h : y + h + 1, x - w : x + w + 1]
            edge = edge if upright else edge.T
            edge = edge[:, ::-1] if edge[:, 0].mean() > edge[:, -1].mean() else edge
            curve = sfr_mtfcal().calc_sfr(np.ascontiguousarray(edge), oversampling=4)[0]
            f, v = curve[:, 0], curve[:, 1]
            k = np.where(v < 0.5)[0][0]
            halves.append(f[k - 1] + (v[k - 1] - 0.5) / (v[k - 1] - v[k]) * (f[k] - f[k - 1]))
    return float(np.median(halves))


def eci_profile():
    """eciRGB v2 as an ICC profile of version 2, the newest that Argyll reads, by colour-science's numbers."""
    number = lambda v: struct.pack(">i", round(v * 65536))
    xyz = lambda values: b"XYZ \0\0\0\0" + b"".join(map(number, values))
    matrix = SPACE.matrix_RGB_to_XYZ * (D50 / (SPACE.matrix_RGB_to_XYZ @ np.ones(3)))[:, None]
    steps = np.clip(np.rint(65535 * SPACE.cctf_decoding(np.linspace(0, 1, 4096))), 0, 65535).astype(">u2")
    curve = b"curv\0\0\0\0" + struct.pack(">I", 4096) + steps.tobytes()
    words = b"eciRGB v2\0"
    named = b"desc\0\0\0\0" + struct.pack(">I", len(words)) + words + bytes(78)
    tags = {b"desc": named, b"cprt": b"text\0\0\0\0none\0", b"wtpt": xyz(D50)}
    tags |= {name: xyz(matrix[:, i]) for i, name in enumerate((b"rXYZ", b"gXYZ", b"bXYZ"))}
    tags |= {name: curve for name in (b"rTRC", b"gTRC", b"bTRC")}
    table, data, start = b"", b"", 132 + 12 * len(tags)
    for name, content in tags.items():
        table += name + struct.pack(">II", start + len(data), len(content))
        data += content + bytes(-len(content) % 4)
    head = struct.pack(">I4xI4s4s4s12x4s", start + len(data), 0x02400000, b"mntr", b"RGB ", b"XYZ ", b"acsp")
    head += bytes(28) + b"".join(map(number, D50)) + bytes(48)
    return head + struct.pack(">I", len(tags)) + table + data


def argyll(folder, chart, labs):
    """Mean dE2000 of the classic chart's patches by Argyll, which samples the picture and knows the way to Lab."""
    layout = Path("/usr/share/color/argyll/ref/ColorChecker.cht")
    if shutil.which("scanin") is None or shutil.which("profcheck") is None or not layout.exists():
        return None
    names = [f"{row}{column}" for row in "ABCD" for column in range(1, 7)]
    lines = [f"{name} {l:.5f} {a:.5f} {b:.5f}" for name, (l, a, b) in zip(names, labs)]
    (folder / "truth.cie").write_text(
        "CGATS\n\nNUMBER_OF_FIELDS 4\nBEGIN_DATA_FORMAT\nSAMPLE_ID LAB_L LAB_A LAB_B\nEND_DATA_FORMAT\n\n"
        "NUMBER_OF_SETS 24\nBEGIN_DATA\n" + "\n".join(lines) + "\nEND_DATA\n")
    # Middles of patches in the layout's measure, and from there to the picture: where its four marks lie.
    middles = np.array([[35 + 52.5 * column, 34.5 + 52.5 * row, 1] for row in range(4) for column in range(6)])
    to_picture = np.linalg.lstsq(middles, np.array(chart["centres"]), rcond=None)[0]
    marks = np.array([[10, 9.75, 1], [321.25, 9.75, 1], [321.25, 217, 1], [10, 217, 1]]) @ to_picture
    places = ",".join(f"{v:.2f}" for v in marks.ravel())
    run("scanin", "-F", places, "-v", "chart.tif", layout, "truth.cie", cwd=folder)
    (folder / "eci.icc").write_bytes(eci_profile())
    words = run("profcheck", "-k", "chart.ti3", "eci.icc", cwd=folder)
    return float(re.search(r"avg\. = ([\d.]+)", words).group(1))


def sg140(spectra, into):
    """The SG's spectra row by row."""
    rows = list(csv.reader(open(spectra / "colorchecker_sg_all_380-730_1.csv")))
    by_name = {row[0]: row for row in rows[1:]}
    names = [f"{column}{row}" for row in range(1, 11) for column in "ABCDEFGHIJKLMN"]
    with open(into, "w", newline="") as file:
        csv.writer(file).writerows([rows[0]] + [by_name[name] for name in names])


def delivery(arguments, folder, camera, light, chart, patches):
    """Own figure of the profile, by verify, by colour-science, by Argyll (classic chart); the worst grey; the edges by both, where they are asked for."""
    program = arguments.darkroot
    run(arguments.chart_shots, folder, arguments.spectra / f"cam_camspec_{camera}.csv", patches, chart, light, cwd=folder)
    own = run(program, "profile", "chart.dng", "--chart", chart, "--light", light, "--reference", "reference.csv", "-o",
              "p.toml", "--accept", cwd=folder)
    own = float(re.search(r"-> \S+\s+([\d.]+) /", own).group(1))
    run(program, "develop", "chart.dng", "-o", "chart.tif", "--look", "reproduction", "--space", "ecirgb-v2", "--profile",
        "p.toml", "--exposure-from-chart", "auto", "--white-balance", "chart", "--chart-layout", chart, "--chart-reference",
        "reference.csv", cwd=folder)
    words = run(program, "verify", "chart.tif", "--chart", chart, "--reference", "reference.csv", "--log", "log.csv", cwd=folder)
    ours = float(list(csv.reader(open(folder / "log.csv")))[1][4])
    place = json.loads(run(program, "chart", "chart.tif", "--chart", chart, "--json", cwd=folder))["charts"][0]
    pairs = list(zip(truths(folder / "reference.csv", light), found(folder / "chart.tif", place)))
    theirs = float(np.mean([colour.delta_E(lab, truth, method="CIE 2000") for truth, lab in pairs]))
    grey = max(abs(truth[0] - lab[0]) for truth, lab in pairs if np.hypot(*truth[1:]) < 5)
    edges, third = None, None
    if chart == "classic24":
        edges = (float(re.search(r"SFR50 ([\d.]+)", words).group(1)), sfr50(folder / "chart.tif", place))
        third = argyll(folder, place, [truth for truth, _ in pairs])
    return own, ours, theirs, third, float(grey), edges


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("darkroot", type=Path)
    parser.add_argument("chart_shots", type=Path)
    parser.add_argument("spectra", type=Path)
    parser.add_argument("--quick", action="store_true", help="one camera only")
    arguments = parser.parse_args()
    for name in ("darkroot", "chart_shots", "spectra"):
        setattr(arguments, name, getattr(arguments, name).resolve())
    classic = arguments.spectra / "colorchecker_classic24_babelcolor_380-730_10.csv"
    print("| camera, light, chart | profile | verify | colour-science | Argyll | greys, L\\* | SFR50, verify / quickMTF |")
    print("|---|---|---|---|---|---|---|")
    bad = False
    with tempfile.TemporaryDirectory() as top:
        sg = Path(top) / "sg140.csv"
        sg140(arguments.spectra, sg)
        for camera in CAMERAS[: 1 if arguments.quick else None]:
            for light in LIGHTS:
                for chart, patches in (("classic24", classic), ("sg140", sg)):
                    folder = Path(top) / f"{camera}-{light}-{chart}"
                    folder.mkdir()
                    own, ours, theirs, third, grey, edges = delivery(arguments, folder, camera, light, chart, patches)
                    bad |= ours - own > 0.1 or grey > 0.5 or abs(ours - theirs) > 0.05 or third is not None and abs(ours - third) > 0.05
                    argylls = "–" if third is None else f"{third:.3f}"
                    sharp = "" if edges is None else " / ".join("–" if v is None else f"{v:.3f}" for v in edges)
                    print(f"| {camera}, {light}, {chart} | {own:.2f} | {ours:.3f} | {theirs:.3f} | {argylls} | {grey:.2f} | {sharp} |", flush=True)
    return int(bad)


if __name__ == "__main__":
    sys.exit(main())
