"""Drivers of the tests, which also serve over gRPC: `python example_drivers.py Cautious`."""

import sys

from paracosm import Briefing, Camera, Control, Driver, Gnss, Imu, Lidar, Observation


class Cautious(Driver):
    """Keeps its speed, and brakes for whoever is ahead."""

    settings = {"gain": 0.04}
    others = True

    def reset(self, briefing: Briefing) -> None:
        self.speed = briefing.cruise_speed

    def step(self, observation: Observation) -> Control:
        ahead = [one.position[0] for one in observation.others if one.position[0] > 0.0 and abs(one.position[1]) < 3.0]
        if min(ahead, default=1e9) < 25.0:
            return Control(-1.0)
        way = observation.way
        return Control(self.settings["gain"] * (self.speed - observation.speed), -0.05 * way.offset + 0.01 * way.ahead[0, 1])


class Sensing(Cautious):
    """Lets all sensors have a say, so that a trace shows what they measured."""

    cameras = {"front": Camera(rate=5.0)}
    lidars = {"roof": Lidar(channels=4, columns=90)}
    gnss = {"roof antenna": Gnss()}
    imus = {"floor": Imu(period=0.05)}

    def step(self, observation: Observation) -> Control:
        seen = sum(float(picture.pixels.mean()) for picture in observation.pictures) + len(observation.images)
        seen += sum(float(scan.points.sum()) for scan in observation.scans)
        seen += sum(float(fix.position[0]) for fix in observation.fixes if fix.position is not None)
        seen += sum(one.yaw_rate + float(one.acceleration[1]) for one in observation.inertia)
        return Control(super().step(observation).throttle, 1e-7 * seen)


def still(observation: Observation) -> Control:
    """Stands still."""
    return Control(-1.0 if observation.speed > 0.0 else 0.0)


if __name__ == "__main__":
    {"Cautious": Cautious, "Sensing": Sensing}[sys.argv[1]]().serve()
