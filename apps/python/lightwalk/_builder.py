"""Scenes that are built in code: primitives as the text of a scene file, with the places of the code that wrote them."""

from __future__ import annotations

import bisect
import os
import re
import sys
from typing import Any, Sequence

import numpy as np

from . import _arrays
from ._errors import InputError
from ._options import number_word

_NAME = re.compile(r"[^\s#!\"'\x00-\x1f\x7f][^\s\"'\x00-\x1f\x7f]*")
_FOLDER = __file__.rsplit("/", 1)[0]
TEXT_NAME = "lightwalk.Scene"  # how messages call the text


def _place_of_caller() -> tuple[str, int]:
    frame = sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_FOLDER):
        frame = frame.f_back
    return frame.f_code.co_filename, frame.f_lineno


def _word(what: str, value: Any) -> str:
    if not isinstance(value, str) or not _NAME.fullmatch(value):
        raise InputError(f"{what}: expected a word without white space, quotes or # and ! before it, found {str(value)[:60]!r}")
    return value


def _shell_word(value: Any) -> str:
    """In quotes, where the scene language's commands need them."""
    if isinstance(value, (int, np.integer)) and not isinstance(value, bool):
        return str(int(value))
    word = value if isinstance(value, str) else number_word(_number("generator", value))
    if not word or re.search(r"[\x00-\x1f\x7f]", word):
        raise InputError(f"generator: expected words without control characters, found {word[:60]!r}")
    return word if re.fullmatch(r"[\w@%+=:,./^-]+", word) else "'" + word.replace("'", "'\\''") + "'"


class _Values(list):  # type: ignore[type-arg]
    """Numbers that were looked at."""


def _channels(what: str, value: Any) -> _Values:
    array = _arrays.numbers(what, value)
    if array.ndim == 0:
        return _Values([float(array)] * 3)
    if array.shape != (3,):
        raise InputError(f"{what}: expected a number or three, red, green and blue")
    return _Values(array.tolist())


def _vector(what: str, value: Any) -> _Values:
    array = _arrays.numbers(what, value)
    if array.shape != (3,):
        raise InputError(f"{what}: expected x, y and z")
    return _Values(array.tolist())


def _number(what: str, value: Any) -> float:
    array = _arrays.numbers(what, value)
    if array.ndim != 0:
        raise InputError(f"{what}: expected a number")
    return float(array)


class Builder:
    """The methods of `Scene` that add something to it. Lengths are in metres; colours are a number, or red, green and blue."""

    def __init__(self) -> None:
        self._pieces: list[str] = []
        self._lines = 0
        self._first_lines: list[int] = []  # of each piece
        self._places: list[tuple[str, int]] = []  # where each was written
        self._surfaces = 0

    def _changed(self) -> None:
        raise NotImplementedError

    def _add(self, text: str) -> None:
        self._changed()
        self._first_lines.append(self._lines + 1)
        self._places.append(_place_of_caller())
        self._pieces.append(text)
        self._lines += text.count("\n")

    def _described(self, message: str) -> str:
        """A message with the places of the code that built the scene, instead of lines of its text."""

        def place(found: "re.Match[str]") -> str:
            at = bisect.bisect_right(self._first_lines, int(found[1])) - 1
            if at < 0:
                return found[0]
            file, line = self._places[at]
            return f"{file}:{line}: "

        return re.sub(rf"^{re.escape(TEXT_NAME)}:(\d+): ", place, message, flags=re.M)

    def _surface_name(self, modifier: str, name: str | None) -> str:
        self._surfaces += 1
        return f"{modifier}.{self._surfaces}" if name is None else name

    def primitive(self, type: str, name: str, modifier: str = "void", strings: Sequence[str] = (), numbers: Any = ()) -> str:
        """Any primitive of the scene language: a modifier of those behind it, or a surface.

        Args:
            type: "plastic", "polygon", "brightfunc", ...
            name: without white space
            modifier: name of a primitive that stands before it, or "void"
            strings, numbers: its arguments
        Returns:
            its name
        Raises:
            InputError: words with white space, numbers that are not finite; what the scene language says of it is told when the
                scene is first used
        """
        if isinstance(strings, str):
            raise InputError(f"{name}: strings are a list of words")
        words = [_word(f"{name}: an argument", word) for word in _arrays.few("strings", strings, 100_000)]
        values = _arrays.numbers(f"{name}: arguments", numbers if np.size(numbers) else np.empty(0)).ravel().tolist()
        self._add(f"{_word('modifier', modifier)} {_word('type', type)} {_word('name', name)} {len(words)} {' '.join(words)} 0 "
                  f"{len(values)} {' '.join(map(number_word, values))}\n")
        return name

    # Materials. Each returns its name.

    def plastic(self, name: str, color: Any, specularity: float = 0, roughness: float = 0, modifier: str = "void") -> str:
        """A surface that scatters light: paint, wood, stone. `color` is its diffuse reflectance, 0 to 1."""
        return self._material("plastic", name, modifier, _channels("color", color), specularity, roughness)

    def metal(self, name: str, color: Any, specularity: float = .9, roughness: float = 0, modifier: str = "void") -> str:
        """A surface whose highlights have its colour."""
        return self._material("metal", name, modifier, _channels("color", color), specularity, roughness)

    def trans(self, name: str, color: Any, specularity: float, roughness: float, transmission: float, transmitted_specular: float,
              modifier: str = "void") -> str:
        """A surface that lets light through, scattered or not: cloth, paper, frosted glass."""
        return self._material("trans", name, modifier, _channels("color", color), specularity, roughness, transmission, transmitted_specular)

    def glass(self, name: str, transmissivity: Any, modifier: str = "void") -> str:
        """A thin pane. `transmissivity` is that of one passage, from surface to surface: .96 for clear glass of 88 %."""
        return self._material("glass", name, modifier, _channels("transmissivity", transmissivity))

    def mirror(self, name: str, color: Any, modifier: str = "void") -> str:
        """A plane mirror, through which light sources light the scene once more."""
        return self._material("mirror", name, modifier, _channels("color", color))

    def light(self, name: str, radiance: Any, modifier: str = "void") -> str:
        """A lamp's surface: rays are sent to it. `radiance` in W/(m² sr); 1 is 179 cd/m²."""
        return self._material("light", name, modifier, _channels("radiance", radiance))

    def glow(self, name: str, radiance: Any, max_distance: float = 0, modifier: str = "void") -> str:
        """A surface that emits, and lights others within `max_distance` [m]; 0: as all other surfaces do, by indirect light."""
        return self._material("glow", name, modifier, _channels("radiance", radiance), max_distance)

    def spotlight(self, name: str, radiance: Any, direction: Any, angle: float, modifier: str = "void") -> str:
        """A lamp that lights a cone of `angle` degrees about `direction`."""
        return self._material("spotlight", name, modifier, _channels("radiance", radiance), angle, _vector("direction", direction))

    def _material(self, type: str, name: str, modifier: str, *numbers: Any) -> str:
        flat: list[float] = []
        for number in numbers:
            flat += number if isinstance(number, _Values) else [_number(name, number)]
        return self.primitive(type, name, modifier, (), flat)

    # Surfaces.

    def polygon(self, modifier: str, vertices: Any, name: str | None = None) -> str:
        """A plane polygon, whose front is where its vertices turn counter-clockwise. vertices: (n, 3), n at least 3 [m]."""
        array = _arrays.numbers("vertices", vertices, 3)
        return self.primitive("polygon", self._surface_name(modifier, name), modifier, (), array)

    def polygons(self, modifier: str, vertices: Any) -> None:
        """Many polygons of the same number of corners. vertices: (polygons, corners, 3) [m]."""
        array = _arrays.numbers("vertices", vertices)
        if array.ndim != 3 or array.shape[2] != 3 or array.shape[1] < 3:
            raise InputError("vertices: expected the shape (polygons, corners, 3), corners at least 3")
        if len(array) == 0:
            return
        _word("modifier", modifier)
        count, first = 3 * array.shape[1], self._surfaces
        self._surfaces += len(array)
        lines = (f"{modifier} polygon {modifier}.{first + 1 + k} 0 0 {count} {' '.join(map(repr, row))}\n"
                 for k, row in enumerate(array.reshape(len(array), count).tolist()))
        self._add("".join(lines))

    def mesh(self, modifier: str, vertices: Any, triangles: Any) -> None:
        """Triangles between points. vertices: (n, 3) [m]; triangles: (m, 3) indices into them, counter-clockwise from the front.

        Raises:
            InputError: indices that are no integers, or of points that are not there
        """
        points = _arrays.numbers("vertices", vertices, 3)
        corners = _arrays.numbers("triangles", triangles, 3)
        if corners.size and (np.any(corners != np.floor(corners)) or corners.min() < 0 or corners.max() >= len(points)):
            raise InputError(f"triangles: expected indices from 0 to {len(points) - 1}")
        self.polygons(modifier, points[corners.astype(np.int64)])

    def box(self, modifier: str, lower: Any, upper: Any, inward: bool = False) -> None:
        """A box between two corners [m]. inward: its faces look inside, as a room's."""
        low, high = np.array(_vector("lower", lower)), np.array(_vector("upper", upper))
        corners = np.array([[high[a] if k >> a & 1 else low[a] for a in range(3)] for k in range(8)])
        faces = np.array([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]])
        self.polygons(modifier, corners[faces[:, ::-1] if inward else faces])

    def sphere(self, modifier: str, center: Any, radius: float, name: str | None = None) -> str:
        """A sphere [m]."""
        return self._shape("sphere", modifier, name, _vector("center", center), radius)

    def cylinder(self, modifier: str, start: Any, end: Any, radius: float, name: str | None = None) -> str:
        """A cylinder without its ends [m]."""
        return self._shape("cylinder", modifier, name, _vector("start", start), _vector("end", end), radius)

    def ring(self, modifier: str, center: Any, normal: Any, inner: float, outer: float, name: str | None = None) -> str:
        """A disk, or what is left of one between two radii [m]."""
        return self._shape("ring", modifier, name, _vector("center", center), _vector("normal", normal), inner, outer)

    def source(self, modifier: str, direction: Any, angle: float, name: str | None = None) -> str:
        """A light at infinity: the sun (.533), a half of the sky (180). `angle`: its diameter [degrees]."""
        return self._shape("source", modifier, name, _vector("direction", direction), angle)

    def _shape(self, type: str, modifier: str, name: str | None, *numbers: Any) -> str:
        return self._material(type, self._surface_name(modifier, name), modifier, *numbers)

    # Other things.

    def generate(self, *words: Any) -> None:
        """What a generator of scenes writes: generate("gensky", 6, 21, 12, "-a", 51.5). Those of Radiance are built in; others need
        allow_commands."""
        self._add("!" + " ".join(map(_shell_word, words)) + "\n")

    def include(self, file: Any, *transform: Any) -> None:
        """A scene file, a luminaire (.ies, .ldt), an object (.obj, .gltf), transformed as by xform: include("chair.rad", "-t", 1, 2, 0)."""
        self.generate("xform", *transform, os.fspath(file))

    def text(self, text: str) -> None:
        """A piece of the scene language."""
        if not isinstance(text, str):
            raise InputError(f"text: expected a str, found a {type(text).__name__}")
        self._add(text if text.endswith("\n") else text + "\n")
