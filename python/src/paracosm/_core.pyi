"""The types of the compiled module. Its documentation is in the module itself: `help(paracosm.sample)`."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Literal, TypedDict, final, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import Unpack

from .parameters import Choice, Interval

_Domain = Interval | Choice | tuple[float, float] | list[Any]

__all__ = [
    "Bracket",
    "CoveringArray",
    "Error",
    "Evaluation",
    "Formula",
    "Generator",
    "Report",
    "Space",
    "Study",
    "Table",
    "Tests",
    "Trace",
    "Trial",
    "cover",
    "coverage",
    "covering_array",
    "fuzz",
    "load",
    "measure",
    "measures",
    "plan",
    "sample",
    "strategies",
]

class Error(ValueError): ...

@final
class Space:
    def __new__(
        cls,
        parameters: Mapping[str, _Domain],
        constraints: Sequence[str] = ...,
    ) -> Space: ...
    @classmethod
    def cube(cls, dims: int, /) -> Space: ...
    @classmethod
    def read(cls, path: str | PathLike[str], /) -> Space: ...
    @property
    def names(self) -> list[str]: ...
    @property
    def constraints(self) -> list[str]: ...
    @property
    def dims(self) -> int: ...
    @property
    def levels(self) -> list[int]: ...
    def __eq__(self, other: object, /) -> bool: ...
    @classmethod
    def _of_json(cls, text: str) -> Space: ...
    def __reduce__(self) -> tuple[Any, tuple[str]]: ...
    def __len__(self) -> int: ...

class Table:
    @property
    def columns(self) -> list[str]: ...
    def __len__(self) -> int: ...
    @overload
    def __getitem__(self, key: str, /) -> NDArray[Any]: ...
    @overload
    def __getitem__(self, key: int, /) -> dict[str, float | int | str | None]: ...
    def __iter__(self) -> Iterator[dict[str, float | int | str | None]]: ...
    def __arrow_c_stream__(self, requested_schema: object = None) -> object: ...
    def to_pandas(self) -> Any: ...
    def to_polars(self) -> Any: ...

class Tests(Table):
    @property
    def space(self) -> Space: ...

@final
class CoveringArray(Tests):
    @property
    def k(self) -> int: ...
    @property
    def lower_bound(self) -> int: ...
    @property
    def kept(self) -> int: ...

@final
class Bracket:
    @property
    def lower(self) -> float: ...
    @property
    def upper(self) -> float: ...
    @property
    def exact(self) -> bool: ...
    @property
    def box(self) -> dict[str, tuple[float, float]] | None: ...
    @property
    def fixed(self) -> dict[str, float | int | str] | None: ...
    @property
    def centre(self) -> dict[str, float] | None: ...
    def __float__(self) -> float: ...

@final
class Generator:
    def __new__(
        cls,
        space: Space | int,
        method: str = "auto",
        *,
        budget: int = 500,
        seed: int | None = None,
        skip: int | None = None,
        k: int | None = None,
        epsilon: float | None = None,
        measure: Literal["dispersion", "k-wise-dispersion"] | None = None,
        discrete: Literal["ipog", "random", "cross"] = "ipog",
        delta: float | None = None,
        existing: Any = None,
    ) -> Generator: ...
    @property
    def method(self) -> str: ...
    def ask(self, n: int = 1) -> Any: ...
    def tell(self, tests: Any, robustness: Sequence[float | None] | ArrayLike) -> None: ...

@final
class Trace:
    def __new__(cls, signals: Any, *, complete: bool = True) -> Trace: ...
    @property
    def signals(self) -> list[str]: ...
    @property
    def columns(self) -> list[str]: ...
    @property
    def dt(self) -> float: ...
    @property
    def complete(self) -> bool: ...
    @property
    def hash(self) -> str: ...
    def __len__(self) -> int: ...
    def __getitem__(self, name: str, /) -> NDArray[np.float64]: ...
    def to_dict(self) -> dict[str, NDArray[np.float64]]: ...

@final
class Evaluation:
    @property
    def truth(self) -> bool | None: ...
    @property
    def robustness(self) -> float: ...
    @property
    def lower(self) -> float: ...
    @property
    def upper(self) -> float: ...
    @property
    def cause(self) -> tuple[float, str] | None: ...

@final
class Formula:
    def __new__(cls, text: str, /) -> Formula: ...
    @property
    def signals(self) -> list[str]: ...
    @property
    def horizon(self) -> float: ...
    def evaluate(self, trace: Any, *, dense: bool = False) -> Evaluation: ...
    def robustness(self, trace: Any, *, dense: bool = False) -> float: ...

class _Choices(TypedDict, total=False):
    spec: str | Sequence[str] | None
    dense: bool | None
    requirements: str | PathLike[str] | None
    strategy: str | None
    budget: int | None
    seed: int | None
    skip: int | None
    k: int | None
    epsilon: float | None
    discrete: Literal["ipog", "random", "cross"] | None
    delta: float | None
    measure: Literal["dispersion", "k-wise-dispersion"] | None
    batch: int | None
    stop_at_first: bool | None

class _ScenarioChoices(_Choices, total=False):
    driver: str | None
    driver_command: str | None
    driver_settings: Mapping[str, float] | None
    open: Mapping[str, _Domain | None] | Sequence[str] | None
    fix: Mapping[str, float | str | Sequence[float] | Sequence[str]] | None
    vehicle: str | None
    vehicle_settings: Mapping[str, float] | None
    references: Sequence[str] | None
    timeout: float | None

class _Replaced(_ScenarioChoices, total=False):
    scenario: str

@final
class Study:
    def __new__(
        cls,
        scenario: str = "pedestrian-crossing",
        **choices: Unpack[_ScenarioChoices],
    ) -> Study: ...
    @classmethod
    def of_function(
        cls,
        function: Callable[[Any], Any],
        space: Space | int,
        *,
        name: str | None = None,
        **choices: Unpack[_Choices],
    ) -> Study: ...
    def replace(
        self,
        **choices: Unpack[_Replaced],
    ) -> Study: ...
    @property
    def scenario(self) -> str: ...
    @property
    def choices(self) -> dict[str, Any]: ...
    @property
    def space(self) -> Space: ...
    @property
    def requirements(self) -> list[str]: ...
    def run(
        self,
        folder: str | PathLike[str],
        *,
        executor: int | None = None,
        resume: bool = False,
        locate: int | None = None,
        junit: bool = False,
        progress: Callable[[int, int], object] | None = None,
    ) -> Report: ...
    def __reduce__(self) -> tuple[Any, tuple[()]]: ...
    def likelihood(
        self,
        *,
        method: Literal["monte-carlo", "qmc", "subset"] = "monte-carlo",
        budget: int = 1000,
        confidence: float = 0.95,
        seed: int = 0,
        executor: int | None = None,
    ) -> dict[str, Any]: ...

@final
class Report:
    @property
    def folder(self) -> Path: ...
    @property
    def verdicts(self) -> dict[str, int]: ...
    @property
    def trials(self) -> Table: ...
    @property
    def failures(self) -> list[Trial]: ...
    @property
    def worst(self) -> Trial | None: ...
    @property
    def coverage(self) -> dict[str, Any]: ...
    @property
    def modes(self) -> dict[str, Any]: ...
    @property
    def explanation(self) -> dict[str, Any] | None: ...
    @property
    def effects(self) -> dict[str, Any] | None: ...
    def blame(self, drivers: Sequence[str] | None = None, *, executor: int | None = None) -> dict[str, Any]: ...
    def diff(self, after: Report, /) -> dict[str, Any]: ...
    def page(self, path: str | PathLike[str], *, max_mb: float = 8.0) -> None: ...
    def __len__(self) -> int: ...
    def __getitem__(self, index: int, /) -> Trial: ...
    def _repr_html_(self) -> str: ...

@final
class Trial:
    @property
    def index(self) -> int: ...
    @property
    def test(self) -> dict[str, float | int | str | list[float] | list[str]]: ...
    @property
    def verdict(self) -> str: ...
    @property
    def robustness(self) -> dict[str, float | None]: ...
    @property
    def error(self) -> str | None: ...
    @property
    def trace_hash(self) -> str | None: ...
    def shrink(self, *, same_mode: bool = False, budget: int | None = None) -> dict[str, Any]: ...
    def replay(self) -> Trace: ...

def load(folder: str | PathLike[str], *, trust: bool = False) -> Report: ...
def measures() -> list[tuple[str, str]]: ...
def measure(
    name: str, tests: Any, space: Space | None = None, *, k: int | None = None, time_limit: float | None = None
) -> Bracket: ...
def coverage(
    tests: Any,
    space: Space | None = None,
    *,
    k: int | None = None,
    measures: Sequence[str] | None = None,
    time_limit: float | None = None,
) -> dict[str, Any]: ...
def strategies() -> list[tuple[str, str, bool]]: ...
@overload
def sample(
    space: int,
    n: int | None = None,
    *,
    method: str = "halton",
    seed: int | None = None,
    skip: int | None = None,
    k: int | None = None,
    epsilon: float | None = None,
    measure: Literal["dispersion", "k-wise-dispersion"] | None = None,
    discrete: Literal["ipog", "random", "cross"] = "ipog",
    delta: float | None = None,
    existing: Any = None,
    time_limit: float | None = None,
) -> NDArray[np.float64]: ...
@overload
def sample(
    space: Space,
    n: int | None = None,
    *,
    method: str = "halton",
    seed: int | None = None,
    skip: int | None = None,
    k: int | None = None,
    epsilon: float | None = None,
    measure: Literal["dispersion", "k-wise-dispersion"] | None = None,
    discrete: Literal["ipog", "random", "cross"] = "ipog",
    delta: float | None = None,
    existing: Any = None,
    time_limit: float | None = None,
) -> Tests: ...
def covering_array(
    space: Space,
    k: int | None = None,
    *,
    strengths: Mapping[tuple[str, ...], int] | None = None,
    seed: int = 0,
    optimise: float | None = None,
    existing: Any = None,
) -> CoveringArray: ...
def plan(
    space: Space, k: int | None = None, *, epsilon: float = 0.1, delta: float = 0.05, time_limit: float = 60.0
) -> dict[str, Any]: ...
def fuzz(words: Sequence[str], /) -> int: ...
def cover(words: Sequence[str], /) -> int: ...
