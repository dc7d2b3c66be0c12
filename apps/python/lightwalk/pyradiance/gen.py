"""Generators of skies and shapes. All return a scene description."""

from __future__ import annotations

from datetime import datetime
from typing import Any, Sequence

from ._programs import options, run, switches


def _moment(function: str, dt: datetime | None, latitude: float | None, longitude: float | None, timezone: float | None, altitude: float | None,
            azimuth: float | None, year: int | None) -> list[Any]:
    """Where the sun is, by the time and the place or by its angles."""
    if dt is not None:
        if not isinstance(dt, datetime):
            raise TypeError(f"{function}: expected a datetime, found {type(dt).__name__}")
        hour = dt.hour + dt.minute / 60 + (dt.second / 3600 if function.endswith("gendaylit") else 0)  # as pyradiance has it
        return [dt.month, dt.day, hour, *options(a=latitude, o=longitude, m=timezone, y=year)]
    if altitude is None or azimuth is None:
        raise ValueError(f"{function}: Must provide either dt or altitude and azimuth")
    return ["-ang", altitude, azimuth]


def gensky(dt: datetime | None = None, latitude: float | None = None, longitude: float | None = None, timezone: int | None = None,
           altitude: float | None = None, azimuth: float | None = None, year: int | None = None, sunny_with_sun: bool = False,
           sunny_without_sun: bool = False, cloudy: bool = False, intermediate_with_sun: bool = False, intermediate_without_sun: bool = False,
           uniform: bool = False, ground_reflectance: float | None = None, zenith_brightness: float | None = None,
           horizontal_brightness: float | None = None, solar_radiance: float | None = None, horizontal_direct_irradiance: float | None = None,
           turbidity: float | None = None) -> bytes:
    """A CIE sky.

    Args:
        dt: local standard time; its year and its seconds do not count
        latitude, longitude, timezone: [degrees north, west, and west of the meridian of the time]; they and `year` count with `dt` only
        altitude, azimuth: of the sun [degrees above the horizon, and west of south], where there is no `dt`
        year: for the sun's position of that year
        sunny_with_sun, sunny_without_sun, cloudy, intermediate_with_sun, intermediate_without_sun, uniform: the sky; the first that is true
        ground_reflectance: 0 to 1
        zenith_brightness: [W/(m² sr)]
        horizontal_brightness: the same by the horizontal diffuse irradiance [W/m²]; not with `zenith_brightness`
        solar_radiance: [W/(m² sr)]
        horizontal_direct_irradiance: the same by the irradiance [W/m²]; not with `solar_radiance`
        turbidity: Linke's
    Raises:
        ValueError: neither a time nor the sun's angles
        TypeError: `dt` is no datetime
        ProgramError: for values that no sky has
    """
    words = _moment("pyradiance.gensky", dt, latitude, longitude, timezone, altitude, azimuth, year)
    skies = {"+s": sunny_with_sun, "-s": sunny_without_sun, "-c": cloudy, "+i": intermediate_with_sun, "-i": intermediate_without_sun, "-u": uniform}
    words += [option for option, wanted in skies.items() if wanted][:1]
    words += options(g=ground_reflectance)
    words += options(b=zenith_brightness) or options(B=horizontal_brightness)
    words += options(r=solar_radiance) or options(R=horizontal_direct_irradiance)
    return run("gensky", words + options(t=turbidity), messages="drop")


def gendaylit(dt: datetime | None = None, latitude: float | None = None, longitude: float | None = None, timezone: int | None = None,
              altitude: float | None = None, azimuth: float | None = None, year: int | None = None, dirnorm: float | None = None,
              diffhor: float | None = None, dirhor: float | None = None, dirnorm_illum: float | None = None, diffhor_illum: float | None = None,
              solar: bool = False, sky_only: bool = False, silent: bool = False, grefl: float | None = None, interval: int | None = None) -> bytes:
    """A sky after Perez.

    Args:
        dt, latitude, longitude, timezone, altitude, azimuth, year: as gensky()'s, but that seconds count
        dirnorm, diffhor: direct normal and diffuse horizontal irradiance [W/m²]
        dirhor: direct horizontal irradiance [W/m²], with `diffhor` in place of `dirnorm`
        dirnorm_illum, diffhor_illum: direct normal and diffuse horizontal illuminance [lx]; the first pair that is given counts
        solar: radiances of the whole solar spectrum rather than of visible light
        sky_only: no sun
        silent: no warnings in the output
        grefl: reflectance of the ground, 0 to 1
        interval: of the weather data [min], which the sun's position is corrected by
    Raises:
        ValueError: neither a time nor the sun's angles
        TypeError: `dt` is no datetime
        ProgramError: for values that no sky has
    """
    words = _moment("pyradiance.gendaylit", dt, latitude, longitude, timezone, altitude, azimuth, year)
    pairs = (("-W", dirnorm, diffhor), ("-G", dirhor, diffhor), ("-L", dirnorm_illum, diffhor_illum))
    words += next(([*pair] for pair in pairs if None not in pair), [])
    words += [*(["-O", 1] if solar else []), *switches(s=sky_only, w=silent), *options(g=grefl, i=interval)]
    return run("gendaylit", words, messages="drop")


def genbox(mat: str, name: str, xsiz: float, ysiz: float, zsiz: float, inward: bool = False, beveled: float | None = None,
           rounded: float | None = None, nsegs: int | None = None, smoothing: bool = False, waveout: bool = False) -> bytes:
    """A box with a corner at the origin.

    Args:
        mat, name: of its material, and its own
        xsiz, ysiz, zsiz: [m]
        inward: whether it is seen from inside
        beveled, rounded: what is taken from its edges [m]; one of the two
        nsegs: polygons a rounded edge; without: cylinders and spheres
        smoothing: of these polygons, by their normals
        waveout: an object file (.obj)
    Raises:
        ProgramError: for sizes that no box has
    """
    words = [mat, name, xsiz, ysiz, zsiz, *switches(i=inward), *options(b=beveled, r=rounded, n=nsegs), *switches(s=smoothing, o=waveout)]
    return run("genbox", words)


def genblinds(mat: str, name: str, depth: float, width: float, height: float, nslats: int, angle: float, rcurv: float | None = None) -> bytes:
    """Venetian blinds.

    Args:
        mat, name: of their material, and their own
        depth, width, height: of a slat, and of all [m]
        nslats: how many slats there are
        angle: of the slats [degrees]
        rcurv: radius of the slats' curvature [m]: positive, upward; negative, downward; 0: none
    Raises:
        ProgramError: for sizes that no blinds have
    """
    curvature = [] if not rcurv else ["+r" if rcurv > 0 else "-r", abs(rcurv)]
    return run("genblinds", [mat, name, depth, width, height, nslats, angle, *curvature])


def genprism(mat: str, name: str, vertices: Sequence[float] | None = None, vfile: str | None = None, lvect: Sequence[float] | None = None,
             radius: float | None = None, no_connect: bool = False, no_ends: bool = False, stdin: bytes | None = None) -> bytes:
    """A polygon in the plane z = 0 that is drawn along a line.

    Args:
        mat, name: of its material, and its own
        vertices: x, y of each corner [m], flat: [0, 0, 1, 0, 1, 1]
        vfile: a file of them; "-": `stdin`. One of the two
        lvect: the line [m], (0, 0, 1) by default
        radius: of rounded edges [m]
        no_connect: without the face from the last corner to the first
        no_ends: without the polygons at both ends
        stdin: what `vfile` "-" reads
    Raises:
        ValueError: fewer than three corners, half a corner, both or none of `vertices` and `vfile`, a line of other than three numbers
        ProgramError: for shapes that no prism has
    """
    if (vertices is None) == (vfile is None):
        raise ValueError("pyradiance.genprism: Must provide either vertices or vfile")
    if vertices is not None:
        values = list(vertices)
        if len(values) % 2:
            raise ValueError("pyradiance.genprism: vertices must contain an even number of values (x, y pairs)")
        if len(values) < 6:
            raise ValueError("pyradiance.genprism: vertices must contain at least 3 pairs")
        corners = [len(values) // 2, *values]
    else:
        corners = [vfile]
    if lvect is not None and len(lvect) != 3:
        raise ValueError("pyradiance.genprism: lvect must have 3 values")
    words = [mat, name, *corners, *(["-l", *lvect] if lvect is not None else []), *options(r=radius), *switches(c=no_connect, e=no_ends)]
    return run("genprism", words, stdin, "drop")


def genrev(mat: str, name: str, z_t: str, r_t: str, nseg: int, expr: str | None = None, file: str | None = None, smooth: bool = False) -> bytes:
    """A surface of revolution about the z axis: z(t), r(t), t from 0 to 1.

    Args:
        mat, name: of its material, and its own
        z_t, r_t: expressions of t [m]
        nseg: how many pieces approximate it
        expr, file: definitions that these use: a text, a file
        smooth: normals of a smooth surface
    Raises:
        ProgramError: for what is no expression
    """
    return run("genrev", [mat, name, z_t, r_t, nseg, *options(e=expr, f=file), *switches(s=smooth)])


def gensurf(mat: str, name: str, x: str, y: str, z: str, m: int, n: int, expr: str | None = None, file: str | None = None, invert: bool = False,
            smooth: bool = False, waveout: bool = False, stdin: bytes | None = None) -> bytes:
    """A curved surface x(s,t), y(s,t), z(s,t); s and t from 0 to 1.

    Args:
        mat, name: of its material, and its own
        x, y, z: expressions [m]; or z a file of heights; or all three one file of points; "-": `stdin`
        m, n: steps of s and t
        expr, file: definitions that the expressions use: a text, a file
        invert: the normals point the other way
        smooth: normals of a smooth surface
        waveout: an object file (.obj)
        stdin: what "-" reads
    Raises:
        ProgramError: for what is no expression, and wrong files
    """
    words = [mat, name, x, y, z, m, n, *options(e=expr, f=file), *switches(i=invert, s=smooth, o=waveout)]
    return run("gensurf", words, stdin, "drop")
