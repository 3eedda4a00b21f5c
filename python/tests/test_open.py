"""Photographs in memory: what they show without a copy, and what becomes of it."""

import gc
import io
import os
import pathlib
import pickle

import numpy
import pytest

import darkroot


def test_a_path_bytes_and_a_file_are_one_photograph(nef):
    data = nef.read_bytes()
    pictures = [darkroot.open(source).mosaic for source in (nef, str(nef), data, bytearray(data), io.BytesIO(data))]
    assert all(numpy.array_equal(picture, pictures[0]) for picture in pictures)
    assert darkroot.open(data).name == pathlib.Path("the bytes")


def test_the_mosaic_is_what_the_program_decodes(nef, dng):
    for path in (nef, dng):
        photo, facts = darkroot.open(path), darkroot.inspect(path)
        assert photo.mosaic.shape == tuple(reversed(facts["frame"]))
        assert photo.mosaic.mean() == pytest.approx(facts["samples_mean"])
        assert photo.black.ravel().tolist() == facts["black"]
        assert photo.white.tolist() == facts["white"]
        assert photo.cfa == facts["filters"] and photo.camera == facts["camera"]
        assert photo.metadata == facts["shot"]


def test_views_are_read_only_share_memory_and_outlive_their_photo(nef):
    photo = darkroot.open(nef)
    mosaic, active = photo.mosaic, photo.active
    assert numpy.shares_memory(mosaic, active) and numpy.shares_memory(mosaic, photo.mosaic)
    with pytest.raises(ValueError):
        mosaic[0, 0] = 1
    with pytest.raises(ValueError):
        mosaic.flags.writeable = True
    before = mosaic.copy()
    photo.close()
    del photo
    gc.collect()
    for _ in range(20):
        darkroot.open(nef).develop(scale=1 / 8)
    assert numpy.array_equal(mosaic, before) and active.sum() > 0


def test_a_closed_photo_says_so(nef):
    with darkroot.open(nef) as photo:
        pass
    with pytest.raises(darkroot.SettingsError, match="the photo is closed; open the file again"):
        photo.develop()


def test_the_preview_is_the_jpeg_that_the_camera_embedded(nef):
    assert darkroot.open(nef).preview() is None
    folder = os.environ.get("DARKROOT_DATA")
    if not folder:
        pytest.skip("DARKROOT_DATA names no folder of test files, and the samples have no preview")
    path = pathlib.Path(folder, "raw/canon_30d.cr2")
    for source in (path, path.read_bytes()):
        jpeg = darkroot.open(source).preview()
        assert jpeg.startswith(b"\xff\xd8") and jpeg in path.read_bytes()


def test_a_photo_stays_in_its_process(nef):
    with pytest.raises(TypeError, match="send its path or its bytes"):
        pickle.dumps(darkroot.open(nef))


def test_light_is_the_mosaic_less_black_over_white(dng):
    photo = darkroot.open(dng)
    light = photo.light()
    black, white = float(photo.black.mean()), float(photo.white[0])
    expected = (photo.mosaic.astype(float) - black) / (white - black)
    x, y, width, height = photo.active_area
    inside = numpy.s_[y : y + height, x : x + width]
    assert numpy.abs(light[inside] - expected[inside]).max() < 1e-3


@pytest.mark.parametrize(
    ("source", "error", "words"),
    [
        ("nothing.nef", darkroot.MissingError, "there is no such file"),
        (b"", darkroot.FileError, "is not a raw photograph"),
        (b"MM\0*", darkroot.FileError, "the bytes: "),
        (".", darkroot.StorageError, "it is a folder"),
        (7, darkroot.SettingsError, "int is nothing to open"),
        (io.StringIO("text"), darkroot.SettingsError, "binary mode"),
    ],
)
def test_what_cannot_be_opened_says_whose_fault_it_is(source, error, words):
    with pytest.raises(error, match=words):
        darkroot.open(source)


def test_a_missing_file_is_what_python_calls_one():
    with pytest.raises(FileNotFoundError):
        darkroot.open("nothing.nef")


def test_an_unknown_decoder_is_refused(nef):
    with pytest.raises(darkroot.SettingsError, match="flashraw"):
        darkroot.open(nef, decoder="libraw")
