"""Walks: the program `lightwalk walk`, beside Python."""

from __future__ import annotations

import os
import pathlib
import subprocess
import tempfile
import weakref
from typing import Any, Iterable

from ._errors import InputError, OptionError
from ._options import words_of
from ._view import ViewLike, view_words
from .bin import _core

PROGRAM = pathlib.Path(__file__).parent / "bin" / "lightwalk"
_THIS_MACHINE = "http://localhost:* http://127.0.0.1:* https://localhost:* https://127.0.0.1:*"


class Walk:
    """A walk that is being served. In a notebook it is shown as its page.

    Attributes:
        address: of the page
    """

    def __init__(self, process: "subprocess.Popen[str]", folder: "tempfile.TemporaryDirectory[str]", address: str, height: int) -> None:
        self.address = address
        self._height = height
        self._process = process
        self._end = weakref.finalize(self, _end, process, folder)

    @property
    def running(self) -> bool:
        """Whether the page is still served."""
        return self._process.poll() is None

    def stop(self) -> None:
        """Ends it; more calls do nothing."""
        self._end()

    def __enter__(self) -> "Walk":
        return self

    def __exit__(self, *_: Any) -> None:
        self.stop()

    def _repr_html_(self) -> str:
        return (f'<iframe src="{self.address}" width="100%" height="{self._height}" style="border:0" allow="fullscreen"></iframe>'
                f'<br><a href="{self.address}" target="_blank">{self.address}</a>')

    def __repr__(self) -> str:
        return f"<lightwalk.Walk at {self.address}{'' if self.running else ', ended'}>"


def _end(process: "subprocess.Popen[str]", folder: "tempfile.TemporaryDirectory[str]") -> None:
    if process.poll() is None:
        process.terminate()
        try:
            process.wait(10)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
    if process.stdout is not None:
        process.stdout.close()
    folder.cleanup()


def start_walk(scene: Any, views: Iterable[ViewLike], port: int, height: int, embed: str | None, options: dict[str, Any]) -> Walk:
    """See `Scene.walk`."""
    for name, value, most in (("port", port, 65535), ("height", height, 100_000)):
        if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= most:
            raise OptionError(f"walk: {name}: expected an integer from 0 to {most}")
    folder = tempfile.TemporaryDirectory(prefix="lightwalk-")
    try:
        words = [str(PROGRAM), "walk", "--port", str(port), "--embed", _THIS_MACHINE if embed is None else str(embed), *words_of("walk", options)]
        for number, view in enumerate(views, 1):
            file = pathlib.Path(folder.name) / f"view{number}.vf"
            file.write_text("VIEW= " + _core.view_text(view_words(view)) + "\n")
            words += ["-vf", str(file)]
        words += _scene_words(scene, pathlib.Path(folder.name))
        problems = pathlib.Path(folder.name) / "messages"
        library = {"RAYPATH": ":".join(scene._source.library)} if scene._source.library else {}
        with problems.open("w") as messages:
            process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=messages, text=True, env=os.environ | library)
        address = process.stdout.readline().strip() if process.stdout is not None else ""
        if address.startswith("http://"):
            return Walk(process, folder, address, height)
        status = process.wait()
        text = problems.read_text(errors="replace").strip()
        if process.stdout is not None:
            process.stdout.close()
        raise (OptionError if status == 2 else InputError)(text or "the walk has ended")
    except BaseException:
        folder.cleanup()
        raise


def _scene_words(scene: Any, folder: pathlib.Path) -> list[str]:
    source = scene._complete_source()
    words = ["--allow-commands"] if source.allow_commands else []
    if source.allow_stale:
        words.append("--stale")
    if source.files:
        return words + [file if file[0] not in "-@$" else "./" + file for file in source.files]
    file = folder / ("scene.rad" if scene._built else "scene")
    file.write_bytes(source.bytes)
    return [*words, str(file)]
