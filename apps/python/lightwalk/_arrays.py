"""Arrays that come from elsewhere, checked."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np

from ._errors import InputError


_MOST = 1 << 28  # a copy has 2 GiB
_MOST_RAYS = 1 << 25


def numbers(what: str, value: Any, columns: int | None = None, finite: bool = True, dtype: Any = np.float64) -> np.ndarray:
    """`value` as a contiguous array of numbers, (n, columns) where columns are given.

    Raises:
        InputError: other shapes, other kinds of values, and numbers that are not finite where these are asked for
    """
    try:
        with np.errstate(all="ignore"):
            array = np.asarray(value)
            if array.dtype.kind not in "fiub" or array.dtype.itemsize > 16:
                raise InputError(f"{what}: expected an array of numbers, found {array.dtype}")
            if array.size > _MOST:
                raise InputError(f"{what}: more than {_MOST} numbers")
            array = np.asarray(array, dtype=dtype, order="C")
    except InputError:
        raise
    except MemoryError:
        raise
    except Exception as problem:  # whatever an object's __array__ raises
        raise InputError(f"{what}: no array can be made of it: {problem}") from problem
    if columns is not None:
        if array.ndim == 1 and array.size == columns:
            array = array.reshape(1, columns)
        if array.ndim != 2 or array.shape[1] != columns:
            raise InputError(f"{what}: expected the shape (n, {columns}), found {_shape(array)}")
    if finite and not np.isfinite(array).all():
        bad = int(np.argmin(np.isfinite(array.reshape(len(array), -1)).all(axis=1))) if array.ndim else 0
        raise InputError(f"{what}: row {bad} holds a number that is not finite")
    return array


def few(what: str, values: Any, most: int) -> list[Any]:
    """The items of anything that can be iterated, which may have no end.

    Raises:
        InputError: more items than `most`, and what cannot be iterated
    """
    try:
        items = list(itertools.islice(iter(values), most + 1))
    except Exception as problem:  # whatever somebody else's iterator raises
        raise InputError(f"{what}: cannot be read: {problem}") from problem
    if len(items) > most:
        raise InputError(f"{what}: expected at most {most}")
    return items


def picture(what: str, value: Any) -> np.ndarray:
    """`value` as a picture: float32 (height, width, 3)."""
    array = numbers(what, value, finite=False, dtype=np.float32)
    if array.ndim != 3 or array.shape[2] != 3 or 0 in array.shape:
        raise InputError(f"{what}: expected the shape (height, width, 3), found {_shape(array)}")
    return array


def rays(origins: Any, directions: Any) -> np.ndarray:
    """Origins and directions, one beside the other: (n, 6). One origin, or one direction, does for all.

    Raises:
        InputError: as numbers(), and for different counts
    """
    origin, direction = numbers("origins", origins, 3), numbers("directions", directions, 3)
    count = max(len(origin), len(direction)) if len(origin) and len(direction) else 0
    if len(origin) not in (1, count) or len(direction) not in (1, count):
        raise InputError(f"{len(origin)} origins and {len(direction)} directions: expected as many, or one of either")
    if count > _MOST_RAYS:
        raise InputError(f"more than {_MOST_RAYS} rays in one call")
    both = np.empty((count, 6))
    both[:, :3], both[:, 3:] = origin[:count], direction[:count]
    return both


def _shape(array: np.ndarray) -> str:
    return "(" + ", ".join(map(str, array.shape)) + ")"
