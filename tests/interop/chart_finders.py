"""One program that finds colour charts, in its own process: chart_finders.py NAME < names of pictures

Prints a line of JSON for each picture: seconds that the search took (reading the file is not counted), and for every
chart its type, its grid and the centres of its patches in pixels, from patch 1 on, row by row. Exit code 9 and the name
of the package when it is not installed. Used by charts.py.
"""
import contextlib
import json
import sys
import time
import warnings

import numpy as np

warnings.simplefilter("ignore")


def opencv(kind):
    import cv2

    if not hasattr(cv2, "mcc"):
        raise ImportError("opencv-contrib-python")
    grid, name = {"MCC24": ((6, 4), "classic24"), "SG140": ((14, 10), "sg140")}[kind]

    def find(path):
        picture = cv2.imread(path)
        start = time.perf_counter()
        detector = cv2.mcc.CCheckerDetector_create()
        # The type was an argument before OpenCV 5.
        if hasattr(detector, "setColorChartType"):
            detector.setColorChartType(getattr(cv2.mcc, kind))
            found = detector.process(picture)
        else:
            found = detector.process(picture, getattr(cv2.mcc, kind))
        charts = detector.getListColorChecker() if found else []
        seconds = time.perf_counter() - start
        corners = [np.array(c.getColorCharts()).reshape(-1, 4, 2) for c in charts]
        return seconds, [(name, grid, quads.mean(1)) for quads in corners]

    return find, f"OpenCV {cv2.__version__} mcc, {kind}"


def plantcv():
    import importlib.metadata

    from plantcv import plantcv as pcv

    version = importlib.metadata.version("plantcv")

    def find(path):
        picture = pcv.readimage(path, mode="rgb")[0][:, :, :3]
        start = time.perf_counter()
        try:
            labels = pcv.transform.detect_color_card(rgb_img=picture)
        except (RuntimeError, ValueError, IndexError, ZeroDivisionError):
            return time.perf_counter() - start, []
        seconds = time.perf_counter() - start
        centres = {}
        for chip in range(24):
            rows, columns = np.nonzero(labels == 10 * (chip + 1))
            # It numbers from white on: up the columns, as `std_color_matrix(pos=3)` has the colours.
            patch = (3 - chip % 4) * 6 + chip // 4
            centres[patch] = [columns.mean(), rows.mean()] if len(rows) else [np.nan, np.nan]
        return seconds, [("classic24", (6, 4), np.array([centres[i] for i in range(24)]))]

    return find, f"PlantCV {version} detect_color_card"


def colour_checker_detection(templated):
    import importlib.metadata

    import colour
    import cv2
    import sklearn  # noqa: F401: needed by the templated form, which asks in a way that colour-science does not know yet.
    from colour.utilities.requirements import REQUIREMENTS_TO_CALLABLE
    from colour_checker_detection.detection import segmentation
    from colour_checker_detection.detection import templated as by_template

    REQUIREMENTS_TO_CALLABLE.setdefault("scikit-learn", lambda **_: True)
    version = importlib.metadata.version("colour-checker-detection")
    place, warped = (np.array([[1440, 0], [1440, 960], [0, 960], [0, 0]], np.float32)), []
    warp = cv2.warpPerspective

    def remembered(picture, transform, size, **settings):
        warped.append(transform)
        return warp(picture, transform, size, **settings)

    def segmented(picture):
        found = segmentation.detect_colour_checkers_segmentation(picture, additional_data=True)
        for chart in found:
            to_chart = cv2.getPerspectiveTransform(np.float32(chart.quadrilateral), place)
            y0, y1, x0, x1 = np.array(chart.swatch_masks).T
            yield np.linalg.inv(to_chart), np.stack([(x0 + x1) / 2, (y0 + y1) / 2], 1)

    def by_templates(picture):
        template = by_template.TEMPLATE_COLORCHECKER_CLASSIC
        cv2.warpPerspective = remembered
        try:
            found = by_template.detect_colour_checkers_templated(picture, additional_data=True)
        except ValueError:  # "No valid transformation found"
            return
        finally:
            cv2.warpPerspective = warp
        for chart in found:
            centres = np.array(template.swatch_centroids, float)
            # Whether it reversed the patches is told by the colours only.
            x, y = centres[0].astype(int)
            first = chart.colour_checker[max(y - 16, 0) : y + 16, max(x - 16, 0) : x + 16].reshape(-1, 3).mean(0)
            turned = np.abs(chart.swatch_colours[0] - first).sum() > np.abs(chart.swatch_colours[-1] - first).sum()
            yield np.linalg.inv(warped[-1]), centres[::-1] if turned else centres

    def find(path):
        picture = colour.io.read_image(path)[..., :3]
        start = time.perf_counter()
        # It works on light, as in its own examples.
        found = list((by_templates if templated else segmented)(colour.cctf_decoding(picture)))
        seconds = time.perf_counter() - start
        height, width = picture.shape[:2]
        charts = []
        for back, centres in found:
            at = np.c_[centres, np.ones(len(centres))] @ back.T
            u, v = ((at[:, :2] / at[:, 2:] + 0.5) * max(width, height) / 1440 - 0.5).T
            # Tall pictures are turned clockwise before the search.
            charts.append(("classic24", (6, 4), np.stack([v, height - 1 - u], 1) if width < height else np.stack([u, v], 1)))
        return seconds, charts

    return find, f"colour-checker-detection {version}, {'templated' if templated else 'segmentation'}"


FINDERS = {
    "opencv": lambda: opencv("MCC24"),
    "opencv-sg": lambda: opencv("SG140"),
    "segmentation": lambda: colour_checker_detection(False),
    "templated": lambda: colour_checker_detection(True),
    "plantcv": plantcv,
}

if __name__ == "__main__":
    out = sys.stdout
    with contextlib.redirect_stdout(sys.stderr):
        try:
            find, title = FINDERS[sys.argv[1]]()
        except ImportError as fault:
            print(fault, file=out)
            sys.exit(9)
        print(json.dumps(title), file=out)
        for path in sys.stdin.read().splitlines():
            start = time.perf_counter()
            try:
                seconds, charts = find(path)
            except Exception as fault:  # A program that fails on a picture has found nothing in it.
                print(f"{path}: {type(fault).__name__}: {fault}")
                seconds, charts = time.perf_counter() - start, []
            charts = [{"chart": n, "grid": g, "centres": c.tolist()} for n, g, c in charts if np.isfinite(c).all()]
            print(json.dumps({"seconds": seconds, "charts": charts}), file=out, flush=True)
