"""Runs the programs: the package's own one, which acts as the Radiance program by whose name it is called."""

from __future__ import annotations

import numbers
import os
import subprocess
import warnings
from typing import Any, Sequence, Union

from .._errors import Error, InputError, LightwalkWarning
from .._walk import PROGRAM

Path = Union[str, "os.PathLike[str]"]
Input = Union[str, "os.PathLike[str]", bytes]  #: a file's name, or what is in it


class ProgramError(Error, RuntimeError):
    """A program that ended with an error.

    Attributes:
        program: its name
        returncode: its exit status; negative: the signal that ended it
        stderr: what it wrote to standard error
    """

    def __init__(self, program: str, returncode: int, stderr: str) -> None:
        super().__init__(f"An error occurred with exit code {returncode}: {stderr}")
        self.program = program
        self.returncode = returncode
        self.stderr = stderr

    def __reduce__(self) -> tuple[Any, ...]:  # it crosses processes with what it says
        return type(self), (self.program, self.returncode, self.stderr)


def executable(name: str) -> str:
    """The file that is run as the program `name`. Tests put other programs in its place."""
    return str(PROGRAM)


def run(name: str, words: Sequence[Any], stdin: bytes | None = None, messages: str = "warn") -> bytes:
    """Runs a program.

    Args:
        words: of its command line
        stdin: what it reads; None: nothing
        messages: what becomes of standard error where the program succeeds: "warn", warnings of Python; "drop"; "show", it goes
            where Python's goes, at once
    Returns:
        what it wrote to standard output
    Raises:
        ProgramError: it ended with an error, whose text is the message
        TypeError: for what is no word, and an input that is not bytes
        InputError: a word that holds a byte 0
    """
    line = [name, *(word_of(word) for word in words)]
    if stdin is not None and not isinstance(stdin, (bytes, bytearray, memoryview)):
        raise TypeError(f"{name}: expected bytes as input, found {type(stdin).__name__}")
    source: dict[str, Any] = {"stdin": subprocess.DEVNULL} if stdin is None else {"input": bytes(stdin)}
    errors = None if messages == "show" else subprocess.PIPE
    try:
        done = subprocess.run(line, executable=executable(name), stdout=subprocess.PIPE, stderr=errors, check=False, **source)
    except ValueError as problem:
        raise InputError(f"{name}: {problem}") from problem
    except OSError as problem:
        raise Error(f"{name}: cannot be run: {problem}") from problem
    text = (done.stderr or b"").decode(errors="replace")
    if done.returncode:
        raise ProgramError(name, done.returncode, text)
    if text and messages == "warn":
        warnings.warn(text.rstrip("\n"), LightwalkWarning, stacklevel=3)
    return done.stdout


def word_of(value: Any) -> str:
    """A word of a command line.

    Raises:
        TypeError: neither a text, nor a number, nor a path
    """
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if not isinstance(value, (str, numbers.Number)):
        raise TypeError(f"expected a text, a number or a path, found {value!r:.60}")
    return str(value)


def file_or_bytes(what: str, value: Any) -> tuple[list[str], bytes | None]:
    """An input as the words that name it, and as what a program reads instead where it is bytes.

    Raises:
        TypeError: `value` is no Input
    """
    if isinstance(value, bytes):
        return [], value
    if isinstance(value, (str, os.PathLike)):
        return [word_of(value)], None
    raise TypeError(f"{what} must be a path or bytes, found {type(value).__name__}")


def listed(what: str, words: Sequence[str] | None) -> list[str]:
    """Words of a command line, which a text is not: it would be taken for a sequence of letters.

    Raises:
        TypeError: a text
    """
    if isinstance(words, (str, bytes)):
        raise TypeError(f'{what} must be a sequence of words (["-ab", "2"]), found {words!r:.60}')
    return list(words or ())


def options(**values: Any) -> list[Any]:
    """`-name value` for each that is not None, in their order; `as_` is -as, as `as` is a word of Python's."""
    words: list[Any] = []
    for name, value in values.items():
        if value is not None:
            words += ["-" + name.rstrip("_"), value]
    return words


def switches(**values: bool) -> list[str]:
    """`-name` for each that is true, in their order."""
    return ["-" + name.rstrip("_") for name, value in values.items() if value]
