"""Folders to folders."""

import dataclasses
import os

from . import _core, _html, _program, _threads
from ._errors import SettingsError


@dataclasses.dataclass(frozen=True)
class Summary:
    """How a batch came out."""

    #: Files developed, failed, done and unchanged before, and left because it was stopped.
    done: int
    failed: int
    skipped: int
    left: int
    #: The events of files that failed: dictionaries with ``input``, ``output`` and ``error``.
    failures: list
    #: What could not be read while files were looked for, in words.
    faults: list
    #: Why it was stopped before the end, in words, or ``None``.
    stopped: str | None
    #: Whether a person or the system wanted it to stop.
    interrupted: bool
    #: Pixels developed, seconds of the run, most memory that one worker held (bytes).
    pixels: int
    seconds: float
    peak_memory: int

    def _repr_html_(self):
        rows = [(name, getattr(self, name)) for name in ("done", "failed", "skipped", "left", "stopped")]
        rows += [("seconds", f"{self.seconds:.1f}")]
        rows += [("error", failure["error"]) for failure in self.failures[:20]]
        return _html.table(rows)


def batch(
    inputs,
    out,
    *,
    on_event=None,
    recipe=None,
    folders=True,
    name=None,
    on_collision="refuse",
    overwrite=False,
    redo=False,
    verify=False,
    recursive=True,
    include=(),
    exclude=(),
    shard=None,
    workers="processes",
    jobs=None,
    threads=None,
    memory=None,
    timeout=600,
    **settings,
):
    """Develops folders of raw files into a folder of pictures, as ``darkroot batch IN -o OUT`` does, bit for bit.

    The plan is made first: collisions and wrong settings raise before anything is written. A journal in ``out`` says what was
    done, so that the same call again does only what is left, whatever ended the one before.

    Parameters
    ----------
    inputs : a folder, a file, a pattern ("shoot/**/*.NEF"), or a list of them.
    on_event : is called with a dictionary for each event: ``event`` is "begun", "done", "failed", "later", "gone" or "stopping", with
        ``input``, ``output``, and for "done" sizes, seconds and notes. What it raises stops the batch and comes out of this call.
    folders : take what ``darkroot.toml`` in the folders and sidecars say, as the program does.
    name : template of names below ``out`` ("{folder}/{stem}.{ext}").
    on_collision : "refuse" or "suffix".
    shard : "i/n", the i-th of n parts; "auto" inside a Slurm array or a Kubernetes Indexed Job.
    workers : "processes" starts the program that came with this package, one process for each file in its sandbox: what a
        file does to its decoder costs that file alone. "threads" needs no program; a file that stalls cannot be ended then.
    jobs, threads : files at once, and threads in all; one for each core if not given.
    memory : bytes of all workers together; half of what is free if not given.
    timeout : longest time for one file, seconds ("processes" only).
    settings : those of :meth:`Photo.develop`, and those of files ("format", "quality" ...).

    Returns a :class:`Summary`; files that fail are counted there and do not raise.
    """
    if workers not in ("processes", "threads"):
        raise SettingsError(f"`workers` cannot be {workers!r}; it is processes or threads")
    program = _program.find() if workers == "processes" else None
    if workers == "processes" and program is None:
        raise SettingsError(
            "the program darkroot of this version is not installed; install the package by its wheel, which brings it, "
            "or take workers='threads'"
        )
    one = isinstance(inputs, (str, os.PathLike))
    said = {
        "inputs": [os.fspath(path) for path in ([inputs] if one else inputs)],
        "out": os.fspath(out),
        "name": name,
        "on_collision": on_collision,
        "overwrite": overwrite,
        "redo": redo,
        "verify": verify,
        "recursive": recursive,
        "include": [include] if isinstance(include, str) else list(include),
        "exclude": [exclude] if isinstance(exclude, str) else list(exclude),
        "shard": shard,
        "program": program,
        "jobs": _threads.checked(jobs) if jobs is not None else None,
        "threads": _threads.checked(threads),
        "memory": memory,
        "timeout": float(timeout),
        "folders": folders,
    }
    return Summary(**_core.batch(said, on_event, recipe, settings))
