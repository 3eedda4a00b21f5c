"""The type stubs say what is there."""

import ast
import importlib.util
import inspect
import pathlib

import conftest

import darkroot

STUBS = conftest.ROOT / "python/darkroot"


def test_the_types_of_settings_are_those_of_the_table():
    spec = importlib.util.spec_from_file_location("keywords", conftest.ROOT / "python/build/keywords.py")
    keywords = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(keywords)
    written = (STUBS / "_keywords.pyi").read_text()
    assert written == keywords.text(), "write it again: python python/build/keywords.py > python/darkroot/_keywords.pyi"


def test_everything_public_has_a_type_and_the_same_arguments():
    tree = ast.parse((STUBS / "__init__.pyi").read_text())
    named = {node.name: node for node in tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
    assert set(named) | {"ENDINGS"} == set(darkroot.__all__)
    for name, node in named.items():
        thing = getattr(darkroot, name)
        if isinstance(node, ast.FunctionDef):
            check(name, node, thing)
            continue
        for member in node.body:
            if isinstance(member, ast.AnnAssign):
                assert member.target.id in thing.__dataclass_fields__, f"{name}.{member.target.id}"
            elif isinstance(member, ast.FunctionDef):
                assert hasattr(thing, member.name), f"{name}.{member.name}"
                found = inspect.getattr_static(thing, member.name)
                if inspect.isfunction(found):
                    check(f"{name}.{member.name}", member, found)


def check(name, node, function):
    """Names of arguments; where the function hands keywords on, the stub names them."""
    arguments = node.args
    typed = [a.arg for a in arguments.posonlyargs + arguments.args + arguments.kwonlyargs]
    parameters = inspect.signature(function).parameters.values()
    real = [p.name for p in parameters if p.kind not in (p.VAR_KEYWORD, p.VAR_POSITIONAL)]
    hands_on = any(p.kind in (p.VAR_KEYWORD, p.VAR_POSITIONAL) for p in parameters)
    if hands_on:
        assert set(real) <= set(typed), name
    else:
        assert real == typed, name


def test_the_package_says_that_it_has_types():
    assert (pathlib.Path(darkroot.__file__).parent / "py.typed").exists()
