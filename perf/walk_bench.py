#!/usr/bin/python3
"""Measures reuse, speed and errors of walks through rooms, by the settings of reuse between frames.

  walk_bench.py --scenes DIR                   how much is reused, how soon frames are there, how true they are
  walk_bench.py --scenes DIR --rules all       the same with each rule of reuse on and off
  walk_bench.py --scenes DIR --regions         errors in mirrors, windows and shiny floors after --moves moves
  walk_bench.py --scenes DIR --pinterp PROGRAM  beside Radiance's pinterp between key frames, as many pixels traced

DIR is a folder that holds Radiance's sample models: DIR/cabin and DIR/lib. Without it only the demo scene is walked
through. Each walk is drawn with every pixel of every frame traced (the truth), the same with all rays moved by half a
pixel to the right and up (what two equally good pictures differ by: the floor), and with each way of reuse. One line
a walk and way, tab-separated. Shares are percent of the pixels, means over the frames after the first:

  reused      answered by points, less those that do not pass the check: elsewhere, the points are a twentieth nearer
              or farther than what the ray meets, and off (hidden ones that show through)
  traced      shaded by rays, the audited ones included
  full s, frame s, speedup   seconds of a frame that is traced, of one that reuses, all steps; their ratio
  off, floor  luminance is off by more than a tenth; the same of the moved picture
  excess      off beyond the floor, one less the other; worst: of the worst frame
  beyond      off by more than a tenth from all that rays moved by half a pixel find (those at the pixel's corners)
  PSNR        of the tone-mapped picture [dB]; worst: of the worst frame; floor: of the moved picture
  error       mean difference of the luminance, percent of the mean luminance

A walk backward goes where that forward went, from its end; one to the right crosses that forward in its middle: behind
and beside the views there are walls. The paper reached 97 % reuse turning indoors, 94 % forward, 85 % in the forest, and
90 % with its first version, which dropped points that a frame did not use.
"""
import argparse, json, pathlib, sys, tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.append(str(HERE / "scaling"))

from walk import interpolated, moves, regions, stage, truth, ways  # noqa: E402


class Table:
    """Rows on standard output, tab-separated under their names, and in a file."""

    def __init__(self, path):
        self.path, self.rows, self.names = path, [], None

    def add(self, row, **more):
        """A row, and what only the file gets."""
        if list(row) != self.names:
            self.names = list(row)
            print("\t".join(self.names))
        cells = (f"{value:.4g}" if isinstance(value, float) else str(value) for value in row.values())
        print("\t".join(cells), flush=True)
        self.rows.append({**row, **more})
        if self.path:
            self.path.write_text(json.dumps(self.rows, indent=1) + "\n")


def measure_truth(args, traced, about, folder, table):
    for way, words in args.ways.items():
        row, errors, stats = truth.measure(traced, way, words.split(), folder / truth.folder_name(way))
        table.add({**about, **row}, frames=[vars(error) for error in errors])
        if args.pinterp and "reuse" in stats:
            beside = interpolated.measure(args.pinterp, traced, stage.traced_share(stats), folder / "pinterp")
            table.add({**about, **{name: beside.get(name, "-") for name in row}, "way": f"pinterp, as {way}"})


def walks(args, place, names, root):
    """Each walk from a place, traced: (move, TracedWalk, its folder)."""
    forward = None
    for move in names:
        folder = root / place.name.replace("/", "-") / move
        found = moves.views_of_walk(place.program, place.file, move, args.size.frames, folder)
        traced = truth.TracedWalk(place, args.size, found, folder)
        traced.trace(forward if move == "backward" else None)
        forward = traced if move == "forward" else forward
        yield move, traced, folder


def run(args, root, table):
    wanted = list(dict.fromkeys(region.place for region in args.regions)) if args.regions else args.views
    for place in stage.places(wanted, args.lightwalk, args.scenes, root / "offices"):
        for move, traced, folder in walks(args, place, args.walks, root):
            about = {"view": place.name, "walk": move}
            if args.regions:
                here = [region for region in args.regions if region.place == place.name]
                regions.measure(traced, here, args.ways, folder, lambda row: table.add({**about, **row}))
            else:
                measure_truth(args, traced, about, folder, table)


def parse_args():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", type=lambda text: pathlib.Path(text).resolve(), metavar="DIR")
    parser.add_argument("--lightwalk", default="build/release/lightwalk", metavar="PROGRAM")
    parser.add_argument("--views", help="separated by commas, default " + ",".join(stage.VIEWS) + "; also " +
                        ",".join(stage.OFFICES) + "; with --regions those listed there")
    parser.add_argument("--walks", default=",".join(moves.MOVES), help="default %(default)s; right goes sideways")
    parser.add_argument("--frames", type=int, default=50, help="of a walk, default %(default)s")
    parser.add_argument("--moves", type=int, default=50,
                        help="--regions: before the frame that counts, default %(default)s")
    parser.add_argument("--size", default="640x480", help="most pixels, default %(default)s")
    parser.add_argument("--threads", type=int, default=0, help="default: as the program likes")
    parser.add_argument("--reuse", action="append", metavar="LABEL=OPTIONS", help="a way of your own instead")
    parser.add_argument("--rules", metavar="all|NAMES", help=f"separated by commas: {', '.join(ways.RULES)}")
    parser.add_argument("--regions", action="store_true",
                        help="; ".join(f"{r.place}: {r.name} ({' '.join(r.modifiers)})" for r in regions.REGIONS))
    parser.add_argument("--pinterp", metavar="PROGRAM", help="Radiance's, for example pinterp")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="all rows, with the errors of each frame")
    parser.add_argument("--keep", type=pathlib.Path, metavar="FOLDER",
                        help="leave the pictures there, and take the traced ones that the same program left there")
    args = parser.parse_args()
    if bool(args.reuse) + bool(args.rules) > 1:
        parser.error("--reuse and --rules: only one of them")
    return args


def resolve(args):
    """Names and numbers into what they stand for."""
    width, height = (int(word) for word in args.size.split("x"))
    if args.regions and args.views and not set(args.views.split(",")) & {region.place for region in regions.REGIONS}:
        sys.exit("--regions: none is in these views")
    args.size = stage.Size(args.moves + 1 if args.regions else args.frames, width, height, args.threads)
    args.regions = [r for r in regions.REGIONS if args.regions and (not args.views or r.place in args.views.split(","))]
    args.views, args.walks = args.views.split(",") if args.views else stage.VIEWS, args.walks.split(",")
    args.ways = ways.given(args.reuse) if args.reuse else ways.rules(args.rules) if args.rules else ways.WAYS
    if (args.regions or args.pinterp) and not (args.reuse or args.rules):
        args.ways = {"supersaturated": ways.WAYS["supersaturated"]}
    if args.pinterp:
        args.pinterp = interpolated.find(args.pinterp)
    if args.size.frames < 2:
        sys.exit("a walk has at least two frames")
    if "backward" in args.walks and "forward" in args.walks:  # whose pictures it takes
        args.walks.remove("backward")
        args.walks.insert(args.walks.index("forward") + 1, "backward")


def main():
    args = parse_args()
    resolve(args)
    with tempfile.TemporaryDirectory() as scratch:
        run(args, (args.keep or pathlib.Path(scratch)).resolve(), Table(args.json))


if __name__ == "__main__":
    main()
