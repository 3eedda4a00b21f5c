"""What a camera's colours mean."""

import html
import os

import numpy

from . import _core, _html
from ._errors import SettingsError


class Profile(_core.Profile):
    """What one camera's colours mean: from linear, balanced camera RGB to XYZ.

    A profile is a function: ``profile(rgb)`` is :meth:`apply`, so that it stands where other libraries take a function of colours
    (colour-science's characterisation among them). It is compared by what it says, and can be pickled. Exposure does not matter
    to it: ``profile(2 * rgb) == 2 * profile(rgb)``, except for plain polynomials.

    >>> profile = Profile.load("Nikon D700")
    >>> profile.lights, profile.is_camera
    (['D65', 'D50', 'A'], True)
    >>> profile([[1, 1, 1], [0.2, 0.4, 0.1]], light="D50").round(3)
    array([[0.964, 1.   , 0.825],
           [0.226, 0.371, 0.045]])
    """

    @classmethod
    def load(cls, name):
        """Reads a profile: a file (Darkroot's own, or a DCP), or the name of a camera that has one.

        Raises :class:`ProfileError` where there is none of that name, and where the file is no usable profile.
        """
        return cls(cls._text_of(os.fspath(name)))

    @classmethod
    def from_text(cls, text):
        """What the text of a profile file says. Raises :class:`ProfileError`."""
        return cls(text)

    def to_text(self):
        """The text of the profile's file."""
        return super().to_text()

    def save(self, path, *, overwrite=False):
        """Writes the profile's file, whole or not at all. The program's ``--profile`` takes it."""
        super().save(os.fspath(path), overwrite=overwrite)

    def apply(self, rgb, light=None):
        """XYZ of camera RGB.

        ``rgb`` is an array of any shape whose last axis is R, G, B: linear, 1 for the white of the light, as
        :meth:`Photo.camera_rgb` gives it. ``light`` names a light of the profile, or a temperature ("4000K") between them; any
        light there is where the profile is a camera (:attr:`is_camera`). It can be left out where the profile has only one.

        Returns ``float64`` in the same shape: XYZ relative to D50, Y = 1 for the white.

        Raises :class:`SettingsError` for a light that the profile does not have.
        """
        return super().apply(numpy.asarray(rgb, dtype=numpy.float64), light)

    __call__ = apply

    def figures(self, light=None):
        """How far the model is off, as a dictionary: ``light``, ``kelvin``, ``model``, and CIEDE2000 (``mean``, ``median``, ``p95``,
        ``max``) over the colours of the fit (``training``), over each left out of it (``left_out``) and over others
        (``held_out``); ``None`` where that is not known."""
        return super().figures(light)

    def patches(self, light=None):
        """The colours of the fit, where the profile keeps them: dictionaries with ``name``, ``rgb``, ``xyz`` and ``de2000``."""
        return super().patches(light)

    def lint(self):
        """What may be wrong with the models: dictionaries with ``light``, ``check``, ``severity`` (note, warning or failure),
        ``value`` and ``words``. Empty where nothing is.

        >>> [finding for finding in Profile.load("Nikon D700").lint() if finding["severity"] == "failure"]
        []
        """
        return super().lint()

    def export(
        self,
        path,
        *,
        light=None,
        raw=None,
        neutral=None,
        space=None,
        shaper="sqrt",
        grid=33,
        icc_version=4,
        overwrite=False,
    ):
        """Writes the profile for other programs; the ending of ``path`` says which: .dcp, .icc, .cube or .clf.

        Parameters
        ----------
        light : name of a light, or for a DCP two.
        raw : for a DCP, a raw file of the camera, whose matrices say what its sensor makes of the white; or ``neutral``, the camera
            RGB of the white, once for each light.
        space : for .cube and .clf, the space of what comes out ("rec2020-linear").
        shaper : for .cube, what goes in: "sqrt" or "none".
        grid : nodes along each side of a table, 2 to 129.
        icc_version : 2 or 4.

        Returns for each light how far the file, read back, is off: ``light``, ``de2000`` and the number of ``colours``.

        >>> found = Profile.load("Nikon D700").export("d750.cube", light="D50", overwrite=True)
        >>> found[0]["de2000"]["mean"] < 0.1
        True
        """
        return super().export(
            os.fspath(path),
            light=light,
            raw=None if raw is None else os.fspath(raw),
            neutral=None if neutral is None else numpy.asarray(neutral, dtype=float).tolist(),
            space=space,
            shaper=shaper,
            grid=grid,
            icc_version=icc_version,
            overwrite=overwrite,
        )

    def __reduce__(self):
        return (type(self), (self.to_text(),))

    def __hash__(self):
        return hash(self.to_text())

    def __repr__(self):
        what = "a camera" if self.is_camera else ", ".join(self.lights)
        return f"<darkroot.Profile {self.camera or 'of any camera'}: {what}>"

    def _repr_html_(self):
        origin = self.origin
        rows = [
            ("camera", self.camera or "any"),
            ("made from", origin["summary"] or None),
            ("date", origin["date"] or None),
        ]
        parts = [f"<h3>{html.escape(self.camera or 'Profile')}</h3>", _html.table(rows)]
        for light in self.lights:
            parts.append(_html.light(self.figures(light), self.patches(light)))
        return "".join(parts)


def fit_profile(
    rgb,
    xyz=None,
    *,
    reflectance=None,
    wavelengths=None,
    light="D50",
    camera="",
    model=None,
    names=None,
    date="",
):
    """Fits a profile to colours that a camera has seen.

    Every kind of model is fitted and cross-validated, and the one that is best on colours left out is taken, unless ``model``
    names one. The white of the light is found through the grey colours, so some should be grey.

    Parameters
    ----------
    rgb : n x 3, linear camera RGB of the colours; balanced or not, at any exposure. At least six.
    xyz : n x 3, what they are: XYZ under D50, Y = 1 for the perfect diffuser; or instead
    reflectance : n x m, their spectral reflectances, 0 to 1, at ``wavelengths`` in nm. Best under lights other than D50.
    light : the light that they were seen in: "D50", "A", "LED-B3", "5200K", "0.34,0.36", or a file with its spectrum.
    camera : make and model ("Nikon D700"). A profile of no camera is accepted for every photograph.
    model : linear, root-2, root-3, root-4, anchored, hue-plane, half, spectral or chromatic.
    names : a name for each colour.
    date : a day that the profile carries, YYYY-MM-DD.

    Raises :class:`ProfileError` where nothing can be fitted, :class:`SettingsError` for arrays that do not fit each other.

    >>> import numpy
    >>> rng = numpy.random.default_rng(1)
    >>> matrix = numpy.array([[0.6, 0.3, 0.0642], [0.2, 0.75, 0.05], [0.0, 0.1, 0.7251]])
    >>> rgb = rng.uniform(0.05, 0.6, (30, 1)) * rng.uniform(0.8, 1.2, (30, 3))
    >>> rgb = numpy.vstack([rgb, numpy.outer([0.1, 0.3, 0.9], [1, 1, 1])])
    >>> profile = fit_profile(rgb, rgb @ matrix.T, model="linear")
    >>> profile.figures()["left_out"]["max"] < 0.05
    True
    """
    references = {"xyz": xyz, "reflectance": reflectance, "wavelengths": wavelengths}
    arrays = {k: numpy.asarray(v, dtype=float) for k, v in references.items() if v is not None}
    rgb = numpy.asarray(rgb, dtype=float)
    for name, array in [("rgb", rgb), *arrays.items()]:
        if array.ndim != (1 if name == "wavelengths" else 2):
            raise SettingsError(f"`{name}` has the shape {array.shape}; a table has a row for each colour")
    text = _core.fit_profile(
        rgb, light=light, camera=camera, model=model, names=None if names is None else list(names), date=date, **arrays
    )
    return Profile(text)


def from_matrix(camera):
    """The profile that a camera's published matrix makes most probable, where nobody has made a better one.

    ``camera`` is a raw file, or make and model as decoders list them ("Nikon D90").

    Raises :class:`ProfileError` for a camera that is not listed.

    >>> from_matrix("Nikon D90").is_camera
    True
    """
    return Profile(_core.from_matrix(os.fspath(camera))[0])


def from_spectra(
    sensitivities, *, camera, wavelengths=None, lights=(), reflectances=(), held_out=(), model=None, date=""
):
    """A profile from a camera's spectral sensitivities.

    Parameters
    ----------
    sensitivities : a CSV file of three spectra; or an array, wavelengths x 3 (red, green, blue), with ``wavelengths`` in nm.
    camera : make and model, as raw files name it.
    reflectances : files of reflectances to fit models to, for the ``lights``. Without them the profile is the camera itself,
        and models for any light follow from it.
    held_out : files of reflectances to judge by.
    model : kind of model for reflectances.

    Raises :class:`ProfileError` for files that cannot be used, :class:`SettingsError` for arrays that are no spectra.
    """
    if wavelengths is not None:
        if lights or reflectances or held_out or model:
            raise SettingsError("`lights`, `reflectances`, `held_out` and `model` go with a file of sensitivities")
        table = numpy.asarray(sensitivities, dtype=float)
        if table.ndim != 2:
            raise SettingsError(f"`sensitivities` has the shape {table.shape}; a table is wavelengths x 3")
        nm = numpy.asarray(wavelengths, dtype=float)
        return Profile(_core.from_sensitivities(nm, table, camera, date))
    text = _core.from_spectra_file(
        os.fspath(sensitivities),
        camera=camera,
        lights=list(lights),
        reflectances=[os.fspath(path) for path in reflectances],
        held_out=[os.fspath(path) for path in held_out],
        model=model,
        date=date,
    )
    return Profile(text)
