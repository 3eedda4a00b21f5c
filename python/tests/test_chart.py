"""Charts: found, measured, made into profiles, judged."""

import numpy
import pytest

import darkroot


def test_a_chart_is_found_in_a_file_and_in_an_array(chart):
    (in_file, *_) = darkroot.detect_charts(chart, charts=["classic24"])
    assert in_file.chart == "classic24" and in_file.patches.shape == (24, 4, 2) and in_file.confidence > 0.3
    coded, linear = darkroot.develop(chart), darkroot.develop(chart, look="linear")
    for array in (coded, linear):
        (found, *_) = darkroot.detect_charts(array, charts=["classic24"])
        assert numpy.abs(found.corners - in_file.corners).max() < 5
    assert darkroot.detect_charts(numpy.zeros((200, 300, 3), "uint8")) == []
    with pytest.raises(darkroot.SettingsError, match="height x width x 3"):
        darkroot.detect_charts(numpy.zeros((200, 300)))


def test_measured_patches_make_a_profile(chart):
    shot = darkroot.measure_chart(chart, accept=True)
    assert len(shot.names) == 24 and shot.rgb.shape == shot.xyz.shape == shot.uncertainty.shape == (24, 3)
    assert shot.camera == "Nikon D750" and {gate["name"] for gate in shot.gates} >= {"exposure", "glare"}
    profile = darkroot.fit_profile(shot.rgb[shot.used], shot.xyz[shot.used], light="5500K", camera=shot.camera)
    assert profile.figures()["left_out"]["mean"] < 3
    assert "<svg" in shot._repr_html_()


def test_a_shot_makes_a_profile_with_its_report(chart, tmp_path):
    made = darkroot.make_profile(chart, light="5500K", accept=True, date="2026-11-27")
    assert made.profile.camera == "Nikon D750" and made.profile.origin["date"] == "2026-11-27"
    assert made.lights[0]["figures"]["left_out"]["mean"] < 3 and len(made.lights[0]["models"]) > 8
    assert made.report.lower().startswith("<!doctype html>") and "<iframe" in made._repr_html_()
    judged = darkroot.verify(chart, profile=made.profile, light="5500K", accept=True)
    assert judged["de2000"]["mean"] < 2 and len(judged["patches"]) == 24


def test_a_finished_picture_is_judged_by_the_chart(chart, tmp_path):
    darkroot.develop_file(chart, tmp_path / "page.tif", look="reproduction", space="ecirgb-v2")
    judged = darkroot.verify(tmp_path / "page.tif", accept=True, preset="fadgi-4star")
    assert judged["space"].lower().startswith("eci") and judged["verdicts"]
    assert judged["kept"] == all(v["kept"] is not False for v in judged["verdicts"])
    with pytest.raises(darkroot.SettingsError, match="is no preset"):
        darkroot.verify(tmp_path / "page.tif", preset="mine")


def test_what_is_no_shot_of_a_chart_says_so(nef, chart, tmp_path):
    with pytest.raises(darkroot.ChartError, match="no ColorChecker|was found|no .* was found"):
        darkroot.measure_chart(chart, "sg140")
    with pytest.raises(darkroot.ChartError, match="is no chart"):
        darkroot.measure_chart(chart, "my chart")
    with pytest.raises(darkroot.SettingsError, match="auto, always or never"):
        darkroot.measure_chart(chart, even_out="sometimes")
    with pytest.raises(darkroot.SettingsError, match="shots and 2 lights"):
        darkroot.make_profile(chart, light=["D50", "A"])
