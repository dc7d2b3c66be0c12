"""Where a picture is seen from."""

from __future__ import annotations

import dataclasses
import os
import shlex
from typing import Any, Mapping, Sequence, Union

from ._arrays import few
from ._errors import InputError, OptionError
from ._options import number_word

_SHORT = {"type": "-vt", "position": "-vp", "direction": "-vd", "up": "-vu", "horizontal": "-vh", "vertical": "-vv", "fore": "-vo", "aft": "-va",
          "shift": "-vs", "lift": "-vl"}


@dataclasses.dataclass(frozen=True)
class View:
    """A view, as the command's options -vt -vp -vd -vu -vh -vv -vo -va -vs -vl tell it; the defaults are theirs.

    Attributes:
        position: the eye [m]
        direction: of the line of sight, of any length but 0
        up: what is up in the picture
        horizontal, vertical: size [degrees; of parallel views m]
        type: v perspective, l parallel, c cylindrical, h hemispherical, a angular, s stereographic
        fore, aft: nothing nearer, nothing farther is seen [m]; 0: no limit
        shift, lift: of the picture, to the right and up, in its widths and heights
    """

    position: Sequence[float] = (0, 0, 0)
    direction: Sequence[float] = (0, 1, 0)
    up: Sequence[float] = (0, 0, 1)
    horizontal: float = 45
    vertical: float = 45
    type: str = "v"
    fore: float = 0
    aft: float = 0
    shift: float = 0
    lift: float = 0

    @staticmethod
    def fisheye(position: Sequence[float], direction: Sequence[float], up: Sequence[float] = (0, 0, 1), type: str = "a") -> "View":
        """All that is before an eye, 180 by 180 degrees, as `glare` needs it."""
        return View(position, direction, up, 180, 180, type)

    def words(self) -> list[str]:
        """As the words of a command line."""
        words = []
        for field, name in _SHORT.items():
            value = getattr(self, field)
            if field == "type":
                words.append(name + str(value))
            elif field in ("position", "direction", "up"):
                words += [name, *_three(field, value)]
            else:
                words += [name, _number(field, value)]
        return words


ViewLike = Union[View, str, "os.PathLike[str]", Mapping[str, Any], None]


def _number(field: str, value: Any) -> str:
    try:
        return number_word(float(value))
    except (TypeError, ValueError, OverflowError) as problem:
        raise InputError(f"view: {field} is not a number") from problem


def _three(field: str, value: Any) -> list[str]:
    values = few(f"view: {field}", value, 3)
    if len(values) != 3:
        raise InputError(f"view: {field} is not three numbers but {len(values)}")
    return [_number(field, one) for one in values]


def view_words(view: ViewLike) -> list[str]:
    """The words of a view: a View, a mapping of its attributes, a text of options ("-vp 0 0 1 -vd 0 1 0"), or the name of a view
    file or a picture. None: no words.

    Raises:
        InputError, OptionError: what is none of these
    """
    if view is None:
        return []
    if isinstance(view, View):
        return view.words()
    if isinstance(view, Mapping):
        try:
            return View(**view).words()
        except TypeError as problem:
            raise OptionError(f"view: {problem}") from problem
    if isinstance(view, os.PathLike):
        return ["-vf", os.fspath(view)]
    if not isinstance(view, str):
        raise OptionError(f"view: expected a View, a text or a file, found a {type(view).__name__}")
    if not view.lstrip().startswith(("-v", "VIEW=")):
        return ["-vf", view]
    try:
        words = shlex.split(view)
    except ValueError as problem:
        raise InputError(f"view: {problem}") from problem
    return [word for word in words if word != "VIEW="]
