"""Compares walks with the same walks fully traced: share of reused pixels, speed-up, errors."""
import dataclasses, json, statistics, sys

import numpy

from . import pictures, stage, views


@dataclasses.dataclass
class FrameError:
    """The errors of a frame, compared with the true one. Shares are percent of the pixels."""
    off: float  # luminance is off by more than a tenth
    floor: float  # the same of a picture that is moved by half a pixel
    beyond: float  # off from whatever a ray moved by half a pixel finds
    square: float  # mean squared difference as shown
    floor_square: float
    error: float  # mean difference of the luminance, percent of the mean luminance
    elsewhere: float = 0  # shows something at another distance than its ray meets, and is off


def percent(mask):
    return 100 * float(numpy.mean(mask))


@dataclasses.dataclass
class TracedWalk:
    """A fully traced walk, and the same walk with all rays moved by half a pixel to the right and up."""
    place: stage.Place
    size: stage.Size
    views: list
    folder: object  # holds truth/ and moved/
    seconds: float = 0  # of a frame
    shape: tuple = ()  # height, width [pixels]

    def trace(self, reverse_of=None):
        """Draw both; or take the pictures of `reverse_of`, the same walk in the other direction; or those that an earlier run
        left in the folder."""
        if reverse_of is not None:
            self.seconds, self.shape = reverse_of.seconds, reverse_of.shape
            self.link(reverse_of)
            return
        if self.left_before():
            return
        (self.folder / "traced.json").unlink(missing_ok=True)
        stats = stage.animate(self.place, self.size, self.views, ["--reuse", "off"], self.folder / "truth", depths=True)
        self.shape = stats["picture"]["height"], stats["picture"]["width"]
        self.seconds = stats["seconds"]["render"] / len(self.views)
        moved = [views.shifted(view, 0.5 / self.shape[1], 0.5 / self.shape[0]) for view in self.views]
        stage.animate(self.place, self.size, moved, ["--reuse", "off"], self.folder / "moved")
        (self.folder / "traced.json").write_text(json.dumps(self.made_from() | {"seconds": self.seconds,
                                                                                "shape": self.shape}))

    def made_from(self):
        """Everything that the traced pictures depend on, as text."""
        program = self.place.program.lightwalk.stat()
        return {"views": views.lines(self.views), "program": [program.st_size, program.st_mtime_ns],
                "size": [self.size.width, self.size.height]}

    def left_before(self):
        """Whether the folder has traced pictures with the same dependencies."""
        path = self.folder / "traced.json"
        found = json.loads(path.read_text()) if path.is_file() else {}
        if not self.made_from().items() <= found.items():
            return False
        self.seconds, self.shape = found["seconds"], tuple(found["shape"])
        print(f"{self.folder}: traced before; full s, and what follows from it, are of that time", file=sys.stderr)
        return True

    def link(self, other):
        count = len(self.views)
        for name in ("truth", "moved"):
            (self.folder / name).mkdir(parents=True, exist_ok=True)
            for i in range(1, count + 1):
                for path in (other.folder / name).glob(f"f{count + 1 - i:04d}.*"):
                    link = self.folder / name / f"f{i:04d}{path.suffix}"
                    link.unlink(missing_ok=True)
                    link.symlink_to(path.resolve())

    def frame_error(self, picture, number, distances=None, mask=None):
        """The errors of a picture, compared with the true frame of that number; with a mask only those of its pixels."""
        truth, moved = stage.frame(self.folder / "truth", number), stage.frame(self.folder / "moved", number)
        inside = numpy.ones(self.shape, bool) if mask is None else mask
        scale = pictures.exposure(truth)
        is_, should, floor = (pictures.luminance(each) for each in (picture, truth, moved))
        wrong = numpy.zeros(self.shape, bool)
        if distances is not None:  # behind panes distance may mean either: of the pane, of what shows through
            true_distances = stage.depths(self.folder / "truth", number, self.shape)
            wrong = pictures.other_depth(distances, true_distances) & pictures.off(is_, should)
        return FrameError(
            off=percent(pictures.off(is_, should)[inside]), floor=percent(pictures.off(floor, should)[inside]),
            beyond=percent(pictures.beyond(is_, should, floor)[inside]),
            square=float(numpy.mean(pictures.square(picture, truth, scale)[inside])),
            floor_square=float(numpy.mean(pictures.square(moved, truth, scale)[inside])),
            error=100 * float(numpy.mean(numpy.abs(is_ - should)[inside]) / max(numpy.mean(should[inside]), 1e-30)),
            elsewhere=percent(wrong[inside]))


def compare(traced, folder):
    """The FrameErrors of all frames of a folder but the first."""
    return [traced.frame_error(stage.frame(folder, i), i, stage.depths(folder, i, traced.shape))
            for i in range(2, len(traced.views) + 1)]


def frame_seconds(stats):
    """Mean time of all frames but the first, all steps included."""
    return statistics.mean(sum(frame["seconds"].values()) for frame in stats["reuse"]["frames"][1:])


def passing(stats, errors):
    """Percent of the pixels that were reused and show what their ray hits, mean of all frames but the first. A pixel that
    shows something at another distance counts as reused, as traced pixels cannot."""
    pixels = stats["picture"]["width"] * stats["picture"]["height"]
    return statistics.mean(max(0.0, 100 * frame["reused"] / pixels - error.elsewhere)
                           for frame, error in zip(stats["reuse"]["frames"][1:], errors))


def summary(errors):
    """Mean and worst of frames."""
    def mean(name):
        return statistics.mean(getattr(error, name) for error in errors)

    excess = [error.off - error.floor for error in errors]
    return {"off": mean("off"), "floor": mean("floor"), "excess": statistics.mean(excess), "worst excess": max(excess),
            "beyond": mean("beyond"), "worst beyond": max(error.beyond for error in errors),
            "PSNR": pictures.psnr(mean("square")), "worst PSNR": pictures.psnr(max(error.square for error in errors)),
            "floor PSNR": pictures.psnr(mean("floor_square")), "error": mean("error")}


def measure(traced, way, words, folder):
    """The row of a walk drawn with one setting, and the errors of its frames."""
    stats = stage.animate(traced.place, traced.size, traced.views, words, folder, depths=True)
    errors = compare(traced, folder)
    seconds = frame_seconds(stats) if "reuse" in stats else stats["seconds"]["render"] / len(traced.views)
    row = {"way": way, "reused": passing(stats, errors) if "reuse" in stats else 0.0,
           "elsewhere": statistics.mean(error.elsewhere for error in errors),
           "traced": 100 * (stage.traced_share(stats) - 1) / (len(traced.views) - 1) if "reuse" in stats else 100.0,
           "full s": traced.seconds, "frame s": seconds, "speedup": traced.seconds / seconds, **summary(errors)}
    return row, errors, stats


def folder_name(way):
    """The label of a setting, with characters that a folder's name may have."""
    return "".join(letter if letter.isalnum() or letter in ".-" else "-" for letter in way)
