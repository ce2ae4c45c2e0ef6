"""The sensors of a driver.

Lengths are in metres, times in seconds, and angles in radians, unless a name says otherwise. A position on the car is seen from the middle of the
box of the car on the ground, with x ahead, y to the left and z up.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from typing import Any


@dataclass(frozen=True)
class Camera:
    """A camera. The usual camera is the camera of `paracosm-fuzz record`: at the front, 74 degrees across, 200 x 66 pixels, 10 Hz.

    - width, height: the size of the images in pixels
    - focal_mm, sensor_mm: the focal length and the width of the image sensor in millimetres
    - x, y, z: the position of the camera on the car
    - yaw_degrees, pitch_degrees, roll_degrees: the direction: first to the left, then downwards, then rolled to the right
    - rate: the number of images per second
    - latency: the seconds between the taking of an image and its arrival at the driver
    - dropped: the probability that an image is lost
    - motion, motion_angle_degrees: the length of motion blur in pixels, and its direction counter-clockwise from the right
    - defocus: the radius in pixels of the disc into which the lens blurs a point that is out of focus
    - blur: the standard deviation of the blur of the lens in pixels
    - vignetting: the loss of light towards the corners of the image, from 0 to 1
    - exposure: the exposure in stops
    - full_well: the full well capacity of a pixel in electrons; 0 for images without shot noise
    - read_noise: the read noise of a pixel in electrons
    - lens: further settings of the lens and the image sensor, by their names in files of cameras
    """

    width: int = 200
    height: int = 66
    focal_mm: float = 24.0
    sensor_mm: float = 36.0
    x: float = 0.3
    y: float = 0.0
    z: float = 1.35
    yaw_degrees: float = 0.0
    pitch_degrees: float = 2.0
    roll_degrees: float = 0.0
    rate: float = 10.0
    latency: float = 0.0
    dropped: float = 0.0
    motion: float = 0.0
    motion_angle_degrees: float = 0.0
    defocus: float = 0.0
    blur: float = 0.0
    vignetting: float = 0.0
    exposure: float = 0.0
    full_well: float = 0.0
    read_noise: float = 0.0
    lens: Mapping[str, float] = field(default_factory=dict, hash=False)


@dataclass(frozen=True)
class Mount:
    """The place of an upright sensor on the car.

    - x, y, z: the position on the car
    - heading: the direction of the sensor to the left of the heading of the car
    """

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    heading: float = 0.0


@dataclass(frozen=True)
class Inaccuracy:
    """The inaccuracy of a quantity, in the unit of the quantity.

    - noise: the standard deviation of the noise of each reading
    - bias: the standard deviation of the bias at the start of a test
    - walk: the standard deviation of the change of the bias within one second
    """

    noise: float = 0.0
    bias: float = 0.0
    walk: float = 0.0


@dataclass(frozen=True)
class Delivery:
    """The delay and the loss of readings on their way from a sensor to the driver.

    - latency: the seconds between a measurement and its arrival
    - loss: the probability that a reading is lost
    """

    latency: float = 0.0
    loss: float = 0.0


@dataclass(frozen=True)
class Lidar:
    """A LiDAR. Brackets show the default of a setting that is `None`.

    - delivery: the delay and the loss of scans [none]
    - mount: the place of the sensor [2 m above the middle of the car, looking ahead]
    - period: the seconds of one turn [0.1]
    - channels, lowest, highest: the number of channels, and the elevations of the lowest and the highest channel [32, -30 and 10 degrees]
    - columns: the number of measurements of each channel in a turn [1800]
    - range: the greatest distance that the sensor measures [100]
    - noise: the standard deviation of the noise of a distance [0.02]
    - attenuation: the attenuation of the intensity in clear air, in 1/m [0.004]
    - sure: the least intensity at which no echo is lost for weakness [0.8]. Below, the loss is 1 - intensity / sure
    - loss: the probability that an echo is lost independently of its intensity [0]
    """

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
    """A satellite receiver. Brackets show the default of a setting that is `None`.

    - delivery: the delay and the loss of fixes [none]
    - mount: the place of the antenna [1.5 m above the middle of the car]
    - period: the seconds between two fixes [0.1]
    - position: the inaccuracy of positions in m [noise 0.5, bias 1, walk 0.05]
    - velocity_noise: the standard deviation of the noise of each coordinate of the velocity, in m/s [0.05]
    - outages, outage_duration: the rate of outages in 1/s, and the mean duration of an outage in s [0 and 5]
    """

    delivery: Delivery | None = None
    mount: Mount | None = None
    period: float | None = None
    position: Inaccuracy | None = None
    velocity_noise: float | None = None
    outages: float | None = None
    outage_duration: float | None = None


@dataclass(frozen=True)
class Imu:
    """An inertial measurement unit. Brackets show the default of a setting that is `None`.

    - delivery: the delay and the loss of readings [none]
    - period: the seconds between two readings [0.01]
    - acceleration: the inaccuracy of accelerations in m/s^2 [noise 0.05, bias 0.05, walk 0.001]
    - yaw_rate: the inaccuracy of yaw rates in rad/s [noise 0.0017, bias 0.0017, walk 0.00005]
    """

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
