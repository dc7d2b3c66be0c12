"""Pictures."""

from __future__ import annotations

from typing import Any

from ._programs import Input, file_or_bytes, options, run, switches


def pfilt(image: Input, xres: str | None = None, yres: str | None = None, pixel_aspect: float = 0, pa_correct: bool = False,
          exposure: float | None = 0, lamp: str | None = None, lampdat: str | None = None, one_pass: bool = False,
          gaussian_filter_radius: float | None = None, limitfrac: float | None = None, hot_threshold: float = 100, star_points: int = 0,
          star_spread: float = .0001, average_hot: bool = False) -> bytes:
    """Filters and exposes a picture.

    Args:
        image: the picture
        xres, yres: its new size [pixels], or "/2" for what the old one is divided by
        pixel_aspect: height of a pixel over its width; 0: as it was
        pa_correct: change the size for it
        exposure: a factor, or with a sign f-stops ("+1"); 0 or None: automatic
        lamp, lampdat: a lamp whose colour becomes white, and the table of lamps
        one_pass: without the pass that looks for what is too bright, and the exposure
        gaussian_filter_radius: of a Gaussian filter [new pixels]; without: a box
        limitfrac: what no more than a pixel may bring to the sum of a filter, 0 to 1
        hot_threshold: from where a pixel counts as hot [W/(m² sr)]
        star_points, star_spread: of stars drawn at hot pixels
        average_hot: hot pixels are averaged as others
    Returns:
        the picture (RGBE)
    Raises:
        ProgramError: for what is no picture, and sizes that none has
        TypeError: `image` is neither a path nor bytes
    """
    file, stdin = file_or_bytes("image", image)
    words: list[Any] = [*options(x=xres, y=yres, p=pixel_aspect or None), *switches(c=pa_correct), *options(e=exposure or None, t=lamp, f=lampdat)]
    words += [*switches(**{"1": one_pass}), *options(r=gaussian_filter_radius or None, m=limitfrac or None)]
    words += options(h=None if hot_threshold == 100 else hot_threshold, n=star_points or None, s=None if star_spread == .0001 else star_spread)
    return run("pfilt", [*words, *switches(a=average_hot), *file], stdin)


def pvalue(pic: Input, unique: bool = False, original: bool = False, header: bool = True, resstr: bool = True, skip: int = 0, exposure: int = 0,
           gamma: float = 1.0, dataonly: bool = False, outform: str = "", reverse_rgb: bool = False, interleaving: bool = True,
           brightness: bool = False, outprimary: str | None = None) -> bytes:
    """The numbers of a picture.

    Args:
        pic: the picture
        unique: only those pixels that differ from the one before
        original: before the picture's exposure
        header, resstr: whether there is a header, and a line of the size
        skip: bytes that are skipped
        exposure: f-stops by which values change
        gamma: what values are raised to the inverse of
        dataonly: without the pixels' places
        outform: "a" text, "f" and "d" binary floating-point numbers, "b" bytes ...
        reverse_rgb: blue, green, red
        interleaving: False: all of a channel, then the next
        brightness: one value a pixel
        outprimary: the colours' primaries, "XYZ"
    Returns:
        the numbers
    Raises:
        ProgramError: for what is no picture
        TypeError: `pic` is neither a path nor bytes
    """
    file, stdin = file_or_bytes("pic", pic)
    words: list[Any] = [*switches(u=unique, o=original, h=not header, H=not resstr), *options(s=skip or None, e=exposure or None)]
    words += [*options(g=None if gamma == 1 else gamma), *switches(d=dataonly), *([f"-d{outform}"] if outform else [])]
    words += [*switches(R=reverse_rgb, n=not interleaving, b=brightness), *([f"-p{outprimary}"] if outprimary is not None else [])]
    return run("pvalue", [*words, *file], stdin)


def falsecolor(inp: Input, pic_overlay: str | None = None, contour: str | None = None, extrema: bool = False, scale: str | None = None,
               digits: int | None = None, label: str | None = None, ndivs: int | None = None, lwidth: int | None = None, lheight: int | None = None,
               decades: int | None = None, multiplier: float | None = None, palette: str | None = None, redv: str | None = None,
               grnv: str | None = None, bluv: str | None = None) -> bytes:
    """A picture in false colours.

    Args:
        inp: the picture
        pic_overlay: one that contours are drawn upon
        contour: "b" bands, "l" lines, "p" posterised; without: colours everywhere
        extrema: marks the darkest and the brightest pixel
        scale: the value at the legend's end, "auto" for the picture's greatest
        digits: most digits behind the point in the legend
        label: of the legend
        ndivs: how many steps the legend has
        lwidth, lheight: the legend's size [pixels]; 0: none
        decades: of a logarithmic scale
        multiplier: of the values; 179 by default, which gives cd/m²
        palette: "def", "spec", "pm3d", "hot" ...
        redv, grnv, bluv: expressions of colours
    Returns:
        the picture (RGBE)
    Raises:
        ValueError: another contour
        ProgramError: for what is no picture, and wrong options
        TypeError: `inp` is neither a path nor bytes
    """
    if contour is not None and (not isinstance(contour, str) or contour not in ("b", "l", "p")):
        raise ValueError("Invalid value for contour. Allowed values are 'b', 'l', or 'p'.")
    file, stdin = file_or_bytes("inp", inp)
    words: list[Any] = [*(["-i", *file] if file else []), *options(p=pic_overlay), *([f"-c{contour}"] if contour is not None else [])]
    words += [*switches(e=extrema), *options(s=scale, d=digits, l=label, n=ndivs, lw=lwidth, lh=lheight, log=decades, m=multiplier, pal=palette)]
    return run("falsecolor", words + options(r=redv, g=grnv, b=bluv), stdin)
