"""Disc: a round object that slides on the floor and resists with a stated friction force."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError

if TYPE_CHECKING:
    import mujoco

_GRAVITY = 9.81  # m/s^2, of every mjmr world
_COEFFICIENT = 0.6  # of friction with the floor where no mass is given
_FOOT = 0.02  # m, radius of the foot
_GRIP = 0.01  # friction coefficient of the foot, which a spring presses down
_SPRING = 10.0  # m, by which that spring is drawn out: its force hardly depends on the height
_TIME = 0.02  # s, time constant of the foot's contact
_RIM = 0.08  # m, height at which it is touched, as round pushers are
_CLEARANCE = 0.004  # m, between the hull and the floor
_HULL_FRICTION = 0.1
JOINTS = ("", "_y", "_z", "_yaw")  # of a disc: its name and these


@dataclass(frozen=True, kw_only=True)
class Disc:
    """An upright cylinder that slides on the floor, turns about the vertical and cannot tip.

    Rays and cameras meet the cylinder. What touches it touches the same circle at a height of
    80 mm, the equator of a sphere: things lower than that, or with a slanting face, would press it
    down or lift it.

    Its floor friction is that of an evenly loaded disc, as far as an ellipsoid of force and torque
    describes it (Howe and Cutkosky, 1996): ``friction_force`` against sliding in any direction,
    ``friction_force * 2/3 radius`` against turning in place, less of either together.

    Attributes:
        x: Centre [m], world frame.
        y: The same.
        radius: [m].
        height: [m].
        friction_force: Force at which it slides [N].
        mass: [kg]; None: such that the friction force makes a coefficient of 0.6.
        rgba: Colour, 0 to 1.

    Raises:
        InvalidInputError: A size, mass or force that is not positive and finite.
    """

    x: float
    y: float
    radius: float
    height: float = 0.26
    friction_force: float
    mass: float | None = None
    rgba: tuple[float, float, float, float] = (0.95, 0.45, 0.05, 1.0)

    def __post_init__(self):
        if not (math.isfinite(self.x) and math.isfinite(self.y)):
            raise InvalidInputError(f"a disc's place must be finite; got {self.x}, {self.y}")
        for name in ("radius", "height", "friction_force", "mass"):
            value = getattr(self, name)
            if not (name == "mass" and value is None or 0 < value < math.inf):
                raise InvalidInputError(f"a disc's {name} must be positive and finite; got {value}")
        if self.height <= _RIM:
            raise InvalidInputError(
                f"a disc is touched at a height of {_RIM:g} m and must be higher; got "
                f"{self.height} m"
            )

    @property
    def weight(self) -> float:
        """Mass [kg], given or chosen."""
        return self.friction_force / (_COEFFICIENT * _GRAVITY) if self.mass is None else self.mass


def add_disc(spec: "mujoco.MjSpec", name: str, disc: Disc, floor: str) -> None:
    """Add a disc to ``spec``: hull, a rim that is pushed, a foot that carries all floor friction.

    One foot, because the friction force of several depends on how the weight is shared and each
    creeps; three slides and a hinge instead of a free joint, because one foot holds nothing
    upright. Positions of the joints are world coordinates.

    Args:
        spec: The world's.
        name: Of body, hull and first joint; the others are called as ``JOINTS`` says.
        disc: What to add.
        floor: Name of the floor's geom.
    """
    import mujoco

    load = disc.friction_force / _GRIP
    rate = 2.0 / _TIME
    # soft enough to stay on the floor when it slides at twice what robots do
    softness = _GRIP * rate * disc.weight / load
    hardness = 1.0 / (1.0 + softness)
    # as deep as the spring presses it in at rest; less when it slides
    depth = _GRIP * rate * hardness * _TIME**2
    at = [disc.x, disc.y, disc.height / 2 - depth]
    body = spec.worldbody.add_body(name=name, pos=at)
    slide, hinge = mujoco.mjtJoint.mjJNT_SLIDE, mujoco.mjtJoint.mjJNT_HINGE
    for k, ending in enumerate(JOINTS[:3]):
        body.add_joint(name=name + ending, type=slide, axis=np.eye(3)[k], ref=at[k])
    body.joints[2].stiffness = [(load - disc.weight * _GRAVITY) / _SPRING, 0.0, 0.0]
    body.joints[2].springref = at[2] - _SPRING
    body.add_joint(name=name + JOINTS[3], type=hinge, axis=[0, 0, 1])
    half = (disc.height - _CLEARANCE) / 2
    body.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_CYLINDER,
        pos=[0, 0, _CLEARANCE / 2],
        size=[disc.radius, half, 0],
        mass=disc.weight,
        rgba=disc.rgba,
        # what rays and cameras meet; bit 2 is nobody's: the rim touches in its place
        contype=2,
        conaffinity=0,
        group=0,
    )
    # the same circle at the height of the robots' rims. Of two upright cylinders MuJoCo's solver
    # for convex shapes says at times that they are centimetres deep in each other, and throws them
    # apart; of spheres the contact is exact. It reaches below the floor, which bit 8 does not touch
    body.add_geom(
        name=f"{name}_rim",
        type=mujoco.mjtGeom.mjGEOM_SPHERE,
        pos=[0, 0, _RIM - disc.height / 2],
        size=[disc.radius, 0, 0],
        mass=0,
        contype=8,
        conaffinity=9,
        friction=[_HULL_FRICTION, 0.005, 0.0001],
        priority=1,
        group=3,
    )
    body.add_geom(
        name=f"{name}_foot",
        type=mujoco.mjtGeom.mjGEOM_SPHERE,
        pos=[0, 0, _FOOT - disc.height / 2],
        size=[_FOOT, 0, 0],
        mass=0,
        rgba=disc.rgba,
        # it touches as a pair alone: bit 2 is nobody's
        contype=2,
        conaffinity=0,
        group=3,
    )
    spec.add_pair(
        name=f"{name}_foot",
        geomname1=floor,
        geomname2=f"{name}_foot",
        condim=4,
        friction=[_GRIP, _GRIP, _GRIP * 2.0 / 3.0 * disc.radius, 0.0001, 0.0001],
        solref=[_TIME, 1.0],
        solimp=[hardness, hardness, 0.001, 0.5, 2.0],
    )


def let_discs_sleep(spec: "mujoco.MjSpec") -> None:
    """Leave out discs at rest until something touches them: for ``world.edit``, where many rest.

    A disc that touches nothing that is awake, and moves by less than 0.1 mm/s, is frozen after
    some steps. Of four robots among 30 discs the physics takes half the time.
    """
    import mujoco

    spec.option.enableflags |= int(mujoco.mjtEnableBit.mjENBL_SLEEP)
    policy = mujoco.mjtSleepPolicy
    discs = {pair.name.removesuffix("_foot") for pair in spec.pairs if pair.name.endswith("_foot")}
    for body in spec.worldbody.bodies:
        # said of the others too: by itself MuJoCo lets all sleep that has no motor
        body.sleep = policy.mjSLEEP_ALLOWED if body.name in discs else policy.mjSLEEP_NEVER


def disc_poses(positions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Poses (k, 7) of discs, position and quaternion, from their joints' positions (k, 4)."""
    poses = np.zeros((len(positions), 7))
    poses[:, :3] = positions[:, :3]
    half = positions[:, 3] / 2.0
    poses[:, 3], poses[:, 6] = np.cos(half), np.sin(half)
    return poses


def disc_positions(poses: NDArray[np.float64]) -> NDArray[np.float64]:
    """Positions (k, 4) of a disc's joints at poses (k, 7): position, quaternion."""
    yaw = 2.0 * np.arctan2(poses[:, 6], poses[:, 3])
    return np.column_stack([poses[:, :3], yaw])
