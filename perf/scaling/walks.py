"""Measures walks: share of reused pixels, speed-up over traced frames, and errors."""
import json, pathlib, shutil, statistics, subprocess, sys, tempfile

import svg_plot
from experiments import print_table, save
from runs import ROOT, about

sys.path.append(str(ROOT / "perf"))  # the package walk; as it needs NumPy, it is imported where it is used

MOVES = ("turn", "forward", "backward", "right")
#: Settings of points and of their reuse: ours, and those that imitate the paper.
MODES = {"supersaturated": ("--reuse", "supersaturated"), "cloud": ("--reuse", "cloud"),
         "paper": ("--reuse", "supersaturated", "--look", "forward", "--check", "edges"),
         "paper, first": ("--reuse", "cloud", "--look", "forward", "--check", "edges")}
#: Share of the pixels that the paper (SC'99) reused: indoors; its forest had 85 %, its first version 90 %.
PAPER = {"turn": 0.97, "forward": 0.94}


def views_of(scene):
    return ("vf/living", "vf/interior", "vf/ext.ne") if scene.name == "cabin" else scene.views[:2]


def animate(program, options, views, words, folder):
    """--stats of a walk whose frames are f0001.hdr ... in the folder. views: as of views_of_walk."""
    from walk.views import lines
    stats, path = folder / "stats.json", folder / "walk.vf"
    path.write_text(lines(views))
    program.run([program.lightwalk, "animate", "--quiet", "-n", options.cores, "--path", path, "-x", options.size, "-y",
                 options.size * 3 // 4, "-ps", 1, "-av", ".02", ".02", ".02", *words, "--stats", stats, "-o",
                 folder / "f%04d.hdr", *program.scene.words], timeout=7200)
    return json.loads(stats.read_text())


def frame_seconds(stats):
    """Median time of all frames but the first, all steps included."""
    return statistics.median(sum(frame["seconds"].values()) for frame in stats["reuse"]["frames"][1:])


def table2(program, options):
    """Share of reused pixels and speed-up over traced frames, for each walk and way, beside the paper's Table 2."""
    from walk.moves import views_of_walk
    rows = []
    for view in views_of(program.scene):
        for move in MOVES:
            with tempfile.TemporaryDirectory() as scratch:
                views = views_of_walk(program, view, move, options.frames, pathlib.Path(scratch))
                full = animate(program, options, views, ("--reuse", "off"), pathlib.Path(scratch))
                traced = full["seconds"]["render"] / options.frames
                for mode, words in MODES.items():
                    stats = animate(program, options, views, words, pathlib.Path(scratch))
                    seconds = frame_seconds(stats)
                    rows.append({"view": view, "walk": move, "mode": mode, "reused": stats["reuse"]["reused"],
                                 "paper": PAPER.get(move, "-"), "traced_s": traced, "frame_s": seconds,
                                 "speedup": traced / seconds})
                    print(f"{view} {move} {mode}: {stats['reuse']['reused']:.1%}", file=sys.stderr, flush=True)
    print_table(rows)
    save(options.out, "table2", about(program.scene, options.size), frames=options.frames, cores=options.cores,
         rows=rows)
    series = {mode: [statistics.mean(r["reused"] for r in rows if r["walk"] == move and r["mode"] == mode)
                     for move in MOVES] for mode in MODES}
    series["SC'99"] = [PAPER.get(move) for move in MOVES]
    svg_plot.write_bars(options.out / "table2.svg", f"Pixels reused from frame to frame, {program.scene.name}",
                        "share of the pixels", MOVES, series)


def film_of(folder, name, frames):
    """NAME.mp4 where ffmpeg is installed, else NAME.png: at most eight of the frames, one below the other. Returns its
    path."""
    import numpy
    from walk import pictures
    if shutil.which("ffmpeg"):
        path = folder / f"{name}.mp4"
        height, width, _ = frames[0].shape
        subprocess.run(["ffmpeg", "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s",
                        f"{width}x{height}", "-framerate", "12", "-i", "pipe:0", "-vf",
                        "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p", str(path)],
                       input=b"".join(frame.tobytes() for frame in frames), check=True)
        return path
    path = folder / f"{name}.png"
    count = min(8, len(frames))
    chosen = [frames[k * (len(frames) - 1) // max(count - 1, 1)] for k in range(count)]
    pictures.write_png(path, numpy.concatenate(chosen))
    return path


def film_frames(folders, count):
    """Pictures of a film: what is shown, and beside it how far it is off (see error_image); and for each the share of
    the pixels that are off by more than a tenth."""
    import numpy
    from walk import pictures
    scale, frames, off = None, [], []
    for i in range(1, count + 1):
        truth, reused = (pictures.read_hdr(folders[name] / f"f{i:04d}.hdr") for name in ("truth", "reused"))
        is_, should = pictures.luminance(reused), pictures.luminance(truth)
        off.append(float(numpy.mean(pictures.off(is_, should))))
        scale = scale or pictures.exposure(truth)  # all frames as the first one
        beside = pictures.error_image(is_, should)
        frames.append((255 * numpy.concatenate([pictures.shown(reused, scale), beside], axis=1)).astype(numpy.uint8))
    return frames, off


def walkfilm(program, options):
    """Each walk as a film: what is shown, and beside it how far it is off."""
    from walk.moves import views_of_walk
    rows, lines = [], {}
    for view in views_of(program.scene):
        name = pathlib.Path(view).stem if view.endswith(".vf") else pathlib.Path(view).name
        for move in MOVES:
            with tempfile.TemporaryDirectory() as scratch:
                folders = {kind: pathlib.Path(scratch) / kind for kind in ("truth", "reused")}
                for folder in folders.values():
                    folder.mkdir()
                views = views_of_walk(program, view, move, options.frames, folders["truth"])
                animate(program, options, views, ("--reuse", "off"), folders["truth"])
                animate(program, options, views, MODES["supersaturated"], folders["reused"])
                frames, off = film_frames(folders, options.frames)
            film = film_of(options.out, f"walkfilm-{name}-{move}", frames)
            rows.append({"view": view, "walk": move, "film": film.name, "off": statistics.mean(off),
                         "most_off": max(off)})
            lines[f"{name} {move}"] = [(i + 1, 100 * share) for i, share in enumerate(off)]
    print_table(rows)
    save(options.out, "walkfilm", about(program.scene, options.size), frames=options.frames, rows=rows)
    svg_plot.write_lines(options.out / "walkfilm.svg", f"Pixels off by more than a tenth, {program.scene.name}",
                         "frame", "percent", lines, x_log=0)
