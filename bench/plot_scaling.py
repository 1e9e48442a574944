#!/usr/bin/env python3
"""Plots Mray/s over the number of triangles from the output of `bench_vs_embree --scaling`.

usage: plot_scaling.py bench_vs_embree.json scaling.svg
"""
import json
import math
import sys

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 720, 420, 60, 150, 20, 50
COLORS = {"primary": "#1b6ca8", "bounce": "#b3541e", "occlusion": "#3c7d3e"}


def read(path):
    """Returns {kind: [(triangles, microtrace's Mray/s, Embree's Mray/s)]}, sorted by triangles."""
    with open(path) as file:
        rows = json.load(file)
    triangles = {row["scene"]: row["triangles"] for row in rows if row["kind"] == "build"}
    curves = {kind: [] for kind in COLORS}
    for row in rows:
        if row["kind"] in curves:
            point = (triangles[row["scene"]], row["mrays_microtrace"], row["mrays_embree_fast"])
            curves[row["kind"]].append(point)
    return {kind: sorted(points) for kind, points in curves.items()}


def scale(values, low, high):
    """Returns a logarithmic axis that extends slightly beyond the values: its function from values to
    coordinates, and the logarithms of its ends."""
    first, last = math.log10(min(values) / 1.15), math.log10(max(values) * 1.15)
    return lambda v: low + (math.log10(v) - first) / (last - first) * (high - low), first, last


def ticks(first, last, steps):
    for power in range(math.floor(first), math.ceil(last) + 1):
        for step in steps:
            value = step * 10.0**power
            if first <= math.log10(value) <= last:
                yield value


def text(x, y, words, anchor="middle", color="#333"):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{color}">{words}</text>'


def line(points, color, dash=""):
    path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    return f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="2"{dash}/>'


def axes(counts, values, unit, steps):
    """Returns the functions from numbers of triangles and from values to coordinates, and the lines of
    an SVG picture up to the axes. `steps` are the labeled multiples of powers of ten."""
    x, x_first, x_last = scale(counts, LEFT, WIDTH - RIGHT)
    y, y_first, y_last = scale(values, HEIGHT - BOTTOM, TOP)
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
        'font-family="sans-serif" font-size="13">',
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
    ]
    for value in ticks(y_first, y_last, steps):
        out.append(line([(LEFT, y(value)), (WIDTH - RIGHT, y(value))], "#ddd"))
        out.append(text(LEFT - 6, y(value) + 4, f"{value:g}", "end"))
    for value in ticks(x_first, x_last, (1,)):
        out.append(line([(x(value), TOP), (x(value), HEIGHT - BOTTOM)], "#ddd"))
        out.append(text(x(value), HEIGHT - BOTTOM + 18, f"10^{math.log10(value):.0f}"))
    out.append(text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 10, "triangles"))
    out.append(text(LEFT - 6, TOP - 6, unit, "end"))
    return x, y, out


def draw(curves):
    every = [point for points in curves.values() for point in points]
    counts = [n for n, _, _ in every]
    x, y, out = axes(counts, [v for _, a, b in every for v in (a, b)], "Mray/s", (1, 2, 5))
    for kind, points in curves.items():
        color = COLORS[kind]
        out.append(line([(x(n), y(ours)) for n, ours, _ in points], color))
        embree = [(x(n), y(theirs)) for n, _, theirs in points]
        out.append(line(embree, color, ' stroke-dasharray="5 4"'))
        out.append(text(WIDTH - RIGHT + 8, y(points[-1][1]) + 4, kind, "start", color))
    out.append(text(WIDTH - RIGHT + 8, TOP + 10, "solid: microtrace", "start"))
    out.append(text(WIDTH - RIGHT + 8, TOP + 28, "dashed: Embree fast", "start"))
    return "\n".join(out + ["</svg>", ""])


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with open(sys.argv[2], "w") as svg:
        svg.write(draw(read(sys.argv[1])))
