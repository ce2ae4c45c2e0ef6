#!/usr/bin/env python3
"""Computes the star discrepancy of points: python3 check_star.py POINTS.csv ..., one line with the value for each file.

It shares nothing with the software, and follows the definition. The discrepancy is the largest of `xy - open / n` and `closed / n - xy`, over all boxes from the
origin to (x, y), where `open` counts the points inside the box, and `closed` also the points on its upper faces. It is enough to take each x and
each y from the coordinates of the points and 1. A point enters the counts of all y above it, so the counts are kept for each y while x grows.
In the plane, all numbers are exact until the end. In more dimensions, y stands for the other coordinates, and numpy keeps an array of counts with a place for
each choice of them: n points in d dimensions take (n + 1)^(d - 1) places.
"""

import csv
import sys
from bisect import bisect_left, bisect_right
from fractions import Fraction

def star_in_the_plane(points):
    n = len(points)
    exact = [tuple(map(Fraction, point)) for point in points]
    # The denominators are powers of two, so the largest one serves all coordinates.
    scale = max(c.denominator for point in exact for c in point)
    whole = [tuple(int(c * scale) for c in point) for point in exact]
    xs = sorted({x for x, _ in whole} | {scale})
    ys = sorted({y for _, y in whole} | {scale})
    by_x = {}
    for x, y in whole:
        by_x.setdefault(x, []).append(y)
    # For each y, the number of points with a smaller x that are below y, or not above y.
    below, not_above = [0] * len(ys), [0] * len(ys)
    worst = 0
    for x in xs:
        # All boxes of this x that are open to the right hold the points before x.
        worst = max(worst, max(n * x * y - count * scale * scale for y, count in zip(ys, below)))
        for y in by_x.get(x, ()):
            for j in range(bisect_left(ys, y), len(ys)):
                not_above[j] += 1
            for j in range(bisect_right(ys, y), len(ys)):
                below[j] += 1
        worst = max(worst, max(count * scale * scale - n * x * y for y, count in zip(ys, not_above)))
    return Fraction(worst, n * scale * scale)


def star_in_space(points):
    import numpy as np

    n, others = len(points), range(1, len(points[0]))
    ends = [sorted({point[axis] for point in points} | {1.0}) for axis in others]
    volumes = np.ones([])
    for at in ends:
        volumes = volumes[..., np.newaxis] * np.array(at)
    # For each choice of the other coordinates: the points with a smaller x that are inside the open box, or the closed one.
    below, not_above = np.zeros_like(volumes), np.zeros_like(volumes)
    by_x = {}
    for x, *rest in points:
        by_x.setdefault(x, []).append(rest)
    worst, beside = 0.0, np.empty_like(volumes)
    for x in sorted({*by_x, 1.0}):
        np.multiply(volumes, x, out=beside)
        beside -= below / n
        worst = max(worst, beside.max())
        for rest in by_x.get(x, ()):
            not_above[tuple(slice(bisect_left(at, y), None) for at, y in zip(ends, rest))] += 1
            below[tuple(slice(bisect_right(at, y), None) for at, y in zip(ends, rest))] += 1
        np.multiply(volumes, -x, out=beside)
        beside += not_above / n
        worst = max(worst, beside.max())
    return worst


for name in sys.argv[1:]:
    with open(name, newline="", encoding="utf-8") as file:
        header, *rows = csv.reader(file)
    points = [tuple(map(float, row)) for row in rows]
    dims = len(header)
    assert dims > 1 and points and all(0.0 <= c <= 1.0 for point in points for c in point), name
    print(repr(float(star_in_the_plane(points) if dims == 2 else star_in_space(points))))
