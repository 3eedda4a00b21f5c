#!/usr/bin/env python3
"""Licences of what is inside: `licences.py [PACKAGE ...]` prints every crate of darkroot-cli with its licence, then the texts.

What `cargo metadata` says and what the crates bring along, for the platform that it runs on; each text once, with the crates that
it belongs to.
"""

import collections
import json
import pathlib
import subprocess
import sys

#: Names of files that hold licences, by their beginning.
NAMES = ("licen", "copying", "notice", "copyright", "unlicense")


def packages(roots):
    """What goes into packages of the workspace: crates that are linked, not those that only build."""
    host = next(
        line.split()[1]
        for line in subprocess.run(["rustc", "-vV"], capture_output=True, text=True, check=True).stdout.splitlines()
        if line.startswith("host:")
    )
    command = ["cargo", "metadata", "--locked", "--format-version", "1", "--filter-platform", host]
    told = json.loads(subprocess.run(command, capture_output=True, check=True).stdout)
    by_id = {package["id"]: package for package in told["packages"]}
    nodes = {node["id"]: node for node in told["resolve"]["nodes"]}
    waiting = [package["id"] for package in told["packages"] if package["name"] in roots]
    found = set()
    while waiting:
        one = waiting.pop()
        if one in found:
            continue
        found.add(one)
        for dep in nodes[one]["deps"]:
            if any(kind["kind"] is None for kind in dep["dep_kinds"]):
                waiting.append(dep["pkg"])
    others = (by_id[one] for one in found if by_id[one]["source"])
    return sorted(others, key=lambda package: (package["name"], package["version"]))


def main():
    """Prints the list and the texts."""
    roots = sys.argv[1:] or ["darkroot-cli"]
    texts = collections.defaultdict(list)
    print(f"What is inside of {' and '.join(roots)} beside Darkroot's own code, which is under LGPL-3.0-or-later:\n")
    for package in packages(roots):
        name = f"{package['name']} {package['version']}"
        print(f"{name:40} {package['license'] or package['license_file'] or 'see its text'}")
        for path in sorted(pathlib.Path(package["manifest_path"]).parent.iterdir()):
            if path.is_file() and path.name.lower().startswith(NAMES):
                text = path.read_text(errors="replace").strip()
                if text:
                    texts[text].append(name)
    for text, names in sorted(texts.items(), key=lambda one: -len(one[1])):
        print("\n" + "=" * 100 + "\n" + ", ".join(names) + ":\n\n" + text)


if __name__ == "__main__":
    main()
