"""A walk from Python: the page is served, may be shown in a notebook, and goes when it is no longer wanted."""

import gc
import urllib.error
import urllib.request

import pytest

import lightwalk
from conftest import VIEW


def test_a_walk_serves_its_page_until_it_is_stopped(room):
    walk = room.walk(VIEW, n=1)
    assert walk.address.startswith("http://127.0.0.1:") and walk.running and walk.address in repr(walk)
    with urllib.request.urlopen(walk.address) as page:
        assert b"<html" in page.read()
        policy = page.headers["Content-Security-Policy"]
    assert "frame-ancestors http://localhost:* http://127.0.0.1:*" in policy
    assert f'<iframe src="{walk.address}"' in walk._repr_html_()
    walk.stop()
    walk.stop()
    assert not walk.running and "ended" in repr(walk)
    with pytest.raises(urllib.error.URLError):
        urllib.request.urlopen(walk.address)


def test_a_walk_of_a_scene_that_was_built_ends_with_its_owner():
    scene = lightwalk.Scene()
    scene.light("lamp", 1)
    scene.sphere("lamp", (0, 4, 0), 1)
    walk = scene.walk(n=1, embed="https://notebooks.example")
    with urllib.request.urlopen(walk.address) as page:
        assert "frame-ancestors https://notebooks.example" in page.headers["Content-Security-Policy"]
    process = walk._process
    del walk
    gc.collect()
    assert process.poll() is not None


def test_what_a_walk_cannot_be_is_refused(room):
    for wrong, why in (({"abb": 1}, "did you mean"), ({"fps": 0}, "--fps"), ({"port": 70000}, "port"), ({"embed": "a; script-src *"}, "--embed"), ({"o": "f"}, "arrays")):
        with pytest.raises(lightwalk.OptionError, match=why):
            room.walk(VIEW, **wrong)
