"""Plots of lines and bars as small SVG files, with the standard library alone."""
import math
from xml.sax.saxutils import escape

COLOURS = ["#1b6ca8", "#d1495b", "#3a7d44", "#edae49", "#6a4c93", "#00798c", "#8d6a4f", "#555555"]
WIDTH, HEIGHT = 730, 400
LEFT, RIGHT, TOP, BOTTOM = 64, 260, 36, 48


class Axis:
    """An axis: the map from values to positions. `log`: base of a logarithmic axis (2 or 10); else linear from `low`."""

    def __init__(self, values, begin, end, log=0, low=None, high=None):
        self.log, self.begin, self.end = log, begin, end
        values = [v for v in values if v is not None and (not log or v > 0)] or [1]
        self.low = min(values) if low is None else low
        self.high = max(values) if high is None else high
        if log:
            self.low, self.high = self.scaled(self.low), self.scaled(self.high)
        if self.high <= self.low:
            self.high = self.low + 1

    def scaled(self, value):
        return math.log(value, self.log) if self.log else value

    def place(self, value):
        share = (self.scaled(value) - self.low) / (self.high - self.low)
        return self.begin + share * (self.end - self.begin)

    def ticks(self):
        if self.log:
            first, last = math.ceil(self.low - 1e-9), math.floor(self.high + 1e-9)
            step = max(1, (last - first) // 8 + 1)
            return [self.log**k for k in range(first, last + 1, step)]
        step = 10 ** math.floor(math.log10((self.high - self.low) / 2))
        for factor in (1, 2, 5, 10):
            if (self.high - self.low) / (step * factor) <= 6:
                step *= factor
                break
        first = math.ceil(self.low / step - 1e-9)
        return [k * step for k in range(first, math.floor(self.high / step + 1e-9) + 1)]


def number(value):
    return f"{value:.10g}" if abs(value) >= 1e-4 or value == 0 else f"{value:.1e}"


def text(x, y, words, anchor="middle", extra=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" {extra}>{escape(words)}</text>'


def frame(title, x_label, y_label, x_axis, y_axis):
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" '
           'font-size="12" fill="#222">', f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
           text(LEFT, 22, title, "start", 'font-size="15"')]
    for value in y_axis.ticks():
        y = y_axis.place(value)
        out.append(f'<path d="M{LEFT} {y:.1f}H{WIDTH - RIGHT}" stroke="#ddd"/>')
        out.append(text(LEFT - 6, y + 4, number(value), "end"))
    for value in x_axis.ticks() if x_axis else []:
        x = x_axis.place(value)
        out.append(f'<path d="M{x:.1f} {TOP}V{HEIGHT - BOTTOM}" stroke="#eee"/>')
        out.append(text(x, HEIGHT - BOTTOM + 16, number(value)))
    out.append(text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 12, x_label))
    middle = (TOP + HEIGHT - BOTTOM) / 2
    out.append(text(16, middle, y_label, extra=f'transform="rotate(-90 16 {middle:.1f})"'))
    return out


def legend(names):
    out = []
    for k, name in enumerate(names):
        y = TOP + 8 + 18 * k
        out.append(f'<rect x="{WIDTH - RIGHT + 12}" y="{y - 8}" width="14" height="8" '
                   f'fill="{COLOURS[k % len(COLOURS)]}"/>')
        out.append(text(WIDTH - RIGHT + 32, y, name, "start"))
    return out


def write_lines(path, title, x_label, y_label, series, x_log=2, y_log=0, y_low=None, y_high=None, points=()):
    """`series`: {name: [(x, y), ...]}, joined by lines; names in `points` are drawn as dots alone."""
    xs = [x for line in series.values() for x, _ in line]
    ys = [y for line in series.values() for _, y in line]
    x_axis = Axis(xs, LEFT, WIDTH - RIGHT, x_log)
    y_axis = Axis(ys, HEIGHT - BOTTOM, TOP, y_log, y_low if y_low is not None or y_log else 0, y_high)
    out = frame(title, x_label, y_label, x_axis, y_axis)
    for k, (name, line) in enumerate(series.items()):
        colour = COLOURS[k % len(COLOURS)]
        places = [(x_axis.place(x), y_axis.place(y)) for x, y in sorted(line)]
        if name not in points:
            way = "L".join(f"{x:.1f} {y:.1f}" for x, y in places)
            out.append(f'<path d="M{way}" fill="none" stroke="{colour}" stroke-width="2"/>')
        out += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour}"/>' for x, y in places]
    path.write_text("\n".join([*out, *legend(series), "</svg>\n"]))


def write_bars(path, title, y_label, groups, series):
    """`series`: {name: [height or None for each group]}."""
    heights = [h for bars in series.values() for h in bars if h is not None]
    y_axis = Axis(heights, HEIGHT - BOTTOM, TOP, low=0)
    out = frame(title, "", y_label, None, y_axis)
    room = (WIDTH - RIGHT - LEFT) / max(1, len(groups))
    width = 0.8 * room / max(1, len(series))
    for g, group in enumerate(groups):
        left = LEFT + g * room + 0.1 * room
        out.append(text(left + 0.4 * room, HEIGHT - BOTTOM + 16, group))
        for k, bars in enumerate(series.values()):
            if bars[g] is None:
                continue
            y = y_axis.place(bars[g])
            out.append(f'<rect x="{left + k * width:.1f}" y="{y:.1f}" width="{width:.1f}" '
                       f'height="{HEIGHT - BOTTOM - y:.1f}" fill="{COLOURS[k % len(COLOURS)]}"/>')
    path.write_text("\n".join([*out, *legend(series), "</svg>\n"]))
