"""Lightwalk: light in buildings that do not exist yet, by the methods of Radiance.

    import lightwalk
    scene = lightwalk.Scene.from_files("room.rad", "sky.rad")
    picture = scene.render(lightwalk.View((2, 1, 1.6), (0, 1, 0)), size=(640, 480), ab=2)   # float32 (h, w, 3) [W/(m² sr)]
    lux = 179 * scene.trace(points, normals, irradiance=True, ab=3) @ lightwalk.LUMINANCE_WEIGHTS
"""

from ._analysis import LUMINANCE_WEIGHTS, Glare, false_color, glare, grid, luminance
from ._errors import Error, InputError, LightwalkWarning, OptionError, Problem
from ._options import Option, options
from ._scene import Picture, Rays, Scene, demo_scene, demo_views, save_picture
from ._view import View
from .bin import _core as _core

__version__: str = _core.version
__all__ = ["LUMINANCE_WEIGHTS", "Error", "Glare", "InputError", "LightwalkWarning", "Option", "OptionError", "Picture", "Problem", "Rays", "Scene", "View",
           "demo_scene", "demo_views", "false_color", "glare", "grid", "luminance", "options", "save_picture"]
