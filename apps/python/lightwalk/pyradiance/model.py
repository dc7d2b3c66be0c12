"""Primitives and scenes."""

from __future__ import annotations

import errno
import os
from dataclasses import dataclass
from typing import Any, Iterable, Sequence, Union

from ._programs import word_of
from .ot import oconv


@dataclass
class Primitive:
    """A primitive of a scene: a material, a surface ...

    Attributes:
        modifier: what modifies it, "void": nothing
        ptype: "plastic", "polygon" ...
        identifier: its name
        sargs, fargs: its arguments: words, numbers
    """

    __slots__ = ("modifier", "ptype", "identifier", "sargs", "fargs")

    modifier: str
    ptype: str
    identifier: str
    sargs: Sequence[str]
    fargs: Sequence[float]

    def _rows(self) -> list[str]:
        head = f"{self.modifier} {self.ptype} {self.identifier}"
        if self.ptype == "alias" and len(self.sargs) == 1:  # the one kind that has no lists of arguments
            return [f"{head} {_quoted(self.sargs[0])}"]
        return [head, f"{len(self.sargs)} {' '.join(map(_quoted, self.sargs))}", "0", f"{len(self.fargs)} {' '.join(map(str, self.fargs))}"]

    @property
    def bytes(self) -> bytes:
        """As a line of a scene file."""
        return "".join(row.rstrip(" ") + " " for row in self._rows()).encode()

    def __str__(self) -> str:
        return "\n".join(self._rows()) + "\n"


def _quoted(word: Any) -> str:
    text = str(word)
    if text and not any(character.isspace() for character in text):
        return text
    return f"'{text}'" if '"' in text else f'"{text}"'


Part = Union[str, "os.PathLike[str]", Primitive]


class Scene:
    """A scene: files and primitives, from which two octrees are made in the working directory: m{sid}.oct of the materials, and
    {sid}.oct, which extends it, of all.

    Args:
        sid: its name
        kwargs: `materials`, `surfaces`, `sources`, `views` and `sensors` that are added, as sequences
    Raises:
        ValueError: an empty name
        TypeError: another keyword
        FileNotFoundError: a file that is not there
    """

    def __init__(self, sid: str, **kwargs: Any) -> None:
        if len(sid) == 0:
            raise ValueError("Scene id must be at least one character long")
        self._sid = sid
        self._octree = f"{sid}.oct"
        self._moctree = f"m{sid}.oct"
        self._materials: dict[str, str | Primitive] = {}
        self._surfaces: dict[str, str | Primitive] = {}
        self._sources: dict[str, str | Primitive] = {}
        self._views: list[Any] = []
        self._sensors: list[Sequence[float]] = []
        self._changed = True
        adders = {"materials": self.add_material, "surfaces": self.add_surface, "sources": self.add_source, "views": self.add_view,
                  "sensors": self.add_sensor}
        for kind, parts in kwargs.items():
            if kind not in adders:
                raise TypeError(f"Scene: unknown keyword {kind!r}, expected one of {', '.join(adders)}")
            for part in [parts] if isinstance(parts, (str, os.PathLike, Primitive)) else parts:
                adders[kind](part)

    @property
    def sid(self) -> str:
        """Its name."""
        return self._sid

    @property
    def octree(self) -> str:
        """The file of its octree."""
        return self._octree

    @property
    def changed(self) -> bool:
        """Whether its parts have changed since the octrees were made."""
        return self._changed

    @property
    def materials(self) -> dict[str, str | Primitive]:
        """Its materials, by the names of files and primitives."""
        return self._materials

    @property
    def surfaces(self) -> dict[str, str | Primitive]:
        """Its surfaces, by the names of files and primitives."""
        return self._surfaces

    @property
    def sources(self) -> dict[str, str | Primitive]:
        """Its light sources, by the names of files and primitives."""
        return self._sources

    @property
    def views(self) -> list[Any]:
        """Its views."""
        return self._views

    @property
    def sensors(self) -> list[Sequence[float]]:
        """Its sensors, each a point and a direction."""
        return self._sensors

    def add_material(self, material: Part) -> None:
        """Adds a material. Raises as `add_surface`."""
        self._add(material, "_materials")

    def add_surface(self, surface: Part) -> None:
        """Adds surfaces: a file, or a primitive, in place of the one of that name.

        Raises:
            FileNotFoundError: there is no such file
            TypeError: neither
        """
        self._add(surface, "_surfaces")

    def add_source(self, source: Part) -> None:
        """Adds a light source. Raises as `add_surface`."""
        self._add(source, "_sources")

    def add_view(self, view: Any) -> None:
        """Adds a View. The octrees stay right."""
        self._views.append(view)

    def add_sensor(self, sensor: Sequence[float]) -> None:
        """Adds a sensor, six numbers: a point [m], a direction. The octrees stay right.

        Raises:
            ValueError: other than six
        """
        if len(sensor) != 6:
            raise ValueError("Sensor must be a sequence of 6 numbers")
        self._sensors.append(sensor)

    def remove_material(self, material: Part) -> None:
        """Removes a material. Raises as `remove_surface`."""
        self._remove(material, "_materials")

    def remove_surface(self, surface: Part) -> None:
        """Removes surfaces.

        Raises:
            KeyError: the scene does not have them
        """
        self._remove(surface, "_surfaces")

    def remove_source(self, source: Part) -> None:
        """Removes a light source. Raises as `remove_surface`."""
        self._remove(source, "_sources")

    def build(self) -> None:
        """Makes the octrees in the working directory, unless nothing has changed since.

        Raises:
            ProgramError: what is wrong with the scene
        """
        if not self._changed:
            return
        paths, text = parts_of(self._materials.values())
        materials = oconv(*paths, stdin=text, warning=False)
        with open(self._moctree, "wb") as file:
            file.write(materials)
        paths, text = parts_of([*self._surfaces.values(), *self._sources.values()])
        everything = oconv(*paths, stdin=text, warning=False, octree=self._moctree)
        with open(self._octree, "wb") as file:
            file.write(everything)
        self._changed = False

    def _add(self, part: Any, kind: str) -> None:
        name = _name_of(part)
        if not isinstance(part, Primitive) and not os.path.exists(name):
            raise FileNotFoundError(errno.ENOENT, "File not found", name)
        getattr(self, kind)[name] = part if isinstance(part, Primitive) else name
        self._changed = True

    def _remove(self, part: Any, kind: str) -> None:
        name = _name_of(part)
        if name not in getattr(self, kind):
            raise KeyError(f"{name!r} is not in scene {kind[1:]}")
        del getattr(self, kind)[name]
        self._changed = True


def _name_of(part: Any) -> str:
    if isinstance(part, Primitive):
        return part.identifier
    if isinstance(part, (str, os.PathLike)):
        return word_of(part)
    raise TypeError("Unsupported type: ", type(part))


def parts_of(parts: Iterable[str | Primitive]) -> tuple[list[str], bytes | None]:
    """The files of a scene's parts, and the text of its primitives; None: there are none."""
    listed = list(parts)
    text = "".join(str(part) for part in listed if isinstance(part, Primitive)).encode()
    return [part for part in listed if isinstance(part, str)], text or None
