"""RawTherapee as it shows the colours of a camera profile alone: no curve, no look. Used by dcp.py and linear_dng.py."""
import subprocess

import numpy as np

# Programs that are needed, and Debian's packages of them.
TOOLS = {"rawtherapee-cli": "rawtherapee", "transicc": "liblcms2-utils"}
OUTPUT = "/usr/share/rawtherapee/iccprofiles/output/RTv4_Large.icc"
RECIPE = """[Version]
AppVersion=5.9
Version=349
[Exposure]
Auto=false
HistogramMatching=false
[HLRecovery]
Enabled=false
[White Balance]
Enabled=true
Setting=Camera
[Color Management]
InputProfile={profile}
ToneCurve=false
ApplyLookTable=false
ApplyBaselineExposureOffset=false
ApplyHueSatMap={table}
DCPIlluminant=0
WorkingProfile=ProPhoto
OutputProfile=RTv4_Large
OutputProfileIntent=Relative
OutputBPC=false
[RAW]
CA=false
HotPixelFilter=false
DeadPixelFilter=false
[RAW Bayer]
Method=fast
"""


def develop(raw, out, profile, table="true"):
    """A TIFF of a raw file by a profile (`file:PATH`, or `(embedded)`), with its table or without; 16 bits, for `xyz`."""
    recipe = out.with_suffix(".pp3")
    recipe.write_text(RECIPE.format(profile=profile, table=table))
    command = ["rawtherapee-cli", "-Y", "-o", out, "-p", recipe, "-t", "-b16", "-c", raw]
    subprocess.run(command, check=True, capture_output=True)


def xyz(rgb):
    """XYZ relative to D50 of rows of such a TIFF's numbers, 0 to 1."""
    lines = "".join(f"{r:.9g} {g:.9g} {b:.9g}\n" for r, g, b in 255 * rgb)
    command = ["transicc", "-n", "-c0", "-t1", "-i", OUTPUT, "-o", "*XYZ"]
    out = subprocess.run(command, input=lines, capture_output=True, text=True, check=True).stdout
    return np.array([[float(v) for v in line.split()] for line in out.split("\n") if line.strip()]) / 100
