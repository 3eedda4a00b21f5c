#!/usr/bin/env python3
"""What exiftool shows of raw files and means something in a picture is in what Darkroot makes of them, with the same value.

    python3 tests/interop/metadata.py PROGRAM FILE...
    python3 tests/interop/metadata.py --peers PROGRAM FILE...

The second counts beside those of Darkroot the fields that RawTherapee and darktable keep, where they are installed.

Says which fields are lost or changed, and what `exiftool -validate` says of the pictures. Passes without exiftool."""
import json
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

# Fields about how the raw file is stored, how the camera rendered it, or that must differ in the picture.
OF_THE_RAW = re.compile(
    r"^(Image(Width|Height|Size)|Exif(ImageWidth|ImageHeight|Version|ByteOrder)|.*(Offset|Length|ByteCounts?)$|Bits.*|Compression|"
    r"Photometric.*|Samples.*|Rows.*|Planar.*|Subfile.*|Orientation|[XY]Resolution|ResolutionUnit|Software|.*Thumbnail.*|"
    r"CFA.*|DNG.*|UniqueCameraModel|.*Matrix.*|.*Calibration.*|Black.*|White(Level|Point)|Default.*|Linear.*|Active.*|AnalogBal.*|"
    r"As.?Shot.*|Baseline.*|BestQ.*|Bayer.*|Chroma.*|AntiAlias.*|ShadowScale|Raw.*|Original.*|Opcode.*|Noise.*|Profile.*|Preview.*|"
    r"TIFF-?EP.*|ColorSpace|Tile.*|Strip.*|YCbCr.*|Primary.*|Reference.*|Predictor|Sample.*|Flashpix.*|Components.*|MakerNote.*|"
    r"ModifyDate|MetadataDate|CreatorTool|Format|.*Digest|Interop.*|NewRaw.*|Cached.*|Rating(Percent)?|JPEG.*|LocalizedCameraModel|"
    r"CameraSerialNumber|Jpg.*|SubTileBlockSize|RowInterleaveFactor|Gain.*Map.*|Semantic.*|Mask.*|Depth.*|RGBTables|ColorimetricReference|"
    r"PrintIM.*|UserComment|CompressedBitsPerPixel|Application.*|FileSource|XMPToolkit|FocalPlane.*|Contrast|Saturation|Sharpness|CustomRendered|GainControl)$"
)
GROUPS = re.compile(r"^(IFD0|ExifIFD|GPS|XMP-(?!crs|xmpMM|tiff|crd|crss|darktable|stEvt|xmpNote).*)$")


def fields(path):
    out = subprocess.run(["exiftool", "-j", "-G1", "-a", str(path)], capture_output=True, text=True).stdout
    found = {}
    for key, value in json.loads(out)[0].items():
        group, _, name = key.partition(":")
        if GROUPS.match(group) and not OF_THE_RAW.match(name) and str(value).strip():
            found.setdefault(name, set()).add(str(value))
    return found


def developed(program, raw, out):
    """Makes a JPEG as each program makes it by default; whether it did."""
    commands = {
        "rawtherapee": ["rawtherapee-cli", "-q", "-Y", "-d", "-o", out, "-j90", "-c", raw],
        "darktable": ["darktable-cli", raw, out, "--core", "--configdir", out.parent / "dt", "--library", ":memory:"],
    }
    command = commands.get(program, [program, "develop", raw, "-q", "-o", out, "--overwrite"])
    subprocess.run(command, capture_output=True, timeout=300)
    return out.exists()


def lens_and_numbers(path):
    """How many of lens, serial number of camera and of lens are told outside of maker notes."""
    names = ["LensModel", "SerialNumber", "LensSerialNumber"]
    said = subprocess.run(["exiftool", "-j", "-G1", "-a", *(f"-{name}" for name in names), str(path)], capture_output=True, text=True)
    keys = {key for key in json.loads(said.stdout)[0] if key.startswith(("ExifIFD:", "XMP-"))}
    return sum(any(key.endswith(f":{name}") for key in keys) for name in names)


def peers(program, files):
    others = [name for name, command in [("rawtherapee", "rawtherapee-cli"), ("darktable", "darktable-cli")] if shutil.which(command)]
    print("| raw file | fields | " + " | ".join(["Darkroot", *others]) + " |")
    print("|---|---|" + "---|" * (1 + len(others)))
    with tempfile.TemporaryDirectory() as folder:
        for raw in map(Path, files):
            before, row = fields(raw), []
            for name in [program, *others]:
                out = Path(folder) / f"{raw.stem}-{Path(name).name}.jpg"
                if not developed(name, raw, out):
                    row.append("no picture")
                    continue
                after = fields(out)
                kept = sum(bool(n in after and before[n] & after[n]) for n in before)
                row.append(f"{kept}, {lens_and_numbers(out)} of lens and numbers")
            print(f"| {raw.name} | {len(before)} | " + " | ".join(row) + " |", flush=True)
    return 0


def main():
    if not shutil.which("exiftool"):
        print("skipped: exiftool is not there")
        return 0
    if sys.argv[1] == "--peers":
        return peers(sys.argv[2], sys.argv[3:])
    program, wrong = sys.argv[1], 0
    with tempfile.TemporaryDirectory() as folder:
        for raw in map(Path, sys.argv[2:]):
            for ending in ["jpg", "tif", "png"]:
                out = Path(folder) / f"{raw.stem}.{ending}"
                subprocess.run([program, "develop", raw, "--resize", "long:200", "-q", "-o", out], check=True)
                before, after = fields(raw), fields(out)
                lost = sorted(set(before) - set(after))
                changed = sorted(n for n in before if n in after and not before[n] & after[n])
                said = subprocess.run(
                    ["exiftool", "-validate", "-s3", str(out)], capture_output=True, text=True
                ).stdout.strip()
                print(f"{raw.name} {ending}: {len(before)} fields, lost {lost}, changed {changed}; {said}")
                wrong += len(lost) + len(changed)
    return 1 if wrong else 0


sys.exit(main())
