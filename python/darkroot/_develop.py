"""Jobs on files."""

import os

from . import _core, _storage, _threads
from ._photo import open


def develop(path, *, dtype=None, scale=1, region=None, recipe=None, threads=None, cancel=None, **settings):
    """Opens a file and develops it: :func:`open` and :meth:`Photo.develop` in one.

    >>> darkroot.develop(sample, scale=1/8, look="vivid").shape
    (60, 90, 3)
    """
    decoder = settings.pop("decoder", "flashraw")
    with open(path, decoder=decoder, threads=threads, cancel=cancel) as photo:
        return photo.develop(
            dtype=dtype, scale=scale, region=region, recipe=recipe, threads=threads, cancel=cancel, **settings
        )


def camera_rgb(path, *, scale=1, region=None, threads=None, cancel=None, **settings):
    """Opens a file and gives its linear camera RGB: :func:`open` and :meth:`Photo.camera_rgb` in one.

    >>> darkroot.camera_rgb(sample, scale=1/8).dtype
    dtype('float32')
    """
    with open(path, threads=threads, cancel=cancel) as photo:
        return photo.camera_rgb(scale=scale, region=region, threads=threads, cancel=cancel, **settings)


def develop_file(src, dst, *, overwrite=False, recipe=None, folders=False, threads=None, cancel=None, **settings):
    """Develops a file into a picture, as ``darkroot develop SRC -o DST`` does, bit for bit.

    The ending of ``dst`` names the format: .jpg, .png, .tif, .webp, .avif, .exr, .jxl or .dng. It is absent, the old one, or the
    complete new one, whatever happens. Both may be URLs that fsspec knows.

    ``folders=True`` takes what ``darkroot.toml`` in the folders above and sidecars beside the file say, as the program does;
    :meth:`Photo.develop` explains the other arguments.

    Returns the report as a dictionary: size, space, what gave the colours, notes on what was assumed, seconds.

    Raises what :func:`open` and :meth:`Photo.develop` raise, :class:`ExistsError` where ``dst`` exists and ``overwrite`` was not
    said, and :class:`StorageError` where it cannot be written.

    >>> report = darkroot.develop_file(sample, "small.jpg", resize="long:64", overwrite=True)
    >>> report["width"], report["height"], report["format"]
    (64, 43, 'JPEG')
    """
    arguments = dict(recipe=recipe, folders=folders, threads=_threads.checked(threads), cancel=cancel, **settings)
    if _storage.is_remote(dst):
        make = lambda local: {**develop_file(src, local, **arguments), "output": dst}  # noqa: E731
        return _storage.write(dst, make, overwrite)
    if _storage.is_remote(src):
        with _storage.copied(src) as local:
            report = _core.develop_file(local, os.fspath(dst), overwrite=overwrite, **arguments)
        return {**report, "input": src}
    return _core.develop_file(os.fspath(src), os.fspath(dst), overwrite=overwrite, **arguments)


def inspect(path, *, threads=None):
    """What a raw file is, without developing it, as ``darkroot inspect --json`` says it: a dictionary.

    Camera, sizes, levels, matrices, white as shot, how much is clipped, a histogram, and the hash of the samples.

    >>> facts = darkroot.inspect(sample)
    >>> facts["camera"], facts["filters"], facts["bits"]
    ('Nikon D750', 'RGGB', 14)
    """
    with open(path, threads=threads) as photo:
        return photo.inspect(threads=threads)


def settings():
    """Every setting as a dictionary: ``name``, ``default``, ``help``, ``allowed`` (in words), ``type``, ``range``, ``words``.

    Keywords are the names with underscores for dashes.

    >>> exposure = next(s for s in darkroot.settings() if s["name"] == "exposure")
    >>> exposure["range"], exposure["unit"]
    ([-20.0, 20.0], 'stops')
    """
    return _core.describe()
