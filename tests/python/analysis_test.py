"""What is made of pictures."""

import numpy as np
import pytest

import lightwalk


def test_luminance_is_radiances_own():
    assert lightwalk.luminance([1, 1, 1]) == pytest.approx(179, rel=1e-6)
    assert lightwalk.luminance(np.zeros((4, 5, 3))).shape == (4, 5)
    with pytest.raises(lightwalk.InputError, match="..., 3"):
        lightwalk.luminance([1, 2])


def test_false_colours_go_from_blue_to_red():
    colors = lightwalk.false_color([[0, 50, 100, np.nan, np.inf]], 100)
    assert colors.dtype == np.uint8 and colors.shape == (1, 5, 3)
    blue, middle, red, nothing, endless = colors[0].astype(int)
    assert blue[2] > blue[0] and middle[1] > middle[0] and red[0] > red[2]
    assert (nothing == blue).all() and (endless == red).all()
    assert lightwalk.false_color([[1, 10, 100]], 100, decades=2)[0, 1].tolist() == middle.tolist()
    assert lightwalk.false_color(np.zeros((2, 2))).shape == (2, 2, 3)


def test_a_grid_lies_in_the_middle_of_its_cells():
    points = lightwalk.grid((0, 0, .8), (4, 2, .8), 4, 2)
    assert points.shape == (2, 4, 3)
    assert points[0, 0].tolist() == [.5, .5, .8] and points[1, 3].tolist() == [3.5, 1.5, .8]


def test_the_eyes_illuminance_under_an_even_sky_is_pi_times_its_radiance():
    scene = lightwalk.Scene()
    scene.glow("sky", 10)
    scene.source("sky", (0, 1, 0), 360)
    view = lightwalk.View.fisheye((0, 0, 0), (0, 1, 0))
    picture = scene.render(view, 256, ps=1)
    report = lightwalk.glare(picture, view)
    assert report.vertical_illuminance == pytest.approx(179 * np.pi * 10, rel=.01)
    assert report.average_luminance == pytest.approx(1790, rel=.001)
    assert report.sources == () and report.dgp == pytest.approx(5.87e-5 * report.vertical_illuminance + .16, rel=1e-3)
    scene.light("sun", 1e6)
    scene.source("sun", (.1, 1, .1), 2)
    bright = lightwalk.glare(scene.render(view, 256, ps=1), view)
    assert len(bright.sources) == 1 and bright.dgp > report.dgp
    assert np.allclose(bright.sources[0].direction, np.array([.1, 1, .1]) / np.sqrt(1.02), atol=.02)
    with pytest.raises(lightwalk.InputError):
        lightwalk.glare(picture, lightwalk.View())
