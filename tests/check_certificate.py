#!/usr/bin/env python3
"""Checks a certificate that `paracosm-cover estimate --certificate FILE` wrote.

    python3 check_certificate.py FILE

It shares nothing with the software that wrote the file. Each claim is about boxes in the unit cube of the continuous
parameters, in every projection: a choice of parameters, with values of the discrete ones among them, which select tests.
A box is empty if no selected test is strictly inside it.

Why a proof proves. To show: every empty box has at most the volume `upper`. Take a box R and an empty box B inside
it, R the unit cube at first. If R is no larger than `upper`, so is B. Else the proof names a selected test p inside R.
It is not inside B, so along some axis B ends at p or before it, or begins at p or after it: B lies in what is left of R when
one of its ends moves to p. Take the first such cut in the order below; at the ends of the cuts before it B reaches
beyond p, which is noted (`begins_below`, `ends_above`), and which rules out cuts further down that contradict it. So B lies
in one of the boxes that follow, and all of them are looked at.

Floating-point numbers suffice: a product of d differences of numbers in [0,1] is off by a share of at most 2 d / 2^53,
and boxes that count as small enough are smaller than `upper` by a share of 1e-12, more than that up to d = 1000.
(No product underflows on the way: a largest empty box, which some leaf contains, is at least 1 / (n + 1) large.)
"""

import json
import sys
from fractions import Fraction
from itertools import combinations, product
from math import inf, prod
from operator import sub

MARGIN = 1e-12


def check(holds, message):
    if not holds:
        sys.exit(f"refused: {message}")


def follow(tests, axes, upper, pivots, where):
    """Checks that the pivots prove that no empty box is larger than `upper`; `tests` holds those that are selected."""
    enough = upper * (1 - MARGIN)
    pivots = iter(pivots)
    boxes = [([0.0] * len(axes), [1.0] * len(axes), [inf] * len(axes), [-inf] * len(axes))]
    while boxes:
        lower, upper, begins_below, ends_above = boxes.pop()
        pivot = next(pivots, None)
        check(pivot is not None, f"{where}: the proof ends, but the box from {lower} to {upper} is left")
        check(pivot in tests, f"{where}: {pivot} is no test that is selected")
        p = [tests[pivot][axis] for axis in axes]
        for j, x in enumerate(p):
            check(lower[j] < x < upper[j], f"{where}: test {pivot} is not inside the box from {lower} to {upper}")
        for j, x in enumerate(p):
            if x < begins_below[j]:
                cut = lower[:j] + [x] + lower[j + 1 :]
                if prod(map(sub, upper, cut)) > enough:
                    boxes.append((cut, upper, begins_below[:], ends_above[:]))
                begins_below[j] = x
            if x > ends_above[j]:
                cut = upper[:j] + [x] + upper[j + 1 :]
                if prod(map(sub, cut, lower)) > enough:
                    boxes.append((lower, cut, begins_below[:], ends_above[:]))
                ends_above[j] = x
    check(next(pivots, None) is None, f"{where}: the proof goes on after its end")


def projections(claim, dims, levels):
    """The projections that a claim is about, as (fixed levels, axes)."""
    if claim["measure"] == "dispersion":
        return [((), tuple(range(dims)))]
    check(claim["measure"] == "k-wise-dispersion", f"{claim['measure']} is no measure")
    values = [[None]] * dims + [range(n) for n in levels]
    chosen = (zip(s, v) for s in combinations(range(len(values)), claim["k"]) for v in product(*(values[i] for i in s)))
    split = (list(pairs) for pairs in chosen)
    return [
        (tuple((i - dims, v) for i, v in pairs if i >= dims), tuple(i for i, _ in pairs if i < dims)) for pairs in split
    ]


def main(path):
    with open(path, encoding="utf-8") as file:
        certificate = json.load(file)
    check(certificate["format"] == 1, "this script knows format 1")
    coordinates, levels = certificate["coordinates"], certificate["levels"]
    dims, choices = len(certificate["continuous"]), [len(choice["values"]) for choice in certificate["discrete"]]
    check(dims <= 1000 and len(levels) == len(coordinates), "too many dimensions, or half-tests")
    for i, (point, test) in enumerate(zip(coordinates, levels)):
        check(len(point) == dims and all(0 <= x <= 1 for x in point), f"test {i} is outside the unit cube")
        check(len(test) == len(choices) and all(0 <= v < n for v, n in zip(test, choices)), f"test {i} has no such level")
    check(certificate["claims"], "nothing is claimed")

    for claim in certificate["claims"]:
        k, bound, hole = claim["k"], claim["upper"], claim["witness"]
        which = f"in any {k} parameters" if k else f"in all {dims} continuous parameters together"
        wanted = projections(claim, dims, choices)

        def selected(fixed):
            return {i: coordinates[i] for i, test in enumerate(levels) if all(test[q] == v for q, v in fixed)}

        if hole:
            fixed, axes = tuple(map(tuple, hole["fixed"])), tuple(hole["axes"])
            ends = list(zip(axes, hole["lower"], hole["upper"], strict=True))
            check((fixed, axes) in wanted, f"{which}: the witness is of another projection")
            check(all(0 <= a < b <= 1 for _, a, b in ends), f"{which}: the witness is no box in the unit cube")
            for i, p in selected(fixed).items():
                check(not all(a < p[axis] < b for axis, a, b in ends), f"{which}: test {i} is inside the witness")
            volume = prod((Fraction(b) - Fraction(a) for _, a, b in ends), start=Fraction(1))
            check(abs(volume - Fraction(claim["lower"])) <= volume * Fraction(MARGIN), f"{which}: the witness has another volume")
            print(f"an axis-parallel region of volume {claim['lower']} {which} has not been hit: shown")
        else:
            check(claim["lower"] <= 0, f"{which}: there is no witness of the lower bound")
        if bound >= 1:
            print(f"nothing is proved of larger regions {which}: {claim['note'] or 'there may be such a hole'}")
            continue
        proofs = {(tuple(map(tuple, proof["fixed"])), tuple(proof["axes"])): proof["pivots"] for proof in claim["proofs"]}
        for fixed, axes in wanted:
            where = f"{which}, axes {list(axes)}, levels {list(fixed)}"
            check((fixed, axes) in proofs, f"{where}: there is no proof")
            follow(selected(fixed), axes, bound, proofs[fixed, axes], where)
        boxes = sum(map(len, proofs.values()))
        print(
            f"every axis-parallel failure region of volume above {bound} {which} has been hit: "
            f"proved ({len(wanted)} projections, {boxes} boxes)"
        )


if __name__ == "__main__":
    main(sys.argv[1])
