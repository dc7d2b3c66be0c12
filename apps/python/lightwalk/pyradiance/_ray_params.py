"""How light is followed, as a value: the options that rpict, rtrace and rcontrib share."""

from __future__ import annotations

import copy
from typing import Any, Iterable, Sequence

from .._errors import OptionError
from ._values import Values, number, three_numbers

# Names in the order of the words on a command line; each with its default, whose kind it keeps.
_DEFAULTS: dict[str, Any] = {
    "u": True, "bv": True, "dt": .03, "dc": .75, "dj": 0.0, "dr": 2, "dp": 512, "dv": True, "ds": .2, "st": .15, "ss": 1.0, "lr": -10, "lw": 1e-4,
    "i": False, "av": (0.0, 0.0, 0.0), "aw": 0, "aa": .1, "ar": 256, "ad": 1024, "as_": 512, "ab": 0, "af": "", "me": (0.0, 0.0, 0.0),
    "ma": (0.0, 0.0, 0.0), "mg": 0.0, "ms": 0.0}


class RayParams(Values):
    """The options' values, named as the options (as_ is -as), with pyradiance's defaults.

    Attributes:
        u, bv, dv, i: switches
        dt, dc, dj, ds, st, ss, lw, aa, mg, ms: numbers
        dr, dp, lr, aw, ar, ad, as_, ab: integers
        av, me, ma: three numbers: ambient value [W/(m² sr)], extinction of mist [1/m], its scattering albedo
        af: ambient file; "": none
        ambincl: 1 amblist names the only modifiers that have ambient values (-ai), 0 those that have none (-ae), -1 neither
        amblist: names of modifiers
    Raises:
        TypeError: values of other kinds
        ValueError: numbers that are not finite
        AttributeError: another attribute
    """

    __slots__ = ()

    def __init__(self) -> None:
        super().__init__({**_DEFAULTS, "ambincl": -1, "amblist": []})

    def _checked(self, name: str, value: Any) -> Any:
        if name == "ambincl":
            return -1 if isinstance(value, int) and value == -1 else int(_like(name, True, value))
        if name == "amblist":
            return _names(value)
        return _like(name, _DEFAULTS[name], value)


def _names(value: Any) -> list[str]:
    names = list(value) if isinstance(value, Iterable) and not isinstance(value, (str, bytes)) else [None]
    if not all(isinstance(name, str) for name in names):
        raise TypeError(f"RayParams.amblist: expected names, found {value!r:.60}")
    return names


def _like(name: str, like: Any, value: Any) -> Any:
    """A value of the kind of `like`."""
    what = f"RayParams.{name}"
    if isinstance(like, tuple):
        return three_numbers(what, value)
    if isinstance(like, float):
        return number(what, value)
    if isinstance(like, bool):
        if (isinstance(value, (bool, int)) and value in (0, 1)) or type(value).__name__ in ("bool", "bool_"):
            return bool(value)
    elif isinstance(like, int):
        if hasattr(value, "__index__") and not isinstance(value, bool):
            return int(value)
    elif isinstance(value, str):
        return value
    kind = {bool: "True or False", int: "an integer", str: "a text"}[type(like)]
    raise TypeError(f"{what}: expected {kind}, found {value!r:.60}")


def get_default_ray_params() -> RayParams:
    """pyradiance's defaults, which are not rtrace's."""
    return RayParams()


def get_ray_params_args(arg: RayParams) -> list[str]:
    """The words of a command line, as pyradiance has them: with six digits behind the point, by which small weights become 0, and
    with -bv and -dv for True, which change over what the program has (rtrace: on). Tell these as `params` where they matter.

    Raises:
        TypeError: no RayParams
    """
    if not isinstance(arg, RayParams):
        raise TypeError(f"expected RayParams, found {type(arg).__name__}")
    words: list[str] = []
    for name, default in _DEFAULTS.items():
        value = getattr(arg, name)
        option = "-" + name.rstrip("_")
        if isinstance(default, bool):
            words += [option + "+" if name in ("u", "i") else option] if value else []
        elif isinstance(default, str):
            words += [option, value] if value else []
        else:
            words += [option, *(str(one) if isinstance(one, int) else f"{one:.6f}" for one in (value if isinstance(value, tuple) else [value]))]
        if name == "ab" and arg.ambincl >= 0:
            words += [word for modifier in arg.amblist for word in (("-ae", "-ai")[arg.ambincl], modifier)]
    return words


_current = RayParams()


def get_ray_params() -> RayParams:
    """A copy of the values that set_ray_params() and set_option() have left. They change nothing else: hand them to a function."""
    return copy.copy(_current)


def set_ray_params(rp: RayParams | None = None) -> None:
    """Sets what get_ray_params() returns; None: the defaults.

    Raises:
        TypeError: no RayParams
    """
    global _current
    if rp is not None and not isinstance(rp, RayParams):
        raise TypeError(f"expected RayParams, found {type(rp).__name__}")
    _current = RayParams() if rp is None else copy.copy(rp)


def ray_done(arg: int) -> None:
    """Does nothing: there is no renderer in this process whose memory could be freed."""


def set_option(arg: Sequence[str]) -> None:
    """Changes what get_ray_params() returns by the words of options: ["-ab", "2", "-u-"]. A switch without + or - changes over.

    Raises:
        OptionError: a word that is none of RayParams' options, or has not its numbers; nothing is changed then
        TypeError: `arg` is a text
    """
    global _current
    if isinstance(arg, (str, bytes)):
        raise TypeError(f"expected a sequence of words, found {arg!r:.60}")
    changed = copy.copy(_current)
    words = list(arg)
    at = 0
    while at < len(words):
        at += 1 + _take_option(changed, words[at], words[at + 1:])
    _current = changed


def _take_option(params: RayParams, option: str, rest: list[str]) -> int:
    """How many words of the rest belong to an option."""
    name = "as_" if option == "-as" else option[1:].rstrip("+-")
    if option in ("-ai", "-ae") and rest:
        wanted = option == "-ai"
        params.amblist = [*(params.amblist if params.ambincl == int(wanted) else []), rest[0]]
        params.ambincl = wanted
        return 1
    default = _DEFAULTS.get(name)
    if default is None or not option.startswith("-"):
        raise OptionError(f"unknown option {option!r}")
    if isinstance(default, bool):
        setattr(params, name, {"+": True, "-": False}.get(option[-1], not getattr(params, name)))
        return 0
    count = 3 if isinstance(default, tuple) else 1
    try:
        values = [word if isinstance(default, str) else int(word) if isinstance(default, int) else float(word) for word in rest[:count]]
    except ValueError as problem:
        raise OptionError(f"option {option}: {problem}") from problem
    if len(values) < count:
        raise OptionError(f"option {option}: expected {count} values, found {len(values)}")
    setattr(params, name, tuple(values) if count == 3 else values[0])
    return count
