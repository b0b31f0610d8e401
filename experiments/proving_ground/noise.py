"""Every actuator driven by noise from a random start: nothing may warn, whatever is mounted."""

from collections.abc import Callable, Mapping
from typing import Any

import mujoco
import numpy as np
from scipy.stats import qmc

from experiments.proving_ground.course import ALL, Metrics, demand, hall, sheet
from mjmr.claims import Bound, Claim
from mjmr.randomness import Streams
from mjmr.robots import platform_class
from mjmr.robots.nims import CABLES, Nims
from mjmr.robots.platform import Platform
from mjmr.sensors.base import Sensor
from mjmr.sensors.bumper import Bumper
from mjmr.sensors.cable_tension import CableTension
from mjmr.sensors.compass import Compass
from mjmr.sensors.force_torque import ForceTorque
from mjmr.sensors.imu import IMU
from mjmr.sensors.lidar import Lidar
from mjmr.sensors.line_of_sight import LineOfSight
from mjmr.sensors.localizer import Localizer
from mjmr.sensors.pan_tilt import PanTilt
from mjmr.sensors.proximity import InfraredProximity
from mjmr.sensors.rangers import InfraredRanger, Sonar
from mjmr.simulation import Simulation

SECONDS, HOLD = 1.0, 20  # s, steps a value is held


def noise(condition: Mapping[str, Any], seed: int) -> Metrics:
    """One second of Halton noise on all actuators, from a random pose in front of a box.

    Every sensor is read ten times on the way.
    """
    rng = Streams(seed).generator("start")
    platform = _robot(condition["platform"], rng)
    world = hall(4.0)
    pose = np.zeros(3)
    if not platform.anchored:
        pose = rng.uniform([-2.5, -2.5, -np.pi], [2.5, 2.5, np.pi])
        away = platform.radius + 0.2
        x, y = pose[:2] + away * np.array([np.cos(pose[2]), np.sin(pose[2])])
        world.add_box(x, y, 0.4, 0.4, yaw=pose[2], height=0.4, mass=3.0)
    group = world.add_group(platform, [pose])
    for sensor in (*_everywhere(), *_OF[condition["platform"]]()):
        # the AIBO's model has something called imu, and soccer robots have a localizer
        group.mount(sensor, f"{sensor.name}_here")
    simulation = Simulation(world, seed=seed, dt_max=condition["dt_ms"] / 1000.0)
    model, data = simulation.model, simulation.data
    count = round(SECONDS / simulation.timestep / HOLD)
    halton = qmc.Halton(model.nu, scramble=True, rng=rng).random(count)
    low, high = _ranges(model)
    fastest = 0.0
    for row in low + halton * (high - low):
        data.ctrl[:] = row
        mujoco.mj_step(model, data, HOLD)
        simulation.step += HOLD
        fastest = max(fastest, float(np.abs(data.qvel).max()))
        for sensor in group.sensors.values():
            sensor.capture(simulation.step, simulation.time)
            sensor.read()
    demand("fastest speed", fastest, 0.1)
    return {
        "warnings": int(data.warning.number.sum()),
        "finite": bool(np.isfinite(data.qpos).all() and np.isfinite(data.qvel).all()),
        "fastest": fastest,
    }


def _robot(name: str, rng: np.random.Generator) -> Platform:
    """A platform; NIMS, whose rig stands still, has either cable and starts anywhere on it."""
    if name != Nims.name:
        return platform_class(name)()
    reach = Nims().reach
    return Nims(cable=CABLES[rng.integers(2)], along=rng.uniform(-reach, reach))


def _everywhere() -> list[Sensor]:
    lidar = Lidar(position=(0.0, 0.0, 0.3))
    return [lidar, Compass(), IMU(), Bumper(), Localizer(), LineOfSight()]


_OF: dict[str, Callable[[], list[Sensor]]] = {
    "pioneer2dx": lambda: [Sonar(), PanTilt()],
    "koala": lambda: [InfraredRanger(), PanTilt()],
    "aibo_ers7": lambda: [InfraredRanger(sites=("ir_head", "ir_chest")), ForceTorque(body="head")],
    "tamiya_txt1": lambda: [Sonar(), PanTilt()],
    "round_pusher": list,
    "nims": lambda: [CableTension(), ForceTorque(site="package")],
    "soccer_bot": list,
    "tj_pro": lambda: [InfraredProximity(trip=0.1)],
    "four_wheeler": lambda: [PanTilt()],
}


def _ranges(model: Any) -> tuple[np.ndarray, np.ndarray]:
    """Lowest and highest control of every actuator.

    Ramped servos have no range of their own: theirs takes the set point in 50 ms as far as what
    saturates the motor.
    """
    limited = model.actuator_ctrllimited.astype(bool)
    # a winch pulls only: its limit is the lower one
    gain, most = model.actuator_gainprm[:, 0], np.abs(model.actuator_forcerange).max(axis=1)
    ramp = np.where(most > 0, most / np.where(gain > 0, gain, 1.0) / 0.05, 10.0)
    low = np.where(limited, model.actuator_ctrlrange[:, 0], -ramp)
    high = np.where(limited, model.actuator_ctrlrange[:, 1], ramp)
    return low, high


def claims(platform: str) -> list[Claim]:
    """What every platform must survive."""
    words = "survives whatever its actuators do"
    how = "1 s of Halton noise on all actuators from random starts, sensors mounted"
    return [
        sheet(platform, "noise", "warnings", words, f"{how}; MuJoCo's warnings, most in a trial",
              Bound("<=", 0.0), "warnings", sizes=ALL),
        sheet(platform, "noise", "finite", words, f"{how}; whether every coordinate is finite",
              Bound(">=", 1.0), "finite", sizes=ALL),
    ]  # fmt: skip
