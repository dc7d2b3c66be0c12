"""Views as options: shifted views, rays of views, and random walks through a room."""
import random

import numpy

#: How many numbers each option of a view takes. -vtv and the like take none.
LENGTHS = {"-vp": 3, "-vd": 3, "-vu": 3, "-vh": 1, "-vv": 1, "-vo": 1, "-va": 1, "-vs": 1, "-vl": 1}
#: The values of options that a view does not name.
DEFAULTS = {"-vp": [0, 0, 0], "-vd": [0, 1, 0], "-vu": [0, 0, 1], "-vh": [45], "-vv": [45], "-vo": [0], "-va": [0],
            "-vs": [0], "-vl": [0]}


def parse(text):
    """{"type": letter, "-vp": [x, y, z], ...} of "-vtv -vp 1 2 3 ..."; words before the first option do not count."""
    view, words = {"type": "v", **{name: list(map(float, numbers)) for name, numbers in DEFAULTS.items()}}, text.split()
    while words and not words[0].startswith("-v"):
        words.pop(0)
    while words:
        name = words.pop(0)
        if name.startswith("-vt") and len(name) == 4:
            view["type"] = name[3]
        elif name in LENGTHS and len(words) >= LENGTHS[name]:
            view[name] = [float(words.pop(0)) for _ in range(LENGTHS[name])]
        else:
            raise ValueError(f"{name} is no option of a view: {text}")
    return view


def words_of(view):
    """A view as text of options: the inverse of parse()."""
    words = ["-vt" + view["type"]]
    for name in LENGTHS:
        words += [name, *(f"{number:.9g}" for number in view[name])]
    return words


def shifted(view, right, up):
    """The view with its picture shifted by shares of its width and height (-vs -vl)."""
    return {**view, "-vs": [view["-vs"][0] + right], "-vl": [view["-vl"][0] + up]}


def lines(views):
    """The text of a file for --path."""
    return "".join("VIEW= " + " ".join(words_of(view)) + "\n" for view in views)


def unit(vector):
    return vector / numpy.linalg.norm(vector)


def rays(view, width, height):
    """Origins and unit directions through the middles of a perspective view's pixels, each height x width x 3, rows
    from the top."""
    if view["type"] != "v":
        raise ValueError(f"rays of a view of type {view['type']}: only perspective ones (-vtv) are known")
    ahead = unit(numpy.array(view["-vd"]))
    right = unit(numpy.cross(ahead, view["-vu"]))
    up = numpy.cross(right, ahead)
    wide, high = (2 * numpy.tan(numpy.radians(view[name][0]) / 2) for name in ("-vh", "-vv"))
    x = ((numpy.arange(width) + 0.5) / width - 0.5 + view["-vs"][0]) * wide
    y = (0.5 - (numpy.arange(height) + 0.5) / height + view["-vl"][0]) * high
    along = ahead + x[None, :, None] * right + y[:, None, None] * up
    return numpy.array(view["-vp"]) + view["-vo"][0] * along, along / numpy.linalg.norm(along, axis=2, keepdims=True)


def random_walk(low, high, count, seed, sizes=(60, 45), reach=0.2, turn=50):
    """`count` views inside a box: an eye that wanders and looks around, upright.

    low, high  corners of the box [m]
    sizes      of the views, across and upright [degrees]
    reach      most way from one view to the next, as a share of the box's sides
    turn       most turn between two views [degrees]: less than 90, so that directions between them are never zero
    The same seed gives the same views.
    """
    if not 0 < turn < 90:
        raise ValueError("turn lies between 0 and 90 degrees")
    chance = random.Random(seed)
    at = [chance.uniform(a, b) for a, b in zip(low, high)]
    heading, views = chance.uniform(0, 360), []
    for _ in range(count):
        pitch = chance.uniform(-15, 15)
        flat = numpy.cos(numpy.radians(pitch))
        direction = [flat * numpy.cos(numpy.radians(heading)), flat * numpy.sin(numpy.radians(heading)),
                     numpy.sin(numpy.radians(pitch))]
        views.append({**parse(""), "-vp": list(at), "-vd": [float(number) for number in direction],
                      "-vh": [sizes[0]], "-vv": [sizes[1]]})
        heading += chance.uniform(-turn, turn)
        at = [min(max(x + chance.uniform(-reach, reach) * (b - a), a), b) for x, a, b in zip(at, low, high)]
    return views
