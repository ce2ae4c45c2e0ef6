#!/usr/bin/env python3
"""Checks a certificate that `paracosm-cover estimate --certificate FILE` wrote: python3 check_certificate.py FILE

It shares nothing with the software that wrote the file. Each claim is about boxes in the unit cube of continuous
parameters, in every projection: a choice of parameters, with values of the discrete ones among them, which select tests.
A box is empty if no selected test is strictly inside it.

Why a proof proves. To show: every empty box has at most the volume `upper`. Take a box R and an empty box B inside
it, R the unit cube at first. If R is no larger than `upper`, so is B. Else the proof names a selected test p inside R.
It is not inside B, so along some axis B ends at p or before it, or begins at p or after it: B lies in what is left of R
when one of its ends moves to p. Take the first such cut in the order below; at the ends of the cuts before it B reaches
beyond p, which is noted (`begins_below`, `ends_above`) and rules out later cuts that contradict it. So B lies in one of the
boxes that are looked at next.

Floating-point numbers suffice: volumes of boxes in d dimensions are computed with an error of at most a share of
(2 d + 5) / 2^53, and boxes that count as small enough are smaller than `upper` by a share of 1e-12, more than that up
to d = 1000. (No product underflows: an empty box of the largest volume, which some leaf contains, has at least 1 / (n + 1).)

The valid part. If constraints name continuous parameters, a box counts for its share of the valid part of the projection:
of the places where some test keeps all constraints, whatever values its other parameters have. The value of a parameter
at the coordinate u is lo + u (hi - lo), computed with floats as the software does. The valid part V comes as a tree of
cells, each cut in the middle. This script believes no cell. It reads the constraints and computes them with intervals,
which are rounded outward. A cell is invalid if each row of discrete values breaks a constraint at all its places, for all
values of the other parameters. A cell is valid if one row keeps all constraints at all its places, with the other
parameters at one place. (Places where two parameters are equal that must not be have no volume, and are passed over.)
So for a box B, volume(B and V) is at most p(B), the volume of its cells that are not invalid, and at least c(B), that of
its valid cells. Its share is at most p(B) / c(cube). This never grows when the box shrinks, so that the proof above holds
with p in the place of the volume and `upper` c(cube) in the place of `upper`; the sums over n cells add a share of
4 (n + 2 d + 2) / 2^53 to the error, and as much to the margin. The share is at least c(B) / (p(cube) - p(B) + c(B)),
because undecided places inside B that are valid would add to B as much as to V. That is the lower bound, without floats.
"""

import ast
import json
import re
import sys
from fractions import Fraction
from functools import lru_cache
from itertools import combinations, product
from math import acos, asin, atan, ceil, comb, copysign, cos, floor, fmod, inf, isfinite, nextafter, prod, sin, sqrt
from operator import lt, sub

MARGIN = 1e-12
MOST_PROJECTIONS = 1_000_000
MOST_STEPS = 200_000  # of the search for rows of discrete values that keep the constraints
MOST_NESTED = 10_000  # of calls, some three for each cell in a cell
MOST_KNOWN = 500_000  # weights that are kept in memory
COARSE = (2**-3, 2**-6, 2**-9, 2**-12)  # the least sizes of cells for bounds on weights
CLOSE = 1e-9  # weights that differ by this share are not told apart by bounds
LEAST_WEIGHT = 1e-200  # below, products may underflow
SLACK = 5e-15  # a bound on the relative error of the functions of the module math


def check(holds, message):
    if not holds:
        sys.exit(f"refused: {message() if callable(message) else message}")


# The form of a certificate: a test of a value, a list with the form of its items, or a dict with the forms of its entries.
# The names of tests stand in messages.
def a_number(value):
    return type(value) in (int, float) and abs(value) < 1e300 and isfinite(value)


def an_index(value):
    return type(value) is int and 0 <= value < 2**53


def a_text(value):
    return type(value) is str


def a_text_or_null(value):
    return value is None or a_text(value)


def anything(_):
    return True


def a_cell(value):
    is_pair = type(value) is list and len(value) == 2 and an_index(value[0]) and an_index(value[1])
    return is_pair or an_index(value) or value in ("invalid", "undecided")


LEVELS = [[an_index]]
WITNESS = {"fixed": LEVELS, "axes": [an_index], "lower": [a_number], "upper": [a_number]}
PROOF = {"fixed": LEVELS, "axes": [an_index], "pivots": [an_index]}
CLAIM = {"measure": a_text, "lower": a_number, "upper": a_number, "note": a_text_or_null, "proofs": [PROOF]}
PART = {"axes": [an_index], "along": [an_index], "discrete": [an_index], "rows": [[an_index]], "cells": [a_cell]}
PART.update({"beside": [an_index], "places": [[a_number]]})
CERTIFICATE = {
    "format": an_index,
    "continuous": [{"name": a_text, "interval": [a_number]}],
    "discrete": [{"name": a_text, "values": [anything]}],
    "coordinates": [[a_number]],
    "levels": [[an_index]],
    "constraints": [a_text],
    "claims": [CLAIM],
}


def check_form(value, form, where):
    """Checks that a value has a form. Entries of a dict that the form does not name are ignored."""
    if isinstance(form, list):
        check(isinstance(value, list), lambda: f"{where} is {shown(value)}, expected a list")
        for i, item in enumerate(value):
            check_form(item, form[0], f"{where}[{i}]")
    elif isinstance(form, dict):
        check(isinstance(value, dict), lambda: f"{where} is {shown(value)}, expected an object")
        for name, entry in form.items():
            check(name in value, lambda: f"{where} has no entry `{name}`")
            check_form(value[name], entry, f"{where}.{name}")
    else:
        check(form(value), lambda: f"{where} is {shown(value)}, expected {form.__name__.replace('_', ' ')}")


def check_claim_form(claim, where):
    """Checks the entries that only some claims have."""
    check("witness" in claim, f"{where} has no entry `witness`")
    if claim["witness"] is not None:
        check_form(claim["witness"], WITNESS, f"{where}.witness")
        ends = [len(claim["witness"][end]) for end in ("axes", "lower", "upper")]
        check(len(set(ends)) == 1, f"{where}.witness has {ends[0]} axes, {ends[1]} lower and {ends[2]} upper ends")
    if claim["measure"] == "k-wise-dispersion":
        check_form(claim, {"k": an_index, "excluded": [LEVELS]}, where)
    if claim["measure"] == "hole-of-row":
        check_form(claim, {"row": [an_index]}, where)
    for of in (claim, claim["witness"] or {}, *claim["proofs"]):
        positions = [of.get(name) for name in ("like", "part")]
        check(all(at is None or an_index(at) for at in positions), f"{where} has a part or claim that is no index")
    pairs = [pair for of in (claim["witness"] or {}, *claim["proofs"]) for pair in of.get("fixed", [])]
    pairs += [pair for fixed in claim.get("excluded") or [] for pair in fixed]
    check(all(len(pair) == 2 for pair in pairs), f"{where} has a fixed level that is no pair of a parameter and a level")


def shown(value):
    """A value in a message."""
    text = json.dumps(value)
    return text if len(text) <= 40 else f"{text[:40]}..."


def read(path):
    """The contents of a JSON file."""
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except OSError as error:
        return check(False, f"{path} cannot be read: {error.strerror}")
    except UnicodeDecodeError:
        return check(False, f"{path} is not UTF-8")
    except RecursionError:
        return check(False, f"{path} is nested too deeply")
    except ValueError as error:
        return check(False, f"{path} is not JSON: {error}")


# Constraints. The text becomes an expression of Python. With spans (lo, hi) and words for the parameters, it says whether
# all tests there keep the constraint (True), none does (False), or neither is certain (None). A parameter may be unknown.
WORD, NAME = r"'(?:\\.|[^'\\])*'|\"(?:\\.|[^\"\\])*\"", r"\[(?:\\.|[^\]\\])*\]|[^\W\d][\w.]*"
NUMBER, SIGN = r"\.?\d[\w.]*(?:(?<=[eE])[+-]\w+)?", r"[=!<>]=|[-+*/%<>()\],]"
TOKEN = re.compile(rf"(?s)\s*(?:(?P<word>{WORD})|(?P<name>{NAME})|(?P<number>{NUMBER})|(?P<sign>{SIGN}))")
RELATIONS = {"Eq": "==", "NotEq": "!=", "Lt": "<", "LtE": "<=", "Gt": ">", "GtE": ">="}
KEYWORDS = ("in", "not", "and", "or", "implies")
OF_ONE = "abs sqrt floor ceil round sign sin cos tan asin acos atan".split()
FUNCTIONS = {"min": 2, "max": 2, "pow": 2, **dict.fromkeys(OF_ONE, 1)}


class Constraint:
    def __init__(self, text, names):
        tokens, at, text = [], 0, text.strip()
        while at < len(text):
            # A bracket is around a name, and after `in` around a list.
            found = re.compile(r"\s*(?P<sign>\[)").match(text, at) if tokens[-1:] == ["in"] else TOKEN.match(text, at)
            if not found:
                raise ValueError(f"`{text[at:]}` is no part of the language")
            kind, written, at = found.lastgroup, found[found.lastgroup], found.end()
            inside = re.sub(r"(?s)\\(.)", r"\1", written[1:-1])
            if kind == "number" and ("_" in written or not isfinite(float(written))):
                raise ValueError(f"`{written}` is no number")
            if kind == "name" and not (written in FUNCTIONS and text[at:].lstrip()[:1] == "("):
                written = written if written in KEYWORDS else names[inside if written[0] == "[" else written]
            tokens.append(repr(inside) if kind == "word" else repr(float(written)) if kind == "number" else written)
        left = iter(tokens)
        self.tree = ast.parse(f"({self.group(left)})", mode="eval").body
        if next(left, None) or tokens.count("(") != tokens.count(")"):
            raise ValueError("the parentheses do not match")
        self.of_places = any(type(node) is ast.Name and node.id[0] == "C" for node in ast.walk(self.tree))
        self.holds({})  # a part that is no condition raises a ValueError

    def group(self, tokens):
        """The text up to the end of a parenthesis, with `not (a) or (b)` for `a implies b`."""
        parts = [""]
        for token in tokens:
            if token == ")":
                break
            if token == "implies":
                parts.append("")
            else:
                parts[-1] += f"({self.group(tokens)})" if token == "(" else f" {token} "
        text = parts.pop()
        while parts:
            text = f"not ({parts.pop()}) or ({text})"
        return text

    def holds(self, known):
        return self.truth(self.tree, known)

    def truth(self, node, known):
        if type(node) is ast.BoolOp:
            return joined([self.truth(part, known) for part in node.values], type(node.op) is ast.Or)
        if type(node) is ast.UnaryOp and type(node.op) is ast.Not:
            return negated(self.truth(node.operand, known))
        if type(node) is not ast.Compare or len(node.ops) > 1:
            raise ValueError("a part is no condition")
        left, right, sign = node.left, node.comparators[0], type(node.ops[0]).__name__
        value = self.value(left, known)
        if sign in ("In", "NotIn") and type(right) is ast.List:
            among = joined([related(value, "==", self.value(of, known)) for of in right.elts], True)
            return among if sign == "In" else negated(among)
        plain = all(type(getattr(of, "operand", of)) is ast.Constant or type(of) is ast.Name for of in (left, right))
        different = plain and ast.dump(left) != ast.dump(right)
        return related(value, RELATIONS[sign], self.value(right, known), different)

    def value(self, node, known):
        if type(node) is ast.Constant:
            return node.value if type(node.value) is str else (node.value,) * 2
        if type(node) is ast.Name:
            return known.get(node.id)
        name, of = type(getattr(node, "op", None)).__name__, [getattr(node, "operand", None)]
        if type(node) is ast.BinOp:
            of = [node.left, node.right]
        elif type(node) is ast.Call and FUNCTIONS.get(node.func.id) == len(node.args):
            name, of = node.func.id, node.args
        elif name not in ("USub", "UAdd"):
            raise ValueError("a part is no number")
        spans = [self.value(operand, known) for operand in of]
        return span(name, spans[0], spans[-1]) if all(type(of) is tuple for of in spans) else None


def negated(truth):
    return None if truth is None else not truth


def joined(truths, deciding):
    """The truth of "or" (the deciding truth is True) or "and" (False)."""
    return deciding if deciding in truths else None if None in truths else not deciding


def related(a, relation, b, different=False):
    """The truth of a comparison; the two sides may be `different` parameters, which are equal only without volume."""
    if a is None or b is None:
        return None
    if type(a) is str or type(b) is str:
        return relation in ("==", "!=") and (a == b) == (relation == "==")
    if relation in (">", ">="):
        a, b, relation = b, a, relation.replace(">", "<")
    if relation == "<":
        return True if a[1] < b[0] else False if a[0] >= b[1] else None
    if relation == "<=":
        return True if a[1] <= b[0] else False if a[0] > b[1] else None
    equal = True if a[0] == a[1] == b[0] == b[1] else False if a[1] < b[0] or b[1] < a[0] or different else None
    return equal if relation == "==" else negated(equal)


def outward(lo, hi):
    """The span of floats around two exact numbers; None if it is not finite."""
    try:
        a, b = float(lo), float(hi)
    except OverflowError:
        return None
    a, b = a if a <= lo else nextafter(a, -inf), b if b >= hi else nextafter(b, inf)
    return (a, b) if isfinite(a) and isfinite(b) else None


def span(name, a, b):
    """The span of a function of all numbers in the spans a and b; None if it has no value for some of them."""
    (lo, hi), no_zero, in_one = a, not b[0] <= 0 <= b[1], -1 <= a[0] and a[1] <= 1
    slack = lambda ends: (min(ends) - abs(min(ends)) * SLACK - 1e-301, max(ends) + abs(max(ends)) * SLACK + 1e-301)
    if name in ("Add", "Sub"):
        b = b if name == "Add" else (-b[1], -b[0])
        return outward(Fraction(lo) + Fraction(b[0]), Fraction(hi) + Fraction(b[1]))
    if name == "Mult" or (name == "Div" and no_zero):
        values = [Fraction(x) * Fraction(y) if name == "Mult" else Fraction(x) / Fraction(y) for x in a for y in b]
        return outward(min(values), max(values))
    if name == "Mod" and no_zero:
        most = max(map(abs, b))
        exact = (fmod(lo, b[0]),) * 2
        return exact if lo == hi and b[0] == b[1] else (max(min(lo, 0.0), -most), min(max(hi, 0.0), most))
    if name in ("USub", "UAdd"):
        return (-hi, -lo) if name == "USub" else a
    if name in ("min", "max"):
        return tuple(map(min if name == "min" else max, a, b))
    if name == "abs":
        return 0.0 if lo <= 0 <= hi else min(map(abs, a)), max(map(abs, a))
    if name == "sqrt" and lo >= 0:
        x, y = sqrt(lo), sqrt(hi)
        x, y = x if Fraction(x) ** 2 <= lo else nextafter(x, -inf), y if Fraction(y) ** 2 >= hi else nextafter(y, inf)
        return max(x, 0.0), y
    if name == "pow" and lo > 0:
        try:
            return slack([x**y for x in a for y in b])
        except OverflowError:
            return None
    if name in ("floor", "ceil"):
        return tuple(float(floor(x) if name == "floor" else ceil(x)) for x in a)
    if name == "round":
        return tuple(copysign(floor(Fraction(abs(x)) + Fraction(1, 2)), x) for x in a)
    if name == "sign":
        return tuple(float((x > 0) - (x < 0)) for x in a)
    if name in ("sin", "cos"):
        lo, hi = slack([sin(lo) if name == "sin" else cos(lo)]) if lo == hi else (-1.0, 1.0)
        return max(lo, -1.0), min(hi, 1.0)
    if name == "atan" or (name in ("asin", "acos") and in_one):
        return slack([{"atan": atan, "asin": asin, "acos": acos}[name](x) for x in a])
    return None


class Space:
    """The parameters and the constraints. In constraints, C0.. are continuous parameters, and D0.. discrete ones."""

    def __init__(self, certificate):
        self.intervals = [of["interval"] for of in certificate["continuous"]]
        self.names, self.values = ([of[entry] for of in certificate["discrete"]] for entry in ("name", "values"))
        ids = {of["name"]: f"C{i}" for i, of in enumerate(certificate["continuous"])}
        ids.update({name: f"D{i}" for i, name in enumerate(self.names)})
        check(len(ids) == len(self.intervals) + len(self.names), "two parameters have the same name")
        check(all(len(of) == 2 and of[0] <= of[1] for of in self.intervals), "an interval has not two ends in their order")
        self.constraints, self.steps, self.trusted = [], MOST_STEPS, 0
        for text in certificate["constraints"]:
            try:
                self.constraints.append(Constraint(text, ids))
            except (SyntaxError, ValueError, KeyError, RecursionError, MemoryError) as error:
                check(False, f"the constraint `{text}` cannot be read: {error}")
        nodes = [node for constraint in self.constraints for node in ast.walk(constraint.tree)]
        self.named = sorted({int(node.id[1:]) for node in nodes if type(node) is ast.Name and node.id[0] == "D"})

    def spans(self, sides):
        """The spans of continuous parameters with these sides of the unit cube; the others vary fully."""
        spans = {}
        for axis, (lo, hi) in enumerate(self.intervals):
            ends = sides.get(axis, (0.0, 1.0))
            spans[f"C{axis}"] = tuple(hi if u >= 1 else min(max(lo + u * (hi - lo), lo), hi) for u in ends)
        return spans

    def row(self, levels):
        """The values of discrete parameters with these levels; the others are unknown."""
        values = {q: self.values[q][level] for q, level in levels.items()}
        number = lambda value: (float(value),) * 2 if a_number(value) else None
        return {f"D{q}": value if type(value) is str else number(value) for q, value in values.items()}

    def excludes(self, levels):
        """Whether no row with these levels keeps the constraints; None if that is not found out."""
        self.steps -= 1
        known = {**self.spans({}), **self.row(levels)}
        if self.steps < 0 or any(of.holds(known) is False for of in self.constraints):
            return True if self.steps >= 0 else None
        free = next((q for q in self.named if q not in levels), None)
        if free is None:
            return False if all(of.of_places or of.holds(known) for of in self.constraints) else None
        found = True
        for level in range(len(self.values[free])):
            answer = self.excludes({**levels, free: level})
            if answer is False:
                return False
            found = found and answer
        return found

    def check_row(self, levels, excluded, message):
        """Checks whether constraints exclude all rows with these levels. What is not found out is trusted, and counted."""
        answer = self.excludes(dict(levels))
        check(answer is not (not excluded), message)
        self.trusted += answer is None


class Part:
    """The valid part of a projection, as a tree of cells. Each cell is checked."""

    def __init__(self, part, space, where):
        self.axes, self.along, self.discrete, self.rows = (part[of] for of in ("axes", "along", "discrete", "rows"))
        self.space, self.shares, self.checked = space, {}, set()
        beside, places = part["beside"], part["places"]
        self.counts = [len(space.values[q]) if q < len(space.values) else 0 for q in self.discrete]
        exist = [i < len(space.intervals) for i in self.axes + beside] + [j < len(self.axes) for j in self.along]
        lists = [self.axes + beside, self.along, self.discrete]
        once = all(len(set(of)) == len(of) for of in lists)
        check(all(exist) and once, f"{where}: parameters that do not exist, or are named twice")
        fit = [len(row) == len(self.counts) and all(map(lt, row, self.counts)) for row in self.rows]
        fit += [len(place) == len(beside) and all(0 <= x <= 1 for x in place) for place in places]
        check(all(fit), f"{where}: a row or a place does not exist")
        known = [space.row(dict(zip(self.discrete, row))) for row in self.rows]
        cells, self.cuts, self.upper_half, self.sides, volumes, used = part["cells"], {}, {}, [], [], set()
        boxes = [({axis: (0.0, 1.0) for axis in self.axes}, 1.0, None)]
        for i, cell in enumerate(cells):
            check(boxes, f"{where}: the cells go on after their end")
            sides, volume, below = boxes.pop()
            self.upper_half[below] = i
            volumes.append(volume)
            self.sides.append(tuple(sides[self.axes[j]] for j in self.along))
            if type(cell) is int:
                check(cell < len(self.along), f"{where}: cell {i} is cut along no axis")
                axis = self.axes[self.along[cell]]
                (lo, hi), at = sides[axis], sum(sides[axis]) / 2
                check(lo < at < hi, f"{where}: cell {i} is too small to be cut")
                self.cuts[i] = cell, at
                boxes += [({**sides, axis: (at, hi)}, volume / 2, i), ({**sides, axis: (lo, at)}, volume / 2, None)]
            elif cell == "invalid":
                spans = space.spans(sides)
                for row, values in zip(self.rows, known):
                    breaks = any(of.holds({**spans, **values}) is False for of in space.constraints)
                    check(breaks, f"{where}: cell {i} is marked invalid, but row {row} is not shown to break a constraint")
            elif cell != "undecided":
                check(cell[0] < len(self.rows) and cell[1] < len(places), f"{where}: cell {i} names no row or place")
                place = {axis: (x, x) for axis, x in zip(beside, places[cell[1]])}
                values = {**space.spans({**sides, **place}), **known[cell[0]]}
                keeps = all(of.holds(values) for of in space.constraints if of.of_places)
                check(keeps, f"{where}: cell {i} is marked valid, but is not shown to keep the constraints")
                used.add(tuple(self.rows[cell[0]]))
        check(not boxes, f"{where}: the cells end too early")
        self.volumes, self.used, self.leaves_out = volumes, used, "invalid" in cells
        self.certain = self.summed([v if type(cell) is list else 0.0 for v, cell in zip(volumes, cells)])
        self.possible = self.summed([0.0 if cell == "invalid" else v for v, cell in zip(volumes, cells)])
        exact = lambda box: (self.within(0, box, self.possible),) * 2
        self.known = lru_cache(MOST_KNOWN)(lambda box, size: self.bounds(0, box, size) if size else exact(box))
        self.rounding = 2.0 * (len(cells) + 2 * len(self.axes) + 2) * 2.0**-52

    def summed(self, weights):
        for i in reversed(self.cuts):
            weights[i] = weights[i + 1] + weights[self.upper_half[i]]
        return weights

    def halves_of(self, i, box, number=float):
        """The halves of a cell, each with the part of a box that is in it."""
        (j, at), (lo, hi) = self.cuts[i], box[self.cuts[i][0]]
        at = number(at)
        if lo < at:
            yield i + 1, (*box[:j], (lo, min(hi, at)), *box[j + 1 :])
        if hi > at:
            yield self.upper_half[i], (*box[:j], (max(lo, at), hi), *box[j + 1 :])

    def within(self, i, box, weights, number=float):
        """The weight of the part of a box that is in a cell, in the software's order of operations."""
        if i not in self.cuts:
            return prod(hi - lo for lo, hi in box) if weights[i] > 0 else 0
        if weights[i] <= 0 or box == self.sides[i]:
            return weights[i]
        return sum(self.within(half, part, weights, number) for half, part in self.halves_of(i, box, number))

    def bounds(self, i, box, size):
        """Bounds on the weight of the part of a box that is in a cell. Smaller cells than `size` are not looked into."""
        if self.possible[i] <= 0 or box == self.sides[i]:
            return (self.possible[i],) * 2
        if i not in self.cuts or self.volumes[i] < size:
            volume = prod(hi - lo for lo, hi in box)
            return self.possible[i] - self.volumes[i] + volume, min(volume, self.possible[i])
        of_halves = [self.bounds(half, part, size) for half, part in self.halves_of(i, box)]
        return sum(least for least, _ in of_halves), sum(most for _, most in of_halves)

    def split(self, lower, upper):
        """The sides of a box along which cells are cut, and the product of the others."""
        free = prod(b - a for j, (a, b) in enumerate(zip(lower, upper)) if j not in self.along)
        return tuple((lower[j], upper[j]) for j in self.along), free

    def exceeds(self, lower, upper, enough):
        """Whether a box weighs more than enough: its cells that are not invalid. Bounds decide this faster if they can."""
        box, free = self.split(lower, upper)
        for size in COARSE:
            least, most = self.known(box, size)
            if free * most < enough * (1 - CLOSE) or free * (least - 1e-12) > enough * (1 + CLOSE):
                return free * least > enough
        return free * self.known(box, 0)[0] > enough

    def share(self, lower, upper):
        """The least share of a box, computed exactly."""
        if (known := (tuple(lower), tuple(upper))) in self.shares:
            return self.shares[known]
        box, free = self.split(list(map(Fraction, lower)), list(map(Fraction, upper)))
        exact = [self.summed([Fraction(w) for w in weights]) for weights in (self.certain, self.possible)]
        certain, possible = (free * self.within(0, box, weights, Fraction) for weights in exact)
        whole = exact[1][0]
        self.shares[known] = certain / (whole - possible + certain) if certain else Fraction(0)
        return self.shares[known]

    def check_rows(self, fixed, where):
        """Checks that valid cells have rows of a projection, and that invalid cells leave out none."""
        if fixed in self.checked:
            return
        self.checked.add(fixed)
        for row in self.used:
            levels = {**dict(zip(self.discrete, row)), **dict(fixed)}
            check(all(levels[q] == v for q, v in zip(self.discrete, row)), f"{where}: {row} is a row of another projection")
            self.space.check_row(levels, False, f"{where}: a cell is valid in the row {row}, which constraints exclude")
        choices = [[dict(fixed)[q]] if q in dict(fixed) else range(n) for q, n in zip(self.discrete, self.counts)]
        if self.leaves_out and prod(map(len, choices)) > MOST_STEPS:
            self.space.trusted += 1
        elif self.leaves_out:
            for row in product(*choices):
                if list(row) not in self.rows:
                    levels = {**dict(zip(self.discrete, row)), **dict(fixed)}
                    self.space.check_row(levels, True, f"{where}: cells are invalid, but the row {row} was not looked at")


def follow(tests, axes, bound, pivots, part, where):
    """Checks that the pivots prove that no empty box is larger than the bound; `tests` holds those that are selected."""
    enough, pivots = bound * (1 - MARGIN), iter(pivots)
    if part:
        enough *= part.certain[0]
        enough *= 1 - part.rounding
        check(enough > LEAST_WEIGHT or part.possible[0] <= 0, f"{where}: the valid part is too small for floats")
    boxes = [([0.0] * len(axes), [1.0] * len(axes), [inf] * len(axes), [-inf] * len(axes))]
    boxes = [] if part and part.possible[0] <= enough else boxes
    while boxes:
        lower, upper, begins_below, ends_above = boxes.pop()
        pivot = next(pivots, None)
        check(pivot is not None, lambda: f"{where}: the proof ends, but the box from {lower} to {upper} is left")
        check(pivot in tests, lambda: f"{where}: {pivot} is no test that is selected")
        p = [tests[pivot][axis] for axis in axes]
        inside = all(begin < x < end for begin, x, end in zip(lower, p, upper))
        check(inside, lambda: f"{where}: test {pivot} is not inside the box from {lower} to {upper}")
        volume = prod(map(sub, upper, lower))
        for j, x in enumerate(p):
            section = volume / (upper[j] - lower[j])
            if x < begins_below[j]:
                above = lower[:j] + [x] + lower[j + 1 :]
                if part.exceeds(above, upper, enough) if part else section * (upper[j] - x) > enough:
                    boxes.append((above, upper, begins_below[:], ends_above[:]))
                begins_below[j] = x
            if x > ends_above[j]:
                below = upper[:j] + [x] + upper[j + 1 :]
                if part.exceeds(lower, below, enough) if part else section * (x - lower[j]) > enough:
                    boxes.append((lower, below, begins_below[:], ends_above[:]))
                ends_above[j] = x
    check(next(pivots, None) is None, f"{where}: the proof goes on after its end")


def projections(claim, space):
    """The projections that a claim is about, as (fixed levels, axes), and in words."""
    dims, levels = len(space.intervals), [len(values) for values in space.values]
    if claim["measure"] == "dispersion":
        return [((), tuple(range(dims)))], f"in all {dims} continuous parameters together"
    if claim["measure"] == "hole-of-row":
        row = claim["row"]
        check(len(row) == len(levels) and all(v < n for v, n in zip(row, levels)), f"{row} is no row of discrete values")
        named = ", ".join(f"{name} {values[v]}" for name, values, v in zip(space.names, space.values, row))
        return [(tuple(enumerate(row)), tuple(range(dims)))], f"in the row {named}" if named else "in the only row"
    check(claim["measure"] == "k-wise-dispersion", f"{claim['measure']} is no measure")
    k, parameters, wanted = claim["k"], range(dims + len(levels)), []
    check(k in range(1, len(parameters) + 1), f"there are no {k} parameters")
    most = comb(len(parameters), k) * max([1, *levels]) ** min(k, len(levels))
    check(most <= MOST_PROJECTIONS, f"there may be {most} projections; this script checks {MOST_PROJECTIONS} at most")
    for chosen in combinations(parameters, k):
        axes, discrete = [i for i in chosen if i < dims], [i - dims for i in chosen if i >= dims]
        wanted += [(tuple(zip(discrete, v)), tuple(axes)) for v in product(*(range(levels[q]) for q in discrete))]
    excluded = {tuple(map(tuple, fixed)) for fixed in claim["excluded"]}
    check(space.constraints or not excluded, "combinations are excluded, but there are no constraints")
    check(all(excluded), "a combination of no values is excluded")
    fits = all(q < len(levels) and v < levels[q] for fixed in excluded for q, v in fixed)
    check(fits, "a combination of values that do not exist is excluded")
    for fixed in excluded:
        space.check_row(fixed, True, f"the combination {list(fixed)} is excluded, but a row with it keeps the constraints")
    kept = [of for of in wanted if of[0] not in excluded]
    check(kept, "everything is excluded")
    but = f" but {len(excluded)} combinations of values, which constraints exclude," if excluded else ""
    return kept, f"in any {k} parameters{but}"


def key(of):
    return tuple(map(tuple, of["fixed"])), tuple(of["axes"])


def part_of(of, parts, where):
    """The valid part of a proof or a witness, or None."""
    if of.get("part") is None:
        return None
    check(of["part"] < len(parts), f"{where}: there is no part {of['part']}")
    part = parts[of["part"]]
    check(part.axes == of["axes"], f"{where}: the valid part is of another projection")
    part.check_rows(key(of)[0], where)
    return part


def check_claim(claim, earlier, coordinates, levels, space, parts):
    bound, hole, (wanted, which) = claim["upper"], claim["witness"], projections(claim, space)
    selected = lambda fixed: {i: coordinates[i] for i, test in enumerate(levels) if all(test[q] == v for q, v in fixed)}
    like, proofs = claim, claim["proofs"]
    if claim.get("like") is not None:
        check(not proofs and claim["like"] < len(earlier), f"{which}: no earlier claim is like this one")
        like = earlier[claim["like"]]
        check(claim["measure"] == like["measure"] == "hole-of-row", f"{which}: only a row is like another row")
        theirs = [selected(tuple(enumerate(of["row"]))).values() for of in (claim, like)]
        check(list(theirs[0]) == list(theirs[1]), f"{which}: the row has other points than the row that it is like")
        check(bound >= like["upper"], f"{which}: the row that it is like has a weaker bound")
        proofs = [{**proof, "fixed": list(wanted[0][0])} for proof in like["proofs"]]
    kinds = {part_of(of, parts, which) is not None for of in ([hole] if hole else []) + proofs if of["axes"]}
    check(len(kinds) < 2, f"{which}: some boxes count for their volume, and others for their share of a valid part")
    which = f"of the valid part {which}" if True in kinds else which
    if hole:
        ends = list(zip(hole["axes"], hole["lower"], hole["upper"], strict=True))
        check(key(hole) in wanted, f"{which}: the witness is of another projection")
        check(all(0 <= a < b <= 1 for _, a, b in ends), f"{which}: the witness is no box in the unit cube")
        for i, p in selected(hole["fixed"]).items():
            check(not all(a < p[axis] < b for axis, a, b in ends), f"{which}: test {i} is inside the witness")
        if part := part_of(hole, parts, which):
            share = part.share(hole["lower"], hole["upper"])
            most = f"{which}: the witness has at least {float(share)}, which does not show {claim['lower']}"
            check(Fraction(claim["lower"]) <= share * (1 + Fraction(MARGIN)), most)
        else:
            volume = prod((Fraction(b) - Fraction(a) for _, a, b in ends), start=Fraction(1))
            close = abs(volume - Fraction(claim["lower"])) <= volume * Fraction(MARGIN)
            check(close, f"{which}: the witness has the volume {float(volume)}, not {claim['lower']}")
        print(f"an axis-parallel region of volume {claim['lower']} {which} has not been hit: shown")
    check(hole or claim["lower"] <= 0, f"{which}: the lower bound has no witness")
    check(bound >= claim["lower"], f"{which}: the bounds contradict each other")
    if bound >= 1:
        return print(f"nothing is proved of larger regions {which}: {claim['note'] or 'there are none'}")
    known = {key(proof): proof for proof in proofs}
    for fixed, axes in wanted:
        where = f"{which}, axes {list(axes)}, levels {list(fixed)}"
        check((fixed, axes) in known, f"{where}: there is no proof")
        proof = known[fixed, axes]
        if like is claim:
            follow(selected(fixed), axes, bound, proof["pivots"], part_of(proof, parts, where), where)
    size = f"{len(wanted)} projections, {sum(len(known[projection]['pivots']) for projection in wanted)} boxes"
    size = size if like is claim else "as another row with the same points"
    print(f"every axis-parallel failure region of volume above {bound} {which} has been hit: proved ({size})")


def main(path):
    certificate = read(path)
    sys.setrecursionlimit(MOST_NESTED)
    check_form(certificate, CERTIFICATE, "the certificate")
    check(certificate["format"] in (1, 2), "this script knows the formats 1 and 2")
    for i, claim in enumerate(certificate["claims"]):
        check_claim_form(claim, f"the certificate.claims[{i}]")
    coordinates, levels, space = certificate["coordinates"], certificate["levels"], Space(certificate)
    dims, choices = len(space.intervals), [len(values) for values in space.values]
    check(dims <= 1000 and len(levels) == len(coordinates), "too many dimensions, or halves of tests")
    for i, (point, test) in enumerate(zip(coordinates, levels)):
        check(len(point) == dims and all(0 <= x <= 1 for x in point), f"test {i} is outside the unit cube")
        check(len(test) == len(choices) and all(v in range(n) for v, n in zip(test, choices)), f"test {i}: no such level")
    check_form(certificate.get("parts", []), [PART], "the certificate.parts")
    parts = [Part(part, space, f"part {i}") for i, part in enumerate(certificate.get("parts", []))]
    check(certificate["claims"], "nothing is claimed")
    for i, claim in enumerate(certificate["claims"]):
        check_claim(claim, certificate["claims"][:i], coordinates, levels, space, parts)
    if space.trusted:
        print(f"on trust: whether constraints allow {space.trusted} combinations of discrete values")
    if certificate.get("note"):
        print(f"note: {certificate['note']}")


if __name__ == "__main__":
    check(len(sys.argv) == 2, "expected the path of a certificate")
    try:
        main(sys.argv[1])
    except RecursionError:
        check(False, "cells or parentheses are nested too deeply")
