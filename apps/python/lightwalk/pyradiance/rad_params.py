"""Views, and how light is followed."""

from __future__ import annotations

import os
from typing import Any

from .._errors import InputError
from ._programs import Path
from ._ray_params import RayParams, get_default_ray_params, get_ray_params, get_ray_params_args, ray_done, set_option, set_ray_params
from ._values import Values, number, three_numbers

__all__ = ["RayParams", "View", "ViewFileError", "create_default_view", "get_default_ray_params", "get_ray_params", "get_ray_params_args",
           "get_view_args", "parse_view", "ray_done", "set_option", "set_ray_params", "viewfile"]

_TYPES = "vlchas"
_VECTORS = {"-vp": "vp", "-vd": "vdir", "-vu": "vu"}
_NUMBERS = {"-vh": "horiz", "-vv": "vert", "-vs": "hoff", "-vl": "voff", "-vo": "vfore", "-va": "vaft"}


class ViewFileError(InputError, RuntimeError):
    """A file without a view."""


class View(Values):
    """A view, with Radiance's defaults.

    Attributes:
        type: v perspective, l parallel, c cylindrical, h hemispherical, a angular, s stereographic
        vp, vdir, vu: the eye [m], the direction of sight, what is up; three numbers each
        horiz, vert: size [degrees; of parallel views m]
        hoff, voff: of the picture, to the right and up, in its widths and heights
        vfore, vaft: nothing nearer, nothing farther is seen [m]; 0: no limit
    Raises:
        TypeError: values of other kinds
        ValueError: another type of view, numbers that are not finite
        AttributeError: another attribute
    """

    __slots__ = ()

    def __init__(self) -> None:
        super().__init__({"type": "v", "vp": (0.0, 0.0, 0.0), "vdir": (0.0, 1.0, 0.0), "vu": (0.0, 0.0, 1.0), "horiz": 45.0, "vert": 45.0, "hoff": 0.0,
                          "voff": 0.0, "vfore": 0.0, "vaft": 0.0})

    def _checked(self, name: str, value: Any) -> Any:
        if name in _VECTORS.values():
            return three_numbers(f"View.{name}", value)
        if name in _NUMBERS.values():
            return number(f"View.{name}", value)
        if not isinstance(value, str) or len(value) != 1:
            raise TypeError(f"View.type: expected one letter of {_TYPES!r}, found {value!r:.60}")
        if value not in _TYPES:
            raise ValueError(f"View.type: expected one letter of {_TYPES!r}, found {value!r}")
        return value

    def __repr__(self) -> str:
        words = [f"-vt{self.type}", *(f"{option} {' '.join(f'{value:g}' for value in getattr(self, name))}" for option, name in _VECTORS.items())]
        words += [f"{option} {getattr(self, _NUMBERS[option]):g}" for option in ("-vh", "-vv", "-vo", "-va", "-vs", "-vl")]
        return " " + " ".join(words)


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
            if option[3:] not in tuple(_TYPES):
                raise InputError(f"option {option}: expected one letter of {_TYPES!r} behind -vt")
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
        numbers = [number("number", float(word)) for word in words[at:at + count]]
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
