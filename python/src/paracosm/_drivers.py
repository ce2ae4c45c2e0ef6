"""Drivers in this process: what a study does with the driver that it is given."""

import copy
import inspect
import math
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from numbers import Real
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
    try:
        own = copy.deepcopy(driver)
    except Exception as error:
        raise Error(f"driver: {type(driver).__name__} cannot be copied, and each session has its own copy: {type(error).__name__}: {error}") from None
    if not isinstance(own.settings, Mapping):
        raise Error(f"settings of the driver is {own.settings!r}, expected a dictionary with a number for each name")
    for name, value in own.settings.items():
        if not (_is_number(value) and math.isfinite(value)):
            raise Error(f"settings of the driver: `{name}` is {value!r}, expected a number")
    try:
        configure(own, settings, seed)
    except ValueError as error:
        raise Error(f"driver_settings: {error}") from None
    return own


def described(driver: Driver) -> dict[str, Any]:
    """Returns what a driver says of itself and of its sensors."""
    sensors: dict[str, Any] = {}
    for kind in ("cameras", "lidars", "gnss", "imus"):
        named = getattr(driver, kind)
        if not isinstance(named, Mapping):
            raise Error(f"{kind} of the driver is {named!r}, expected a dictionary of sensors by their names")
        sensors[kind] = [_written(name, one) for name, one in named.items()]
    if not _is_number(driver.period):
        raise Error(f"period of the driver is {driver.period!r}, expected a number of seconds")
    if not isinstance(driver.others, bool):
        raise Error(f"others of the driver is {driver.others!r}, expected True or False")
    if not isinstance(driver.look, str):
        raise Error(f"look of the driver is {driver.look!r}, expected the name of a look, such as 'textured'")
    return {"period": float(driver.period), "others": driver.others, "look": driver.look, **sensors}


def _is_number(value: Any) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool)


def _written(name: str, sensor: Any) -> dict[str, Any]:
    if not is_dataclass(sensor):
        raise Error(f"the sensor `{name}` is {sensor!r}, expected a Camera, a Lidar, a Gnss or an Imu")
    return {"name": str(name), **_entries(sensor)}


def _entries(part: Any) -> dict[str, Any]:
    """Returns what is set of a sensor."""
    every = ((one.name, getattr(part, one.name)) for one in fields(part))
    return {name: _entries(value) if is_dataclass(value) else value for name, value in every if value is not None}
