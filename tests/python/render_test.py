"""Pictures are those of the command, bit for bit."""

import sys
import threading
import time
import types

import numpy as np
import pytest

import lightwalk
from conftest import ROOM, VIEW, VIEW_WORDS, command, in_new_process


def pixels(file):
    """Of a Radiance picture: what follows its header, whose dates and history differ."""
    data = file.read_bytes()
    return data[data.index(b"\n\n"):]


@pytest.mark.parametrize("words, options", [
    ([], {}),
    (["-ps", "1", "-pj", "0", "-av", ".1", ".2", ".3"], {"ps": 1, "pj": 0, "av": (.1, .2, .3)}),
    (["-ab", "1", "-ad", "64", "-as", "16", "--deterministic"], {"ab": 1, "ad": 64, "as_": 16, "deterministic": True}),
    (["--samples", "8", "--seed", "5", "-dv-", "-i+"], {"samples": 8, "seed": 5, "dv": False, "i": True}),
    (["-pa", "0", "-vth", "-vh", "180", "-vv", "180"], {"pa": 0, "vt": "h", "vh": 180, "vv": 180})])
def test_a_picture_has_the_bytes_of_the_commands(room_file, room, tmp_path, words, options):
    command("render", *VIEW_WORDS, "-x", 80, "-y", 60, *words, "-o", tmp_path / "command.hdr", room_file)
    if "vt" in options:
        picture = room.render(None, (80, 60), vp=(0, -4, 1.5), vd=(0, 1, -.05), **options)
    else:
        picture = room.render(VIEW, (80, 60), **options)
    assert picture.dtype == np.float32 and picture.ndim == 3 and picture.shape[2] == 3
    assert picture.max() > 0
    lightwalk.save_picture(tmp_path / "python.hdr", picture)
    assert pixels(tmp_path / "python.hdr") == pixels(tmp_path / "command.hdr")


def test_the_view_may_be_a_text_a_file_or_a_mapping(room, tmp_path):
    expected = room.render(VIEW, 32)
    (tmp_path / "eye.vf").write_text("VIEW= " + " ".join(VIEW_WORDS) + "\n")
    for view in (" ".join(VIEW_WORDS), "VIEW= " + " ".join(VIEW_WORDS), tmp_path / "eye.vf", str(tmp_path / "eye.vf"),
                 {"position": (0, -4, 1.5), "direction": (0, 1, -.05), "horizontal": 60, "vertical": 46.8}):
        assert np.array_equal(room.render(view, 32), expected)


def test_a_picture_holds_distances_layers_and_errors(room):
    picture = room.picture(VIEW, 32, distance=True, light_group="auto")
    assert picture.distance.shape == picture.radiance.shape[:2]
    assert .5 < picture.distance.min() < 11
    assert set(picture.layers) == {"lamp"} | set(picture.layers)
    total = sum(layer.astype(float) for layer in picture.layers.values())
    assert np.allclose(total, picture.radiance, atol=1e-5)
    assert picture.error is None and picture.rays > 0
    assert room.picture(VIEW, 32, error=.2).error.shape == picture.radiance.shape[:2]


def test_a_picture_is_saved_whole_or_not_at_all(room, tmp_path):
    picture = room.render(VIEW, 16)
    for name in ("a.hdr", "a.exr", "a.png", "a.jpg"):
        lightwalk.save_picture(tmp_path / name, picture, view=VIEW)
        assert (tmp_path / name).stat().st_size > 100
    assert b"VIEW= -vtv -vp 0 -4 1.5" in (tmp_path / "a.hdr").read_bytes()
    for name, why in (("a.gif", "gif"), ("no/such/folder.hdr", "folder")):
        with pytest.raises(lightwalk.InputError, match=why):
            lightwalk.save_picture(tmp_path / name, picture)
    assert len(list(tmp_path.iterdir())) == 4


def test_progress_is_told_and_what_a_listener_raises_ends_the_work(room):
    told = []
    room.render(VIEW, 64, samples=16, progress=told.append)
    assert told and told[-1] == 1 and told == sorted(told)

    def refuse(share):
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        room.render(VIEW, 512, samples=1024, progress=refuse)
    assert room.render(VIEW, 16).shape[2] == 3


def test_progress_is_a_bar_where_tqdm_is_installed(room, monkeypatch):
    class Bar:
        made = []

        def __init__(self, **_):
            self.n, self.closed = 0, False
            self.made.append(self)

        def refresh(self):
            pass

        def close(self):
            self.closed = True

    module = types.ModuleType("tqdm.auto")
    module.tqdm = Bar
    monkeypatch.setitem(sys.modules, "tqdm", types.ModuleType("tqdm"))
    monkeypatch.setitem(sys.modules, "tqdm.auto", module)
    room.render(VIEW, 16, progress=True)
    list(room.animate([VIEW] * 3, 16, progress=True))
    assert [(bar.n, bar.closed) for bar in Bar.made] == [(1, True)] * 2
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)  # not installed
    assert room.render(VIEW, 16, progress=True).max() > 0
    with pytest.raises(lightwalk.OptionError, match="progress"):
        room.render(VIEW, 16, progress="bar")


def test_other_threads_of_python_go_on_while_a_picture_is_drawn(room):
    counted = [0]
    ended = threading.Event()

    def count():
        while not ended.is_set():
            counted[0] += 1
            time.sleep(.001)

    thread = threading.Thread(target=count)
    thread.start()
    before = counted[0]
    room.render(VIEW, 128, samples=16)
    after = counted[0]
    ended.set()
    thread.join()
    assert after > before


def test_an_interrupt_ends_a_picture(room_file):
    # Without an end of its own it would take hours. The signal comes when the work is under way, from within it.
    print(in_new_process("""
import lightwalk, os, signal, sys
scene = lightwalk.Scene.from_files(sys.argv[1])
try:
    scene.render("-vp 0 -4 1.5", 4096, samples=65536, progress=lambda share: os.kill(os.getpid(), signal.SIGINT))
except KeyboardInterrupt:
    print("interrupted", scene.render("-vp 0 -4 1.5", 16).shape)
""", room_file))


def test_eight_threads_draw_eight_scenes_at_once():
    def scene_of(k):
        scene = lightwalk.Scene.from_bytes(ROOM.replace("10 9 8", f"{k + 1} 9 8"))
        return scene.render(VIEW, 48, ab=1, ad=32, deterministic=True)

    expected = [scene_of(k) for k in range(8)]
    found = [None] * 8

    def draw(k):
        found[k] = scene_of(k)

    threads = [threading.Thread(target=draw, args=(k,)) for k in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for k in range(8):
        assert np.array_equal(found[k], expected[k]), k
    assert len({picture.tobytes() for picture in expected}) == 8


def test_frames_of_a_walk_are_those_of_the_command(room_file, room, tmp_path):
    words = ["--reuse", "off", "--rotate", "20", "--frames", "3", "-ps", "1"]
    command("animate", *VIEW_WORDS, "-x", 40, "-y", 30, *words, "-o", tmp_path / "f%d.hdr", room_file)
    frames = list(room.animate(size=(40, 30), view=VIEW, reuse="off", rotate=20, frames=3, ps=1))
    assert len(frames) == 3
    for number, frame in enumerate(frames, 1):
        lightwalk.save_picture(tmp_path / "frame.hdr", frame)
        assert pixels(tmp_path / "frame.hdr") == pixels(tmp_path / f"f{number}.hdr")


def test_frames_may_have_views_of_their_own_and_reuse_points(room):
    views = [lightwalk.View((0, -4 + .1 * k, 1.5), horizontal=60, vertical=46.8) for k in range(4)]
    frames = list(room.animate(views, 32))
    assert len(frames) == 4 and all(frame.max() > 0 for frame in frames)
    first = next(room.animate(iter(views), 32, reuse="off", ps=1))
    assert np.array_equal(first, room.render(views[0], 32, ps=1))
    with pytest.raises(lightwalk.OptionError, match="expected views"):
        room.animate(size=32)
