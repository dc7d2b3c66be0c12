#!/usr/bin/python3
"""Glare and false colours of twenty pictures of the demo's lodge and of the cabin, beside those of Radiance's evalglare and pcomb.

  glare.py PROGRAM DATA                            beside what Radiance's programs have told of them, which is in glare.tsv beside this file
  glare.py PROGRAM DATA --radiance BIN [--update]  beside the programs in BIN; --update: make glare.tsv anew by them

DATA: the folder of reference data, which has the cabin. Who changes what these views show makes glare.tsv anew.

Our DGP is the published formula's; evalglare has other digits of it, by which it is some .0009 less. In views whose up vector is not perpendicular to
the line of sight evalglare's position indices are up to 2 % less, by an axis that it leaves shorter than 1: these views' are perpendicular.
falsecolor is a script there, not always installed, that has pcomb work out the formula of its manual page: so does this one, or NumPy in its place.
Exit 0: holds, 1: does not, 77: the data or NumPy are not here (skipped).
"""
import argparse, csv, math, os, pathlib, re, subprocess, sys, tempfile

HERE = pathlib.Path(__file__).resolve().parent
KEPT = HERE / "glare.tsv"
try:
    import numpy
except ImportError:
    print("NumPy is not here: skipped")
    sys.exit(77)
sys.path.insert(0, str(HERE.parents[1] / "perf" / "walk"))
from pictures import read_hdr
SIZE = 400
DGP, RELATIVE = 1e-3, 1e-3
# evalglare takes a source to be at the centre of a pixel. Where its mean place lies on the border of two, it is a pixel elsewhere for one of the
# programs: some pictures have such a source, whose numbers may be this far off.
BORDER, FEWEST_WITHIN = 1e-2, 14
STEP, STEPS = 1 / 255, 1e-3  # a step of a pixel's encoding, and the share of values that may differ by it
LUMINANCE = 179 * numpy.array([.26510582, .67010582, .06478836])  # of the primaries and the white that Radiance assumes
COLUMNS = "dgp dgi ugr vcp cgi Lveil Ev".split()
LODGE = "-av .2 .2 .19 -ds .3 lodge.rad day.rad".split()
CABIN = ("-av .1 .1 .1 pattmats cabin bathroom furniture winpanes.rad mirrors.rad summerday landscape lights.off daywindows").split()
WALK = (24, 32, 48, 64, 72, 87)  # lines of the lodge's path
PALETTES = {"linear": ("-s 1000", "at=v/1000;"), "decades": ("-s 5000 -log 3", "at=if(v,1+log10(v/5000)/3,0);")}  # for falsecolor and for pcomb
SPECTRUM = "v=li(1)*179;{} x=cut(at); ro=cut(1.6*x-.6);go=cut(if(x-.375,1.6-1.6*x,8/3*x));bo=cut(1-8/3*x);cut(y)=if(y-1,1,if(y,y,0));"


def fisheye(text):
    """A view of all that is before the eye, with an up vector perpendicular to the line of sight."""
    point, way = (re.search(rf"-{name} (\S+) (\S+) (\S+)", text).groups() for name in ("vp", "vd"))
    d = [float(x) for x in way]
    size = math.hypot(*d)
    d = [x / size for x in d]
    up = [-d[2] * d[0], -d[2] * d[1], 1 - d[2] * d[2]]
    return ["-vta", "-vp", *point, "-vd", *map(str, d), "-vu", *map(str, up), "-vh", "180", "-vv", "180"]


def views(lodge, cabin):
    """Name, folder, view and scene of each picture."""
    path = (lodge / "views" / "walk.vf").read_text().splitlines()
    for name in ("living", "dining", "window", "terrace"):
        yield f"lodge-{name}", lodge, fisheye((lodge / "views" / f"{name}.vf").read_text()), LODGE
    for line in WALK:
        yield f"lodge-walk{line}", lodge, fisheye(path[line]), LODGE
    for name in "living living2 bath bed fireplace dresser corner liv3 liv5 bedroom".split():
        yield f"cabin-{name}", cabin, fisheye((cabin / "vf" / name).read_text().strip().splitlines()[-1]), CABIN


def run(*words, cwd=None, env=None):
    done = subprocess.run([str(w) for w in words], cwd=cwd, env=env, capture_output=True, timeout=300)
    if done.returncode != 0:
        sys.exit(f"{words[0]} failed: {done.stderr.decode().strip()[-400:]}")
    return done.stdout


def indices(program, picture):
    """The numbers of a picture, the last of them its illuminance [lx]. Whatever evalglare's exit status is: it may be 1 although it has printed them."""
    line, lux = (subprocess.run([program, *words, picture], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, timeout=300).stdout.decode()
                 for words in ([], ["-V"]))
    if ":" not in line:
        sys.exit(f"{program} of {picture.name} printed {line!r}")
    return [*(float(x) for x in line.strip().splitlines()[-1].split(":")[1].split()[:len(COLUMNS) - 1]), float(lux)]


def glare_differs(found, expected):
    """What is wrong, and how much the numbers differ: of DGP absolutely, of the others relatively (of VCP, of 100 %)."""
    least = {"vcp": 100, "Ev": 0}
    off = [abs(found[0] - expected[0])]
    off += [abs(a - b) / max(abs(b), least.get(name, 1)) for name, a, b in zip(COLUMNS[1:], found[1:], expected[1:])]
    most = {"dgp": DGP, "Ev": RELATIVE}
    wrong = [f"{n}: {a}, evalglare's {b}" for n, o, a, b in zip(COLUMNS, off, found, expected) if o > most.get(n, BORDER)]
    return wrong, off


def colours_by_pcomb(bin_folder, picture, place):
    """Red, green and blue that the formula tells, as a picture's pixels hold them."""
    made = run(bin_folder / "pcomb", "-e", SPECTRUM.format(place), "-o", picture)
    (picture.parent / "theirs.hdr").write_bytes(made)
    return read_hdr(picture.parent / "theirs.hdr")


def colours_by_formula(picture, place):
    """The same, by NumPy."""
    v = read_hdr(picture) @ LUMINANCE
    if place == PALETTES["linear"][1]:
        x = numpy.clip(v / 1000, 0, 1)
    else:
        lit = v > 0
        x = numpy.where(lit, numpy.clip(1 + numpy.log10(numpy.where(lit, v, 1) / 5000) / 3, 0, 1), 0)
    green = numpy.where(x > .375, 1.6 - 1.6 * x, 8 / 3 * x)
    rgb = numpy.clip(numpy.stack([1.6 * x - .6, green, 1 - 8 / 3 * x], axis=-1), 0, 1)
    # A pixel is three bytes and an exponent that they share (Ward, Graphics Gems II, 1991).
    exponent = numpy.frexp(rgb.max(-1, keepdims=True))[1]
    return (numpy.floor(numpy.ldexp(rgb, 8 - exponent)) + .5) * numpy.ldexp(1.0, exponent - 8)


def colours_differ(falsecolor, picture, expected):
    """By how much at most, and the share of values that differ at all."""
    worst, differing = 0, 0
    for options, place in PALETTES.values():
        made = picture.parent / "ours.hdr"
        made.write_bytes(run(falsecolor, "-i", picture, "-pal", "spec", "-lw", "0", "-lh", "0", *options.split()))
        found, theirs = read_hdr(made), expected(picture, place)
        if found.shape != theirs.shape or found.size != 3 * SIZE * SIZE:
            return math.inf, 1
        off = numpy.abs(found - theirs)
        worst, differing = max(worst, float(off.max())), max(differing, float((off > 0).mean()))
    return worst, differing


def kept_numbers():
    with open(KEPT, newline="") as file:
        return {row["picture"]: [float(row[column]) for column in COLUMNS] for row in csv.DictReader(file, delimiter="\t")}


def keep(numbers):
    lines = [[name, *(f"{value:.6g}" for value in values)] for name, values in numbers.items()]
    KEPT.write_text("".join("\t".join(line) + "\n" for line in [["picture", *COLUMNS], *lines]))


def compare(program, data, bin_folder, scratch, update):
    for name in ("evalglare", "falsecolor"):
        (scratch / name).symlink_to(program)
    env = dict(os.environ, RAYPATH=f".:{data / 'scenes' / 'lib'}")
    told = {} if bin_folder else kept_numbers()
    coloured = (lambda picture, place: colours_by_pcomb(bin_folder, picture, place)) if bin_folder else colours_by_formula
    holds, worst, count, within, colours, shares = True, [0] * len(COLUMNS), 0, 0, 0, 0
    for name, folder, view, scene in views(HERE.parent.parent / "apps" / "scenes" / "lodge", data / "scenes" / "cabin"):
        picture = scratch / f"{name}.hdr"
        run(program, "render", "--quiet", *view, "-x", SIZE, "-y", SIZE, "-dj", 0, "-o", picture, *scene, cwd=folder, env=env)
        if bin_folder:
            told[name] = indices(bin_folder / "evalglare", picture)
        wrong, off = glare_differs(indices(scratch / "evalglare", picture), told[name])
        colour, share = colours_differ(scratch / "falsecolor", picture, coloured)
        if colour > STEP or share > STEPS:
            wrong.append(f"false colours differ by {colour}, {share:.1e} of them")
        for text in wrong:
            print(f"FAILS {name}: {text}")
        holds, count, colours, shares = holds and not wrong, count + 1, max(colours, colour), max(shares, share)
        within += max(off[1:]) <= RELATIVE
        worst = [max(a, b) for a, b in zip(worst, off)]
    print(f"{count} pictures, at most: " + ", ".join(f"{n} {w:.1e}" for n, w in zip(COLUMNS, worst)) + f", false colours {colours:.1e} ({shares:.1e} of them)")
    print(f"{within} pictures have all numbers within {RELATIVE} (at least {FEWEST_WITHIN})")
    if update:
        keep(told)
    return 0 if holds and count == 20 and within >= FEWEST_WITHIN else 1


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--radiance", type=pathlib.Path)
    parser.add_argument("--update", action="store_true")
    a = parser.parse_args()
    if a.update and not a.radiance:
        parser.error("--update wants --radiance")
    if a.radiance and b"Wienold" not in subprocess.run([a.radiance / "evalglare", "-v"], capture_output=True).stdout:
        parser.error(f"{a.radiance} has not Radiance's evalglare")
    if not (a.data / "scenes" / "cabin" / "vf").is_dir():
        print(f"{a.data} is not here: skipped")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        return compare(a.program.resolve(), a.data.resolve(), a.radiance and a.radiance.resolve(), pathlib.Path(folder), a.update)


if __name__ == "__main__":
    sys.exit(main())
