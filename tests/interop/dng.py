#!/usr/bin/env python3
"""Adobe's DNG SDK and Darkroot find the same samples in every kind of DNG: dng.py DARKROOT [FOLDER]

Small DNG files of every compression, predictor, number of bits and byte order are made here; real ones are read from FOLDER.
The SDK's stage 1 (samples as stored) is compared with `darkroot inspect --samples-hash`, bit for bit where nothing is lost.
What Darkroot refuses must be a sentence; the SDK's own refusals are printed, too. The SDK's later stages cannot be had from
dngpy.

Needs dngpy (Adobe's SDK), imagecodecs and numpy from PyPI; says which is missing.
"""
import json
import os
import struct
import subprocess
import sys
import tempfile
import zlib
from pathlib import Path

try:
    import dngpy
    import imagecodecs
    import numpy as np
except ImportError as missing:
    print(f"skipped: {missing.name} is not installed")
    sys.exit(0)

WIDTH, HEIGHT = 96, 64
HALF = np.dtype("<f2")


def picture(planes, bits, floats):
    """Slopes, with some noise that is always the same."""
    y, x, p = np.mgrid[:HEIGHT, :WIDTH, :planes]
    noise = np.random.default_rng(1).integers(0, 40, (HEIGHT, WIDTH, planes))
    light = (x * 31 + y * 7 + p * 900 + noise) / 6000
    if floats:
        exact = light.astype(np.float16).astype(np.float32)
        return exact if bits == 16 else light.astype(np.float32)
    return (light * (2**bits - 1)).astype(np.uint32)


def half24(values):
    """Floats of 24 bits (1 sign, 7 exponent, 16 fraction; DNG 1.4) as numbers, rounded towards zero."""
    bits = values.astype("<f4").view("<u4")
    sign, exponent, fraction = bits >> 31, (bits >> 23 & 255).astype(int) - 127 + 63, bits >> 7 & 0xFFFF
    return (sign << 23) | (exponent.astype(np.uint32) << 16) | fraction


def pack(values, bits):
    """Rows of numbers of any width, the highest bit first; each row begins at a byte."""
    rows = []
    for row in values.reshape(values.shape[0], -1):
        text = "".join(format(int(v), f"0{bits}b") for v in row)
        text += "0" * (-len(text) % 8)
        rows.append(int(text, 2).to_bytes(len(text) // 8, "big"))
    return b"".join(rows)


def stored(values, bits, floats, order):
    """Samples as an uncompressed DNG has them."""
    if floats:
        if bits == 24:
            numbers = half24(values).ravel()
            return b"".join(int(n).to_bytes(3, "little" if order == "<" else "big") for n in numbers)
        return values.astype(f"{order}f{bits // 8}").tobytes()
    if bits in (8, 16, 32):
        return values.astype(f"{order}u{bits // 8}").tobytes()
    return pack(values, bits)


def float_bytes(values, bits):
    """The bytes of each number, the highest first."""
    if bits == 24:
        numbers = half24(values)
        return np.stack([numbers >> s & 255 for s in (16, 8, 0)], -1).astype(np.uint8)
    return values.astype(f">f{bits // 8}")[..., None].view(np.uint8)


def predicted(values, bits, floats, order, predictor):
    """Samples before deflation: horizontal differences, or those of byte planes for floats (DNG 1.4, chapter 3)."""
    planes = values.shape[2]
    step = {1: 0, 2: 1, 3: 1, 34892: 2, 34893: 4, 34894: 2, 34895: 4}[predictor] * planes
    if floats and predictor != 1:
        rows = []
        for row in values.reshape(HEIGHT if len(values) == HEIGHT else len(values), -1):
            flat = float_bytes(row, bits).reshape(len(row), -1).T.ravel().astype(np.int16)
            flat[step:] -= flat[:-step].copy()
            rows.append((flat & 255).astype(np.uint8).tobytes())
        return b"".join(rows)
    if step:
        flat = values.reshape(len(values), -1).astype(np.int64)
        differences = flat.copy()
        differences[:, step:] -= flat[:, :-step]
        return (differences % 2**bits).astype(f"{order}u{bits // 8}").tobytes()
    return stored(values, bits, floats, order)


def fields_apart(values, rows, columns):
    """Every so many rows and columns together (DNG 1.7, RowInterleaveFactor and ColumnInterleaveFactor)."""
    values = np.concatenate([values[i::rows] for i in range(rows)])
    return np.concatenate([values[:, i::columns] for i in range(columns)], 1)


def jxl(values, bits, floats, distance):
    lossy = {"distance": distance} if distance else {"lossless": True}
    if values.shape[2] == 1:
        values = values[..., 0]
    if floats:
        return imagecodecs.jpegxl_encode(values.astype(np.float16 if bits == 16 else np.float32), **lossy)
    depth = np.uint8 if bits == 8 else np.uint16
    return imagecodecs.jpegxl_encode(values.astype(depth), bitspersample=bits, **lossy)


def write(path, values, bits, *, floats=False, order="<", compression=1, predictor=1, tile=None, rows=None, distance=None,
          tags=(), interleave=(1, 1)):
    """A DNG of one directory."""
    planes = values.shape[2]
    linear = planes == 3
    rows_apart, columns_apart = interleave
    values = fields_apart(values, rows_apart, columns_apart)
    if tile:
        tw, th = tile
        padded = np.pad(values, ((0, -HEIGHT % th), (0, -WIDTH % tw), (0, 0)), mode="edge")
        parts = [padded[y:y + th, x:x + tw] for y in range(0, HEIGHT, th) for x in range(0, WIDTH, tw)]
    else:
        rows = rows or HEIGHT
        parts = [values[y:y + rows] for y in range(0, HEIGHT, rows)]
    if compression == 1:
        data = [stored(p, bits, floats, order) for p in parts]
    elif compression == 8:
        data = [zlib.compress(predicted(p, bits, floats, order, predictor)) for p in parts]
    elif compression == 52546:
        data = [jxl(p, bits, floats, distance) for p in parts]
    else:
        whole = [p[..., 0] if planes == 1 else p for p in parts]
        data = [imagecodecs.ljpeg_encode(p.astype(np.uint16), bitspersample=bits) for p in whole]
    white = [1 if floats else 2**bits - 1] * planes
    fields = {
        254: ("I", [0]), 256: ("I", [WIDTH]), 257: ("I", [HEIGHT]), 258: ("H", [bits] * planes), 259: ("H", [compression]),
        262: ("H", [34892 if linear else 32803]), 271: ("s", b"Test\0"), 272: ("s", b"Camera\0"), 274: ("H", [1]),
        277: ("H", [planes]), 284: ("H", [1]), 50706: ("B", [1, 7, 1, 0]), 50707: ("B", [1, 7, 0, 0]),
        50708: ("s", b"Test Camera\0"), 50717: ("I", white), 50778: ("H", [21]),
        50721: ("ii", [(1, 1), (0, 1), (0, 1), (0, 1), (1, 1), (0, 1), (0, 1), (0, 1), (1, 1)]),
        50728: ("II", [(1, 2), (1, 1), (1, 2)]),
    }
    if floats:
        fields[339] = ("H", [3] * planes)
    if predictor != 1:
        fields[317] = ("H", [predictor])
    if not linear:
        fields |= {33421: ("H", [2, 2]), 33422: ("B", [0, 1, 1, 2]), 50710: ("B", [0, 1, 2]), 50711: ("H", [1])}
    if tile:
        fields |= {322: ("I", [tw]), 323: ("I", [th])}
    else:
        fields[278] = ("I", [rows])
    if rows_apart > 1:
        fields[50975] = ("I", [rows_apart])
    if columns_apart > 1:
        fields[52547] = ("I", [columns_apart])
    fields |= dict(tags)
    offsets, lengths = (324, 325) if tile else (273, 279)
    fields |= {offsets: ("I", [0] * len(data)), lengths: ("I", [len(d) for d in data])}
    kinds = {"B": 1, "s": 2, "H": 3, "I": 4, "II": 5, "ii": 10}

    def value(kind, numbers):
        if kind == "s":
            return numbers
        if len(kind) == 2:
            return b"".join(struct.pack(order + kind, *pair) for pair in numbers)
        return struct.pack(f"{order}{len(numbers)}{kind}", *numbers)

    at = 8 + 2 + 12 * len(fields) + 4
    for _ in range(2):  # Offsets are known once everything has its length.
        head, values_bytes = b"", b""
        for tag in sorted(fields):
            kind, numbers = fields[tag]
            raw = value(kind, numbers)
            count = len(numbers)
            if len(raw) <= 4:
                inline = raw.ljust(4, b"\0")
            else:
                inline = struct.pack(order + "I", at + len(values_bytes))
                values_bytes += raw + b"\0" * (len(raw) % 2)
            head += struct.pack(order + "HHI", tag, kinds[kind], count) + inline
        start = at + len(values_bytes)
        places = [start + sum(len(d) for d in data[:i]) for i in range(len(data))]
        fields[offsets] = ("I", places)
    magic = b"II*\0" if order == "<" else b"MM\0*"
    directory = struct.pack(order + "IH", 8, len(fields)) + head + struct.pack(order + "I", 0)
    Path(path).write_bytes(magic + directory + values_bytes + b"".join(data))


def fnv(samples):
    """As darkroot_raw::samples_hash."""
    samples = np.ascontiguousarray(samples)
    words = samples.view(np.uint32) if samples.dtype == np.float32 else samples
    value = 0xCBF29CE484222325
    for word in words.ravel().tolist():
        value = ((value ^ word) * 0x100000001B3) & 0xFFFFFFFFFFFFFFFF
    return f"{value:016x}"


def cases():
    """Name, arguments of `write`, planes."""
    for order, way in (("<", "little"), (">", "big")):
        for bits in (8, 10, 12, 14, 16, 32):
            yield f"integer {bits} {way}-endian", dict(bits=bits, order=order), 1
        yield f"integer 16 tiles {way}-endian", dict(bits=16, order=order, tile=(48, 32)), 3
        yield f"integer 12 strips {way}-endian", dict(bits=12, order=order, rows=10), 1
        for predictor in (1, 2, 34892, 34893):
            for bits in (8, 16):
                yield (f"deflate {bits} predictor {predictor} {way}-endian",
                       dict(bits=bits, order=order, compression=8, predictor=predictor, tile=(48, 32)), 1)
        for bits in (16, 24, 32):
            yield f"float {bits} {way}-endian", dict(bits=bits, order=order, floats=True), 1
            for predictor in (3, 34894, 34895):
                for planes in (1, 3):
                    yield (f"deflate float {bits} predictor {predictor} {way}-endian x{planes}",
                           dict(bits=bits, order=order, floats=True, compression=8, predictor=predictor, tile=(48, 32)), planes)
        for planes in (1, 3):
            for bits in (8, 10, 12, 16):
                yield f"JPEG XL {bits} {way}-endian x{planes}", dict(bits=bits, order=order, compression=52546), planes
            for bits in (16, 32):
                arguments = dict(bits=bits, order=order, compression=52546, floats=True)
                yield f"JPEG XL float {bits} {way}-endian x{planes}", arguments, planes
                yield f"JPEG XL float {bits} tiles {way}-endian x{planes}", dict(arguments, tile=(64, 48)), planes
        yield f"JPEG XL 16 lossy {way}-endian", dict(bits=16, order=order, compression=52546, distance=0.5), 3
        yield f"JPEG XL float 16 lossy {way}-endian", dict(bits=16, order=order, compression=52546, floats=True, distance=0.5), 3
        for bits in (8, 12, 14, 16):
            yield f"lossless JPEG {bits} {way}-endian", dict(bits=bits, order=order, compression=7), 1
        for compression, what in ((1, "uncompressed"), (7, "lossless JPEG"), (8, "deflate"), (52546, "JPEG XL")):
            for tile in (None, (48, 32)):
                for interleave in ((2, 1), (2, 2), (3, 2)):
                    arguments = dict(bits=16, order=order, compression=compression, interleave=interleave, tile=tile)
                    yield f"{what} in {interleave} fields, {'tiles' if tile else 'strip'}, {way}-endian", arguments, 1
        arguments = dict(bits=16, order=order, compression=52546, floats=True, interleave=(2, 2), tile=(48, 32))
        yield f"JPEG XL float in (2, 2) fields, tiles, {way}-endian", arguments, 3
        masked = {50829: ("I", [4, 8, HEIGHT, WIDTH]), 50830: ("I", [0, 0, 4, WIDTH, 4, 0, HEIGHT, 8])}
        yield f"masked areas {way}-endian", dict(bits=14, order=order, tags=masked), 1


def by_sdk(path):
    """Stage 1 of Adobe's SDK, or what it says."""
    # The SDK writes its warnings past Python.
    keep, null = [os.dup(1), os.dup(2)], os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(null, 1)
        os.dup2(null, 2)
        return dngpy.Dng(str(path), True).raw_pixels
    except RuntimeError:
        return None
    finally:
        os.dup2(keep[0], 1)
        os.dup2(keep[1], 2)
        for descriptor in (*keep, null):
            os.close(descriptor)


def by_darkroot(path):
    command = [sys.argv[1], "inspect", "--json", "--samples-hash", str(path)]
    run = subprocess.run(command, capture_output=True, text=True)
    if run.returncode:
        return None, run.stderr.strip()
    return json.loads(run.stdout.splitlines()[0]), ""


failed = refused = 0


def compare(name, path, exact, mean_only=False, jxl_bits=16):
    global failed, refused
    theirs, (ours, said) = by_sdk(path), by_darkroot(path)
    if ours is None:
        words = said.split(": ", 2)[-1]
        sentence = len(words) > 20 and "panick" not in said
        refused += 1
        failed += not sentence
        print(f"refused    {name}: {words[:110]}{'' if theirs is not None else ' (the SDK refuses it too)'}")
        return
    if theirs is not None and 8 < jxl_bits < 16:
        # The SDK decodes 9 bits of JPEG XL and more to all of 16, and then takes the file's white level, which is of 9, for
        # that of 16: such files are white in it. Darkroot keeps the bits that the file names.
        theirs = np.round(theirs * ((2**jxl_bits - 1) / 65535)).astype(np.uint16)
    if theirs is None:
        if exact is not None and fnv(exact) == ours["samples_hash"]:
            print(f"by truth   {name} (the SDK refuses it)")
        else:
            print(f"no oracle  {name} (the SDK refuses it)")
        return
    if mean_only:
        theirs_mean = float(theirs.mean(dtype=np.float64))
        same = abs(theirs_mean - ours["samples_mean"]) <= 2e-4 * abs(theirs_mean)
    else:
        same = fnv(theirs) == ours["samples_hash"]
    failed += not same
    means = "" if same else f": mean {float(theirs.mean(dtype=np.float64)):.4f}, Darkroot {ours['samples_mean']:.4f}"
    print(f"{'same' if same else 'DIFFERENT':10} {name}{means}")


with tempfile.TemporaryDirectory() as folder:
    for name, arguments, planes in cases():
        path = Path(folder, "a.dng")
        arguments = dict(arguments)
        bits = arguments.pop("bits")
        values = picture(planes, bits, arguments.get("floats", False))
        write(path, values, bits, **arguments)
        exact = values if arguments.get("floats") else values.astype(np.uint16)
        compare(name, path, exact, mean_only="distance" in arguments,
                jxl_bits=bits if arguments.get("compression") == 52546 else 16)
if len(sys.argv) > 2:
    for path in sorted(Path(sys.argv[2]).glob("*.dng")):
        compare(path.name, path, None, mean_only=True)
print(f"{failed} differ, {refused} refused in words")
sys.exit(1 if failed else 0)
