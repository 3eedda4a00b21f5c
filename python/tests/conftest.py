"""What the tests stand on: samples of the repository, and raw files that its own examples make."""

import os
import pathlib
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SAMPLES = ROOT / "samples"
#: Examples of the repository that were compiled; resolved here, before any test changes its folder.
EXAMPLES = pathlib.Path(os.environ["DARKROOT_EXAMPLES"]).resolve() if "DARKROOT_EXAMPLES" in os.environ else None


@pytest.fixture(scope="session")
def nef():
    """A small NEF of a Nikon D750."""
    return SAMPLES / "still-life.nef"


@pytest.fixture(scope="session")
def dng():
    """A small DNG of a simulated camera."""
    return SAMPLES / "still-life.dng"


@pytest.fixture
def copies(tmp_path, nef):
    """Makes a folder of so many raw files, which are copies of one."""

    def make(count, folder="in"):
        place = tmp_path / folder
        place.mkdir()
        data = nef.read_bytes()
        for number in range(count):
            (place / f"{number:04}.nef").write_bytes(data)
        return place

    return make


def example(name):
    """An example of the repository that was compiled, or a skipped test."""
    if EXAMPLES is None or not (EXAMPLES / name).exists():
        pytest.skip(f"DARKROOT_EXAMPLES names no folder with the compiled example {name}")
    return EXAMPLES / name


@pytest.fixture(scope="session")
def raw(tmp_path_factory):
    """Makes a raw file by the example `make_raw`: `raw("--format", "nef", ...)`."""
    folder = tmp_path_factory.mktemp("raw")

    def make(*arguments, name="made.nef"):
        out = folder / name
        if not out.exists():
            subprocess.run([example("make_raw"), *arguments, "--out", out], check=True, capture_output=True)
        return out

    return make


@pytest.fixture(scope="session")
def chart(nef):
    """A shot with a chart of 24 patches in it, under daylight of 5500 K: that of the samples."""
    return nef
