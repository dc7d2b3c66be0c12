"""Headers, rays of views, transformed scenes, primitives, glare."""

from __future__ import annotations

import re
from typing import Any, Iterable, Iterator, Literal, Sequence

from .._errors import InputError
from ._programs import Input, Path, file_or_bytes, listed, options, run, switches
from ._render import render
from .model import Primitive

__all__ = ["Xform", "evalglare", "get_header", "get_image_dimensions", "getinfo", "parse_primitive", "render", "vwrays"]

_WORD = re.compile(r"""(?P<comment>\#[^\n]*)|"(?P<double>[^"\n]*)"|'(?P<single>[^'\n]*)'|(?P<plain>\S+)""")
_SIZE = re.compile(rb"([-+][XY]) +(\d+) +([-+][XY]) +(\d+)\s*$")


def getinfo(*inputs: Input, dimension_only: bool = False, dimension: bool = False, strip_header: bool = False, replace: str = "", append: str = "",
            command: str = "") -> bytes:
    """Headers of files.

    Args:
        inputs: paths, or one file's bytes
        dimension_only: only the pictures' sizes
        dimension: headers, with the sizes
        strip_header: what follows the header; of one input
        replace, append: a line that takes the place of all, or is added; the file with its new header
        command: one that what follows the header is piped through
    Returns:
        the headers, or the file
    Raises:
        TypeError: bytes beside other inputs
        ValueError: several inputs with `strip_header`
        ProgramError: for a file without a header
        OSError: a file that cannot be read, with `strip_header`
    """
    if len(inputs) > 1 and any(isinstance(one, bytes) for one in inputs):
        raise TypeError("All inputs must be str or Path if one is")
    if strip_header and len(inputs) != 1:
        raise ValueError(f"strip_header requires exactly one input; got {len(inputs)}")
    words: list[Any] = ["-d"] if dimension_only else ["+d"] if dimension else options(r=replace or None) or options(a=append or None)
    words += options(c=command or None)
    given = [file_or_bytes("inputs", one) for one in inputs]
    stdin = given[0][1] if given else None
    if strip_header:
        if stdin is None:
            with open(inputs[0], "rb") as file:
                stdin = file.read()
        return run("getinfo", [*words, "-"], stdin, "drop")
    return run("getinfo", [*words, *(word for file, _ in given for word in file)], stdin, "drop")


def get_header(inp: Input, dimension: bool = False) -> bytes:
    """The header of a file.

    Args:
        inp: the file
        dimension: only a picture's size
    Raises:
        TypeError: `inp` is neither a path nor bytes
        ProgramError: for a file without a header
    """
    file, stdin = file_or_bytes("inp", inp)
    return run("getinfo", [*switches(d=dimension), *file], stdin, "drop")


def get_image_dimensions(image: Input) -> tuple[int, int]:
    """Width and height of a picture [pixels], as its lines run: of a picture whose columns come first ("+X 512 -Y 300") their
    length, and how many they are.

    Raises:
        ValueError: what has no size
        ProgramError: for a file without a header
    """
    text = getinfo(image, dimension_only=True)
    size = _SIZE.search(text)
    if size is None:
        raise ValueError(f"Could not parse image dimensions from {text!r:.200}")
    return int(size[4]), int(size[2])


def vwrays(pixpos: bytes | None = None, unbuf: bool = False, outform: Literal["a", "f", "d", "c"] = "a", ray_count: int = 1, pixel_jitter: float = 0,
           pixel_diameter: float = 0, pixel_aspect: float = 1, xres: int = 512, yres: int = 512, dimensions: bool = False,
           view: Sequence[str] | None = None, pic: Path | None = None, zbuf: Path | None = None) -> bytes:
    """The rays of a view, for rtrace() and Rcontrib.

    Args:
        pixpos: places in the picture [pixels], as text; without: all pixels, line by line
        unbuf: each ray is written at once
        outform: "a" text, "f" and "d" binary numbers
        ray_count: rays a pixel
        pixel_jitter: how far they stray from the pixel's centre, 0 to 1
        pixel_diameter: of the lens [m]
        pixel_aspect: height of a pixel over its width
        xres, yres: the picture's greatest size [pixels]
        dimensions: only the picture's size, as rtrace's options ("-x 512 -y 512 -ld-")
        view: the view's options as words
        pic: a picture that has the view, where none is given
        zbuf: its file of distances; rays then begin where they arrive and go back
    Returns:
        origin and direction of each ray, six numbers
    Raises:
        ValueError: neither a view nor a picture
        ProgramError: for views that are none
    """
    if view is None and pic is None:
        raise ValueError("Either view or pic should be provided.")
    words: list[Any] = [*switches(i=pixpos is not None, u=unbuf), *([f"-f{outform}"] if outform != "a" else [])]
    words += options(c=ray_count, pj=pixel_jitter, pd=pixel_diameter, pa=pixel_aspect, x=xres, y=yres)
    words += [*switches(d=dimensions), *(listed("view", view) if view is not None else [pic, *([zbuf] if zbuf is not None else [])])]
    return run("vwrays", words, pixpos)


def parse_primitive(pstr: str | bytes) -> list[Primitive]:
    """The primitives of a scene's text.

    Args:
        pstr: the text, without commands ("!genbox ..."): Xform writes what they give
    Raises:
        InputError: "line N: what is wrong"
        TypeError: neither a text nor bytes
    """
    if not isinstance(pstr, (str, bytes)):
        raise TypeError(f"expected a text, found {type(pstr).__name__}")
    words = _words(pstr.decode(errors="surrogateescape") if isinstance(pstr, bytes) else pstr)
    primitives = []
    for modifier, line in words:
        if modifier.startswith("!"):
            raise InputError(f"line {line}: a command, where a primitive is expected: Xform(...)() writes what commands give")
        try:
            kind, name = next(words)[0], next(words)[0]
            if kind == "alias":
                primitives.append(Primitive(modifier, kind, name, [next(words)[0]], []))
                continue
            texts = _arguments(words)
            _arguments(words)  # integers, of which no primitive has any
            primitives.append(Primitive(modifier, kind, name, texts, [float(word) for word in _arguments(words)]))
        except StopIteration:
            raise InputError(f"line {line}: a primitive that ends too early") from None
        except ValueError as problem:
            raise InputError(f"line {line}: {problem}") from problem
    return primitives


def _words(text: str) -> Iterator[tuple[str, int]]:
    """Words and the lines that they are in."""
    line, at = 1, 0
    for word in _WORD.finditer(text):
        line += text.count("\n", at, word.start())
        at = word.start()
        if word["comment"] is None:
            yield next(part for part in (word["double"], word["single"], word["plain"]) if part is not None), line


def _arguments(words: Iterator[tuple[str, int]]) -> list[str]:
    count = int(next(words)[0])
    if count < 0:
        raise ValueError(f"{count} arguments")
    return [next(words)[0] for _ in range(count)]


class Xform:
    """Transforms a scene: `Xform("chair.rad").rotatez(30).translate(1, 0, 0)()`. Transformations apply in order.

    Args:
        inp: the scene, a file or its bytes
        expand_cmd: whether commands in it are run
        invert: surfaces face the other way
        iprefix: before all names
        modifier: of all surfaces
    """

    def __init__(self, inp: Input, expand_cmd: bool = True, invert: bool = False, iprefix: str | None = None, modifier: str | None = None) -> None:
        self._input = inp
        self._words: list[Any] = [*switches(c=not expand_cmd), *options(n=iprefix, m=modifier), *switches(I=invert)]

    def __call__(self) -> bytes:
        """Transforms it.

        Returns:
            the scene
        Raises:
            TypeError: `inp` is neither a path nor bytes
            ProgramError: what is wrong with the scene
        """
        file, stdin = file_or_bytes("inp", self._input)
        return run("xform", [*self._words, *file], stdin)

    def _then(self, *words: Any) -> "Xform":
        self._words += words
        return self

    def translate(self, x: float, y: float, z: float) -> "Xform":
        """Moves it by a vector [m]."""
        return self._then("-t", x, y, z)

    def rotatex(self, deg: float) -> "Xform":
        """Turns it about the x axis [degrees]."""
        return self._then("-rx", deg)

    def rotatey(self, deg: float) -> "Xform":
        """Turns it about the y axis [degrees]."""
        return self._then("-ry", deg)

    def rotatez(self, deg: float) -> "Xform":
        """Turns it about the z axis [degrees]."""
        return self._then("-rz", deg)

    def scale(self, ratio: float) -> "Xform":
        """Scales it about the origin."""
        return self._then("-s", ratio)

    def mirrorx(self) -> "Xform":
        """Mirrors it at the plane x = 0."""
        return self._then("-mx")

    def mirrory(self) -> "Xform":
        """Mirrors it at the plane y = 0."""
        return self._then("-my")

    def mirrorz(self) -> "Xform":
        """Mirrors it at the plane z = 0."""
        return self._then("-mz")

    def array(self, number: int) -> "Xform":
        """Makes that many copies, each transformed once more by what follows."""
        return self._then("-a", number)

    def iterate(self, number: int) -> "Xform":
        """Repeats what follows that many times."""
        return self._then("-i", number)


def evalglare(inp: Input, view: list[str] | None = None, detailed: bool = False, ev_only: bool = False, ev: float | Sequence[float] | None = None,
              smooth: bool = False, threshold: float | None = None, task_area: tuple[float, ...] | None = None, masking_file: Path | None = None,
              band_lum_angle: float | None = None, check_file: Path | None = None, correction_mode: str | None = None, peak_extraction: bool = True,
              peak_extraction_value: float = 50000, bg_lum_mode: int = 0, search_radius: float = .2, version: bool = False,
              source_color: tuple[float, float, float] | None = None, fast: int | None = None) -> bytes:
    """Glare in a picture of all that is before an eye.

    Args:
        inp: the picture
        view: its view, as words, where its header does not tell
        detailed: each source of glare, too
        ev_only: only the vertical illuminance [lx]
        ev: vertical illuminance that counts [lx], or with a picture of less than a hemisphere (its greatest, its least)
        smooth: sources of glare grow together
        threshold: from where a pixel is glare: above 100 [cd/m²], or below that times the mean luminance (of the task, where one is given)
        task_area: x, y [pixels] and opening angle [rad] of the task
        masking_file: a picture that masks a part
        band_lum_angle: [degrees] of a band about the horizon whose luminance is told
        check_file: a picture that is written, with the sources of glare in colours
        correction_mode: "l+" ...
        peak_extraction, peak_extraction_value: whether peaks are sources of their own, and from where [cd/m²]
        bg_lum_mode: how the background's luminance is found, 0, 1 or 2
        search_radius: between pixels of one source [rad]
        version: only the program's version
        source_color: of all sources in `check_file`, 0 to 1
        fast: 1 or 2: less is calculated
    Returns:
        what the program prints
    Raises:
        TypeError: `inp` is neither a path nor bytes
        ProgramError: for what is no such picture, and options that the program does not have
    """
    file, stdin = file_or_bytes("inp", inp)
    if version:
        return run("evalglare", ["-v"], messages="drop")
    if ev_only:
        return run("evalglare", ["-V", *file], stdin, "drop")
    words: list[Any] = switches(d=detailed)
    if ev is not None:
        words += ["-I", *ev] if isinstance(ev, Iterable) else ["-i", ev]
    words += [*([f"-{fast}"] if fast is not None else []), *listed("view", view)]
    if check_file is not None:
        words += ["-c", check_file, *(["-u", *source_color] if source_color is not None else [])]
    words += [*switches(s=smooth), *options(b=threshold)]
    if task_area is not None:
        words += ["-T" if check_file is not None else "-t", *task_area]
    words += options(q=bg_lum_mode or None, A=masking_file, B=band_lum_angle or None, C=correction_mode)
    words += options(Y=peak_extraction_value or None) if peak_extraction else ["-x"]
    words += options(r=None if search_radius == .2 else search_radius)
    return run("evalglare", [*words, *file], stdin, "drop")
