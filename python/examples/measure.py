"""Figures of docs/cluster.md: `python measure.py MAKE_RAW [--files 1000] [--engines batch,ray,dask]`.

Makes small raw files, develops them by `darkroot batch` and by each engine with one worker and with two, then once more while a
worker is killed in the middle, and compares every output with the batch's. MAKE_RAW is the example of that name
(`cargo build --release -p darkroot-simulate --example make_raw`).
"""

import argparse
import hashlib
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import threading
import time

import engine

import darkroot

#: The file's own matrix: what is measured is the engine, not the estimate of a camera.
SETTINGS = {"profile": "matrix"}


def make(program, folder, count):
    """So many files of eight kinds."""
    folder.mkdir()
    for number in range(count):
        kind = folder / f"{number % 8}.dng"
        if number < 8:
            size = ["--format", "dng", "--width", "240", "--height", "160", "--stops", str(-number / 4)]
            subprocess.run([program, *size, "--out", kind], check=True, capture_output=True)
        else:
            shutil.copy(kind, folder / f"{number}.dng")


def outputs(out):
    """Hash of each picture by its name, and nothing else that may lie there."""
    files = [path for path in out.rglob("*") if path.is_file() and ".darkroot" not in path.parts]
    return {str(path.relative_to(out)): hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


def kill_one(workers, stop):
    """Kills a worker process when a fifth of the files is there."""

    def watch(out, share):
        while not stop.is_set():
            if out.exists() and len(list(out.iterdir())) > share:
                victim = workers()
                if victim:
                    os.kill(victim, signal.SIGKILL)
                    return print(f"    killed worker {victim}")
            time.sleep(0.02)

    return watch


def named(prefix):
    """The process of a worker of Ray that is at work, by the beginning of its title."""
    for entry in pathlib.Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                words = (entry / "cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace")
            except OSError:
                continue
            if words.startswith(prefix):
                return int(entry.name)
    return None


def by_ray(folder, out, workers, kill):
    """Seconds, by Ray with so many workers; its start is not among them."""
    import ray
    import ray_folder

    ray.init(num_cpus=workers, include_dashboard=False, log_to_driver=False, logging_level="error")
    try:
        warm(lambda: ray_folder.develop_folder(folder / "warm", out.parent / "warm", **SETTINGS))
        return timed(
            lambda: ray_folder.develop_folder(folder / "in", out, **SETTINGS), out, kill, lambda: named("ray::Map")
        )
    finally:
        ray.shutdown()


def by_dask(folder, out, workers, kill):
    """Seconds, by Dask with so many worker processes; their start is not among them."""
    import dask_folder
    from dask.distributed import Client

    with Client(n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None) as client:
        pids = list(client.run(os.getpid).values())
        warm(lambda: dask_folder.develop_folder(client, folder / "warm", out.parent / "warm", **SETTINGS))
        return timed(
            lambda: dask_folder.develop_folder(client, folder / "in", out, **SETTINGS), out, kill, lambda: pids[0]
        )


def warm(work):
    """Starts the workers and their imports."""
    work()


def timed(work, out, kill, victim):
    """Seconds of a run, and seconds that were spent in developing; a worker is killed meanwhile if that is asked for."""
    stop = threading.Event()
    if kill:
        threading.Thread(target=kill_one(victim, stop), args=(out, kill), daemon=True).start()
    begin = time.monotonic()
    rows = work()
    seconds = time.monotonic() - begin
    stop.set()
    assert not any(row["error"] for row in rows), [row["error"] for row in rows if row["error"]][:3]
    return seconds, sum(row["seconds"] for row in rows)


def main():
    """Prints a line for each run."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("make_raw")
    parser.add_argument("--files", type=int, default=1000)
    parser.add_argument("--engines", default="ray,dask")
    said = parser.parse_args()
    engines = {"ray": by_ray, "dask": by_dask}
    os.environ["PYTHONPATH"] = str(pathlib.Path(__file__).parent)
    # A machine that is busy with the work itself is no dead one.
    os.environ.update(RAY_health_check_timeout_ms="60000", RAY_health_check_failure_threshold="20")
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        make(said.make_raw, folder / "in", said.files)
        make(said.make_raw, folder / "warm", 8)
        begin = time.monotonic()
        rows = [engine.develop(row, threads=1, **SETTINGS) for row in engine.rows(folder / "in", folder / "alone")]
        alone = time.monotonic() - begin
        inside = 1000 * sum(row["seconds"] for row in rows) / len(rows)
        beside = 1000 * alone / len(rows) - inside
        print(
            f"file after file: {alone:.1f} s, {inside:.1f} ms a file in developing, {beside:.1f} ms beside it",
            flush=True,
        )
        for jobs in (1, 2):
            summary = darkroot.batch(folder / "in", folder / f"batch{jobs}", jobs=jobs, threads=jobs, **SETTINGS)
            assert (summary.done, summary.failed) == (said.files, 0), summary
            each = 1000 * jobs * summary.seconds / said.files
            print(f"batch, {jobs} at once: {summary.seconds:.1f} s, {each:.1f} ms a file and worker", flush=True)
        expected = outputs(folder / "batch2")
        assert len(expected) == said.files and outputs(folder / "alone") == expected
        for name in said.engines.split(","):
            for workers, kill in [(1, 0), (2, 0), (2, said.files // 5)]:
                out = folder / f"{name}{workers}{bool(kill)}"
                seconds, inside = engines[name](folder, out, workers, kill)
                same = outputs(out) == expected
                words = ", one killed in the middle" if kill else ""
                over = 1000 * (workers * seconds - inside) / said.files
                print(
                    f"{name}, workers: {workers}{words}: {seconds:.1f} s, of each worker {1000 * inside / said.files:.1f} ms "
                    f"a file in developing, {over:.1f} ms beside it",
                    flush=True,
                )
                assert same, "outputs are missing, or are not those of the batch"


if __name__ == "__main__":
    main()
