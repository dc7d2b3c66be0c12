"""What goes wrong, as exceptions."""

from __future__ import annotations

import re
from typing import NamedTuple

_PLACE = re.compile(r"^(?P<file>[^\n]+?):(?P<line>\d+): (?P<message>.*)$")


class Error(Exception):
    """The base of all of Lightwalk's own exceptions."""


class Problem(NamedTuple):
    """One thing that is wrong with a scene. `file` is None, or `line` 0, where there is none."""

    file: str | None
    line: int
    message: str


class InputError(Error, ValueError):
    """A scene, a file or an array that is wrong. The text has a line "file:line: what is wrong" for each problem.

    The places of primitives that were built in code are those of the Python code that built them.
    """

    @property
    def problems(self) -> list[Problem]:
        """All that is wrong, in order."""
        found = []
        for line in str(self).splitlines():
            place = _PLACE.match(line)
            if place:
                found.append(Problem(place["file"], int(place["line"]), place["message"]))
            else:
                found.append(Problem(None, 0, line))
        return found

    @property
    def file(self) -> str | None:
        """The file of the first problem."""
        return self.problems[0].file if str(self) else None

    @property
    def line(self) -> int:
        """The line of the first problem, from 1; 0: there is none."""
        return self.problems[0].line if str(self) else 0


class OptionError(Error, TypeError):
    """A keyword argument that is no option of the command, or a value that the option cannot have."""


class LightwalkWarning(UserWarning):
    """What the command `lightwalk` prints as a warning."""
