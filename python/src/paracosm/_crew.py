"""A crew: it gives the tests of a campaign to an executor, in parts, and collects the trials."""

import concurrent.futures
import math
import os
import time
from collections import deque
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import dataclass, field
from typing import Any

from ._core import Error, Study
from ._parcels import Packed, packed
from ._station import Ran, run_part

# The seconds that a part of a campaign should take: much more than an executor needs to hand it over, and little enough that all workers end together.
_PART = 0.3
# The parts for each worker that run or wait in the executor, so that no worker waits for this process.
_AHEAD = 3
# The seconds between two looks whether the campaign should end.
_LOOK = 0.05


class Crew:
    """Runs the tests of a study with an executor of `concurrent.futures`, or with a client of Dask."""

    def __init__(self, study: Study, executor: Any) -> None:
        self.executor, self._count = _executor(executor)
        # An executor that was closed should be an error before the campaign begins.
        self.workers()
        self.packed: Packed = packed(study, getattr(executor, "pickler", None))
        self.pace = _Pace()

    def workers(self) -> int:
        """Returns the number of tests that run at the same time. Machines may come and go."""
        try:
            return max(self._count(), 1)
        except Exception as error:
            raise Error(f"the executor does not answer, perhaps because it was closed: {type(error).__name__}: {error}") from None

    def begin(self, first: int, tests: list[str]) -> "_Batch":
        """Begins tests, of which the first has the index `first`."""
        return _Batch(self, first, tests)


def _executor(given: Any) -> tuple[concurrent.futures.Executor, Callable[[], int]]:
    """Returns an executor, and a function that returns the number of its workers."""
    if hasattr(given, "get_executor") and hasattr(given, "nthreads"):
        # Dask takes two calls with the same arguments for one unless it is told otherwise.
        return given.get_executor(pure=False), lambda: sum(given.nthreads().values())
    if not isinstance(given, concurrent.futures.Executor):
        raise Error(f"executor is {given!r}, expected a number of tests, an executor of concurrent.futures, a client of Dask, or a paracosm.ray.Executor")
    # The number of workers of an executor that was closed may be an error, so nobody asks for it here.
    if hasattr(type(given), "workers") or "workers" in getattr(given, "__dict__", {}):
        return given, lambda: int(getattr(given, "workers"))  # noqa: B009
    known = getattr(given, "_max_workers", None) or os.cpu_count() or 1
    return given, lambda: known


@dataclass
class _Part:
    """Tests in a row that one worker runs."""

    first: int
    tests: list[str]
    wanted: list[str] = field(default_factory=list)
    """The hashes of what the worker lacks."""

    def __str__(self) -> str:
        last = self.first + len(self.tests) - 1
        return f"test {self.first}" if last == self.first else f"tests {self.first} to {last}"


class _Pace:
    """How long a test takes: the mean of all tests, in which the latest count most."""

    def __init__(self) -> None:
        self.seconds: float | None = None

    def learn(self, tests: int, seconds: float) -> None:
        each = seconds / tests
        self.seconds = each if self.seconds is None else 0.8 * self.seconds + 0.2 * each

    def tests(self, left: int, workers: int) -> int:
        """Returns the number of tests of the next part: less towards the end, so that all workers end together."""
        if self.seconds is None:
            return 1
        return max(1, min(int(_PART / max(self.seconds, 1e-9)), math.ceil(left / (2 * workers))))


class _Batch:
    """Tests that the strategy has proposed together."""

    def __init__(self, crew: Crew, first: int, tests: list[str]) -> None:
        self._crew = crew
        self._first, self._tests = first, tests
        self._begun = 0
        self._again: deque[_Part] = deque()
        self._running: dict[Future[Any], _Part] = {}
        self._workers, self._looked = 1, -math.inf
        self._broken: Error | None = None

    def results(self) -> list[tuple[list[str], str]] | None:
        """Returns the parts that have come after a short time: trials, as lines of the log, and errors that did not repeat. `None` if all have come."""
        if self._broken is not None:
            raise self._broken
        self._submit()
        if not self._running:
            return None
        wait(self._running, timeout=_LOOK, return_when=FIRST_COMPLETED)
        # A future that somebody else has cancelled is done, but `wait` does not know.
        done = [future for future in self._running if future.done()]
        parts: list[tuple[list[str], str]] = []
        for future in done:
            try:
                parts += self._taken(future)
            except Error as error:
                # The trials that have come with the error count.
                self._broken = self._broken or error
        return parts

    def cancel(self) -> None:
        """Lets go of the tests that have not come."""
        for future in self._running:
            future.cancel()

    def _submit(self) -> None:
        # Each part would ask for the study and its files before the first part has brought them.
        ahead = 1 if self._crew.pace.seconds is None else _AHEAD
        while len(self._running) < ahead * self._present() and (part := self._next()) is not None:
            packed = self._crew.packed
            try:
                future = self._crew.executor.submit(run_part, packed.parcel, part.first, part.tests, packed.contents(part.wanted))
            except RuntimeError as error:
                raise _failed(part, error) from error
            self._running[future] = part

    def _present(self) -> int:
        if time.monotonic() - self._looked > 1.0:
            self._workers, self._looked = self._crew.workers(), time.monotonic()
        return self._workers

    def _next(self) -> _Part | None:
        if self._again:
            return self._again.popleft()
        left = len(self._tests) - self._begun
        if left == 0:
            return None
        begun = self._begun
        self._begun += self._crew.pace.tests(left, self._workers)
        return _Part(self._first + begun, self._tests[begun : self._begun])

    def _taken(self, future: Future[Any]) -> list[tuple[list[str], str]]:
        part = self._running.pop(future)
        try:
            error = future.exception()
        except concurrent.futures.CancelledError:
            raise Error(f"{part}: the executor has cancelled them") from None
        # A worker may have been interrupted, which does not interrupt this process.
        if error is not None:
            raise _failed(part, error) from None
        ran: Ran = future.result()
        if ran.missing:
            # The next process may lack something else.
            part.wanted = sorted({*part.wanted, *ran.missing})
            self._again.append(part)
            return []
        self._crew.pace.learn(len(part.tests), ran.seconds)
        return [(ran.lines, ran.recovered)]


def _failed(part: _Part, error: BaseException) -> Error:
    """Returns the error that an executor ran no tests."""
    # Ray wraps what a worker raises.
    cause = getattr(error, "cause", None) or error
    why = str(cause) if isinstance(cause, Error) else ": ".join(word for word in (type(cause).__name__, str(cause)) if word)
    return Error(f"{part}: the executor failed: {why}")
