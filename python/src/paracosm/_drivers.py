"""Drivers in this process: what a study does with the driver that it is given."""

import copy
import inspect
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from typing import Any

from ._core import Error
from .driver import Driver, configure
from .observation import Control, Observation


class _Function(Driver):
    """A driver that is a function from observations to controls. It has no memory."""

    def __init__(self, function: Callable[[Observation], Control]) -> None:
        self.function = function

    def step(self, observation: Observation) -> Control:
        return self.function(observation)


def as_driver(given: object) -> tuple[Driver, str] | None:
    """Converts the `driver` of a study: an object, a class or a function. Returns the driver and its name, or `None` for the name of a built-in driver.

    Raises `Error` for anything else.
    """
    if isinstance(given, Driver):
        return given, type(given).__name__
    if isinstance(given, str):
        return None
    if inspect.isclass(given) and issubclass(given, Driver):
        try:
            return given(), given.__name__
        except TypeError as error:
            raise Error(f"driver: the class {given.__name__} needs arguments ({error}): pass an object, such as driver={given.__name__}(..)") from None
    if not callable(given):
        raise Error(f"driver is {given!r}, expected the name of a driver, a Driver, or a function that gets an Observation")
    name = getattr(given, "__name__", type(given).__name__)
    return _Function(given), "function" if name == "<lambda>" else name


def of_session(driver: Driver, settings: dict[str, float], seed: int) -> Driver:
    """Returns the driver for one session: a copy with its settings."""
    own = copy.deepcopy(driver)
    try:
        configure(own, settings, seed)
    except ValueError as error:
        raise Error(f"driver_settings: {error}") from None
    return own


def described(driver: Driver) -> dict[str, Any]:
    """Returns what a driver says of itself and of its sensors."""
    sensors = {kind: [_written(name, one) for name, one in getattr(driver, kind).items()] for kind in ("cameras", "lidars", "gnss", "imus")}
    return {"period": float(driver.period), "others": bool(driver.others), **sensors}


def _written(name: str, sensor: Any) -> dict[str, Any]:
    if not is_dataclass(sensor):
        raise Error(f"the sensor `{name}` is {sensor!r}, expected a Camera, a Lidar, a Gnss or an Imu")
    return {"name": str(name), **_entries(sensor)}


def _entries(part: Any) -> dict[str, Any]:
    """Returns what is set of a sensor."""
    every = ((one.name, getattr(part, one.name)) for one in fields(part))
    return {name: _entries(value) if is_dataclass(value) else value for name, value in every if value is not None}
