"""Writes the types of the settings, from the program's own table: `python python/build/keywords.py > python/darkroot/_keywords.pyi`.

A test compares the file with what this writes.
"""

import darkroot


def kind(setting):
    """The type of a setting's values, as a stub has it."""
    words = [word["word"] for word in setting.get("words", [])]
    if setting["type"] == "word":
        numbers = [word for word in words if word.isdigit()]
        texts = [word for word in words if not word.isdigit()]
        choices = [f'"{word}"' for word in texts] + numbers
        return f"Literal[{', '.join(choices)}]"
    return {
        "switch": "bool",
        "number": "float",
        "whole number": "int",
        "file": "str | os.PathLike[str] | Profile" if setting["name"] == "profile" else "str | os.PathLike[str]",
        "text": "str | float | Sequence[float]",
    }[setting["type"]]


def text():
    """The stub."""
    lines = [
        '"""Types of the settings. Written by python/build/keywords.py from the table of settings; not by hand."""',
        "",
        "import os",
        "from collections.abc import Sequence",
        "from typing import Literal, TypedDict",
        "",
        "from . import Profile",
        "",
        "class Settings(TypedDict, total=False):",
    ]
    lines += [f"    {one['name'].replace('-', '_')}: {kind(one)} | None" for one in darkroot.settings()]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(text(), end="")
