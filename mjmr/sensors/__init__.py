"""What robots perceive: sampled on schedule, computed when read."""

from mjmr.sensors.base import Sensor
from mjmr.sensors.cable_tension import CableTension
from mjmr.sensors.camera import Camera
from mjmr.sensors.cart_report import CartReport
from mjmr.sensors.encoders import WheelEncoders
from mjmr.sensors.localizer import Localizer

__all__ = ["CableTension", "Camera", "CartReport", "Localizer", "Sensor", "WheelEncoders"]
