"""A photograph in memory."""

import functools
import os

import numpy

from . import _core, _html, _storage, _threads
from ._errors import SettingsError


class Photo(_core.Photo):
    """A decoded raw file, made by :func:`darkroot.open`.

    A ``with`` statement closes it at its end: its samples go, as soon as no array needs them any more.

    >>> with darkroot.open(sample) as photo:
    ...     print(photo.camera, photo.cfa, photo.mosaic.shape, photo.mosaic.dtype)
    ...     picture = photo.develop(scale=1/4)
    Nikon D750 RGGB (480, 720) uint16
    >>> picture.shape, picture.dtype
    ((120, 180, 3), dtype('uint8'))
    """

    @property
    def mosaic(self):
        """The samples of the whole frame as decoded: a read-only view without a copy, which outlives the photo.

        Height x width under a colour filter array or of a monochrome sensor, height x width x 3 for a linear DNG; ``uint16``,
        or ``float32`` for DNG files of floating point. Black and white level are not applied: see :meth:`light`.

        >>> photo = darkroot.open(sample)
        >>> photo.mosaic.flags.writeable, bool(photo.mosaic.max() <= photo.white.max())
        (False, True)
        """
        return numpy.asarray(self._samples)

    @property
    def active(self):
        """The part of :attr:`mosaic` where light falls, as :attr:`active_area` says; a view, too."""
        x, y, width, height = self.active_area
        return self.mosaic[y : y + height, x : x + width]

    def light(self, *, threads=None):
        """Linear light under the filters: black level and white level applied, nothing interpolated or clipped.

        Returns an array of ``float32`` in the shape of :attr:`mosaic`; 0 is black, 1 is the white level. Corrections that the
        file itself asks for before interpolation (DNG OpcodeList2) are in it.

        >>> light = darkroot.open(sample).light()
        >>> light.shape, light.dtype, bool(light.max() <= 1.0)
        ((480, 720), dtype('float32'), True)
        """
        return super().light(threads=_threads.checked(threads))

    def develop(self, *, dtype=None, scale=1, region=None, recipe=None, threads=None, cancel=None, **settings):
        """Develops the picture, or a part of it, upright.

        Settings are those of the program with underscores for dashes, from one table: :func:`darkroot.settings` lists names,
        ranges and words. ``recipe`` (a :class:`Recipe`, a dictionary, or a file) holds some, and keywords count more.

        Parameters
        ----------
        dtype : ``uint8``, ``uint16`` or ``float32``; without it ``float32`` for light of the scene (``look="linear"``,
            ``space="camera"``) and ``uint8`` for all else. Integers span 0 to 255 or 65535, ``float32`` has 1 for white.
        scale : 1, 1/2, 1/4 ... 1/64: size against the whole picture. Small scales are fast: less is computed.
        region : (x, y, width, height) in pixels of the upright picture at that scale. At scale 1 it is, bit for bit, that
            rectangle of the whole picture.
        threads : how many; all cores if not given, one inside an engine (Ray, Dask).
        cancel : a :class:`Cancel` that ends it from another thread.

        Returns an array of height x width x 3, R, G and B in the colour space that the settings name (sRGB if none).

        Of the last view of at most 8 megapixels the camera RGB is kept (12 bytes a pixel, until the photo is closed): the same
        view with another exposure, look, tone, saturation or output takes a fraction of the time.

        Raises :class:`SettingsError` for a setting that is none or does not go with the others, :class:`ProfileError` for
        a profile of another camera.

        >>> photo = darkroot.open(sample)
        >>> photo.develop(look="linear", scale=1/2).dtype
        dtype('float32')
        >>> photo.develop(region=(100, 50, 32, 16), dtype="uint16", space="adobe-rgb").shape
        (16, 32, 3)
        >>> photo.develop(look="film")
        Traceback (most recent call last):
        darkroot.SettingsError: `look`: `film` is no look: use neutral, vivid, flat, camera, dcp, reproduction or linear
        """
        return super().develop(
            dtype=dtype,
            scale=scale,
            region=region,
            recipe=recipe,
            threads=_threads.checked(threads),
            cancel=cancel,
            **settings,
        )

    def camera_rgb(self, *, scale=1, region=None, threads=None, cancel=None, **settings):
        """Linear camera RGB before any profile: balanced so that the white of the light is (1, 1, 1), interpolated.

        Returns ``float32``, height x width x 3. It is what a :class:`Profile` takes. :meth:`develop` says what the arguments are.

        >>> rgb = darkroot.open(sample).camera_rgb(scale=1/8)
        >>> rgb.shape, rgb.dtype
        ((60, 90, 3), dtype('float32'))
        """
        return self.develop(
            scale=scale, region=region, threads=threads, cancel=cancel, **{**settings, "space": "camera"}
        )

    def explain(self, *, recipe=None, threads=None, **settings):
        """What :meth:`develop` with the same settings does, as a dictionary: size, space, what gives the colours, white of the
        light (``kelvin``, ``tint``, ``multipliers``), demosaicing, exposure (``gain``), and notes on what was assumed.

        >>> darkroot.open(sample).explain()["demosaic"]
        'directional LMMSE (Zhang and Wu 2005)'
        """
        return super().explain(recipe=recipe, threads=_threads.checked(threads), **settings)

    def inspect(self, *, threads=None):
        """All facts about the file, as :func:`darkroot.inspect` gives them."""
        return super().inspect(threads=_threads.checked(threads))

    def to_xarray(self, **arguments):
        """The developed picture as an ``xarray.DataArray`` (dimensions y, x, channel); needs xarray.

        Arguments are those of :meth:`develop`; what the camera wrote, and what gave the colours, are its attributes.
        """
        try:
            import xarray
        except ImportError:
            raise SettingsError("to_xarray needs xarray; install it with `pip install xarray`") from None
        picture = self.develop(**arguments)
        asked = {k: v for k, v in arguments.items() if k not in ("dtype", "scale", "region", "cancel")}
        told = self.explain(**asked)
        facts = {"camera": self.camera, "space": told["space"], "colours": told["colours"], **self.metadata}
        return xarray.DataArray(
            picture,
            dims=("y", "x", "channel"),
            coords={"channel": ["R", "G", "B"]},
            name=os.path.basename(self.name),
            attrs={name: value for name, value in facts.items() if value is not None},
        )

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __reduce__(self):
        raise TypeError("a photo does not go to another process; send its path or its bytes, and open it there")

    def __repr__(self):
        height, width = self.mosaic.shape[:2]
        return f"<darkroot.Photo {os.fspath(self.name)!r}: {self.camera}, {width} x {height}>"

    def _repr_html_(self):
        return _html.photo(self)


def open(source, *, decoder="flashraw", threads=None, cancel=None):
    """Opens a raw file: NEF, DNG, CR2, ARW, RAF and the others that the program reads.

    ``source`` is a path, a URL that fsspec reads (``s3://bucket/a.nef``), the bytes of a file, or an open file with ``read``.

    Raises :class:`MissingError` (a ``FileNotFoundError``) where there is no such file, :class:`StorageError` where it cannot be
    read, :class:`UnsupportedError` for cameras and compressions that are not known, and :class:`FileError` for files that
    are damaged or no raw files. Hostile files raise, too: none crashes Python, or takes memory without bounds.

    >>> darkroot.open(sample).camera
    'Nikon D750'
    >>> with builtins.open(sample, "rb") as file:
    ...     darkroot.open(file).white
    array([16383., 16383., 16383.], dtype=float32)
    >>> darkroot.open(b"GIF89a")
    Traceback (most recent call last):
    darkroot.FileError: the bytes: is not a raw photograph: it is a GIF picture; give a raw file such as NEF, DNG, CR2, ARW or RAF
    >>> darkroot.open("nothing.nef")
    Traceback (most recent call last):
    darkroot.MissingError: nothing.nef: cannot be read: there is no such file; check the name
    """
    make = functools.partial(Photo, decoder=decoder, threads=_threads.checked(threads), cancel=cancel)
    if _storage.is_remote(source):
        return make(_storage.read(source), name=source)
    if isinstance(source, (str, os.PathLike)):
        return make(os.fspath(source))
    if isinstance(source, (bytes, bytearray, memoryview)):
        return make(bytes(source))
    if hasattr(source, "read"):
        data = source.read()
        if not isinstance(data, (bytes, bytearray, memoryview)):
            raise SettingsError("the file gives text; open it in binary mode, `open(path, 'rb')`")
        name = getattr(source, "name", None)
        return make(bytes(data), name=name if isinstance(name, str) else "the file")
    raise SettingsError(f"{type(source).__name__} is nothing to open; give a path, a URL, bytes or a binary file")
