"""Where files are: on this machine, or wherever fsspec reaches (``s3://``, ``gs://``, ``memory://``)."""

import contextlib
import os
import tempfile
import uuid
from pathlib import Path

from ._errors import ExistsError, MissingError, SettingsError, StorageError

#: What fsspec's file systems raise.
FAULTS = (OSError, ValueError, NotImplementedError)


def is_remote(path):
    """Whether a name is a URL that fsspec reads. ``file://`` is one, too."""
    return isinstance(path, str) and "://" in path


def _filesystem(url):
    try:
        import fsspec
    except ImportError:
        raise SettingsError(f"{url}: files by URL need fsspec; install it with `pip install fsspec`") from None
    return fsspec.core.url_to_fs(url)


def read(url):
    """The bytes of a file at a URL."""
    filesystem, path = _filesystem(url)
    try:
        return filesystem.cat_file(path)
    except FileNotFoundError:
        raise MissingError(f"{url}: cannot be read: there is no such file; check the name") from None
    except FAULTS as fault:
        raise StorageError(f"{url}: cannot be read: {fault}") from fault


@contextlib.contextmanager
def copied(url):
    """The path of a copy of a file at a URL, with its own name, as long as it is needed."""
    data = read(url)
    with tempfile.TemporaryDirectory(prefix="darkroot-") as folder:
        local = os.path.join(folder, os.path.basename(url) or "input")
        Path(local).write_bytes(data)
        yield local


def write(url, make, overwrite):
    """Puts a file at a URL, whole or not at all.

    ``make(path)`` writes it to a path of this machine. It goes up under a name of its own and gets its name at last; where a
    store has no renaming (object stores), its own upload is whole or nothing.
    """
    filesystem, path = _filesystem(url)
    if not overwrite and filesystem.exists(path):
        raise ExistsError(f"{url}: exists already")
    with tempfile.TemporaryDirectory(prefix="darkroot-") as folder:
        local = Path(folder) / (os.path.basename(path) or "output")
        result = make(local)
        unfinished = f"{path}.{uuid.uuid4().hex}.part"
        try:
            filesystem.makedirs(filesystem._parent(path), exist_ok=True)
            filesystem.put_file(str(local), unfinished)
            filesystem.mv(unfinished, path)
        except FAULTS as fault:
            if filesystem.exists(unfinished):
                filesystem.rm_file(unfinished)
            raise StorageError(f"{url}: cannot be written: {fault}") from fault
    return result
