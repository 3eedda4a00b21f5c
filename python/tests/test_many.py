"""Many files: one after the other, and folders."""

import threading
import time

import numpy
import pytest

import darkroot


def test_pictures_come_in_the_order_of_the_files_and_errors_are_values(copies, nef):
    paths = sorted(copies(6).iterdir())
    paths.insert(3, "nothing.nef")
    found = list(darkroot.develop_many(paths, scale=1 / 8, workers=3))
    assert [one.path for one in found] == paths
    expected = darkroot.develop(nef, scale=1 / 8)
    for number, one in enumerate(found):
        if number == 3:
            assert isinstance(one.error, darkroot.MissingError) and one.picture is None
            with pytest.raises(FileNotFoundError):
                one.get()
        else:
            assert numpy.array_equal(one.get(), expected)


def test_files_are_not_read_far_ahead(nef):
    asked = []

    def endless():
        while True:
            asked.append(nef)
            yield nef

    for number, one in enumerate(darkroot.develop_many(endless(), scale=1 / 64, workers=2)):
        assert one.error is None and len(asked) <= number + 6
        if number == 10:
            break


def test_another_thread_can_cancel(raw):
    path = raw("--format", "nef", "--width", "3000", "--height", "2000", name="large.nef")
    cancel = darkroot.Cancel()
    threading.Timer(0.3, cancel.cancel).start()
    begin = time.monotonic()
    with pytest.raises(darkroot.Cancelled):
        while True:
            darkroot.develop(path, denoise="1", sharpen="1", cancel=cancel)
    assert time.monotonic() - begin < 10 and cancel.cancelled


@pytest.mark.parametrize("workers", ["processes", "threads"])
def test_a_batch_makes_what_developing_each_file_makes(copies, nef, tmp_path, workers):
    if workers == "processes" and darkroot._program.find() is None:
        pytest.skip("the program is not installed beside this Python")
    folder, out, events = copies(3), tmp_path / "out", []
    (folder / "broken.nef").write_bytes(nef.read_bytes()[:20000])
    import os

    os.utime(folder / "broken.nef", (1e9, 1e9))
    summary = darkroot.batch(folder, out, on_event=events.append, workers=workers, look="vivid", format="png", jobs=2)
    assert (summary.done, summary.failed, summary.left) == (3, 1, 0), summary
    assert "broken.nef" in summary.failures[0]["error"]
    assert sorted(event["event"] for event in events) == ["begun"] * 4 + ["done"] * 3 + ["failed"]
    darkroot.develop_file(nef, tmp_path / "alone.png", look="vivid")
    assert {(out / f"{n:04}.png").read_bytes() for n in range(3)} == {(tmp_path / "alone.png").read_bytes()}
    again = darkroot.batch(folder, out, workers=workers, look="vivid", format="png")
    assert (again.done, again.skipped) == (0, 3)


def test_what_a_callback_raises_stops_the_batch(copies, tmp_path):
    def hear(event):
        raise KeyError(event["input"])

    with pytest.raises(KeyError, match="0000.nef"):
        darkroot.batch(copies(3), tmp_path / "out", on_event=hear, workers="threads", jobs=1)
    assert len(list((tmp_path / "out").glob("*.jpg"))) <= 2


@pytest.mark.parametrize(
    ("arguments", "error", "words"),
    [
        ({"inputs": "no/such"}, darkroot.MissingError, "no such file or folder"),
        ({"workers": "robots"}, darkroot.SettingsError, "processes or threads"),
        ({"on_collision": "shrug"}, darkroot.SettingsError, "refuse or suffix"),
        ({"exposure": 99}, darkroot.SettingsError, "-20 to 20"),
        ({"shard": "3/2"}, darkroot.SettingsError, "3/2"),
        ({"timeout": 0}, darkroot.SettingsError, "above 0"),
        ({"name": "{nothing}.jpg"}, darkroot.SettingsError, "placeholder"),
    ],
)
def test_batches_that_cannot_be_raise_before_anything_is_written(copies, tmp_path, arguments, error, words):
    given = {"inputs": copies(1), "workers": "threads", **arguments}
    with pytest.raises(error, match=words):
        darkroot.batch(given.pop("inputs"), tmp_path / "out", **given)
    assert not list(tmp_path.glob("out/*.jpg"))
