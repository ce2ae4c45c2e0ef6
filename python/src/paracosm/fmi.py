"""Drivers that are functional mock-up units (FMU), by FMPy. It needs fmpy.

    >>> import paracosm as pc
    >>> from paracosm import fmi
    >>> study = pc.Study("cut-in", driver=fmi.Driver("ego.fmu"))

An FMU for co-simulation, of FMI 2 or 3, drives the car: at each step it gets its inputs, advances by the period, and gives the throttle and the
steering. An FMU runs the code of its author with your rights, like any program. The folder of a campaign names the driver only, so no folder runs one.
"""

import copy
import os
import tempfile
import threading
from collections.abc import Callable, Mapping
from contextlib import suppress
from difflib import get_close_matches
from importlib import import_module
from pathlib import Path
from typing import Any

from . import driver
from ._core import Error
from .observation import Briefing, Control, Observation

__all__ = ["QUANTITIES", "Driver"]

_Quantity = Callable[[Observation], float]


def _ahead(observation: Observation) -> tuple[float, float]:
    """Returns the distance to the front of the car's nearest body ahead in its own path, and the speed of this body; 1000 m and 0 without one."""
    half = 1.5
    bodies = [body for body in observation.others if body.position[0] > 0 and abs(body.position[1]) < half + 0.5 * body.width]
    if not bodies:
        return 1000.0, 0.0
    body = min(bodies, key=lambda body: float(body.position[0]))
    return float(body.position[0]) - 0.5 * body.length, float(body.velocity[0])


# What an input of an FMU gets, by the name of the input.
QUANTITIES: dict[str, _Quantity] = {
    "time": lambda observation: observation.time,
    "speed": lambda observation: observation.speed,
    "travelled": lambda observation: observation.travelled,
    "way_offset": lambda observation: observation.way.offset,
    "way_heading": lambda observation: observation.way.heading,
    "way_curvature": lambda observation: float(observation.way.ahead[0][2]) if len(observation.way.ahead) else 0.0,
    "lead_distance": lambda observation: _ahead(observation)[0],
    "lead_speed": lambda observation: _ahead(observation)[1],
}


class Driver(driver.Driver):
    """An FMU that drives the car.

    `inputs` says what the inputs of the FMU get: a dictionary from the name of an input to the name of a quantity (`QUANTITIES` lists them) or to a function of the
    observation. An input that is not named gets the quantity of its own name. An input `cruise_speed` gets the speed in m/s that the car should keep.
    `outputs` has the names of the outputs for the `throttle` and the `steering`; a steering is not needed. `parameters` sets parameters of the FMU before
    each test. `period` is the step in seconds.
    """

    def __init__(
        self,
        fmu: str | os.PathLike[str],
        *,
        period: float = 0.1,
        inputs: Mapping[str, str | _Quantity] | None = None,
        outputs: Mapping[str, str] | None = None,
        parameters: Mapping[str, float] | None = None,
    ) -> None:
        self.period = period
        self.others = True
        self.files = [fmu]
        self._choices: dict[str, Any] = {"period": period, "inputs": inputs, "outputs": outputs, "parameters": parameters}
        self.unit = _Unit(Path(fmu))
        self._inputs = self.unit.bound(inputs or {})
        self._outputs = self.unit.outputs(outputs or {})
        self._parameters = {self.unit.variable(name, "parameter"): float(value) for name, value in (parameters or {}).items()}
        self._running: _Running | None = None
        self._cruise_speed = 0.0

    def __reduce__(self) -> tuple[Any, ...]:
        """Says how to make the driver again from a pickle, with the file of the FMU and with what was set since."""
        made = {"unit", "files", "_inputs", "_outputs", "_parameters", "_running", "_cruise_speed"}
        state = {name: value for name, value in self.__dict__.items() if name not in made}
        return _made_again, (type(self), self.files[0], self._choices, state)

    def __deepcopy__(self, memo: dict[int, Any]) -> "Driver":
        """Returns a driver with the same unit, which begins its own instance."""
        copied = object.__new__(type(self))
        copied.__dict__.update(self.__dict__, _running=None)
        return copied

    def reset(self, briefing: Briefing) -> None:
        if self._running is not None:
            self._running.end()
        self._cruise_speed = briefing.cruise_speed
        self._running = _Running(self.unit, self._parameters)

    def step(self, observation: Observation) -> Control:
        assert self._running is not None, "a test begins with `reset`"
        values = {variable: self._cruise_speed if quantity is None else float(quantity(observation)) for variable, quantity in self._inputs.items()}
        found = self._running.step(values, list(self._outputs.values()), observation.time, self.period)
        controls = dict(zip(self._outputs, found))
        return Control(controls["throttle"], controls.get("steering", 0.0))

    def __del__(self) -> None:
        running = getattr(self, "_running", None)
        if running is not None:
            running.end()


def _made_again(kind: type[Driver], fmu: str | os.PathLike[str], choices: dict[str, Any], state: dict[str, Any]) -> Driver:
    driver = object.__new__(kind)
    Driver.__init__(driver, fmu, **choices)
    driver.__dict__.update(state)
    return driver


class _Unit:
    """The file of an FMU, which is unpacked once."""

    def __init__(self, file: Path) -> None:
        fmpy: Any = import_module("fmpy")
        if not file.is_file():
            raise Error(f"found no file {file}")
        self.file = file
        try:
            self.description: Any = fmpy.read_model_description(os.fspath(file), validate=False)
        except Exception as error:
            raise Error(f"{file} is no FMU that FMPy reads: {error}") from None
        if self.description.coSimulation is None:
            raise Error(f"{file} is an FMU for model exchange, expected one for co-simulation")
        if self.description.fmiVersion.split(".")[0] not in ("2", "3"):
            raise Error(f"{file} has the version {self.description.fmiVersion} of FMI, expected 2 or 3")
        self.variables = {variable.name: variable for variable in self.description.modelVariables}
        self._unpacked = tempfile.TemporaryDirectory(prefix="paracosm-fmu-")
        self.folder = self._unpacked.name
        fmpy.extract(os.fspath(file), self.folder)
        self.is_2 = self.description.fmiVersion.startswith("2")
        self.loaded = self._loaded()
        self.lock = threading.Lock()
        self.running = 0

    def _loaded(self) -> Any:
        """Loads the code of the FMU, once. FMPy changes the present folder of the process meanwhile, so no thread of a campaign may do so."""
        kind: Any = import_module("fmpy.fmi2").FMU2Slave if self.is_2 else import_module("fmpy.fmi3").FMU3Slave
        description, before = self.description, os.getcwd()
        try:
            return kind(guid=description.guid, unzipDirectory=self.folder, modelIdentifier=description.coSimulation.modelIdentifier, instanceName="ego")
        except Exception as error:
            raise Error(f"the code of {self.file} cannot be loaded: {error}") from None
        finally:
            os.chdir(before)

    def __deepcopy__(self, memo: dict[int, Any]) -> "_Unit":
        return self

    def variable(self, name: str, causality: str) -> str:
        """Returns the name of a variable with a causality, and checks that it exists and is a real number."""
        known = [one.name for one in self.variables.values() if one.causality == causality]
        if name not in known:
            near = get_close_matches(name, known, n=1)
            meant = f" (did you mean `{near[0]}`?)" if near else ""
            raise Error(f"{self.file} has no {causality} `{name}`{meant}; it has {', '.join(known) or 'none'}")
        if self.variables[name].type not in ("Real", "Float64"):
            raise Error(f"the {causality} `{name}` of {self.file} has the type {self.variables[name].type}, expected Real or Float64")
        return name

    def bound(self, inputs: Mapping[str, str | _Quantity]) -> dict[str, _Quantity | None]:
        """Returns the quantity of each input; `None` for the speed that the car should keep."""
        for name in inputs:
            self.variable(name, "input")
        bound: dict[str, _Quantity | None] = {}
        for variable in (one for one in self.variables.values() if one.causality == "input"):
            wanted = inputs.get(variable.name, variable.name)
            if not callable(wanted) and wanted != "cruise_speed" and wanted not in QUANTITIES:
                names = [*QUANTITIES, "cruise_speed"]
                near = get_close_matches(wanted, names, n=1)
                meant = f" (did you mean `{near[0]}`?)" if near else ""
                raise Error(
                    f"nothing is known for the input `{variable.name}` of {self.file}: no quantity is called `{wanted}`{meant}; give inputs={{'{variable.name}': ..}} "
                    f"with one of {', '.join(names)}, or a function of the observation"
                )
            self.variable(variable.name, "input")
            bound[variable.name] = wanted if callable(wanted) else QUANTITIES.get(wanted)
        return bound

    def outputs(self, names: Mapping[str, str]) -> dict[str, str]:
        """Returns the output of each control. An output called like its control need not be named, and a steering need not be there."""
        unknown = set(names) - {"throttle", "steering"}
        if unknown:
            raise Error(f"outputs: found the control `{min(unknown)}`, expected throttle or steering")
        has = {one.name for one in self.variables.values() if one.causality == "output"}
        wanted = ["throttle", "steering"] if "steering" in names or "steering" in has else ["throttle"]
        return {control: self.variable(names.get(control, control), "output") for control in wanted}


class _Running:
    """An instance of an FMU in a test."""

    def __init__(self, unit: _Unit, parameters: Mapping[str, float]) -> None:
        self.unit = unit
        # The instances share the code.
        self.slave = copy.copy(unit.loaded)
        self.is_over = True
        with unit.lock:
            once = getattr(unit.description.coSimulation, "canBeInstantiatedOnlyOncePerProcess", False)
            if once and unit.running > 0:
                raise Error(f"{unit.file} can have one instance in a process: run the study with executor=1")
            unit.running += 1
        self.is_over = False
        try:
            self._begin(parameters)
        except BaseException:
            self.end()
            raise

    def _begin(self, parameters: Mapping[str, float]) -> None:
        """Makes an instance that is ready for its first step."""
        self.slave.instantiate()
        self._set(parameters)
        if self.unit.is_2:
            self.slave.setupExperiment(startTime=0.0)
            self.slave.enterInitializationMode()
        else:
            self.slave.enterInitializationMode(startTime=0.0)
        self.slave.exitInitializationMode()

    def step(self, inputs: Mapping[str, float], outputs: list[str], time: float, period: float) -> list[float]:
        self._set(inputs)
        self.slave.doStep(currentCommunicationPoint=time, communicationStepSize=period)
        references = [self.unit.variables[name].valueReference for name in outputs]
        get = self.slave.getReal if self.unit.is_2 else self.slave.getFloat64
        return [float(value) for value in get(references)]

    def _set(self, values: Mapping[str, float]) -> None:
        if values:
            references = [self.unit.variables[name].valueReference for name in values]
            (self.slave.setReal if self.unit.is_2 else self.slave.setFloat64)(references, list(values.values()))

    def end(self) -> None:
        """Ends the instance."""
        if self.is_over:
            return
        self.is_over = True
        with self.unit.lock:
            self.unit.running -= 1
        # An instance that has failed cannot be terminated, and an instance that never began cannot be freed.
        with suppress(Exception):
            self.slave.terminate()
        with suppress(Exception):
            # `freeInstance` of FMPy would also unload the code.
            free = self.slave.fmi2FreeInstance if self.unit.is_2 else self.slave.fmi3FreeInstance
            free(self.slave.component)
