"""The experiments of perf/run.sh: each function writes NAME.json and NAME.svg, and prints a table."""
import json, os

import svg_plot
from runs import Split, about, measure

#: Speed-ups of the paper's Table 1 (SC'99) on a Cray T3E, by processors.
PAPER = {6: 5.1, 11: 10.2, 31: 31.1, 64: 65.1}


def picture(size):
    return ["-x", size, "-y", size * 3 // 4, "-ps", 1, "-pj", 0]


def save(out, name, head, **content):
    (out / f"{name}.json").write_text(json.dumps({**head, **content}, indent=1) + "\n")
    print(f"{out / name}.json")


def print_table(rows):
    columns = list(rows[0])
    cells = [columns, *([f"{row[c]:.3f}" if isinstance(row[c], float) else str(row[c]) for c in columns]
                        for row in rows)]
    widths = [max(len(line[k]) for line in cells) for k in range(len(columns))]
    for line in cells:
        print("  ".join(word.rjust(width) for word, width in zip(line, widths)))


def table1(program, options):
    """The views at 1, 2, ... ranks, as the paper has them: one process, then master and workers."""
    scene, size = program.scene, options.size
    counts = [1] + [n for n in (2, 3, 4, 5, 6, 8, 11, 16, 31, 64) if n - 1 <= options.cores]
    if len(counts) == 1:
        counts.append(2)
    cases = {}
    for view in scene.views:
        for n in counts:
            split = Split() if n == 1 else Split("ranks", n)
            cases[f"{view} {n}"] = (split, ["-vf", view, *picture(size)])
    found = measure(program, cases, options.runs)
    rows = []
    for view in scene.views:
        base = found[f"{view} 1"]["seconds"]
        for n in counts:
            one = found[f"{view} {n}"]
            rows.append({"view": view, "ranks": n, "workers": max(1, n - 1), "seconds": one["seconds"],
                         "speedup": base / one["seconds"], "spread": one["most"] - one["least"],
                         "others": one["others"]})
    print_table(rows)
    print("the paper, on a Cray T3E:", ", ".join(f"{s} at {n}" for n, s in PAPER.items()))
    save(options.out, "table1", about(scene, size), rows=rows, paper=PAPER)
    lines = {view: [(r["ranks"], r["speedup"]) for r in rows if r["view"] == view] for view in scene.views}
    lines["paper (T3E)"] = list(PAPER.items())
    svg_plot.write_lines(options.out / "table1.svg", f"Speed-up over one process, {scene.name}", "ranks, master included",
                         "speed-up", lines, y_log=2)


def all_splits(cores):
    """Ranks x threads of `cores` that trace, and the same number of threads in one process."""
    splits = [Split("threads", 1, cores)]
    splits += [Split("hybrid", ranks, cores // ranks) for ranks in range(1, cores + 1) if cores % ranks == 0]
    return [*splits, Split("ranks", cores + 1)]


def core_counts(cores):
    return sorted({1, cores, *(2**k for k in range(cores.bit_length()) if 2**k <= cores)})


def splits(program, options):
    """All splits of the cores at hand; strong scaling: the same picture; weak: as many more pixels as cores."""
    scene, view = program.scene, program.scene.views[0]
    cases, rows = {}, []
    for light, extra in (("direct", ()), ("ambient", scene.ambient)):
        for cores in core_counts(options.cores):
            for split in all_splits(cores):
                if light == "ambient" and split.variant == "ranks":
                    split = Split("ranks", cores + 2)  # and an ambient master
                for kind in ("strong", "weak"):
                    if kind == "weak" and (cores == 1 or split.variant == "ranks" and cores == 1):
                        continue
                    size = options.size if kind == "strong" else round(options.size * cores**0.5 / 8) * 8
                    key = (light, cores, kind, split)
                    cases[key] = (split, ["-vf", view, *picture(size), *extra])
    found = measure(program, cases, options.runs)
    for (light, cores, kind, split), one in found.items():
        base = found[(light, 1, "strong", Split())]["seconds"]
        pixels = 1 if kind == "strong" else (round(options.size * cores**0.5 / 8) * 8 / options.size) ** 2
        rows.append({"light": light, "kind": kind, "cores": cores, "split": str(split), "seconds": one["seconds"],
                     "efficiency": base * pixels / one["seconds"] / cores, "spread": one["most"] - one["least"],
                     "ambient_values": one["ambient_values"], "others": one["others"]})
    print_table(rows)
    save(options.out, "splits", about(scene, options.size), rows=rows)
    most = [r for r in rows if r["cores"] == options.cores]
    names = [r["split"] for r in most if r["kind"] == "strong" and r["light"] == "direct"]
    series = {f"{light}, {kind}": [next((r["efficiency"] for r in most if r["light"] == light and r["kind"] == kind
                                        and r["split"].split()[0] == name.split()[0]
                                        and (r["split"] == name or name.startswith("ranks"))), None)
                                  for name in names]
              for light in ("direct", "ambient") for kind in ("strong", "weak")}
    svg_plot.write_bars(options.out / "splits.svg", f"Efficiency on {options.cores} cores, {scene.name}",
                        "of one thread's speed", names, series)


def pixels_sent(messages):
    """(count, bytes) of Pixels of all ranks, from --stats; None where it does not tell."""
    if not messages:
        return None
    per_rank = messages if isinstance(messages, list) else [messages]
    found = [m.get("messages", m).get("WorkResult", {}) for m in per_rank]
    return sum(f.get("count", 0) for f in found), sum(f.get("bytes", 0) for f in found)


def stride(program, options):
    """Blocks dealt out with a stride, and one after the other: time, and how results gather at one owner."""
    from model import model_inputs, predict  # the model tells what --stats does not: when each owner gets its pixels
    scene, view = program.scene, program.scene.views[0]
    ranks = max(5, options.cores + 1)
    strides = {"auto": [], "1": ["--stride", 1], "7": ["--stride", 7]}
    cases = {name: (Split("ranks", ranks), ["-vf", view, *picture(options.size), "--block", 8, *words])
             for name, words in strides.items()}
    found = measure(program, cases, options.runs)
    inputs = model_inputs(program, options, view, (), "stride")
    wanted = [{"name": f"{name}/{n}", "variant": "ranks", "ranks": n, "block": 8, "machine": machine,
               "stride": 0 if name == "auto" else int(name)}
              for n, machine in ((ranks, "here"), (65, "cluster")) for name in strides]
    predicted = {p["name"]: p for p in predict(program, options.out, "stride", inputs, wanted)}
    rows = []
    for name, one in found.items():
        sent = pixels_sent(one["messages"])
        here, large = predicted[f"{name}/{ranks}"], predicted[f"{name}/65"]
        rows.append({"stride": name, "seconds": one["seconds"], "spread": one["most"] - one["least"],
                     "pixel_messages": sent[0] if sent else here["messages"]["WorkResult"]["count"],
                     "owner_share": here["owner_share"], "owner_share_64_workers": large["owner_share"],
                     "busiest_64_workers": large["busiest_busy"], "others": one["others"]})
    print_table(rows)
    save(options.out, "stride", about(scene, options.size), ranks=ranks, rows=rows)
    svg_plot.write_bars(options.out / "stride.svg", f"Results that go to one owner, {scene.name}",
                        "share, of 2 x workers messages in a row", [f"stride {r['stride']}" for r in rows],
                        {f"{ranks - 1} workers": [r["owner_share"] for r in rows],
                         "64 workers (model)": [r["owner_share_64_workers"] for r in rows]})


def ambient_exchange(program, options):
    """Ambient rays and time by the number of ambient values in one message."""
    scene, view = program.scene, program.scene.views[0]
    cases = {str(batch): (Split("ranks", 4), ["-vf", view, *picture(options.size), *scene.ambient,
                                              "--ambient-batch", batch]) for batch in (0, 1, 4, 16, 64, 256)}
    found = measure(program, cases, options.runs)
    rows = [{"batch": name, "seconds": one["seconds"], "spread": one["most"] - one["least"],
             "ambient_rays": one["ambient_rays"], "values": one["ambient_values"],
             "rays_saved": 1 - one["ambient_rays"] / max(1, found["0"]["ambient_rays"]), "others": one["others"]}
            for name, one in found.items()]
    print_table(rows)
    save(options.out, "ambient-exchange", about(scene, options.size), ranks=4, rows=rows)
    svg_plot.write_bars(options.out / "ambient-exchange.svg", f"Ambient rays by --ambient-batch, 4 ranks, {scene.name}",
                        "of those without exchange", [r["batch"] for r in rows],
                        {"rays": [1 - r["rays_saved"] for r in rows],
                         "time": [r["seconds"] / rows[0]["seconds"] for r in rows]})
