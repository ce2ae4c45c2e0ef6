"""What a driver can measure with. Lengths in metres, times in seconds, angles in radians unless a name says otherwise.

Positions on the car are as seen from the middle of its box on the ground: x ahead, y to the left, z up.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from typing import Any


@dataclass(frozen=True)
class Camera:
    """A camera; the usual one is that of `paracosm-fuzz record`: at the front, 74 degrees across, 200 x 66 pixels, 10 Hz."""

    width: int = 200
    height: int = 66
    focal_mm: float = 24.0
    sensor_mm: float = 36.0
    x: float = 0.3
    y: float = 0.0
    z: float = 1.35
    yaw_degrees: float = 0.0  # to the left
    pitch_degrees: float = 2.0  # downwards
    roll_degrees: float = 0.0  # to the right
    rate: float = 10.0  # images per second
    latency: float = 0.0  # from when an image is taken to when it is there
    dropped: float = 0.0  # the probability that an image is lost
    motion: float = 0.0  # pixels over which motion smears the image,
    motion_angle_degrees: float = 0.0  # and which way, counter-clockwise from the right
    defocus: float = 0.0  # the radius of the disc that a point becomes, in pixels
    blur: float = 0.0  # the standard deviation of the lens's blur, in pixels
    vignetting: float = 0.0  # from 0 to 1: how much darker it gets towards the corners
    exposure: float = 0.0  # stops
    full_well: float = 0.0  # electrons; 0 for no shot noise
    read_noise: float = 0.0  # electrons
    lens: Mapping[str, float] = field(default_factory=dict, hash=False)  # further settings, by their names in camera files


@dataclass(frozen=True)
class Mount:
    """Where a sensor sits, upright, and where it looks: to the left of where the car points."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    heading: float = 0.0


@dataclass(frozen=True)
class Inaccuracy:
    """How far off a quantity is: standard deviations of every reading, of the bias at first, of its change in a second."""

    noise: float = 0.0
    bias: float = 0.0
    walk: float = 0.0


@dataclass(frozen=True)
class Delivery:
    """What becomes of readings on their way: their latency, and the probability that one is lost."""

    latency: float = 0.0
    loss: float = 0.0


@dataclass(frozen=True)
class Lidar:
    """A LiDAR. What is `None` is as PARACOSM has it: 32 channels from -30 to 10 degrees, 1800 columns, 10 Hz, 100 m."""

    delivery: Delivery | None = None
    mount: Mount | None = None
    period: float | None = None
    channels: int | None = None
    lowest: float | None = None
    highest: float | None = None
    columns: int | None = None
    range: float | None = None
    noise: float | None = None
    attenuation: float | None = None
    sure: float | None = None
    loss: float | None = None


@dataclass(frozen=True)
class Gnss:
    """A satellite receiver. What is `None` is as PARACOSM has it: 10 Hz, off by half a metre and a bias of one."""

    delivery: Delivery | None = None
    mount: Mount | None = None
    period: float | None = None
    position: Inaccuracy | None = None
    velocity_noise: float | None = None
    outages: float | None = None
    outage_duration: float | None = None


@dataclass(frozen=True)
class Imu:
    """An inertial measurement unit. What is `None` is as PARACOSM has it: 100 Hz, as cars have them."""

    delivery: Delivery | None = None
    period: float | None = None
    acceleration: Inaccuracy | None = None
    yaw_rate: Inaccuracy | None = None


def write(sensor: Any, message: Any) -> None:
    """Writes what is set of a sensor to its message."""
    for setting in fields(sensor):
        value = getattr(sensor, setting.name)
        if is_dataclass(value):
            part = getattr(message, setting.name)
            part.SetInParent()
            write(value, part)
        elif isinstance(value, Mapping):
            getattr(message, setting.name).update(value)
        elif value is not None:
            setattr(message, setting.name, value)
