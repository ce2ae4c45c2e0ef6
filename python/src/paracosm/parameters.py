"""The domains of parameters: `Interval` and `Choice`."""

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Interval:
    """All numbers from `low` to `high`. The parameter is continuous.

    - low, high: the least and the greatest value
    - unit: the unit of the numbers, such as "m/s"
    - default: the value of the parameter if no test varies it
    - signal: the shape of a parameter that varies while a test runs: "polynomial(DEGREE)", "piecewise-constant(PIECES)" or "piecewise-linear(PIECES)"
    - distribution: the distribution for probabilities, such as "normal:1.4,0.3". Without one it is uniform
    """

    low: float
    high: float
    unit: str | None = None
    default: float | None = None
    signal: str | None = None
    distribution: str | None = None


@dataclass(frozen=True)
class Choice:
    """A finite list of numbers and words. The parameter is discrete.

    - values: the numbers and words
    - unit: the unit of the values, such as "m/s"
    - default: the value of the parameter if no test varies it
    - signal: the shape of a parameter that varies while a test runs: "piecewise-constant(PIECES)"
    - distribution: the distribution for probabilities, such as "weights:0.7,0.2,0.1". Without one it is uniform
    """

    values: Sequence[float | str]
    unit: str | None = None
    default: float | str | None = None
    signal: str | None = None
    distribution: str | None = None
