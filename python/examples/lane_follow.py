"""Keeps a car in the right lane of a straight road by the kerb that it sees, with numpy alone.

    paracosm-fuzz follow-leader --driver-command "python python/examples/lane_follow.py" --set leader_speed=20 \\
        --open approach_speed --open gap=40..60 --budget 20
"""

from pathlib import Path

try:
    import numpy as np
    from numpy.typing import NDArray

    from paracosm import Briefing, Camera, Control, Driver, Observation
except ModuleNotFoundError as missing:
    raise SystemExit(f"lane_follow.py needs the package {missing.name}: pip install {Path(__file__).parents[1]}") from None

ROWS = np.arange(48, 66)  # of the image, where the road is near
LOOK_AHEAD = 12.0  # metres


class LaneFollow(Driver):
    cameras = {"front": Camera()}
    settings = {"to_kerb": 1.75}  # metres from the middle of the lane to the kerb

    def reset(self, briefing: Briefing) -> None:
        self.cruise_speed, self.vehicle = briefing.cruise_speed, briefing.vehicle

    def step(self, observation: Observation) -> Control:
        throttle = float(np.clip(0.3 * (self.cruise_speed - observation.speed), -0.5, 0.5))
        image = observation.images.get("front")
        return Control(throttle, 0.0 if image is None else self.steering(image))

    def steering(self, image: NDArray[np.uint8]) -> float:
        camera = self.cameras["front"]
        focal = camera.width * camera.focal_mm / camera.sensor_mm  # pixels
        horizon = camera.height / 2 - focal * np.tan(np.radians(camera.pitch_degrees))
        asphalt = image[ROWS].max(axis=2) < 100
        middle = camera.width // 2
        kerb = middle + np.argmin(asphalt[:, middle:], axis=1)  # the first bright pixel to the right
        slope, at_zero = np.polyfit(ROWS + 0.5, kerb, 1)  # a straight line meets the horizon where it leads to
        heading = (at_zero + slope * horizon - middle) / focal  # of the lane, in radians to the right
        right = slope * camera.z - self.settings["to_kerb"]  # metres from the car to the middle of the lane
        aim = right + LOOK_AHEAD * heading
        angle = -2.0 * self.vehicle.wheelbase * aim / LOOK_AHEAD**2  # pure pursuit
        return float(np.clip(angle / self.vehicle.max_steering_angle, -1.0, 1.0))


if __name__ == "__main__":
    LaneFollow().serve()
