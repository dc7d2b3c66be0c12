"""The functions of the package pyradiance that Lightwalk has, with its signatures; what they run is Lightwalk.

    import lightwalk.pyradiance as pyradiance
    octree = pyradiance.oconv("room.rad", "sky.rad")

Names that are not here raise an AttributeError whose text says what to use.
"""

from __future__ import annotations

from typing import Any

from ._absent import NotCovered, refusal
from ._programs import ProgramError
from .anci import write
from .gen import genblinds, genbox, gendaylit, genprism, genrev, gensky, gensurf
from .model import Primitive, Scene
from .ot import oconv
from .px import falsecolor, pfilt, pvalue
from .rad_params import (RayParams, View, ViewFileError, create_default_view, get_default_ray_params, get_ray_params, get_ray_params_args, get_view_args,
                         parse_view, ray_done, set_option, set_ray_params, viewfile)
from .rt import Rcontrib, rpict, rtrace
from .util import Xform, evalglare, get_header, get_image_dimensions, getinfo, parse_primitive, render, vwrays

__all__ = ["NotCovered", "Primitive", "ProgramError", "RayParams", "Rcontrib", "Scene", "View", "ViewFileError", "Xform", "create_default_view", "evalglare",
           "falsecolor", "genblinds", "genbox", "gendaylit", "genprism", "genrev", "gensky", "gensurf", "get_default_ray_params", "get_header",
           "get_image_dimensions", "get_ray_params", "get_ray_params_args", "get_view_args", "getinfo", "oconv", "parse_primitive", "parse_view", "pfilt", "pvalue",
           "ray_done", "render", "rpict", "rtrace", "set_option", "set_ray_params", "viewfile", "vwrays", "write"]


def __getattr__(name: str) -> Any:
    raise refusal(name)
