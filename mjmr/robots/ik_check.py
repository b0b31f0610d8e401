"""Inverse kinematics of legs by optimisation on the compiled model: mink, to design and to check.

It knows nothing but the MJCF, so it checks closed forms that controllers use, and it solves for
robots that have none. At run time a closed form is some 500 times faster.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError

if TYPE_CHECKING:
    import mujoco

Array = NDArray[np.float64]
_ITERATIONS = 50


def legs_by_mink(
    model: "mujoco.MjModel",
    loci: ArrayLike,
    *,
    feet: Sequence[str],
    joints: Sequence[str],
    tolerance: float = 1e-7,
) -> Array:
    """Joint angles along loci of the feet, each point solved from the one before.

    The body is held at the origin and all joints but ``joints`` where keyframe ``home`` has them:
    as a constraint of the quadratic programme, for a heavy cost instead of it lets the body give
    way while the feet match. Starting in a standing pose keeps knees on the side they bend to.

    Args:
        model: One robot, without a world, with a joint ``free`` and a keyframe ``home``.
        loci: Where the feet shall be (k, f, 3) [m], body frame; neighbours a few millimetres apart.
        feet: Sites at the centres of the feet, f names.
        joints: That may move, names.
        tolerance: Largest distance of a foot from where it shall be [m].

    Returns:
        Angles (k, len(joints)) [rad].

    Raises:
        InvalidInputError: Another shape, or a point whose residual stays above ``tolerance``:
            unreachable, or too far from the one before.
    """
    import mink

    targets = np.asarray(loci, dtype=np.float64)
    if targets.ndim != 3 or targets.shape[1:] != (len(feet), 3) or not np.isfinite(targets).all():
        raise InvalidInputError(
            f"loci must be finite and have shape (k, {len(feet)}, 3); got {targets.shape}"
        )
    home = model.key("home").qpos.copy()
    free = model.joint("free").qposadr[0]
    home[free : free + 7] = [0, 0, 0, 1, 0, 0, 0]
    moving = [model.joint(name) for name in joints]
    dofs = [int(joint.dofadr[0]) for joint in moving]
    angles = np.array([joint.qposadr[0] for joint in moving])
    body = mink.Configuration(model, home)
    tasks = [mink.FrameTask(f, "site", position_cost=1.0, orientation_cost=0.0) for f in feet]
    held = mink.DofFreezingTask(model, [i for i in range(model.nv) if i not in dofs])
    limits = [mink.ConfigurationLimit(model)]
    found = np.empty((len(targets), len(dofs)))
    for k, points in enumerate(targets):
        for task, point in zip(tasks, points, strict=True):
            task.set_target(mink.SE3.from_translation(point))
        residual = _residual(body, feet, points)
        for _ in range(_ITERATIONS):
            if residual.max() < tolerance:
                break
            step = mink.solve_ik(
                body, tasks, 1.0, "daqp", damping=1e-9, limits=limits, constraints=[held]
            )
            body.integrate_inplace(step, 1.0)
            residual = _residual(body, feet, points)
        # mink raises nothing when a target is out of reach
        if residual.max() >= tolerance:
            worst = int(residual.argmax())
            raise InvalidInputError(
                f"foot {feet[worst]} stays {1e3 * residual[worst]:.2g} mm from point {k} of its "
                f"locus: out of reach, or too far from the point before"
            )
        found[k] = body.q[angles]
    return found


def _residual(body: Any, feet: Sequence[str], points: Array) -> Array:
    return np.linalg.norm(
        [body.data.site(f).xpos - p for f, p in zip(feet, points, strict=True)], axis=1
    )
