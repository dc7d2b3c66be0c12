"""Keyword arguments as options of the command, by the command's own tables."""

from __future__ import annotations

import difflib
import functools
import math
import numbers
import os
import re
from typing import Any, Iterable, NamedTuple

from ._arrays import few
from ._errors import InputError, OptionError
from .bin import _core

# Options that say where a program's output goes, how it shares its work, or what the function's own arguments say.
_OUTPUT = {"-o", "-z", "-S", "-t", "-pRGB", "-pXYZ", "-pY", "-pA", "-pc", "--exposure", "--tone", "--denoise", "--checkpoint", "--resume", "--stats",
           "--quiet", "-defaults", "--help", "--version", "-w", "--fps", "-v"}
_RANKS = {"--variant", "--scene-from", "--block", "--stride", "--masters", "--ambient-batch", "--timeline", "--projectors"}
_SCENE = {"--allow-commands", "--stale"}
_RAYS = {"-I", "-h", "--interval", "-x", "-y", "-te", "-ti", "-tE", "-tI", "-m", "-M", "-b", "-bn", "-p", "-c", "-fo", "-r"}
_LEFT_OUT = {"render": _OUTPUT | _RANKS | _SCENE | {"-e"}, "animate": _OUTPUT | _RANKS | _SCENE | {"-e"},
             "walk": (_OUTPUT - {"--fps"}) | _RANKS | _SCENE | {"-e", "--port", "--embed", "-vf"},
             "trace": _OUTPUT | _RANKS | _SCENE | _RAYS | {"-e", "-f"}, "contrib": _OUTPUT | _RANKS | _SCENE | _RAYS}


class Option(NamedTuple):
    """An option as a keyword argument: render(view, ab=2) is `lightwalk render -ab 2`."""

    keyword: str
    name: str  #: of the command's option
    arguments: tuple[str, ...]
    default: str  #: as the command's help shows it
    text: str  #: what it does
    is_switch: bool
    toggles: bool  #: a switch that can be set both ways
    repeats: bool  #: a list stands for the option once for each of its words


def _option(row: Any) -> Option:
    rest = row.words[len(row.name):]
    toggles = rest.startswith("[+-]")
    arguments = () if row.is_switch else tuple(rest.split())
    if row.name == "-f":  # the table has it together with formats
        arguments = ("FILE",)
    if row.name == "-vt":
        arguments = (rest,)
    keyword = row.name.lstrip("-").replace("-", "_")
    return Option(keyword + "_" if keyword in ("as", "if", "in", "is", "or") else keyword, row.name, arguments, row.value, row.text, row.is_switch, toggles,
                  "epeatable" in row.text or row.name in ("-e", "-f", "-aE", "-aI"))


@functools.lru_cache(maxsize=None)
def options(command: str = "render") -> dict[str, Option]:
    """The options of a function as its keyword arguments.

    Args:
        command: "render", "animate", "walk", "trace" or "contrib"
    Returns:
        the options by their keywords: `-ab N` is "ab", `--sample-lights N` "sample_lights", and `-as N`, whose name is a
        word of Python's, "as_"
    Raises:
        OptionError: there is no such command
    """
    if not isinstance(command, str) or command not in _LEFT_OUT:
        raise OptionError(f"no such command: {command!r}, expected one of {', '.join(_LEFT_OUT)}")
    found = (_option(row) for row in _core.offered_options(command) if row.name not in _LEFT_OUT[command])
    return {option.keyword: option for option in found}


def words_of(command: str, arguments: dict[str, Any]) -> list[str]:
    """The words of a command line for keyword arguments.

    Raises:
        OptionError: for a keyword that is no option, with the nearest one, and for values of wrong kinds
    """
    known = options(command)
    words = []
    for keyword, value in arguments.items():
        option = known.get(keyword)
        if option is None:
            raise OptionError(_refusal(command, keyword, known))
        words += _words_of_one(option, value)
    return words


def _refusal(command: str, keyword: str, known: dict[str, Option]) -> str:
    for left_out, why in ((_RANKS, "a process of Python works alone"), (_SCENE, "the scene has it: Scene.from_files(...)"),
                          (_OUTPUT, "what is returned are arrays")):
        if "-" + keyword in left_out or "--" + keyword.replace("_", "-") in left_out:
            return f"{command}: {keyword} is an option of the command alone: {why}"
    near = difflib.get_close_matches(keyword, known, 1, .5)
    return f"{command}: unknown option {keyword!r}" + (f", did you mean {near[0]!r}?" if near else "")


def _words_of_one(option: Option, value: Any) -> list[str]:
    if value is None:
        return []
    if option.is_switch:
        return _switch_words(option, value)
    if option.name == "-vt":
        return ["-vt" + _word(option, value)]
    count = len(option.arguments)
    if count == 1:
        several = value if option.repeats and isinstance(value, (list, tuple)) else [value]
        return [word for one in several for word in (option.name, _word(option, one))]
    values = _listed(value)
    if values is None or len(values) != count:
        raise OptionError(f"option {option.keyword}: expected {count} values ({' '.join(option.arguments)}), found {_shown(value)}")
    return [option.name, *(_word(option, one) for one in values)]


def _switch_words(option: Option, value: Any) -> list[str]:
    if not isinstance(value, (bool, numbers.Integral)) and type(value).__name__ not in ("bool_", "bool"):
        raise OptionError(f"option {option.keyword}: expected True or False, found {_shown(value)}")
    if option.toggles:
        return [option.name + ("+" if value else "-")]
    return [option.name] if value else []


def _listed(value: Any) -> list[Any] | None:
    if isinstance(value, (str, bytes)) or not isinstance(value, Iterable):
        return None
    try:
        return few("values", value, 16)
    except InputError as problem:
        raise OptionError(str(problem)) from problem


def _word(option: Option, value: Any) -> str:
    if isinstance(value, str):
        word = value
    elif isinstance(value, os.PathLike):
        word = os.fspath(value)
    elif isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise OptionError(f"option {option.keyword}: expected {' '.join(option.arguments)}, found {_shown(value)}")
    elif isinstance(value, numbers.Integral):
        word = str(int(value)) if abs(int(value)) < 10 ** 30 else "inf"
    else:
        word = number_word(float(value))
    if not isinstance(word, str) or "\0" in word:
        raise OptionError(f"option {option.keyword}: {_shown(value)} holds bytes that no word has")
    return word


def number_word(value: float) -> str:
    """A number as a word that is read as the same number."""
    return repr(float(value)) if math.isfinite(value) else str(float(value))


def _shown(value: Any) -> str:
    try:
        text = re.sub(r"\s+", " ", repr(value))
    except Exception:  # an object whose repr() raises
        text = f"a {type(value).__name__}"
    return text if len(text) <= 60 else text[:57] + "..."
