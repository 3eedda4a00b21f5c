#!/usr/bin/env python3
"""Deliveries against the truth: delivered.py DARKROOT CHART_SHOTS SPECTRA [--quick]

For three measured cameras, four lights and two charts: a simulated shot (CHART_SHOTS is the example `chart_shots` of the
package `darkroot-tests`, SPECTRA the folder of spectra), its profile, a TIFF in eciRGB v2 by `develop --look reproduction`, and
its patches by `verify` and by colour-science against the spectra under the light. The slanted edges of the first TIFF are read
by quickMTF, too. Prints a Markdown table.

Needs colour-science, tifffile and numpy (PyPI), and quickMTF for the edges. Exit code 1 when a mean dE2000 is more than 0.1 above
the profile's own figure, a grey more than 0.5 L* off, or the two programs more than 0.05 apart.
"""
import argparse
import csv
import json
import re
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


def sg140(spectra, into):
    """The SG's spectra row by row."""
    rows = list(csv.reader(open(spectra / "colorchecker_sg_all_380-730_1.csv")))
    by_name = {row[0]: row for row in rows[1:]}
    names = [f"{column}{row}" for row in range(1, 11) for column in "ABCDEFGHIJKLMN"]
    with open(into, "w", newline="") as file:
        csv.writer(file).writerows([rows[0]] + [by_name[name] for name in names])


def delivery(arguments, folder, camera, light, chart, patches):
    """Own figure of the profile, by verify, by colour-science; the worst grey; the edges by both, where they are asked for."""
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
    edges = None
    if chart == "classic24":
        edges = (float(re.search(r"SFR50 ([\d.]+)", words).group(1)), sfr50(folder / "chart.tif", place))
    return own, ours, theirs, float(grey), edges


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
    print("| camera, light, chart | profile | verify | colour-science | greys, L\\* | SFR50, verify / quickMTF |")
    print("|---|---|---|---|---|---|")
    bad = False
    with tempfile.TemporaryDirectory() as top:
        sg = Path(top) / "sg140.csv"
        sg140(arguments.spectra, sg)
        for camera in CAMERAS[: 1 if arguments.quick else None]:
            for light in LIGHTS:
                for chart, patches in (("classic24", classic), ("sg140", sg)):
                    folder = Path(top) / f"{camera}-{light}-{chart}"
                    folder.mkdir()
                    own, ours, theirs, grey, edges = delivery(arguments, folder, camera, light, chart, patches)
                    bad |= ours - own > 0.1 or grey > 0.5 or abs(ours - theirs) > 0.05
                    sharp = "" if edges is None else " / ".join("–" if v is None else f"{v:.3f}" for v in edges)
                    print(f"| {camera}, {light}, {chart} | {own:.2f} | {ours:.3f} | {theirs:.3f} | {grey:.2f} | {sharp} |", flush=True)
    return int(bad)


if __name__ == "__main__":
    sys.exit(main())
