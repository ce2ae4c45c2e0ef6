"""Coverage-driven testing and falsification of autonomous driving systems.

    import paracosm as pc

    X = pc.sample(5, n=200, method="greedy", seed=1)     # an array of 200 points in 5 dimensions
    pc.dispersion(X)                                     # the largest empty box: exact, or between two certified bounds
    space = pc.Space({"speed": (0.5, 10.0), "lanes": [2, 4, 6]}, constraints=["lanes > 2 or speed < 5"])
    pc.sample(space, n=100).to_pandas()                  # a table of tests

    study = pc.Study("pedestrian-crossing", driver="aeb", open={"friction": (0.3, 0.8)}, budget=500)
    report = study.run("out")                            # the same folder as that of `paracosm-fuzz`
    report.failures[0].replay()                          # a trace with columns of numpy

    @pc.scenario                                         # a world of one's own, as a program
    def crossing(s): ...

`Driver` and `Perceiver` are the base classes of systems under test in Python.

The package has the same core as the programs `paracosm-fuzz` and `paracosm-cover`, so its numbers are the same to the last bit.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from . import fmi as fmi, gymnasium as gymnasium, optuna as optuna, qmc as qmc, ray as ray
    from ._core import (
        Actor,
        AutonomousVehicle,
        Bracket,
        Car,
        Comparison,
        Composite,
        Conditions,
        CoveringArray,
        CrossIntersection,
        Effect,
        Environment,
        EnvironmentCars,
        Error,
        Evaluation,
        FailureMap,
        Fixture,
        Fleet,
        Formula,
        Generator,
        Line,
        Monitor,
        Mover,
        Path,
        Pedestrian,
        Pose,
        Program,
        Report,
        Road,
        RoadNetwork,
        RoadSegment,
        Roadside,
        Roundabout,
        Scenario,
        Space,
        Stream,
        Streets,
        Study,
        TIntersection,
        Table,
        Temporal,
        Tests,
        Trials,
        Trace,
        TrafficCar,
        Trial,
        Walk,
        Walker,
        always,
        compare,
        coverage,
        covering_array,
        eventually,
        grid_city,
        historically,
        load,
        measures,
        never,
        once,
        plan,
        sample,
        scenarios,
        strategies,
        until,
    )
    from .driver import Driver, serve
    from ._falsify import falsify
    from ._scenarios import scenario
    from ._measures import (
        centered_discrepancy,
        dispersion,
        extreme_discrepancy,
        fill_distance,
        k_wise_coverage,
        k_wise_dispersion,
        l2_star_discrepancy,
        mixture_discrepancy,
        star_discrepancy,
        wraparound_discrepancy,
    )
    from .observation import Body, Briefing, Control, Fix, Inertia, Observation, Picture, Scan, Vehicle, Way
    from .parameters import Choice, Interval
    from .perceiver import Detection, Perceiver
    from .sensors import Camera, Delivery, Gnss, Imu, Inaccuracy, Lidar, Mount

__all__ = [
    "Actor",
    "AutonomousVehicle",
    "Body",
    "Bracket",
    "Briefing",
    "Camera",
    "Car",
    "Choice",
    "Comparison",
    "Composite",
    "Conditions",
    "Control",
    "CoveringArray",
    "CrossIntersection",
    "Delivery",
    "Detection",
    "Driver",
    "Effect",
    "Environment",
    "EnvironmentCars",
    "Error",
    "Evaluation",
    "FailureMap",
    "Fix",
    "Fixture",
    "Fleet",
    "Formula",
    "Generator",
    "Gnss",
    "Imu",
    "Inaccuracy",
    "Inertia",
    "Interval",
    "Lidar",
    "Line",
    "Monitor",
    "Mount",
    "Mover",
    "Observation",
    "Path",
    "Pedestrian",
    "Perceiver",
    "Picture",
    "Pose",
    "Program",
    "Report",
    "Road",
    "RoadNetwork",
    "RoadSegment",
    "Roadside",
    "Roundabout",
    "Scan",
    "Scenario",
    "Space",
    "Stream",
    "Streets",
    "Study",
    "TIntersection",
    "Table",
    "Temporal",
    "Tests",
    "Trials",
    "Trace",
    "TrafficCar",
    "Trial",
    "Vehicle",
    "Walk",
    "Walker",
    "Way",
    "always",
    "centered_discrepancy",
    "compare",
    "coverage",
    "covering_array",
    "dispersion",
    "eventually",
    "extreme_discrepancy",
    "falsify",
    "fill_distance",
    "grid_city",
    "historically",
    "k_wise_coverage",
    "k_wise_dispersion",
    "l2_star_discrepancy",
    "load",
    "measures",
    "mixture_discrepancy",
    "never",
    "once",
    "plan",
    "sample",
    "scenario",
    "scenarios",
    "serve",
    "star_discrepancy",
    "strategies",
    "until",
    "wraparound_discrepancy",
]

# The modules in which names are looked for, in this order. They are imported when a name of theirs is first used, so that a driver in a
# process of its own starts without the compiled core.
_MODULES = ("driver", "observation", "perceiver", "sensors", "parameters", "_core", "_scenarios", "_falsify", "_measures")


# The modules that work with other packages. Each is imported when its name is first used.
_PARTS = ("fmi", "gymnasium", "optuna", "qmc", "ray")


__version__: str


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import version

        return version("paracosm")
    if name in _PARTS:
        try:
            return import_module(f".{name}", __name__)
        except ModuleNotFoundError as missing:
            raise AttributeError(f"paracosm.{name} needs the package {missing.name}: pip install 'paracosm[{name}]'") from missing
    if name in __all__:
        for module in _MODULES:
            found = getattr(import_module(f".{module}", __name__), name, None)
            if found is not None:
                globals()[name] = found
                return found
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return [*__all__, *_PARTS]
