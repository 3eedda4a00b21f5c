#!/usr/bin/env python3
"""What the program shows of highlights, edges and noise, beside other developers with their defaults.

    peers.py --darkroot target/release/darkroot [--raw FILE ..] [--clipped FILE] [--work DIR]

Captures are simulated and written as DNG, and every developer that is installed makes a picture in sRGB of them:
rawtherapee-cli and darktable-cli with the recipe that they give a new file, LibRaw (rawpy) with the camera's white balance,
once cutting highlights and once blending them.

- ramps: 24 colours (twelve hues, two strengths) that grow brighter until every channel is clipped. The largest step in
  dE2000 within 0.055 stops from a stop below clipping on, the mean of the largest of each colour, and the mean of how far the
  hue (Oklab) goes from that of two stops below.
- edges: a slanted edge, blurred by 0.5 and 0.8 pixels. MTF50 in cycles a pixel (0.316 and 0.221 is what the sensor saw) and
  the overshoot. What a developer makes of light is undone by a grey ramp in the same picture.
- smooth: how far a smooth scene of a sensor of 3750 electrons (60000, four stops pushed) is from the same without noise, in
  dB of what is shown.
- scenes, with --scenes: a sunset, a lamp in a dark room, snow in the sun and blue diodes, for the eye: PNG files in --work.
- FILES of --raw: mean L* less that of the embedded preview; --clipped: a* and b* of what is brighter than L* 90.

Needs numpy, scipy, tifffile and Pillow; rawpy for LibRaw.
"""
import argparse
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import tifffile
from PIL import Image
from scipy.special import erf

sys.path.insert(0, str(Path(__file__).parent))
from brightness import lightness, reduced  # noqa: E402
from denoise import CAMERA, SRGB, bayer, de2000, decode, exposed, lab, mosaic, smooth_scene, write_dng  # noqa: E402

STOPS, COLUMNS, STEP = (-2.5, 4.5), 72, 4
BAND, GAP = 48, 16
OKLAB = (
    np.array([[0.8189330101, 0.3618667424, -0.1288597137], [0.0329845436, 0.9293118715, 0.0361456387], [0.0482003018, 0.2643662691, 0.6338517070]]),
    np.array([[0.2104542553, 0.7936177850, -0.0040720468], [1.9779984951, -2.4285922050, 0.4505937099], [0.0259040371, 0.7827717662, -0.8086757660]]),
)


def developers(darkroot):
    """Names of the developers that are here, and what makes a picture in sRGB, 0 to 1."""
    found = {"Darkroot": lambda raw, work: by_darkroot(darkroot, raw, work)}
    if shutil.which("rawtherapee-cli"):
        found["RawTherapee"] = by_rawtherapee
    if shutil.which("darktable-cli"):
        found["darktable"] = by_darktable
    try:
        import rawpy

        found["LibRaw, cut"] = lambda raw, work: by_libraw(rawpy, raw, rawpy.HighlightMode.Clip)
        found["LibRaw, blended"] = lambda raw, work: by_libraw(rawpy, raw, rawpy.HighlightMode.Blend)
    except ImportError:
        print("LibRaw is left out: there is no rawpy")
    return found


def run(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"{command[0]} failed: {(done.stdout + done.stderr).strip()[-200:]}")


def read(path):
    pixels = tifffile.imread(path)[..., :3]
    return pixels / np.iinfo(pixels.dtype).max


def by_darkroot(program, raw, work):
    out = work / "darkroot.tif"
    run(program, "develop", raw, "-o", out, "--bits", "16", "--overwrite", "-q")
    return read(out)


def by_rawtherapee(raw, work):
    out = work / "rawtherapee.tif"
    run("rawtherapee-cli", "-Y", "-d", "-t", "-b16", "-o", out, "-c", raw)
    return read(out)


def by_darktable(raw, work):
    out = work / "darktable.tif"
    out.unlink(missing_ok=True)
    options = ["--configdir", work / "darktable", "--library", ":memory:", "--conf", "plugins/imageio/format/tiff/bpp=16"]
    run("darktable-cli", raw, out, "--icc-type", "SRGB", "--core", *options)
    return read(out)


def by_libraw(rawpy, raw, mode):
    try:
        with rawpy.imread(str(raw)) as opened:
            return opened.postprocess(use_camera_wb=True, output_bps=16, no_auto_bright=True, highlight_mode=mode) / 65535
    except rawpy.LibRawError as e:
        raise RuntimeError(f"LibRaw: {e}") from e


def whole_white():
    """Camera RGB of white, its largest channel 1."""
    neutral = CAMERA @ SRGB @ np.ones(3)
    return neutral / neutral.max()


def ramps(work):
    """A DNG of ramps, and the rows of each that are far from its edges."""
    neutral = whole_white()
    stops = STOPS[0] + np.arange(int((STOPS[1] - STOPS[0]) * COLUMNS)) / COLUMNS
    light, rows = [np.zeros((GAP, stops.size, 3))], []
    for strength in (0.4, 0.7):
        for hue in np.arange(12) * np.pi / 6:
            colour = neutral * (1 + strength * np.cos(hue - np.arange(3) * 2 * np.pi / 3))
            ramp = np.exp2(stops)[:, None] * colour / colour.max()
            top = sum(len(v) for v in light)
            rows.append(slice(top + 12, top + BAND - 12))
            light += [np.repeat(ramp[None], BAND, 0), np.zeros((GAP, stops.size, 3))]
    light = np.concatenate(light)
    raw = work / "ramps.dng"
    write_dng(raw, exposed(bayer(light), 1, 0, None), neutral)
    return raw, stops, rows


def oklab(rgb):
    return np.cbrt(decode(rgb) @ (OKLAB[0] @ SRGB).T) @ OKLAB[1].T


def of_ramps(picture, stops, rows):
    steps, skews = [], []
    for band in rows:
        seen = picture[band].mean(0)
        seen = (np.cumsum(np.pad(seen, ((STEP, 0), (0, 0))), 0)[STEP:] - np.pad(np.cumsum(seen, 0), ((STEP, 0), (0, 0)))[:-STEP]) / STEP
        at, inner = stops - STEP / 2 / COLUMNS, slice(32, len(stops) - 32)
        seen, at = seen[inner], at[inner]
        colours = lab(seen)
        step = de2000(colours[:-STEP], colours[STEP:])
        steps.append(step[at[:-STEP] > -1].max())
        ok = oklab(seen)
        usual = ok[(at > -2.2) & (at < -1.8)].mean(0)
        turn = np.degrees(np.arctan2(ok[:, 2], ok[:, 1]) - np.arctan2(usual[2], usual[1]))
        turn = np.abs((turn + 180) % 360 - 180)
        coloured = (np.hypot(ok[:, 1], ok[:, 2]) > 0.02) & (at > -1.5)
        skews.append(turn[coloured].max() if coloured.any() else 0.0)
    return max(steps), np.mean(steps), np.mean(skews)


def edge(work, blur):
    """A DNG of a slanted edge between 10 and 30 % of white over a grey ramp."""
    height, width, slope = 512, 512, np.tan(np.radians(5))
    y, x = np.mgrid[0:height, 0:width]
    distance = (x - width / 2 - slope * (y - 192)) * np.cos(np.arctan(slope))
    # The mean over a pixel of an edge with a Gaussian blur, by its integral.
    integral = lambda d: d * 0.5 * (1 + erf(d / (blur * np.sqrt(2)))) + blur / np.sqrt(2 * np.pi) * np.exp(-(d**2) / (2 * blur**2))
    share = integral(distance + 0.5) - integral(distance - 0.5)
    grey = 0.1 + 0.2 * share
    grey[384:] = 0.02 + 0.6 * x[384:] / width
    raw = work / "edge.dng"
    write_dng(raw, exposed(bayer(grey[..., None] * whole_white()), 1, 0, None), whole_white())
    return raw, slope


def of_edge(picture, slope):
    """MTF50 in cycles a pixel, and the overshoot as a share of the edge."""
    light = decode(picture) @ SRGB[1]
    height, width = light.shape
    top, left = (512 - height) // 2, (512 - width) // 2
    ramp = light[height - 90 : height - 30].mean(0)
    known = 0.02 + 0.6 * (np.arange(width) + left) / 512
    order = np.argsort(ramp)
    light = np.interp(light[60:320], ramp[order], known[order])
    y, x = np.mgrid[60:320, 0:width]
    distance = (x + left - 256 - slope * (y + top - 192)) * np.cos(np.arctan(slope))
    near = np.abs(distance) < 32
    bins = np.floor(distance[near] * 4).astype(int) + 128
    profile = np.bincount(bins, light[near], 256) / np.maximum(np.bincount(bins, minlength=256), 1)
    return mtf50(profile), overshoot(profile)


def mtf50(profile):
    """Cycles a pixel at which half of the contrast of an edge is left; its profile is in quarters of a pixel, 256 of them."""
    mtf = np.abs(np.fft.rfft(np.gradient(profile) * np.hamming(256)))
    cycles = np.arange(len(mtf)) * 4 / 256
    # Of bins of a quarter of a pixel, and of the difference of neighbours.
    mtf[1:] /= np.sinc(cycles[1:] / 4) * np.sinc(cycles[1:] / 2)
    mtf /= mtf[0]
    last = np.argmax(mtf < 0.5)
    share = (mtf[last - 1] - 0.5) / (mtf[last - 1] - mtf[last])
    return cycles[last - 1] + share * (cycles[1] - cycles[0])


def overshoot(profile, seen=slice(None)):
    """How far such a profile goes beyond its ends where it is seen, as a share of the edge."""
    low, high = profile[20:60].mean(), profile[-60:-20].mean()
    return max(profile[seen].max() - high, low - profile[seen].min()) / (high - low)


def noise(develop, work):
    """dB between developed captures with noise and without."""
    light, neutral = mosaic(smooth_scene())
    raw, pictures = work / "smooth.dng", []
    for seed in (None, 5):
        write_dng(raw, exposed(0.55 * light, 60000 * 2.0**-4, 5, seed), neutral)
        pictures.append(develop(raw, work)[16:-16, 16:-16])
    return -10 * np.log10(((pictures[0] - pictures[1]) ** 2).mean())


def scenes():
    """Names of scenes that run into clipping, and their light, linear sRGB, 1 = where white clips."""
    height, width = 480, 720
    y, x = np.mgrid[0:height, 0:width] / width
    random = np.random.default_rng(3)
    grain = 1 + 0.06 * random.standard_normal((height, width, 1))
    near = lambda u, v: np.hypot(x - u, y - v)[..., None]

    sky = np.array([0.9, 0.35, 0.1]) * np.exp(-((y - 0.45) ** 2) / 0.03)[..., None] + np.array([0.10, 0.16, 0.32]) * (1 - y)[..., None]
    sun = np.array([1.0, 0.62, 0.25]) * (40 / (1 + np.exp((near(0.5, 0.42) - 0.03) * 400)) + 0.9 * np.exp(-near(0.5, 0.42) / 0.07))
    ground = y > 0.5 + 0.02 * np.sin(9 * x)
    yield "sunset", np.where(ground[..., None], 0.02 * grain * [1, 0.8, 0.7], sky + sun)

    wall = 0.05 * np.array([1.0, 0.75, 0.5]) * grain
    glow = np.array([1.0, 0.66, 0.33]) * (0.02 / (near(0.5, 0.25) ** 2 + 0.004))
    shade = (np.abs(x - 0.5) < 0.06 + 0.25 * np.maximum(y - 0.17, 0)) & (np.abs(y - 0.25) < 0.07)
    yield "lamp", wall + glow + np.where(shade[..., None], 6 * np.array([1.0, 0.72, 0.42]) * (1 - 3 * np.abs(x - 0.5)[..., None]), 0)

    slope = 0.75 + 0.35 * np.sin(14 * x + 6 * np.sin(7 * y)) * np.cos(11 * y)
    shadow = 1 / (1 + np.exp((slope - 0.55) * 25))[..., None]
    snow = slope[..., None] * ((1 - shadow) * np.array([1.15, 1.10, 1.0]) + 0.45 * shadow * np.array([0.75, 0.9, 1.25]))
    blue = np.array([0.20, 0.42, 0.85]) * (1 - 0.4 * y)[..., None]
    yield "snow", np.where((y < 0.2 + 0.03 * np.sin(6 * x))[..., None], blue, 1.1 * snow * (1 + 0.15 * (grain - 1)))

    room = 0.03 * np.array([0.8, 0.85, 1.0]) * grain
    diodes = sum(8 * np.exp(-((near(u, 0.22) / 0.008) ** 2)) + 0.6 * np.exp(-near(u, 0.22) / 0.05) for u in np.linspace(0.1, 0.9, 9))
    colours = np.where((x < 0.35)[..., None], [0.05, 0.12, 1.0], np.where((x < 0.65)[..., None], [0.9, 0.05, 0.8], [1.0, 0.08, 0.04]))
    yield "diodes", room + diodes * colours


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--darkroot", required=True)
    parser.add_argument("--raw", type=Path, nargs="*", default=[])
    parser.add_argument("--clipped", type=Path)
    parser.add_argument("--scenes", action="store_true")
    parser.add_argument("--work", type=Path, help="keeps the files; without it they are deleted")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        work = arguments.work or Path(temporary)
        work.mkdir(exist_ok=True, parents=True)
        for name, develop in developers(arguments.darkroot).items():
            row(arguments, name, develop, work)


def row(arguments, name, develop, work):
    raw, stops, rows = ramps(work)
    print(f"{name:<16} ramps: step %.1f at most, %.2f in the mean, hue %.1f degrees;" % of_ramps(develop(raw, work), stops, rows), end="")
    for blur in (0.5, 0.8):
        raw, slope = edge(work, blur)
        print(f" edge {blur}: MTF50 %.3f, overshoot %.1f %%;" % tuple(np.array([1, 100]) * of_edge(develop(raw, work), slope)), end="")
    print(f" smooth {noise(develop, work):.1f} dB", flush=True)
    if arguments.scenes:
        for scene, light in scenes():
            camera = 0.45 * light @ (CAMERA @ SRGB / (CAMERA @ SRGB @ np.ones(3)).max()).T
            raw = work / f"{scene}.dng"
            write_dng(raw, exposed(bayer(np.maximum(camera, 0)), 40000, 4, 7), whole_white())
            picture = Image.fromarray((255 * np.clip(develop(raw, work), 0, 1)).astype(np.uint8))
            picture.save(work / f"{scene}.{name.replace(', ', '-')}.png")
    for raw in arguments.raw:
        preview = work / "preview.jpg"
        preview.unlink(missing_ok=True)
        subprocess.run([arguments.darkroot, "inspect", str(raw), "--preview", str(preview)], capture_output=True)
        if not preview.exists():
            continue
        try:
            picture = Image.fromarray((255 * np.clip(develop(raw, work), 0, 1)).astype(np.uint8))
            out = work / f"{raw.stem}.{name.replace(', ', '-')}.png"
            picture.save(out)
            theirs = reduced(preview)
            off = lightness(reduced(out, theirs.size)).mean() - lightness(theirs).mean()
            print(f"    {raw.name}: L* {off:+.1f}", flush=True)
        except (RuntimeError, OSError) as e:
            print(f"    {raw.name}: {' '.join(str(e).split())}")
    if arguments.clipped:
        try:
            colours = lab(develop(arguments.clipped, work))
        except (RuntimeError, OSError) as e:
            print(f"    {arguments.clipped.name}: {' '.join(str(e).split())}")
            return
        bright = colours[colours[..., 0] > 90]
        print(f"    {arguments.clipped.name}: a* %.1f, b* %.1f of %d %% that is bright" % (*bright[:, 1:].mean(0), 100 * len(bright) / colours[..., 0].size))


if __name__ == "__main__":
    main()
