"""Follows its way, and brakes for the road users that get into it. It knows their true positions (`others = True`).

    paracosm-fuzz pedestrian-crossing --driver-command "python python/examples/brake.py" --budget 50
"""

from pathlib import Path

try:
    import numpy as np

    from paracosm import Briefing, Control, Driver, Observation
except ModuleNotFoundError as missing:
    raise SystemExit(f"brake.py needs the package {missing.name}: pip install {Path(__file__).parents[1]}") from None


class Brake(Driver):
    others = True
    settings = {"deceleration": 5.0, "margin": 2.0, "ahead": 3.0}  # m/s2, metres, and seconds that it looks ahead

    def reset(self, briefing: Briefing) -> None:
        self.cruise_speed, self.vehicle = briefing.cruise_speed, briefing.vehicle

    def step(self, observation: Observation) -> Control:
        stopping = observation.speed**2 / (2 * self.settings["deceleration"]) + self.settings["margin"]
        if self.free_way(observation) < stopping:
            return Control(throttle=-1.0, steering=self.steering(observation))
        throttle = float(np.clip(0.3 * (self.cruise_speed - observation.speed), -0.5, 0.5))
        return Control(throttle, self.steering(observation))

    def free_way(self, observation: Observation) -> float:
        """Returns the metres from the front of the car to the nearest body that is in its way soon."""
        free = np.inf
        for body in observation.others:
            times = np.linspace(0.0, self.settings["ahead"], 16)[:, None]
            x, y = (body.position + times * body.velocity).T
            beside = np.abs(y) > (self.vehicle.width + body.width) / 2 + 0.5
            distance = x - (self.vehicle.length + body.length) / 2
            in_the_way = distance[~beside & (distance > 0.0)]
            free = min(free, in_the_way.min(initial=np.inf))
        return free

    def steering(self, observation: Observation) -> float:
        way = observation.way
        place = min(round(8.0 / way.spacing), len(way.ahead) - 1)  # a point some 8 m ahead
        x, y, _ = way.ahead[place]
        angle = 2.0 * self.vehicle.wheelbase * y / (x * x + y * y)  # pure pursuit
        return float(np.clip(angle / self.vehicle.max_steering_angle, -1.0, 1.0))


if __name__ == "__main__":
    Brake().serve()
