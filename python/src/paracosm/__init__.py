"""Drivers and perceivers for PARACOSM, which tests them in simulated worlds.

Subclass `Driver`, say which cameras it has, implement `reset` and `step`, and serve it:

    from paracosm import Camera, Control, Driver

    class Careful(Driver):
        cameras = {"front": Camera()}

        def step(self, observation):
            image = observation.images["front"]      # (height, width, 3), or not there yet
            return Control(throttle=0.1)

    if __name__ == "__main__":
        Careful().serve()

    $ paracosm-fuzz follow-leader --driver-command "python careful.py"

Subclass `Perceiver` to test a network that sees.
"""

from .driver import Driver, serve
from .observation import Body, Briefing, Control, Fix, Inertia, Observation, Picture, Scan, Vehicle, Way
from .perceiver import Detection, Perceiver
from .sensors import Camera, Delivery, Gnss, Imu, Inaccuracy, Lidar, Mount

__all__ = [
    "Body",
    "Briefing",
    "Camera",
    "Control",
    "Delivery",
    "Detection",
    "Driver",
    "Fix",
    "Gnss",
    "Imu",
    "Inaccuracy",
    "Inertia",
    "Lidar",
    "Mount",
    "Observation",
    "Perceiver",
    "Picture",
    "Scan",
    "Vehicle",
    "Way",
    "serve",
]
