"""Develops a folder on Dask: `python dask_folder.py IN OUT [SCHEDULER]`; and a folder as one lazy array.

Without a scheduler's address Dask starts a cluster on this machine.
"""

import sys

import dask
import dask.array
import dask.bag
import engine
from dask.distributed import Client

import darkroot


def develop_folder(client, folder, out, **settings):
    """Develops every raw file below `folder`; gives a row for each: src, dst, error, seconds, worker."""
    rows = list(engine.rows(folder, out))
    if not rows:
        return []
    # As many parts as let a dead worker's work be done again soon.
    workers = sum(client.nthreads().values())
    parts = min(len(rows), max(len(rows) // 50, 4 * workers))
    bag = dask.bag.from_sequence(rows, npartitions=parts).map(engine.develop, **settings)
    return client.compute(bag, sync=True)


def frames(paths, **arguments):
    """A folder's pictures as one lazy array: files x height x width x 3. All must have the size of the first.

    `arguments` are those of `darkroot.develop`. Nothing is developed but the first, at 1 x 1, until values are asked for.
    """
    paths = [str(path) for path in paths]
    with darkroot.open(paths[0]) as photo:
        told = photo.explain(**{k: v for k, v in arguments.items() if k not in ("dtype", "scale")})
        dtype = photo.develop(region=(0, 0, 1, 1), **arguments).dtype
    scale = arguments.get("scale", 1)
    shape = (-int(-told["height"] * scale // 1), -int(-told["width"] * scale // 1), 3)
    one = dask.delayed(darkroot.develop, pure=True)
    arrays = [dask.array.from_delayed(one(path, **arguments), shape, dtype) for path in paths]
    return dask.array.stack(arrays)


if __name__ == "__main__":
    with Client(*sys.argv[3:4], threads_per_worker=1) as client:
        done = develop_folder(client, *sys.argv[1:3])
    failed = [row["error"] for row in done if row["error"]]
    print(f"{len(done) - len(failed)} developed, {len(failed)} failed", *failed, sep="\n")
