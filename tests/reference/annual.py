#!/usr/bin/python3
"""Illuminances of sensors in a room over a year: coefficients of lightwalk contrib beside those of Radiance's rcontrib, times the same skies;
needs python3-numpy.

  annual.py PROGRAM                 compare with what rcontrib has brought, which lies in annual/ beside this file
  annual.py PROGRAM --radiance BIN  the same, and by the programs gendaymtx and dctimestep of BIN as well, which must tell the same
  annual.py PROGRAM --radiance BIN --update   first make annual/ anew: skies.mtx.gz by gendaymtx, illuminances.txt by rcontrib and dctimestep

Without --radiance the programs are used where they stand on PATH. The weather is made up: the 15th of every other month, from clear to overcast.
What is random is held to its noise, which coefficients of another seed tell. Exit 0: holds, 1: does not, 77: NumPy is not here (skipped).
"""
import argparse, gzip, math, os, pathlib, shutil, subprocess, sys, tempfile

HERE = pathlib.Path(__file__).resolve().parent / "annual"
SENSORS = [(x, y) for y in (.5, 1.5, 2.5, 3.5, 4.5, 5.5) for x in (1, 3)]
RAYS = "".join(f"{x} {y} .8 0 0 1\n" for x, y in SENSORS).encode()
LUMENS = [179 * .265, 179 * .670, 179 * .065]  # of red, green and blue: Radiance's
DIVISIONS = 16384
CONVERGED = 262144  # of rcontrib: its noise is a quarter of that
MORE_THAN_NOISE = 1.5  # how much farther off than another seed's coefficients are, root mean square
MEAN = .01  # most by which the mean of all may be off
CACHED, CACHED_MEAN = .02, .015  # with --cache and a quarter of the divisions: root mean square; the mean; seen: .0115, .005


def contrib(program, divisions, out, more=()):
    """Daylight coefficients, with a header."""
    words = (f"-I+ -ab 3 -ad {divisions} -lw {.2 / divisions:.1e} -f patches.cal -b patch -bn 146 -m sky -y {len(SENSORS)} -faf").split()
    out.write_bytes(subprocess.run([*program, *words, *more], input=RAYS, stdout=subprocess.PIPE, check=True, cwd=HERE).stdout)
    return out


def matrix(data):
    """Rows, columns and colours of a matrix with a header."""
    import numpy
    head, _, body = data.partition(b"\n\n")
    words = dict(line.split(b"=", 1) for line in head.splitlines() if b"=" in line)
    shape = [int(words[name]) for name in (b"NROWS", b"NCOLS", b"NCOMP")]
    if words[b"FORMAT"].strip() == b"ascii":
        return numpy.array(body.split(), float).reshape(shape)
    return numpy.frombuffer(body, "<f4").reshape(shape).astype(float)


def illuminances(coefficients, skies):
    """Of each sensor at each hour [lx]."""
    import numpy
    return numpy.einsum("spc,phc,c->sh", coefficients, skies, LUMENS)


def weather():
    """A year of Berlin's latitude in Radiance's format .wea: direct normal and diffuse horizontal irradiance."""
    lines = ["place made_up", "latitude 52", "longitude -13", "time_zone -15", "site_elevation 40", "weather_data_file_units 1"]
    for month in range(2, 13, 2):
        declination = math.radians(-23.45 * math.cos(2 * math.pi * (month - .17) / 12))
        clear = month * 7 % 12 / 12 + .1
        for hour in range(24):
            up = (math.sin(math.radians(52)) * math.sin(declination)
                  + math.cos(math.radians(52)) * math.cos(declination) * math.cos(math.pi * (hour - 11.5) / 12))
            direct, diffuse = (round(800 * clear * up ** .7), round(30 + 250 * (1 - .6 * clear) * up)) if up > .1 else (0, 0)
            lines.append(f"{month} 15 {hour + .5} {direct} {diffuse}")
    return "\n".join(lines) + "\n"


def skies_by(programs, scratch):
    """The skies of the hours with light, of a row a patch."""
    wea = scratch / "year.wea"
    wea.write_text(weather())
    return subprocess.run([programs / "gendaymtx", "-m", "1", "-u", "-of", wea.name], stdout=subprocess.PIPE, check=True, cwd=scratch).stdout


def product_by(programs, coefficients, skies, scratch):
    (scratch / "skies.mtx").write_bytes(skies)
    done = subprocess.run([programs / "dctimestep", coefficients, scratch / "skies.mtx"], stdout=subprocess.PIPE, check=True)
    return matrix(done.stdout) @ LUMENS


def update(programs, scratch):
    import numpy
    os.environ["RAYPATH"] = f".:{programs.parent / 'lib'}:{os.environ.get('RAYPATH', '')}"
    skies = skies_by(programs, scratch)
    (HERE / "skies.mtx.gz").write_bytes(gzip.compress(skies, mtime=0))
    with open(scratch / "room.oct", "wb") as octree:
        subprocess.run([programs / "oconv", "room.rad"], cwd=HERE, stdout=octree, check=True)
    theirs = contrib([programs / "rcontrib", "-n", "2"], CONVERGED, scratch / "theirs.mtx", [scratch / "room.oct"])
    numpy.savetxt(HERE / "illuminances.txt", product_by(programs, theirs, skies, scratch), "%.1f",
                  header="rows: sensors, columns: hours with light [lx]; annual.py --update makes this file")


class Comparison:
    def __init__(self, expected):
        self.expected, self.holds = expected, True

    def tell(self, name, found, most, most_mean):
        import numpy
        rms = numpy.sqrt(((found - self.expected) ** 2).sum() / (self.expected ** 2).sum())
        mean = found.sum() / self.expected.sum() - 1
        good = rms <= most and abs(mean) <= most_mean
        self.holds = self.holds and good
        worst = numpy.abs(found.sum(1) / self.expected.sum(1) - 1).max()
        print(f"{name}: root mean square {rms:.4f} (at most {most:.4f}), mean {mean:+.4f} (at most {most_mean}), "
              f"a sensor's year at most {worst:.4f}{'' if good else ': WRONG'}")


def compare(program, programs, scratch):
    import numpy
    data = gzip.decompress((HERE / "skies.mtx.gz").read_bytes())
    skies = matrix(data)
    ours = [program, "contrib"]
    first = contrib(ours, DIVISIONS, scratch / "first.mtx", ["room.rad"])
    of = {name: illuminances(matrix(contrib(ours, divisions, scratch / "x.mtx", [*more, "room.rad"]).read_bytes()), skies)
          for name, divisions, more in (("first", DIVISIONS, []), ("second", DIVISIONS, ["--seed", "7"]), ("cached", DIVISIONS // 4, ["--cache"]))}
    comparison = Comparison(numpy.loadtxt(HERE / "illuminances.txt"))
    difference = ((of["first"] - of["second"]) ** 2).sum() / (comparison.expected ** 2).sum()
    noise = (difference / 2) ** .5
    comparison.tell("contrib", of["first"], MORE_THAN_NOISE * noise, MEAN)
    comparison.tell(f"contrib --cache, {DIVISIONS // 4} divisions", of["cached"], CACHED, CACHED_MEAN)
    if programs:
        again = product_by(programs, first, skies_by(programs, scratch), scratch)
        off = numpy.abs(again - of["first"]).max() / of["first"].max()
        print(f"by gendaymtx and dctimestep: the same to {off:.1e} of the largest")
        comparison.holds = comparison.holds and off < 1e-4
    else:
        print("gendaymtx and dctimestep are not here: the product is computed without them")
    return 0 if comparison.holds else 1


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--radiance", type=pathlib.Path)
    parser.add_argument("--update", action="store_true")
    a = parser.parse_args()
    try:
        import numpy
    except ImportError:
        print("NumPy is not here: skipped")
        return 77
    programs = a.radiance
    if not programs and shutil.which("gendaymtx") and shutil.which("dctimestep"):
        programs = pathlib.Path(shutil.which("dctimestep")).parent
    with tempfile.TemporaryDirectory() as folder:
        if a.update:
            if not a.radiance:
                sys.exit("--update needs --radiance")
            update(programs.resolve(), pathlib.Path(folder))
        return compare(pathlib.Path(a.program).resolve(), programs and programs.resolve(), pathlib.Path(folder))


if __name__ == "__main__":
    sys.exit(main())
