#!/usr/bin/python3
"""An office of lamps as a scene for benchmarks: rows of desks under rows of ceiling lamps, in one room.

  office.py [--lamps 8] [--desks 7]     to standard output: lamps x lamps lamps, desks x (desks - 2) desks

The view into it is VIEW. make() writes it with a band of windows, by day, and a view for walks past these."""
import argparse

import bsdf_data

WIDTH, DEPTH, HEIGHT = 24.0, 18.0, 3.0  # [m]
VIEW = f"-vp .5 .5 1.7 -vd {WIDTH} {DEPTH} -4 -vu 0 0 1 -vh 70 -vv 55".split()
MATERIALS = """void plastic white 0 0 5 .75 .75 .75 0 0
void plastic carpet 0 0 5 .25 .22 .2 0 0
void plastic wood 0 0 5 .45 .3 .18 .03 .08
void metal steel 0 0 5 .6 .6 .62 .8 .1
void brightfunc spread 2 max(-Dz,Dz)^2 . 0 0
spread light lamp 0 0 3 18 17 15
"""


def quad(modifier, name, *corners):
    return f"{modifier} polygon {name} 0 0 12 " + " ".join(f"{x:g} {y:g} {z:g}" for x, y, z in corners) + "\n"


def box(modifier, name, low, high):
    """The six sides, turned outwards."""
    (a, b, c), (d, e, f) = low, high
    sides = [((a, b, c), (a, e, c), (d, e, c), (d, b, c)), ((a, b, f), (d, b, f), (d, e, f), (a, e, f)),
             ((a, b, c), (d, b, c), (d, b, f), (a, b, f)), ((a, e, c), (a, e, f), (d, e, f), (d, e, c)),
             ((a, b, c), (a, b, f), (a, e, f), (a, e, c)), ((d, b, c), (d, e, c), (d, e, f), (d, b, f))]
    return "".join(quad(modifier, f"{name}.{i}", *corners) for i, corners in enumerate(sides))


def room():
    w, d, h = WIDTH, DEPTH, HEIGHT
    return (quad("carpet", "floor", (0, 0, 0), (w, 0, 0), (w, d, 0), (0, d, 0)) +
            quad("white", "ceiling", (0, 0, h), (0, d, h), (w, d, h), (w, 0, h)) +
            quad("white", "south", (0, 0, 0), (0, 0, h), (w, 0, h), (w, 0, 0)) +
            quad("white", "north", (0, d, 0), (w, d, 0), (w, d, h), (0, d, h)) +
            quad("white", "west", (0, 0, 0), (0, d, 0), (0, d, h), (0, 0, h)) +
            quad("white", "east", (w, 0, 0), (w, 0, h), (w, d, h), (w, d, 0)))


def desk(name, x, y):
    top = box("wood", name + ".top", (x, y, .70), (x + 1.6, y + .8, .74))
    legs = "".join(f"steel cylinder {name}.leg{i} 0 0 7 {x + dx:g} {y + dy:g} 0 {x + dx:g} {y + dy:g} .7 .03\n"
                   for i, (dx, dy) in enumerate(((.1, .1), (1.5, .1), (1.5, .7), (.1, .7))))
    return top + legs + box("steel", name + ".screen", (x + .5, y + .55, .84), (x + 1.1, y + .58, 1.2))


def lamp(name, x, y):
    return quad("lamp", name, (x - .6, y - .15, HEIGHT - .02), (x - .6, y + .15, HEIGHT - .02), (x + .6, y + .15, HEIGHT - .02),
                (x + .6, y - .15, HEIGHT - .02))


def office(lamps=8, desks=7):
    text = [MATERIALS, room()]
    for i in range(desks):
        for j in range(desks - 2):
            text.append(desk(f"desk.{i}.{j}", 2 + i * (WIDTH - 4) / desks, 2 + j * (DEPTH - 4) / (desks - 2)))
    for i in range(lamps):
        for j in range(lamps):
            text.append(lamp(f"lamp.{i}.{j}", (i + .5) * WIDTH / lamps, (j + .5) * DEPTH / lamps))
    return "".join(text)


#: The material of the windows, and how its data is made, if it has any.
WINDOWS = {"glass": ("void glass window 0 0 3 .8 .8 .8\n", None),
           "blind": ("void BSDF window 6 0 window.xml 0 0 1 . 0 0\n", bsdf_data.blind_file),
           "pane": ("void aBSDF window 5 window.xml 0 0 1 . 0 0\n", bsdf_data.pane_file)}
WALK_VIEW = "rvu -vtv -vp 15 4 1.6 -vd 1 .45 -.1 -vu 0 0 1 -vh 60 -vv 46.8\n"
DAY = """void plastic grass 0 0 5 .1 .2 .05 0 0
void plastic bark 0 0 5 .3 .2 .12 0 0
void plastic brick 0 0 5 .5 .2 .12 0 0
void light sun_light 0 0 3 3e4 2.8e4 2.5e4
sun_light source sun 0 0 4 .7 -.3 .6 .53
void glow sky_glow 0 0 4 .8 .95 1.3 0
sky_glow source sky 0 0 4 0 0 1 180
grass ring field 0 0 8 24 9 -.3  0 0 1  0 200
"""


def outdoors():
    """Trunks near the windows, and a house behind them."""
    trunks = "".join(f"bark cylinder trunk{i} 0 0 7 {28 + 3 * (i % 3)} {1 + 2.3 * i:g} -.3 {28 + 3 * (i % 3)} {1 + 2.3 * i:g} 6 .2\n"
                     for i in range(9))
    return DAY + trunks + box("brick", "house", (45, 6, -.3), (55, 20, 6))


def windowed(kind, lamps=4, desks=5):
    """The office with windows along its east wall, which face the room."""
    w, d, h, sill, lintel, pier = WIDTH, DEPTH, HEIGHT, .9, 2.6, 1
    lines = office(lamps, desks).splitlines(keepends=True)
    inside = "".join(line for line in lines if " polygon east " not in line)

    def part(modifier, name, y0, y1, z0, z1):
        return quad(modifier, name, (w, y0, z0), (w, y0, z1), (w, y1, z1), (w, y1, z0))
    count = 4
    width = (d - pier * (count + 1)) / count
    walls = part("white", "below", 0, d, 0, sill) + part("white", "above", 0, d, lintel, h)
    for i in range(count + 1):
        walls += part("white", f"pier{i}", i * (width + pier), i * (width + pier) + pier, sill, lintel)
    for i in range(count):
        walls += part("window", f"window{i}", pier + i * (width + pier), (i + 1) * (width + pier), sill, lintel)
    return inside + WINDOWS[kind][0] + walls + outdoors()


def make(folder, kind):
    """Write office.rad with windows of a kind, their data, and views/KIND.vf for walks."""
    (folder / "views").mkdir(parents=True, exist_ok=True)
    (folder / "office.rad").write_text(windowed(kind))
    (folder / "views" / f"{kind}.vf").write_text(WALK_VIEW)
    if WINDOWS[kind][1]:
        (folder / "window.xml").write_text(WINDOWS[kind][1]())


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lamps", type=int, default=8)
    parser.add_argument("--desks", type=int, default=7)
    arguments = parser.parse_args()
    print(office(arguments.lamps, arguments.desks), end="")
