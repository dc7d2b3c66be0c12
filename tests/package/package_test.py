#!/usr/bin/python3
"""Installs the library, builds a project outside the source tree with it, and compares its picture with that of
`lightwalk render`, byte for byte: package_test.py CMAKE BUILD_FOLDER PROGRAM"""
import pathlib, shutil, subprocess, sys, tempfile

SCENE = """void plastic grey 0 0 5 .5 .5 .5 .02 .1
void light lamp 0 0 3 9 8 7
grey polygon floor 0 0 12  -9 -9 0  9 -9 0  9 9 0  -9 9 0
grey sphere ball 0 0 4  0 0 1 1
lamp sphere sun 0 0 4  3 -2 6 .5
"""


def run(words, **more):
    done = subprocess.run(words, capture_output=True, text=not more.pop("binary", False), **more)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))}: exit status {done.returncode}\n{done.stdout}\n{done.stderr}")
    return done.stdout


def pixels(picture):
    """Of a Radiance picture: what follows the header, whose dates and history differ."""
    return picture[picture.index(b"\n\n"):]


def main(cmake, build, program):
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for component in ("library", "development", "data"):
            run([cmake, "--install", build, "--prefix", folder / "prefix", "--component", component])
        project = shutil.copytree(pathlib.Path(__file__).parent, folder / "project")
        run([cmake, "-S", project, "-B", folder / "build", f"-DCMAKE_PREFIX_PATH={folder / 'prefix'}", "-DCMAKE_BUILD_TYPE=Release"])
        run([cmake, "--build", folder / "build"])
        scene = folder / "scene.rad"
        scene.write_text(SCENE)
        expected = pixels(run([program, "render", "-vp", "0", "-4", "1", "-x", "80", "-y", "60", "-pa", "0", "-av", ".1", ".1", ".1", scene], binary=True))
        for kind in ("lightwalk", "lightwalk_static"):
            run([folder / "build" / f"picture_with_{kind}", scene, folder / "picture.hdr"])
            found = pixels((folder / "picture.hdr").read_bytes())
            if found != expected:
                sys.exit(f"the picture of {kind} is not that of lightwalk render")
            (folder / "broken.rad").write_text("void plastic grey 0 0 5 .5 .5\n")
            wrong = subprocess.run([folder / "build" / f"picture_with_{kind}", folder / "broken.rad", folder / "no.hdr"], capture_output=True, text=True)
            if wrong.returncode != 1 or "broken.rad:1: " not in wrong.stderr:
                sys.exit(f"an error of {kind} does not name its place: {wrong.returncode} {wrong.stderr}")
    print("installed, found, built; both pictures are those of lightwalk render")


main(*sys.argv[1:])
