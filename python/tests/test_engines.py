"""The examples for engines run: a worker is killed in the middle, and every output is there, bit for bit the batch's."""

import os
import pathlib
import signal
import sys
import threading
import time

import conftest
import numpy
import pytest

import darkroot

EXAMPLES = conftest.ROOT / "python/examples"
FILES = 24
SETTINGS = {"profile": "matrix", "resize": "long:200"}


@pytest.fixture
def folder(copies, nef, tmp_path, monkeypatch):
    """A folder of raw files, one of which is broken."""
    monkeypatch.syspath_prepend(str(EXAMPLES))
    monkeypatch.setenv("PYTHONPATH", str(EXAMPLES))
    place = copies(FILES)
    (place / "sub").mkdir()
    (place / "sub/broken.nef").write_bytes(nef.read_bytes()[:30000])
    return place


def pictures(out):
    files = [path for path in out.rglob("*") if path.is_file() and ".darkroot" not in path.parts]
    return {str(path.relative_to(out)): path.read_bytes() for path in files}


def check(rows, folder, out, tmp_path):
    assert sorted(row["src"] for row in rows) == sorted(str(path) for path in folder.rglob("*.nef"))
    failed = [row for row in rows if row["error"]]
    assert len(failed) == 1 and "broken.nef" in failed[0]["error"]
    darkroot.batch(folder, tmp_path / "batch", workers="threads", jobs=2, **SETTINGS)
    assert pictures(out) == pictures(tmp_path / "batch") and len(pictures(out)) == FILES
    return len({row["worker"] for row in rows})


def killer(out, victim):
    """Kills a process as soon as some outputs are there."""

    def watch():
        until = time.monotonic() + 60
        while time.monotonic() < until:
            if out.exists() and len(list(out.glob("*.jpg"))) >= 3:
                os.kill(victim(), signal.SIGKILL)
                return
            time.sleep(0.005)

    thread = threading.Thread(target=watch, daemon=True)
    thread.start()
    return thread


def test_dask_develops_a_folder_though_a_worker_dies(folder, tmp_path):
    pytest.importorskip("distributed")
    import dask_folder
    from dask.distributed import Client

    with Client(n_workers=2, threads_per_worker=1, dashboard_address=None) as client:
        assert client.submit(darkroot._threads.usual).result() == 1
        victim = next(iter(client.run(os.getpid).values()))
        thread = killer(tmp_path / "out", lambda: victim)
        rows = dask_folder.develop_folder(client, folder, tmp_path / "out", **SETTINGS)
        thread.join(timeout=1)
        assert not thread.is_alive(), "no worker was killed"
    assert check(rows, folder, tmp_path / "out", tmp_path) >= 2


def test_a_folder_is_one_lazy_array(folder, nef):
    pytest.importorskip("dask.array")
    import dask_folder

    paths = sorted(folder.glob("*.nef"))
    lazy = dask_folder.frames(paths, scale=1 / 8, dtype="uint16")
    expected = darkroot.develop(nef, scale=1 / 8, dtype="uint16")
    assert lazy.shape == (FILES, *expected.shape) and lazy.dtype == numpy.uint16
    assert numpy.array_equal(lazy[5].compute(), expected)
    assert lazy[:3].mean(axis=(1, 2)).compute() == pytest.approx(numpy.stack([expected.mean(axis=(0, 1))] * 3))


def test_ray_develops_a_folder_though_a_worker_dies(folder, tmp_path, monkeypatch):
    ray = pytest.importorskip("ray")
    import measure
    import ray_folder

    # A machine that is busy with the work itself is no dead one.
    monkeypatch.setenv("RAY_health_check_timeout_ms", "60000")
    monkeypatch.setenv("RAY_health_check_failure_threshold", "20")
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False, logging_level="error")
    try:
        assert ray.get(ray.remote(darkroot._threads.usual).remote()) == 1
        thread = killer(tmp_path / "out", lambda: measure.named("ray::Map"))
        rows = ray_folder.develop_folder(folder, tmp_path / "out", **SETTINGS)
        thread.join(timeout=1)
        assert not thread.is_alive(), "no worker was killed"
    finally:
        ray.shutdown()
    check(rows, folder, tmp_path / "out", tmp_path)


def test_a_task_that_runs_twice_changes_nothing(folder, tmp_path):
    sys.modules.pop("engine", None)
    import engine

    row = next(engine.rows(folder, tmp_path / "out"))
    first = engine.develop(row, **SETTINGS)
    before = pathlib.Path(row["dst"]).read_bytes()
    second = engine.develop(row, **SETTINGS)
    assert pathlib.Path(row["dst"]).read_bytes() == before and first["error"] == second["error"] == ""


def test_two_files_never_become_one_picture(folder, nef):
    import engine

    (folder / "0000.dng").write_bytes(nef.read_bytes())
    with pytest.raises(ValueError, match="would both become"):
        list(engine.rows(folder, "out"))


def test_threads_follow_the_environment(monkeypatch):
    monkeypatch.setenv("DARKROOT_THREADS", "3")
    assert darkroot._threads.usual() == 3
    monkeypatch.setenv("DARKROOT_THREADS", "many")
    with pytest.raises(darkroot.SettingsError, match="`threads` cannot be 'many'"):
        darkroot._threads.usual()
    monkeypatch.delenv("DARKROOT_THREADS")
    assert darkroot._threads.usual() is None
