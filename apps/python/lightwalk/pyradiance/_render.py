"""Pictures of scenes, with options that follow from how good they shall be, as rad(1) finds them."""

from __future__ import annotations

import math
import pathlib
import subprocess
import tempfile
from typing import Any, Sequence

from .._errors import InputError
from .._scene import Scene as CompiledScene
from .._walk import PROGRAM
from ..bin import _core
from ._programs import ProgramError, run
from .model import Primitive, Scene, parts_of
from .rad_params import RayParams, View, get_ray_params_args, get_view_args

# What rad(1) gives rpict and rtrace alike, in its order.
_OPTIONS = ("-dp", "-ar", "-ms", "-ds", "-dt", "-dc", "-dr", "-ss", "-st", "-ab of its own", "-af", "-aa", "-ad", "-as", "-av", "-lr", "-lw", "-ab")


def render(scene: Scene, view: View | None = None, quality: str = "Medium", variability: str = "Medium", detail: str = "Medium", nproc: int = 1,
           ncssamp: int = 3, resolution: tuple[int, int] | None = None, ambbounce: int = 0, ambcache: bool = True,
           params: RayParams | None = None) -> bytes:
    """Draws a picture of a scene; see Scene for the files that are made. With ambient values they are kept in {sid}.amb.

    Args:
        scene: the scene
        view: the view; None: the scene's first
        quality, variability, detail: "Low", "Medium" or "High", as in rad files
        nproc: 1: rpict's picture; more: one of rays through the pixels' centres, on so many threads
        ncssamp: more than 3: channels of a spectrum
        resolution: the picture's greatest size [pixels]; None: 512 by 512
        ambbounce: how often light is reflected diffusely
        ambcache: whether ambient values are kept and interpolated
        params: options that replace those found
    Returns:
        the picture
    Raises:
        InputError: what is wrong with the scene or the words, a scene without views
        ProgramError: as rpict()
    """
    if view is None and not scene.views:
        raise InputError(f"render: the scene {scene.sid!r} has no view, and none is given")
    view = scene.views[0] if view is None else view
    seen = get_view_args(view)
    scene.build()
    width, height = resolution or (512, 512)
    size = run("vwrays", ["-c", 1, "-pj", 0, "-pd", 0, "-pa", 1, "-x", width, "-y", height, "-d", *seen]).decode().split()
    words = _light(scene, view, quality, variability, detail, ambbounce, ambcache)
    words += get_ray_params_args(params) if params is not None else []
    if nproc == 1 and ncssamp == 3:
        return run("rpict", [*seen, *size[:4], "-ps", 1, *words, scene.octree], messages="drop")
    rays = run("vwrays", ["-ff", "-c", 1, "-pj", 0, "-pd", 0, "-pa", 1, *size[:4], *seen])
    words += ["-co+", "-cs", ncssamp] if ncssamp > 3 else []
    picture = run("rtrace", ["-ffc", "-n", nproc, *words, *size, scene.octree], rays, "drop")
    return run("getinfo", ["-a", "VIEW=" + " ".join(seen)], picture, "drop")


def _light(scene: Scene, view: View, quality: str, variability: str, detail: str, ambbounce: int, ambcache: bool) -> list[str]:
    lower, upper = _bounds(scene)
    # An eye counts as inside, as pyradiance has it, in the sphere around the box.
    inside = math.dist(view.vp, [(low + high) / 2 for low, high in zip(lower, upper)]) <= math.dist(lower, upper) / 2
    zone = " ".join(f"{low:.6g} {high:.6g}" for low, high in zip(lower, upper))
    lines = [f"ZONE= {'I' if inside else 'E'} {zone}", f"QUALITY= {quality}", f"VARIABILITY= {variability}", f"DETAIL= {detail}"]
    if any("\n" in line for line in lines):
        raise InputError("render: quality, variability and detail are one word each")
    with tempfile.TemporaryDirectory(prefix="lightwalk-") as folder:
        rad = pathlib.Path(folder) / "scene.rif"
        nothing = pathlib.Path(folder) / "nothing.rad"  # a rad file names a scene, which is not read for this
        nothing.touch()
        rad.write_text("\n".join([*lines, f'scene= "{nothing}"']) + "\n")
        done = subprocess.run([str(PROGRAM), "render", str(rad), "-defaults"], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    if done.returncode:
        raise ProgramError("rad", done.returncode, done.stderr)
    found = {line.split()[0]: line.split("#")[0].split() for line in done.stdout.splitlines() if line.startswith("-")}
    # Ambient resolution is told for a cube as large as the zone; it counts in the octree's cube.
    edge = _cube_edge(scene.octree) or max(upper[axis] - lower[axis] for axis in range(3))
    mean = sum(upper[axis] - lower[axis] for axis in range(3)) / 3
    found["-ar"] = ["-ar", str(int(min(int(found["-ar"][1]) * (edge / mean if mean > 0 else 1), 1 << 30)))]
    found["-ab"] = ["-ab", str(int(ambbounce))] if ambcache else ["-ab", str(int(ambbounce)), "-aa", "0"]
    found["-af"] = ["-af", f"{scene.sid}.amb"] if ambcache and ambbounce > 0 else []
    found["-ab of its own"] = ["-ab", "1"] if quality[:1] in ("h", "H") else []  # the last one counts
    if float(found["-ms"][1]) == 0:
        found["-ms"] = []
    return [_as_rad_writes(option, word) for option in _OPTIONS for word in found[option]]


def _as_rad_writes(option: str, word: str) -> str:
    """A word of an option; its numbers stand in pictures' headers."""
    if option == "-af" or word[1:2].isalpha():
        return word
    if option == "-lw" and 0 < float(word) < .001:
        mantissa, exponent = f"{float(word):e}".split("e")
        return f"{float(mantissa):g}e{int(exponent)}"
    text = f"{float(word):g}"
    return text[1:] if text.startswith("0.") and option not in ("-ms", "-av") else text


def _bounds(scene: Scene) -> tuple[Sequence[float], Sequence[float]]:
    """The corners of the box around a scene's surfaces [m]. Its light sources do not count, unless nothing is there without them."""
    problem = None
    for kinds in ([scene.materials, scene.surfaces], [scene.materials, scene.surfaces, scene.sources]):
        try:
            lower, upper = _bounds_of([part for kind in kinds for part in kind.values()])
        except InputError as error:
            problem = error
            continue
        if all(low <= high for low, high in zip(lower, upper)):
            return [float(f"{low:.6g}") for low in lower], [float(f"{high:.6g}") for high in upper]
    raise InputError(f"render: the scene {scene.sid!r} has no surfaces whose bounds could be found") from problem


def _bounds_of(parts: Sequence[str | Primitive]) -> tuple[Any, Any]:
    files, text = parts_of(parts)
    with tempfile.TemporaryDirectory(prefix="lightwalk-") as folder:
        if text:
            file = pathlib.Path(folder) / "primitives.rad"
            file.write_bytes(text)
            files = [*files, str(file)]
        # Commands have run for the octree, which told the warnings, too.
        return _core.Scene(CompiledScene.from_files(*files, allow_commands=True)._complete_source()).bounds()


def _cube_edge(octree: str) -> float | None:
    """The edge of an octree's cube [m], the last of the four texts behind its header; None: the file is no octree."""
    with open(octree, "rb") as file:
        while True:
            line = file.readline()
            if not line:
                return None
            if line in (b"\n", b"\r\n"):
                break
        texts = file.read(256)[2:].split(b"\0")
    try:
        return float(texts[3]) or None
    except (IndexError, ValueError):
        return None
