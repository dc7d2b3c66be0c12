"""Objects that are sets of named values, each of a kind of its own."""

from __future__ import annotations

import math
from typing import Any


class Values:
    """A set of named values. They are checked when they are set, and copies share none of them."""

    __slots__ = ("_values",)

    def __init__(self, values: dict[str, Any]) -> None:
        object.__setattr__(self, "_values", values)

    def _checked(self, name: str, value: Any) -> Any:
        """`value` as it is kept. Raises TypeError, InputError."""
        raise NotImplementedError

    def __getattr__(self, name: str) -> Any:
        if not name.startswith("_") and name in self._values:
            return self._values[name]
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in self._values:
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")
        self._values[name] = self._checked(name, value)

    def __copy__(self) -> Any:
        other = type(self).__new__(type(self))
        other.__setstate__(self.__getstate__())
        return other

    def __deepcopy__(self, _: Any) -> Any:
        return self.__copy__()

    def __getstate__(self) -> dict[str, Any]:
        return {name: list(value) if isinstance(value, list) else value for name, value in self._values.items()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        object.__setattr__(self, "_values", state)

    def __dir__(self) -> list[str]:
        return list(self._values)


def number(name: str, value: Any) -> float:
    """A finite number.

    Raises:
        TypeError: no number
        ValueError: not finite
    """
    try:
        if isinstance(value, (str, bytes, bool)):
            raise TypeError
        found = float(value)
    except (TypeError, ValueError, OverflowError) as problem:
        raise TypeError(f"{name}: expected a number, found {value!r:.60}") from problem
    if not math.isfinite(found):
        raise ValueError(f"{name}: {found} is not finite")
    return found


def three_numbers(name: str, value: Any) -> tuple[float, ...]:
    """Three finite numbers. Raises as `number`."""
    try:
        if isinstance(value, (str, bytes)):
            raise TypeError
        found = tuple(value)
    except TypeError as problem:
        raise TypeError(f"{name}: expected three numbers, found {value!r:.60}") from problem
    if len(found) != 3:
        raise TypeError(f"{name}: expected three numbers, found {len(found)}")
    return tuple(number(name, one) for one in found)
