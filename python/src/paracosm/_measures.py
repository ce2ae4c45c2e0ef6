"""The measures of coverage, a function for each of them.

Every function takes tests: an array of points of the unit cube, of the shape (n, d); a table of tests as `sample` makes it; or, with a
space, a dictionary or a data frame with a column for each parameter. Every function returns a `Bracket`.

A measure that takes long ends after an amount of work that is the same on every machine: some seconds of one core. Its result is then a
bracket with two certified bounds. `time_limit` is a limit in seconds instead, and `time_limit=float("inf")` is no limit.
"""

from typing import Any

from ._core import Bracket, Space, measure

__all__ = [
    "centered_discrepancy",
    "dispersion",
    "extreme_discrepancy",
    "fill_distance",
    "k_wise_coverage",
    "k_wise_dispersion",
    "l2_star_discrepancy",
    "mixture_discrepancy",
    "star_discrepancy",
    "wraparound_discrepancy",
]


def dispersion(tests: Any, space: Space | None = None, *, time_limit: float | None = None) -> Bracket:
    """Returns the largest volume of a box without a test inside, as a share of the space. `.box` is this box."""
    return measure("dispersion", tests, space, time_limit=time_limit)


def star_discrepancy(tests: Any, space: Space | None = None, *, time_limit: float | None = None) -> Bracket:
    """Returns the largest difference between the volume of a box at the origin and its share of the tests."""
    return measure("star", tests, space, time_limit=time_limit)


def extreme_discrepancy(tests: Any, space: Space | None = None, *, time_limit: float | None = None) -> Bracket:
    """Returns the largest difference between the volume of any box and its share of the tests."""
    return measure("extreme", tests, space, time_limit=time_limit)


def fill_distance(tests: Any, space: Space | None = None, *, time_limit: float | None = None) -> Bracket:
    """Returns the radius of the largest ball without a test inside. `.centre` is its centre."""
    return measure("fill", tests, space, time_limit=time_limit)


def l2_star_discrepancy(tests: Any, space: Space | None = None) -> Bracket:
    """Returns the L2 star discrepancy (Warnock's formula)."""
    return measure("l2-star", tests, space)


def centered_discrepancy(tests: Any, space: Space | None = None) -> Bracket:
    """Returns the centred L2 discrepancy (Hickernell)."""
    return measure("centered", tests, space)


def wraparound_discrepancy(tests: Any, space: Space | None = None) -> Bracket:
    """Returns the wraparound L2 discrepancy (Hickernell)."""
    return measure("wraparound", tests, space)


def mixture_discrepancy(tests: Any, space: Space | None = None) -> Bracket:
    """Returns the mixture L2 discrepancy (Zhou, Fang and Ning)."""
    return measure("mixture", tests, space)


def k_wise_coverage(tests: Any, space: Space | None = None, *, k: int | None = None) -> Bracket:
    """Returns the share of the valid combinations of values of any k discrete parameters that some test contains."""
    return measure("k-wise", tests, space, k=k)


def k_wise_dispersion(
    tests: Any, space: Space | None = None, *, k: int | None = None, time_limit: float | None = None
) -> Bracket:
    """Returns the largest hole in the space of any k parameters, discrete and continuous parameters together. `.box` and `.fixed` are its
    place."""
    return measure("k-wise-dispersion", tests, space, k=k, time_limit=time_limit)
