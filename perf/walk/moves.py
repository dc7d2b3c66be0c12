"""The views of walks, placed so that no wall is in the way."""
import sys

import numpy

from . import pictures, views

MOVES = ("turn", "forward", "backward", "right")
#: A walk sideways keeps so many of its steps away from walls.
MARGIN = 2


def drawn_views(program, start, move, frames, folder):
    """The views that the program itself goes through, from a view given by options."""
    folder.mkdir(parents=True, exist_ok=True)
    program.run([program.lightwalk, "animate", "--quiet", "-x", 16, "-y", 16, "-ps", 1, *start, "--walk", move,
                 "--frames", frames, "-o", folder / "v%04d.hdr", *program.scene.words], timeout=3600)
    found = []
    for i in range(1, frames + 1):
        path = folder / f"v{i:04d}.hdr"
        found.append(views.parse(pictures.view_of(path)))
        path.unlink()
    return found


def free_way(program, origin, direction):
    """The distance to the first surface along a ray [units of the scene]."""
    ray = " ".join(f"{number:.9g}" for number in (*origin, *direction))
    told = program.run([program.lightwalk, "trace", "-h", "-oL", "--quiet", *program.scene.words], input=ray.encode())
    return float(told.split()[0])


def crossing(steps, step, free_left, free_right):
    """Where a walk of `steps` steps to the right begins, in steps to the left of a point: half of them, or more or fewer
    if walls require it. None if the walk does not fit between the walls.

    step, free_left, free_right  lengths, in one unit
    """
    least, most = steps + MARGIN - free_right / step, free_left / step - MARGIN
    return min(max(steps / 2, least), most) if least <= most else None


def sideways(program, forward, frames, folder):
    """A walk to the right that crosses the middle of the walk forward."""
    first, second = drawn_views(program, views.words_of(forward[0]), "right", 2, folder)
    way = numpy.subtract(second["-vp"], first["-vp"])
    step = float(numpy.linalg.norm(way))
    middle = forward[len(forward) // 2]
    free_left, free_right = (free_way(program, middle["-vp"], sign * way / step) for sign in (-1, 1))
    begin = crossing(frames - 1, step, free_left, free_right)
    if begin is None:
        print(f"between walls {free_left + free_right:.3g} apart no walk of {frames - 1} steps of {step:.3g} fits: the "
              "walk sideways goes through one", file=sys.stderr)
        begin = (frames - 1) / 2
    return [{**middle, "-vp": [float(x) for x in numpy.add(middle["-vp"], (i - begin) * way)]} for i in range(frames)]


def views_of_walk(program, file, move, frames, folder):
    """The views of a walk of so many frames from the view in a file, in the program's own steps. A walk backward goes
    where that forward went, from its end: behind the views there are walls. A walk to the right crosses that forward in
    its middle: beside the views there are walls, too."""
    if move in ("turn", "forward"):
        return drawn_views(program, ["-vf", file], move, frames, folder)
    forward = drawn_views(program, ["-vf", file], "forward", frames, folder)
    return forward[::-1] if move == "backward" else sideways(program, forward, frames, folder)
