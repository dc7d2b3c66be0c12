#!/usr/bin/python3
"""The page of `lightwalk walk`: its modules' own tests, and the page in a browser.

    viewer_test.py modules
    viewer_test.py fake NPM PICTURES
    viewer_test.py page PROGRAM NPM PICTURES
    viewer_test.py time PROGRAM NPM PICTURES
    viewer_test.py compare PROGRAM NPM PICTURES
    viewer_test.py files PROGRAM NPM PICTURES

fake: the page against a server that draws a room without a renderer, and misbehaves when it is told to. NPM is a folder with node_modules;
PICTURES gets a screenshot of each step, or of those that fail. Exit status 77: what is needed is not there.
"""
import json, pathlib, re, shutil, subprocess, sys, tempfile

from scripted_walk import Server

VIEWER = pathlib.Path(__file__).resolve().parent / "viewer"


def modules(node):
    tests = sorted(str(path) for path in VIEWER.glob("*_test.mjs") if not path.name.endswith("page_test.mjs"))
    return subprocess.run([node, "--test", *tests]).returncode


def lacking(npm, *packages):
    """Whether a browser or a package is not there, which is then said."""
    lacks = [name for name in packages if not (pathlib.Path(npm) / "node_modules" / name).is_dir()]
    lacks += [] if shutil.which("chromium") else ["chromium"]
    if lacks:
        print("skipped: no", ", no ".join(lacks), "(tests/run.sh installs what is needed)")
    return bool(lacks)


def fake(node, npm, pictures):
    if lacking(npm, "playwright-core", "ws", "jpeg-js"):
        return 77
    return subprocess.run([node, VIEWER / "page_test.mjs", "--npm", npm, "--pictures", pictures]).returncode


def page(node, program, npm, pictures):
    if lacking(npm, "playwright-core"):
        return 77
    with Server(program, ["--light-group", "auto", "--edge-samples", "2"]) as server:
        # The panel glows with 2 W/(m2 sr), and is the middle of the picture's right half.
        status = subprocess.run([node, VIEWER / "walk_page_test.mjs", "--address", server.address, "--npm", npm, "--pictures", pictures,
                                 "--luminance", "358", "--at", "0.67,0.52"]).returncode
        files = pathlib.Path(pictures)
        return (status or dimmed(program, server.scene, files) or animate(program, server.scene, files / "path.vf") or
                isolux(program, server.scene, files) or edited(program, server.scene, files))


SUNLIT = """!gensky 9 21 {} +s -a 46 -o -7 -m -15
skyfunc glow sky_glow 0 0 4 1 1 1 0
sky_glow source sky 0 0 4 0 0 1 180
void plastic grey 0 0 5 .5 .5 .5 0 0
grey polygon floor 0 0 12  -4 -6 0  4 -6 0  4 6 0  -4 6 0
grey polygon back 0 0 12  -4 6 0  4 6 0  4 6 3  -4 6 3
grey sphere ball 0 0 4 -1 2 .7 .7
"""


def time(node, program, npm, pictures):
    """Whether the page reads at other hours what `lightwalk trace` finds in the scene whose file names these hours."""
    if lacking(npm, "playwright-core"):
        return 77
    with Server(program, ["-ab", "0", "-av", ".1", ".1", ".1", "--edge-samples", "1"], SUNLIT.format("14.3")) as server:
        status = subprocess.run([node, VIEWER / "time_page_test.mjs", "--address", server.address, "--npm", npm, "--pictures", pictures]).returncode
    if status:
        return status
    wrong = 0
    for read in json.loads((pathlib.Path(pictures) / "read.json").read_text()):
        hour = 14.3 if read["hour"] is None else read["hour"]
        ray = " ".join(map(str, read["position"] + read["normal"]))
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder) / "scene.rad"
            scene.write_text(SUNLIT.format(hour))
            options = "-h -I -ab 0 -av .1 .1 .1 -dt .05 -dc .5 -ds .25 -dr 1"  # the walk's
            traced = subprocess.run([program, "trace", *options.split(), scene], input=ray + "\n", text=True, stdout=subprocess.PIPE, check=True).stdout
        lux = 179 * sum(float(value) * weight for value, weight in zip(traced.split(), (0.265106, 0.670106, 0.064788)))
        print(f"time: at {hour} the page has read {read['illuminance']:.2f} lx, trace finds {lux:.2f} lx")
        wrong += abs(read["illuminance"] / lux - 1) > 0.01
    wrong += "gensky 9 21 12.0000 -a 46 -o -7 -m -15 +s\n" not in (pathlib.Path(pictures) / "sky.rad").read_text()
    return 1 if wrong else 0


def compare(node, program, npm, pictures):
    """Whether the page reads of each of two states side by side what `lightwalk trace` finds in the scene that is so."""
    if lacking(npm, "playwright-core"):
        return 77
    with Server(program, ["-ab", "0", "-av", ".1", ".1", ".1", "--edge-samples", "1"], SUNLIT.format("14.3")) as server:
        status = subprocess.run([node, VIEWER / "compare_page_test.mjs", "--address", server.address, "--npm", npm, "--pictures", pictures]).returncode
    if status:
        return status
    wrong = 0
    for read in json.loads((pathlib.Path(pictures) / "compared.json").read_text()):
        way = [place - eye for place, eye in zip(read["position"], read["eye"])]
        rays = {"illuminance": (["-I"], read["position"] + read["normal"]), "luminance": ([], read["eye"] + way)}
        for what, (more, ray) in rays.items():
            with tempfile.TemporaryDirectory() as folder:
                scene = pathlib.Path(folder) / "scene.rad"
                scene.write_text(SUNLIT.format(read["hour"]).replace(".5 .5 .5", " ".join(map(str, read["colour"]))))
                options = "-h -ab 0 -av .1 .1 .1 -dt .05 -dc .5 -ds .25 -dr 1"  # the walk's
                traced = subprocess.run([program, "trace", *options.split(), *more, scene], input=" ".join(map(str, ray)) + "\n", text=True,
                                        stdout=subprocess.PIPE, check=True).stdout
            value = 179 * sum(float(value) * weight for value, weight in zip(traced.split(), (0.265106, 0.670106, 0.064788)))
            print(f"compare: {read['side']} at {read['hour']}: {what} {read[what]:.2f}, trace finds {value:.2f}")
            wrong += abs(read[what] / value - 1) > 0.01
    return 1 if wrong else 0


EDITED = """void plastic grey 0 0 5 .5 .5 .5 0 0
void plastic paint 0 0 5 {paint} 0 0
void light lamp 0 0 3 40 40 40
grey polygon floor 0 0 12  -4 -6 0  4 -6 0  4 6 0  -4 6 0
paint polygon back 0 0 12  -4 {back} 0  4 {back} 0  4 {back} 3  -4 {back} 3
lamp polygon light 0 0 12  -1 -1 2.99  -1 1 2.99  1 1 2.99  1 -1 2.99
"""


def files(node, program, npm, pictures):
    """Whether the page reads, after its scene's file was edited, what `lightwalk trace` finds in that file."""
    if lacking(npm, "playwright-core"):
        return 77
    states = [EDITED.format(paint=paint, back=back) for paint, back in ((".5 .5 .5", 6), (".8 .3 .2", 6), (".8 .3 .2", 4))]
    states[1:1] = [states[0] + "painted sphere ball 0 0 4 0 0 1 .5\n"]  # has an error
    with Server(program, ["-ab", "0", "-av", ".1", ".1", ".1", "--edge-samples", "1"], states[0]) as server:
        folder = pathlib.Path(server.folder.name)
        for k, state in enumerate(states):
            (folder / f"state{k}.rad").write_text(state)
        status = subprocess.run([node, VIEWER / "files_page_test.mjs", "--address", server.address, "--npm", npm, "--pictures", pictures,
                                 "--folder", folder]).returncode
    if status:
        return status
    wrong = 0
    for read in json.loads((pathlib.Path(pictures) / "read.json").read_text()):
        way = [place - eye for place, eye in zip(read["position"], read["eye"])]
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder) / "scene.rad"
            scene.write_text(states[read["state"]])
            traced = subprocess.run([program, "trace", "-h", "-av", ".1", ".1", ".1", "-dt", ".05", "-dc", ".5", "-ds", ".25", "-dr", "1", scene],
                                    input=" ".join(map(str, read["eye"] + way)) + "\n", text=True, stdout=subprocess.PIPE, check=True).stdout
        luminance = 179 * sum(float(value) * weight for value, weight in zip(traced.split(), (0.265106, 0.670106, 0.064788)))
        print(f"files: in state {read['state']} the page has read {read['luminance']:.2f} cd/m2, trace finds {luminance:.2f} cd/m2, "
              f"after {read['seconds']:.2f} s, kept {read['kept']:.2f}")
        wrong += abs(read["luminance"] / luminance - 1) > 0.02
    return 1 if wrong else 0


def isolux(program, scene, files):
    """Trace the points that the page has saved, and compare with its table."""
    told = [float(line.split(",")[3]) for line in (files / "isolux.csv").read_text().splitlines()[1:]]
    options = "-h -I -dt .05 -dc .5 -ds .25 -dr 1"  # the walk's
    traced = subprocess.run([program, "trace", *options.split(), scene], input=(files / "isolux.pts").read_text(), capture_output=True, text=True, check=True).stdout
    lux = [179 * (0.265 * r + 0.670 * g + 0.065 * b) for r, g, b in (map(float, line.split()) for line in traced.splitlines())]
    print(f"isolux: the page's table has {len(told)} illuminances, their mean is {sum(told) / len(told):.2f} lx; traced {sum(lux) / len(lux):.2f} lx")
    near = len(told) == len(lux) and all(abs(a - b) < 1e-3 * max(lux) for a, b in zip(told, lux))
    return 0 if near and max(lux) > 0 else 1


def edited(program, scene, files):
    """Whether the page has read of a changed material what `lightwalk trace` finds in the scene with the materials that the page has saved."""
    materials = (files / "materials.rad").read_text()
    names = set(re.findall(r"^void plastic\s+(\S+)", materials, re.MULTILINE))
    rest = [line for line in scene.read_text().splitlines() if line.split()[:1] != ["void"] or line.split()[2] not in names]
    read = json.loads((files / "edited.json").read_text())
    way = [place - eye for place, eye in zip(read["position"], read["eye"])]
    with tempfile.TemporaryDirectory() as folder:
        changed = pathlib.Path(folder) / "changed.rad"
        changed.write_text(materials + "\n".join(rest) + "\n")
        traced = subprocess.run([program, "trace", "-h", "-dt", ".05", "-dc", ".5", "-ds", ".25", "-dr", "1", changed],
                                input=" ".join(map(str, read["eye"] + way)) + "\n", text=True, stdout=subprocess.PIPE, check=True).stdout
    luminance = 179 * sum(float(value) * weight for value, weight in zip(traced.split(), (0.265106, 0.670106, 0.064788)))
    print(f"edited: the page has read {read['luminance']:.2f} cd/m2, trace finds {luminance:.2f} cd/m2; materials: {', '.join(sorted(names))}")
    return 0 if names and abs(read["luminance"] / luminance - 1) < 0.02 else 1


def dimmed(program, scene, files):
    """Whether the page has read under its dimmers what `lightwalk trace` finds in the scene with the lamps that the page has saved."""
    lamps = (files / "lights.rad").read_text()
    names = set(re.findall(r"^void (?:light|glow)\s+(\S+)", lamps, re.MULTILINE))
    rest = [line for line in scene.read_text().splitlines() if line.split()[2:3] == [] or line.split()[2] not in names or line.split()[0] != "void"]
    read = json.loads((files / "dimmed.json").read_text())
    ray = " ".join(map(str, read["position"] + read["normal"]))
    with tempfile.TemporaryDirectory() as folder:
        scaled = pathlib.Path(folder) / "scaled.rad"
        scaled.write_text(lamps + "\n".join(rest) + "\n")
        traced = subprocess.run([program, "trace", "-h", "-I", scaled], input=ray + "\n", text=True, stdout=subprocess.PIPE, check=True).stdout
    lux = 179 * sum(float(value) * weight for value, weight in zip(traced.split(), (0.265106, 0.670106, 0.064788)))
    print(f"dimmed: the page has read {read['illuminance']:.2f} lx, trace finds {lux:.2f} lx; lamps: {', '.join(sorted(names))}")
    return 0 if names and abs(read["illuminance"] / lux - 1) < 0.01 else 1


def animate(program, scene, path):
    """Draw three frames of the path that the page has saved."""
    with tempfile.TemporaryDirectory() as folder:
        words = ["--path", path.resolve(), "--frames", "3", "-x", "32", "-y", "24", "-o", pathlib.Path(folder) / "frame%d.hdr", scene]
        status = subprocess.run([program, "animate", *words]).returncode
        drawn = len(list(pathlib.Path(folder).glob("*.hdr")))
    print("animate: the page's path has", drawn, "frames")
    return status or (0 if drawn == 3 else 1)


if __name__ == "__main__":
    node = shutil.which("node")
    if not node:
        print("skipped: there is no Node.js")
        sys.exit(77)
    sys.exit({"modules": modules, "fake": fake, "page": page, "time": time, "compare": compare, "files": files}[sys.argv[1]](node, *sys.argv[2:]))
