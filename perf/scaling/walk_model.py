"""What a frame of a walk takes on more cores than there are: a walk is measured, its steps' costs go into a simulation of the
roles that draw it, which is held against what this machine can run, and then tells of clusters."""
import json, pathlib, tempfile

import svg_plot
from experiments import print_table, save
from model import CLUSTER, measure_machine, width, write_cost_map
from runs import Split, about, mpirun
from walks import animate

#: Frames at the end of a measured walk, whose costs count.
LAST = 8


def walk_views(program, options, frames, folder):
    from walk.moves import views_of_walk
    return views_of_walk(program, program.scene.views[0], "turn", frames, folder)


def step_costs(stats, pixels):
    """The costs of a frame's steps on one core, from a run on one thread [s]."""
    frames = stats["reuse"]["frames"]
    last, before = frames[-LAST:], frames[-LAST - 1:-1]
    traced = sum(sum(f["traced"].values()) for f in last)
    points = sum(f["points"] for f in before)
    seconds = {step: sum(f["seconds"][step] for f in last) for step in ("project", "check", "trace", "keep")}
    return {"project": seconds["project"] / points, "check": seconds["check"] / pixels / LAST,
            "trace": seconds["trace"] / max(1, traced), "keep": seconds["keep"] / points, "points": points / pixels / LAST,
            "holes": traced / pixels / LAST}


def frame_of(program, options, views, split, folder):
    """Seconds a frame: from two walks of which one has more frames, so that what comes before the first does not count."""
    from walk.views import lines
    path, stats = folder / "walk.vf", folder / "stats.json"
    taken = []
    for count in (3, len(views)):
        path.write_text(lines(views[:count]))
        start = [] if split.variant == "threads" else mpirun(split.ranks)
        program.run([*start, program.lightwalk, "animate", "--variant", split.variant, "--quiet", "-n", split.threads, "--path",
                     path, "-x", options.size, "-y", options.size * 3 // 4, "-ps", 1, "-av", ".02", ".02", ".02", "--stats",
                     stats, "-o", folder / "r%04d.hdr", *program.scene.words], timeout=3600)
        taken.append(json.loads(stats.read_text())["seconds"]["render"])
    return (taken[1] - taken[0]) / (len(views) - 3)


def predict(program, out, content):
    path = out / "cases-walk.json"
    path.write_text(json.dumps(content, indent=1) + "\n")
    return json.loads(program.run([program.beside("walk_model"), path]))["predictions"]


def cluster_cases():
    """Pictures of a walk on a cluster, ranks of so many threads; all ranks may keep points, or 32 of them."""
    found = []
    for size in ((640, 480), (1920, 1080)):
        for cores in (1, 4, 16, 64, 256):
            for threads in (1, 16):
                if threads > cores:
                    continue
                found.append({"name": f"{size[0]}x{size[1]} {cores // threads}x{threads}", "machine": "cluster", "cores": cores,
                              "ranks": cores // threads, "threads": threads, "width": size[0], "height": size[1]})
    return found


def run(program, options):
    """Frames of a turn: measured on this machine's splits beside what the model says of them, and what clusters reach."""
    scene, size = program.scene, (options.size, options.size * 3 // 4)
    splits = [Split(), Split("hybrid", 1, options.cores), Split("hybrid", options.cores)]
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        views = walk_views(program, options, max(options.frames, LAST + 4), folder)
        alone = type(options)(**{**vars(options), "cores": 1})
        stats = animate(program, alone, views, (), folder)
        pixels = stats["picture"]["width"] * stats["picture"]["height"]
        measured = {str(split): frame_of(program, options, views, split, folder) for split in splits}
        cost_map = folder / "cost.json"
        write_cost_map(program, cost_map, scene.views[0], width(options, "ambient"), (), 1)
        pieces = json.loads(cost_map.read_text())
    costs = {**step_costs(stats, pixels), "shift": 0.01, "encode": pieces["encode_seconds"], "decode": pieces["decode_seconds"],
             "packed_bytes": pieces["packed_bytes"]}
    here = [{"name": str(split), "machine": "here", "ranks": split.ranks, "threads": split.threads, "width": size[0],
             "height": size[1]} for split in splits]
    machines = {"here": measure_machine(program), "cluster": CLUSTER}
    found = predict(program, options.out, {"costs": costs, "machines": machines, "cases": here + cluster_cases()})
    rows = [{"split": p["name"], "measured": measured[p["name"]], "predicted": p["seconds"],
             "error": p["seconds"] / measured[p["name"]] - 1} for p in found if p["machine"] == "here"]
    print_table(rows)
    steps = ("projected", "checked", "traced", "gathered")
    large = [{"picture and split": p["name"], "cores": p["cores"], "frames_a_second": 1 / p["seconds"], "seconds": p["seconds"],
              **{step: p[step] for step in steps}, "master_busy": p["master_busy"], "MB_a_frame": p["bytes_a_frame"] / 1e6}
             for p in found if p["machine"] == "cluster"]
    print_table(large)
    save(options.out, "walk-model", about(scene, options.size), costs=costs, rows=rows, cluster=large)
    lines = {}
    for row in large:
        picture, split = row["picture and split"].split()
        lines.setdefault(f"{picture}, ranks of {split.split('x')[1]}", []).append((row["cores"], row["frames_a_second"]))
    svg_plot.write_lines(options.out / "walk-model.svg", f"A turn on a cluster, {scene.name} (model)", "cores", "frames a second",
                         lines, y_log=2)
