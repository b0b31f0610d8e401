"""Lifting: somebody picks robots up and puts them down elsewhere, at rest.

That is no motion of a robot's own: it is what an operator does who places robots at a start, or
takes those away that have arrived. The one way to do it is
:meth:`mjmr.loop.TickedSimulation.lift`, which no controller can call.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError
from mjmr.robots.platform import Array, Drive, FramedDrive

if TYPE_CHECKING:
    import mujoco

    from mjmr.group import Group

Rows = NDArray[np.int64]


def check_lift(group: "Group", rows: ArrayLike, poses: ArrayLike) -> tuple[Rows, Array]:
    """Robots to be lifted (k,) and where to (k, 3), as arrays of their own.

    Raises:
        InvalidInputError: No such robot, one twice, poses of another shape or not finite, or rigs.
    """
    if group.platform.anchored:
        raise InvalidInputError(f"{group.name}: a rig stands where its world was built")
    given = np.asarray(rows)
    where = np.array(poses, dtype=np.float64)
    if given.ndim != 1 or (given.size and not np.issubdtype(given.dtype, np.integer)):
        raise InvalidInputError(f"robots to be lifted are a list of their indices; got {rows!r}")
    which = given.astype(np.int64)
    if ((which < 0) | (which >= group.n)).any() or len(np.unique(which)) != len(which):
        raise InvalidInputError(
            f"robots to be lifted are distinct indices from 0 to {group.n - 1}; got "
            f"{which.tolist()}"
        )
    if where.shape != (len(which), 3) or not np.isfinite(where).all():
        raise InvalidInputError(
            f"a pose for each of {len(which)} lifted robots has shape ({len(which)}, 3) and is "
            f"finite; got shape {where.shape}"
        )
    return which, where


class Lifter:
    """Where the robots of one group are in MuJoCo's arrays, and how they are put down.

    They are put down as :meth:`mjmr.robots.platform.Drive.place` does; wheels keep their angles,
    which encoders count.
    """

    def __init__(self, model: "mujoco.MjModel", group: "Group", drive: Drive):
        """Look everything up.

        Raises:
            InvalidInputError: The drive has a memory that a lift would leave wrong.
        """
        if isinstance(drive, FramedDrive):
            raise InvalidInputError(
                f"{group.name}: robots whose firmware runs at a rate of its own cannot be lifted"
            )
        self._drive = drive
        own = [_own(model, prefix) for prefix in group.prefixes]
        self._qpos, self._qvel, self._act, self._ctrl, self._wheels = (
            np.array(column, dtype=np.int64) for column in zip(*own, strict=True)
        )

    def put_down(self, data: "mujoco.MjData", rows: Rows, poses: Array) -> None:
        """Put robots ``rows`` down at rest at ``poses`` (k, 3); nobody else is touched."""
        everybody = self._drive.poses(data)
        everybody[rows] = poses
        arrays = (data.qpos, data.qvel, data.act, data.ctrl)
        before = [array.copy() for array in arrays]
        self._drive.place(data, everybody)
        for array, kept, columns in zip(
            arrays, before, (self._qpos, self._qvel, self._act, self._ctrl), strict=True
        ):
            placed = array[columns[rows]]
            array[:] = kept
            array[columns[rows]] = placed
        wheels = self._wheels[rows]
        data.qpos[wheels] = before[0][wheels]
        data.qacc_warmstart[self._qvel[rows]] = 0.0


def _own(model: Any, prefix: str) -> Sequence[list[int]]:
    """Columns of one robot in qpos, qvel, act and ctrl; those in qpos of wheels."""
    import mujoco

    sizes = {mujoco.mjtJoint.mjJNT_FREE: (7, 6), mujoco.mjtJoint.mjJNT_BALL: (4, 3)}
    qpos: list[int] = []
    qvel: list[int] = []
    wheels: list[int] = []
    for joint in range(model.njnt):
        body = model.jnt_bodyid[joint]
        if not model.body(body).name.startswith(prefix):
            continue
        kind = mujoco.mjtJoint(int(model.jnt_type[joint]))
        places, speeds = sizes.get(kind, (1, 1))
        first, velocity = int(model.jnt_qposadr[joint]), int(model.jnt_dofadr[joint])
        qpos.extend(range(first, first + places))
        qvel.extend(range(velocity, velocity + speeds))
        # a hinge of the base itself is the heading of a planar robot
        turns_freely = kind == mujoco.mjtJoint.mjJNT_HINGE and not model.jnt_limited[joint]
        if turns_freely and model.body_parentid[body] != 0:
            wheels.append(first)
    servos = [i for i in range(model.nu) if model.actuator(i).name.startswith(prefix)]
    act = [int(model.actuator_actadr[i]) for i in servos if model.actuator_actadr[i] >= 0]
    return qpos, qvel, act, servos, wheels
