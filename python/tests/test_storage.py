"""Files by URL, through fsspec."""

import pytest

import darkroot

fsspec = pytest.importorskip("fsspec")


@pytest.fixture(params=["memory", "file"])
def place(request, tmp_path, nef):
    """A folder somewhere with a raw file in it, as a URL."""
    url = "memory://darkroot-test" if request.param == "memory" else tmp_path.as_uri()
    filesystem, path = fsspec.core.url_to_fs(url)
    filesystem.makedirs(path, exist_ok=True)
    filesystem.pipe_file(f"{path}/a.nef", nef.read_bytes())
    yield url
    filesystem.rm(path, recursive=True)


def listing(url):
    filesystem, path = fsspec.core.url_to_fs(url)
    return sorted(name.rsplit("/", 1)[-1] for name in filesystem.ls(path, detail=False))


def test_files_come_from_and_go_to_urls(place, nef, tmp_path):
    assert darkroot.open(f"{place}/a.nef").camera == "Nikon D750"
    assert darkroot.inspect(f"{place}/a.nef")["input"] == f"{place}/a.nef"
    report = darkroot.develop_file(f"{place}/a.nef", f"{place}/out/a.jpg", look="vivid")
    assert report["output"] == f"{place}/out/a.jpg" and report["input"] == f"{place}/a.nef"
    darkroot.develop_file(nef, tmp_path / "alone.jpg", look="vivid")
    with fsspec.open(f"{place}/out/a.jpg") as file:
        assert file.read() == (tmp_path / "alone.jpg").read_bytes()
    assert listing(f"{place}/out") == ["a.jpg"]


def test_what_is_there_stays_unless_it_is_to_be_replaced(place):
    darkroot.develop_file(f"{place}/a.nef", f"{place}/a.jpg")
    with pytest.raises(darkroot.ExistsError, match="exists already"):
        darkroot.develop_file(f"{place}/a.nef", f"{place}/a.jpg")
    darkroot.develop_file(f"{place}/a.nef", f"{place}/a.jpg", overwrite=True)
    assert listing(place) == ["a.jpg", "a.nef"]


def test_a_file_that_fails_leaves_nothing(place):
    with pytest.raises(darkroot.MissingError, match="there is no such file"):
        darkroot.open(f"{place}/nothing.nef")
    fsspec.open(f"{place}/broken.nef", "wb").open().close()
    with pytest.raises(darkroot.FileError):
        darkroot.develop_file(f"{place}/broken.nef", f"{place}/broken.jpg")
    assert "broken.jpg" not in listing(place)
