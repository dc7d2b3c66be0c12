#!/usr/bin/python3
"""Compare the program with Radiance's own pictures and rays; needs python3-numpy and the reference data.

  check_reference.py PROGRAM DATA KIND [NAME]

KIND: cases (radiances of tiny scenes), distances, pixels, rays (single rays through real models), picture NAME,
defaults NAME (the mean with default options). Exit 0: holds, 1: does not, 77: the data are not here (skipped).
"""
import csv, gzip, json, os, pathlib, subprocess, sys, tempfile

import numpy as np

SKIP = 77
RAY_FIELDS = "odpNnLlvsm"  # 20 numbers, then the names of surface and modifier
FIRST_DISTANCE, VALUE, NAMES = 15, slice(17, 20), slice(20, 22)


def table(path):
    with open(path, newline="") as f:
        return list(csv.DictReader(f, delimiter="\t"))


def run(program, command, options, scene, folder, text=None, raypath=".:../lib"):
    env = dict(os.environ, RAYPATH=raypath)
    done = subprocess.run([program, command, *options, *scene], cwd=folder, env=env, input=text,
                          capture_output=True, text=text is not None, timeout=1500)
    if done.returncode != 0:
        error = done.stderr if isinstance(done.stderr, str) else done.stderr.decode()
        raise SystemExit(f"{command} of {scene} failed: {error.strip()[-400:]}")
    return done.stdout


def cases(program, data):
    checker = data / "tools" / "check_cases.py"
    done = subprocess.run([sys.executable, checker, f"{program} trace", data / "spec" / "4-cases"])
    return done.returncode == 0


def distances(program, data):
    folder, good = data / "spec" / "4-cases", 0
    rows = table(folder / "distances.tsv")
    for row in rows:
        out = run(program, "trace", ["-h", "-oLXRl", *row["options"].split()], [row["scene"]], folder, row["ray"] + "\n")
        got, want = [float(x) for x in out.split()], [float(row[c]) for c in "LXRl"]
        if len(got) == 4 and all(abs(g - w) <= 2e-5 * max(abs(w), 1) for g, w in zip(got, want)):
            good += 1
        else:
            print(f"FAILS {row['scene']} [{row['note']}]: got {got} want {want}")
    print(f"{good} of {len(rows)} distances hold")
    return good == len(rows) > 0


def pixels(program, data):
    folder, good, pictures = data / "spec" / "4-cases", 0, {}
    rows = table(folder / "pixels.tsv")
    sys.path.insert(0, str(data / "tools"))
    import compare_pictures
    for row in rows:
        key = (row["scene"], row["rpict options"])
        if key not in pictures:
            with tempfile.TemporaryDirectory() as temp:
                name = os.path.join(temp, "out.hdr")
                run(program, "render", ["--quiet", *row["rpict options"].split(), "-o", name], [row["scene"]], folder)
                picture = compare_pictures.read_hdr(name)
                pictures[key] = picture[0] if isinstance(picture, tuple) else picture
        image = pictures[key]
        got = image[image.shape[0] - 1 - int(row["y"]), int(row["x"])]
        want = np.array([float(row[c]) for c in "RGB"])
        if np.all(np.abs(got - want) <= 0.011 * want.max()):  # one step of the pixel encoding and the table's digits
            good += 1
        else:
            print(f"FAILS {row['scene']} pixel {row['x']} {row['y']}: got {got} want {want}")
    print(f"{good} of {len(rows)} pixels hold")
    return good == len(rows) > 0


def rays(program, data):
    index = {row["name"]: row for row in table(data / "reference" / "pictures" / "index.tsv")}
    ok = True
    for path in sorted((data / "reference" / "rays").glob("*.tsv.gz")):
        name = path.name[:-len(".tsv.gz")]
        with gzip.open(path, "rt") as f:
            options = f.readline().split(";")[0].split()[2:]
            records = [line.rstrip("\n").split("\t") for line in f if line.strip()]
        text = "\n".join(" ".join(r[:6]) for r in records) + "\n"
        row = index[name]
        out = run(program, "trace", ["-h", "-o" + RAY_FIELDS, *options], row["scene files"].split(),
                  data / "scenes" / row["folder"], text)
        mine = [line.split("\t") for line in out.splitlines()]
        hits = values = 0
        for want, got in zip(records, mine):
            w, g = np.array(want[:NAMES.start], float), np.array(got[:NAMES.start], float)
            near = abs(g[FIRST_DISTANCE] - w[FIRST_DISTANCE]) <= 1e-4 * max(w[FIRST_DISTANCE], 1e-9)
            hits += near and want[NAMES] == got[NAMES]
            values += bool(np.all(np.abs(g[VALUE] - w[VALUE]) <= 0.01 * max(w[VALUE].max(), 1e-6)))
        n = len(records)
        print(f"{name}: {n} rays, same surface {hits / n:.4f}, same value {values / n:.4f}")
        ok = ok and len(mine) == n and hits >= 0.99 * n and values >= 0.98 * n
    return ok


def picture(program, data, name, defaults=False):
    row = {r["name"]: r for r in table(data / "reference" / "pictures" / "index.tsv")}[name]
    options = row["options"].split()
    if defaults:  # jitter, subdivision and rough specular samples as they are by default
        view, av = options[options.index("-vf") + 1], options[options.index("-av"):][:4]
        options = ["-vf", view, "-x", "320", "-y", "240", "-ab", "0", *av]
    with tempfile.TemporaryDirectory() as temp:
        out = os.path.join(temp, "mine.hdr")
        run(program, "render", ["--quiet", *options, "-o", out], row["scene files"].split(), data / "scenes" / row["folder"])
        reference = data / "reference" / row["picture"]
        done = subprocess.run([sys.executable, data / "tools" / "compare_pictures.py", "--kind",
                               "deterministic" if not defaults else "converged", "--json", reference, out],
                              capture_output=True, text=True)
        print(name, done.stdout.strip(), done.stderr.strip())
        if not defaults:
            return done.returncode == 0
        figures = json.loads(done.stdout)
        return all(abs(m - 1) < 0.01 for m in np.atleast_1d(figures["mean_ratio"]))


def main(argv):
    if len(argv) < 4:
        print(__doc__, file=sys.stderr)
        return 2
    program, data, kind = str(pathlib.Path(argv[1]).resolve()), pathlib.Path(argv[2]).resolve(), argv[3]
    if not (data / "reference").is_dir():
        print("skipped: the reference data are not here")
        return SKIP
    check = {"cases": cases, "distances": distances, "pixels": pixels, "rays": rays}.get(kind)
    if check:
        return 0 if check(program, data) else 1
    return 0 if picture(program, data, argv[4], defaults=kind == "defaults") else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv))
