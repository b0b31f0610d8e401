"""What robots perceive: sampled on schedule, computed when read."""

from mjmr.sensors.base import Sensor
from mjmr.sensors.camera import Camera
from mjmr.sensors.cart_report import CartReport
from mjmr.sensors.encoders import WheelEncoders
from mjmr.sensors.lidar import Lidar
from mjmr.sensors.line_of_sight import LineOfSight
from mjmr.sensors.localizer import Localizer
from mjmr.sensors.rangers import InfraredRanger, Sonar

__all__ = [
    "Camera",
    "CartReport",
    "InfraredRanger",
    "Lidar",
    "LineOfSight",
    "Localizer",
    "Sensor",
    "Sonar",
    "WheelEncoders",
]
