"""What is made of radiances: luminances, false colours, grids of points, glare."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

from . import _arrays
from ._errors import InputError
from ._view import ViewLike, view_words
from .bin import _core

#: Luminance of 1 W/(m² sr) in each channel, over 179 lm/W. Source: Ward Larson & Shakespeare, "Rendering with Radiance" (1998), ch. 10.
LUMINANCE_WEIGHTS = np.array([0.26510582, 0.67010582, 0.06478836])


def luminance(light: Any) -> np.ndarray:
    """Of radiance the luminance [cd/m²], of irradiance the illuminance [lx].

    Args:
        light: (..., 3) [W/(m² sr)] or [W/m²]
    Returns:
        float64 (...)
    """
    array = _arrays.numbers("light", light, finite=False)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise InputError("light: expected the shape (..., 3)")
    return 179 * (array @ LUMINANCE_WEIGHTS)


def false_color(values: Any, scale: float | None = None, decades: float = 0) -> np.ndarray:
    """Numbers as colours, from blue by green and yellow to red.

    Args:
        values: (height, width), as of luminance()
        scale: the number that is red; None: the largest one
        decades: powers of ten that the colours span, logarithmically; 0: they are linear
    Returns:
        uint8 (height, width, 3), sRGB
    """
    array = _arrays.numbers("values", values, finite=False)
    top = float(scale) if scale is not None else float(np.nanmax(array, initial=0, where=np.isfinite(array)))
    if not (np.isfinite(top) and top >= 0 and np.isfinite(decades) and decades >= 0):
        raise InputError("scale and decades: expected finite numbers of at least 0")
    share = np.nan_to_num(array / (top or 1), nan=0, posinf=1, neginf=0)
    if decades:
        share = 1 + np.log10(np.maximum(share, 10.0 ** -decades)) / decades
    stops = np.array([[0, 0, 96], [0, 64, 255], [0, 200, 160], [96, 220, 0], [255, 230, 0], [255, 128, 0], [200, 0, 0]], float)
    at = np.clip(share, 0, 1) * (len(stops) - 1)
    return np.stack([np.interp(at, range(len(stops)), stops[:, k]) for k in range(3)], -1).round().astype(np.uint8)


def grid(lower: Any, upper: Any, columns: int, rows: int) -> np.ndarray:
    """Points of a level plane, in the middle of equal cells.

    Args:
        lower, upper: corners (x, y, z), of equal height [m]
    Returns:
        float64 (rows, columns, 3), which reshape(-1, 3) makes a list for `Scene.trace`
    """
    low, high = _arrays.numbers("lower", lower, 3)[0], _arrays.numbers("upper", upper, 3)[0]
    if not (1 <= columns <= 1 << 14 and 1 <= rows <= 1 << 14):
        raise InputError("columns and rows: expected from 1 to 16384")
    x = low[0] + (high[0] - low[0]) * (np.arange(int(columns)) + .5) / int(columns)
    y = low[1] + (high[1] - low[1]) * (np.arange(int(rows)) + .5) / int(rows)
    points = np.empty((len(y), len(x), 3))
    points[..., 0], points[..., 1], points[..., 2] = x, y[:, None], low[2]
    return points


@dataclasses.dataclass(frozen=True)
class Glare:
    """Daylight glare of a picture.

    Attributes:
        dgp: daylight glare probability, the share of people who are disturbed (Wienold & Christoffersen 2006)
        low_light_correction: factor of dgp for dim surroundings (Wienold 2009)
        within_assessments: False: dgp is beyond what people were asked for
        vertical_illuminance: at the eye [lx]
        average_luminance: [cd/m²]
        sources: for each source of glare, the worst first: luminance [cd/m²], solid_angle [sr], position_index, direction
    """

    dgp: float
    low_light_correction: float
    within_assessments: bool
    vertical_illuminance: float
    average_luminance: float
    sources: tuple[Any, ...]


def glare(radiance: Any, view: ViewLike, threshold: float = 2000) -> Glare:
    """How much a picture's light disturbs the eye.

    Args:
        radiance: (height, width, 3) [W/(m² sr)], of a fisheye
        view: of the picture: type a or h, 180 by 180 degrees, as View.fisheye() makes it
        threshold: brighter pixels are glare [cd/m²]
    Raises:
        InputError: other views and shapes
    """
    array = _arrays.picture("radiance", radiance)
    text = _core.view_text(view_words(view))
    report = _core.glare(array, array.shape[1], array.shape[0], text, float(threshold))
    return Glare(report.dgp, report.low_light_correction, report.within_assessments, report.vertical_illuminance, report.average_luminance,
                 tuple(report.sources))
