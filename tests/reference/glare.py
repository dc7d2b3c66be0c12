#!/usr/bin/python3
"""Glare and false colours of twenty pictures of the demo's lodge and of the cabin, beside those of Radiance's evalglare and pcomb.

  glare.py PROGRAM DATA [--radiance BIN]   DATA: the folder of reference data, which has the cabin; BIN: Radiance's programs (else: PATH)

Our DGP is the published formula's; evalglare has other digits of it, by which it is some .0009 less. In views whose up vector is not perpendicular to
the line of sight evalglare's position indices are up to 2 % less, by an axis that it leaves shorter than 1: these views' are perpendicular.
falsecolor is a script there, not always installed, that has pcomb work out the formula of its manual page: so does this one.
Exit 0: holds, 1: does not, 77: the programs, the data or NumPy are not here (skipped).
"""
import argparse, math, os, pathlib, re, shutil, subprocess, sys, tempfile

HERE = pathlib.Path(__file__).resolve().parent
SIZE = 400
DGP, RELATIVE = 1e-3, 1e-3
# evalglare takes a source to be at the centre of a pixel. Where its mean place lies on the border of two, it is a pixel elsewhere for one of the
# programs: some pictures have such a source, whose numbers may be this far off.
BORDER, FEWEST_WITHIN = 1e-2, 14
STEP, STEPS = 1 / 255, 1e-3  # a step of a pixel's encoding, and the share of values that may differ by it
COLUMNS = "dgp dgi ugr vcp cgi Lveil".split()
LODGE = "-av .2 .2 .19 -ds .3 lodge.rad day.rad".split()
CABIN = ("-av .1 .1 .1 pattmats cabin bathroom furniture winpanes.rad mirrors.rad summerday landscape lights.off daywindows").split()
WALK = (24, 32, 48, 64, 72, 87)  # lines of the lodge's path
PALETTES = {"linear": ("-s 1000", "at=v/1000;"), "decades": ("-s 5000 -log 3", "at=if(v,1+log10(v/5000)/3,0);")}
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
    """The numbers of a picture, and its illuminance. Whatever evalglare's exit status is: it may be 1 although it has printed them."""
    line, lux = (subprocess.run([program, *words, picture], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, timeout=300).stdout.decode()
                 for words in ([], ["-V"]))
    if ":" not in line:
        sys.exit(f"{program} of {picture.name} printed {line!r}")
    return [float(x) for x in line.strip().splitlines()[-1].split(":")[1].split()], float(lux)


def glare_differs(ours, theirs, picture):
    """What is wrong, and how much the numbers differ: of DGP absolutely, of the others relatively (of VCP, of 100 %)."""
    (found, lux), (expected, their_lux) = indices(ours, picture), indices(theirs, picture)
    off = [abs(found[0] - expected[0])]
    off += [abs(a - b) / (100 if name == "vcp" else max(abs(b), 1)) for name, a, b in zip(COLUMNS[1:], found[1:], expected[1:])]
    off.append(abs(lux / their_lux - 1))
    names = [*COLUMNS, "Ev"]
    wrong = [f"{n}: {a}, evalglare's {b}" for n, o, a, b in zip(names, off, [*found, lux], [*expected, their_lux]) if o > (DGP if n == "dgp" else BORDER)]
    return wrong, off


def colours_differ(ours, bin_folder, picture, scratch):
    import numpy
    worst, differing = 0, 0
    for options, place in PALETTES.values():
        for name, made in (("ours", run(ours, "-i", picture, "-pal", "spec", "-lw", "0", "-lh", "0", *options.split())),
                           ("theirs", run(bin_folder / "pcomb", "-e", SPECTRUM.format(place), "-o", picture))):
            (scratch / name).write_bytes(made)
        found, expected = (numpy.frombuffer(run(bin_folder / "pvalue", "-h", "-H", "-df", scratch / name), "<f4") for name in ("ours", "theirs"))
        if found.shape != expected.shape or found.size != 3 * SIZE * SIZE:
            return math.inf, 1
        off = numpy.abs(found - expected)
        worst, differing = max(worst, float(off.max())), max(differing, float((off > 0).mean()))
    return worst, differing


def compare(program, data, bin_folder, scratch):
    for name in ("evalglare", "falsecolor"):
        (scratch / name).symlink_to(program)
    env = dict(os.environ, RAYPATH=f".:{data / 'scenes' / 'lib'}")
    holds, worst, count, within, colours = True, [0] * 7, 0, 0, 0
    for name, folder, view, scene in views(HERE.parent.parent / "apps" / "scenes" / "lodge", data / "scenes" / "cabin"):
        picture = scratch / f"{name}.hdr"
        run(program, "render", "--quiet", *view, "-x", SIZE, "-y", SIZE, "-dj", 0, "-o", picture, *scene, cwd=folder, env=env)
        wrong, off = glare_differs(scratch / "evalglare", bin_folder / "evalglare", picture)
        colour, share = colours_differ(scratch / "falsecolor", bin_folder, picture, scratch)
        if colour > STEP or share > STEPS:
            wrong.append(f"false colours differ by {colour}, {share:.1e} of them")
        for text in wrong:
            print(f"FAILS {name}: {text}")
        holds, count, colours = holds and not wrong, count + 1, max(colours, colour)
        within += max(off[1:]) <= RELATIVE
        worst = [max(a, b) for a, b in zip(worst, off)]
    print(f"{count} pictures, at most: " + ", ".join(f"{n} {w:.1e}" for n, w in zip([*COLUMNS, "Ev"], worst)) + f", false colours {colours:.1e}")
    print(f"{within} pictures have all numbers within {RELATIVE} (at least {FEWEST_WITHIN})")
    return 0 if holds and count == 20 and within >= FEWEST_WITHIN else 1


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--radiance", type=pathlib.Path)
    a = parser.parse_args()
    found = a.radiance or (shutil.which("evalglare") and pathlib.Path(shutil.which("evalglare")).parent)
    if not found or any(not (found / name).exists() for name in ("evalglare", "pcomb", "pvalue")):
        print("evalglare, pcomb and pvalue are not here: skipped")
        return 77
    if b"Wienold" not in subprocess.run([found / "evalglare", "-v"], capture_output=True).stdout:
        print("the evalglare that is here is not Radiance's: skipped")
        return 77
    if not (a.data / "scenes" / "cabin" / "vf").is_dir():
        print(f"{a.data} is not here: skipped")
        return 77
    try:
        import numpy
    except ImportError:
        print("NumPy is not here: skipped")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        return compare(a.program.resolve(), a.data.resolve(), found.resolve(), pathlib.Path(folder))


if __name__ == "__main__":
    sys.exit(main())
