#!/usr/bin/python3
"""The tests of packages that call Radiance's programs, by Lightwalk's names and by Radiance's own.

    suites.py LIGHTWALK --radiance FOLDER --python PYTHON [--serve] SUITE...

FOLDER: Radiance's, with bin/ and lib/. PYTHON: of an environment where the packages and pytest are installed. SUITE: a folder with
a package's tests, as `pip download --no-deps --no-binary :all: bifacial_radiance` (honeybee-radiance, honeybee-radiance-command)
brings them; of FOLDER:WORDS the words, with commas between them, are pytest's. Each is run in copies of it.
Prints for each what passed and failed, seconds, and the tests whose outcome differs. Exit status 1: one fails by Lightwalk's names
that passes by Radiance's. --serve: rtrace by servers of scenes."""
import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as xml


def outcomes(python, suite, words, path, radiance, folder):
    """'passed', 'failed' or 'skipped' of each test, and seconds."""
    copy = folder / "suite"
    shutil.rmtree(copy, ignore_errors=True)
    shutil.copytree(suite, copy, symlinks=True)
    environment = {**os.environ, "PATH": path, "RAYPATH": f".:{radiance / 'lib'}"}
    start = time.perf_counter()
    subprocess.run([python, "-B", "-m", "pytest", "-q", "-p", "no:cacheprovider", "--junitxml", folder / "report.xml", *words],
                   cwd=copy, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
    seconds = time.perf_counter() - start
    if not (folder / "report.xml").exists():
        sys.exit(f"{suite}: pytest did not run")
    found = {}
    for case in xml.parse(folder / "report.xml").iter("testcase"):
        kinds = {child.tag for child in case}
        found[f"{case.get('classname')}.{case.get('name')}"] = (
            "failed" if kinds & {"failure", "error"} else "skipped" if "skipped" in kinds else "passed")
    (folder / "report.xml").unlink()
    return found, seconds


def main():
    parser = argparse.ArgumentParser(usage=__doc__, add_help=False)
    for name in ("lightwalk", "--radiance", "--python"):
        parser.add_argument(name, type=pathlib.Path)
    parser.add_argument("--serve", action="store_true")
    parser.add_argument("suites", nargs="+")
    given = parser.parse_args()
    radiance = given.radiance.resolve()
    rest = f"{given.python.parent.absolute()}:{radiance / 'bin'}:/usr/bin:/bin"
    worse = False
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        subprocess.run([given.lightwalk.resolve(), "install-names", *["--serve"] * given.serve, folder / "names"], check=True,
                       stdout=subprocess.DEVNULL)
        for suite in given.suites:
            place, _, words = suite.partition(":")
            place, words = pathlib.Path(place).resolve(), [word for word in words.split(",") if word]
            theirs, their_seconds = outcomes(given.python, place, words, rest, radiance, folder)
            ours, our_seconds = outcomes(given.python, place, words, f"{folder / 'names'}:{rest}", radiance, folder)
            for name, found, seconds in (("Radiance", theirs, their_seconds), ("Lightwalk", ours, our_seconds)):
                counts = ", ".join(f"{sum(kind == one for one in found.values())} {kind}" for kind in ("passed", "failed", "skipped"))
                print(f"{place.name:32} {name:10} {counts:40} {seconds:7.1f} s", flush=True)
            for test in sorted(theirs.keys() | ours.keys()):
                before, now = theirs.get(test, "absent"), ours.get(test, "absent")
                if before != now:
                    print(f"    {test}: {before} by Radiance's, {now} by Lightwalk's")
                    worse |= before == "passed"
    return int(worse)


if __name__ == "__main__":
    sys.exit(main())
