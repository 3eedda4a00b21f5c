"""Accuracy beside rawpy and colour-science's own fits: `python colours_beside_colour_science.py CHART_SHOTS SPECTRA`.

Measured cameras photograph a chart of 24 patches and one of 140 under D50, with noise and blur (CHART_SHOTS is the example of that name
of darkroot-tests; SPECTRA the folder of sensitivities and reflectances). Each way fits to the 24 and is judged by the 140, which it has
not seen: the whole way from the raw file to XYZ. All are scaled to the reference by one number, as no way knows the exposure.

Needs rawpy and colour-science. Figures stand in docs/python.md.
"""

import csv
import pathlib
import subprocess
import sys
import tempfile

import colour
import numpy
import rawpy

import darkroot

CAMERAS = ["camspec_nikon_d700", "camspec_canon_5dmarkii", "rawtoaces_fujifilm_x-t4", "camspec_phase_one"]
D50 = colour.CCS_ILLUMINANTS["CIE 1931 2 Degree Standard Observer"]["D50"]


def sequences(spectra, folder):
    """The reflectances of both charts, row by row as the charts are printed."""
    classic = list(csv.reader(open(spectra / "colorchecker_classic24_babelcolor_380-730_10.csv")))
    sg = list(csv.reader(open(spectra / "colorchecker_sg_all_380-730_1.csv")))
    named = {row[0]: row for row in sg[1:]}
    by_name = [named[f"{column}{row}"] for row in range(1, 11) for column in "ABCDEFGHIJKLMN"]
    for chart, rows in [("classic24", classic), ("sg140", [sg[0], *by_name])]:
        with open(folder / f"{chart}.csv", "w", newline="") as file:
            csv.writer(file).writerows(rows)


def shoot(program, spectra, camera, folder):
    """The shots of both charts."""
    sequences(spectra, folder)
    for chart in ("classic24", "sg140"):
        command = [program, folder / chart, spectra / f"cam_{camera}.csv", folder / f"{chart}.csv", chart, "D50"]
        subprocess.run(command, check=True, capture_output=True)


def patches(picture, chart):
    """The mean of each patch of a linear picture."""
    (found, *_) = darkroot.detect_charts(picture, charts=[chart])
    means = []
    for corners in found.patches:
        left, top = numpy.ceil(corners.min(axis=0) + 4).astype(int)
        right, bottom = numpy.floor(corners.max(axis=0) - 4).astype(int)
        means.append(picture[top:bottom, left:right].reshape(-1, 3).mean(axis=0, dtype=float))
    return numpy.array(means)


def by_rawpy(path):
    """Linear camera RGB by LibRaw with AHD, not balanced."""
    with rawpy.imread(str(path)) as raw:
        rgb = raw.postprocess(
            demosaic_algorithm=rawpy.DemosaicAlgorithm.AHD,
            gamma=(1, 1),
            no_auto_bright=True,
            output_bps=16,
            user_wb=[1, 1, 1, 1],
            output_color=rawpy.ColorSpace.raw,
            user_flip=0,
        )
    return rgb.astype(numpy.float32) / 65535


def errors(xyz, truth):
    """dE2000 after the best common scale."""
    scale = (xyz[:, 1] * truth[:, 1]).sum() / (xyz[:, 1] ** 2).sum()
    return colour.delta_E(colour.XYZ_to_Lab(scale * xyz, D50), colour.XYZ_to_Lab(truth, D50), method="CIE 2000")


def ways(folder):
    """The name of each way and XYZ of the chart that it has not seen."""
    seen, unseen = folder / "classic24/chart.dng", folder / "sg140/chart.dng"
    known = darkroot.measure_chart(seen, reference=folder / "classic24/reference.csv", accept=True).xyz
    made = darkroot.make_profile(seen, light="D50", reference=folder / "classic24/reference.csv", accept=True)
    to_xyz = numpy.linalg.inv(numpy.array(darkroot._html.TO_SRGB))
    linear = darkroot.develop(unseen, look="linear", profile=made.profile, highlights="keep")
    yield f"Darkroot ({made.lights[0]['model']})", patches(linear, "sg140") @ to_xyz.T
    train, test = patches(by_rawpy(seen), "classic24"), patches(by_rawpy(unseen), "sg140")
    # Balanced by the chart's white, as people do; root polynomials do not mind.
    white = train[known[:, 1].argmax()]
    train, test = train / white, test / white
    yield "rawpy + matrix", colour.colour_correction(test, train, known, method="Cheung 2004", terms=3)
    for degree in (2, 3):
        fitted = colour.colour_correction(
            test, train, known, method="Finlayson 2015", degree=degree, root_polynomial_expansion=True
        )
        yield f"rawpy + root polynomial {degree}", fitted


def main():
    """Prints a table of mean, 95th percentile and largest error."""
    program, spectra = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    print("| camera | way | mean | 95 % | max |\n|---|---|---|---|---|")
    for camera in CAMERAS:
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            shoot(program, spectra, camera, folder)
            sg = folder / "sg140/reference.csv"
            truth = darkroot.measure_chart(folder / "sg140/chart.dng", "sg140", sg, accept=True).xyz
            for name, xyz in ways(folder):
                e = errors(xyz, truth)
                print(
                    f"| {camera} | {name} | {e.mean():.2f} | {numpy.percentile(e, 95):.2f} | {e.max():.2f} |",
                    flush=True,
                )


if __name__ == "__main__":
    main()
