#!/usr/bin/env python3
"""Counts the instructions of each stage per pixel, and fails where there are 5 % more than `counts.json` has.

    guard.py PROGRAM            compares
    guard.py PROGRAM --update   writes what it counted

PROGRAM is the example `instructions` of darkroot-develop, built for release. Counts, unlike times, are the same on every run
of one program on one kind of machine; another compiler makes another program, so counts of another one are shown, not judged.

What a stage gives must be the same to the bit whatever vectors a processor has. Valgrind gives a program AVX2 at most, so
where the machine has AVX-512 the two ways are compared here.
"""

import json
import re
import subprocess
import sys
from pathlib import Path

COUNTS = Path(__file__).with_name("counts.json")
PIXELS = 1024 * 512
ALLOWED = 1.05


def instructions(program, stage, times):
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, stage, str(times)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return int(re.search(r"Collected : (\d+)", done.stderr).group(1)), done.stdout


def per_pixel(program, stage):
    """What one more run costs: what starting takes, cancels out."""
    (two, _), (one, given) = instructions(program, stage, 2), instructions(program, stage, 1)
    here = subprocess.run([program, stage, "1"], capture_output=True, text=True, check=True).stdout
    if given != here:
        sys.exit(f"{stage}: gives {given.strip()} under valgrind, {here.strip()} with this machine's vectors")
    return round((two - one) / PIXELS, 2)


def main():
    program = sys.argv[1]
    compiler = subprocess.run(["rustc", "--version"], capture_output=True, text=True, check=True).stdout.strip()
    stages = subprocess.run([program], capture_output=True, text=True, check=True).stdout.split("\n")
    found = {stage: per_pixel(program, stage) for stage in stages if stage}
    if "--update" in sys.argv:
        COUNTS.write_text(json.dumps({"compiler": compiler, "per_pixel": found}, indent=4) + "\n")
        return 0
    known = json.loads(COUNTS.read_text())
    worse = []
    for stage, count in found.items():
        before = known["per_pixel"].get(stage)
        print(f"{stage:20} {count:9.2f} instructions a pixel, {before} before")
        if before is None or count > ALLOWED * before:
            worse.append(stage)
    if set(known["per_pixel"]) - set(found):
        worse += sorted(set(known["per_pixel"]) - set(found))
    if compiler != known["compiler"]:
        print(f"not judged: {compiler} here, the counts are of {known['compiler']}")
        return 0
    if worse:
        print(f"more than 5 % more, or not known: {', '.join(worse)}. If that is meant: guard.py PROGRAM --update")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
