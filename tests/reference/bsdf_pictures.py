#!/usr/bin/python3
"""Rooms with each kind of BSDF and of spectral pattern, against pictures by Radiance's rpict; needs python3-numpy.

  bsdf_pictures.py PROGRAM [NAME..]                  compare with the pictures in bsdf/ beside this file
  bsdf_pictures.py PROGRAM [NAME..] --update BIN     first make these by the oconv and rpict of BIN
  --keep FOLDER                                       leave scenes and pictures there

bsdf_scenes.py has the rooms. Where nothing is random a picture is held to a step of its encoding; where lobes are sampled it is
the mean of 100 rays a pixel, and is held to their noise, which a picture of another seed tells.
Exit 0: holds, 1: does not, 77: NumPy is not here (skipped).
"""
import argparse, pathlib, subprocess, sys, tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.append(str(HERE))
sys.path.append(str(HERE.parents[1] / "perf"))

WIDTH, HEIGHT, FINER = 48, 36, 10  # where there is noise, pictures are drawn so many times as wide and high
OPTIONS = "-ps 1 -pj 0 -dj 0 -ds 0 -dt 0 -dc 1 -dr 1 -dp 0 -av .05 .05 .05 -lr 6 -lw 1e-4 -bv+".split()
MEANS, MEANS_OF_NOISE = .001, .003  # most by which a channel's mean may be off
STEP = .01  # of the pictures' encoding
MORE_THAN_NOISE = 1.4  # how much farther off than another seed, 95th percentile of blocks; seen: 1.2


def size_of(noise):
    return ["-x", str(WIDTH * (FINER if noise else 1)), "-y", str(HEIGHT * (FINER if noise else 1))]


def update(programs, folder, words, path):
    """By oconv and rpict."""
    with open(folder / "room.oct", "wb") as octree:
        subprocess.run([programs / "oconv", "room.rad"], cwd=folder, stdout=octree, check=True)
    done = subprocess.run([programs / "rpict", *words, "room.oct"], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
    if done.returncode != 0:
        sys.exit(f"rpict failed: {done.stderr.decode(errors='replace')[-400:]}")
    for line in done.stderr.decode(errors="replace").splitlines():
        print(f"rpict: {line}")
    (folder / "theirs.hdr").write_bytes(done.stdout)
    write_hdr(path, small(folder / "theirs.hdr"))


def small(path):
    """The picture at its small size."""
    from walk.pictures import read_hdr
    picture = read_hdr(path)
    times = picture.shape[0] // HEIGHT
    return picture.reshape(HEIGHT, times, WIDTH, times, 3).mean((1, 3))


def write_hdr(path, picture):
    """Flat pixels, to the nearest step that readers decode to the middle of."""
    import numpy
    exponent = numpy.frexp(picture.max(2))[1]
    mantissas = numpy.clip(numpy.floor(numpy.ldexp(picture, (8 - exponent)[:, :, None])), 0, 255)
    pixels = numpy.concatenate([mantissas, exponent[:, :, None] + 128], 2).astype(numpy.uint8)
    path.write_bytes(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {HEIGHT} +X {WIDTH}\n".encode() + pixels.tobytes())


def figures(ours, theirs):
    """Relative differences: of the channels' means, the share of pixels that are off by 2 %, of blocks of 4 x 4 pixels."""
    import numpy
    from walk.pictures import WEIGHTS
    a, b = ours @ WEIGHTS, theirs @ WEIGHTS
    least = .02 * b.mean()
    blocks = [v.reshape(v.shape[0] // 4, 4, v.shape[1] // 4, 4).mean((1, 3)) for v in (a, b)]
    means = ours.mean((0, 1)) / theirs.mean((0, 1)) - 1
    off = numpy.abs(a - b) > .02 * numpy.maximum(b, least)
    apart = numpy.abs(blocks[0] - blocks[1]) / numpy.maximum(blocks[1], least)
    return float(numpy.abs(means).max()), float(off.mean()), float(numpy.percentile(apart, 95))


def render(program, words, folder, seed):
    out = folder / f"ours{seed}.hdr"
    done = subprocess.run([program, "render", "--quiet", *words, "--seed", str(seed), "-o", str(out), "room.rad"], cwd=folder,
                          capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"render of {folder} failed: {done.stderr[-400:]}")
    return small(out)


def check(program, name, folder, programs):
    import bsdf_scenes
    from walk.pictures import read_hdr
    options = bsdf_scenes.SCENES[name][3]
    noise = options is not bsdf_scenes.EXACT
    bsdf_scenes.make(name, folder)
    reference = HERE / "bsdf" / f"{name}.hdr"
    words = [*bsdf_scenes.view_of(name), *size_of(noise), *OPTIONS, *options]
    if programs:
        update(programs, folder, words, reference)
    ours = render(program, words, folder, 0)
    means, off, blocks = figures(ours, read_hdr(reference))
    most = figures(ours, render(program, words, folder, 1))[2] * MORE_THAN_NOISE if noise else 0
    holds = means <= (MEANS_OF_NOISE if noise else MEANS) and blocks <= max(STEP, most) and (noise or off <= .01)
    print(f"{name}: means off by {means:.4f}, pixels off by 2 % {off:.4f}, blocks {blocks:.4f} of {max(STEP, most):.4f}"
          f"{'' if holds else ' FAILS'}", flush=True)
    return holds


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("names", nargs="*")
    parser.add_argument("--update", metavar="BIN", type=pathlib.Path)
    parser.add_argument("--keep", metavar="FOLDER", type=pathlib.Path)
    arguments = parser.parse_args()
    try:
        import numpy  # noqa: F401
    except ImportError:
        print("skipped: NumPy is not here")
        return 77
    import bsdf_scenes
    program, ok = str(pathlib.Path(arguments.program).resolve()), True
    with tempfile.TemporaryDirectory() as made:
        for name in arguments.names or bsdf_scenes.SCENES:
            folder = (arguments.keep or pathlib.Path(made)).resolve() / name
            folder.mkdir(parents=True, exist_ok=True)
            ok = check(program, name, folder, arguments.update and arguments.update.resolve()) and ok
    return 0 if ok else 1


if __name__ == "__main__":
    sys.exit(main())
