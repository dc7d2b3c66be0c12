"""Rays and pictures."""

from __future__ import annotations

from typing import Any, Sequence

from ._programs import Path, listed, options, run, switches, word_of


def rpict(view: Sequence[str], octree: Path, xres: int | None = None, yres: int | None = None, report: float = 0,
          report_file: Path | None = None, params: Sequence[str] | None = None) -> bytes:
    """Draws a picture.

    Args:
        view: the view's options as words: ["-vp", "0", "0", "1", ...], as get_view_args() gives them
        octree: the scene
        xres, yres: the picture's greatest size [pixels]
        report: time between reports [s]; 0: none
        report_file: where they go
        params: more options
    Returns:
        the picture (RGBE), radiances [W/(m² sr)]
    Raises:
        ProgramError: for wrong options, and what is wrong with the scene
    """
    words = [*listed("view", view), *(["-t", report] if report else []), *options(e=report_file, x=xres, y=yres), *listed("params", params), octree]
    return run("rpict", words, messages="drop")


def rtrace(rays: bytes, octree: Path, header: bool = True, inform: str = "a", outform: str = "a", irradiance: bool = False,
           irradiance_lambertian: bool = False, outspec: str | None = None, trace_exclude: str = "", trace_include: str = "",
           trace_exclude_file: Path | None = None, trace_include_file: Path | None = None, uncorrelated: bool = False,
           xres: int | None = None, yres: int | None = None, nproc: int | None = None, params: Sequence[str] | None = None,
           report: bool = False, version: bool = False) -> bytes:
    """Traces rays.

    Args:
        rays: origin and direction of each, six numbers as `inform` says
        octree: the scene
        header: whether the answers have one
        inform, outform: a text, f and d binary numbers, c (out) colours as in pictures
        irradiance: rays are sensors: points and normals
        irradiance_lambertian: irradiance where the rays arrive
        outspec: what is told of a ray, as rtrace's -o: "v" (default) its radiance [W/(m² sr)]
        trace_exclude, trace_include: names, between spaces, of the materials that are left out of, or alone make "tT"
        trace_exclude_file, trace_include_file: files of such names
        uncorrelated: random numbers rather than low-discrepancy ones
        xres, yres: the answers are lines of a picture
        nproc: threads
        params: more options
        report: whether its progress report is shown
        version: only the program's version is wanted
    Returns:
        the answers, or the version
    Raises:
        ProgramError: for wrong options, and what is wrong with the scene or the rays
        TypeError: rays that are not bytes
    """
    if version:
        return run("rtrace", ["-version"])
    if not isinstance(rays, bytes):
        raise TypeError("Rays must be bytes")
    words: list[Any] = switches(h=not header, I=irradiance, i=irradiance_lambertian and not irradiance)
    words += [f"-f{inform}{outform}", *([f"-o{outspec}"] if outspec is not None else [])]
    words += _traced(trace_exclude, trace_include, trace_exclude_file, trace_include_file)
    words += [*(["-u+"] if uncorrelated else []), *options(x=xres, y=yres), *(["-n", nproc] if nproc else []), *listed("params", params), octree]
    return run("rtrace", words, rays, "show" if report else "drop")


def _traced(exclude: str, include: str, exclude_file: Path | None, include_file: Path | None) -> list[Any]:
    """The first of rtrace's options -te -ti -tE -tI that is given; -te and -ti take one name each."""
    for option, names in (("-te", exclude), ("-ti", include)):
        if names:
            return [word for name in word_of(names).split() for word in (option, name)]
    if exclude_file is not None:
        return ["-tE", exclude_file]
    return ["-tI", include_file] if include_file is not None else []


class Rcontrib:
    """What modifiers bring to rays: `Rcontrib(rays, octree).add_modifier("sky", binv="rbin", nbins="Nrbins")()`.

    Args:
        inp: rays, as rtrace() takes them
        octree: the scene
        nproc: threads
        yres: records in a line of the output
        inform, outform: as rtrace()'s
        report: time between reports [s]; 0: none
        params: more options
    """

    def __init__(self, inp: bytes, octree: Path, nproc: int = 1, yres: int | None = None, inform: str | None = None,
                 outform: str | None = None, report: int = 0, params: Sequence[str] | None = None) -> None:
        self._rays = inp
        self._octree = octree
        form = f"-f{inform or 'a'}{outform or 'a'}"
        self._words: list[Any] = ["-n", nproc, *listed("params", params), *([form] if form != "-faa" else []), *options(y=yres),
                                  *(["-t", report] if report > 0 else [])]

    def add_modifier(self, modifier: str | None = None, modifier_path: str | None = None, calfile: str | None = None,
                     expression: str | None = None, nbins: str | None = None, binv: str | None = None, param: str | None = None,
                     xres: int | None = None, yres: int | None = None, output: str | None = None) -> "Rcontrib":
        """Adds a modifier, or those of a file.

        Args:
            modifier, modifier_path: its name, or a file of names; one of the two
            calfile, expression: definitions that the bins use: a file, a text
            nbins, binv: how many bins there are, and which of them a ray is in
            param: values of the definitions' variables: "MF=4,rNx=0"
            xres, yres: size of the output
            output: where it goes: "sky.dat", "%s.dat"
        Returns:
            self
        Raises:
            ValueError: neither a modifier nor a file, or both
        """
        if not modifier and not modifier_path:
            raise ValueError("Modifier or modifier path must be provided.")
        if modifier and modifier_path:
            raise ValueError("either a modifier or a modifier path must be provided, not both")
        self._words += options(f=calfile, e=expression, bn=nbins, b=binv, p=param, x=xres, y=yres, o=output, m=modifier or None, M=modifier_path or None)
        return self

    def __call__(self) -> bytes:
        """Traces the rays.

        Returns:
            the contributions, of those modifiers whose output is no file
        Raises:
            ProgramError, TypeError: as rtrace()
        """
        if not isinstance(self._rays, bytes):
            raise TypeError("Rays must be bytes")
        return run("rcontrib", [*self._words, self._octree], self._rays, "drop")
