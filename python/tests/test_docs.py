"""Every example in a docstring runs."""

import builtins
import doctest
import importlib
import pkgutil
import re

import pytest

import darkroot

OPTIONAL = {"darkroot.imageio": "imageio"}


def _modules():
    yield "darkroot"
    for module in pkgutil.iter_modules(darkroot.__path__, "darkroot."):
        yield module.name


def _examples():
    finder = doctest.DocTestFinder(exclude_empty=True)
    for name in _modules():
        if name in OPTIONAL:
            try:
                importlib.import_module(OPTIONAL[name])
            except ImportError:
                continue
        module = importlib.import_module(name)
        found = finder.find(module, name)
        if name == "darkroot._core":
            # What is compiled has no source in which to look it up.
            for thing in (darkroot.Recipe, darkroot.Cancel):
                found += finder.find(thing, f"darkroot.{thing.__name__}", module=False)
        yield from (example for example in found if example.examples)


@pytest.mark.parametrize("example", list(_examples()), ids=lambda example: example.name)
def test_an_example_of_a_docstring_gives_what_it_says(example, nef, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    example.globs = {"darkroot": darkroot, "sample": str(nef), "builtins": builtins, **vars(darkroot)}
    example.globs.pop("open", None)
    flags = doctest.NORMALIZE_WHITESPACE
    words = []
    failed, tried = doctest.DocTestRunner(optionflags=flags).run(example, out=words.append)
    assert tried and not failed, "".join(words)


def test_there_are_enough_examples():
    assert sum(len(example.examples) for example in _examples()) > 40


def test_everything_public_says_what_it_is():
    for name in darkroot.__all__:
        thing = getattr(darkroot, name)
        assert (thing.__doc__ or "").strip(), name
        if isinstance(thing, type):
            for member, value in vars(thing).items():
                if callable(value) and not member.startswith("_"):
                    assert (value.__doc__ or "").strip(), f"{name}.{member}"


def test_the_readme_runs(nef, tmp_path, monkeypatch):
    """The Python blocks of the package's README, in the sequence in which they stand."""
    import conftest

    text = (conftest.ROOT / "python/README.md").read_text()
    blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert len(blocks) > 5
    monkeypatch.chdir(tmp_path)
    for name in ("DSC_0001.NEF", "chart.NEF"):
        (tmp_path / name).write_bytes(nef.read_bytes())
    (tmp_path / "shoot").mkdir()
    for number in range(3):
        (tmp_path / f"shoot/{number}.nef").write_bytes(nef.read_bytes())
    names = {}
    for block in blocks:
        exec(compile(block, "README.md", "exec"), names)
