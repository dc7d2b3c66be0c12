"""Scenes that walks lead through, and runs of `lightwalk animate` on them."""
import dataclasses, json, pathlib, sys

import office
from runs import Program, Scene, cabin, lodge

from . import pictures, views

#: Constant ambient radiance of all pictures [W/(m2 sr)]: there is no other indirect light.
AMBIENT = ("-av", ".02", ".02", ".02")
#: Views of the walks, as SCENE/FILE; the second word is the file's name in the scene's folder of views.
VIEWS = ("cabin/living", "cabin/interior", "cabin/ext.ne", "lodge/living")
#: The office with windows of a kind: of glass, and of BSDF data.
OFFICES = tuple(f"office/{kind}" for kind in office.WINDOWS)


def view_file(scene, name):
    """The path of a scene's view file, from the scene's folder."""
    return f"vf/{name}" if scene.name == "cabin" else f"views/{name}.vf"


@dataclasses.dataclass(frozen=True)
class Place:
    """A view of a scene, for example "cabin/living"."""
    name: str
    program: Program

    @property
    def file(self):
        return view_file(self.program.scene, self.name.split("/", 1)[1])


def made_office(name, folder):
    """The office of that name, written into a folder of its own in `folder`."""
    kind = name.split("/", 1)[1]
    office.make(folder / kind, kind)
    return Scene("office", folder / kind, ("office.rad",), (f"views/{kind}.vf",), ())


def places(names, lightwalk, scenes, made=None):
    """The places with these names. Without the sample models those in the cabin are left out, and a message says so. Offices are
    written into the folder `made`, without which there are none."""
    found = []
    for name in names:
        scene, _, view = name.partition("/")
        if (scene not in ("cabin", "lodge") or not view) and (made is None or name not in OFFICES):
            sys.exit(f"{name}: a view is cabin/NAME, lodge/NAME or one of {', '.join(OFFICES)}")
        if scene == "cabin" and not (scenes and (scenes / "cabin").is_dir()):
            print(f"{name} is left out: --scenes DIR names no folder that holds the cabin", file=sys.stderr)
            continue
        model = cabin(scenes) if scene == "cabin" else lodge() if scene == "lodge" else made_office(name, made)
        place = Place(name, Program(lightwalk, model))
        if not (place.program.scene.folder / place.file).is_file():
            sys.exit(f"{name}: there is no view {place.program.scene.folder / place.file}")
        found.append(place)
    return found


@dataclasses.dataclass(frozen=True)
class Size:
    """The size of all walks of a run."""
    frames: int
    width: int  # most [pixels]
    height: int
    threads: int  # 0: as the program likes


def picture_words(size):
    words = ["-x", size.width, "-y", size.height, "-ps", 1, *AMBIENT]
    return words + (["-n", size.threads] if size.threads else [])


def animate(place, size, walk, words, folder, depths=False):
    """Draw a walk into f0001.hdr, ... (and f0001.z, ... with `depths`) of the folder. Returns what --stats says.

    walk  views, as of views.parse
    """
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "walk.vf").write_text(views.lines(walk))
    stats = folder / "stats.json"
    place.program.run([place.program.lightwalk, "animate", "--quiet", *picture_words(size), "--path",
                       folder / "walk.vf", *words, "--stats", stats, "-o", folder / "f%04d.hdr",
                       *(["-z", folder / "f%04d.z"] if depths else []), *place.program.scene.words], timeout=36000)
    return json.loads(stats.read_text())


def frame(folder, number):
    """Picture of a frame; the first one has the number 1."""
    return pictures.read_hdr(folder / f"f{number:04d}.hdr")


def depths(folder, number, shape):
    return pictures.read_depths(folder / f"f{number:04d}.z", shape)


def traced_share(stats):
    """Pixels traced for each pixel of a picture, over all frames of a walk: 1 is one frame traced whole."""
    pixels = stats["picture"]["width"] * stats["picture"]["height"]
    return sum(sum(frame["traced"].values()) for frame in stats["reuse"]["frames"]) / pixels
