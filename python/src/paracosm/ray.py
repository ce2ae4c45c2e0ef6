"""An executor that runs the tests of a campaign on the machines of a Ray cluster. It needs ray.

    >>> import paracosm as pc
    >>> from paracosm import ray
    >>> study = pc.Study("cut-in", strategy="halton", budget=2000)
    >>> report = study.run("out", executor=ray.Executor("auto"))

This process asks the strategy, and writes the folder; the workers only run tests. So the folder is the folder of a run on one machine, byte for byte. All machines need the same version
of paracosm. A scenario or a driver of Python travels with the study, and so do the files that the study names.
"""

import concurrent.futures
import math
import threading
import time
import warnings
import weakref
from collections import deque
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from dataclasses import dataclass, field
from importlib import import_module
from queue import Empty, SimpleQueue
from typing import Any, ParamSpec, TypeVar

from ._core import Error

__all__ = ["Executor"]

_P = ParamSpec("_P")
_R = TypeVar("_R")

# A worker has its next call before it has ended the present one, so it never waits for this process.
_IN_FLIGHT = 2
# The seconds after which the user is told that calls wait for a first worker.
_PATIENCE = 10.0

# The number of executors that use the connection of this process to a cluster, if an executor has made the connection.
_users = 0
_address: str | None = None
_connecting = threading.Lock()


@dataclass(eq=False)
class _Call:
    """A call that was submitted."""

    future: Future[Any]
    function: Callable[..., Any]
    args: tuple[Any, ...]
    kwargs: dict[str, Any]
    deaths: int = 0
    """The number of workers that died while they made the call."""


class Executor(concurrent.futures.Executor):
    """Calls functions on the workers of a Ray cluster, as any executor of `concurrent.futures` does.

    `address` is the address of a cluster, as `ray.init` takes it: `"auto"` is the cluster of this machine. Without it, the cluster counts to which this process is connected, or that
    RAY_ADDRESS names, or that was started on this machine; if there is none, Ray starts on this machine alone. `cpus` and `gpus` are what a worker takes of a machine; each worker runs one test at a time. A call whose worker
    or machine dies is made again, up to `retries` times. `runtime_env` is the environment of the workers, as Ray takes it.

    The executor has a worker for each place in the cluster, also of machines that come later, until `shutdown`. Workers are actors of Ray: Ray gives the tasks of another machine
    a new place twice a second, and this took a tenth of the time.
    """

    pickler = "ray.cloudpickle"

    def __init__(
        self, address: str | None = None, *, cpus: float = 1, gpus: float = 0, retries: int = 5, runtime_env: Mapping[str, Any] | None = None
    ) -> None:
        if not (isinstance(cpus, (int, float)) and 0 < cpus < math.inf):
            raise Error(f"cpus is {cpus!r}, expected a number above 0")
        if not (isinstance(gpus, (int, float)) and 0 <= gpus < math.inf):
            raise Error(f"gpus is {gpus!r}, expected a number from 0 on")
        if not (isinstance(retries, int) and retries >= 0):
            raise Error(f"retries is {retries!r}, expected a whole number from 0 on")
        try:
            self._ray: Any = import_module("ray")
        except ModuleNotFoundError:
            raise Error("the executor needs the package ray: pip install 'paracosm[ray]'") from None
        connection = _Connection(self._ray, _connected(self._ray, address))
        try:
            self._crew = _Crew(connection, {"num_cpus": cpus, "num_gpus": gpus, "runtime_env": dict(runtime_env or {})}, retries)
        except BaseException:
            connection.leave()
            raise
        # An executor that nobody holds any more gives its workers back.
        weakref.finalize(self, self._crew.close, False).atexit = False

    @property
    def workers(self) -> int:
        """The number of workers for which the cluster has room."""
        return max(self._crew.places(), 1)

    def submit(self, fn: Callable[_P, _R], /, *args: _P.args, **kwargs: _P.kwargs) -> Future[_R]:
        future: Future[_R] = Future()
        self._crew.submit(_Call(future, fn, args, kwargs))
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Ends the workers once they have made all calls, and leaves the cluster if an executor has connected this process to it. With `cancel_futures`, calls that no worker has yet are not made."""
        self._crew.close(cancel_futures)
        if wait:
            self._crew.join()


@dataclass
class _Connection:
    """The connection of this process to a cluster, and whether an executor has made it."""

    ray: Any
    is_user: bool

    def leave(self) -> None:
        """Disconnects this process from its cluster if no other executor uses the connection that an executor has made."""
        global _users
        with _connecting:
            if self.is_user:
                self.is_user = False
                _users -= 1
                if _users == 0:
                    self.ray.shutdown()


def _connected(ray: Any, address: str | None) -> bool:
    """Connects this process to a cluster unless it is connected. Returns whether an executor has made the connection."""
    global _users, _address
    with _connecting:
        if not ray.is_initialized():
            try:
                ray.init(address=address, log_to_driver=False)
            except Exception as error:
                raise Error(f"cannot connect to the cluster{f' {address}' if address else ''}: {type(error).__name__}: {error}") from None
            _users, _address = 0, address
        elif address is not None and (_users == 0 or address != _address):
            raise Error(f"address is {address}, but this process is connected to a cluster already: leave the address out, or call ray.shutdown() before")
        elif _users == 0:
            return False
        _users += 1
        return True


@dataclass
class _Come:
    """A worker has come, or cannot come."""

    worker: Any
    error: BaseException | None


@dataclass
class _Made:
    """A call was made, or its worker has died."""

    worker: Any
    call: _Call
    result: Any
    error: BaseException | None


@dataclass
class _Close:
    """No further calls are submitted."""

    cancels: bool


@dataclass
class _Crew:
    """The workers of an executor. A thread of its own gives calls to them: Ray reports results in threads that must not call Ray and wait."""

    connection: _Connection
    options: dict[str, Any]
    retries: int
    events: SimpleQueue[Any] = field(default_factory=SimpleQueue)
    waiting: deque[_Call] = field(default_factory=deque)
    coming: list[Any] = field(default_factory=list)
    there: dict[Any, deque[_Call]] = field(default_factory=dict)
    """The calls of each worker, the oldest first."""
    is_open: bool = True
    has_told: bool = False
    failed_starts: int = 0

    def __post_init__(self) -> None:
        self.ray = self.connection.ray
        self.make = self.ray.remote(**self.options)(_Worker)
        # The executor may be let go of while this thread holds the lock.
        self.lock = threading.RLock()
        if not any(self._fits(node) for node in self._nodes()):
            self._tell("no machine of the cluster has room for it. Give a smaller `cpus` or `gpus`, unless machines come later")
        self.looked = -math.inf
        self.thread = threading.Thread(target=self._run, name="paracosm-ray", daemon=True)
        self.thread.start()

    def places(self) -> int:
        """Returns the number of workers for which the machines have room."""
        return sum(self._fits(node) for node in self._nodes())

    def submit(self, call: _Call) -> None:
        with self.lock:
            if not self.is_open:
                raise RuntimeError("the executor was shut down")
            self.events.put(call)

    def close(self, cancels: bool) -> None:
        with self.lock:
            self.is_open = False
            self.events.put(_Close(cancels))

    def join(self) -> None:
        """Waits until all calls were made."""
        self.thread.join()

    def _nodes(self) -> list[dict[str, float]]:
        """Returns what each machine has."""
        return [node["Resources"] for node in self.ray.nodes() if node["Alive"]]

    def _fits(self, node: dict[str, float]) -> int:
        """Returns the number of workers for which a machine has room."""
        wanted = [("CPU", self.options["num_cpus"]), ("GPU", self.options["num_gpus"])]
        return min(int(node.get(name, 0) / number + 1e-9) for name, number in wanted if number > 0)

    def _tell(self, why: str) -> None:
        cpus, gpus = self.options["num_cpus"], self.options["num_gpus"]
        takes = f"{cpus} CPUs" + (f" and {gpus} GPUs" if gpus else "")
        most = max((node.get("CPU", 0) for node in self._nodes()), default=0)
        free = self.ray.available_resources().get("CPU", 0)
        self.has_told = True
        warnings.warn(f"a worker takes {takes}, the largest machine has {most:g} CPUs, and {free:g} CPUs of the cluster are free: {why}", RuntimeWarning, stacklevel=4)

    def _run(self) -> None:
        try:
            self._serve()
        except BaseException as error:
            # Nobody would ever make the calls: the connection may be lost.
            with self.lock:
                self.is_open = False
            calls = [*self.waiting, *(call for calls in self.there.values() for call in calls)]
            while not self.events.empty():
                event = self.events.get()
                calls += [event] if isinstance(event, _Call) else []
            for call in calls:
                if call.future.running() or call.future.set_running_or_notify_cancel():
                    call.future.set_exception(Error(f"the connection to the cluster broke: {type(error).__name__}: {error}"))
        finally:
            self.connection.leave()

    def _serve(self) -> None:
        """Answers events until no calls are left."""
        is_closing = False
        while not is_closing or self.waiting or any(self.there.values()):
            try:
                event = self.events.get(timeout=_PATIENCE)
            except Empty:
                if self.waiting and not self.there and not self.has_told:
                    self._tell("no worker has come yet. Perhaps other work has the room, or another executor of this process")
                event = None
            match event:
                case _Call():
                    self.waiting.append(event)
                case _Come():
                    self._come(event)
                case _Made():
                    self._made(event)
                case _Close():
                    is_closing = True
                    if event.cancels:
                        self._cancel()
            if self.waiting:
                self._hire()
            self._hand_out()
        for worker in [*self.coming, *self.there]:
            self.ray.kill(worker)

    def _hire(self) -> None:
        """Starts a worker for each place that has none. It asks for the places at most once in a second."""
        now = time.monotonic()
        if (self.coming or self.there) and now - self.looked < 1.0:
            return
        self.looked = now
        for _ in range(max(self.places(), 1) - len(self.coming) - len(self.there)):
            self._expect(self.make.remote())

    def _expect(self, worker: Any) -> None:
        """Waits for a worker, which gets no call meanwhile."""
        self.coming.append(worker)
        worker.is_there.remote().future().add_done_callback(lambda come: self.events.put(_Come(worker, _error_of(come))))

    def _come(self, event: _Come) -> None:
        self.coming.remove(event.worker)
        if event.error is None:
            self.failed_starts = 0
            self.there[event.worker] = deque()
            return
        self.failed_starts += 1
        if self.failed_starts > self.retries and not self.coming and not self.there:
            waiting, self.waiting = self.waiting, deque()
            for call in waiting:
                if call.future.running() or call.future.set_running_or_notify_cancel():
                    call.future.set_exception(Error(f"no worker starts: {_first_line(event.error)}"))

    def _hand_out(self) -> None:
        """Gives the calls that wait to workers with few calls."""
        while self.waiting and self.there:
            worker = min(self.there, key=lambda worker: len(self.there[worker]))
            if len(self.there[worker]) >= _IN_FLIGHT:
                return
            call = self.waiting.popleft()
            if not call.future.running() and not call.future.set_running_or_notify_cancel():
                continue
            try:
                made = worker.call.remote(call.function, call.args, call.kwargs).future()
            except Exception as error:
                # The arguments cannot be pickled.
                call.future.set_exception(error)
                continue
            self.there[worker].append(call)
            made.add_done_callback(lambda made, worker=worker, call=call: self.events.put(_made(worker, call, made)))

    def _made(self, event: _Made) -> None:
        worker, call, error = event.worker, event.call, event.error
        calls = self.there.get(worker)
        if calls is None or call not in calls:
            # The worker died with another call, and this call waits again.
            return
        lost = self.ray.exceptions
        # What a function raises is no death, also if it raises an error of Ray.
        is_raised = isinstance(error, lost.RayTaskError)
        if error is not None and not is_raised and isinstance(error, lost.RayActorError):
            self._died(worker, error)
            return
        calls.remove(call)
        if error is None:
            call.future.set_result(event.result)
        elif not is_raised and isinstance(error, (lost.ObjectLostError, lost.NodeDiedError, lost.WorkerCrashedError, lost.OutOfMemoryError)):
            call.deaths += 1
            self._again(call, error)
        else:
            call.future.set_exception(error)

    def _died(self, worker: Any, error: BaseException) -> None:
        """Gives the calls of a worker that has died to others. The worker was making its oldest call."""
        calls = self.there.pop(worker)
        calls[0].deaths += 1
        for call in reversed(calls):
            self._again(call, error)
        # A machine that dies takes its idle workers with it, and nothing else tells of them.
        for idle in [other for other, has in self.there.items() if not has]:
            del self.there[idle]
            self._expect(idle)
        self.looked = -math.inf

    def _again(self, call: _Call, error: BaseException) -> None:
        if call.deaths <= self.retries:
            self.waiting.appendleft(call)
            return
        times = "once" if call.deaths == 1 else f"{call.deaths} times"
        call.future.set_exception(Error(f"the worker died {times} in these tests; does a test end its process? ({_first_line(error)})"))

    def _cancel(self) -> None:
        """Cancels the calls that no worker has had yet."""
        waiting, self.waiting = self.waiting, deque()
        for call in waiting:
            if call.future.running():
                self.waiting.append(call)
            elif call.future.cancel():
                call.future.set_running_or_notify_cancel()


def _first_line(error: BaseException) -> str:
    return f"{type(error).__name__}: {str(error).partition(chr(10))[0]}"


def _error_of(done: Future[Any]) -> BaseException | None:
    try:
        return done.exception()
    except concurrent.futures.CancelledError as cancelled:
        return cancelled


def _made(worker: Any, call: _Call, made: Future[Any]) -> _Made:
    error = _error_of(made)
    return _Made(worker, call, made.result() if error is None else None, error)


class _Worker:
    """A worker on a machine of the cluster."""

    def is_there(self) -> None:
        pass

    def call(self, function: Callable[..., Any], args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
        return function(*args, **kwargs)
