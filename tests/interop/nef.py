#!/usr/bin/env python3
"""LibRaw and Darkroot find the same samples in every kind of NEF: nef.py DARKROOT MAKE_RAW

MAKE_RAW is the example of `darkroot-simulate`. Where LibRaw takes one order of bits for granted and Darkroot asks the samples,
the true ones decide, and LibRaw's answer is printed. Small raw files (sNEF) and the padded rows of Z cameras are made here.

Needs rawpy (LibRaw) and numpy from PyPI; says which is missing.
"""
import json
import os
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import numpy as np
    import rawpy
except ImportError as missing:
    print(f"skipped: {missing.name} is not installed")
    sys.exit(0)

WIDTH, HEIGHT = 300, 200
darkroot, make_raw = sys.argv[1:3]


def fnv(samples):
    """As darkroot_raw::samples_hash."""
    value = 0xCBF29CE484222325
    for word in samples.ravel().tolist():
        value = ((value ^ word) * 0x100000001B3) & 0xFFFFFFFFFFFFFFFF
    return f"{value:016x}"


def by_libraw(path):
    keep, null = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(null, 2)
        with rawpy.imread(str(path)) as raw:
            return raw.raw_image.copy() if raw.raw_type == rawpy.RawType.Flat else None
    except rawpy.LibRawError:
        return None
    finally:
        os.dup2(keep, 2)
        os.close(keep)
        os.close(null)


def by_darkroot(path):
    run = subprocess.run([darkroot, "inspect", "--json", "--samples-hash", str(path)], capture_output=True, text=True)
    return (None, run.stderr.strip()) if run.returncode else (json.loads(run.stdout.splitlines()[0]), "")


def made(folder, storage, bits):
    """A simulated file and its samples."""
    path, counts = Path(folder, "a.nef"), Path(folder, "counts")
    size = f"--width {WIDTH} --height {HEIGHT}"
    command = f"{make_raw} --format nef --storage {storage} --bits {bits} {size} --out {path} --counts {counts}"
    subprocess.run(command.split(), check=True, capture_output=True)
    return path, np.fromfile(counts, "<u2").reshape(HEIGHT, WIDTH)


def entries(data, at):
    for i in range(struct.unpack_from("<H", data, at)[0]):
        place = at + 2 + 12 * i
        yield *struct.unpack_from("<HHII", data, place), place


def restored(path, samples, *, compression, bits, model=None):
    """Puts other bytes of samples, compression and bits into a file whose directories stay."""
    data = bytearray(path.read_bytes())
    first = struct.unpack_from("<I", data, 4)[0]
    below = next(value for tag, _, _, value, _ in entries(data, first) if tag == 330)
    for tag, _, _, _, place in entries(data, below):
        new = {258: bits, 259: compression, 273: len(data), 279: len(samples)}.get(tag)
        if new is not None:
            struct.pack_into("<I", data, place + 8, new)
    if model:
        count, value = next((c, v) for tag, _, c, v, _ in entries(data, first) if tag == 272)
        data[value:value + count] = model.ljust(count, "\0").encode()[:count]
    path.write_bytes(bytes(data) + samples)


def lowest_first(values, bits, padded):
    rows = []
    for row in values:
        number = sum(int(v) << (bits * i) for i, v in enumerate(row))
        length = -(-len(row) * bits // 8)
        rows.append(number.to_bytes(length, "little").ljust(-(-length // padded) * padded, b"\0"))
    return b"".join(rows)


failed = 0


def say(name, good, more=""):
    global failed
    failed += not good
    print(f"{'same' if good else 'DIFFERENT':10} {name}{more}")


with tempfile.TemporaryDirectory() as folder:
    for bits in (12, 14):
        for storage in ("uncompressed", "lossless", "lossy", "lossy-split"):
            path, counts = made(folder, storage, bits)
            theirs, (ours, said) = by_libraw(path), by_darkroot(path)
            same = ours is not None and theirs is not None and fnv(theirs) == ours["samples_hash"]
            exact = "" if "lossy" in storage else f", true: {ours and ours['samples_hash'] == fnv(counts)}"
            say(f"{storage} {bits}", same, exact + said)
        for storage in ("packed-highest", "packed-lowest"):
            path, counts = made(folder, storage, bits)
            theirs, (ours, said) = by_libraw(path), by_darkroot(path)
            libraw = "refuses" if theirs is None else "agrees" if fnv(theirs) == fnv(counts) else "reads something else"
            say(f"{storage} {bits}", ours is not None and ours["samples_hash"] == fnv(counts), f" as the true ones; LibRaw {libraw}{said}")
        path, counts = made(folder, "uncompressed", bits)
        restored(path, lowest_first(counts, bits, 16), compression=34713, bits=bits, model="NIKON Z 6")
        theirs, (ours, said) = by_libraw(path), by_darkroot(path)
        good = ours is not None and ours["samples_hash"] == fnv(counts)
        libraw = theirs is not None and fnv(theirs) == fnv(counts)
        say(f"rows padded to 16 bytes {bits}", good, f" as the true ones; LibRaw {'agrees' if libraw else 'does not'}{said}")
    # Small raw files: two pixels share their colour differences, 12 bits each.
    path, _ = made(folder, "uncompressed", 12)
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    light = (x * 6 + y * 3) % 2500
    colour = [2048 + (x // 2 + k * y) % 300 - 150 for k in (1, 2)]
    four = np.stack([light[:, ::2], light[:, 1::2], colour[0][:, ::2], colour[1][:, ::2]], -1).reshape(HEIGHT, -1)
    restored(path, lowest_first(four, 12, 1), compression=34713, bits=12)
    with rawpy.imread(str(path)) as raw:
        theirs = raw.raw_image_visible[..., :3].copy()
    ours, said = by_darkroot(path)
    say("small (sNEF)", ours is not None and ours["samples_hash"] == fnv(theirs), said)
sys.exit(1 if failed else 0)
