"""Refuses to be imported where it cannot work: inside of a sub-interpreter."""

import importlib


def _number():
    """Number of this interpreter; the main one has 0."""
    for name in ("_interpreters", "_xxsubinterpreters"):
        try:
            current = importlib.import_module(name).get_current()
        except ImportError:
            continue
        # Later versions of Python say whose it is, too.
        return int(current[0] if isinstance(current, tuple) else current)
    return 0


if _number() != 0:
    raise ImportError(
        "darkroot works in the main interpreter only, as numpy does; use threads, which run at the same time here "
        "(the lock of Python is free while files are developed), or processes"
    )
