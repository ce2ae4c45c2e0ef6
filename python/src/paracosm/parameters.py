"""The domains of parameters: `Interval` and `Choice`."""

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Interval:
    """All numbers from `low` to `high`. The parameter is continuous."""

    low: float
    high: float
    unit: str | None = None
    """The unit of the numbers, such as "m/s"."""
    default: float | None = None
    """The value of the parameter if no test varies it."""
    signal: str | None = None
    """The shape of a parameter that varies while a test runs: "polynomial(DEGREE)", "piecewise-constant(PIECES)" or "piecewise-linear(PIECES)"."""
    distribution: str | None = None
    """The distribution for probabilities, such as "normal:1.4,0.3". Without one it is uniform."""


@dataclass(frozen=True)
class Choice:
    """A finite list of numbers and words. The parameter is discrete."""

    values: Sequence[float | str]
    unit: str | None = None
    """The unit of the values, such as "m/s"."""
    default: float | str | None = None
    """The value of the parameter if no test varies it."""
    signal: str | None = None
    """The shape of a parameter that varies while a test runs: "piecewise-constant(PIECES)"."""
    distribution: str | None = None
    """The distribution for probabilities, such as "weights:0.7,0.2,0.1". Without one it is uniform."""
