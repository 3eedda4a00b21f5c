"""Profiles: fitted to colours, kept in files, used on pictures and as functions."""

import pickle

import numpy
import pytest

import darkroot

D50 = numpy.array([0.9642, 1.0, 0.8251])


def colours(count=40, seed=3):
    """Camera RGB and XYZ of colours that a camera with crossed channels sees, greys among them."""
    rng = numpy.random.default_rng(seed)
    rgb = rng.uniform(0.05, 0.6, (count, 1)) * numpy.exp(rng.normal(0, 0.25, (count, 3)))
    rgb = numpy.vstack([rgb, numpy.outer([0.05, 0.2, 0.5, 0.9], [1, 1, 1])])
    matrix = numpy.array([[0.62, 0.22, 0.1242], [0.24, 0.7, 0.06], [0.01, 0.07, 0.7451]])
    xyz = rgb @ matrix.T + 0.05 * (numpy.sqrt(rgb[:, [0]] * rgb[:, [1]]) - rgb[:, :2].mean(axis=1, keepdims=True))
    return rgb, xyz


def test_a_fit_finds_what_made_the_colours():
    rgb, xyz = colours()
    for model, most in [("root-2", 0.3), (None, 0.6)]:
        profile = darkroot.fit_profile(rgb, xyz, model=model)
        assert profile.figures()["left_out"]["mean"] < most
    unseen_rgb, unseen = colours(seed=9)
    assert numpy.abs(darkroot.fit_profile(rgb, xyz, model="root-2")(unseen_rgb) - unseen).max() < 0.01


def test_exposure_is_nothing_to_a_profile():
    rgb, xyz = colours()
    profile = darkroot.fit_profile(rgb, xyz)
    assert numpy.allclose(profile(4 * rgb), 4 * profile(rgb))
    # Nor is the exposure of the shot that it was fitted to.
    assert numpy.allclose(darkroot.fit_profile(0.25 * rgb, xyz)(rgb), profile(rgb), atol=1e-5)


def test_arrays_of_every_shape_and_type_are_taken():
    profile = darkroot.Profile.load("Nikon D700")
    for shape in [(3,), (5, 3), (4, 6, 3), (2, 2, 2, 3)]:
        rgb = numpy.random.default_rng(0).uniform(0, 1, shape)
        xyz = profile(rgb, "D65")
        assert xyz.shape == shape and xyz.dtype == numpy.float64
        assert numpy.allclose(profile(rgb.astype("float32"), "D65"), xyz, atol=1e-6)
    strided = numpy.random.default_rng(0).uniform(0, 1, (8, 6, 3))[::2, ::-1]
    assert numpy.array_equal(profile(strided, "A"), profile(strided.copy(), "A"))
    assert profile([[1, 1, 1]], "D50") == pytest.approx(D50[None], abs=1e-3)
    with pytest.raises(darkroot.SettingsError, match="last axis must be 3"):
        profile(numpy.zeros((3, 4)), "D65")
    with pytest.raises(darkroot.SettingsError, match="choose one"):
        profile([1, 1, 1])
    with pytest.raises(darkroot.SettingsError, match="is no light|no light"):
        profile([1, 1, 1], "moon")


def test_a_profile_is_the_same_from_its_file_and_in_another_process(tmp_path):
    rgb, xyz = colours()
    profile = darkroot.fit_profile(rgb, xyz, camera="Nikon D750", names=[f"c{i}" for i in range(len(rgb))])
    profile.save(tmp_path / "p.toml")
    again = darkroot.Profile.load(tmp_path / "p.toml")
    assert again == profile == pickle.loads(pickle.dumps(profile)) and hash(again) == hash(profile)
    assert again.patches()[0]["name"] == "c0" and again.camera == "Nikon D750"
    with pytest.raises(darkroot.ExistsError):
        profile.save(tmp_path / "p.toml")


def test_a_profile_in_memory_develops_as_its_file_does(nef, dng, tmp_path):
    rgb, xyz = colours()
    profile = darkroot.fit_profile(rgb, xyz, camera="Nikon D750")
    profile.save(tmp_path / "p.toml")
    photo = darkroot.open(nef)
    ours = photo.develop(profile=profile)
    assert numpy.array_equal(ours, photo.develop(profile=tmp_path / "p.toml"))
    assert not numpy.array_equal(ours, photo.develop())
    assert "the profile that was given" not in photo.explain()["colours"]
    with pytest.raises(darkroot.ProfileError, match="is a profile for Nikon D750"):
        darkroot.open(dng).develop(profile=profile)
    darkroot.open(dng).develop(profile=darkroot.fit_profile(rgb, xyz), scale=1 / 8)
    with pytest.raises(darkroot.SettingsError, match="save it"):
        darkroot.Recipe(profile=profile)


def test_camera_rgb_and_a_profile_are_the_linear_look(nef):
    """What the developer does with a profile can be done by hand."""
    profile = darkroot.fit_profile(*colours(), camera="Nikon D750")
    photo = darkroot.open(nef)
    xyz = profile(photo.camera_rgb(scale=1 / 4))
    linear = photo.develop(look="linear", scale=1 / 4, profile=profile)
    assert numpy.abs(xyz @ numpy.array(darkroot._html.TO_SRGB).T - linear).max() < 1e-3 * linear.max()


@pytest.mark.parametrize("name", ["a.dcp", "a.icc", "a.cube", "a.clf"])
def test_exports_say_how_far_they_are_off(tmp_path, name):
    profile = darkroot.Profile.load("Nikon D700")
    with_neutral = {"neutral": (0.47, 1, 0.68)} if name.endswith("dcp") else {}
    found = profile.export(tmp_path / name, light="D65", **with_neutral)
    assert (tmp_path / name).stat().st_size > 1000 and found[0]["de2000"]["mean"] < 0.5
    assert found[0]["light"] == "D65"


@pytest.mark.parametrize(
    ("name", "arguments", "words"),
    [
        ("a.xyz", {"light": "D65"}, "names no format of profiles"),
        ("a.icc", {}, "choose one"),
        ("a.dcp", {"light": "D65"}, "what the sensor makes"),
        ("a.icc", {"light": "D65", "icc_version": 3}, "2 or 4"),
        ("a.cube", {"light": "D65", "grid": 1}, "2 to 129"),
        ("a.clf", {"light": "D65", "space": "srgb"}, "linear spaces"),
        ("a.cube", {"light": "D65", "shaper": "log"}, "none or sqrt"),
    ],
)
def test_exports_that_cannot_be_are_refused(tmp_path, name, arguments, words):
    with pytest.raises(darkroot.SettingsError, match=words):
        darkroot.Profile.load("Nikon D700").export(tmp_path / name, **arguments)


def test_lint_finds_what_is_wrong():
    rgb, xyz = colours()
    broken = darkroot.fit_profile(rgb, xyz[:, ::-1] * [1, 1, 1], model="root-4")
    assert any(finding["severity"] == "failure" for finding in broken.lint())


def test_a_camera_from_its_matrix_and_from_its_spectra(nef):
    assert darkroot.from_matrix("Nikon D90").camera == "Nikon D90"
    assert darkroot.from_matrix(nef).is_camera
    with pytest.raises(darkroot.ProfileError, match="published matrix"):
        darkroot.from_matrix("No Camera")
    nm = numpy.arange(380, 781, 5)
    bell = lambda middle: numpy.exp(-(((nm - middle) / 40) ** 2))  # noqa: E731
    table = numpy.stack([bell(600), bell(535), bell(450)], axis=1)
    profile = darkroot.from_spectra(table, wavelengths=nm, camera="Lab One")
    assert profile.is_camera and profile([[1, 1, 1]], "A") == pytest.approx(D50[None], abs=2e-3)
    with pytest.raises(darkroot.SettingsError, match="three columns"):
        darkroot.from_spectra(table[:, :2], wavelengths=nm, camera="Lab One")
    with pytest.raises(darkroot.ProfileError, match="sees nothing"):
        darkroot.from_spectra(table * [1, 0, 1], wavelengths=nm, camera="Lab One")


def test_spectra_beat_colours_under_another_light():
    """Reflectances are seen under the light itself, where XYZ under D50 can only be adapted."""
    nm = numpy.arange(400, 701, 10)
    rng = numpy.random.default_rng(5)
    waves = numpy.array([numpy.cos(nm / 300 * numpy.pi * k) for k in range(5)])
    reflectance = 0.5 + 0.45 * numpy.tanh(rng.normal(0, 0.5, (40, 5)) @ waves)
    reflectance = numpy.vstack([reflectance, [[v] * len(nm) for v in (0.05, 0.2, 0.5, 0.9)]])
    bell = lambda middle: numpy.exp(-(((nm - middle) / 35) ** 2))  # noqa: E731
    light = 1.0 + (nm - 400) / 100
    rgb = reflectance @ (numpy.stack([bell(600), bell(535), bell(455)], axis=1) * light[:, None])
    rgb /= rgb.max()
    profile = darkroot.fit_profile(rgb, reflectance=reflectance, wavelengths=nm, light="A")
    assert profile.lights == ["A"] and profile.figures()["left_out"]["mean"] < 2


@pytest.mark.parametrize(
    ("arguments", "error", "words"),
    [
        ({"xyz": None}, darkroot.SettingsError, "give `xyz`"),
        ({"xyz": numpy.ones((3, 3))}, darkroot.SettingsError, "colours of the camera"),
        ({"rgb": numpy.ones((44, 4))}, darkroot.SettingsError, "three columns"),
        ({"rgb": numpy.full((44, 3), numpy.nan)}, darkroot.SettingsError, "finite"),
        ({"rgb": numpy.ones(44)}, darkroot.SettingsError, "has the shape"),
        ({"rgb": numpy.zeros((44, 3))}, darkroot.ProfileError, "of 44 patches can be used"),
        ({"model": "magic"}, darkroot.SettingsError, "hue-plane"),
        ({"light": "moon"}, darkroot.SettingsError, "is no light"),
    ],
)
def test_fits_that_cannot_be_say_why(arguments, error, words):
    rgb, xyz = colours()
    given = {"rgb": rgb, "xyz": xyz, **arguments}
    with pytest.raises(error, match=words):
        darkroot.fit_profile(given.pop("rgb"), given.pop("xyz"), **given)
