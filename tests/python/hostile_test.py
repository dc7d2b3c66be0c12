"""Whatever Python hands over is answered, or refused by an exception; the process goes on."""

import ctypes
import gc
import os
import random

import numpy as np
import pytest

import lightwalk
from conftest import ROOM, VIEW

CALLS = 10_000 // int(os.environ.get("LIGHTWALK_TEST_SHARE", 1))  # a share with sanitizers


class Hostile:
    """Raises wherever it is asked."""

    def __array__(self, *_, **__):
        raise RuntimeError("no array")

    def __iter__(self):
        raise RuntimeError("no items")

    def __repr__(self):
        raise RuntimeError("no text")

    def __float__(self):
        raise RuntimeError("no number")

    __int__ = __index__ = __fspath__ = __len__ = __float__


def freed_view():
    """An array over memory whose owner has let go of it, as far as Python allows: the array keeps the owner."""
    block = (ctypes.c_double * 12)(*range(12))
    array = np.frombuffer(block).reshape(4, 3)
    del block
    gc.collect()
    return array


def released_view():
    """A buffer whose memory was given back."""
    view = memoryview(bytearray(24)).cast("d")
    view.release()
    return view


def any_array(rng):
    shape = rng.choice([(3,), (1, 3), (4, 3), (4, 3, 3), (3, 4), (0, 3), (0,), (), (2, 2, 2, 2), (3, 0)])
    kind = rng.choice(["f8", "f4", "f2", "i4", "u1", "?", "c16", "O", "U3", "M8[s]", ">f8", "V8"])
    array = np.zeros(shape, kind)
    if array.dtype.kind == "f" and array.size:
        flat = array.reshape(-1)
        for k in range(flat.size):
            flat[k] = rng.choice([0, 1, -1, .5, 2, float("nan"), float("inf"), -float("inf"), 1e-300, 1e4])
    if rng.random() < .2 and array.ndim > 1:
        array = array[::-1]
    if rng.random() < .2:
        array = np.asfortranarray(array)
    return array


def any_value(rng):
    return rng.choice([
        lambda: None, lambda: True, lambda: rng.randint(-3, 5), lambda: 10 ** 40, lambda: -1, lambda: rng.random(), lambda: float("nan"), lambda: float("inf"),
        lambda: 1e308, lambda: "", lambda: "lamp", lambda: "-vp 1 2 3", lambda: "-vp", lambda: "\0", lambda: "\ud800", lambda: "a b", lambda: "x" * 5000,
        lambda: b"lamp", lambda: [], lambda: (1, 2), lambda: (0, 1, 0), lambda: [(0, 0, 1), (1, 0, 0)], lambda: {"a": 1}, lambda: {"position": (0, 0, 1)},
        lambda: {1: 2}, lambda: object(), Hostile, lambda: 3j, lambda: any_array(rng), freed_view, released_view, lambda: np.broadcast_to(np.zeros(3), (1 << 40, 3)),
        lambda: memoryview(b"12345678"), lambda: lightwalk.View(), lambda: lightwalk.View(rng.choice([3, "x", (1, 2, 3), Hostile()])),
        lambda: range(3), lambda: iter([1, 2]), lambda: lightwalk, lambda: np.float32(2), lambda: np.int64(1), lambda: np.str_("lamp")])()


def any_options(rng, command):
    """Few, so that most calls come far; threads and work are small."""
    names = sorted(set(lightwalk.options(command)) - {"af", "vf", "f", "ab", "ad", "as_", "samples", "error", "time", "n", "ss", "dj", "lr", "lw", "dp", "ms", "aE", "aI",
                                                        "path", "frames", "x", "y", "pd", "bn"})
    found = {"n": 1}
    for _ in range(rng.choice([0, 0, 1, 2])):
        found[rng.choice([*names, "nothing", "", "ab "])] = any_value(rng)
    return found


def mixed(rng, good):
    """Mostly what is right, else anything."""
    return good if rng.random() < .6 else any_value(rng)


def calls(scene):
    """Functions that call with hostile arguments."""
    points, directions = np.array([(0, 0, 1.), (1, 0, 1), (0, 1, 1), (1, 1, 1)]), np.array([(0, 0, 1.), (0, 1, 0), (1, 0, 0), (0, 0, -1)])
    picture = np.ones((4, 4, 3), np.float32)

    def render(rng):
        return scene.render(mixed(rng, VIEW), mixed(rng, (6, 4)), progress=mixed(rng, None), **any_options(rng, "render"))

    def trace(rng):
        return scene.trace(mixed(rng, points), mixed(rng, directions), mixed(rng, True), surface=mixed(rng, True), normal=mixed(rng, True), **any_options(rng, "trace"))

    def contrib(rng):
        return scene.contrib(mixed(rng, points), mixed(rng, directions), mixed(rng, "lamp"), mixed(rng, True), ab=0, **any_options(rng, "contrib"))

    def animate(rng):
        return list(scene.animate(mixed(rng, [VIEW] * 2), mixed(rng, (6, 4)), **any_options(rng, "animate")))

    def build(rng):
        built = lightwalk.Scene(library=mixed(rng, None), threads=mixed(rng, 1))
        built.light(mixed(rng, "lamp"), mixed(rng, 1))
        for _ in range(3):
            name, good = rng.choice([
                ("polygon", ("lamp", points[:3])), ("mesh", ("lamp", points, [(0, 1, 2)])), ("sphere", ("lamp", (0, 4, 0), 1)), ("box", ("lamp", (0, 0, 0), (1, 1, 1))),
                ("ring", ("lamp", (0, 4, 0), (0, 1, 0), 0, 1)), ("source", ("lamp", (0, 1, 0), 10)), ("cylinder", ("lamp", (0, 0, 0), (0, 0, 1), 1)),
                ("glass", ("pane", .9)), ("trans", ("cloth", .5, 0, 0, .5, 0)), ("primitive", ("plastic", "p", "void", (), (.5, .5, .5, 0, 0))),
                ("text", ("void glow g 0 0 4 1 1 1 0",)), ("generate", ("genbox", "lamp", "b", 1, 1, 1)), ("polygons", ("lamp", [points[:3]]))])
            getattr(built, name)(*(mixed(rng, value) for value in good))
        return built.trace(points, directions, n=1)

    def source(rng):
        text = bytearray(ROOM.encode())
        for _ in range(rng.randint(1, 6)):
            text[rng.randrange(len(text))] = rng.randrange(256)
        return lightwalk.Scene.from_bytes(mixed(rng, bytes(text)), threads=1).trace(points, directions, n=1)

    def analyse(rng):
        which = rng.randrange(5)
        if which == 0:
            return lightwalk.glare(mixed(rng, picture), mixed(rng, lightwalk.View.fisheye((0, 0, 0), (0, 1, 0))), mixed(rng, 2000))
        if which == 1:
            return lightwalk.luminance(mixed(rng, picture))
        if which == 2:
            return lightwalk.false_color(mixed(rng, picture[..., 0]), mixed(rng, 100), mixed(rng, 2))
        if which == 3:
            return lightwalk.grid(mixed(rng, (0, 0, 1)), mixed(rng, (2, 2, 1)), mixed(rng, 3), mixed(rng, 3))
        return lightwalk.Scene.from_files(mixed(rng, "no/such.rad")).load()

    def save(rng):
        return lightwalk.save_picture(mixed(rng, "/dev/null"), mixed(rng, picture), view=mixed(rng, VIEW), header=mixed(rng, ["A= 1"]))

    return [render, trace, contrib, animate, build, source, analyse, save]


@pytest.mark.filterwarnings("ignore")
def test_ten_thousand_hostile_calls_end_in_answers_or_exceptions(room, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    kinds = calls(room)
    rng = random.Random(20)
    expected = room.render(VIEW, 12)
    answered = 0
    for number in range(CALLS):
        kind = kinds[number % len(kinds)]
        try:
            kind(rng)
            answered += 1
        except lightwalk.Error:
            pass
        except (TypeError, ValueError, AttributeError, RuntimeError, MemoryError, OverflowError, IndexError, OSError):
            pass  # of Python, numpy, or the hostile object itself
    assert CALLS / 20 < answered < CALLS * 19 / 20  # of both kinds there are many
    assert np.array_equal(room.render(VIEW, 12), expected)


def test_arrays_that_change_or_vanish_during_a_call_do_no_harm(room):
    points = np.zeros((100_000, 3))
    points[:, 2] = 1
    result = room.trace(points, (0, 0, 1), surface=True)
    radiance = result.radiance
    del result, points
    gc.collect()
    assert (radiance == radiance[0]).all()
    picture = room.picture(VIEW, 32)
    kept = picture.radiance
    expected = kept.copy()
    del picture
    gc.collect()
    [np.ones(1000) for _ in range(100)]
    assert np.array_equal(kept, expected)


def test_arrays_that_are_too_large_are_refused_before_they_are_copied(room):
    with pytest.raises((lightwalk.InputError, MemoryError)):
        room.trace(np.broadcast_to(np.zeros(3), (1 << 34, 3)), (0, 0, 1))
    with pytest.raises(lightwalk.Error):
        room.render(VIEW, 1 << 20, pa=0)
