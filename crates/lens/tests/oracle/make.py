"""Prints what lensfun itself says: where light is in the picture as taken, and by what vignetting is undone.

    python -m pip install lensfunpy==1.18.0 numpy
    python crates/lens/tests/oracle/make.py > crates/lens/tests/oracle/table.tsv
    python crates/lens/tests/oracle/make.py --all > every-lens.tsv     # one shot or two of every lens

A line `shot` (camera maker and model, lens maker and model, focal length in mm, f-number, distance in m, which of
distortion, TCA and vignetting there are), then lines `place` (x, y, then x and y of red, green, blue) of a picture of
6000 x 4000 pixels and lines `gain` (x, y, factor) of one of 600 x 400, all from the middle of the picture. Single
places are asked for: in whole rows lensfun adds single precision up, and is wrong by a tenth of a pixel.
"""
import sys

import lensfunpy
import numpy as np

SIZE, SMALL = (6000, 4000), (600, 400)
PLACES = [(0, 0), (0, 2000), (3000, 0), (5200, 3300), (2000, 3100), (3300, 2200)]
FLAGS = lensfunpy.ModifyFlags.DISTORTION | lensfunpy.ModifyFlags.TCA | lensfunpy.ModifyFlags.VIGNETTING

# Camera maker and model, lens, focal lengths, f-numbers, distances.
SHOTS = [
    ("Canon", "Canon EOS 550D", "Canon EF-S 18-55mm f/3.5-5.6 IS", [18, 21, 55], [4], [1000]),
    ("Canon", "Canon EOS 5D Mark II", "Canon EF 24-70mm f/2.8L USM", [24, 31, 70], [2.8, 5], [3]),
    ("Canon", "Canon EOS 5D Mark II", "Canon EF 50mm f/1.8 II", [50], [1.8, 4.5], [1000]),
    ("Canon", "Canon EOS 7D", "Canon EF 24-105mm f/4L IS USM", [24, 60], [4, 9], [1000]),
    ("Canon", "Canon EOS 5D Mark III", "Canon EF 16-35mm f/2.8L II USM", [16, 19, 35], [2.8], [10]),
    ("Canon", "Canon EOS 5D Mark II", "Canon EF 85mm f/1.2L II USM", [85], [1.2], [2]),
    ("Nikon Corporation", "Nikon D5000", "Nikon AF-S DX Nikkor 18-55mm f/3.5-5.6G VR", [18, 26], [5.6], [1000]),
    ("Nikon Corporation", "Nikon D700", "Nikon AF-S Zoom-Nikkor 24-70mm f/2.8G ED", [24, 40, 70], [2.8, 7], [5]),
    ("Nikon Corporation", "Nikon D700", "Nikon AF-S Nikkor 50mm f/1.8G", [50], [1.8], [1000]),
    ("Nikon Corporation", "Nikon D90", "Nikon AF-S DX Nikkor 35mm f/1.8G", [35], [1.8, 2.4], [1]),
    ("Nikon Corporation", "Nikon D7000", "Nikon AF-S DX Zoom-Nikkor 16-85mm f/3.5-5.6G ED VR", [16, 50], [5], [1000]),
    ("Nikon Corporation", "Nikon D7000", "Tokina AT-X 116 AF Pro DX 11-16mm f/2.8", [11, 14], [2.8], [1000]),
    ("Nikon Corporation", "Nikon Z 6", "Nikkor Z 24-70mm f/4 S", [24, 33, 70], [4], [1000]),
    ("Sony", "ILCE-7M3", "FE 24-70mm f/2.8 GM", [24, 50], [2.8], [1000]),
    ("Sony", "ILCE-6000", "E PZ 16-50mm f/3.5-5.6 OSS", [16, 20, 50], [5.6], [1000]),
    ("Sony", "ILCE-7M3", "FE 55mm f/1.8 ZA", [55], [1.8], [1000]),
    ("Fujifilm", "X-T1", "XF 18-55mm f/2.8-4 R LM OIS", [18, 25, 55], [4], [1000]),
    ("Fujifilm", "X-T1", "XF 35mm f/1.4 R", [35], [1.4, 3], [1000]),
    ("Olympus Imaging Corp.", "E-M5", "Olympus M.Zuiko Digital ED 12-40mm f/2.8 Pro", [12, 17], [2.8], [1000]),
    ("Panasonic", "DMC-GX7", "Lumix G 20mm f/1.7 II Asph.", [20], [1.7], [1000]),
    ("Pentax", "Pentax K-5", "smc Pentax-DA 18-135mm f/3.5-5.6 ED AL IF DC WR", [18, 40], [5.6], [1000]),
    ("Pentax", "Pentax K-5", "smc Pentax-DA* 16-50mm f/2.8 ED AL IF SDM", [16, 23], [2.8], [1000]),
    ("Sony", "SLT-A77V", "Sony DT 16-50mm f/2.8 SSM (SAL1650)", [16, 30], [2.8], [1000]),
    ("Canon", "Canon PowerShot S95", None, [6, 12], [2.8], [1000]),
    ("Sony", "DSC-RX100M3", None, [8.8, 15], [2.8], [1000]),
    ("Nikon Corporation", "Nikon D90", "Sigma 8mm f/3.5 EX DG Circular", [8], [5.6], [1000]),
    ("Sony", "ILCE-6000", "E 24mm f/1.8 ZA", [24], [2.8], [1000]),
    ("Canon", "Canon PowerShot G12", None, [6.1, 15, 30.5], [4], [1000]),
    ("Canon", "Canon EOS 550D", "Tamron SP AF 17-50mm f/2.8 XR Di II LD Aspherical (IF)", [17, 24], [4], [1000]),
]


def shot(camera, lens, focal, aperture, distance, out):
    """One shot; nothing if lensfun corrects nothing."""
    big = lensfunpy.Modifier(lens, camera.crop_factor, *SIZE)
    big.initialize(focal, aperture, distance, scale=1.0, pixel_format=np.float32, flags=FLAGS)
    small = lensfunpy.Modifier(lens, camera.crop_factor, *SMALL)
    small.initialize(focal, aperture, distance, scale=1.0, pixel_format=np.float32, flags=FLAGS)
    picture = np.ones((SMALL[1], SMALL[0], 3), np.float32)
    has = [big.apply_geometry_distortion(0, 0, 1, 1) is not None, big.apply_subpixel_distortion(0, 0, 1, 1) is not None,
           small.apply_color_modification(picture)]
    has = [n for n, there in zip("dtv", has) if there]
    if not has:
        return
    name = (camera.maker, camera.model, lens.maker, lens.model)
    out.write("shot\t%s\t%g\t%g\t%g\t%s\n" % ("\t".join(n or "" for n in name), focal, aperture, distance, "".join(has)))
    middle = [(s - 1) / 2 for s in SIZE]
    if "d" in has or "t" in has:
        for x, y in PLACES:
            ask = big.apply_subpixel_geometry_distortion
            if "t" not in has:
                ask = big.apply_geometry_distortion
            elif "d" not in has:
                ask = big.apply_subpixel_distortion
            found = ask(x, y, 1, 1).reshape(-1, 2).astype(float) - middle
            found = np.repeat(found, 3, 0) if len(found) == 1 else found
            numbers = [x - middle[0], y - middle[1], *found.flatten()]
            out.write("place\t" + "\t".join("%.3f" % n for n in numbers).replace(".500", ".5") + "\n")
    if "v" in has:
        for x, y in PLACES:
            x, y = x // 10, y // 10
            where = [x - (SMALL[0] - 1) / 2, y - (SMALL[1] - 1) / 2]
            out.write("gain\t%g\t%g\t%.5f\n" % (*where, picture[y, x, 0]))


def table(database, out):
    for maker, model, name, focals, apertures, distances in SHOTS:
        cameras = database.find_cameras(maker, model)
        if not cameras:
            sys.stderr.write("no camera %s\n" % model)
            continue
        lenses = database.find_lenses(cameras[0], None, name) if name else database.find_lenses(cameras[0])
        if not lenses:
            sys.stderr.write("no lens %s\n" % name)
            continue
        for focal in focals:
            for aperture in apertures:
                for distance in distances:
                    shot(cameras[0], lenses[0], focal, aperture, distance, out)


def every(database, out):
    """Every lens that was measured, on the first camera of its mount with the crop factor that it was measured with."""
    for lens in database.lenses:
        mounts = set(lens.mounts)
        cameras = [c for c in database.cameras if c.mount in mounts]
        cameras.sort(key=lambda c: abs(c.crop_factor - lens.crop_factor))
        if not cameras or cameras[0].crop_factor < lens.crop_factor * 0.96:
            continue
        low, high = lens.min_focal, lens.max_focal
        if not low:
            continue
        for focal in {low, round((low * (high or low)) ** 0.5, 1)}:
            shot(cameras[0], lens, focal, max(lens.min_aperture or 4, 4), 1000, out)


if __name__ == "__main__":
    (every if "--all" in sys.argv else table)(lensfunpy.Database(), sys.stdout)
