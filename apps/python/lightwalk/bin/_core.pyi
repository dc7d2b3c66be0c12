"""What the package uses of the extension module. Arrays go in as buffers of doubles or floats, rows one after the other."""

from typing import Any, Callable, Sequence

import numpy as np

version: str
Words = Sequence[str]
Listener = Callable[[float, int, float, float | None], Any] | None

class OfferedOption:
    @property
    def name(self) -> str: ...
    @property
    def words(self) -> str: ...
    @property
    def text(self) -> str: ...
    @property
    def value(self) -> str: ...
    @property
    def is_switch(self) -> bool: ...

class Floats:
    """A buffer of float32."""
    def __len__(self) -> int: ...
    def __buffer__(self, flags: int, /) -> memoryview: ...

class Doubles:
    """A buffer of float64."""
    def __len__(self) -> int: ...
    def __buffer__(self, flags: int, /) -> memoryview: ...

class Integers:
    """A buffer of int32."""
    def __len__(self) -> int: ...
    def __buffer__(self, flags: int, /) -> memoryview: ...

class SceneSource:
    files: list[str]
    bytes: bytes
    name: str
    library: list[str]
    allow_commands: bool
    allow_stale: bool
    threads: int

class Scene:
    def __init__(self, source: SceneSource) -> None: ...
    def take_warnings(self) -> list[str]: ...
    def surface_names(self, numbers: Sequence[int]) -> list[str]: ...
    def digest(self) -> str: ...
    def bounds(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]: ...

class Picture:
    width: int
    height: int
    radiance: Floats
    distance: Floats
    error: Floats
    layers: dict[str, Floats]
    rays: int
    view: str

class PictureMaker:
    def __init__(self, scene: Scene, command: str, words: Words, with_distances: bool, listener: Listener) -> None: ...
    def make(self) -> Picture: ...
    def make_changed(self, view: Words) -> Picture: ...
    def make_frame(self, number: int) -> Picture: ...
    def path_length(self) -> int: ...
    def take_warnings(self) -> list[str]: ...

class Rays:
    radiance: Floats
    distance: Doubles
    position: Doubles
    normal: Doubles
    surface: Integers

class Contributions:
    modifiers: list[tuple[str, int]]
    numbers: Doubles

class GlareSource:
    luminance: float
    solid_angle: float
    position_index: float
    direction: tuple[float, float, float]

class GlareReport:
    dgp: float
    low_light_correction: float
    within_assessments: bool
    vertical_illuminance: float
    average_luminance: float
    sources: list[GlareSource]

def offered_options(command: str) -> list[OfferedOption]: ...
def freeze(source: SceneSource, path: str) -> list[str]: ...
def view_text(words: Words) -> str: ...
def save(path: str, pixels: np.ndarray, width: int, height: int, header: Words) -> None: ...
def trace(scene: Scene, words: Words, rays: np.ndarray, sensor: bool, shade: bool, surfaces: bool, listener: Listener) -> tuple[Rays, list[str]]: ...
def contrib(scene: Scene, words: Words, rays: np.ndarray, sensor: bool, listener: Listener) -> tuple[Contributions, list[str]]: ...
def glare(pixels: np.ndarray, width: int, height: int, view: str, threshold: float) -> GlareReport: ...
