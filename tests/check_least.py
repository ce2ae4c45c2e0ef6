#!/usr/bin/env python3
"""Checks a table of least dispersions that `paracosm-cover least --certificate FILE` wrote: python3 check_least.py FILE

It shares nothing with the software that wrote the file. A row says: these n points have this dispersion, and no n points have a
dispersion below the level. The dispersion is the volume of the largest open box inside the unit cube that holds no point.

Why a proof proves. Suppose that n points have a dispersion below the level. Number the points along the first axis. Along each
other axis, they are in some order. A box between two coordinates (or ends of the cube) along each axis holds certain points, m of
them at most. Among m points in a box of volume v, there is an empty box of at least v times the least dispersion of m points. So v
is below the level over the level of row m (1 for m = 0). If the lengths of the box along the other axes have lower bounds, the length
along this axis has an upper bound. Differences of coordinates along an axis have bounds that follow from each other: the bound from
a to c is at most the sum of the bounds from a to b and from b to c. If a coordinate must be below itself, the points do not exist.

The steps are: `+`, the next point takes each of its places in the orders so far, where the second point lies above the first along each axis
(else mirror the cube); `axis,from,to,at;`, a difference is at most `at` or at least `at`; `x`, no points exist. Whether no points exist is
computed here. All bounds are whole numbers of 2^-40, rounded upward.
"""

import json
import re
import sys
from fractions import Fraction
from itertools import product

UNIT = 1 << 40
TOKEN = re.compile(r"x|\+|(\d+),(\d+),(\d+),(\d+);")
ROUNDS = 400


def refuse(message):
    sys.exit(f"refused: {message}")


class Contradiction(Exception):
    pass


class Axis:
    """The bounds along an axis: most[a][b] bounds the coordinate of b less that of a."""

    def __init__(self, most):
        self.most = most

    @classmethod
    def of_cube(cls, nodes):
        most = [[UNIT] * nodes for _ in range(nodes)]
        for node in range(nodes):
            most[node][node] = most[node][0] = most[-1][node] = 0
        most[-1][0] = -UNIT
        return cls(most)

    def copy(self):
        return Axis([row[:] for row in self.most])

    def demand(self, a, b, bound):
        most = self.most
        if bound >= most[a][b]:
            return
        if most[b][a] + bound < 0:
            raise Contradiction
        after = most[b][:]
        for row in most:
            via = row[a] + bound
            for end, rest in enumerate(after):
                if via + rest < row[end]:
                    row[end] = via + rest


def gaps_of(n, orders):
    """The boxes that cannot grow without another point: their ends along each axis, and the most points inside."""
    axes = []
    for axis, order in enumerate(orders):
        nodes = [0, *order, n + 1]
        # Points without a place may be anywhere.
        anywhere = 0 if axis == 0 else sum(1 << point for point in range(1, n + 1) if point not in order)
        inside = {}
        for low in range(len(nodes)):
            points = anywhere
            for high in range(low + 1, len(nodes)):
                inside[low, high] = points
                points |= 1 << nodes[high]
        spans = []
        for (low, high), points in inside.items():
            wider = [inside[end] for end in ((low - 1, high), (low, high + 1)) if end in inside]
            spans.append((nodes[low], nodes[high], points, wider))
        axes.append(spans)
    gaps = []

    def choose(spans, held):
        """Takes a span of each further axis. A box that can grow along an axis can also grow if it is cut along others."""
        if len(spans) == len(axes):
            gaps.append(([span[:2] for span in spans], bin(held).count("1")))
            return
        for span in axes[len(spans)]:
            longer, inside = [*spans, span], held & span[2]
            if not any(wider & others(longer, axis) == inside for axis, of in enumerate(longer) for wider in of[3]):
                choose(longer, inside)

    choose([], -1)
    return gaps


def others(spans, axis):
    """The points inside the spans along all axes but one."""
    inside = -1
    for other, span in enumerate(spans):
        if other != axis:
            inside &= span[2]
    return inside


class Proof:
    def __init__(self, n, dims, level, levels, steps):
        self.n, self.dims = n, dims
        self.volumes = [-(-UNIT * Fraction(level) // Fraction(known)) for known in levels] + [UNIT]
        self.steps, self.at = steps, 0

    def step(self):
        found = TOKEN.match(self.steps, self.at)
        if not found:
            refuse(f"the steps for {self.n} points are wrong at character {self.at}")
        self.at = found.end()
        return found

    def narrow(self, gaps, axes):
        """Bounds lengths by volumes, for as long as bounds fall by much. Raises an error if no points exist."""
        for _ in range(ROUNDS):
            falls = False
            for ends, held in gaps:
                least = [-axis.most[high][low] for axis, (low, high) in zip(axes, ends)]
                for at, (axis, (low, high)) in enumerate(zip(axes, ends)):
                    bound = self.volumes[held]
                    for other, length in enumerate(least):
                        if other != at:
                            if length <= 0:
                                break
                            bound = -(-bound * UNIT // length)
                    else:
                        before = axis.most[low][high]
                        if bound < before:
                            axis.demand(low, high, bound)
                            falls |= (before - bound) << 14 > before
                            least[at] = -axis.most[high][low]
            if not falls:
                return

    def closed(self, gaps, axes, demands=()):
        """The bounds with more demands, narrowed; None if no points exist."""
        if axes is None:
            return None
        axes = [axis.copy() for axis in axes]
        try:
            for axis, a, b, bound in demands:
                axes[axis].demand(a, b, bound)
            self.narrow(gaps, axes)
        except Contradiction:
            return None
        return axes

    def follow(self, orders, axes, demands=()):
        gaps = gaps_of(self.n, orders)
        axes = self.closed(gaps, axes, demands)
        self.go_on(orders, gaps, axes)

    def go_on(self, orders, gaps, axes):
        step = self.step()
        if step[0] == "x":
            if axes is not None:
                refuse(f"{self.n} points: the steps before character {self.at} do not rule out all points")
            return
        # The steps may go on although no points exist.
        if step[0] == "+":
            self.next_point(orders, axes)
            return
        axis, a, b, at = map(int, step.groups())
        if len(orders[-1]) < self.n and self.dims > 1 or axis >= self.dims or max(a, b) > self.n + 1:
            refuse(f"{self.n} points: a wrong cut before character {self.at}")
        for demand in ((axis, a, b, at), (axis, b, a, -at)):
            self.go_on(orders, gaps, self.closed(gaps, axes, [demand]))

    def next_point(self, orders, axes):
        point = len(orders[-1]) + 1 if self.dims > 1 else self.n + 1
        if point > self.n:
            refuse(f"{self.n} points: all have their places before character {self.at}")
        first = 1 if point == 2 else 0
        for places in product(range(first, point), repeat=self.dims - 1):
            new, demands = [orders[0]], []
            for axis, place in enumerate(places, 1):
                order = orders[axis]
                new.append(order[:place] + [point] + order[place:])
                before = order[place - 1] if place else 0
                after = order[place] if place < len(order) else self.n + 1
                demands += [(axis, point, before, 0), (axis, after, point, 0)]
            self.follow(new, axes, demands)


def largest_empty_box(points, dims):
    """The volume of the largest empty box, from all boxes between coordinates."""
    sides = []
    for axis in range(dims):
        at = sorted({0.0, 1.0, *(point[axis] for point in points)})
        sides.append([(low, high) for i, low in enumerate(at) for high in at[i + 1 :]])
    largest = 0.0
    for box in product(*sides):
        volume = 1.0
        for low, high in box:
            volume *= high - low
        if volume > largest:
            inside = (all(low < x < high for x, (low, high) in zip(point, box)) for point in points)
            if not any(inside):
                largest = volume
    return largest


def main(path):
    with open(path, encoding="utf-8") as file:
        table = json.load(file)
    dims, levels = table["dims"], [1.0]
    if not (type(dims) is int and dims > 0 and table["rows"]):
        refuse("a table has at least one dimension and one row")
    if table["measure"] != "least-dispersion" or table["format"] != 1:
        refuse("this script knows tables of the measure least-dispersion in the format 1")
    for n, row in enumerate(table["rows"], 1):
        points, level = row["points"], row["level"]
        if len(points) != n or not all(len(point) == dims and all(0 <= x <= 1 for x in point) for point in points):
            refuse(f"row {n} does not have {n} points in the unit cube of {dims} dimensions")
        largest = largest_empty_box(points, dims)
        if not abs(largest - row["dispersion"]) <= 1e-12 * largest:
            refuse(f"row {n}: the largest empty box between the points has the volume {largest}, not {row['dispersion']}")
        if not 0 < level <= row["dispersion"]:
            refuse(f"row {n}: the level {level} is not between 0 and the dispersion {row['dispersion']}")
        if row["steps"] or Fraction(level) * (n + 1) > 1:
            proof = Proof(n, dims, level, levels, row["steps"])
            orders = [list(range(1, n + 1))] + [[] for _ in range(dims - 1)]
            axes = [Axis.of_cube(n + 2) for _ in range(dims)]
            for point in range(1, n):
                axes[0].demand(point + 1, point, 0)
            proof.follow(orders, axes)
            if proof.at != len(row["steps"]):
                refuse(f"row {n}: the steps go on after the proof")
        levels.append(level)
        print(f"{n} points in {dims} dimensions: no dispersion below {level}: proved; {row['dispersion']}: reached")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        refuse("expected the path of a table")
    sys.setrecursionlimit(100_000)
    main(sys.argv[1])
