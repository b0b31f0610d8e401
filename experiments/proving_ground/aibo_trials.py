"""The AIBO ERS-7's actions: getting up from random falls, kicks, and how its ball rolls."""

import math
from collections.abc import Mapping
from typing import Any

import mujoco
import numpy as np

from controllers.legged.ers7_keyframes import ERS7_KICKS
from controllers.legged.motion import (
    GET_UP,
    KICK_FORWARD,
    KICK_LEFT,
    KICK_RIGHT,
    WALKING,
    AiboMotion,
    BoundAiboMotion,
)
from controllers.legged.posture import BACK, FRONT, LEFT, POSTURES, RIGHT, STANDING, classify
from experiments.proving_ground.course import Array, Metrics, hall
from mjmr.errors import UnknownNameError
from mjmr.group import Group
from mjmr.randomness import Streams
from mjmr.robots.aibo_ers7 import JOINTS, AiboERS7
from mjmr.simulation import Simulation
from mjmr.world import World

PERIOD = 0.04  # s, five frames of the servos
KICKS = {"forward": KICK_FORWARD, "left": KICK_LEFT, "right": KICK_RIGHT}
FALLS = {"front": FRONT, "left": LEFT, "right": RIGHT, "back": BACK}
# about x [rad]: how it is dropped, to come to rest in each class more often than not
_ROLLS = {FRONT: 0.0, LEFT: -np.pi / 2, RIGHT: np.pi / 2, BACK: np.pi}
_STANDS = 0.1  # m; a robot on its belly is lower
_GIVE_UP = 20.0  # s; five tries take less
_BALL_RESTS = 0.02  # m/s; rolling friction lets it creep on
_BALL_TIME, _KICK_TIME = 20.0, 2.2  # s


def world_with(friction: float, half: float = 8.0) -> World:
    """An empty hall whose floor has this friction with the feet."""
    world = hall(half, overlap=True)

    def floor(spec: Any) -> None:
        spec.geom("floor").friction[0] = friction

    if friction:  # 0: as the world has it
        world.edit(floor)
    return world


class LegRates:
    """How fast the leg joints turn, as shares of the servos' limits, at every physics step."""

    def __init__(self, simulation: Simulation, group: Group):
        """Watch the first robot of ``group`` from now on."""
        drive, data = simulation.drive_of(group), simulation.data
        self._seen: list[Array] = []

        def measure() -> None:
            self._seen.append(np.abs(drive.joint_rates(data)[0, :12]) / AiboERS7.joint_rates[:12])

        simulation.watch_steps(measure)

    def p99(self, since: int = 0, until: int | None = None) -> float:
        """99th percentile over joints and the steps from ``since`` to ``until``."""
        return float(np.percentile(self._seen[since:until], 99))


def fall(simulation: Simulation, group: Group, kind: int, rng: np.random.Generator) -> None:
    """Let the first robot of a group fall, before the first tick, until it lies as it should.

    It is dropped with random joints, 15 to 85 % of their ranges, which its servos hold, and lies
    1 s; if it does not come to rest as ``kind``, it is drawn again.
    """
    model, data = simulation.model, simulation.data
    base, free, servos, angles = _addresses(model, group)
    low, high = AiboERS7.joint_limits.T
    while True:
        data.qvel[:] = 0.0
        roll, pitch = _ROLLS[kind] + rng.uniform(-0.4, 0.4), rng.uniform(-0.4, 0.4)
        about_x = np.array([math.cos(roll / 2), math.sin(roll / 2), 0.0, 0.0])
        about_y = np.array([math.cos(pitch / 2), 0.0, math.sin(pitch / 2), 0.0])
        turned = np.empty(4)
        mujoco.mju_mulQuat(turned, about_y, about_x)
        data.qpos[free : free + 7] = [0.0, 0.0, rng.uniform(0.25, 0.35), *turned]
        data.qpos[angles] = data.ctrl[servos] = low + rng.uniform(0.15, 0.85, 20) * (high - low)
        mujoco.mj_step(model, data, round(1.0 / simulation.timestep))
        if lies_as(data.xmat[base], float(data.xpos[base, 2])) == kind:
            return


def lies_as(rotation: Array, height: float) -> int:
    """True posture of a robot whose base has this rotation (9,) and height [m]."""
    posture = int(classify(rotation[None, 6:])[0])
    return FRONT if posture == STANDING and height < _STANDS else posture


def get_up(condition: Mapping[str, Any], seed: int) -> Metrics:
    """A random fall, then the command to get up.

    Returns:
        ``up``, ``seconds`` from the command until it stood (and still stood half a second later),
        ``tries``, and ``rate_p99``, 99th percentile of leg joints' speeds / limits.
    """
    kind = FALLS.get(condition["variant"])
    if kind is None:
        raise UnknownNameError("fall", condition["variant"], FALLS)
    world = world_with(condition["friction"], 2.0)
    motion = _Watched(automatic=False)
    group = world.add_group(AiboERS7(motion), [[0.0, 0.0, 0.0]])
    simulation = _simulation(world, condition, seed)
    fall(simulation, group, kind, Streams(seed).generator(f"fall {POSTURES[kind]}"))
    base, *_ = _addresses(simulation.model, group)
    data, stood, rates = simulation.data, [], LegRates(simulation, group)

    def look() -> None:
        upright = lies_as(data.xmat[base], float(data.xpos[base, 2])) == STANDING
        if not (upright and motion.bound.status[0] == WALKING):
            stood.clear()
        elif simulation.time > 0:
            stood.append(simulation.time)

    simulation.observe(look)
    for _ in simulation.ticks(_GIVE_UP):
        group.drive(motion.command(action=GET_UP))
        if stood and simulation.time - stood[0] >= 0.5:
            break
    seconds = stood[0] if stood else _GIVE_UP
    return {
        "up": bool(stood),
        "seconds": seconds,
        "tries": int(motion.bound.tries[0]),
        "rate_p99": rates.p99(),
    }


def kick(condition: Mapping[str, Any], seed: int) -> Metrics:
    """A kick at a ball that lies nearly where it should.

    Off by random amounts: ball 6 mm on each axis, heading 2 degrees, joints 0.01 rad (deviations).

    Returns:
        ``distance_m`` from where the ball lay to where it came to rest, ``angle_deg`` of that way,
        anticlockwise from ahead, whether the robot ``fell``, and ``rate_p99`` during the kick, 99th
        percentile of leg joints' speeds / limits.
    """
    code = KICKS.get(condition["variant"])
    if code is None:
        raise UnknownNameError("kick", condition["variant"], KICKS)
    rng = Streams(seed).generator("kick")
    heading = math.radians(2.0) * rng.standard_normal()
    spot = np.array(ERS7_KICKS[code].ball) + 0.006 * rng.standard_normal(2)
    world = world_with(condition["friction"])
    world.add_ball(*spot)
    motion = AiboMotion(automatic=False)
    group = world.add_group(AiboERS7(motion), [[0.0, 0.0, heading]])
    simulation = _simulation(world, condition, seed)
    off = 0.01 * rng.standard_normal(20)
    low, high = AiboERS7.joint_limits.T
    base, _, _, angles = _addresses(simulation.model, group)
    simulation.data.qpos[angles] = (simulation.data.qpos[angles] + off).clip(low, high)
    data, seen, rates = simulation.data, [], LegRates(simulation, group)
    simulation.observe(lambda: seen.append(simulation.truth.movers()[0, :2]))
    for t in simulation.ticks(_BALL_TIME):
        group.drive(motion.command(action=code))
        if t > 4.0 and np.hypot(*(seen[-1] - seen[-2])) < _BALL_RESTS * PERIOD:
            break
    way = seen[-1] - spot
    stands = lies_as(data.xmat[base], float(data.xpos[base, 2])) == STANDING
    return {
        "distance_m": float(np.hypot(*way)),
        "angle_deg": math.degrees(math.atan2(way[1], way[0])),
        "fell": not stands,
        # the kick itself: afterwards it stands and watches the ball
        "rate_p99": rates.p99(until=round(_KICK_TIME / simulation.timestep)),
    }


def roll(condition: Mapping[str, Any], seed: int) -> Metrics:
    """A ball that rolls, from 1 m/s to rest; returns how far, ``distance_m``."""
    world = world_with(condition["friction"])
    ball = world.add_ball(-4.0, 0.0)
    # a simulation needs somebody in it
    world.add_group(AiboERS7, [[-4.0, 4.0, 0.0]])
    simulation = _simulation(world, condition, seed)
    spin = simulation.model.joint(world.movers[0][0]).dofadr[0]
    simulation.data.qvel[[spin, spin + 4]] = 1.0, 1.0 / ball.radius
    seen: list[Array] = []
    simulation.observe(lambda: seen.append(simulation.truth.movers()[0, :2]))
    for t in simulation.ticks(_BALL_TIME):
        if t > 1.0 and np.hypot(*(seen[-1] - seen[-2])) < _BALL_RESTS * PERIOD:
            break
    return {"distance_m": float(np.hypot(*(seen[-1] - seen[0])))}


class _Watched(AiboMotion):
    """Keeps the engine at work, whose status is asked for."""

    def bind(self, n: int) -> BoundAiboMotion:
        self.bound = super().bind(n)
        return self.bound


def _simulation(world: World, condition: Mapping[str, Any], seed: int) -> Simulation:
    return Simulation(world, seed=seed, control_period=PERIOD, dt_max=condition["dt_ms"] / 1000.0)


def _addresses(model: mujoco.MjModel, group: Group) -> tuple[int, int, Array, Array]:
    """Of the first robot: base body, free joint in qpos, servos, and joints in qpos."""
    prefix = group.prefixes[0]
    servos = np.array([model.actuator(prefix + joint.name).id for joint in JOINTS])
    angles = model.jnt_qposadr[model.actuator_trnid[servos, 0]]
    free = int(model.joint(f"{prefix}free").qposadr[0])
    return int(model.body(f"{prefix}base").id), free, servos, angles
