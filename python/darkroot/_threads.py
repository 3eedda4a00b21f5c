"""How many threads a call takes where nobody says it."""

import os
import sys

from ._errors import SettingsError


def usual():
    """Threads of one call: ``DARKROOT_THREADS`` if set, one inside a worker of Ray or Dask, else ``None`` (all cores).

    An engine runs one task for each core already; more threads would only stand in each other's way.
    """
    said = os.environ.get("DARKROOT_THREADS")
    if said is not None:
        return checked(said)
    return 1 if _in_ray() or _in_dask() else None


def checked(threads):
    """A number of threads, or ``None`` for the usual one."""
    if threads is None:
        return usual()
    try:
        number = int(threads)
    except (TypeError, ValueError):
        number = 0
    if number < 1:
        raise SettingsError(f"`threads` cannot be {threads!r}; it is a whole number from 1 on")
    return min(number, 4 * (os.cpu_count() or 1))


def _in_ray():
    ray = sys.modules.get("ray")
    worker = getattr(getattr(ray, "_private", None), "worker", None)
    mode = getattr(getattr(worker, "global_worker", None), "mode", None)
    return mode is not None and mode == getattr(worker, "WORKER_MODE", object())


def _in_dask():
    worker = sys.modules.get("distributed.worker")
    if worker is None:
        return False
    try:
        worker.get_worker()
    except ValueError:
        return False
    return True
