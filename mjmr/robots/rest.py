"""Rest: how a robot stands on the floor by its own weight."""

import copy
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError
from mjmr.robots.platform import FLOOR, Array

if TYPE_CHECKING:
    import mujoco

_START = -3e-4  # m, of the base: every wheel touches the floor
_NUDGE = 1e-7
_STILL = 1e-9  # m/s^2 or rad/s^2


def rest(model: "mujoco.MjModel", base: int, freedoms: NDArray[np.int64]) -> Array:
    """Positions ``qpos`` (nq,) of the model in which one robot stands still; the others float.

    Args:
        model: The compiled model.
        base: The robot's body with a free joint; its origin is on the floor.
        freedoms: Indices in ``qvel`` of what weight moves: the free joint's third (height) first,
            then its rotations, springs ...

    Raises:
        InvalidInputError: It finds no rest: the weight is not above the wheels.
    """
    import mujoco

    only = alone(model, base)
    data = mujoco.MjData(only)

    def acceleration(moved: Array) -> Array:
        step = np.zeros(only.nv)
        step[freedoms] = moved
        data.qpos[:] = only.qpos0
        mujoco.mj_integratePos(only, data.qpos, step, 1.0)
        mujoco.mj_forward(only, data)
        return data.qacc[freedoms].copy()

    # Newton's method: contact forces grow smoothly with depth
    moved = np.zeros(len(freedoms))
    moved[0] = _START
    nudges = _NUDGE * np.eye(len(freedoms))
    found = acceleration(moved)
    for _ in range(30):
        if np.abs(found).max() < _STILL:
            return data.qpos.copy()
        slopes = [(acceleration(moved + nudge) - found) / _NUDGE for nudge in nudges]
        try:
            moved -= np.linalg.solve(np.transpose(slopes), found)
        except np.linalg.LinAlgError:  # a wheel has left the floor
            break
        found = acceleration(moved)
    raise InvalidInputError(
        f"{model.body(base).name} does not stand still on its wheels (an acceleration of "
        f"{np.abs(found).max():.2g} is left); its centre of mass must be above them"
    )


def alone(model: "mujoco.MjModel", base: int) -> "mujoco.MjModel":
    """Copy of a model in which only the floor and the robot with this base, a body, collide."""
    only = copy.copy(model)
    others = only.body_rootid[only.geom_bodyid] != base
    others[model.geom(FLOOR).id] = False
    only.geom_contype[others] = 0
    only.geom_conaffinity[others] = 0
    return only
