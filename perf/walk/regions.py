"""Regions of a picture in which reflections and things behind panes are seen: mirrors, windows, shiny floors."""
import dataclasses, sys

import numpy

from . import stage, truth, views


@dataclasses.dataclass(frozen=True)
class Region:
    """The pixels whose ray first hits a surface of one of these modifiers."""
    name: str
    place: str  # a view that shows it
    modifiers: tuple


REGIONS = (Region("mirror", "cabin/bath", ("mirror",)), Region("mirror", "cabin/dresser", ("mirror",)),
           Region("window", "cabin/living", ("window_glass", "window_illum")),
           Region("shiny floor", "cabin/living", ("wood_floor",)),
           Region("mirror", "lodge/mirror", ("silvering",)), Region("window", "lodge/window", ("pane", "window_light")),
           Region("shiny floor", "lodge/living", ("floor_wood",)))


def first_modifiers(place, view, shape):
    """The modifier that the ray through the middle of each pixel hits, height x width of text; "*" for none."""
    origins, along = views.rays(view, shape[1], shape[0])
    rays = numpy.concatenate([origins + numpy.zeros_like(along), along], axis=2).astype(numpy.float64)
    told = place.program.run([place.program.lightwalk, "trace", "-h", "-fda", "-om", "--quiet",
                              *place.program.scene.words], input=rays.tobytes())
    return names_of(told, shape)


def names_of(text, shape):
    """The names on the lines of a text, in rows."""
    names = [line.strip() for line in text.split("\n") if line.strip()]
    if len(names) != shape[0] * shape[1]:
        raise ValueError(f"{len(names)} names for {shape[0] * shape[1]} rays")
    return numpy.array(names).reshape(shape)


def mask(names, modifiers):
    """Which pixels meet one of the modifiers."""
    return numpy.isin(names, modifiers)


def measure(traced, wanted, ways, folder, report):
    """Calls report(row) with the errors in each region of the walk's last frame, for each setting."""
    last = len(traced.views)
    names = first_modifiers(traced.place, traced.views[-1], traced.shape)
    for way, words in ways.items():
        place = folder / truth.folder_name(way)
        stage.animate(traced.place, traced.size, traced.views, words.split(), place, depths=True)
        picture = stage.frame(place, last)
        distances = stage.depths(place, last, traced.shape)
        for region in wanted:
            inside = mask(names, region.modifiers)
            if not inside.any():
                print(f"{region.name} of {region.place}: no pixel of the last frame meets "
                      f"{' or '.join(region.modifiers)}", file=sys.stderr)
                continue
            found = truth.summary([traced.frame_error(picture, last, distances, inside)])
            report({"region": region.name, "modifiers": " ".join(region.modifiers), "way": way,
                    "pixels": 100 * float(numpy.mean(inside)), **found})
