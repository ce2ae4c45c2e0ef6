"""What a driver is told, and what it answers. SI units; "as seen from the car" means from the middle of its box: x ahead, y to
the left."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Control:
    """The control until the next step: `throttle` from -1 (full brakes) to 1 (full power), and `steering` from -1 (right) to 1 (left)."""

    throttle: float = 0.0
    """From -1, full brakes, to 1, full power."""
    steering: float = 0.0
    """From -1, the wheels turned to the right as far as they go, to 1, to the left."""


@dataclass(frozen=True)
class Vehicle:
    """A car. Lengths in metres, masses in kg; `driver.proto` says what each is. Its axles stand evenly about its middle."""

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
    """What a driver is told before a test: the speed to keep where nothing is in the way, in m/s, and its car."""

    cruise_speed: float
    vehicle: Vehicle


@dataclass(frozen=True)
class Way:
    """The way that the car is to go."""

    offset: float
    """How far the car is to the left of it, in metres."""
    heading: float
    """By how much the car points to the left of it, in radians."""
    spacing: float
    """Metres along the way from one point ahead to the next."""
    ahead: NDArray[np.float64]
    """Points ahead, the nearest first, (n, 3): x and y as seen from the car, and the curvature in 1/m, positive to the left."""


@dataclass(frozen=True)
class Body:
    """Another body as it truly is, for drivers with `others = True`."""

    id: int
    kind: str
    """car, van, truck, bus, motorcycle, bicycle, pedestrian, building, tree, sign or prop."""
    position: NDArray[np.float64]
    """(2,), metres, as seen from the car."""
    velocity: NDArray[np.float64]
    """(2,), m/s over the ground, along the same axes."""
    heading: float
    """Radians, from where the car points."""
    length: float
    width: float
    """Of the rectangle, or twice the radius of the disc, that it covers of the ground."""


@dataclass(frozen=True)
class Picture:
    """An image that has arrived."""

    camera: str
    number: int
    """The k-th image is due at k periods of the camera."""
    time: float
    """When it was taken."""
    pixels: NDArray[np.uint8]
    """(height, width, 3), uint8, sRGB, read-only."""


@dataclass(frozen=True)
class Scan:
    """A turn of a LiDAR."""

    sensor: str
    number: int
    time: float
    points: NDArray[np.float32]
    """(n, 4), float32: x, y, z as seen from the sensor, and the intensity; read-only."""


@dataclass(frozen=True)
class Fix:
    """Where a satellite receiver says that it is in the plane of the world; no position and no velocity in an outage."""

    sensor: str
    number: int
    time: float
    position: NDArray[np.float64] | None
    velocity: NDArray[np.float64] | None


@dataclass(frozen=True)
class Inertia:
    """What the car feels of its own motion: its acceleration (2,) as seen from the car, and its yaw rate to the left."""

    sensor: str
    number: int
    time: float
    acceleration: NDArray[np.float64]
    yaw_rate: float


@dataclass(frozen=True)
class Observation:
    """A moment. Lists hold what has arrived since the last step, the earliest first."""

    time: float
    """Seconds since the test began."""
    speed: float
    """Of the car, in m/s."""
    travelled: float
    """The way that the car has covered, in metres."""
    odometry: tuple[float, float, float]
    """x, y and heading of the car as seen from where it began."""
    way: Way
    images: dict[str, NDArray[np.uint8]]
    """The last image of each camera from which one has arrived in this test: (height, width, 3), uint8, read-only."""
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
