"""The notebooks run from the first cell to the last."""

import conftest
import pytest

nbclient = pytest.importorskip("nbclient")
nbformat = pytest.importorskip("nbformat")
pytest.importorskip("ipykernel")

NOTEBOOKS = conftest.ROOT / "python/notebooks"


@pytest.fixture
def bracket(raw, tmp_path):
    """A bracket of three exposures."""
    for number, stops in enumerate(("0", "-1", "-2")):
        made = raw("--format", "nef", "--width", "720", "--height", "480", "--stops", stops, name=f"{number}.nef")
        (tmp_path / made.name).write_bytes(made.read_bytes())
    return tmp_path


def run(name):
    notebook = nbformat.read(NOTEBOOKS / f"{name}.ipynb", as_version=4)
    assert all(not cell.get("outputs") for cell in notebook.cells), "notebooks are kept without what they showed"
    nbclient.NotebookClient(notebook, timeout=120, resources={"metadata": {"path": NOTEBOOKS}}).execute()
    return notebook


@pytest.mark.parametrize("name", ["developing", "profile_from_a_chart"])
def test_a_notebook_on_the_sample_runs(name):
    pytest.importorskip("PIL")
    notebook = run(name)
    shown = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    assert any("text/html" in output.get("data", {}) for output in shown)
    assert any("image/png" in output.get("data", {}) for output in shown)


def test_the_notebook_on_a_bracket_runs(bracket, monkeypatch):
    monkeypatch.setenv("DARKROOT_NOTEBOOK_BRACKET", str(bracket))
    run("photometry_of_a_bracket")


def test_the_notebook_on_ray_runs():
    pytest.importorskip("ray")
    run("a_folder_on_ray")
