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
"""

import json
import sys
from fractions import Fraction
from itertools import combinations, product
from math import comb, inf, isfinite, prod
from operator import sub

MARGIN = 1e-12
MOST_PROJECTIONS = 1_000_000


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


LEVELS = [[an_index]]
WITNESS = {"fixed": LEVELS, "axes": [an_index], "lower": [a_number], "upper": [a_number]}
PROOF = {"fixed": LEVELS, "axes": [an_index], "pivots": [an_index]}
CLAIM = {"measure": a_text, "lower": a_number, "upper": a_number, "note": a_text_or_null, "proofs": [PROOF]}
CERTIFICATE = {
    "format": an_index,
    "continuous": [anything],
    "discrete": [{"values": [anything]}],
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


def follow(tests, axes, bound, pivots, where):
    """Checks that the pivots prove that no empty box is larger than the bound; `tests` holds those that are selected."""
    enough, pivots = bound * (1 - MARGIN), iter(pivots)
    boxes = [([0.0] * len(axes), [1.0] * len(axes), [inf] * len(axes), [-inf] * len(axes))]
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
                if section * (upper[j] - x) > enough:
                    boxes.append((lower[:j] + [x] + lower[j + 1 :], upper, begins_below[:], ends_above[:]))
                begins_below[j] = x
            if x > ends_above[j]:
                if section * (x - lower[j]) > enough:
                    boxes.append((lower, upper[:j] + [x] + upper[j + 1 :], begins_below[:], ends_above[:]))
                ends_above[j] = x
    check(next(pivots, None) is None, f"{where}: the proof goes on after its end")


def projections(claim, dims, levels, constrained):
    """The projections that a claim is about, as (fixed levels, axes), and in words."""
    if claim["measure"] == "dispersion":
        return [((), tuple(range(dims)))], f"in all {dims} continuous parameters together"
    check(claim["measure"] == "k-wise-dispersion", f"{claim['measure']} is no measure")
    k, parameters, wanted = claim["k"], range(dims + len(levels)), []
    check(k in range(1, len(parameters) + 1), f"there are no {k} parameters")
    most = comb(len(parameters), k) * max([1, *levels]) ** min(k, len(levels))
    check(most <= MOST_PROJECTIONS, f"there may be {most} projections; this script checks {MOST_PROJECTIONS} at most")
    for chosen in combinations(parameters, k):
        axes, discrete = [i for i in chosen if i < dims], [i - dims for i in chosen if i >= dims]
        wanted += [(tuple(zip(discrete, v)), tuple(axes)) for v in product(*(range(levels[q]) for q in discrete))]
    excluded = {tuple(map(tuple, fixed)) for fixed in claim["excluded"]}
    check(constrained or not excluded, "combinations are excluded, but there are no constraints")
    check(all(excluded), "a combination of no values is excluded")
    kept = [of for of in wanted if of[0] not in excluded]
    check(kept, "everything is excluded")
    trust = f" but {len(excluded)} combinations of values, on trust excluded by constraints," if excluded else ""
    return kept, f"in any {k} parameters{trust}"


def key(of):
    return tuple(map(tuple, of["fixed"])), tuple(of["axes"])


def check_claim(claim, coordinates, levels, dims, choices, constrained):
    bound, hole, (wanted, which) = claim["upper"], claim["witness"], projections(claim, dims, choices, constrained)
    selected = lambda fixed: {i: coordinates[i] for i, test in enumerate(levels) if all(test[q] == v for q, v in fixed)}
    if hole:
        ends = list(zip(hole["axes"], hole["lower"], hole["upper"], strict=True))
        check(key(hole) in wanted, f"{which}: the witness is of another projection")
        check(all(0 <= a < b <= 1 for _, a, b in ends), f"{which}: the witness is no box in the unit cube")
        for i, p in selected(hole["fixed"]).items():
            check(not all(a < p[axis] < b for axis, a, b in ends), f"{which}: test {i} is inside the witness")
        volume = prod((Fraction(b) - Fraction(a) for _, a, b in ends), start=Fraction(1))
        close = abs(volume - Fraction(claim["lower"])) <= volume * Fraction(MARGIN)
        check(close, f"{which}: the witness has the volume {float(volume)}, not {claim['lower']}")
        print(f"an axis-parallel region of volume {claim['lower']} {which} has not been hit: shown")
    check(hole or claim["lower"] <= 0, f"{which}: the lower bound has no witness")
    check(bound >= claim["lower"], f"{which}: the bounds contradict each other")
    if bound >= 1:
        return print(f"nothing is proved of larger regions {which}: {claim['note'] or 'there are none'}")
    proofs = {key(proof): proof["pivots"] for proof in claim["proofs"]}
    for fixed, axes in wanted:
        where = f"{which}, axes {list(axes)}, levels {list(fixed)}"
        check((fixed, axes) in proofs, f"{where}: there is no proof")
        follow(selected(fixed), axes, bound, proofs[fixed, axes], where)
    size = f"{len(wanted)} projections, {sum(len(proofs[projection]) for projection in wanted)} boxes"
    print(f"every axis-parallel failure region of volume above {bound} {which} has been hit: proved ({size})")


def main(path):
    certificate = read(path)
    check_form(certificate, CERTIFICATE, "the certificate")
    check(certificate["format"] == 1, "this script knows format 1")
    for i, claim in enumerate(certificate["claims"]):
        check_claim_form(claim, f"the certificate.claims[{i}]")
    coordinates, levels = certificate["coordinates"], certificate["levels"]
    dims, choices = len(certificate["continuous"]), [len(choice["values"]) for choice in certificate["discrete"]]
    check(dims <= 1000 and len(levels) == len(coordinates), "too many dimensions, or halves of tests")
    for i, (point, test) in enumerate(zip(coordinates, levels)):
        check(len(point) == dims and all(0 <= x <= 1 for x in point), f"test {i} is outside the unit cube")
        check(len(test) == len(choices) and all(v in range(n) for v, n in zip(test, choices)), f"test {i}: no such level")
    check(certificate["claims"], "nothing is claimed")
    for claim in certificate["claims"]:
        check_claim(claim, coordinates, levels, dims, choices, bool(certificate["constraints"]))


if __name__ == "__main__":
    check(len(sys.argv) == 2, "expected the path of a certificate")
    main(sys.argv[1])
