#!/usr/bin/env python3
"""Darkroot's batch beside other raw developers, on the same files, in one run.

Makes simulated 24 MP lossless NEF files and lets every developer that is installed turn all of them into
pictures, in turns, so that whatever else the machine does hits all of them alike. See README.md.
"""

import argparse
import json
import os
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = os.sysconf("SC_PAGE_SIZE")


# What is measured -----------------------------------------------------------------------------------------------


def tree(root):
    """A process and all below it."""
    children = {}
    for entry in os.listdir("/proc"):
        if entry.isdigit():
            try:
                fields = Path("/proc", entry, "stat").read_text().rpartition(")")[2].split()
            except OSError:
                continue
            children.setdefault(int(fields[1]), []).append(int(entry))
    found, queue = [], [root]
    while queue:
        process = queue.pop()
        found.append(process)
        queue += children.get(process, [])
    return found


def memory(root):
    """Bytes that a process and all below it hold: each one's share of what several hold together (PSS)."""
    total = 0
    for process in tree(root):
        try:
            for line in Path("/proc", str(process), "smaps_rollup").read_text().splitlines():
                if line.startswith("Pss:"):
                    total += 1024 * int(line.split()[1])
        except OSError:
            pass  # It ended meanwhile.
    return total


class Measured:
    """What a command took."""

    def __init__(self, seconds, cpu, peak, code):
        self.seconds, self.cpu, self.peak, self.code = seconds, cpu, peak, code


def measure(command, hear=None, environment=None):
    """Runs a command to its end. `hear` gets each line of its output with the process's number."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    start = time.monotonic()
    process = subprocess.Popen(
        [str(part) for part in command],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE if hear else subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        text=True,
        env={**os.environ, **(environment or {})},
    )
    peak = 0
    over = threading.Event()

    def look():
        nonlocal peak
        while not over.wait(0.05):
            peak = max(peak, memory(process.pid))

    looker = threading.Thread(target=look)
    looker.start()
    if hear:
        for line in process.stdout:
            hear(line, process.pid)
    code = process.wait()
    seconds = time.monotonic() - start
    over.set()
    looker.join()
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return Measured(seconds, cpu, peak, code)


# Who is measured ------------------------------------------------------------------------------------------------


def batch(darkroot, *more):
    """One command for all files, into a new folder."""
    return lambda files, out: [[darkroot, "batch", *files, "-o", out, "--quiet", *more]]


def darktable(files, out):
    configuration = ["--core", "--configdir", out / "config", "--cachedir", out / "cache", "--library", ":memory:"]
    return [["darktable-cli", files[0].parent, out, "--out-ext", "jpg", *configuration]]


def rawtherapee(files, out):
    return [["rawtherapee-cli", "-q", "-d", "-Y", "-j92", "-o", out, "-c", *files]]


def dcraw(files, out):
    return [["dcraw_emu", "-T", "-q", "3", "-Z", out / (file.stem + ".tif"), file] for file in files]


def dcraw_together(files, out):
    names = "\\0".join(str(file) for file in files)
    one = f'dcraw_emu -T -q 3 -Z "{out}/$(basename "$1" .nef).tif" "$1"'
    return [["sh", "-c", f"printf '{names}' | xargs -0 -n 1 -P {cores()} sh -c '{one}' sh"]]


def peers(darkroot):
    """Name, program, commands for files, ending of what it makes."""
    everyone = [
        ("darkroot batch", darkroot, batch(darkroot), "jpg"),
        ("darktable-cli", "darktable-cli", darktable, "jpg"),
        ("rawtherapee-cli", "rawtherapee-cli", rawtherapee, "jpg"),
        ("dcraw_emu, one at a time", "dcraw_emu", dcraw, "tif"),
        (f"dcraw_emu, {cores()} at once", "dcraw_emu", dcraw_together, "tif"),
    ]
    for name, program, _, _ in everyone:
        if not shutil.which(str(program)):
            print(f"{name}: not installed, left out", file=sys.stderr)
    return [peer for peer in everyone if shutil.which(str(peer[1]))]


# How ------------------------------------------------------------------------------------------------------------


def cores():
    return len(os.sched_getaffinity(0))


def build(arguments):
    """Paths of the program and of the maker of raw files."""
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release"
    if not arguments.no_build:
        cargo = ["cargo", "build", "--release", "--quiet", "--manifest-path", ROOT / "Cargo.toml"]
        subprocess.run([*cargo, "-p", "darkroot-cli"], check=True)
        subprocess.run([*cargo, "-p", "darkroot-simulate", "--example", "make_raw"], check=True)
    return arguments.darkroot or target / "darkroot", target / "examples" / "make_raw"


def make_files(maker, folder, count, width, height):
    """Raw files of which no two are alike: each is exposed a little less than the one before it."""
    folder.mkdir()
    kinds = min(count, 12)
    files = []
    for number in range(count):
        path = folder / f"DSC_{number + 1:04}.nef"
        if number < kinds:
            size = ["--width", str(width), "--height", str(height), "--stops", str(-0.05 * number)]
            subprocess.run([maker, "--format", "nef", *size, "--out", path], check=True, stderr=subprocess.DEVNULL)
            let_rawspeed_in(path)
        else:
            shutil.copyfile(files[number % kinds], path)
        files.append(path)
    for path in files:
        path.read_bytes()  # Into the memory of the system, for all of them alike.
    return files


def let_rawspeed_in(path):
    """Makes the lens of a simulated NEF its contrast curve, in two bytes.

    darktable's decoder finds Nikon's compression table beside a contrast curve only. No other one here minds.
    """
    content = path.read_bytes()
    lens, curve = b"\x84\x00\x05\x00\x04\x00\x00\x00", b"\x8c\x00\x05\x00\x04\x00\x00\x00"
    if content.count(lens) != 1:
        sys.exit(f"{path}: its maker note is another than this script knows")
    path.write_bytes(content.replace(lens, curve))


def one_turn(peer, files, work):
    """One developer, all files, into an empty folder."""
    _, _, commands, ending = peer
    out = work / "out"
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir()
    runs = [measure(command) for command in commands(files, out)]
    made = len(list(out.rglob(f"*.{ending}")))
    if made != len(files) or any(run.code != 0 for run in runs):
        codes = {run.code for run in runs}
        sys.exit(f"{peer[0]}: made {made} of {len(files)} pictures, exit codes {codes}")
    seconds, cpu = sum(run.seconds for run in runs), sum(run.cpu for run in runs)
    return Measured(seconds, cpu, max(run.peak for run in runs), 0)


def single(darkroot, files, work):
    """Processor seconds of one `darkroot develop` on one thread, for each of a few files."""
    taken = []
    for file in files:
        out = work / "single.jpg"
        run = measure([darkroot, "develop", file, "-o", out, "--overwrite", "--quiet", "--threads", "1"])
        if run.code != 0:
            sys.exit(f"darkroot develop ended with {run.code} on {file.name}")
        taken.append(run.cpu)
    return taken


def load():
    one, five, _ = os.getloadavg()
    return f"{one:.1f} (1 min), {five:.1f} (5 min)"


def side_by_side(arguments, darkroot, files, work):
    megapixels = arguments.width * arguments.height / 1e6 * len(files)
    print(f"{len(files)} files of {megapixels / len(files):.0f} MP, {cores()} cores, {arguments.rounds} rounds")
    print(f"load before: {load()}\n")
    everyone = peers(darkroot)
    turns = {peer[0]: [] for peer in everyone}
    alone = []
    for _ in range(arguments.rounds):
        for peer in everyone:
            turns[peer[0]].append(one_turn(peer, files, work))
            if peer is everyone[0]:
                alone += single(darkroot, files[:3], work)
    # The median of the rounds: of few rounds, the middle one is what a quiet machine shows most often.
    middle = lambda name, of: statistics.median(of(turn) for turn in turns[name])
    ours = middle(everyone[0][0], lambda t: t.seconds)
    print("| developer | seconds a file | MP/s | CPU seconds a file | peak memory, MiB | time / darkroot |")
    print("|---|---|---|---|---|---|")
    for name in turns:
        seconds, cpu = middle(name, lambda t: t.seconds), middle(name, lambda t: t.cpu)
        peak = max(turn.peak for turn in turns[name]) / 2**20
        print(
            f"| {name} | {seconds / len(files):.2f} | {megapixels / seconds:.1f} | {cpu / len(files):.2f} | "
            f"{peak:.0f} | {seconds / ours:.2f} |"
        )
    spread = {name: [round(turn.seconds, 1) for turn in of] for name, of in turns.items()}
    print(f"\nseconds of each round: {json.dumps(spread)}")
    ideal = statistics.median(alone) * len(files) / cores()
    print(
        f"one `darkroot develop` on one thread: {statistics.median(alone):.2f} CPU seconds; ideal for "
        f"{len(files)} files on {cores()} cores {ideal:.1f} s, batch {ours:.1f} s: {100 * (ours / ideal - 1):+.0f} %"
    )
    used = [turn.cpu / turn.seconds / cores() for turn in turns[everyone[0][0]]]
    print(f"share of the processor that batch had: {', '.join(f'{100 * u:.0f} %' for u in used)}")
    print(f"load after: {load()}")


def memory_trace(darkroot, files, work):
    """Memory of all processes of a batch, over its files."""
    out = work / "out"
    trace = []
    done = 0

    def hear(line, process):
        nonlocal done
        if json.loads(line).get("event") == "done":
            done += 1
            trace.append((done, memory(process)))

    run = measure([darkroot, "batch", files[0].parent, "-o", out, "--json", "--quiet"], hear)
    if run.code != 0 or done != len(files):
        sys.exit(f"darkroot batch ended with {run.code} after {done} of {len(files)} files")
    print(f"{done} files in {run.seconds:.0f} s; peak {run.peak / 2**20:.0f} MiB; load {load()}\n")
    print("| file | MiB held by all processes, median of the 10 files up to it | largest |\n|---|---|---|")
    step = max(len(files) // 10, 10)
    for at in sorted({10, *range(step, len(files) + 1, step), len(files)}):
        near = [held / 2**20 for number, held in trace if at - 10 < number <= at]
        print(f"| {at} | {statistics.median(near):.0f} | {max(near):.0f} |")


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--files", type=int, default=12)
    arguments.add_argument("--rounds", type=int, default=3)
    arguments.add_argument("--width", type=int, default=6000)
    arguments.add_argument("--height", type=int, default=4000)
    arguments.add_argument("--memory-trace", action="store_true", help="memory of a batch over time, without peers")
    arguments.add_argument("--no-build", action="store_true", help="take the programs that are built already")
    arguments.add_argument("--darkroot", type=Path, help="another build of the program")
    arguments.add_argument("--work", type=Path, help="a folder on a quick disk for files and pictures")
    arguments = arguments.parse_args()
    darkroot, maker = build(arguments)
    with tempfile.TemporaryDirectory(dir=arguments.work) as work:
        work = Path(work)
        files = make_files(maker, work / "in", arguments.files, arguments.width, arguments.height)
        if arguments.memory_trace:
            memory_trace(darkroot, files, work)
        else:
            side_by_side(arguments, darkroot, files, work)


if __name__ == "__main__":
    main()
