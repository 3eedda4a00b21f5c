"""Recipes: the same as the TOML that the program reads."""

import pickle
import subprocess
import sys

import pytest

import darkroot
from darkroot import Recipe, _program


def test_a_recipe_is_its_toml(tmp_path):
    recipe = Recipe(look="linear", exposure=-0.5, white_balance=(2.1, 1, 1.5), auto_exposure=False, crop="3:2")
    recipe.save(tmp_path / "r.toml")
    again = Recipe.load(tmp_path / "r.toml")
    assert again == recipe == Recipe.from_toml(recipe.to_toml()) and hash(again) == hash(recipe)
    assert again["white_balance"] == "2.1,1,1.5" and again["auto_exposure"] is False
    assert dict(**recipe) == dict(recipe) and len(recipe) == 5 and "exposure" in recipe
    with pytest.raises(darkroot.ExistsError):
        recipe.save(tmp_path / "r.toml")


def test_a_recipe_goes_to_another_process():
    recipe = Recipe(look="vivid", exposure=1)
    assert pickle.loads(pickle.dumps(recipe)) == recipe
    code = "import pickle, sys; print(pickle.load(sys.stdin.buffer).to_toml())"
    told = subprocess.run([sys.executable, "-c", code], input=pickle.dumps(recipe), capture_output=True, check=True)
    assert told.stdout.decode().strip() == recipe.to_toml().strip()


def test_the_program_reads_it_as_it_is_meant(nef, tmp_path):
    program = _program.find()
    if program is None:
        pytest.skip("the program is not installed beside this Python")
    recipe = Recipe(look="vivid", exposure=0.5, resize="long:200")
    recipe.save(tmp_path / "r.toml")
    darkroot.develop_file(nef, tmp_path / "ours.jpg", recipe=recipe)
    darkroot.develop_file(nef, tmp_path / "file.jpg", recipe=tmp_path / "r.toml")
    darkroot.develop_file(nef, tmp_path / "dict.jpg", recipe=dict(recipe))
    subprocess.run(
        [program, "-q", "develop", nef, "-o", tmp_path / "program.jpg", "--recipe", tmp_path / "r.toml"], check=True
    )
    pictures = {path.read_bytes() for path in tmp_path.glob("*.jpg")}
    assert len(pictures) == 1


def test_keywords_count_more_than_the_recipe(nef):
    photo = darkroot.open(nef)
    mixed = photo.develop(recipe=Recipe(exposure=3, look="vivid"), exposure=0, scale=1 / 4)
    assert (mixed == photo.develop(look="vivid", scale=1 / 4)).all()


def test_names_and_values_are_those_of_the_table():
    for setting in darkroot.settings():
        name = setting["name"].replace("-", "_")
        default = setting["default"]
        assert Recipe(**{name: default}).get(name) == default, name
        if "range" in setting:
            least, most = setting["range"]
            Recipe(**{name: least}), Recipe(**{name: most})
            with pytest.raises(darkroot.SettingsError):
                Recipe(**{name: most + 1})


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"expsoure": 1}, "did you mean `exposure`"),
        ({"look": "film"}, "neutral, vivid, flat"),
        ({"exposure": "much"}, "`much`"),
        ({"auto_exposure": "perhaps"}, "true or false"),
    ],
)
def test_what_is_no_setting_is_said(settings, words):
    with pytest.raises(darkroot.SettingsError, match=words):
        Recipe(**settings)
