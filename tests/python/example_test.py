"""The notebook in apps/python/examples runs from its first cell to its last."""

import json
import pathlib
import sys
import types

import numpy as np

NOTEBOOK = pathlib.Path(__file__).resolve().parents[2] / "apps/python/examples/room.ipynb"


class Anything:
    """Stands for plots, where matplotlib is not installed."""

    def __getattr__(self, name):
        return lambda *_, **__: None

    def __getitem__(self, place):
        return self


def code(size):
    cells = [cell for cell in json.loads(NOTEBOOK.read_text())["cells"] if cell["cell_type"] == "code"]
    return "\n".join("".join(cell["source"]) for cell in cells).replace("size=400", f"size={size}").replace("ad=256", "ad=64")


def test_the_room_of_the_notebook_is_lit_by_its_window(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    try:
        import matplotlib
        matplotlib.use("Agg")
    except ImportError:
        plots = types.ModuleType("matplotlib.pyplot")
        plots.subplots = lambda *_, **__: (Anything(), Anything())
        monkeypatch.setitem(sys.modules, "matplotlib", types.ModuleType("matplotlib"))
        monkeypatch.setitem(sys.modules, "matplotlib.pyplot", plots)
        sys.modules["matplotlib"].pyplot = plots
    found = {}
    exec(compile(code(48), str(NOTEBOOK), "exec"), found)
    assert found["picture"].shape == (38, 48, 3) or found["picture"].shape[1] == 48
    lux = found["lux"]
    assert lux.shape == (16, 20) and lux[:4].mean() > 2 * lux[-4:].mean() > 100  # brighter at the window
    assert .2 < found["glare"].dgp <= 1
    assert np.isfinite(found["fisheye"]).all()


def test_the_notebook_has_some_thirty_lines():
    lines = [line for line in code(400).splitlines() if line.strip() and not line.startswith("#")]
    assert len(lines) <= 32
