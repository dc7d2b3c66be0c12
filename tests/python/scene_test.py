"""Scenes from files, from bytes, and built in code; what is wrong with them has a place."""

import inspect
import os
import pathlib
import warnings

import numpy as np
import pytest

import lightwalk
from conftest import ROOM, VIEW, command, in_new_process


def here():
    return inspect.currentframe().f_back.f_lineno


def built_room():
    """ROOM, in code."""
    scene = lightwalk.Scene()
    grey = scene.plastic("grey", .5)
    shiny = scene.plastic("shiny", (.4, .3, .2), .1, .05)
    lamp = scene.light("lamp", (10, 9, 8))
    scene.polygon(grey, [(-4, -6, 0), (4, -6, 0), (4, 6, 0), (-4, 6, 0)], "floor")
    scene.polygon(grey, np.array([(-4, 6, 0), (4, 6, 0), (4, 6, 3), (-4, 6, 3)], np.float32), "back")
    scene.polygon(grey, [(-4, -6, 3), (-4, 6, 3), (4, 6, 3), (4, -6, 3)], "ceiling")
    scene.sphere(shiny, (-1, 2, .7), .7, "ball")
    scene.polygon(lamp, [(-1, -1, 2.99), (-1, 1, 2.99), (1, 1, 2.99), (1, -1, 2.99)], "panel")
    return scene


def test_a_scene_is_the_same_from_files_octrees_frozen_files_bytes_and_code(room_file, room, tmp_path):
    expected = room.render(VIEW, 48)
    frozen = tmp_path / "room.lwz"
    room.freeze(frozen)
    # Half of the room in each of two files.
    lines = ROOM.splitlines(keepends=True)
    (tmp_path / "a.rad").write_text("".join(lines[:5]))
    (tmp_path / "b.rad").write_text("".join(lines[5:]))
    for scene in (lightwalk.Scene.from_files(frozen), lightwalk.Scene.from_bytes(frozen.read_bytes()), lightwalk.Scene.from_bytes(ROOM),
                  lightwalk.Scene.from_bytes(bytearray(ROOM.encode())), lightwalk.Scene.from_files(tmp_path / "a.rad", str(tmp_path / "b.rad")),
                  built_room()):
        assert np.array_equal(scene.render(VIEW, 48), expected)


def test_octrees_are_read():
    spruce = pathlib.Path(lightwalk.__file__).parent / "share/lightwalk/scenes/lodge/spruce.oct"
    for scene in (lightwalk.Scene.from_files(spruce), lightwalk.Scene.from_bytes(spruce.read_bytes())):
        assert (scene.bounds[1] > scene.bounds[0]).all()


def test_the_demo_scene_is_in_the_package():
    views = lightwalk.demo_views()
    assert {"living", "dining"} <= set(views)
    assert lightwalk.demo_scene().render(views["living"], 16).max() > 0
    assert lightwalk.demo_scene(night=True).render(views["dining"], 16).max() > 0


def test_meshes_boxes_and_files_are_parts_of_a_scene(room_file):
    scene = lightwalk.Scene()
    grey = scene.plastic("grey", .5)
    vertices = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    scene.mesh(grey, vertices, np.array([(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)], np.uint8))
    scene.box(grey, (2, 0, 0), (3, 1, 1))
    scene.box(grey, (-9, -9, -9), (9, 9, 9), inward=True)
    scene.include(room_file, "-t", 0, 0, 20)
    found = scene.trace([(.2, .2, -1), (2.5, .5, 3), (.2, .2, -8), (0, 0, 19)], [(0, 0, 1), (0, 0, -1), (0, 0, -1), (0, 0, 1)], distance=True, normal=True,
                        shade=False)
    assert np.allclose(found.distance, [1, 2, 1, 1])
    assert np.allclose(found.normal, [(0, 0, -1), (0, 0, 1), (0, 0, 1), (0, 0, 1)])  # outwards, but for the room's
    with pytest.raises(lightwalk.InputError, match="indices from 0 to 3"):
        scene.mesh(grey, vertices, [(0, 1, 4)])


def test_a_sky_by_a_generator_lights_the_ground():
    scene = lightwalk.Scene()
    scene.generate("gensky", 6, 21, "12", "+s", "-a", 46, "-o", -7, "-m", -15)
    scene.glow("sky_glow", 1, modifier="skyfunc")
    scene.source("sky_glow", (0, 0, 1), 180)
    E = scene.trace((0, 0, 0), (0, 0, 1), True, ab=1, ad=256)
    assert 50_000 < lightwalk.luminance(E)[0] < 150_000  # a clear day at noon in June [lx]


def test_a_scene_that_is_built_on_has_what_was_added():
    scene = lightwalk.Scene()
    scene.light("lamp", 1)
    scene.sphere("lamp", (0, 4, 0), 1)
    before = scene.trace((0, 0, 0), [(0, 1, 0), (0, 0, 1)])
    scene.sphere("lamp", (0, 0, 4), 1)
    after = scene.trace((0, 0, 0), [(0, 1, 0), (0, 0, 1)])
    assert before[:, 0].tolist() == [1, 0] and after[:, 0].tolist() == [1, 1]


def test_errors_of_files_have_file_and_line(tmp_path):
    file = tmp_path / "wrong.rad"
    file.write_text("void plastic grey 0 0 5 .5 .5 .5 0 0\n\nnobody sphere s 0 0 4 0 0 0 1\ngrey sphere s 0 0 4 0 0 0 1\nnone sphere t 0 0 4 0 0 0 1\n")
    scene = lightwalk.Scene.from_files(file)
    with pytest.raises(lightwalk.InputError) as caught:
        scene.load()
    assert caught.value.file == str(file) and caught.value.line == 3
    assert [problem.line for problem in caught.value.problems] == [3, 5]
    assert isinstance(caught.value, ValueError)
    with pytest.raises(lightwalk.InputError, match="not/there.rad"):
        lightwalk.Scene.from_files("not/there.rad").render()


def test_errors_of_what_is_built_in_code_have_the_place_in_the_code():
    scene = lightwalk.Scene()
    scene.plastic("grey", .5)
    scene.polygons("grey", np.random.default_rng(0).random((50, 3, 3)))
    line = here() + 1
    scene.sphere("gray", (0, 0, 0), 1)
    with pytest.raises(lightwalk.InputError, match="gray") as caught:
        scene.load()
    assert (caught.value.file, caught.value.line) == (__file__, line)
    scene = lightwalk.Scene()
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        scene.light("lamp", 1)
        scene.sphere("lamp", (0, 0, 0), 1)
        line = here() + 1
        scene.text("void glow none 0 0 4 1 1 1 0\nnone polygon p 0 0 9 0 0 0 1 0 0 2 0 0")
        scene.load()
    assert any(f"{__file__}:{line}: " in str(warning.message) for warning in told), [str(warning.message) for warning in told]


@pytest.mark.parametrize("wrong", [
    lambda scene: scene.plastic("two words", .5), lambda scene: scene.plastic("a\nvoid", .5), lambda scene: scene.plastic("", .5),
    lambda scene: scene.plastic("!rm", .5), lambda scene: scene.plastic("#", .5), lambda scene: scene.plastic(None, .5),
    lambda scene: scene.plastic("a", (1, 2)), lambda scene: scene.plastic("a", "red"), lambda scene: scene.plastic("a", float("nan")),
    lambda scene: scene.plastic("a", .5, specularity=float("inf")), lambda scene: scene.plastic("a", .5, modifier="b c"),
    lambda scene: scene.polygon("a", [(0, 0, 0)] * 2 + [(1, 2)]), lambda scene: scene.polygon("a", [[0, 0, None]] * 3),
    lambda scene: scene.polygons("a", np.zeros((3, 3))), lambda scene: scene.mesh("a", np.zeros((3, 3)), [(0, 1, 1.5)]),
    lambda scene: scene.mesh("a", np.zeros((3, 3)), [(0, 1, -1)]), lambda scene: scene.sphere("a", (0, 0), 1), lambda scene: scene.sphere("a", (0, 0, 0), [1, 2]),
    lambda scene: scene.generate("xform", "a\nb"), lambda scene: scene.text(b"void"), lambda scene: scene.primitive("mesh", "m", "void", "a.rtm"),
    lambda scene: scene.include(3), lambda scene: scene.box("a", (0, 0, 0), None)])
def test_what_cannot_be_a_primitive_is_refused_at_once(wrong):
    scene = lightwalk.Scene()
    with pytest.raises((lightwalk.InputError, TypeError)):
        wrong(scene)
    assert scene._pieces == []


def test_scenes_of_files_are_not_built_on(room):
    with pytest.raises(lightwalk.InputError, match="include"):
        room.plastic("a", .5)
    with pytest.raises(lightwalk.InputError, match="without files"):
        lightwalk.Scene.from_files()
    with pytest.raises(lightwalk.InputError, match="empty"):
        lightwalk.Scene().load()


def test_commands_in_scenes_do_not_run_unless_allowed(tmp_path):
    text = f"!touch {tmp_path}/made\nvoid light a 0 0 3 1 1 1\na sphere b 0 0 4 0 0 0 1\n"
    with pytest.raises(lightwalk.InputError, match="touch"):
        lightwalk.Scene.from_bytes(text).load()
    assert not (tmp_path / "made").exists()
    lightwalk.Scene.from_bytes(text, allow_commands=True).load()
    assert (tmp_path / "made").exists()


@pytest.mark.skipif("LIGHTWALK_PRELOAD" in os.environ, reason="sanitizers keep for a while what is freed")
def test_a_thousand_scenes_leave_no_memory_behind():
    # The memory that is in use after the first hundreds is what there is at the end, but for a byte a ray.
    grown = in_new_process("""
import lightwalk, ctypes, gc, numpy
corners = numpy.random.default_rng(0).uniform(1, 5, (60, 3, 3))
def in_use():
    gc.collect()
    ctypes.CDLL(None).malloc_trim(0)
    return int(open("/proc/self/statm").read().split()[1]) * 4096
def once(k):
    scene = lightwalk.Scene()
    scene.light("lamp", 1 + k % 7)
    scene.sphere("lamp", (0, -3, 0), 1)
    scene.plastic("grey", .5)
    scene.polygons("grey", corners)
    scene.render(size=8, n=2)
    scene.trace([(0, 0, 0)] * 500, (0, 1, 0), n=2)
    try:
        lightwalk.Scene.from_bytes("void light a 0 0 2 1 1\\n" * 20).load()
    except lightwalk.InputError:
        pass
for k in range(300):
    once(k)
before = in_use()
for k in range(1000):
    once(k)
print(in_use() - before)
""")
    assert int(grown) < 4 << 20, grown  # where each fifth scene is kept it is 80 MB


def test_too_many_open_scenes_are_refused_by_a_sentence():
    # Embree keeps a key of each thread's own memory for every scene, of which a process has 1024.
    told = in_new_process("""
import lightwalk
kept = []
try:
    for _ in range(1100):
        scene = lightwalk.Scene()
        scene.light("lamp", 1)
        scene.sphere("lamp", (0, -3, 0), 1)
        kept.append(scene.load())
    print("all")
except lightwalk.InputError as error:
    print(error)
kept.pop()
scene.load()
""")
    assert "Embree opens no more scenes" in told, told


def test_options_are_those_of_the_command(room):
    for name in ("render", "animate", "walk", "trace", "contrib"):
        known = lightwalk.options(name)
        assert {"ab", "aa", "as_", "n"} <= set(known) and all(option.text for option in known.values())
        help = command(name, "--help").decode()
        assert all(option.name in help for option in known.values())
    assert lightwalk.options("render")["ab"].default == "0"
    assert "sample_lights" in lightwalk.options() and "o" not in lightwalk.options() and "variant" not in lightwalk.options()


@pytest.mark.parametrize("options, why", [
    ({"abb": 2}, "did you mean 'ab'"), ({"samplelights": 2}, "did you mean 'sample_lights'"), ({"sample": 2}, "did you mean 'samples'"),
    ({"zzzz": 2}, "unknown option 'zzzz'"), ({"ab": "two"}, "-ab"), ({"ab": 1.5}, "-ab"), ({"ab": None, "pa": -1}, "-pa"), ({"av": .1}, "3 values"),
    ({"av": (1, 2)}, "3 values"), ({"av": "1 2 3"}, "3 values"), ({"aa": float("nan")}, "-aa"), ({"aa": [1]}, "aa"), ({"ab": True}, "ab"), ({"dv": 3.5}, "True or False"),
    ({"deterministic": "yes"}, "True or False"), ({"o": "x.hdr"}, "arrays"), ({"variant": "ranks"}, "alone"), ({"allow_commands": True}, "the scene has it"),
    ({"overture": "never"}, "--overture"), ({"n": 0}, "threads"), ({"ab": 10 ** 400}, "-ab"), ({"seed": -1}, "--seed"), ({"ae": ["a", 3j]}, "ae"), ({"ab": "2\0"}, "bytes")])
def test_wrong_options_are_refused_with_what_was_meant(room, options, why):
    with pytest.raises(lightwalk.OptionError, match=why) as caught:
        room.render(VIEW, 8, **options)
    assert isinstance(caught.value, TypeError)


def test_warnings_are_pythons(room):
    with pytest.warns(lightwalk.LightwalkWarning, match="-ps reduced to 16"):
        room.render(VIEW, 8, ps=100)
    dark = lightwalk.Scene()
    dark.plastic("grey", .5)
    dark.sphere("grey", (0, 4, 0), 1)
    with pytest.warns(lightwalk.LightwalkWarning, match="light"):
        dark.render(size=8)
