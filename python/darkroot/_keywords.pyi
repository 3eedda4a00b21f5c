"""Types of the settings. Written by python/build/keywords.py from the table of settings; not by hand."""

import os
from collections.abc import Sequence
from typing import Literal, TypedDict

from . import Profile

class Settings(TypedDict, total=False):
    format: Literal["auto", "jpeg", "png", "tiff", "webp", "avif", "exr", "jxl", "dng"] | None
    space: str | float | Sequence[float] | None
    bits: Literal["auto", 8, 16, 32] | None
    quality: int | None
    chroma: Literal[444, 422, 420] | None
    progressive: bool | None
    hdr: str | float | Sequence[float] | None
    compression: Literal["deflate", "none"] | None
    webp: Literal["lossless", "lossy"] | None
    metadata: Literal["all", "no-gps", "basic", "none"] | None
    artist: str | float | Sequence[float] | None
    copyright: str | float | Sequence[float] | None
    set_tag: str | float | Sequence[float] | None
    exposure: float | None
    auto_exposure: bool | None
    exposure_from_chart: str | os.PathLike[str] | None
    black_from_chart: bool | None
    chart_layout: str | os.PathLike[str] | None
    chart_reference: str | os.PathLike[str] | None
    dpi: str | float | Sequence[float] | None
    white_balance: str | float | Sequence[float] | None
    look: Literal["neutral", "vivid", "flat", "camera", "dcp", "reproduction", "linear"] | None
    gamut: Literal["auto", "clip", "map"] | None
    contrast: float | None
    shadows: float | None
    highlights_tone: float | None
    black: float | None
    white: float | None
    curve: str | float | Sequence[float] | None
    saturation: float | None
    vibrance: float | None
    lut: str | os.PathLike[str] | None
    lut_space: str | float | Sequence[float] | None
    dark: str | os.PathLike[str] | None
    flat: str | os.PathLike[str] | None
    highlights: Literal["rebuild", "clip", "keep"] | None
    local_tone: Literal["auto", "off"] | None
    hot_pixels: Literal["auto", "off"] | None
    banding: Literal["auto", "off"] | None
    denoise: str | float | Sequence[float] | None
    denoise_luma: float | None
    denoise_chroma: float | None
    sharpen: str | float | Sequence[float] | None
    demosaic: Literal["best", "bilinear"] | None
    rotate: Literal[0, 90, 180, 270] | None
    flip: Literal["off", "horizontal", "vertical"] | None
    straighten: str | float | Sequence[float] | None
    perspective: str | float | Sequence[float] | None
    lens: Literal["auto", "file", "lensfun", "maker", "off"] | None
    lens_name: str | float | Sequence[float] | None
    vignetting: bool | None
    ca: bool | None
    crop: str | float | Sequence[float] | None
    resize: str | float | Sequence[float] | None
    enlarge: bool | None
    profile: str | os.PathLike[str] | Profile | None
    illuminant: str | float | Sequence[float] | None
    from_preview: bool | None
    engine: Literal["darkroot", "imagepipe"] | None
    decoder: Literal["flashraw", "rawloader"] | None
