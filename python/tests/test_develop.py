"""Arrays out: what they are, and that they are the program's own pictures."""

import subprocess

import numpy
import pytest

import darkroot
from darkroot import _program


@pytest.mark.parametrize(("dtype", "white"), [("uint8", 255), (numpy.uint16, 65535), (numpy.dtype("float32"), 1.0)])
def test_each_type_holds_the_same_picture(nef, dtype, white):
    photo = darkroot.open(nef)
    picture = photo.develop(dtype=dtype)
    assert picture.dtype == numpy.dtype(dtype) and picture.flags.writeable and picture.flags.c_contiguous
    fine = photo.develop(dtype="float32")
    assert numpy.abs(picture / white - fine).max() < 0.51 / min(white, 255) + 1e-6


def test_a_region_is_that_part_of_the_whole_bit_for_bit(nef):
    photo = darkroot.open(nef)
    whole = photo.develop(dtype="uint16")
    assert numpy.array_equal(photo.develop(dtype="uint16", region=(37, 21, 90, 60)), whole[21:81, 37:127])
    quarter = photo.develop(scale=1 / 4)
    assert quarter.shape[:2] == tuple(-(-side // 4) for side in whole.shape[:2])


def test_a_view_that_is_developed_again_is_what_it_is_alone(nef):
    # Exposure and look begin from what is kept of the view; balance, scale and region do not.
    photo = darkroot.open(nef)
    asked = [
        {},
        {"exposure": 0.7},
        {"exposure": 0.7, "look": "vivid", "space": "display-p3"},
        {"exposure": 0.7, "white_balance": "daylight"},
        {"exposure": -1, "white_balance": "daylight"},
        {"exposure": -1, "scale": 1 / 2},
        {"saturation": 1.2, "scale": 1 / 2},
        {"saturation": 1.2, "region": (10, 20, 50, 40)},
        {"contrast": 0.2, "region": (11, 20, 50, 40)},
    ]
    for one in asked:
        again = photo.develop(dtype="uint16", **one)
        with darkroot.open(nef) as alone:
            assert numpy.array_equal(again, alone.develop(dtype="uint16", **one)), one


def test_the_linear_look_is_proportional_to_light(nef):
    photo = darkroot.open(nef)
    one = photo.develop(look="linear", highlights="keep")
    two = photo.develop(look="linear", highlights="keep", exposure=1)
    assert numpy.allclose(two, 2 * one, rtol=1e-5, atol=1e-6)


def test_the_number_of_threads_changes_nothing(nef):
    photo = darkroot.open(nef)
    assert numpy.array_equal(photo.develop(threads=1), photo.develop(threads=4))


def test_a_file_is_the_programs_own(nef, tmp_path):
    program = _program.find()
    if program is None:
        pytest.skip("the program is not installed beside this Python")
    for name, options, settings in [
        ("a.tif", ["--look", "vivid", "--exposure", "0.5"], {"look": "vivid", "exposure": 0.5}),
        ("b.jpg", ["--white-balance", "5200K"], {"white_balance": "5200K"}),
    ]:
        darkroot.develop_file(nef, tmp_path / f"ours-{name}", **settings)
        subprocess.run([program, "-q", "develop", nef, "-o", tmp_path / name, *options], check=True)
        assert (tmp_path / name).read_bytes() == (tmp_path / f"ours-{name}").read_bytes()


def test_an_array_is_what_a_file_holds(nef, tmp_path):
    image = pytest.importorskip("PIL.Image")
    darkroot.develop_file(nef, tmp_path / "a.png", bits=8)
    assert numpy.array_equal(numpy.asarray(image.open(tmp_path / "a.png")), darkroot.develop(nef))


def test_an_output_that_exists_is_kept(nef, tmp_path):
    out = tmp_path / "a.jpg"
    out.write_text("mine")
    with pytest.raises(darkroot.ExistsError, match="exists already"):
        darkroot.develop_file(nef, out)
    assert out.read_text() == "mine"
    darkroot.develop_file(nef, out, overwrite=True)
    assert out.read_bytes().startswith(b"\xff\xd8")


def test_where_nothing_can_be_written_the_system_is_to_blame(nef, tmp_path):
    with pytest.raises(darkroot.StorageError, match="its folder does not exist"):
        darkroot.develop_file(nef, tmp_path / "no/such/a.jpg")


def test_folders_count_only_where_they_are_asked_for(nef, tmp_path):
    (tmp_path / "a.nef").write_bytes(nef.read_bytes())
    (tmp_path / "darkroot.toml").write_text('resize = "long:50"\n')
    plain = darkroot.develop_file(tmp_path / "a.nef", tmp_path / "a.jpg")
    small = darkroot.develop_file(tmp_path / "a.nef", tmp_path / "b.jpg", folders=True)
    assert small["width"] == 50 and plain["width"] > 500


def test_a_dash_is_a_name_like_any_other(nef, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(darkroot.MissingError, match="no such file"):
        darkroot.open("-")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"scale": 0.3}, "`scale` cannot be 0.3"),
        ({"region": (0, 0, 5000, 5000)}, "does not lie in the picture"),
        ({"region": (0, 0, 0, 10)}, "does not lie in the picture"),
        ({"dtype": "int8"}, "`dtype` cannot be int8"),
        ({"dtype": "uint8", "bits": 16}, "leave one out"),
        ({"threads": 0}, "`threads` cannot be 0"),
        ({"exposure": 99}, "-20 to 20"),
        ({"clarity": 1}, "`clarity` is no setting"),
        ({"look": "linear", "dtype": "uint8"}, "8 bits are too coarse"),
        ({"look": "linear", "contrast": 0.2}, "no room for contrast"),
        ({"decoder": "rawloader"}, "`decoder` counts when a file is read"),
        ({"exposure_from_chart": "auto"}, "develop_file"),
        ({"engine": "imagepipe"}, "develop_file"),
        ({"profile": "no camera"}, "neither a profile file nor a camera"),
    ],
)
def test_what_cannot_be_asked_for_is_refused_in_words(nef, arguments, words):
    with pytest.raises((darkroot.SettingsError, darkroot.ProfileError), match=words):
        darkroot.open(nef).develop(**arguments)
