"""Develops a folder on a Ray cluster: `python ray_folder.py IN OUT`.

Without a cluster (`RAY_ADDRESS`) Ray starts one on this machine. Workers that die are replaced, and their files done again.
"""

import sys

import engine
import ray
import ray.data


def develop_folder(folder, out, **settings):
    """Develops every raw file below `folder`; gives a row for each: src, dst, error, seconds, worker."""
    rows = list(engine.rows(folder, out))
    if not rows:
        return []
    # Blocks so small that what a dead worker had done is soon done again, and so large that Ray's own work is little.
    blocks = max(1, min(len(rows), max(len(rows) // 50, 4 * int(ray.cluster_resources().get("CPU", 1)))))
    files = ray.data.from_items(rows, override_num_blocks=blocks)
    return files.map(engine.develop, fn_kwargs=settings).take_all()


if __name__ == "__main__":
    ray.init()
    done = develop_folder(*sys.argv[1:3])
    failed = [row["error"] for row in done if row["error"]]
    print(f"{len(done) - len(failed)} developed, {len(failed)} failed", *failed, sep="\n")
