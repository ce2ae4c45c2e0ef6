"""Every strategy of this package as a sampler of Optuna. It needs optuna.

    >>> import optuna
    >>> from paracosm.optuna import Sampler
    >>> study = optuna.create_study(sampler=Sampler("bayes", seed=1))

A value below 0 counts as a failure, which the searches of this package look for. If the study maximises, the strategy gets the negative of each value.
"""

import math
import threading
import warnings
from collections.abc import Mapping, Sequence
from typing import Any

import optuna
from optuna.distributions import BaseDistribution, CategoricalDistribution, FloatDistribution, IntDistribution
from optuna.samplers import BaseSampler, RandomSampler
from optuna.study import Study, StudyDirection
from optuna.trial import FrozenTrial, TrialState

from ._core import Error, Generator, Space
from .parameters import Choice, Interval

__all__ = ["Sampler"]

# A parameter with at most so many values is discrete for the strategies.
_MOST_LEVELS = 100


class Sampler(BaseSampler):
    """A strategy of this package, with the given budget of trials and the given seed.

    The strategy proposes the values of all parameters in `search_space`, a dictionary from names to distributions. Without it, these are the parameters
    of the first trial that is complete, which is random. `independent_sampler` proposes the values of other parameters, such as those that only some
    trials have. A study that has trials already tells the strategy their values, and a point that a trial has had is not proposed again. Make a sampler for
    each study.
    """

    def __init__(
        self,
        method: str = "auto",
        *,
        budget: int = 500,
        seed: int | None = None,
        search_space: Mapping[str, BaseDistribution] | None = None,
        independent_sampler: BaseSampler | None = None,
    ) -> None:
        # A mistake in the choices is an error here, and not in the first trial.
        Generator(2, method, budget=budget, seed=seed)
        self._choices: dict[str, Any] = {"method": method, "budget": budget, "seed": seed}
        self._known = None if search_space is None else _varied(search_space)
        self._independent = independent_sampler or RandomSampler(seed=seed or 0)
        self._generator: Generator | None = None
        self._proposed: dict[int, tuple[Any, dict[str, Any]]] = {}
        self._had: set[tuple[Any, ...]] = set()
        self._study_name: str | None = None
        self._lock = threading.Lock()

    def __getstate__(self) -> dict[str, Any]:
        """Leaves out what belongs to this process: a copy learns again from the trials of its study."""
        return {**self.__dict__, "_generator": None, "_proposed": {}, "_had": set(), "_study_name": None, "_lock": None}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._lock = threading.Lock()

    def reseed_rng(self) -> None:
        """Does nothing for the strategy, whose threads share one generator."""
        self._independent.reseed_rng()

    def infer_relative_search_space(self, study: Study, trial: FrozenTrial) -> dict[str, BaseDistribution]:
        """Returns the parameters whose values the strategy proposes."""
        with self._lock:
            if self._study_name not in (None, study.study_name):
                raise Error(f"the sampler belongs to the study {self._study_name}: make another sampler for the study {study.study_name}")
            self._study_name = study.study_name
            if not self._known:
                complete = study.get_trials(deepcopy=False, states=(TrialState.COMPLETE,))
                self._known = next((varied for varied in (_varied(one.distributions) for one in complete) if varied), None)
            return dict(self._known or {})

    def sample_relative(self, study: Study, trial: FrozenTrial, search_space: dict[str, BaseDistribution]) -> dict[str, Any]:
        """Returns the values that the strategy proposes."""
        if not search_space:
            return {}
        if len(study.directions) != 1:
            raise Error(f"the study has {len(study.directions)} objectives, expected one")
        with self._lock:
            if self._generator is None:
                self._generator = self._begun(study, search_space)
            while True:
                test = self._generator.ask(1)
                if len(test) == 0:
                    warnings.warn(f"the strategy {self._generator.method} has no more tests: the independent sampler goes on", stacklevel=2)
                    return {}
                values = {name: _value(one, test[0][name]) for name, one in search_space.items()}
                # An earlier run of the study may have had the point. Later, the strategy itself decides whether it proposes a point twice.
                if tuple(values.values()) not in self._had:
                    break
                self._had.discard(tuple(values.values()))
            self._proposed[trial.number] = (test, values)
            return values

    def sample_independent(self, study: Study, trial: FrozenTrial, param_name: str, param_distribution: BaseDistribution) -> Any:
        """Returns a value of a parameter that the strategy does not know."""
        return self._independent.sample_independent(study, trial, param_name, param_distribution)

    def after_trial(self, study: Study, trial: FrozenTrial, state: TrialState, values: Sequence[float] | None) -> None:
        """Tells the strategy the value of a trial."""
        with self._lock:
            test, proposed = self._proposed.pop(trial.number, (None, {}))
            if self._generator is None or not self._known:
                return
            # The trial may be of another sampler, and the user may have set other values than the proposed ones.
            if test is None or any(trial.params.get(name) != value for name, value in proposed.items()):
                if not _fits(self._known, trial):
                    return
                test = _test(self._known, trial.params)
            self._generator.tell(test, [_robustness(study, state, values)])

    def _begun(self, study: Study, search_space: Mapping[str, BaseDistribution]) -> Generator:
        """Begins the strategy, and tells it all trials that have ended before."""
        generator = Generator(_space(search_space), **self._choices)
        for past in study.get_trials(deepcopy=False):
            if not _fits(search_space, past):
                continue
            self._had.add(tuple(past.params[name] for name in search_space))
            if past.state == TrialState.COMPLETE:
                generator.tell(_test(search_space, past.params), [_robustness(study, past.state, past.values)])
        return generator


def _fits(search_space: Mapping[str, BaseDistribution], trial: FrozenTrial) -> bool:
    """Returns whether a trial has all parameters of the search space with the same distributions."""
    return all(trial.distributions.get(name) == one for name, one in search_space.items())


def _robustness(study: Study, state: TrialState, values: Sequence[float] | None) -> float:
    if state != TrialState.COMPLETE or not values:
        return math.nan
    return -values[0] if study.direction == StudyDirection.MAXIMIZE else values[0]


def _varied(distributions: Mapping[str, BaseDistribution]) -> dict[str, BaseDistribution]:
    return {name: one for name, one in sorted(distributions.items()) if not one.single()}


def _levels(distribution: BaseDistribution) -> int | None:
    """Returns the number of values of a discrete parameter; `None` if the parameter is continuous for the strategies."""
    if isinstance(distribution, CategoricalDistribution):
        return len(distribution.choices)
    if isinstance(distribution, (FloatDistribution, IntDistribution)) and distribution.step is not None and not distribution.log:
        count = int((distribution.high - distribution.low) / distribution.step + 1.5)
        return count if count <= _MOST_LEVELS else None
    return None


def _space(distributions: Mapping[str, BaseDistribution]) -> Space:
    """Makes a space of the positions of values: a number from 0 to 1, or the number of a level."""
    parameters: dict[str, Interval | Choice] = {}
    for name, one in distributions.items():
        levels = _levels(one)
        parameters[name] = Interval(0.0, 1.0) if levels is None else Choice(list(range(levels)))
    return Space(parameters)


def _bounds(distribution: BaseDistribution) -> tuple[float, float]:
    """Returns the least and the greatest number that is rounded to a value, or its logarithm."""
    assert isinstance(distribution, (FloatDistribution, IntDistribution))
    # Each whole number gets an interval of the same width.
    half = 0.5 * (distribution.step or 0.0)
    low, high = distribution.low - half, distribution.high + half
    return (math.log(low), math.log(high)) if distribution.log else (low, high)


def _value(distribution: BaseDistribution, position: Any) -> Any:
    """Returns the value at a position."""
    if isinstance(distribution, CategoricalDistribution):
        return distribution.choices[int(position)]
    assert isinstance(distribution, (FloatDistribution, IntDistribution))
    step = distribution.step
    if _levels(distribution) is not None and step is not None:
        found: float = distribution.low + int(position) * step
    else:
        low, high = _bounds(distribution)
        found = low + position * (high - low)
        found = math.exp(found) if distribution.log else found
        if step is not None:
            found = distribution.low + round((found - distribution.low) / step) * step
    found = min(max(found, distribution.low), distribution.high)
    return int(found) if isinstance(distribution, IntDistribution) else found


def _test(distributions: Mapping[str, BaseDistribution], values: Mapping[str, Any]) -> dict[str, list[float]]:
    """Returns the positions of values, as a table with one row."""
    return {name: [_position(one, values[name])] for name, one in distributions.items()}


def _position(distribution: BaseDistribution, value: Any) -> float:
    if isinstance(distribution, CategoricalDistribution):
        return float(distribution.choices.index(value))
    assert isinstance(distribution, (FloatDistribution, IntDistribution))
    if _levels(distribution) is not None and distribution.step is not None:
        return float(round((value - distribution.low) / distribution.step))
    low, high = _bounds(distribution)
    at = math.log(value) if distribution.log else value
    return float(min(max((at - low) / (high - low), 0.0), 1.0))
