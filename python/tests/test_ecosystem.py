"""Libraries that people use beside this one."""

import numpy
import pytest

import darkroot


def test_imageio_reads_raw_files(nef):
    iio = pytest.importorskip("imageio.v3")
    import darkroot.imageio

    darkroot.imageio.register()
    darkroot.imageio.register()
    expected = darkroot.develop(nef)
    assert numpy.array_equal(iio.imread(nef), expected)
    assert numpy.array_equal(iio.imread(nef.read_bytes(), plugin="darkroot"), expected)
    assert iio.improps(nef, look="linear").dtype == numpy.float32
    assert iio.improps(nef).shape == expected.shape
    assert iio.immeta(nef)["camera"] == "Nikon D750"
    import imageio.v2

    assert numpy.array_equal(imageio.v2.imread(nef), expected)
    with pytest.raises(OSError):
        iio.imread(b"nothing", extension=".nef")


def test_pillow_takes_pictures(nef):
    image = pytest.importorskip("PIL.Image")
    picture = darkroot.develop(nef, scale=1 / 4)
    assert image.fromarray(picture).size == picture.shape[1::-1]


def test_scikit_image_takes_pictures(nef):
    colour = pytest.importorskip("skimage.color")
    filters = pytest.importorskip("skimage.filters")
    picture = darkroot.develop(nef, dtype="float32", scale=1 / 4)
    assert colour.rgb2lab(picture).shape == picture.shape
    assert 0 < filters.threshold_otsu(darkroot.open(nef).active) < 16384


def test_xarray_gets_names_and_facts(nef):
    xarray = pytest.importorskip("xarray")
    found = darkroot.open(nef).to_xarray(look="linear", scale=1 / 4)
    assert isinstance(found, xarray.DataArray) and found.dims == ("y", "x", "channel")
    assert found.sel(channel="G").mean() > 0 and found.attrs["camera"] == "Nikon D750"
    assert "linear" in found.attrs["space"]


def test_colour_science_takes_profiles(nef):
    """A profile stands where a function of colours is wanted, and its XYZ are those of that library."""
    colour = pytest.importorskip("colour")
    profile = darkroot.Profile.load("Nikon D700")
    methods = colour.characterisation.APPLY_MATRIX_COLOUR_CORRECTION_METHODS
    methods["Darkroot"] = lambda rgb, profile, **_: profile(rgb, "D50")
    rgb = numpy.random.default_rng(2).uniform(0.05, 0.9, (20, 3))
    xyz = colour.characterisation.apply_matrix_colour_correction(rgb, profile, method="Darkroot")
    white = colour.CCS_ILLUMINANTS["CIE 1931 2 Degree Standard Observer"]["D50"]
    lab = colour.XYZ_to_Lab(xyz, white)
    assert lab.shape == (20, 3) and colour.delta_E(lab, lab).max() == 0
    del methods["Darkroot"]


def test_notebooks_show_things(nef):
    photo = darkroot.open(nef)
    assert "data:image/png;base64," in photo._repr_html_() and "Nikon D750" in photo._repr_html_()
    image = pytest.importorskip("PIL.Image")
    import base64
    import io
    import re

    shown = re.search(r"base64,([^\"]+)", photo._repr_html_())[1]
    assert image.open(io.BytesIO(base64.b64decode(shown))).size[0] <= 480
    assert "<h4>D65</h4>" in darkroot.Profile.load("Nikon D700")._repr_html_()
    assert "<script" not in darkroot.fit_profile(*_colours(), camera="<script>alert(1)</script> x")._repr_html_()


def _colours():
    from test_profile import colours

    return colours()
