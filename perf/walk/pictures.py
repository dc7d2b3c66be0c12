"""Pictures as arrays, and how far two of them are apart. Rows run from the top, as in the files."""
import pathlib, struct, zlib

import numpy

#: Luminance of Radiance's red, green and blue, as a share.
WEIGHTS = numpy.array([0.265, 0.670, 0.065])
#: A pixel is off when its luminance differs from the true one by more than this share of it.
OFF = 0.1
#: A pixel shows another thing than it should when its distance differs by more than this share.
OTHER_DEPTH = 0.05


def read_hdr(path):
    """Radiance [W/(m2 sr)] of a .hdr picture, height x width x 3."""
    data = pathlib.Path(path).read_bytes()
    at = data.index(b"\n\n") + 2
    end = data.index(b"\n", at)
    words = data[at:end].split()
    height, width = int(words[1]), int(words[3])
    at = end + 1
    rgbe = numpy.empty((height, 4, width), numpy.uint8)
    for y in range(height):
        if data[at:at + 2] != b"\2\2":  # not run-length encoded
            rgbe[y] = numpy.frombuffer(data, numpy.uint8, 4 * width, at).reshape(width, 4).T
            at += 4 * width
            continue
        at += 4
        for channel in range(4):
            at = decode_runs(data, at, rgbe[y, channel])
    exponent = rgbe[:, 3].astype(numpy.int32)
    scale = numpy.where(exponent > 0, numpy.ldexp(1.0, exponent - 136), 0)
    return ((rgbe[:, :3] + 0.5) * scale[:, None]).transpose(0, 2, 1)


def decode_runs(data, at, row):
    """Fill one channel of a row from its runs, which begin at byte `at`. Returns where they end."""
    x = 0
    while x < len(row):
        count = data[at]
        if count > 128:
            row[x:x + count - 128] = data[at + 1]
            x, at = x + count - 128, at + 2
        else:
            row[x:x + count] = numpy.frombuffer(data, numpy.uint8, count, at + 1)
            x, at = x + count, at + 1 + count
    return at


def header_of(path):
    """The lines before a .hdr picture's pixels."""
    with open(path, "rb") as file:
        return file.read(1 << 16).split(b"\n\n")[0].decode(errors="replace").split("\n")


def view_of(path):
    """The view of a .hdr picture, as options: the last line that begins with VIEW=."""
    return [line for line in header_of(path) if line.startswith("VIEW=")][-1].split(maxsplit=1)[1]


def read_depths(path, shape):
    """Distances along the pixels' rays [m], height x width."""
    return numpy.fromfile(path, numpy.float32).reshape(shape)


def luminance(picture):
    """[W/(m2 sr)], height x width."""
    return picture @ WEIGHTS


def exposure(truth):
    """A factor that brings the middle luminance (geometric mean) of a picture to middle grey; 1 for a black one."""
    positive = luminance(truth)
    positive = positive[positive > 0]
    return 0.18 / float(numpy.exp(numpy.mean(numpy.log(positive)))) if positive.size else 1.0


def shown(picture, scale):
    """Tone-mapped values from 0 to 1: Reinhard's curve and a gamma."""
    exposed = picture * scale
    return (exposed / (1 + exposed)) ** (1 / 2.2)


def off(is_, should):
    """Which pixels' luminance is off by more than a tenth: height x width of bool."""
    return numpy.abs(is_ - should) > OFF * should


def half_pixel_range(should, moved):
    """Least and most luminance that a pixel has when its ray moves by up to half a pixel.

    should, moved: luminance of the true picture, and of the one whose rays all lie half a pixel to the right and half a
    pixel up. The moved picture's pixels lie at the corners of the true one's: a pixel has four of them around it, of
    which those outside of the picture are left out.
    """
    below = numpy.vstack([moved[1:], moved[-1:]])
    corners = [moved, numpy.hstack([moved[:, :1], moved[:, :-1]]),
               below, numpy.hstack([below[:, :1], below[:, :-1]])]
    return numpy.minimum.reduce([should, *corners]), numpy.maximum.reduce([should, *corners])


def beyond(is_, should, moved):
    """Which pixels are off by more than a tenth from anything that a ray moved by half a pixel would have found.

    In grainy surfaces most pixels of two equally good pictures are "off" from each other; this says which are wrong.
    """
    least, most = half_pixel_range(should, moved)
    return (is_ < (1 - OFF) * least) | (is_ > (1 + OFF) * most)


def neighbour_range(should):
    """Least and most luminance of a pixel and the eight around it, in the true picture."""
    height, width = should.shape
    padded = numpy.pad(should, 1, mode="edge")
    around = [padded[y:y + height, x:x + width] for y in range(3) for x in range(3)]
    return numpy.minimum.reduce(around), numpy.maximum.reduce(around)


def error_image(is_, should):
    """Errors as colours from 0 to 1, height x width x 3: red, full at a quarter of the true luminance; white where the
    pixel is off by more than a tenth from all true ones around it, too. Grain is red: there neighbours differ by as
    much. What is left behind, shows through or trails is white."""
    error = numpy.abs(is_ - should) / numpy.maximum(should, 1e-9)
    least, most = neighbour_range(should)
    wrong = (is_ < (1 - OFF) * least) | (is_ > (1 + OFF) * most)
    red = 0.7 * numpy.minimum(4 * error, 1)
    return numpy.where(wrong[..., None], 1.0, numpy.stack([red, 0 * red, 0 * red], axis=2))


def square(picture, truth, scale):
    """Squared difference of the pixels as shown, mean of the channels: height x width."""
    return numpy.mean((shown(picture, scale) - shown(truth, scale)) ** 2, axis=2)


def psnr(mean_square):
    """Peak signal-to-noise ratio [dB] of values from 0 to 1; 120 for equal ones."""
    return -10 * float(numpy.log10(max(mean_square, 1e-12)))


def other_depth(is_, should):
    """Which pixels show something that lies elsewhere than what their ray meets: height x width of bool."""
    return numpy.abs(is_ - should) > OTHER_DEPTH * should


def write_png(path, pixels):
    """8-bit r, g, b: an array height x width x 3."""
    height, width, _ = pixels.shape
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    pathlib.Path(path).write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) +
                                   chunk(b"IDAT", zlib.compress(rows, 6)) + chunk(b"IEND", b""))
