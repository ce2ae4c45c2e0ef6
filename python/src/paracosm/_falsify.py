"""Falsification of a function of Python in one call."""

import tempfile
from collections.abc import Callable, Sequence
from os import PathLike
from typing import Any

from ._core import Report, Space, Study

# The folders of campaigns that nobody asked to keep. Each is removed when the process ends.
_folders: list[tempfile.TemporaryDirectory[str]] = []


def falsify(
    function: Callable[[Any], Any],
    space: Space | int,
    *,
    spec: str | Sequence[str] | None = None,
    strategy: object = "auto",
    budget: int = 300,
    seed: int | None = None,
    stop_at_first: bool = False,
    executor: object = 1,
    folder: str | PathLike[str] | None = None,
    **choices: Any,
) -> Report:
    """Searches the space for tests that violate a requirement of a function, and returns the report of the campaign.

    The function gets each test as a dictionary, or as an array if `space` is a number of dimensions. It returns a robustness (below 0 for a
    failure), a dictionary with a robustness for each requirement, or a trace for `spec` to judge. `Study.of_function` says more. `executor` is the number of threads
    that call it at the same time, or an executor as for `Study.run`. Without `folder`, the campaign lies in a temporary folder, which is removed when the process ends.
    """
    study = Study.of_function(
        function, space, spec=spec, strategy=strategy, budget=budget, seed=seed, stop_at_first=stop_at_first, **choices
    )
    if folder is None:
        _folders.append(tempfile.TemporaryDirectory(prefix="paracosm-"))
        folder = f"{_folders[-1].name}/out"
    return study.run(folder, executor=executor)
