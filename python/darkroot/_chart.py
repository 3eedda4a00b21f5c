"""Shots of colour charts: finding them, measuring them, profiles from them, judging by them."""

import dataclasses
import os

import numpy

from . import _core, _html
from ._errors import SettingsError
from ._profile import Profile


def _said(
    chart="classic24",
    reference=None,
    *,
    corners=None,
    flat=None,
    dark=None,
    even_out="auto",
    correct_glare="auto",
    exclude=(),
    accept=False,
    allow_rendered=False,
):
    """How a shot is read, as the core takes it. The names are the program's."""
    path = lambda value: None if value is None else os.fspath(value)  # noqa: E731
    return {
        "chart": path(chart),
        "reference": path(reference),
        "corners": None if corners is None else numpy.asarray(corners, dtype=float).reshape(4, 2).tolist(),
        "flat": path(flat),
        "dark": path(dark),
        "even_out": even_out,
        "correct_glare": correct_glare,
        "exclude": list(exclude),
        "accept": accept,
        "allow_rendered": allow_rendered,
    }


@dataclasses.dataclass(frozen=True)
class FoundChart:
    """A chart in a picture; places are x, y in pixels of the developed picture."""

    #: Name of its layout ("classic24").
    chart: str
    #: How sure that is, 0 to 1.
    confidence: float
    #: 4 x 2: outer corners of the corner patches, from patch 1 on clockwise as the chart is printed.
    corners: numpy.ndarray
    #: patches x 4 x 2: the part of each patch that is measured, row by row.
    patches: numpy.ndarray
    #: Turn of the chart's top edge, clockwise.
    rotation_degrees: float
    #: Side of a patch in pixels.
    patch_pixels: float


def detect_charts(source, *, charts=None):
    """Looks for colour charts, the surest first; a list of :class:`FoundChart`, empty where there is none.

    ``source`` is a raw file, a rendered picture (JPEG, PNG, TIFF), or an array of height x width x 3: integers as sRGB, floating
    point as linear light. ``charts`` names the layouts to look for; all that are built in if not given.
    """
    if isinstance(source, (str, os.PathLike)):
        found = _core.detect_charts(os.fspath(source), None, charts)
    else:
        found = _core.detect_charts(None, _linear(source), charts)
    return [
        FoundChart(
            chart=one["chart"],
            confidence=one["confidence"],
            corners=numpy.array(one["corners"]),
            patches=numpy.array(one["patches"]),
            rotation_degrees=one["rotation_degrees"],
            patch_pixels=one["patch_pixels"],
        )
        for one in found
    ]


def _linear(picture):
    picture = numpy.asarray(picture)
    if picture.ndim != 3 or picture.shape[2] != 3:
        raise SettingsError(f"the picture has the shape {picture.shape}; it must be height x width x 3")
    if picture.dtype.kind == "f":
        return numpy.ascontiguousarray(picture, dtype=numpy.float32)
    if picture.dtype.kind != "u":
        raise SettingsError(f"the picture is of {picture.dtype}; it must be uint8, uint16 or floating point")
    coded = picture.astype(numpy.float32) / numpy.iinfo(picture.dtype).max
    return numpy.where(coded <= 0.04045, coded / 12.92, ((coded + 0.055) / 1.055) ** 2.4).astype(numpy.float32)


@dataclasses.dataclass(frozen=True)
class MeasuredChart:
    """What a camera made of a chart's patches."""

    #: Common name of the camera.
    camera: str
    #: Name of each patch.
    names: list
    #: n x 3: linear camera RGB, not balanced, 1 for the white level; corrected as asked.
    rgb: numpy.ndarray
    #: n x 3: standard error of it.
    uncertainty: numpy.ndarray
    #: n x 3: what the patches are, XYZ under D50.
    xyz: numpy.ndarray
    #: Why each patch takes no part, or ``None``.
    excluded: list
    #: Checks of the shot: dictionaries with ``name``, ``verdict`` (good, warning, refused), ``words`` and ``advice``.
    gates: list
    #: 4 x 2: where the chart is.
    corners: numpy.ndarray
    #: How sure that is, 0 to 1.
    confidence: float
    #: What had to be assumed.
    notes: list

    @property
    def used(self):
        """n, boolean: which patches take part."""
        return numpy.array([reason is None for reason in self.excluded])

    def _repr_html_(self):
        return _html.swatches(self.names, self.xyz) + _html.gates(self.gates)


def _measured(shot):
    patches = shot["patches"]
    column = lambda name: numpy.array([patch[name] for patch in patches])  # noqa: E731
    return MeasuredChart(
        camera=shot["camera"],
        names=[patch["name"] for patch in patches],
        rgb=column("rgb"),
        uncertainty=column("uncertainty"),
        xyz=column("xyz"),
        excluded=[patch["excluded"] for patch in patches],
        gates=shot["gates"],
        corners=numpy.array(shot["corners"]),
        confidence=shot["confidence"],
        notes=shot["notes"],
    )


def measure_chart(path, chart="classic24", reference=None, **how):
    """Finds a chart in a raw file and measures its patches, from the samples of the sensor as they are.

    Parameters
    ----------
    chart : name of a chart that is built in (classic24, passport24, sg140 ...), or a file that describes one.
    reference : what the patches are: a built-in reference or a file (CGATS, CxF 3, CSV); that of the chart if not given.
    corners : 4 x 2, where the chart is; found if not given.
    flat, dark : files: an even surface in the same light; a shot with the lens closed.
    even_out, correct_glare : "auto", "always" or "never": whether uneven light and stray light are taken out.
    exclude : names of patches to leave out.
    accept : use a shot that fails a check.
    allow_rendered : take JPEG, PNG and TIFF, too.

    Returns a :class:`MeasuredChart`. Raises :class:`ChartError` where no chart is found, or the shot is not good enough.
    """
    return _measured(_core.measure_chart(os.fspath(path), _said(chart, reference, **how)))


@dataclasses.dataclass(frozen=True)
class MadeProfile:
    """A profile from shots of a chart, and how it came about."""

    #: The profile.
    profile: Profile
    #: A page of HTML with pictures, plots and figures.
    report: str
    #: For each light: ``light``, ``model``, ``figures``, ``models`` (all that were tried), ``gates``, ``notes``.
    lights: list
    #: The shots of all lights.
    shots: list

    def _repr_html_(self):
        return _html.page(self.report)


def make_profile(
    shots,
    *,
    light,
    chart="classic24",
    reference=None,
    average=False,
    as_camera=False,
    model=None,
    date="",
    **how,
):
    """Makes a profile from raw shots of a chart, as ``darkroot profile`` does.

    ``shots`` is a file or several; ``light`` one light for all, or one for each. Shots of several exposures under one light are a
    bracket. ``average`` takes the mean of shots at one exposure. ``as_camera`` keeps the camera, from which colours for any light
    follow. ``model`` names a kind of model; the best by cross-validation if not given. :func:`measure_chart` explains the rest.

    Returns a :class:`MadeProfile`. Raises :class:`ChartError`, :class:`ProfileError`.
    """
    paths = [shots] if isinstance(shots, (str, os.PathLike)) else list(shots)
    lights = [light] * len(paths) if isinstance(light, str) else list(light)
    if len(lights) != len(paths) or not paths:
        raise SettingsError(
            f"there are {len(paths)} shots and {len(lights)} lights; give one light for all, or one each"
        )
    named = [(os.fspath(path), one) for path, one in zip(paths, lights)]
    text, report, told = _core.make_profile(
        named, _said(chart, reference, **how), average=average, as_camera=as_camera, model=model, date=date
    )
    measured = [_measured(shot) for one in told for shot in one["shots"]]
    kept = [{name: value for name, value in one.items() if name != "shots"} for one in told]
    return MadeProfile(profile=Profile(text), report=report, lights=kept, shots=measured)


def verify(path, *, profile=None, light=None, preset=None, chart="classic24", reference=None, **how):
    """Judges a shot of a chart.

    With a ``profile`` (a :class:`Profile` or its name), ``path`` is a raw shot, and the profile is judged by it. Without one, ``path``
    is a finished picture (TIFF, JPEG, PNG), which is judged by the chart's reference, and by a guideline where ``preset`` names
    one ("fadgi-4star", "iso19264-a", "metamorfoze-full" ...).

    Returns a dictionary: ``light``, ``de2000`` and ``sl1`` (mean, median, p95, max), ``patches``; for finished pictures also ``space``,
    ``verdicts``, whether all were ``kept``, and ``figures``: everything that was measured, as ``darkroot verify --json`` prints it.

    Raises :class:`ChartError` where no chart is found, or the picture is of another light than the one named.
    """
    if profile is None:
        return _core.verify_picture(os.fspath(path), _said(chart, reference, **how), light, preset)
    if preset is not None:
        raise SettingsError("`preset` goes with finished pictures; leave out `profile` to judge one")
    if not isinstance(profile, Profile):
        profile = Profile.load(profile)
    how = {"even_out": "never", "correct_glare": "never", **how}
    return _core.verify_shot(os.fspath(path), profile, _said(chart, reference, **how), light)
