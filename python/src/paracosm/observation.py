"""What a driver is told, and what it answers.

All units are SI units. "As seen from the car" means: from the middle of the box of the car, with x ahead and y to the left.
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Control:
    """The control of the car until the next step.

    - throttle: from -1, full brakes, to 1, full power
    - steering: from -1, the wheels turned to the right as far as they go, to 1, the wheels turned to the left
    """

    throttle: float = 0.0
    steering: float = 0.0


@dataclass(frozen=True)
class Vehicle:
    """A car. The two axles have the same distance from the middle of the car.

    - length, width, height: the size of the car in m
    - wheelbase, track: the distances from front axle to rear axle, and from left wheel to right wheel, in m
    - front_axle: the distance of the centre of gravity behind the front axle in m
    - centre_of_gravity: the height of the centre of gravity above the road in m
    - mass, yaw_inertia: the mass in kg, and the moment of inertia about the vertical axis in kg m^2
    - wheel_radius, wheel_mass, wheel_inertia: the radius of a wheel in m, its mass in kg, and its moment of inertia about its axle in kg m^2
    - ride_frequency: the frequency in Hz at which the body bounces on its springs
    - damping_ratio: the damping of the springs; 1 is critical damping
    - cornering_stiffness: the lateral force of a tyre divided by its load and its slip angle, for small slip angles, in 1/rad
    - max_steering_angle, max_steering_rate: the greatest angle of the front wheels to either side in rad, and the greatest rate in rad/s
    - max_acceleration: the greatest acceleration and deceleration by engine and brakes, without the limits of the road, in m/s^2
    - switch_speed: the speed above which the engine gives constant power, in m/s
    - max_speed: the top speed in m/s
    """

    length: float
    width: float
    height: float
    wheelbase: float
    track: float
    front_axle: float
    centre_of_gravity: float
    mass: float
    yaw_inertia: float
    wheel_radius: float
    wheel_mass: float
    wheel_inertia: float
    ride_frequency: float
    damping_ratio: float
    cornering_stiffness: float
    max_steering_angle: float
    max_steering_rate: float
    max_acceleration: float
    switch_speed: float
    max_speed: float


@dataclass(frozen=True)
class Briefing:
    """What a driver is told before a test.

    - cruise_speed: the speed to keep where nothing is in the way, in m/s
    - vehicle: the car that the driver drives
    """

    cruise_speed: float
    vehicle: Vehicle


@dataclass(frozen=True)
class Way:
    """The way that the car should go.

    - offset: the distance of the car to the left of the way, in m
    - heading: the angle of the car to the left of the way, in rad
    - spacing: the distance along the way from one point of `ahead` to the next, in m
    - ahead: (n, 3), float64: points of the way, the nearest first. Columns: x and y as seen from the car in m, and the curvature in 1/m, positive to
      the left
    """

    offset: float
    heading: float
    spacing: float
    ahead: NDArray[np.float64]


@dataclass(frozen=True)
class Body:
    """Another body at its true place, for drivers with `others = True`.

    - id: the number of the body, the same in all steps of a test
    - kind: car, van, truck, bus, motorcycle, bicycle, pedestrian, building, tree, sign or prop
    - position: (2,), float64: the middle of the body as seen from the car, in m
    - velocity: (2,), float64: the velocity over the ground along the same axes, in m/s
    - heading: the angle of the body to the left of the heading of the car, in rad
    - length, width: the size of the rectangle that the body covers of the ground, in m. Both are the diameter if it covers a disc
    """

    id: int
    kind: str
    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    heading: float
    length: float
    width: float


@dataclass(frozen=True)
class Picture:
    """An image of a camera.

    - camera: the name of the camera
    - number: the number of the image. The image k is due at k periods of the camera
    - time: when the image was taken, in s since the test began
    - pixels: (height, width, 3), uint8: the image in sRGB; read-only
    """

    camera: str
    number: int
    time: float
    pixels: NDArray[np.uint8]


@dataclass(frozen=True)
class Scan:
    """A turn of a LiDAR.

    - sensor: the name of the LiDAR
    - number: the number of the turn. The turn k is due at k periods of the LiDAR
    - time: when the turn was measured, in s since the test began
    - points: (n, 4), float32: x, y and z as seen from the sensor in m, and the intensity; read-only
    """

    sensor: str
    number: int
    time: float
    points: NDArray[np.float32]


@dataclass(frozen=True)
class Fix:
    """What a satellite receiver says about its place in the world.

    - sensor: the name of the receiver
    - number: the number of the fix. The fix k is due at k periods of the receiver
    - time: when the fix was measured, in s since the test began
    - position: (2,), float64: x and y in the world, in m; `None` in an outage
    - velocity: (2,), float64: the velocity along the same axes, in m/s; `None` in an outage
    """

    sensor: str
    number: int
    time: float
    position: NDArray[np.float64] | None
    velocity: NDArray[np.float64] | None


@dataclass(frozen=True)
class Inertia:
    """What an inertial sensor measures of the motion of the car.

    - sensor: the name of the sensor
    - number: the number of the measurement. The measurement k is due at k periods of the sensor
    - time: when it was measured, in s since the test began
    - acceleration: (2,), float64: the acceleration as seen from the car, in m/s^2
    - yaw_rate: the rate at which the car turns to the left, in rad/s
    """

    sensor: str
    number: int
    time: float
    acceleration: NDArray[np.float64]
    yaw_rate: float


@dataclass(frozen=True)
class Observation:
    """A moment of a test. Lists hold what has arrived since the last step, the earliest first.

    - time: the seconds since the test began
    - speed: the speed of the car in m/s
    - travelled: the way that the car has covered, in m
    - odometry: x, y and heading of the car as seen from the place where it began, in m and rad
    - way: the way that the car should go
    - images: the last image of each camera from which one has arrived in this test: (height, width, 3), uint8, read-only
    - pictures: the images that have arrived
    - scans: the turns of LiDARs that have arrived
    - fixes: the measurements of satellite receivers that have arrived
    - inertia: the measurements of inertial sensors that have arrived
    - others: the other bodies, for drivers with `others = True`
    """

    time: float
    speed: float
    travelled: float
    odometry: tuple[float, float, float]
    way: Way
    images: dict[str, NDArray[np.uint8]]
    pictures: list[Picture] = field(default_factory=list)
    scans: list[Scan] = field(default_factory=list)
    fixes: list[Fix] = field(default_factory=list)
    inertia: list[Inertia] = field(default_factory=list)
    others: list[Body] = field(default_factory=list)


def briefing(message: Any) -> Briefing:
    """Reads a `Reset`."""
    vehicle = {name: getattr(message.vehicle, name) for name in Vehicle.__dataclass_fields__}
    return Briefing(message.cruise_speed, Vehicle(**vehicle))


def observation(message: Any, images: dict[str, NDArray[np.uint8]]) -> Observation:
    """Reads a `Step`, and keeps the last image of each camera in `images`."""
    pictures = [_picture(image) for image in message.images]
    images.update((picture.camera, picture.pixels) for picture in pictures)
    way = message.way
    return Observation(
        time=message.time,
        speed=message.speed,
        travelled=message.travelled,
        odometry=(message.odometry.x, message.odometry.y, message.odometry.heading),
        way=Way(way.offset, way.heading, way.spacing, np.array(way.ahead).reshape(-1, 3)),
        images=dict(images),
        pictures=pictures,
        scans=[
            Scan(scan.sensor, scan.number, scan.time, np.frombuffer(scan.points, "<f4").reshape(-1, 4))
            for scan in message.scans
        ],
        fixes=[_fix(fix) for fix in message.fixes],
        inertia=[
            Inertia(one.sensor, one.number, one.time, np.array([one.acceleration_x, one.acceleration_y]), one.yaw_rate)
            for one in message.inertia
        ],
        others=[_body(other) for other in message.others],
    )


def _picture(image: Any) -> Picture:
    pixels = np.frombuffer(image.rgb, np.uint8).reshape(image.height, image.width, 3)
    return Picture(image.camera, image.number, image.time, pixels)


def _fix(fix: Any) -> Fix:
    if not fix.valid:
        return Fix(fix.sensor, fix.number, fix.time, None, None)
    position, velocity = np.array([fix.x, fix.y]), np.array([fix.velocity_x, fix.velocity_y])
    return Fix(fix.sensor, fix.number, fix.time, position, velocity)


def _body(other: Any) -> Body:
    if other.WhichOneof("outline") == "rectangle":
        length, width = other.rectangle.length, other.rectangle.width
    else:
        length = width = 2.0 * other.radius
    position, velocity = np.array([other.x, other.y]), np.array([other.velocity_x, other.velocity_y])
    # `class` is no name in Python.
    kind = getattr(other, "class")
    return Body(other.id, kind, position, velocity, other.heading, length, width)
