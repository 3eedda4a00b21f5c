"""Types of the package. What things do, shapes and units stand in the docstrings."""

import os
import pathlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from types import TracebackType
from typing import Any, BinaryIO, Literal, TypeAlias, final

import numpy
from numpy.typing import ArrayLike, DTypeLike, NDArray
from typing_extensions import Self, Unpack

from ._keywords import Settings

__version__: str
ENDINGS: tuple[str, ...]

Path: TypeAlias = str | os.PathLike[str]
Region: TypeAlias = tuple[int, int, int, int]
RecipeLike: TypeAlias = Recipe | Mapping[str, Any] | Path
When: TypeAlias = Literal["auto", "always", "never"]

class Error(Exception): ...
class FileError(Error, ValueError): ...
class UnsupportedError(FileError): ...
class SettingsError(Error, ValueError): ...
class ProfileError(Error, ValueError): ...
class ChartError(Error, ValueError): ...
class StorageError(Error, OSError): ...
class MissingError(StorageError, FileNotFoundError): ...
class ExistsError(StorageError, FileExistsError): ...
class Cancelled(Error): ...

@final
class Cancel:
    def __init__(self) -> None: ...
    def cancel(self) -> None: ...
    @property
    def cancelled(self) -> bool: ...

@final
class Recipe(Mapping[str, Any]):
    def __init__(self, **settings: Unpack[Settings]) -> None: ...
    @classmethod
    def load(cls, path: Path) -> Recipe: ...
    @classmethod
    def from_toml(cls, text: str) -> Recipe: ...
    def save(self, path: Path, *, overwrite: bool = False) -> None: ...
    def to_toml(self) -> str: ...
    def __getitem__(self, name: str) -> Any: ...
    def __iter__(self) -> Iterator[str]: ...
    def __len__(self) -> int: ...
    def __or__(self, other: RecipeLike) -> Recipe: ...
    def __hash__(self) -> int: ...

class Photo:
    @property
    def name(self) -> pathlib.Path: ...
    @property
    def camera(self) -> str: ...
    @property
    def mosaic(self) -> NDArray[numpy.uint16] | NDArray[numpy.float32]: ...
    @property
    def active(self) -> NDArray[numpy.uint16] | NDArray[numpy.float32]: ...
    @property
    def active_area(self) -> Region: ...
    @property
    def crop(self) -> Region: ...
    @property
    def orientation(self) -> int: ...
    @property
    def cfa(self) -> str | None: ...
    @property
    def black(self) -> NDArray[numpy.float32]: ...
    @property
    def white(self) -> NDArray[numpy.float32]: ...
    @property
    def notes(self) -> list[str]: ...
    @property
    def metadata(self) -> dict[str, Any]: ...
    def preview(self) -> bytes | None: ...
    def light(self, *, threads: int | None = None) -> NDArray[numpy.float32]: ...
    def develop(
        self,
        *,
        dtype: DTypeLike | None = None,
        scale: float = 1,
        region: Region | None = None,
        recipe: RecipeLike | None = None,
        threads: int | None = None,
        cancel: Cancel | None = None,
        **settings: Unpack[Settings],
    ) -> NDArray[Any]: ...
    def camera_rgb(
        self,
        *,
        scale: float = 1,
        region: Region | None = None,
        threads: int | None = None,
        cancel: Cancel | None = None,
        **settings: Unpack[Settings],
    ) -> NDArray[numpy.float32]: ...
    def explain(
        self, *, recipe: RecipeLike | None = None, threads: int | None = None, **settings: Unpack[Settings]
    ) -> dict[str, Any]: ...
    def inspect(self, *, threads: int | None = None) -> dict[str, Any]: ...
    def to_xarray(self, **arguments: Any) -> Any: ...
    def close(self) -> None: ...
    def __enter__(self) -> Self: ...
    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None: ...

def open(
    source: Path | bytes | bytearray | memoryview | BinaryIO,
    *,
    decoder: Literal["flashraw", "rawloader"] = "flashraw",
    threads: int | None = None,
    cancel: Cancel | None = None,
) -> Photo: ...
def develop(
    path: Path | bytes | BinaryIO,
    *,
    dtype: DTypeLike | None = None,
    scale: float = 1,
    region: Region | None = None,
    recipe: RecipeLike | None = None,
    threads: int | None = None,
    cancel: Cancel | None = None,
    **settings: Unpack[Settings],
) -> NDArray[Any]: ...
def camera_rgb(
    path: Path | bytes | BinaryIO,
    *,
    scale: float = 1,
    region: Region | None = None,
    threads: int | None = None,
    cancel: Cancel | None = None,
    **settings: Unpack[Settings],
) -> NDArray[numpy.float32]: ...
def develop_file(
    src: Path,
    dst: Path,
    *,
    overwrite: bool = False,
    recipe: RecipeLike | None = None,
    folders: bool = False,
    threads: int | None = None,
    cancel: Cancel | None = None,
    **settings: Unpack[Settings],
) -> dict[str, Any]: ...
def inspect(path: Path | bytes | BinaryIO, *, threads: int | None = None) -> dict[str, Any]: ...
def settings() -> list[dict[str, Any]]: ...

class Developed:
    path: Any
    picture: NDArray[Any] | None
    error: Error | None
    def get(self) -> NDArray[Any]: ...

def develop_many(
    paths: Iterable[Any], *, workers: int | None = None, threads: int = 1, **arguments: Any
) -> Iterator[Developed]: ...

class Summary:
    done: int
    failed: int
    skipped: int
    left: int
    failures: list[dict[str, Any]]
    faults: list[str]
    stopped: str | None
    interrupted: bool
    pixels: int
    seconds: float
    peak_memory: int

def batch(
    inputs: Path | Sequence[Path],
    out: Path,
    *,
    on_event: Callable[[dict[str, Any]], object] | None = None,
    recipe: RecipeLike | None = None,
    folders: bool = True,
    name: str | None = None,
    on_collision: Literal["refuse", "suffix"] = "refuse",
    overwrite: bool = False,
    redo: bool = False,
    verify: bool = False,
    recursive: bool = True,
    include: str | Iterable[str] = (),
    exclude: str | Iterable[str] = (),
    shard: str | None = None,
    workers: Literal["processes", "threads"] = "processes",
    jobs: int | None = None,
    threads: int | None = None,
    memory: int | None = None,
    timeout: float = 600,
    **settings: Unpack[Settings],
) -> Summary: ...

class Profile:
    def __init__(self, text: str) -> None: ...
    @classmethod
    def load(cls, name: Path) -> Self: ...
    @classmethod
    def from_text(cls, text: str) -> Self: ...
    def to_text(self) -> str: ...
    def save(self, path: Path, *, overwrite: bool = False) -> None: ...
    @property
    def camera(self) -> str: ...
    @property
    def lights(self) -> list[str]: ...
    @property
    def is_camera(self) -> bool: ...
    @property
    def origin(self) -> dict[str, str]: ...
    def apply(self, rgb: ArrayLike, light: str | None = None) -> NDArray[numpy.float64]: ...
    def __call__(self, rgb: ArrayLike, light: str | None = None) -> NDArray[numpy.float64]: ...
    def figures(self, light: str | None = None) -> dict[str, Any]: ...
    def patches(self, light: str | None = None) -> list[dict[str, Any]]: ...
    def lint(self) -> list[dict[str, Any]]: ...
    def export(
        self,
        path: Path,
        *,
        light: str | Sequence[str] | None = None,
        raw: Path | None = None,
        neutral: ArrayLike | None = None,
        space: str | None = None,
        shaper: Literal["sqrt", "none"] = "sqrt",
        grid: int = 33,
        icc_version: Literal[2, 4] = 4,
        overwrite: bool = False,
    ) -> list[dict[str, Any]]: ...

def fit_profile(
    rgb: ArrayLike,
    xyz: ArrayLike | None = None,
    *,
    reflectance: ArrayLike | None = None,
    wavelengths: ArrayLike | None = None,
    light: str = "D50",
    camera: str = "",
    model: str | None = None,
    names: Iterable[str] | None = None,
    date: str = "",
) -> Profile: ...
def from_matrix(camera: Path) -> Profile: ...
def from_spectra(
    sensitivities: Path | ArrayLike,
    *,
    camera: str,
    wavelengths: ArrayLike | None = None,
    lights: Iterable[str] = (),
    reflectances: Iterable[Path] = (),
    held_out: Iterable[Path] = (),
    model: str | None = None,
    date: str = "",
) -> Profile: ...

class FoundChart:
    chart: str
    confidence: float
    corners: NDArray[numpy.float64]
    patches: NDArray[numpy.float64]
    rotation_degrees: float
    patch_pixels: float

class MeasuredChart:
    camera: str
    names: list[str]
    rgb: NDArray[numpy.float64]
    uncertainty: NDArray[numpy.float64]
    xyz: NDArray[numpy.float64]
    excluded: list[str | None]
    gates: list[dict[str, Any]]
    corners: NDArray[numpy.float64]
    confidence: float
    notes: list[str]
    @property
    def used(self) -> NDArray[numpy.bool_]: ...

class MadeProfile:
    profile: Profile
    report: str
    lights: list[dict[str, Any]]
    shots: list[MeasuredChart]

def detect_charts(source: Path | ArrayLike, *, charts: Sequence[str] | None = None) -> list[FoundChart]: ...
def measure_chart(
    path: Path,
    chart: Path = "classic24",
    reference: Path | None = None,
    *,
    corners: ArrayLike | None = None,
    flat: Path | None = None,
    dark: Path | None = None,
    even_out: When = "auto",
    correct_glare: When = "auto",
    exclude: Iterable[str] = (),
    accept: bool = False,
    allow_rendered: bool = False,
) -> MeasuredChart: ...
def make_profile(
    shots: Path | Sequence[Path],
    *,
    light: str | Sequence[str],
    chart: Path = "classic24",
    reference: Path | None = None,
    average: bool = False,
    as_camera: bool = False,
    model: str | None = None,
    date: str = "",
    corners: ArrayLike | None = None,
    flat: Path | None = None,
    dark: Path | None = None,
    even_out: When = "auto",
    correct_glare: When = "auto",
    exclude: Iterable[str] = (),
    accept: bool = False,
    allow_rendered: bool = False,
) -> MadeProfile: ...
def verify(
    path: Path,
    *,
    profile: Profile | Path | None = None,
    light: str | None = None,
    preset: str | None = None,
    chart: Path = "classic24",
    reference: Path | None = None,
    corners: ArrayLike | None = None,
    flat: Path | None = None,
    dark: Path | None = None,
    even_out: When = ...,
    correct_glare: When = ...,
    exclude: Iterable[str] = (),
    accept: bool = False,
    allow_rendered: bool = False,
) -> dict[str, Any]: ...
