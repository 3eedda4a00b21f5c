"""Hostile files come through bytes and become one sentence."""

import os
import pathlib
import random

import pytest

import darkroot


def refused_or_sound(data):
    try:
        with darkroot.open(data) as photo:
            photo.develop(scale=1 / 8)
    except darkroot.Error as error:
        assert "\n" not in str(error) and len(str(error)) < 2000, error
        assert type(error) is not darkroot.Error, error
        return str(error)
    return None


def test_files_cut_off_anywhere_are_refused(nef, dng):
    for path in (nef, dng):
        data = path.read_bytes()
        told = [refused_or_sound(data[:cut]) for cut in (0, 1, 8, 100, 1000, len(data) // 2, len(data) - 1000)]
        assert all(told), told


def test_files_with_other_bytes_never_crash(nef, dng):
    numbers = random.Random(17)
    for path in (nef, dng):
        for _ in range(60):
            data = bytearray(path.read_bytes())
            for _ in range(numbers.choice((1, 5, 50))):
                data[numbers.randrange(numbers.choice((4000, len(data))))] = numbers.randrange(256)
            refused_or_sound(bytes(data))


def test_broken_files_of_the_collection_are_one_sentence_each():
    folder = os.environ.get("DARKROOT_DATA")
    if not folder:
        pytest.skip("DARKROOT_DATA names no folder of test files")
    files = [path for path in sorted(pathlib.Path(folder, "broken").rglob("*")) if path.is_file()]
    files = [path for path in files if path.suffix.lower() not in (".md", ".tsv", ".py", ".txt")]
    assert len(files) > 20
    refused = sum(refused_or_sound(path.read_bytes()) is not None for path in files)
    assert refused > len(files) // 2


def test_hostile_names_are_shown_and_not_obeyed(tmp_path, nef):
    path = tmp_path / "a\n\x1b[31mred.nef"
    path.write_bytes(b"MM\0*")
    with pytest.raises(darkroot.FileError) as raised:
        darkroot.open(path)
    assert "\x1b" not in str(raised.value) and "\n" not in str(raised.value)
    odd = os.fsdecode(b"\xff\xfe.nef")
    (tmp_path / odd).write_bytes(nef.read_bytes())
    assert darkroot.develop(tmp_path / odd, scale=1 / 8).shape[2] == 3
