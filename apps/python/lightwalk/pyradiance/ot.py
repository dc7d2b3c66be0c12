"""Octrees."""

from __future__ import annotations

from ._programs import Path, options, run, switches


def oconv(*paths: Path, warning: bool = True, stdin: bytes | None = None, frozen: bool = False, octree: Path | None = None) -> bytes:
    """Makes an octree of scene files.

    Args:
        paths: of the files, in order
        warning: False: without warnings
        stdin: a scene that follows the files
        frozen: whether the octree holds the scene itself, rather than its files' names
        octree: one that is extended
    Returns:
        the octree
    Raises:
        ProgramError: what is wrong with the scene
        TypeError: `stdin` is not bytes
    """
    if stdin is not None and not isinstance(stdin, bytes):
        raise TypeError("stdin should be bytes.")
    words = [*options(i=octree), *switches(w=not warning, f=frozen), *paths]
    return run("oconv", words + ["-"] if stdin else words, stdin)
