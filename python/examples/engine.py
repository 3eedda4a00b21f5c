"""What every engine runs: one raw file to one picture, once or again.

An engine may run a task twice: when a machine dies, or seems to. That does no harm here. An output gets its name when it is
complete, and developing the same file with the same settings gives the same bits, so a second task replaces a picture by itself.
A file that cannot be developed is a row that says why; only what another try may mend (a disk, a network) is raised.
"""

import os
import pathlib

import darkroot


def rows(folder, out, ending="jpg"):
    """The raw files of a folder and of those in it, each with the place of its picture, as ``darkroot batch`` names them."""
    folder, taken = pathlib.Path(folder), {}
    for path in sorted(folder.rglob("*")):
        if path.suffix[1:].lower() in darkroot.ENDINGS and not path.name.startswith("."):
            place = str(pathlib.Path(out) / path.relative_to(folder).with_suffix(f".{ending}"))
            if place in taken:
                raise ValueError(
                    f"{taken[place]} and {path} would both become {place}; put them into folders of their own"
                )
            taken[place] = path
            yield {"src": str(path), "dst": place}


def develop(row, **settings):
    """Develops one row and says what came of it. Threads: one, as in every task of an engine."""
    if "://" not in row["dst"]:
        os.makedirs(os.path.dirname(row["dst"]), exist_ok=True)
    try:
        report = darkroot.develop_file(row["src"], row["dst"], overwrite=True, **settings)
    except darkroot.StorageError:
        raise
    except darkroot.Error as error:
        return {**row, "error": str(error), "seconds": 0.0, "worker": os.getpid()}
    return {**row, "error": "", "seconds": report["seconds"], "worker": os.getpid()}
