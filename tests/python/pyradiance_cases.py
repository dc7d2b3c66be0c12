"""Calls of pyradiance's functions, and the command lines that pyradiance 1.3.1 runs for them: the call, the words as a shell has them,
and standard input. In the calls D is a time, P makes a path, and a.hdr holds b"bytes"."""

CALLS = [
    ("oconv('a.rad')", "oconv a.rad"),
    ("oconv(P('a.rad'), 'b.rad', warning=False, frozen=True, octree='x.oct')", "oconv -i x.oct -w -f a.rad b.rad"),
    ("oconv(stdin=b'void')", "oconv -", b'void'),
    ("oconv('a.rad', stdin=b'void')", "oconv a.rad -", b'void'),
    ("oconv(stdin=b'')", "oconv", b''),
    ("rpict(['-vp', '0', '0', '1'], 'a.oct')", "rpict -vp 0 0 1 a.oct"),
    ("rpict(['-vtv'], P('a.oct'), xres=5, yres=6, report=1.5, report_file=P('r'), params=['-ab', '1'])", "rpict -vtv -t 1.5 -e r -x 5 -y 6 -ab 1 a.oct"),
    ("rtrace(b'rays', 'a.oct')", "rtrace -faa a.oct", b'rays'),
    ("rtrace(b'rays', 'a.oct', header=False, inform='f', outform='d', irradiance=True, irradiance_lambertian=True, outspec='vn', trace_exclude='a', "
     "trace_include='b', uncorrelated=True, xres=3, yres=4, nproc=2, params=['-ab', '1'], report=True)",
     "rtrace -h -I -ffd -ovn -te a -u+ -x 3 -y 4 -n 2 -ab 1 a.oct", b'rays'),
    ("rtrace(b'rays', P('a.oct'), irradiance_lambertian=True, trace_include='a', trace_exclude_file='b')", "rtrace -i -faa -ti a a.oct", b'rays'),
    ("rtrace(b'', 'a.oct', trace_exclude_file=P('e f'), trace_include_file='i', xres=0, yres=0, nproc=0)", "rtrace -faa -tE 'e f' -x 0 -y 0 a.oct", b''),
    ("rtrace(b'', 'a.oct', trace_include_file='i', outform='c', inform='d', nproc=1)", "rtrace -fdc -tI i -n 1 a.oct", b''),
    ("rtrace(b'', 'a.oct', version=True)", "rtrace -version"),
    ("Rcontrib(b'rays', 'a.oct').add_modifier('m')()", "rcontrib -n 1 -m m a.oct", b'rays'),
    ("Rcontrib(b'rays', P('a.oct'), nproc=4, yres=7, inform='f', outform='d', report=3, params=['-I', '-ab', '2']).add_modifier(modifier='m', calfile='k.cal', "
     "expression='a:1', nbins='Nr', binv='rbin', param='MF=1', xres=3, yres=4, output='o.dat').add_modifier(modifier_path='mods', binv='0')()",
     "rcontrib -n 4 -I -ab 2 -ffd -y 7 -t 3 -f k.cal -e a:1 -bn Nr -b rbin -p MF=1 -x 3 -y 4 -o o.dat -m m -b 0 -M mods a.oct", b'rays'),
    ("Rcontrib(b'rays', 'a.oct')()", "rcontrib -n 1 a.oct", b'rays'),
    ("vwrays(view=['-vp', '0', '0', '1'])", "vwrays -c 1 -pj 0 -pd 0 -pa 1 -x 512 -y 512 -vp 0 0 1"),
    ("vwrays(pic='a.hdr')", "vwrays -c 1 -pj 0 -pd 0 -pa 1 -x 512 -y 512 a.hdr"),
    ("vwrays(b'1 2', True, 'f', 4, .5, .25, 1.5, 6, 7, True, ['-vta'], None, None)", "vwrays -i -u -ff -c 4 -pj 0.5 -pd 0.25 -pa 1.5 -x 6 -y 7 -d -vta", b'1 2'),
    ("vwrays(b'', view=['-vta'], pic='a.hdr', zbuf='z')", "vwrays -i -c 1 -pj 0 -pd 0 -pa 1 -x 512 -y 512 -vta", b''),
    ("vwrays(pic=P('a.hdr'), zbuf=P('z'), outform='d', dimensions=True, xres=0)", "vwrays -fd -c 1 -pj 0 -pd 0 -pa 1 -x 0 -y 512 -d a.hdr z"),
    ("getinfo('a.hdr')", "getinfo a.hdr"),
    ("getinfo(P('a.hdr'), 'b')", "getinfo a.hdr b"),
    ("getinfo(b'bytes')", "getinfo", b'bytes'),
    ("getinfo()", "getinfo"),
    ("getinfo('a.hdr', dimension_only=True, dimension=True, replace='r', append='a', command='c d')", "getinfo -d -c 'c d' a.hdr"),
    ("getinfo(b'bytes', dimension=True, append='a')", "getinfo +d", b'bytes'),
    ("getinfo('a.hdr', replace='r', append='a')", "getinfo -r r a.hdr"),
    ("getinfo('a.hdr', append='a b', command='c')", "getinfo -a 'a b' -c c a.hdr"),
    ("getinfo('a.hdr', strip_header=True, append='a')", "getinfo -a a -", b'bytes'),
    ("getinfo(b'bytes', strip_header=True)", "getinfo -", b'bytes'),
    ("get_header('a.hdr')", "getinfo a.hdr"),
    ("get_header(P('a.hdr'), True)", "getinfo -d a.hdr"),
    ("get_header(b'bytes', dimension=True)", "getinfo -d", b'bytes'),
    ("gensky(D)", "gensky 2 1 12.5"),
    ("gensky(D, 37, 122, 120)", "gensky 2 1 12.5 -a 37 -o 122 -m 120"),
    ("gensky(D, 37.5, -122.25, -120, altitude=1, azimuth=2, year=2020, uniform=True)", "gensky 2 1 12.5 -a 37.5 -o -122.25 -m -120 -y 2020 -u"),
    ("gensky(altitude=30, azimuth=10, timezone=5, year=2020, intermediate_without_sun=True)", "gensky -ang 30 10 -i"),
    ("gensky(D, 37, 122, 120, year=2020, sunny_with_sun=True, sunny_without_sun=True, cloudy=True, intermediate_with_sun=True, intermediate_without_sun=True, "
     "uniform=True, ground_reflectance=.2, zenith_brightness=1, horizontal_brightness=2, solar_radiance=3, horizontal_direct_irradiance=4, turbidity=5)",
     "gensky 2 1 12.5 -a 37 -o 122 -m 120 -y 2020 +s -g 0.2 -b 1 -r 3 -t 5"),
    ("gensky(altitude=0, azimuth=0, cloudy=True, ground_reflectance=0, horizontal_brightness=0, horizontal_direct_irradiance=0, turbidity=0)",
     "gensky -ang 0 0 -c -g 0 -B 0 -R 0 -t 0"),
    ("gensky(D, sunny_without_sun=True, zenith_brightness=0, solar_radiance=0)", "gensky 2 1 12.5 -s -b 0 -r 0"),
    ("gensky(D, intermediate_with_sun=True)", "gensky 2 1 12.5 +i"),
    ("gendaylit(D, 37, 122, 120, dirnorm=800, diffhor=100)", "gendaylit 2 1 12.5125 -a 37 -o 122 -m 120 -W 800 100"),
    ("gendaylit(D, 37, 122, 120, year=2020, dirnorm=1, diffhor=2, dirhor=3, dirnorm_illum=4, diffhor_illum=5, solar=True, sky_only=True, silent=True, grefl=.3, "
     "interval=60)",
     "gendaylit 2 1 12.5125 -a 37 -o 122 -m 120 -y 2020 -W 1 2 -O 1 -s -w -g 0.3 -i 60"),
    ("gendaylit(altitude=30, azimuth=10, dirhor=3, diffhor=2, latitude=3, year=2020)", "gendaylit -ang 30 10 -G 3 2"),
    ("gendaylit(D, dirnorm_illum=3, diffhor_illum=2)", "gendaylit 2 1 12.5125 -L 3 2"),
    ("gendaylit(D, dirnorm=1)", "gendaylit 2 1 12.5125"),
    ("gendaylit(altitude=0, azimuth=0, dirnorm=0, diffhor=0, grefl=0, interval=0)", "gendaylit -ang 0 0 -W 0 0 -g 0 -i 0"),
    ("genbox('m', 'n', 1.5, 2, 3)", "genbox m n 1.5 2 3"),
    ("genbox('m', 'n', 1, 2, 3, inward=True, beveled=.1, rounded=.2, nsegs=4, smoothing=True, waveout=True)", "genbox m n 1 2 3 -i -b 0.1 -r 0.2 -n 4 -s -o"),
    ("genbox('m', 'n', 1, 2, 3, beveled=0, rounded=0, nsegs=0)", "genbox m n 1 2 3 -b 0 -r 0 -n 0"),
    ("genblinds('m', 'n', 1, 2, 3, 4, 5)", "genblinds m n 1 2 3 4 5"),
    ("genblinds('m', 'n', 1, 2, 3, 4, 5, .5)", "genblinds m n 1 2 3 4 5 +r 0.5"),
    ("genblinds('m', 'n', 1, 2, 3, 4, 5, -.5)", "genblinds m n 1 2 3 4 5 -r 0.5"),
    ("genblinds('m', 'n', 1, 2, 3, 4, 5, 0)", "genblinds m n 1 2 3 4 5"),
    ("genprism('m', 'n', [0, 0, .5, .866, 1, 0])", "genprism m n 3 0 0 0.5 0.866 1 0"),
    ("genprism('m', 'n', [0, 0, .5, .866, 1, 0], lvect=(0, 0, 2), radius=.1, no_connect=True, no_ends=True)",
     "genprism m n 3 0 0 0.5 0.866 1 0 -l 0 0 2 -r 0.1 -c -e"),
    ("genprism('m', 'n', vfile='-', stdin=b'0 0 1 0 1 1', radius=0)", "genprism m n - -r 0", b'0 0 1 0 1 1'),
    ("genprism('m', 'n', vfile='v')", "genprism m n v"),
    ("genrev('m', 'n', 'z', 'r', 5)", "genrev m n z r 5"),
    ("genrev('m', 'n', 'z', 'r', 5, 'a:1', 'f.cal', True)", "genrev m n z r 5 -e a:1 -f f.cal -s"),
    ("gensurf('m', 'n', 'x', 'y', 'z', 5, 6)", "gensurf m n x y z 5 6"),
    ("gensurf('m', 'n', 'x', 'y', '-', 5, 6, 'e', 'f', True, True, True, stdin=b'x')", "gensurf m n x y - 5 6 -e e -f f -i -s -o", b'x'),
    ("Xform('a.rad')()", "xform a.rad"),
    ("Xform(P('a.rad'), False, True, 'pre', 'mod').translate(1, 2.5, "
     "3).rotatex(90).rotatey(45.5).rotatez(1e-7).scale(2).mirrorx().mirrory().mirrorz().array(3).iterate(2)()",
     "xform -c -n pre -m mod -I -t 1 2.5 3 -rx 90 -ry 45.5 -rz 1e-07 -s 2 -mx -my -mz -a 3 -i 2 a.rad"),
    ("Xform(b'void', modifier='m').array(3).rotatez(30)()", "xform -m m -a 3 -rz 30", b'void'),
    ("evalglare('a.hdr')", "evalglare -Y 50000 a.hdr"),
    ("evalglare(b'bytes', peak_extraction=False, search_radius=.3)", "evalglare -x -r 0.3", b'bytes'),
    ("evalglare(P('a.hdr'), view=['-vth'], detailed=True, smooth=True, fast=1, ev=1, threshold=4, task_area=(1, 2, 3), masking_file='m', band_lum_angle=2, "
     "check_file='c', correction_mode='x', bg_lum_mode=1, source_color=(1, 2, 3), search_radius=.3)",
     "evalglare -d -i 1 -1 -vth -c c -u 1 2 3 -s -b 4 -T 1 2 3 -q 1 -A m -B 2 -C x -Y 50000 -r 0.3 a.hdr"),
    ("evalglare('a.hdr', ev=(1, 2), task_area=(1, 2, 3), source_color=(1, 0, 0), peak_extraction_value=0, fast=0, threshold=0, band_lum_angle=0)",
     "evalglare -I 1 2 -0 -b 0 -t 1 2 3 a.hdr"),
    ("evalglare('a.hdr', ev_only=True, detailed=True)", "evalglare -V a.hdr"),
    ("evalglare('a.hdr', version=True)", "evalglare -v"),
    ("pfilt('a.hdr')", "pfilt a.hdr"),
    ("pfilt(b'bytes', xres=10, yres='/2', pixel_aspect=1.5, pa_correct=True, exposure='+1', lamp='l', lampdat='d', one_pass=True, gaussian_filter_radius=7, "
     "limitfrac=8, hot_threshold=9, star_points=10, star_spread=11, average_hot=True)",
     "pfilt -x 10 -y /2 -p 1.5 -c -e +1 -t l -f d -1 -r 7 -m 8 -h 9 -n 10 -s 11 -a", b'bytes'),
    ("pfilt(P('a.hdr'), exposure=None, limitfrac=0, gaussian_filter_radius=0, hot_threshold=0)", "pfilt -h 0 a.hdr"),
    ("pvalue('a.hdr')", "pvalue a.hdr"),
    ("pvalue(b'bytes', unique=True, original=True, header=False, resstr=False, skip=1, exposure=-2, gamma=3, dataonly=True, outform='f', reverse_rgb=True, "
     "interleaving=False, brightness=True, outprimary='XYZ')",
     "pvalue -u -o -h -H -s 1 -e -2 -g 3 -d -df -R -n -b -pXYZ", b'bytes'),
    ("pvalue(P('a.hdr'), outform='d')", "pvalue -dd a.hdr"),
    ("falsecolor('a.hdr')", "falsecolor -i a.hdr"),
    ("falsecolor(b'bytes', pic_overlay='p', contour='l', extrema=True, scale='auto', digits=1, label='cd/m2', ndivs=2, lwidth=0, lheight=4, decades=5, "
     "multiplier=6, palette='pal', redv='r', grnv='g', bluv='b')",
     "falsecolor -p p -cl -e -s auto -d 1 -l cd/m2 -n 2 -lw 0 -lh 4 -log 5 -m 6 -pal pal -r r -g g -b b", b'bytes'),
]

# The signatures of pyradiance 1.3.1: names and defaults.
SIGNATURES = {
    "oconv": "*paths, warning=True, stdin=None, frozen=False, octree=None",
    "rpict": "view, octree, xres=None, yres=None, report=0, report_file=None, params=None",
    "rtrace":
        "rays, octree, header=True, inform='a', outform='a', irradiance=False, irradiance_lambertian=False, outspec=None, "
        "trace_exclude='', trace_include='', trace_exclude_file=None, trace_include_file=None, uncorrelated=False, xres=None, "
        "yres=None, nproc=None, params=None, report=False, version=False",
    "Rcontrib": "inp, octree, nproc=1, yres=None, inform=None, outform=None, report=0, params=None",
    "Rcontrib.add_modifier":
        "self, modifier=None, modifier_path=None, calfile=None, expression=None, nbins=None, binv=None, param=None, xres=None, "
        "yres=None, output=None",
    "render":
        "scene, view=None, quality='Medium', variability='Medium', detail='Medium', nproc=1, ncssamp=3, resolution=None, ambbounce=0, "
        "ambcache=True, params=None",
    "vwrays":
        "pixpos=None, unbuf=False, outform='a', ray_count=1, pixel_jitter=0, pixel_diameter=0, pixel_aspect=1, xres=512, yres=512, "
        "dimensions=False, view=None, pic=None, zbuf=None",
    "getinfo": "*inputs, dimension_only=False, dimension=False, strip_header=False, replace='', append='', command=''",
    "get_header": "inp, dimension=False",
    "get_image_dimensions": "image",
    "gensky":
        "dt=None, latitude=None, longitude=None, timezone=None, altitude=None, azimuth=None, year=None, sunny_with_sun=False, "
        "sunny_without_sun=False, cloudy=False, intermediate_with_sun=False, intermediate_without_sun=False, uniform=False, "
        "ground_reflectance=None, zenith_brightness=None, horizontal_brightness=None, solar_radiance=None, "
        "horizontal_direct_irradiance=None, turbidity=None",
    "gendaylit":
        "dt=None, latitude=None, longitude=None, timezone=None, altitude=None, azimuth=None, year=None, dirnorm=None, diffhor=None, "
        "dirhor=None, dirnorm_illum=None, diffhor_illum=None, solar=False, sky_only=False, silent=False, grefl=None, interval=None",
    "genbox": "mat, name, xsiz, ysiz, zsiz, inward=False, beveled=None, rounded=None, nsegs=None, smoothing=False, waveout=False",
    "genblinds": "mat, name, depth, width, height, nslats, angle, rcurv=None",
    "genprism": "mat, name, vertices=None, vfile=None, lvect=None, radius=None, no_connect=False, no_ends=False, stdin=None",
    "genrev": "mat, name, z_t, r_t, nseg, expr=None, file=None, smooth=False",
    "gensurf": "mat, name, x, y, z, m, n, expr=None, file=None, invert=False, smooth=False, waveout=False, stdin=None",
    "Xform": "inp, expand_cmd=True, invert=False, iprefix=None, modifier=None",
    "evalglare":
        "inp, view=None, detailed=False, ev_only=False, ev=None, smooth=False, threshold=None, task_area=None, masking_file=None, "
        "band_lum_angle=None, check_file=None, correction_mode=None, peak_extraction=True, peak_extraction_value=50000, bg_lum_mode=0, "
        "search_radius=0.2, version=False, source_color=None, fast=None",
    "pfilt":
        "image, xres=None, yres=None, pixel_aspect=0, pa_correct=False, exposure=0, lamp=None, lampdat=None, one_pass=False, "
        "gaussian_filter_radius=None, limitfrac=None, hot_threshold=100, star_points=0, star_spread=0.0001, average_hot=False",
    "pvalue":
        "pic, unique=False, original=False, header=True, resstr=True, skip=0, exposure=0, gamma=1.0, dataonly=False, outform='', "
        "reverse_rgb=False, interleaving=True, brightness=False, outprimary=None",
    "falsecolor":
        "inp, pic_overlay=None, contour=None, extrema=False, scale=None, digits=None, label=None, ndivs=None, lwidth=None, "
        "lheight=None, decades=None, multiplier=None, palette=None, redv=None, grnv=None, bluv=None",
    "Primitive": "modifier, ptype, identifier, sargs, fargs",
    "Scene": "sid, **kwargs",
    "parse_primitive": "pstr",
    "write": "file_path, data, overwrite=True, mode='wb'",
}
