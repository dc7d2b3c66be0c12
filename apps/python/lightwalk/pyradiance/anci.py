"""Files."""

from __future__ import annotations

import errno
import os

from ._programs import Path


def write(file_path: Path, data: str | bytes, overwrite: bool = True, mode: str = "wb") -> str:
    """Writes data to a file.

    Args:
        file_path: of the file
        data: a text for the mode "w", bytes for "wb"
        overwrite: whether a file that exists may be replaced
        mode: of open(): "wb", "w", "ab" ...
    Returns:
        the file's path
    Raises:
        FileExistsError: there is such a file, and `overwrite` is false
        TypeError: data that is not of the mode's kind; the file is left as it was
        OSError: it cannot be written
    """
    expected: type = bytes if "b" in mode else str
    if not isinstance(data, expected):
        raise TypeError(f"mode {mode!r}: expected {expected.__name__}, found {type(data).__name__}")
    if not overwrite and os.path.exists(file_path):
        raise FileExistsError(errno.EEXIST, "the file exists, and overwrite=False", str(file_path))
    with open(file_path, mode) as file:
        file.write(data)
    return str(file_path)
