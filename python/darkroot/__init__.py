"""Develop raw photographs: arrays in and out, colour from profiles, folders of any size.

>>> import darkroot
>>> with darkroot.open(sample) as photo:
...     picture = photo.develop(look="vivid")        # uint8, sRGB, height x width x 3
...     light = photo.develop(look="linear")         # float32, proportional to the light of the scene
>>> darkroot.develop_file(sample, "picture.jpg", overwrite=True)["colours"]
"estimated from the camera's matrix (expected dE2000 1.3)"

Everything is told by :class:`Error` and those made from it, which say whose fault it was. ``help(darkroot.settings)`` tells
where the keywords come from.
"""

# It refuses interpreters in which neither this nor numpy could work, before anything else is loaded.
from . import _interpreter as _interpreter

# isort: split
import atexit as _atexit

from . import _core
from ._batch import Summary, batch
from ._chart import (
    FoundChart,
    MadeProfile,
    MeasuredChart,
    detect_charts,
    make_profile,
    measure_chart,
    verify,
)
from ._core import Cancel, Recipe
from ._core import __version__ as __version__
from ._develop import camera_rgb, develop, develop_file, inspect, settings
from ._errors import (
    Cancelled,
    ChartError,
    Error,
    ExistsError,
    FileError,
    MissingError,
    ProfileError,
    SettingsError,
    StorageError,
    UnsupportedError,
)
from ._many import Developed, develop_many
from ._photo import Photo, open
from ._profile import Profile, fit_profile, from_matrix, from_spectra

#: Endings of raw files in lower case, without the dot.
ENDINGS = tuple(_core.endings())

_atexit.register(_core.abandon)

__all__ = [
    "Cancel",
    "Cancelled",
    "ChartError",
    "ENDINGS",
    "Developed",
    "Error",
    "ExistsError",
    "FileError",
    "FoundChart",
    "MadeProfile",
    "MeasuredChart",
    "MissingError",
    "Photo",
    "Profile",
    "ProfileError",
    "Recipe",
    "SettingsError",
    "StorageError",
    "Summary",
    "UnsupportedError",
    "batch",
    "camera_rgb",
    "detect_charts",
    "develop",
    "develop_file",
    "develop_many",
    "fit_profile",
    "from_matrix",
    "from_spectra",
    "inspect",
    "make_profile",
    "measure_chart",
    "open",
    "settings",
    "verify",
]
