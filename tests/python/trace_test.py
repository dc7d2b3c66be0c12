"""Rays and contributions through numpy are those of the command."""

import numpy as np
import pytest

import lightwalk
from conftest import ROOM, command

RNG = np.random.default_rng(1)
ORIGINS = RNG.uniform((-3, -5, .5), (3, 5, 2.5), (500, 3))
DIRECTIONS = RNG.normal(size=(500, 3))


def doubles(words, room_file, rays):
    found = command(*words, "-h-", "-fdd", room_file, input=rays.tobytes())
    return np.frombuffer(found).reshape(len(rays), -1)


@pytest.mark.parametrize("irradiance, words, options", [
    (False, [], {}), (True, ["-I+"], {}), (False, ["-ab", "1", "-ad", "32", "-aa", "0", "-dv-"], {"ab": 1, "ad": 32, "aa": 0, "dv": False})])
def test_rays_bring_what_those_of_the_command_bring(room_file, room, irradiance, words, options):
    rays = np.hstack([ORIGINS, DIRECTIONS])
    expected = doubles(["trace", *words, "-ov"], room_file, rays)
    found = room.trace(ORIGINS, DIRECTIONS, irradiance, **options)
    assert found.dtype == np.float32 and found.shape == (500, 3)
    assert np.array_equal(found, expected.astype(np.float32))
    assert found.max() > 0


@pytest.mark.parametrize("words, options", [
    (["-dj", "1"], {"dj": 1}), (["-ab", "2", "-ad", "16", "-aa", "0"], {"ab": 2, "ad": 16, "aa": 0}), (["-ab", "1", "-ad", "16", "-n", "1"], {"ab": 1, "ad": 16, "n": 1})])
def test_intervals_are_those_of_the_command(room_file, room, words, options):
    rays = np.hstack([ORIGINS, DIRECTIONS])
    found = command("trace", *words, "-ov", "--interval", "5", "-h-", "-fdf", room_file, input=rays.tobytes())
    expected = np.frombuffer(found, np.float32).reshape(500, 6)
    told = []
    values, half_widths = room.trace(ORIGINS, DIRECTIONS, interval=5, progress=told.append, **options)
    assert values.dtype == half_widths.dtype == np.float32 and half_widths.shape == (500, 3)
    assert np.array_equal(values, expected[:, :3]) and np.array_equal(half_widths, expected[:, 3:])
    assert (half_widths > 0).any()
    assert told == sorted(told) and all(0 <= share <= 1 for share in told)
    more = room.trace(ORIGINS, DIRECTIONS, interval=5, distance=True, surface=True, **options)
    assert np.array_equal(more.radiance, values) and np.array_equal(more.half_width, half_widths)
    assert np.array_equal(more.distance, room.trace(ORIGINS, DIRECTIONS, distance=True).distance)


def test_light_without_chance_has_an_interval_of_nothing_and_none_where_it_is_not_asked_for(room):
    values, half_widths = room.trace(ORIGINS, DIRECTIONS, interval=2)
    assert np.array_equal(values, room.trace(ORIGINS, DIRECTIONS)) and not half_widths.any()
    assert room.trace(ORIGINS, DIRECTIONS, distance=True).half_width is None
    assert room.trace(np.empty((0, 3)), np.empty((0, 3)), interval=3)[1].shape == (0, 3)
    for interval in (1, -2, 101, 2.5, True, "3"):
        with pytest.raises(lightwalk.OptionError, match="from 2 to 100"):
            room.trace(ORIGINS, DIRECTIONS, interval=interval)
    with pytest.raises(lightwalk.InputError, match="ambient file"):
        room.trace(ORIGINS, DIRECTIONS, interval=2, ab=1, af="values.amb")


def test_rays_tell_where_they_end(room_file, room):
    rays = np.hstack([ORIGINS, DIRECTIONS])
    found = room.trace(ORIGINS, DIRECTIONS, distance=True, normal=True, position=True, surface=True, shade=False)
    expected = doubles(["trace", "-oLpN"], room_file, rays)
    hit = found.distance < 1e9
    assert 50 < hit.sum() < 500
    assert np.array_equal(found.distance[hit], expected[hit, 0])
    assert np.array_equal(found.position[hit], expected[hit, 1:4])
    assert np.array_equal(found.normal, expected[:, 4:7])
    names = command("trace", "-h-", "-fda", "-os", room_file, input=rays.tobytes()).decode().split()
    assert [name if name != "*" else "" for name in names] == found.surface.tolist()
    assert {"floor", "back", "ball", ""} <= set(found.surface.tolist())
    assert not found.radiance.any()


def test_one_origin_does_for_many_directions(room):
    assert np.array_equal(room.trace((0, 0, 1), DIRECTIONS), room.trace(np.repeat([[0, 0, 1.]], 500, 0), DIRECTIONS))
    assert room.trace((0, 0, 1), (0, 1, 0)).shape == (1, 3)
    assert room.trace(np.empty((0, 3)), np.empty((0, 3))).shape == (0, 3)
    assert room.trace(np.empty((0, 3)), np.empty((0, 3)), surface=True).surface.shape == (0,)
    strided = np.asfortranarray(np.hstack([ORIGINS] * 2))[::5, 3:].astype(np.float32)
    assert room.trace(strided, DIRECTIONS[::5]).shape == (100, 3)


def test_illuminance_under_a_small_lamp_follows_the_inverse_square():
    scene = lightwalk.Scene()
    scene.light("lamp", 100)
    scene.sphere("lamp", (0, 0, 4), .05)
    heights = np.array([0, 1, 2, 3.])
    E = scene.trace([(0, 0, z) for z in heights], (0, 0, 1), irradiance=True)[:, 0]
    assert np.allclose(E, 100 * np.pi * .05 ** 2 / (4 - heights) ** 2, rtol=.01)


def test_contributions_are_those_of_the_command_and_add_up(room_file, room):
    rays = np.hstack([ORIGINS, DIRECTIONS])[:60]
    options = {"ab": 1, "ad": 32}
    words = ["contrib", "-I+", "-ab", "1", "-ad", "32", "-e", "side=if(Dx,0,1)", "-bn", "2", "-b", "side", "-m", "lamp"]
    expected = doubles(words, room_file, rays).reshape(60, 2, 3)
    found = room.contrib(rays[:, :3], rays[:, 3:], {"lamp": ("side", 2)}, True, e="side=if(Dx,0,1)", **options)
    assert list(found) == ["lamp"] and np.array_equal(found["lamp"], expected) and expected.max() > 0
    whole = room.contrib(rays[:, :3], rays[:, 3:], "lamp", True, V=True, **options)["lamp"]
    E = room.trace(rays[:, :3], rays[:, 3:], True, ab=1, ad=32, aa=0, as_=0, dj=.9, dt=0, lw=.002, st=.02)
    assert whole.shape == (60, 1, 3)
    assert np.allclose(whole[:, 0].mean(0), E.mean(0), rtol=.1)


def test_contributions_of_modifiers_that_are_not_there_are_refused(room):
    for wrong, why in (("sun", 'no modifier "sun"'), (["lamp", "lamp"], None), ({"lamp": ("side", 2)}, "side"), ({"lamp": 3}, "expression"), (7, "names"),
                       ([], "no modifier")):
        if why is None:
            assert list(room.contrib((0, 0, 1), (0, 0, 1), wrong)) == ["lamp"]
            continue
        with pytest.raises(lightwalk.Error, match=why):
            room.contrib((0, 0, 1), (0, 0, 1), wrong)


def test_scenes_of_the_same_bytes_have_the_same_digest():
    assert lightwalk.Scene.from_bytes(ROOM).bounds[1].tolist() == [4, 6, 3]
