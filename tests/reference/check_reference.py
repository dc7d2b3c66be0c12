#!/usr/bin/python3
"""Compare the program with Radiance's own pictures and rays; needs python3-numpy and the reference data.

  check_reference.py PROGRAM DATA KIND [NAME]

KIND: cases (radiances of tiny scenes), ambient_cases (with indirect light), bsdf_cases (BSDF files, spectra),
reports (inputs after public bug reports), distances, pixels, rays (single rays
through real models), picture NAME, defaults NAME (the mean with default options),
ambient_error (of indirect light against a converged picture), adaptive (means and rays of -ps 2 and 4). Exit 0: holds, 1: does not, 77: the data are not here (skipped).
"""
import csv, gzip, json, os, pathlib, statistics, subprocess, sys, tempfile

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
    """Values must be exact. Where -dt leaves lights untested Radiance's values depend on which points it computed
    before; ours, which do not, are held to within 1.5 % of testing every light."""
    folder, exact, near = data / "spec" / "4-cases", 0, 0
    rows = table(folder / "index.tsv")
    for row in rows:
        options, count = row["options"].split(), int(row["n"] or 1)
        want, limit = np.array([float(row[c]) for c in "RGB"]), float(row["rel_tol"])

        def value(*more):
            out = run(program, "trace", ["-h", *options, *more], [row["scene"]], folder, (row["ray"] + "\n") * count)
            return np.array(out.split(), float).reshape(count, 3).mean(0)

        got = value()
        if np.all(np.abs(got - want) <= limit * want.max() + 1e-6):
            exact += 1
            continue
        if float(options[options.index("-dt") + 1]) > 0:
            want = value("-dt", "0")
            if np.all(np.abs(got - want) <= 0.015 * want.max()):
                near += 1
                continue
        print(f"FAILS {row['scene']} [{row['note']}]: got {got} want {want}")
    print(f"{exact} of {len(rows)} values are Radiance's, {near} with -dt > 0 are within 1.5 % of testing every light")
    return exact + near == len(rows) > 0


def ambient_cases(program, data):
    done = subprocess.run([sys.executable, data / "tools" / "check_cases.py", f"{program} trace", data / "spec" / "5-cases"])
    return done.returncode == 0


def bsdf_cases(program, data):
    """BSDF files and spectra. Rows of several rays are means, whose limits are six standard errors. Spectral rendering (-cs) is
    not supported. One row's value is the mean of rtrace -u-, whose numbers are correlated: where a hemisphere's rays fall on Klems'
    patches it depends on their number more than on chance (.3661 for 64 rays, .3620 for 256, .3576 for 1024, each +- .00015). Of
    independent numbers (-u+) the same rtrace has .3587, .3587, .3588, and ours are independent: that is its value here."""
    folder, good, count = data / "spec" / "6-cases", 0, 0
    independent = {"52-ambient-proxy-behind.rad": np.full(3, .35868)}
    for row in table(folder / "index.tsv"):
        options, n = row["options"].split(), int(row["n"] or 1)
        if "-cs" in options:
            continue
        count += 1
        want = independent.get(row["scene"], np.array([float(row[c]) for c in "RGB"]))
        out = run(program, "trace", ["-h", *options], [row["scene"]], folder, (row["ray"] + "\n") * n, f".:{data / 'scenes' / 'lib'}")
        got = np.array(out.split(), float).reshape(n, 3).mean(0)
        if np.all(np.abs(got - want) <= float(row["rel_tol"]) * want.max() + 1e-6):
            good += 1
        else:
            print(f"FAILS {row['scene']} [{row['note']}]: got {got} want {want}")
    print(f"{good} of {count} values are Radiance's")
    return good == count > 0


def reports(program, data):
    """Each has a script that finds the right values or messages itself; one is of a lamp of which the reference drops the image. Of
    the others, refused views are tested by client_inbox_test, files behind an octree by added_files_test, rad's files by rad_file_test."""
    folder, failed = data / "reports", 0
    scripts = sorted(folder.glob("*/check.sh"))
    for script in scripts:
        done = subprocess.run(["sh", script, program], capture_output=True, text=True, timeout=300)
        if done.returncode != 0:
            failed += 1
            print(f"FAILS {script.parent.name}: {done.stdout.strip()[-300:]} {done.stderr.strip()[-300:]}")
    lamp = run(program, "trace", "-h -n 1 -dt 0 -ds 0 -dj 0 -dp 0 -dr 1".split(), ["room.rad"], folder / "90-flat-lamp-mirror", "-.5 9.9 2.4 0 0 1\n")
    if any(abs(float(value) - 4.898e-3) > 5e-6 for value in lamp.split()):
        failed += 1
        print(f"FAILS 90-flat-lamp-mirror: got {lamp.strip()}")
    print(f"{len(scripts) + 1 - failed} of {len(scripts) + 1} reports hold")
    return failed == 0 and len(scripts) > 0


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


def as_given(direction):
    """The direction that rtrace was given for a record. It printed the unit vector with seven digits; its input had
    six. Patterns that jump on a lattice plane, where walls stand, show the difference."""
    printed = np.array(direction, float)
    step = 10.0 ** (np.floor(np.log10(np.maximum(np.abs(printed), 1e-30))) - 5)
    for stretch in np.linspace(-1.2e-6, 1.2e-6, 601):
        given = np.array([float(f"{x:.5e}") for x in np.round(printed * (1 + stretch) / step) * step])
        if all(f"{x:.6e}" == text for x, text in zip(given / np.linalg.norm(given), direction)):
            return [f"{x:.5e}" for x in given]
    return direction


def rays(program, data):
    index = {row["name"]: row for row in table(data / "reference" / "pictures" / "index.tsv")}
    ok = True
    for path in sorted((data / "reference" / "rays").glob("*.tsv.gz")):
        name = path.name[:-len(".tsv.gz")]
        with gzip.open(path, "rt") as f:
            options = f.readline().split(";")[0].split()[2:]
            records = [line.rstrip("\n").split("\t") for line in f if line.strip()]
        text = "\n".join(" ".join(r[:3] + as_given(r[3:6])) for r in records) + "\n"
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


def reference_row(data, name):
    return {r["name"]: r for r in table(data / "reference" / "pictures" / "index.tsv")}[name]


def render(program, data, row, options, path):
    run(program, "render", ["--quiet", *options, "-o", path], row["scene files"].split(), data / "scenes" / row["folder"])


def quarter_of_samples(options):
    """The options with a quarter of the hemisphere samples, -ad and -as."""
    value_of = {i + 1 for i, word in enumerate(options) if word in ("-ad", "-as")}
    return [str(int(word) // 4) if i in value_of else word for i, word in enumerate(options)]


def picture(program, data, name):
    """Indirect light with a quarter of the reference's hemisphere samples: twice its noise, in a quarter of the time,
    and the limits are the same. Of 10 % for the blocks, all samples used up 3.6 to 4.2 %, a quarter uses 6.5 to 7.5 %; an eighth fails."""
    row = reference_row(data, name)
    options = row["options"].split()
    with tempfile.TemporaryDirectory() as temp:
        out = os.path.join(temp, "mine.hdr")
        render(program, data, row, quarter_of_samples(options) if row["kind"] == "ambient" else options, out)
        done = subprocess.run([sys.executable, data / "tools" / "compare_pictures.py", "--kind", row["kind"], "--json",
                               data / "reference" / row["picture"], out], capture_output=True, text=True)
        print(name, done.stdout.strip(), done.stderr.strip())
        return done.returncode == 0


def defaults(program, data, name):
    """The mean with jitter, subdivision and rough specular samples as they are by default is that of the
    deterministic picture, which `picture` holds against Radiance's. Both are rendered with four times as many pixels
    a side: one grid of 320x240 pixel centres is itself 1 to 3 % off the mean of this sunlit room."""
    row = reference_row(data, name)
    sys.path.insert(0, str(data / "tools"))
    import compare_pictures
    fixed, means = row["options"].split(), []
    view, av = fixed[fixed.index("-vf") + 1], fixed[fixed.index("-av"):][:4]
    size = ["-x", "1280", "-y", "960"]
    with tempfile.TemporaryDirectory() as temp:
        for options in (fixed + size, ["-vf", view, *size, "-ab", "0", *av]):
            out = os.path.join(temp, "mine.hdr")
            render(program, data, row, options, out)
            picture = compare_pictures.read_hdr(out)
            means.append((picture[0] if isinstance(picture, tuple) else picture).mean((0, 1)))
    ratio = means[1] / means[0]
    print(f"{name}: mean with default options over the deterministic mean {ratio}")
    return bool(np.all(np.abs(ratio - 1) < 0.01))


def compared(data, reference, rendered):
    done = subprocess.run([sys.executable, data / "tools" / "compare_pictures.py", "--kind", "ambient", "--json", reference, rendered],
                          capture_output=True, text=True)
    figures = json.loads(done.stdout)
    return figures["block_p95"], figures["rel_rmse"]


def ambient_error(program, data):
    """With the settings of Radiance's picture of kind medium: against the picture that converged without a cache, ours is
    not farther off than Radiance's, whatever the number of threads (of several threads the median of several pictures: which values
    stand in the cache is up to who is first); pictures of 1, 2 and 8 threads differ by less than a third of that; and the cache takes at most 160 bytes a value, everything counted. summer-living-converged.hdr is ours, of 4096 samples a pixel: -aa 0 -ad 4096, else the same options."""
    row = next(r for r in table(data / "reference" / "pictures" / "index.tsv") if r["kind"] == "medium")
    converged = pathlib.Path(__file__).resolve().parent / "summer-living-converged.hdr"
    theirs = compared(data, converged, data / "reference" / row["picture"])
    print(f"Radiance's: block_p95 {theirs[0]:.4f} rel_rmse {theirs[1]:.4f}")
    ok, errors, pictures = True, [], []
    with tempfile.TemporaryDirectory() as temp:
        for threads, count in (("1", 1), ("2", 3), ("8", 3)):
            stats = os.path.join(temp, "stats.json")
            drawn = []
            for number in range(count):
                picture = os.path.join(temp, f"{threads}-{number}.hdr")
                render(program, data, row, [*row["options"].split(), "-n", threads, "--stats", stats], picture)
                drawn.append((*compared(data, converged, picture), picture))
                ambient = json.loads(pathlib.Path(stats).read_text())["ambient"]
                size = ambient["cache_bytes"] / ambient["cached"]
                ok = ok and size <= 160
                print(f"{threads} threads: block_p95 {drawn[-1][0]:.4f} rel_rmse {drawn[-1][1]:.4f}; {ambient['cached']} values of {size:.1f} bytes")
            errors.append(tuple(statistics.median(figures) for figures in zip(*(one[:2] for one in drawn))))
            pictures.append(sorted(drawn)[len(drawn) // 2][2])  # whose block_p95 is the median
            ok = ok and errors[-1][0] <= theirs[0] and errors[-1][1] <= theirs[1]
        for a, b in ((0, 1), (0, 2), (1, 2)):
            between = compared(data, pictures[a], pictures[b])
            print(f"between them: block_p95 {between[0]:.4f} rel_rmse {between[1]:.4f}")
            ok = ok and all(d < min(errors[a][k], errors[b][k]) / 3 for k, d in enumerate(between))
    return ok


def rpict_rays(picture, spacing, threshold):
    """How many pixels rpict's pattern traces where tracing gives `picture` (rows from the top); the same as
    tests/core/view/rpict_pattern.h, where its rules are."""
    pixel = [[tuple(p) for p in row] for row in picture[::-1].tolist()]
    height, width, rays = len(pixel), len(pixel[0]), 0
    across, up = (140 * spacing + 49) // 99, (99 * spacing + 70) // 140
    density, shown = [across] * (width // across + 3), [[None] * width for _ in range(height)]

    def trace(x, y):
        nonlocal rays
        shown[y][x], rays = pixel[y][x], rays + 1

    def refine(x, y, dx, dy, n, budget):
        if n <= 1:
            return 0
        half, a, b = n // 2, shown[y][x], shown[y + n * dy][x + n * dx]
        mx, my, traced = x + half * dx, y + half * dy, budget > 0 or any(abs(p - q) > threshold * min(p, q) for p, q in zip(a, b))
        if traced:
            trace(mx, my)
        else:
            shown[my][mx] = tuple(p + (q - p) * half / n for p, q in zip(a, b))
        before = refine(x, y, dx, dy, half, int((budget - 1) / 2))
        return traced + before + refine(mx, my, dx, dy, n - half, budget // 2)

    def base_row(y, odd):
        trace(0, y)
        previous, count = 0, across
        for i, anchor in enumerate(range(across if odd else across // 2, width - 1 + across, across)):
            anchor = min(anchor, width - 1)
            trace(anchor, y)
            before, budget = count, count if across <= 2 else max(density[i:i + 2] or [0])
            count = refine(previous, y, 1, 0, anchor - previous, budget // 2)
            density[i:i + 1] = [before if odd else count] if i < len(density) else []
            previous = anchor
        if odd and i + 1 < len(density):
            density[i + 1] = count

    y, odd = height - 1, True
    base_row(y, odd)
    while y > 0:
        below, odd = max(y - up, 0), not odd
        base_row(below, odd)
        count = y - below
        for x in range(width):
            count = refine(x, below, 0, 1, y - below, count // 2)
        y = below
    return rays


def adaptive(program, data):
    """Means of six seeds with -ps 2 and 4 are those of -ps 1 within 1 %, for no more rays than rpict's pattern takes."""
    rows = [(name, reference_row(data, name), data / "scenes") for name in ("summer-bath", "virtual-back", "examp")]
    lodge = pathlib.Path(__file__).resolve().parents[2] / "apps" / "scenes"
    rows.append(("lodge", {"folder": "lodge", "scene files": "lodge.rad day.rad", "options": "-vf views/living.vf -av .35 .33 .30"}, lodge))
    sys.path.insert(0, str(data / "tools"))
    import compare_pictures
    ok = True
    for name, row, scenes in rows:
        words = row["options"].split()
        common = ["-x", "320", "-y", "240", *words[words.index("-vf"):][:2], *words[words.index("-av"):][:4]]
        kinds, means = {"-ps 1": [], "-ps 2 -pt .08": [], "-ps 4 -pt .05": []}, {}
        rays, theirs = dict.fromkeys(kinds, 0), dict.fromkeys(kinds, 0)
        with tempfile.TemporaryDirectory() as temp:
            out, stats = os.path.join(temp, "mine.hdr"), os.path.join(temp, "stats.json")
            for seed in range(6):
                for kind in kinds:
                    options = ["--quiet", *common, *kind.split(), "--seed", str(seed), "--stats", stats, "-o", out]
                    run(program, "render", options, row["scene files"].split(), scenes / row["folder"])
                    picture = compare_pictures.read_hdr(out)
                    picture = picture[0] if isinstance(picture, tuple) else picture
                    kinds[kind].append(picture.mean())
                    if seed == 0:  # counting takes a second, and the counts of seeds are alike
                        full = picture if kind == "-ps 1" else full
                        rays[kind] = json.loads(pathlib.Path(stats).read_text())["rays"]["primary"]
                        theirs[kind] = rays[kind] if kind == "-ps 1" else rpict_rays(full, int(kind.split()[1]), float(kind.split()[3]))
        for kind, values in kinds.items():
            means[kind] = sum(values) / sum(kinds["-ps 1"])
            print(f"{name} {kind}: mean {means[kind]:.4f} of -ps 1, {rays[kind]} rays, rpict's pattern {theirs[kind]}")
            ok = ok and abs(means[kind] - 1) < 0.01 and rays[kind] <= theirs[kind]
    return ok


def main(argv):
    if len(argv) < 4:
        print(__doc__, file=sys.stderr)
        return 2
    program, data, kind = str(pathlib.Path(argv[1]).resolve()), pathlib.Path(argv[2]).resolve(), argv[3]
    if not (data / "reference").is_dir():
        print("skipped: the reference data are not here")
        return SKIP
    check = {"cases": cases, "ambient_cases": ambient_cases, "bsdf_cases": bsdf_cases, "distances": distances, "pixels": pixels, "rays": rays,
             "ambient_error": ambient_error, "adaptive": adaptive, "reports": reports}.get(kind)
    if check:
        return 0 if check(program, data) else 1
    return 0 if {"picture": picture, "defaults": defaults}[kind](program, data, argv[4]) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv))
