"""What robots perceive: sampled on schedule, computed when read."""

from mjmr.sensors.base import Sensor
from mjmr.sensors.beacon import Beacon
from mjmr.sensors.bumper import Bumper
from mjmr.sensors.cable_tension import CableTension
from mjmr.sensors.camera import Camera
from mjmr.sensors.cart_report import CartReport
from mjmr.sensors.compass import Compass
from mjmr.sensors.encoders import WheelEncoders
from mjmr.sensors.floor_patch import FloorPatch
from mjmr.sensors.force_torque import ForceTorque
from mjmr.sensors.imu import IMU
from mjmr.sensors.lidar import Lidar
from mjmr.sensors.line_of_sight import LineOfSight
from mjmr.sensors.localizer import Localizer
from mjmr.sensors.motion_status import MotionStatus
from mjmr.sensors.pan_tilt import PanTilt
from mjmr.sensors.proximity import InfraredProximity
from mjmr.sensors.rangers import InfraredRanger, Sonar
from mjmr.sensors.turret import Turret
from mjmr.sensors.visual_arc import VisualArc

__all__ = [
    "Beacon",
    "Bumper",
    "CableTension",
    "Camera",
    "CartReport",
    "Compass",
    "FloorPatch",
    "ForceTorque",
    "IMU",
    "InfraredProximity",
    "InfraredRanger",
    "Lidar",
    "LineOfSight",
    "Localizer",
    "MotionStatus",
    "PanTilt",
    "Sensor",
    "Sonar",
    "Turret",
    "VisualArc",
    "WheelEncoders",
]
