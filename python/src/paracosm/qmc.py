"""Every sequence and set of points of this package as an engine of `scipy.stats.qmc`. It needs scipy 1.15 or later.

    >>> from paracosm import qmc
    >>> points = qmc.Greedy(d=2, rng=1).random(100)

An engine draws the same points as `paracosm.sample` with the same strategy and seed. Without `rng`, an engine is deterministic: it draws the plain
sequence if there is one, and otherwise the points of the seed 0. A number as `rng` is the seed; a generator of numpy draws one.

Some strategies make a set of exactly as many points as are drawn: such an engine draws once, and again after `reset()`.
"""

import operator
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from scipy.stats.qmc import QMCEngine

from ._core import Error, Generator

__all__ = [
    "Best",
    "Fibonacci",
    "Greedy",
    "GreedyPeriodic",
    "Halton",
    "HaltonScrambled",
    "Hammersley",
    "Kronecker",
    "Lattice",
    "Lhs",
    "LhsCentred",
    "LhsDiscrepancy",
    "LhsMaximin",
    "Random",
    "RandomCorners",
    "Sobol",
    "SobolOwen",
]

_Rng = int | np.integer[Any] | np.random.Generator | np.random.RandomState | None

# A budget that no engine reaches, so the strategy has no last point.
_ENDLESS = 2**40


class _Engine(QMCEngine):
    """An engine of a strategy."""

    method: ClassVar[str]
    # The number of points for which the strategy is made; `None` for the number of the first draw.
    _budget: ClassVar[int | None] = None

    def __init__(self, d: int, *, optimization: Literal["random-cd", "lloyd"] | None = None, rng: _Rng = None) -> None:
        """Makes an engine of points in `d` dimensions. `optimization` has the meaning of the same argument in scipy."""
        self._seed = _seed_of(rng)
        # scipy checks the dimensions and the optimization; its own random numbers only serve the optimization.
        super().__init__(d=d, optimization=optimization, rng=self._seed or 0)
        self._generator: Generator | None = None

    def _random(self, n: Any = 1, *, workers: Any = 1) -> NDArray[np.float64]:
        n = operator.index(n)
        if n == 0:
            return np.empty((0, int(self.d)))
        if self._generator is None:
            self._generator = Generator(int(self.d), self.method, budget=self._budget or n, seed=self._seed)
            # A copy goes on where its original is.
            self._generator.ask(self.num_generated)
        points: NDArray[np.float64] = self._generator.ask(n)
        if len(points) < n:
            raise Error(
                f"{type(self).__name__} makes a set of exactly as many points as its first draw, {self.num_generated}, and cannot draw {n} more: draw all points "
                "at once, or call `reset()` first; as the strategy of a study, it needs a `batch` as large as the budget"
            )
        return points

    def reset(self) -> "_Engine":
        """Returns to the state before the first draw."""
        super().reset()
        self._generator = None
        return self

    def __getstate__(self) -> dict[str, Any]:
        """Leaves out the points to come, which follow from the seed and the number of points so far."""
        return {**self.__dict__, "_generator": None}


def _seed_of(rng: _Rng) -> int | None:
    if rng is None:
        return None
    if isinstance(rng, (int, np.integer)):
        if rng < 0:
            raise Error(f"rng is {rng}, expected a seed from 0 on")
        return int(rng)
    if isinstance(rng, np.random.RandomState):
        return int(rng.randint(2**31))
    return int(np.random.default_rng(rng).integers(2**63))


class Random(_Engine):
    """Independent uniform points: the baseline."""

    method = "random"


class RandomCorners(_Engine):
    """Random corners of the cube."""

    method = "random-corners"


class Halton(_Engine):
    """The Halton sequence from its second point on: the first is the corner. With `rng`, the sequence is shifted at random."""

    method = "halton"


class HaltonScrambled(_Engine):
    """The Halton sequence with random digits."""

    method = "halton-scrambled"


class Sobol(_Engine):
    """The Sobol sequence. With `rng`, the sequence is shifted at random."""

    method = "sobol"


class SobolOwen(_Engine):
    """The Sobol sequence with Owen's nested scrambling."""

    method = "sobol-owen"


class Kronecker(_Engine):
    """A sequence with golden steps on every axis."""

    method = "kronecker"


class Hammersley(_Engine):
    """The Hammersley set: the Halton sequence with one axis evenly spaced. It draws once."""

    method = "hammersley"


class Fibonacci(_Engine):
    """The Fibonacci lattice in two dimensions. It draws once."""

    method = "fibonacci"


class Lattice(_Engine):
    """A rank-1 lattice that is searched for. It draws once."""

    method = "lattice"


class Lhs(_Engine):
    """A Latin hypercube. It draws once."""

    method = "lhs"


class LhsCentred(_Engine):
    """A Latin hypercube with the points in the middle of their cells. It draws once."""

    method = "lhs-centred"


class LhsMaximin(_Engine):
    """A Latin hypercube whose points a search moves apart. It draws once."""

    method = "lhs-maximin"


class LhsDiscrepancy(_Engine):
    """A Latin hypercube after a search for a low centered discrepancy. It draws once."""

    method = "lhs-discrepancy"


class Best(_Engine):
    """A set with a small dispersion: a shipped one, or the result of a short search. It draws once."""

    method = "best"


class Greedy(_Engine):
    """Points in the largest empty boxes: a low dispersion."""

    method = "greedy"
    _budget = _ENDLESS


class GreedyPeriodic(_Engine):
    """Points in the largest empty boxes, which go on at the opposite border."""

    method = "greedy-periodic"
    _budget = _ENDLESS
