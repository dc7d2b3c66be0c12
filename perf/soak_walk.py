#!/usr/bin/python3
"""A long random walk through a room: lightwalk animate must not crash, its memory must not grow, and its point cloud must keep its limit.

  soak_walk.py [--scenes DIR] [--lightwalk PROGRAM] [--frames 10000] [--size 160x120]

The eye wanders through the living room of the cabin in DIR, Radiance's sample models, or of the demo scene, along a
smooth path through random views. Frames are deleted as they are written. Each second the memory in use is noted. The
verdict: the program ends well after all frames; in the last tenth of them it uses no more than --growth percent more
memory than in the second tenth; the cloud has no more points than --cloud-limit times the pixels. Exit status: 0
all is well, 1 it is not.
"""
import argparse, json, pathlib, sys, tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.append(str(HERE / "scaling"))

from walk import soak, stage  # noqa: E402


def parse_args():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", type=lambda text: pathlib.Path(text).resolve(), metavar="DIR")
    parser.add_argument("--lightwalk", default="build/release/lightwalk", metavar="PROGRAM")
    parser.add_argument("--frames", type=int, default=10000, help="default %(default)s")
    parser.add_argument("--size", default="160x120", help="most pixels, default %(default)s")
    parser.add_argument("--threads", type=int, default=0, help="default: as the program likes")
    parser.add_argument("--seed", type=int, default=1, help="another walk, default %(default)s")
    parser.add_argument("--cloud-limit", type=float, default=4, help="points a pixel, default %(default)s")
    parser.add_argument("--growth", type=float, default=5, metavar="PERCENT", help="allowed, default %(default)s")
    parser.add_argument("--options", default="", help="more options of animate, in one word")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="what was found, with the memory over time")
    args = parser.parse_args()
    if args.frames < 2:
        parser.error("a walk has at least two frames")
    return args


def main():
    args = parse_args()
    (place,) = stage.places(["cabin/living" if args.scenes else "lodge/living"], args.lightwalk, args.scenes)
    width, height = (int(word) for word in args.size.split("x"))
    size = stage.Size(args.frames, width, height, args.threads)
    memory = pathlib.Path("/dev/shm")  # frames need not reach a disk
    with tempfile.TemporaryDirectory(dir=memory if memory.is_dir() else None) as scratch:
        found = soak.soak(place, size, args.seed, args.cloud_limit, pathlib.Path(scratch), args.options.split())
    if args.json:
        args.json.write_text(json.dumps(found, indent=1) + "\n")
    tenths = found["samples"][::max(1, len(found["samples"]) // 10)]
    print("frames drawn and memory in use [MB]: " + ", ".join(f"{n}: {m / 1e6:.1f}" for n, m in tenths))
    print(f"{found['drawn']} frames in {found['seconds']:.0f} s, {found.get('reused', 0):.1%} reused, at most "
          f"{found['points']} points of {found['limit']}, growth {found['growth']:.2%}")
    said = soak.faults(found, args.growth / 100)
    print("\n".join(said) or "it neither grew nor crashed")
    return 1 if said else 0


if __name__ == "__main__":
    sys.exit(main())
