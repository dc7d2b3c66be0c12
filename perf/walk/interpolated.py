"""Walks drawn by Radiance's pinterp, which warps frames from the two nearest traced key frames."""
import math, pathlib, shutil, subprocess, sys

from . import stage, truth, views


def find(program):
    """The path of a program; None, and a message, if it is not installed."""
    path = shutil.which(program)
    if path is None:
        print(f"there is no program {program}: the comparison with pinterp is skipped", file=sys.stderr)
        return None
    return str(pathlib.Path(path).resolve())


def keys(count, pictures):
    """Numbers of the frames, 1 ... count, that are traced whole when so many pictures may be: evenly spread, with the
    first and the last one. At least these two, and not more than there are."""
    wanted = min(max(2, math.ceil(pictures)), count)
    return sorted({1 + round(k * (count - 1) / (wanted - 1)) for k in range(wanted)}) if count > 1 else [1]


def neighbours(number, key_frames):
    """The key frames before and after a frame that is no key frame."""
    return max(k for k in key_frames if k < number), min(k for k in key_frames if k > number)


def draw(program, traced, number, around, path):
    """Draw a frame from its two key frames and their distances."""
    height, width = traced.shape
    files = [traced.folder / "truth" / f"f{key:04d}{kind}" for key in around for kind in (".hdr", ".z")]
    with open(path, "wb") as output:
        done = subprocess.run([program, *views.words_of(traced.views[number - 1]), "-x", str(width), "-y", str(height),
                               "-pa", "0", *map(str, files)], stdout=output, stderr=subprocess.PIPE)
    if done.returncode != 0:
        sys.exit(f"pinterp failed: {done.stderr.decode(errors='replace')[-500:]}")


def measure(program, traced, pictures, folder):
    """The row of a walk that is drawn from as many key frames as `pictures`, rounded up."""
    count = len(traced.views)
    key_frames = keys(count, pictures)
    folder.mkdir(parents=True, exist_ok=True)
    errors = []
    for number in range(2, count + 1):
        if number in key_frames:
            picture = stage.frame(traced.folder / "truth", number)
        else:
            path = folder / f"f{number:04d}.hdr"
            draw(program, traced, number, neighbours(number, key_frames), path)
            picture = stage.frame(folder, number)
        errors.append(traced.frame_error(picture, number))
    return {"way": "pinterp", "traced": 100 * (len(key_frames) - 1) / max(count - 1, 1), **truth.summary(errors)}
