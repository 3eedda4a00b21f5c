"""Many files, one array after the other."""

import collections
import concurrent.futures
import dataclasses
import os

import numpy

from . import _core, _threads
from ._develop import develop
from ._errors import Error


@dataclasses.dataclass(frozen=True)
class Developed:
    """One file of :func:`develop_many`: a picture, or the reason why there is none."""

    #: The file as it was given.
    path: object
    #: The picture, or ``None``.
    picture: numpy.ndarray | None
    #: What went wrong, or ``None``.
    error: Error | None

    def get(self):
        """The picture; raises the error where there is one."""
        if self.error is not None:
            raise self.error
        return self.picture


def develop_many(paths, *, workers=None, threads=1, **arguments):
    """Develops files one after the other, several at once; an iterator of :class:`Developed` in the order of ``paths``.

    A file that fails is an error as a value, and the others go on. No more than twice ``workers`` pictures are ahead of whoever
    takes them, so that memory is bounded; ``paths`` may be endless. Leaving the loop, or Ctrl-C, ends what is in flight.

    Parameters
    ----------
    workers : files at once; one for each core if not given.
    threads : threads of one file.
    arguments : those of :func:`develop`.

    >>> for one in darkroot.develop_many([sample, "nothing.nef"], scale=1/8):
    ...     print(one.picture.shape if one.error is None else type(one.error).__name__)
    (60, 90, 3)
    MissingError
    """
    workers = _threads.checked(workers) or os.cpu_count() or 1
    return _developed(iter(paths), workers, dict(arguments, threads=threads))


def _developed(paths, workers, arguments):
    cancel = arguments.pop("cancel", None) or _core.Cancel()
    pool = concurrent.futures.ThreadPoolExecutor(workers, thread_name_prefix="darkroot")
    waiting = collections.deque()
    try:
        for path in paths:
            waiting.append(pool.submit(_one, path, dict(arguments, cancel=cancel)))
            if len(waiting) > 2 * workers:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()
    finally:
        cancel.cancel()
        pool.shutdown(wait=False, cancel_futures=True)


def _one(path, arguments):
    try:
        return Developed(path, develop(path, **arguments), None)
    except Error as error:
        return Developed(path, None, error)
