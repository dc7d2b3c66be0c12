"""Views, and how light is followed."""

from __future__ import annotations

import math
import os
from typing import Any

from .._errors import InputError
from ._programs import Path
from ._ray_params import (RayParams, get_default_ray_params, get_ray_params, get_ray_params_args, ray_done, set_option,
                          set_ray_params)

__all__ = ["RayParams", "View", "ViewFileError", "create_default_view", "get_default_ray_params", "get_ray_params", "get_ray_params_args",
           "get_view_args", "parse_view", "ray_done", "set_option", "set_ray_params", "viewfile"]

_TYPES = "vlchas"
_VECTORS = {"-vp": "vp", "-vd": "vdir", "-vu": "vu"}
_NUMBERS = {"-vh": "horiz", "-vv": "vert", "-vs": "hoff", "-vl": "voff", "-vo": "vfore", "-va": "vaft"}


class ViewFileError(InputError, RuntimeError):
    """A file without a view."""


class View:
    """A view, with Radiance's defaults.

    Attributes:
        type: v perspective, l parallel, c cylindrical, h hemispherical, a angular, s stereographic
        vp, vdir, vu: the eye [m], the direction of sight, what is up; three numbers each
        horiz, vert: size [degrees; of parallel views m]
        hoff, voff: of the picture, to the right and up, in its widths and heights
        vfore, vaft: nothing nearer, nothing farther is seen [m]; 0: no limit
    Raises:
        TypeError: values of other kinds
        InputError: another type of view, numbers that are not finite
        AttributeError: another attribute
    """

    __slots__ = ("_type", "_values")

    def __init__(self) -> None:
        self._type = "v"
        self._values: dict[str, Any] = {"vp": (0.0, 0.0, 0.0), "vdir": (0.0, 1.0, 0.0), "vu": (0.0, 0.0, 1.0), "horiz": 45.0, "vert": 45.0, "hoff": 0.0,
                                        "voff": 0.0, "vfore": 0.0, "vaft": 0.0}

    def __getattr__(self, name: str) -> Any:
        if name == "type":
            return self._type
        if not name.startswith("_") and name in self._values:
            return self._values[name]
        raise AttributeError(f"'View' object has no attribute {name!r}")

    def __setattr__(self, name: str, value: Any) -> None:
        if name in View.__slots__:
            object.__setattr__(self, name, value)
        elif name == "type":
            if not isinstance(value, str):
                raise TypeError(f"View.type: expected one letter of {_TYPES!r}, found {value!r:.60}")
            if len(value) != 1 or value not in _TYPES:
                raise (TypeError if len(value) != 1 else InputError)(f"View.type: expected one letter of {_TYPES!r}, found {value!r:.60}")
            self._type = value
        elif name in _VECTORS.values():
            self._values[name] = _three(name, value)
        elif name in _NUMBERS.values():
            self._values[name] = _number(name, value)
        else:
            raise AttributeError(f"'View' object has no attribute {name!r}")

    def __dir__(self) -> list[str]:
        return ["type", *self._values]

    def __repr__(self) -> str:
        numbers = {option: _NUMBERS[option] for option in ("-vh", "-vv", "-vo", "-va", "-vs", "-vl")}
        words = [f"-vt{self._type}", *(f"{option} {' '.join(f'{value:g}' for value in self._values[name])}" for option, name in _VECTORS.items()),
                 *(f"{option} {self._values[name]:g}" for option, name in numbers.items())]
        return " " + " ".join(words)


def _number(name: str, value: Any) -> float:
    if isinstance(value, (str, bytes, bool)):
        raise TypeError(f"View.{name}: expected a number, found {value!r:.60}")
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError) as problem:
        raise TypeError(f"View.{name}: expected a number, found {value!r:.60}") from problem
    if not math.isfinite(number):
        raise InputError(f"View.{name}: {number} is not finite")
    return number


def _three(name: str, value: Any) -> tuple[float, ...]:
    try:
        numbers = tuple(value)
    except TypeError as problem:
        raise TypeError(f"View.{name}: expected three numbers, found {value!r:.60}") from problem
    if len(numbers) != 3:
        raise TypeError(f"View.{name}: expected three numbers, found {len(numbers)}")
    return tuple(_number(name, one) for one in numbers)


def create_default_view() -> View:
    """A view with Radiance's defaults."""
    return View()


def get_view_args(arg: View) -> list[str]:
    """The words of a view on a command line: -vt -vp -vd -vu -vh -vv -vs -vl -vo -va, with six digits behind the point.

    Raises:
        TypeError: no View
    """
    if not isinstance(arg, View):
        raise TypeError(f"expected a View, found {type(arg).__name__}")
    words = [f"-vt{arg.type}"]
    for option, name in _VECTORS.items():
        words += [option, *(f"{value:.6f}" for value in getattr(arg, name))]
    for option, name in _NUMBERS.items():
        words += [option, f"{getattr(arg, name):.6f}"]
    return words


def parse_view(arg: str) -> View:
    """The view that options tell: "-vta -vp 0 0 1 -vd 0 1 0". What they do not tell has Radiance's defaults, and words that are no
    options of views are passed over, as in lines of view files.

    Raises:
        TypeError: no text
        InputError: options without their numbers
    """
    if not isinstance(arg, str):
        raise TypeError(f"expected a text, found {type(arg).__name__}")
    view = View()
    _take_words(view, arg.split())
    return view


def _take_words(view: View, words: list[str]) -> bool:
    """Whether there was an option of views among the words."""
    found = False
    at = 0
    while at < len(words):
        option = words[at]
        at += 1
        if option.startswith("-vt") and len(option) > 3:
            view.type = option[3:]
        elif option in _VECTORS:
            setattr(view, _VECTORS[option], _numbers_at(words, at, 3))
            at += 3
        elif option in _NUMBERS:
            setattr(view, _NUMBERS[option], _numbers_at(words, at, 1)[0])
            at += 1
        else:
            continue
        found = True
    return found


def _numbers_at(words: list[str], at: int, count: int) -> list[float]:
    try:
        numbers = [float(word) for word in words[at:at + count]]
    except ValueError as problem:
        raise InputError(f"option {words[at - 1]}: {problem}") from problem
    if len(numbers) < count:
        raise InputError(f"option {words[at - 1]}: expected {count} numbers, found {len(numbers)}")
    return numbers


def viewfile(arg: Path) -> View:
    """The view of a view file, or of a picture's header; of several lines all that they tell, as a file that is written to again has it.

    Raises:
        ViewFileError: there is no such file, or no view in it
        InputError: options without their numbers
    """
    view = View()
    found = False
    try:
        with open(os.fspath(arg), "rb") as file:
            for line in file:
                if not line.strip():
                    break  # a picture's header ends here
                text = line.decode(errors="replace")
                start = text.find("VIEW=")
                if start >= 0 or text.split()[0] in ("rvu", "rpict", "rview", "pfilt", "pinterp"):
                    found = _take_words(view, text[max(start, 0):].replace("VIEW=", " ", 1).split()) or found
    except OSError as problem:
        raise ViewFileError(f"Failed to read view file: {os.fspath(arg)!s}") from problem
    if not found:
        raise ViewFileError(f"Failed to read view file: {os.fspath(arg)!s}")
    return view
