"""What robots perceive: sampled on schedule, computed when read."""

from mjmr.sensors.base import Sensor
from mjmr.sensors.camera import Camera
from mjmr.sensors.cart_report import CartReport
from mjmr.sensors.encoders import WheelEncoders
from mjmr.sensors.localizer import Localizer
from mjmr.sensors.motion_status import MotionStatus

__all__ = ["Camera", "CartReport", "Localizer", "MotionStatus", "Sensor", "WheelEncoders"]
