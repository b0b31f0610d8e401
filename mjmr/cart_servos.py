"""The carts of a compiled model: their servos and where they are."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import mujoco
import numpy as np
from numpy.typing import NDArray

from mjmr.cart import Cart

if TYPE_CHECKING:
    from mjmr.world import World

_BANDWIDTH = 30.0  # of the servo [rad/s]
_CLEARANCE = 0.003  # between a cart and the floor [m]


def add_cart(spec: mujoco.MjSpec, name: str, cart: Cart) -> None:
    """Add a cart, its rail and its servo to ``spec``."""
    quat = [np.cos(cart.yaw / 2), 0, 0, np.sin(cart.yaw / 2)]
    half = [cart.length / 2, cart.width / 2, (cart.height - _CLEARANCE) / 2]
    spec.worldbody.add_geom(
        type=mujoco.mjtGeom.mjGEOM_BOX,
        pos=[cart.x, cart.y, 0.0012],
        quat=quat,
        size=[(cart.travel + cart.length) / 2, 0.015, 0.0012],
        material="wall",
        contype=0,
        conaffinity=0,
        group=1,
    )
    body = spec.worldbody.add_body(name=name, pos=[cart.x, cart.y, half[2] + _CLEARANCE], quat=quat)
    joint = body.add_joint(name=name, type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[1, 0, 0])
    joint.actfrclimited = mujoco.mjtLimited.mjLIMITED_TRUE
    joint.actfrcrange = [-cart.force, cart.force]
    body.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_BOX,
        size=half,
        mass=cart.mass,
        material="cart" if cart.material == "plain" else cart.material,
        friction=[0.3, 0.005, 0.0001],
        group=0,
    )
    gains = {"place": cart.mass * _BANDWIDTH**2, "speed": 2.0 * cart.mass * _BANDWIDTH}
    for kind, gain in gains.items():
        spec.add_actuator(
            name=f"{name}_{kind}",
            trntype=mujoco.mjtTrn.mjTRN_JOINT,
            target=name,
            gaintype=mujoco.mjtGain.mjGAIN_FIXED,
            biastype=mujoco.mjtBias.mjBIAS_AFFINE,
            gainprm=[gain] + [0.0] * 9,
            biasprm=[0.0, -gain if kind == "place" else 0.0, -gain if kind == "speed" else 0.0]
            + [0.0] * 7,
        )


class CartServos:
    """Every cart of a world in one compiled model."""

    def __init__(self, model: mujoco.MjModel, world: "World"):
        """Look up every index once."""
        named = world.carts
        self._carts: Sequence[Cart] = [cart for _, cart in named]
        joints = [model.joint(name) for name, _ in named]
        self._qpos = np.array([j.qposadr[0] for j in joints], dtype=np.int64)
        self._qvel = np.array([j.dofadr[0] for j in joints], dtype=np.int64)
        self._place = np.array([model.actuator(f"{n}_place").id for n, _ in named], dtype=np.int64)
        self._speed = np.array([model.actuator(f"{n}_speed").id for n, _ in named], dtype=np.int64)

    def place(self, data: mujoco.MjData, time: float) -> None:
        """Put the carts where they are at ``time`` [s]; before a run, never inside one."""
        for cart, q, v in zip(self._carts, self._qpos, self._qvel, strict=True):
            data.qpos[q], data.qvel[v] = cart.along(time)

    def drive(self, data: mujoco.MjData, time: float, period: float) -> None:
        """Aim the servos for the control period that begins at ``time`` [s] at its middle."""
        for cart, place, speed in zip(self._carts, self._place, self._speed, strict=True):
            data.ctrl[place], data.ctrl[speed] = cart.along(time + period / 2)

    def boxes(self, data: mujoco.MjData) -> NDArray[np.float64]:
        """The carts as boxes (k, 5): x, y, yaw, half-length, half-width [m, rad]."""
        rows = [cart.box(data.qpos[q]) for cart, q in zip(self._carts, self._qpos, strict=True)]
        return np.array(rows).reshape(-1, 5)
