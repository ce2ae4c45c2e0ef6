"""Adapters from samplers and searches of other packages to strategies.

A strategy is an object with `ask(n)` and `tell(X, y)`, an engine of `scipy.stats.qmc`, a sampler of Optuna, or a function that makes one of them.
"""

import copy
import inspect
import sys
from collections import deque
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._core import Error

_Array = NDArray[np.float64]


def as_strategy(given: object) -> str | None:
    """Returns a name for the strategy of another package; `None` if `given` is the name of a strategy of this package.

    Raises `Error` for anything else.
    """
    if isinstance(given, str):
        return None
    if not (_is_engine(given) or _is_of_optuna(given) or _is_search(given) or callable(given)):
        raise Error(
            f"strategy is {given!r}, expected the name of a strategy, an object with `ask(n)` and `tell(X, y)`, an engine of scipy.stats.qmc, a sampler of "
            "Optuna, or a function that makes one"
        )
    name = getattr(given, "__name__", None)
    if not isinstance(name, str) or not name.isprintable():
        name = type(given).__name__
    return "function" if name == "<lambda>" else name


def begun(given: object, levels: list[int], seed: int | None) -> "Asked":
    """Begins a strategy for tests with a coordinate for each entry of `levels`: the number of its levels, or 0 if the coordinate is continuous. The
    object of the user stays as it is."""
    try:
        own = copy.deepcopy(given)
    except Exception as error:
        raise Error(f"the strategy cannot be copied ({error}): give a function that makes it") from None
    if _is_class_of_optuna(own):
        own = _sampler_of(own, seed)
    elif inspect.isclass(own) or not (_is_engine(own) or _is_of_optuna(own) or _is_search(own)):
        own = _called(own, len(levels), seed)
    if _is_engine(own):
        return Asked(_Engine(own), len(levels))
    if _is_of_optuna(own):
        return Asked(_Sampler(own, levels), len(levels))
    if not _is_search(own):
        raise Error(
            f"the function made {type(own).__name__}, expected an object with `ask(n)` and `tell(X, y)`, an engine of scipy.stats.qmc, or a sampler of Optuna. "
            "If it makes points, put it into a class with `ask(self, n)`, which returns them, and `tell(self, X, y)`, which does nothing"
        )
    return Asked(own, len(levels))


def named(strategies: Any) -> list[tuple[str, object | None]]:
    """Returns the names of strategies, each with the object of a strategy of another package."""
    if isinstance(strategies, str):
        raise Error(f"strategies is {strategies!r}, expected a list, such as [{strategies!r}]")
    pairs = strategies.items() if isinstance(strategies, Mapping) else ((None, one) for one in strategies)
    found: list[tuple[str, object | None]] = []
    for name, given in pairs:
        own = as_strategy(given)
        if own is None and name not in (None, given):
            raise Error(f"strategies: `{name}` is the strategy {given!r} of this package, which keeps its name")
        found.append((given, None) if own is None else (_free(name or own), given))
    return found


def _free(name: str) -> str:
    if name in (known for known, _, _ in _core.strategies()):
        raise Error(f"a strategy is called `{name}` already: give yours another name, such as {{'my-{name}': ..}}")
    if not name or not all(c.isascii() and (c.isalnum() or c in "-_") for c in name):
        raise Error(f"found the name `{name}` of a strategy, expected letters, digits, `-` and `_`")
    return name


def set_of(name: str, given: object, dims: int, points: int, seed: int) -> _Array:
    """Returns a set of points of a strategy of another package."""
    try:
        found = begun(given, [0] * dims, seed).all(points)
    except Exception as error:
        why = str(error) if isinstance(error, Error) else f"{type(error).__name__}: {error}"
        raise Error(f"the strategy `{name}`, {points} points in {dims} dimensions: {why}") from error
    if len(found) != points:
        raise Error(f"the strategy `{name}` made {len(found)} points in {dims} dimensions, expected {points}")
    return found


def _called(make: Any, dims: int, seed: int | None) -> Any:
    """Calls a function with the number of coordinates, and with the seed if the function has a parameter `rng` or `seed`."""
    try:
        known = list(inspect.signature(make).parameters)
    except ValueError:
        known = []
    name = next((name for name in ("rng", "seed") if name in known), None)
    return make(dims) if name is None else make(dims, **{name: seed})


def _is_search(given: object) -> bool:
    optuna = sys.modules.get("optuna")
    if optuna is not None and isinstance(given, optuna.Study):
        raise Error("the strategy is a study of Optuna: give its sampler, `study.sampler`")
    return callable(getattr(given, "ask", None)) and callable(getattr(given, "tell", None))


def _is_engine(given: object) -> bool:
    qmc = sys.modules.get("scipy.stats.qmc")
    return qmc is not None and isinstance(given, qmc.QMCEngine)


def _is_class_of_optuna(given: object) -> bool:
    optuna = sys.modules.get("optuna")
    return optuna is not None and inspect.isclass(given) and issubclass(given, optuna.samplers.BaseSampler)


def _sampler_of(made: Any, seed: int | None) -> Any:
    """Makes a sampler of a class of Optuna. The first parameter of such a class is no number of dimensions."""
    return made(seed=seed) if "seed" in inspect.signature(made).parameters else made()


def _is_of_optuna(given: object) -> bool:
    optuna = sys.modules.get("optuna")
    return optuna is not None and isinstance(given, optuna.samplers.BaseSampler)


class _Engine:
    """An engine of scipy, which learns nothing."""

    def __init__(self, engine: Any) -> None:
        self.engine = engine

    def ask(self, n: int) -> _Array:
        points: _Array = self.engine.random(n)
        return points

    def tell(self, points: _Array, robustness: _Array) -> None:
        pass


class _Sampler:
    """A sampler of Optuna, which minimises the robustness."""

    def __init__(self, sampler: Any, levels: list[int]) -> None:
        import optuna
        from optuna.distributions import CategoricalDistribution, FloatDistribution

        before = optuna.logging.get_verbosity()
        optuna.logging.set_verbosity(optuna.logging.WARNING)
        try:
            self.study = optuna.create_study(sampler=sampler)
        finally:
            optuna.logging.set_verbosity(before)
        self.has_stopped = False
        # A sampler of a finite set, such as a grid, stops its study, which Optuna allows only within `optimize`.
        self.study.stop = self._stop  # type: ignore[method-assign]
        of = [CategoricalDistribution(range(count)) if count else FloatDistribution(0.0, 1.0) for count in levels]
        self.distributions = {f"x{i}": one for i, one in enumerate(of)}
        self.levels = levels
        self.trials: deque[Any] = deque()
        self.failed = optuna.trial.TrialState.FAIL

    def _stop(self) -> None:
        self.has_stopped = True

    def ask(self, n: int) -> _Array:
        n = 0 if self.has_stopped else n
        trials = [self.study.ask(dict(self.distributions)) for _ in range(n)]
        self.trials.extend(trials)
        # The middle of the part of a coordinate that means a level.
        unit = [[(value + 0.5) / count if count else value for value, count in zip(trial.params.values(), self.levels)] for trial in trials]
        return np.array(unit, dtype=float).reshape(n, len(self.levels))

    def tell(self, points: _Array, robustness: _Array) -> None:
        for value in robustness:
            trial = self.trials.popleft()
            if np.isnan(value):
                self.study.tell(trial, state=self.failed)
            else:
                self.study.tell(trial, float(value))


class Asked:
    """A strategy at work.

    It is asked for as many points as its `popsize`, or else as the campaign wants, and is told the results of all of them together before it is asked
    again: searches such as CMA-ES need whole generations.
    """

    def __init__(self, search: Any, dims: int) -> None:
        self.search = search
        self.dims = dims
        popsize = getattr(search, "popsize", None)
        self.popsize = int(popsize) if isinstance(popsize, (int, np.integer)) and popsize > 0 else None
        self.points: _Array = np.empty((0, dims))
        self.results: _Array = np.empty(0)
        self.handed = 0
        self.has_begun = False
        self.waiting: set[int] = set()

    def ask(self, n: int) -> tuple[int, _Array]:
        """Returns at most `n` points, and the number of the first of them in the last batch of the search. There are no points while results of the
        batch are missing."""
        if self.handed == len(self.points) and not self.waiting:
            self._next(self.popsize or n)
        first, self.handed = self.handed, min(self.handed + n, len(self.points))
        return first, self.points[first : self.handed]

    def _next(self, n: int) -> None:
        asked = self.search.ask(n)
        if np.ma.is_masked(asked) or np.iscomplexobj(asked):
            raise Error(f"ask({n}) returned complex or masked numbers, expected real numbers from 0 to 1")
        points: _Array = np.array(asked, dtype=float)
        if points.size == 0 and not self.has_begun:
            raise Error(f"ask({n}) returned no points, expected at least one")
        if points.size == 0:
            points = points.reshape(0, self.dims)
        self.has_begun = True
        if points.ndim != 2 or points.shape[1] != self.dims:
            raise Error(f"ask({n}) returned an array of the shape {points.shape}, expected ({n}, {self.dims}): a row for each point")
        if len(points) > n:
            raise Error(f"ask({n}) returned {len(points)} points, expected at most {n}: give the study batch={len(points)}")
        wrong = ~((points >= 0.0) & (points <= 1.0))
        if wrong.any():
            row, column = np.argwhere(wrong)[0]
            raise Error(
                f"ask({n}) returned {points[row, column]} as coordinate {column + 1} of point {row + 1}, expected a number from 0 to 1: give the search the "
                "bounds 0 and 1 in each coordinate"
            )
        self.points, self.results, self.handed = points, np.full(len(points), np.nan), 0
        self.waiting = set(range(len(points)))

    def all(self, n: int) -> _Array:
        """Returns `n` points of a search that learns nothing from them."""
        parts = [self.ask(n)[1]]
        while 0 < sum(map(len, parts)) < n and len(parts[-1]):
            self.waiting.clear()
            parts.append(self.ask(n - sum(map(len, parts)))[1])
        return np.concatenate(parts)

    def tell(self, numbers: list[int], robustness: list[float]) -> None:
        """Takes results by the numbers of the points in the last batch of the search. NaN stands for a test without a result."""
        for number, value in zip(numbers, robustness):
            self.results[number] = value
            self.waiting.discard(number)
        if not self.waiting and len(self.points):
            self.search.tell(self.points, self.results)
