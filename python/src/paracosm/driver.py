"""A driver, and a server that lets PARACOSM ask it."""

import copy
import difflib
import os
import stat
import sys
import threading
import traceback
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, NoReturn

from . import observation, sensors
from .observation import Briefing, Control, Observation

# Each test that runs at the same time as others has a session, and a thread that waits most of the time.
SESSIONS = 1024


class Driver:
    """A system under test: subclass it, and implement `step`.

    The controls of a driver may depend only on the observations since the last `reset`, on `seed` and on `settings`. Then a test gives the
    same trace wherever and whenever it runs.

    Each session gets a deep copy of the driver, so that tests that run at the same time do not disturb each other. Store large constant
    objects, such as a network, as attributes of the class: copies share them.
    """

    period: float = 0.1
    """Seconds from one step to the next."""
    cameras: dict[str, sensors.Camera] = {}
    """Cameras by their names."""
    look: str = "flat"
    """The look of the images of the cameras: `"flat"` or `"textured"`."""
    lidars: dict[str, sensors.Lidar] = {}
    gnss: dict[str, sensors.Gnss] = {}
    imus: dict[str, sensors.Imu] = {}
    others: bool = False
    """Whether it is told where the others truly are."""
    settings: dict[str, float] = {}
    """The settings with their default values. `--set driver.NAME=VALUE` and `driver_settings` change them for a session."""
    seed: int = 0
    """The seed of all random numbers of the driver. `--set driver.seed=N` sets it."""

    files: Sequence[str | os.PathLike[str]] = ()
    """The files that it reads. They travel with it to other machines."""

    def reset(self, briefing: Briefing) -> None:
        """Begins a new test: forget everything. `briefing` is a `Briefing`."""

    def step(self, observation: Observation) -> Control:
        """Returns the `Control` that the car applies until the next step. `observation` is an `Observation`."""
        raise NotImplementedError(f"{type(self).__name__}.step")

    def serve(self, address: str | None = None) -> None:
        """Lets PARACOSM ask this driver, until the process ends; see `serve`."""
        serve(lambda: copy.deepcopy(self), address)


def serve(make: Callable[[], Driver], address: str | None = None) -> None:
    """Serves a driver that `make()` makes for each session, until the process ends.

    It listens at `address`, HOST:PORT; without one, where `paracosm-fuzz --driver-command` asks for by PARACOSM_ADDRESS, and
    else at 127.0.0.1:50051.
    """
    grpc, protocol = _messages()
    started_by = os.environ.get("PARACOSM_ADDRESS")
    address = address or started_by or "127.0.0.1:50051"
    options = [
        ("grpc.max_receive_message_length", -1),
        # Two servers at one address would share what comes.
        ("grpc.so_reuseport", 0),
    ]
    server = grpc.server(ThreadPoolExecutor(SESSIONS), options=options, maximum_concurrent_rpcs=SESSIONS)
    handler = grpc.stream_stream_rpc_method_handler(
        lambda requests, _: _session(make, requests, protocol),
        request_deserializer=protocol.Request.FromString,
        response_serializer=protocol.Answer.SerializeToString,
    )
    server.add_generic_rpc_handlers((grpc.method_handlers_generic_handler(protocol.SERVICE, {protocol.METHOD: handler}),))
    server.add_insecure_port(address)
    server.start()
    if started_by == address and stat.S_ISFIFO(os.fstat(0).st_mode):
        # Whoever has started this process holds the other end of the pipe, and ends it by this, also when it dies.
        threading.Thread(target=_end_with_input, daemon=True).start()
    else:
        print(f"listening at grpc://{address}", file=sys.stderr)
    try:
        server.wait_for_termination()
    except KeyboardInterrupt:
        pass


def _messages() -> tuple[Any, Any]:
    """The packages that carry messages; only a driver in a process of its own needs them."""
    try:
        import grpc

        from . import protocol
    except ModuleNotFoundError as missing:
        raise SystemExit(f"a driver in its own process needs the package {missing.name}: pip install 'paracosm[grpc]'") from None
    return grpc, protocol


def _end_with_input() -> NoReturn:
    while sys.stdin.buffer.read(4096):
        pass
    os._exit(0)


def _session(make: Callable[[], Driver], requests: Iterator[Any], protocol: Any) -> Iterator[Any]:
    """Answers the requests of a session; what a driver raises ends it."""
    driver: Driver
    images: dict[str, Any] = {}
    for request in requests:
        answer = protocol.Answer()
        try:
            match request.WhichOneof("kind"):
                case "hello":
                    driver = _welcome(make(), request.hello, answer.welcome, protocol.VERSION)
                case "reset":
                    images.clear()
                    driver.reset(observation.briefing(request.reset))
                    answer.ready.SetInParent()
                case "step":
                    control = driver.step(observation.observation(request.step, images))
                    if not isinstance(control, Control):
                        raise TypeError(f"step returned {control!r}, expected a Control")
                    answer.control.throttle = float(control.throttle)
                    answer.control.steering = float(control.steering)
                case other:
                    raise ValueError(f"found an unknown request: {other}; update the package")
        # `sys.exit()` in a driver would otherwise end this thread without a word.
        except (Exception, SystemExit) as error:
            traceback.print_exc()
            yield protocol.Answer(fault={"message": _words(error)})
            return
        yield answer


def configure(driver: Driver, settings: Mapping[str, float], seed: int) -> None:
    """Gives a driver its settings and its seed for a session. Raises `ValueError` if the driver has no such setting."""
    for name in settings:
        if name not in driver.settings:
            near = difflib.get_close_matches(name, driver.settings, 1)
            hint = f" (did you mean `{near[0]}`?)" if near else ""
            raise ValueError(f"{type(driver).__name__} has no setting `{name}`{hint}")
    driver.settings = {**driver.settings, **settings}
    driver.seed = seed


def _welcome(driver: Driver, hello: Any, welcome: Any, version: int) -> Driver:
    """Sets a driver as it is asked to, and says what it measures with."""
    configure(driver, hello.settings, hello.seed)
    welcome.protocol = version
    welcome.name = type(driver).__name__
    welcome.period = driver.period
    welcome.others = driver.others
    welcome.look = driver.look
    described: Any
    for described, messages in [
        (driver.cameras, welcome.cameras),
        (driver.lidars, welcome.lidars),
        (driver.gnss, welcome.gnss),
        (driver.imus, welcome.imus),
    ]:
        for name, sensor in described.items():
            message = messages.add(name=name)
            sensors.write(sensor, message)
    return driver


def _words(error: BaseException) -> str:
    """An exception in a line, with the place in the user's code where it was raised."""
    what = "".join(traceback.format_exception_only(error)).strip()
    frames = [frame for frame in traceback.extract_tb(error.__traceback__) if frame.filename != __file__]
    if not frames:
        return what
    at = frames[-1]
    return f"{what} ({os.path.basename(at.filename)}, line {at.lineno}, in {at.name})"
