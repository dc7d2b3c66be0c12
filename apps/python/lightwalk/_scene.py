"""Scenes, and what light does in them."""

from __future__ import annotations

import dataclasses
import os
import pathlib
import re
import threading
import warnings
from numbers import Integral
from typing import Any, Callable, Iterable, Iterator, Mapping, Sequence, Sized, Union

import numpy as np

from . import _arrays
from ._builder import TEXT_NAME, Builder
from ._errors import InputError, LightwalkWarning, OptionError
from ._options import words_of
from ._view import ViewLike, view_words
from .bin import _core

SHARE = pathlib.Path(__file__).parent / "share" / "lightwalk"  # what the package installs

Size = Union[int, Sequence[int]]
Progress = Union[Callable[[float], Any], bool, None]


@dataclasses.dataclass(frozen=True)
class Picture:
    """What `Scene.picture` makes.

    Attributes:
        radiance: float32 (height, width, 3), rows from the top: red, green, blue [W/(m² sr)]
        distance: float32 (height, width) along the pixels' rays [m]; 1e10: nothing is there; None: not asked for
        error: float32 (height, width), with the options `error` and `time`: of luminance, relative; else None
        layers: with the option `light_group`, what each group of lights adds to the radiance, by their names
        view: as a text, which `render` takes
        rays: that were traced, of all kinds
    """

    radiance: np.ndarray
    distance: np.ndarray | None
    error: np.ndarray | None
    layers: Mapping[str, np.ndarray]
    view: str
    rays: int

    def save(self, file: Any) -> None:
        """To a file, see `save_picture`."""
        save_picture(file, self.radiance, view=self.view)


@dataclasses.dataclass(frozen=True)
class Rays:
    """What `Scene.trace` finds for n rays.

    Attributes:
        radiance: float32 (n, 3) [W/(m² sr)]; with irradiance=True [W/m²]
        distance: float64 (n) to what the ray meets first [m]; 1e10: nothing
        position: float64 (n, 3), where that is [m]; None: not asked for
        normal: float64 (n, 3) of the surface there, to its front; 0 where there is none; None: not asked for
        surface: (n), its name; "" where there is none; None: not asked for
        half_width: float32 (n, 3): how far the 95 % interval of each radiance reaches to both sides; None: not asked for
    """

    radiance: np.ndarray
    distance: np.ndarray
    position: np.ndarray | None
    normal: np.ndarray | None
    surface: np.ndarray | None
    half_width: np.ndarray | None = None


class Scene(Builder):
    """A scene: from files, from bytes, or built in code.

        scene = lightwalk.Scene.from_files("room.rad", "sky.rad")
        picture = scene.render(lightwalk.View((2, 1, 1.6), (0, 1, 0)), size=(640, 480), ab=2)

        scene = lightwalk.Scene()
        wall = scene.plastic("wall", (.5, .5, .5))
        scene.polygon(wall, [(0, 0, 0), (4, 0, 0), (4, 3, 0), (0, 3, 0)])

    Scenes are read and compiled when they are first used, or by `load`; any number of them may be open, and threads may use one, or
    several, at once. Options are keyword arguments named as the command's: `ab=2` is -ab 2, `sample_lights=4` --sample-lights 4,
    `as_=64` -as 64; `lightwalk.options("render")` lists them. All methods that compute let other threads of Python go on, and end at
    Ctrl-C.

    Args:
        library: folders of function files and the like, before Lightwalk's own; None: those of the environment variable RAYPATH
        allow_commands: run commands in scene files that no built-in one replaces
        threads: that compile the scene; 0: one for each processor
    """

    def __init__(self, *, library: Iterable[Any] | None = None, allow_commands: bool = False, threads: int = 0) -> None:
        super().__init__()
        source = _core.SceneSource()
        source.name = TEXT_NAME
        source.allow_commands = bool(allow_commands)
        source.threads = _count("threads", threads, 0, 4096)
        if library is not None:
            source.library = [*(_file(folder) for folder in _arrays.few("library", library, 1000)), str(SHARE / "lib")]
        self._source = source
        self._lock = threading.Lock()
        self._loaded: Any = None
        self._built = True

    @classmethod
    def from_files(cls, *files: Any, allow_stale: bool = False, **more: Any) -> "Scene":
        """Scene files in order; the first one may be an octree or a frozen scene, to which the others are added.

        Args:
            allow_stale: take a frozen scene whose files have changed since
            more: see `Scene`
        Raises:
            InputError: a scene without files; what is wrong in them is told when the scene is first used
        """
        if not files:
            raise InputError("a scene of files without files")
        scene = cls(**more)
        scene._source.files = [_file(file) for file in files]
        scene._source.allow_stale = bool(allow_stale)
        scene._built = False
        return scene

    @classmethod
    def from_bytes(cls, data: Any, name: str = "memory", **more: Any) -> "Scene":
        """The bytes of an octree or a frozen scene, or the text of a scene file (a str, too).

        Args:
            name: how messages call it
            more: see `Scene`
        """
        scene = cls(**more)
        scene._source.bytes = data.encode() if isinstance(data, str) else _bytes(data)
        scene._source.name = str(name)
        scene._built = False
        return scene

    def _changed(self) -> None:
        if not self._built:
            raise InputError("a scene of files or bytes is read as it is: build one in code, and include() the files")
        self._loaded = None

    def _complete_source(self) -> Any:
        if self._built:
            if not self._pieces:
                raise InputError("the scene is empty")
            self._source.bytes = "".join(self._pieces).encode()
        return self._source

    def load(self) -> "Scene":
        """Reads and compiles the scene now, if that was not done before.

        Returns:
            the scene
        Raises:
            InputError: with a line "file:line: what is wrong" for each problem
        """
        self._compiled()
        return self

    def _compiled(self) -> Any:
        with self._lock:
            if self._loaded is None:
                try:
                    self._loaded = _core.Scene(self._complete_source())
                except InputError as error:
                    raise InputError(self._described(str(error))) from None
                self._warn(self._loaded.take_warnings())
            return self._loaded

    def _warn(self, messages: Iterable[str]) -> None:
        for message in messages:
            warnings.warn(self._described(message), LightwalkWarning, stacklevel=4)

    @property
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """The corners of the box around all surfaces that are finite [m]; lower > upper where there are none."""
        lower, upper = self._compiled().bounds()
        return np.array(lower), np.array(upper)

    @property
    def digest(self) -> str:
        """Of all that was read: equal for equal files."""
        return str(self._compiled().digest())

    def freeze(self, file: Any) -> None:
        """Writes a scene of files to one file that is mapped rather than read (`lightwalk freeze`)."""
        if self._built or not self._source.files:
            raise InputError("a scene that is frozen consists of files")
        self._warn(_core.freeze(self._source, _file(file)))

    def picture(self, view: ViewLike = None, size: Size = 512, *, distance: bool = False, progress: Progress = None,
                **options: Any) -> Picture:
        """As `render`, with all that a picture can hold.

        Args:
            distance: whether distances are wanted; where pixels are interpolated they count then, as with the command's -z
        """
        words = [*words_of("render", options), *_size_words(size), *view_words(view)]
        with _Listener(progress, "render") as listener:
            maker = _core.PictureMaker(self._compiled(), "render", words, bool(distance), listener)
            made = maker.make()
        self._warn(maker.take_warnings())
        return _picture(made, distance)

    def render(self, view: ViewLike = None, size: Size = 512, *, progress: Progress = None, **options: Any) -> np.ndarray:
        """A picture, the same to the bit as that of `lightwalk render`.

        Args:
            view: a View, a text of options ("-vp 0 0 1.6 -vd 0 1 0"), the name of a view file, or None: what the options vp, vd ...
                say
            size: largest width and height [pixels], as -x and -y: the picture has the view's shape; exactly this size with pa=0
            progress: a function that is called with the share that is done, 0 to 1; True: a bar, where tqdm is installed
            options: those of `lightwalk render`: ab=2, samples=16, error=.05 ...
        Returns:
            float32 (height, width, 3), rows from the top: red, green, blue [W/(m² sr)]
        Raises:
            InputError: what is wrong with the scene or the view
            OptionError: what is wrong with the options
        """
        return self.picture(view, size, progress=progress, **options).radiance

    def animate(self, views: Iterable[ViewLike] | None = None, size: Size = 512, *, view: ViewLike = None, progress: Progress = None,
                **options: Any) -> Iterator[np.ndarray]:
        """The frames of a walk, one after the other, each from the points that those before it left.

        Args:
            views: of the frames, each a change of `view`; None: those of the options path="walk.vf", rotate=90 with frames=30, or walk="forward"
            view, size, progress: see `render`
            options: those of `lightwalk animate`; reuse="off" traces every pixel
        Yields:
            as `render` returns
        """
        words = [*words_of("animate", options), *_size_words(size), *view_words(view)]
        maker = _core.PictureMaker(self._compiled(), "animate", words, False, None)
        if views is None and maker.path_length() == 0:
            raise OptionError("animate: expected views, or one of the options path, rotate and walk")
        return self._frames(maker, views, progress)

    def _frames(self, maker: Any, views: Iterable[ViewLike] | None, progress: Progress) -> Iterator[np.ndarray]:
        total = maker.path_length() if views is None else len(views) if isinstance(views, Sized) else 0
        with _Listener(progress, "animate") as listener:
            frames = map(maker.make_frame, range(total)) if views is None else (maker.make_changed(view_words(one)) for one in views)
            for done, made in enumerate(frames, 1):
                self._warn(maker.take_warnings())
                if listener and total:
                    listener(done / total)
                yield _picture(made, False).radiance

    def trace(self, origins: Any, directions: Any, irradiance: bool = False, *, distance: bool = False, normal: bool = False,
              surface: bool = False, position: bool = False, shade: bool = True, interval: int = 0, progress: Progress = None,
              **options: Any) -> Any:
        """Single rays, as `lightwalk trace` answers them.

        Args:
            origins, directions: (n, 3), or three numbers for all; directions of any length [m]
            irradiance: origins are points and directions the normals there: what arrives from the half space, not the radiance
                along a ray
            distance, normal, surface, position: what is wanted beside the light
            shade: False: only what the rays meet is found, and all light is 0
            interval: 2 to 100: each ray is answered so many times, independently; the light is the mean, and comes with the
                half-width of its 95 % confidence interval (Student's t). 0: it is answered once
            options: those of `lightwalk trace`: ab=2, ad=1024 ...
        Returns:
            float32 (n, 3): radiance [W/(m² sr)], or irradiance [W/m²]; with `interval` a pair of it and its half-widths, of the same
            shape; where more is wanted, Rays
        Raises:
            InputError: arrays of other shapes, numbers that are not finite, and what is wrong with the scene
            OptionError: what is wrong with the options
        """
        rays = _arrays.rays(origins, directions)
        answers = _answers(interval)
        words = words_of("trace", options)
        scene = self._compiled()
        with _Listener(progress, "trace") as listener:
            found, messages = _core.trace(scene, words, rays, bool(irradiance), bool(shade), bool(normal or position), answers, listener)
        self._warn(messages)
        radiance = _array(found.radiance, (len(rays), 3))
        half_width = _array(found.half_width, (len(rays), 3)) if answers else None
        if not (distance or normal or surface or position):
            return (radiance, half_width) if answers else radiance
        names = None
        if surface:
            numbers, places = np.unique(_array(found.surface, (len(rays),)), return_inverse=True)
            names = np.array(scene.surface_names(numbers.tolist()) or [""])[places.reshape(-1)]
        return Rays(radiance, _array(found.distance, (len(rays),)), _array(found.position, (len(rays), 3)) if position else None,
                    _array(found.normal, (len(rays), 3)) if normal else None, names, half_width)

    def contrib(self, origins: Any, directions: Any, modifiers: Any, irradiance: bool = False, *, progress: Progress = None,
                **options: Any) -> dict[str, np.ndarray]:
        """What light sources bring to rays, as `lightwalk contrib` tells it.

        Args:
            origins, directions, irradiance: see `trace`
            modifiers: a name, names, or for each name the expression of its bins and their number: {"sky": ("rbin", 146)}
            options: those of `lightwalk contrib`: f="reinhart.cal", e="MF:1", ab=2; V=True: radiance instead of coefficients
        Returns:
            for each modifier float64 (n, bins, 3): coefficients, which times the source's radiance are what it brings
        Raises:
            InputError, OptionError: see `trace`; modifiers that the scene does not have
        """
        rays = _arrays.rays(origins, directions)
        words = [*words_of("contrib", options), *_modifier_words(modifiers)]
        with _Listener(progress, "contrib") as listener:
            found, messages = _core.contrib(self._compiled(), words, rays, bool(irradiance), listener)
        self._warn(messages)
        columns = sum(bins for _, bins in found.modifiers)
        numbers = _array(found.numbers, (len(rays), columns, 3))
        ends = np.cumsum([bins for _, bins in found.modifiers])
        return {name: numbers[:, end - bins:end] for (name, bins), end in zip(found.modifiers, ends)}

    def walk(self, *views: ViewLike, port: int = 0, height: int = 600, embed: str | None = None, **options: Any) -> Any:
        """Serves a walk through the scene, and shows its page in a notebook's output cell.

        Args:
            views: for the page's list; the first is where the walk begins
            port: of the page; 0: any that is free
            height: of the cell [pixels]
            embed: origins of pages that may show it, with spaces between them; None: those of this machine
            options: those of `lightwalk walk`
        Returns:
            a Walk: its address, and stop(), which ends it
        """
        from ._walk import start_walk
        return start_walk(self, views, port, height, embed, options)


DEMO_FOLDER = SHARE / "scenes" / "lodge"


def demo_scene(night: bool = False) -> Scene:
    """The demonstration scene, a lodge in the mountains, by day or in the evening."""
    return Scene.from_files(DEMO_FOLDER / "lodge.rad", DEMO_FOLDER / ("night.rad" if night else "day.rad"), library=[DEMO_FOLDER])


def demo_views() -> dict[str, pathlib.Path]:
    """The views of the demonstration scene by their names, which `render` takes: demo_scene().render(demo_views()["living"])."""
    return {file.stem: file for file in sorted((DEMO_FOLDER / "views").glob("*.vf")) if file.stem != "walk"}


def save_picture(file: Any, radiance: Any, *, view: ViewLike = None, header: Iterable[str] = ()) -> None:
    """Writes a picture by the ending of its name: .hdr .pic (Radiance), .exr, .png, .jpg (exposed automatically, sRGB).

    Args:
        radiance: (height, width, 3) [W/(m² sr)]
        view: for the header of a Radiance picture
        header: more lines for it
    Raises:
        InputError: other shapes or endings, and a file that cannot be written; it is then as it was
    """
    array = _arrays.picture("radiance", radiance)
    lines = [str(line) for line in _arrays.few("header", header, 10_000)]
    if any(re.search(r"[\r\n\0]", line) or not line for line in lines):
        raise InputError("header: expected lines that are neither empty nor several")
    if view is not None:
        lines.append("VIEW= " + _core.view_text(view_words(view)))
    _core.save(_file(file), array, array.shape[1], array.shape[0], lines)


def _answers(interval: Any) -> int:
    if isinstance(interval, bool) or not isinstance(interval, Integral) or not (interval == 0 or 2 <= interval <= 100):
        raise OptionError("interval: expected a number of answers from 2 to 100, or 0")
    return int(interval)


def _array(numbers: Any, shape: tuple[int, ...]) -> np.ndarray:
    """What C++ has made, without a copy."""
    return np.asarray(memoryview(numbers)).reshape(shape)


def _picture(made: Any, distance: bool) -> Picture:
    shape = made.height, made.width
    layers = {name: _array(radiance, (*shape, 3)) for name, radiance in made.layers.items()}
    return Picture(_array(made.radiance, (*shape, 3)), _array(made.distance, shape) if distance else None,
                   _array(made.error, shape) if len(made.error) else None, layers, made.view, made.rays)


def _file(file: Any) -> str:
    try:
        name = os.fspath(file)
    except TypeError as problem:
        raise InputError(f"expected the name of a file, found a {type(file).__name__}") from problem
    if isinstance(name, bytes):
        name = os.fsdecode(name)
    if not name or name == "-" or "\0" in name:
        raise InputError(f"{name!r} is not the name of a file")
    return name


def _bytes(data: Any) -> bytes:
    try:
        return bytes(memoryview(data))
    except TypeError as problem:
        raise InputError(f"expected bytes or a str, found a {type(data).__name__}") from problem


def _count(what: str, value: Any, least: int, most: int) -> int:
    try:
        number = int(value) if not isinstance(value, (str, bytes)) and int(value) == value else None
    except (TypeError, ValueError, OverflowError):
        number = None
    if number is None or not least <= number <= most:
        raise InputError(f"{what}: expected an integer from {least} to {most}")
    return number


def _size_words(size: Any) -> list[str]:
    try:
        pair = [size, size] if np.ndim(size) == 0 else _arrays.few("size", size, 2)
    except Exception as problem:  # whatever an object's __array__ raises
        raise InputError("size: expected a width and a height") from problem
    if len(pair) != 2:
        raise InputError("size: expected a width and a height")
    width, height = (_count("size", number, 1, 1 << 20) for number in pair)
    return ["-x", str(width), "-y", str(height)]


def _modifier_words(modifiers: Any) -> list[str]:
    words: list[str] = []
    if isinstance(modifiers, str):
        modifiers = [modifiers]
    try:
        if not isinstance(modifiers, Mapping):
            modifiers = {name: None for name in _arrays.few("modifiers", modifiers, 100_000)}
    except (TypeError, InputError) as problem:
        raise InputError("modifiers: expected names") from problem
    for name, bins in modifiers.items():
        if not isinstance(name, str) or not name:
            raise InputError(f"modifiers: expected names, found {str(name)[:60]!r}")
        expression, count = ("0", 1) if bins is None else bins if isinstance(bins, (list, tuple)) and len(bins) == 2 else (None, None)
        if not isinstance(expression, str) or not isinstance(count, (int, str, np.integer)):
            raise InputError(f"modifiers: {name}: expected the expression of its bins and their number")
        words += ["-bn", str(count), "-b", expression, "-m", name]
    return words


class _Listener:
    """Who is told how far a call is: a function, a bar, or nobody."""

    def __init__(self, progress: Progress, name: str) -> None:
        self._bar: Any = None
        self._take: Any = None
        if progress is True:
            try:
                from tqdm.auto import tqdm
            except ImportError:
                return
            self._bar = tqdm(total=1, desc=name, bar_format="{l_bar}{bar}| {elapsed}<{remaining}")
        elif callable(progress):
            self._take = progress
        elif progress not in (None, False):
            raise OptionError("progress: expected a function, or True for a bar")

    def __enter__(self) -> Any:
        return self._told if self._bar is not None or self._take is not None else None

    def __exit__(self, *_: Any) -> None:
        if self._bar is not None:
            self._bar.close()

    def _told(self, share: float, *_: Any) -> None:
        if self._bar is not None:
            self._bar.n = min(1, share)
            self._bar.refresh()
        else:
            self._take(share)
