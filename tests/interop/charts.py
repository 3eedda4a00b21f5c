#!/usr/bin/env python3
"""Who finds colour charts, and where: charts.py DARKROOT LABELLED [--install | --alone] [--raw FOLDER]
[--clutter FOLDER] [--into FILE]

Runs OpenCV's mcc, colour-checker-detection, PlantCV and `darkroot chart` on the same pictures and prints a Markdown table,
or puts it between the markers of FILE. LABELLED holds photographs and `labels.json`; --raw names a folder of raw files
(those of charts excepted they must have none), --clutter a folder of pictures without a chart, such as the example
`clutter_pictures` of the crate `darkroot-chart` writes.

With --install the other programs are installed from PyPI, each into an environment of its own under target/interop; what
is not there is named in the table. With --alone only Darkroot is run. Needs numpy and Pillow itself. Exit code 1 when
Darkroot misses or turns a chart, invents one, or is off by more than 0.02 patch in the median.
"""
import argparse
import json
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

try:
    import numpy as np
    from PIL import Image
except ImportError as missing:
    print(f"skipped: {missing.name} is not installed (PyPI: numpy, pillow)")
    sys.exit(0)

HERE = Path(__file__).resolve().parent
ENVIRONMENTS = HERE.parent.parent / "target" / "interop"
PEERS = [
    ("opencv", ["opencv-contrib-python-headless"]),
    ("opencv-sg", ["opencv-contrib-python-headless"]),
    ("segmentation", ["colour-checker-detection", "opencv-python-headless", "scikit-learn"]),
    ("templated", ["colour-checker-detection", "opencv-python-headless", "scikit-learn"]),
    ("plantcv", ["plantcv"]),
]
LONGEST = 1500  # Pixels of the longer side of developed raw files.
MARKERS = ("<!-- charts.py: from here -->", "<!-- charts.py: to here -->")


class Label:
    """A chart of a labelled photograph."""

    def __init__(self, entry):
        self.usable = entry["usable"] is True
        self.grid = tuple(entry["grid"])
        self.kind = "classic24" if entry["classic_layout"] else entry["type"]
        to_picture = homography(np.array(entry["corners"], float))
        gap, (columns, rows) = entry.get("gap_frac", [0.2, 0.2]), self.grid
        at = lambda i, n, g, edge: (i * (1 + g) + edge) / (n + (n - 1) * g)
        place = lambda x, y: apply(
            to_picture,
            np.array([[at(c, columns, gap[0], x), at(r, rows, gap[1], y)] for r in range(rows) for c in range(columns)]),
        )
        self.centres = place(0.5, 0.5)
        a, b, c, d = place(0, 0), place(1, 0), place(1, 1), place(0, 1)
        cross = lambda p, q: p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]
        self.sides = np.sqrt(np.abs(cross(c - a, d - b)) / 2)

    def is_at(self, centres):
        """Whether a chart that was found stands here, whichever way round and of whatever type."""
        middle, other = self.centres.mean(0), centres.mean(0)
        spread = lambda points: np.sqrt(((points - points.mean(0)) ** 2).sum(1).mean())
        near = np.hypot(*(middle - other)) < 1.5 * self.sides.mean()
        return near and 0.6 < spread(centres) / spread(self.centres) < 1.7

    def errors(self, centres):
        return np.hypot(*(centres - self.centres).T) / self.sides


def homography(corners):
    """From the unit square to a quadrilateral, clockwise from (0, 0)."""
    rows, values = [], []
    for (u, v), (x, y) in zip([(0, 0), (1, 0), (1, 1), (0, 1)], corners):
        rows += [[u, v, 1, 0, 0, 0, -u * x, -v * x], [0, 0, 0, u, v, 1, -u * y, -v * y]]
        values += [x, y]
    return np.append(np.linalg.solve(rows, values), 1).reshape(3, 3)


def apply(matrix, points):
    at = np.c_[points, np.ones(len(points))] @ matrix.T
    return at[:, :2] / at[:, 2:]


def environment(packages, install):
    """Python of an environment with the packages; None where there is none."""
    folder = ENVIRONMENTS / packages[0]
    python = folder / "bin" / "python"
    if not (folder / "complete").exists():
        if not install:
            return None
        subprocess.run([sys.executable, "-m", "venv", folder], check=True)
        pip = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        done = subprocess.run([*pip, *packages], capture_output=True, text=True)
        if done.returncode != 0:
            return None
        (folder / "complete").touch()
    return python


def peer(name, packages, pictures, install):
    """Title of a program and what it found in each picture; None for what is not installed."""
    python = environment(packages, install)
    if python is None:
        return f"{packages[0]}: {'cannot be' if install else 'is not'} installed here", None
    run = subprocess.run(
        [python, HERE / "chart_finders.py", name], input="\n".join(map(str, pictures)), capture_output=True, text=True
    )
    if run.returncode == 9:
        return f"{packages[0]}: cannot be used here ({run.stdout.strip()})", None
    if run.returncode != 0:
        sys.exit(f"{name}: {run.stderr[-2000:]}")
    failures = [line for line in run.stderr.splitlines() if "Error: " in line]
    print(f"{name}: failed on {len(failures)} pictures" + "".join(f"\n  {f}" for f in failures[:3]), file=sys.stderr)
    title, *lines = map(json.loads, run.stdout.splitlines())
    return title, [(line["seconds"], line["charts"]) for line in lines]


def darkroot(program, pictures):
    found = []
    for picture in pictures:
        start = time.perf_counter()
        run = subprocess.run([program, "chart", "--json", picture], capture_output=True, text=True)
        seconds = time.perf_counter() - start
        # 1 is a picture without a chart, or one that cannot be read: then nothing is printed.
        if run.returncode not in (0, 1) or not run.stdout:
            raise SystemExit(f"{picture}: {run.stderr}")
        charts = json.loads(run.stdout)["charts"]
        for chart in charts:
            # The 24 patches of the classic come on cards of many sizes.
            if chart["grid"] == [6, 4] and not chart["chart"].startswith("spyder"):
                chart["chart"] = "classic24"
        found.append((seconds, charts))
    return found


class Score:
    """Figures of one program."""

    def __init__(self, photos, results, others):
        self.found = {"classic24": [0, 0], "others": [0, 0]}
        self.turned, self.errors, self.worst, self.lookalikes = 0, [], 0.0, 0
        for labels, (_, charts) in zip(photos, results):
            for label in labels:
                counted = self.found["classic24" if label.kind == "classic24" else "others"]
                wanted = label.usable and label.kind != "other"
                counted[1] += wanted
                for chart in [c for c in charts if c["chart"] == label.kind and label.is_at(np.array(c["centres"]))][:1]:
                    chart["labelled"] = True
                    errors = label.errors(np.array(chart["centres"]))
                    if np.median(errors) > 0.5:
                        self.turned += 1
                    elif wanted:
                        counted[0] += 1
                        self.errors.append(float(np.median(errors)))
                        self.worst = max(self.worst, float(errors.max()))
            self.lookalikes += sum("labelled" not in chart for chart in charts)
        self.invented = {name: sum(bool(charts) for _, charts in found) for name, found in others.items()}
        self.seconds = statistics.median(seconds for seconds, _ in results)

    def cells(self):
        (classic, of_classic), (other, of_others) = self.found.values()
        median = f"{statistics.median(self.errors):.4f}" if self.errors else "–"
        worst = f"{max(self.errors):.3f}" if self.errors else "–"
        return [
            f"{classic} of {of_classic}", f"{other} of {of_others}", self.turned, median, worst,
            self.lookalikes, *self.invented.values(), f"{self.seconds:.2f}",
        ]

    def is_good(self):
        everything = all(found == wanted for found, wanted in self.found.values())
        wrong = self.turned + self.lookalikes + sum(self.invented.values())
        return everything and wrong == 0 and statistics.median(self.errors) <= 0.02


def developed(program, raw_files, folder):
    """Raw files as other programs can read them."""
    pictures = []
    for raw in raw_files:
        picture = folder / f"{raw.name}.png"
        run = subprocess.run([program, "develop", "-q", raw, "-o", picture], capture_output=True, text=True)
        if run.returncode != 0:
            print(f"not developed: {run.stderr.strip()}", file=sys.stderr)
            continue
        with Image.open(picture) as opened:
            opened.thumbnail((LONGEST, LONGEST), Image.Resampling.BOX)
            opened.save(picture)
        pictures.append(picture)
    return pictures


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("darkroot", type=Path)
    arguments.add_argument("labelled", type=Path)
    who = arguments.add_mutually_exclusive_group()
    who.add_argument("--install", action="store_true")
    who.add_argument("--alone", action="store_true")
    arguments.add_argument("--raw", type=Path)
    arguments.add_argument("--clutter", type=Path)
    arguments.add_argument("--into", type=Path)
    asked = arguments.parse_args()
    program = asked.darkroot.resolve()
    photos = []
    for name, entry in sorted(json.loads((asked.labelled / "labels.json").read_text()).items()):
        labels = [Label(chart) for chart in entry["charts"]]
        # The look-alike for which there is a layout of its own.
        for label in labels:
            if "SpyderCheckr 24" in entry.get("notes", ""):
                label.kind = "spyder24"
        photos.append((asked.labelled / name, labels))
    with tempfile.TemporaryDirectory() as folder:
        groups = {"labelled": [path for path, _ in photos]}
        if asked.raw:
            raw = sorted(f for f in asked.raw.iterdir() if f.suffix != ".tsv" and "chart" not in f.name)
            groups["raw"] = developed(program, raw, Path(folder))
        if asked.clutter:
            groups["clutter"] = sorted(asked.clutter.glob("*.png"))
        pictures = [p for group in groups.values() for p in group]
        rows, good = [], True
        runs = [("Darkroot", darkroot(program, pictures))]
        runs += [peer(*named, pictures, asked.install) for named in PEERS if not asked.alone]
        for title, results in runs:
            if results is None:
                rows.append(f"| {title} |" + " – |" * (7 + len(groups)))
                continue
            parts, at = {}, 0
            for name, group in groups.items():
                parts[name] = results[at : at + len(group)]
                at += len(group)
            score = Score([labels for _, labels in photos], parts.pop("labelled"), parts)
            rows.append("| " + " | ".join(str(c) for c in [title, *score.cells()]) + " |")
            if title == "Darkroot":
                good = score.is_good()
    heads = ["program", "classic 24 found", "other charts found", "turned", "median error", "worst error", "wrong in these photographs"]
    heads += [f"invented in {len(groups[name])} {what}" for name, what in [("raw", "raw photographs"), ("clutter", "of clutter")] if name in groups]
    heads += ["seconds"]
    table = "\n".join(["| " + " | ".join(heads) + " |", "|---" * len(heads) + "|", *rows])
    print(table)
    if asked.into:
        text = asked.into.read_text()
        before, rest = text.split(MARKERS[0])
        asked.into.write_text(f"{before}{MARKERS[0]}\n{table}\n{MARKERS[1]}{rest.split(MARKERS[1])[1]}")
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
