"""Closed-form kinematics of a four-legged robot's legs: rotator, elevator, knee."""

import functools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError
from mjmr.jit import njit

Array = NDArray[np.float64]
LEGS = ("fl", "fr", "hl", "hr")
_SLACK = 1e-9  # rad and m^2; what rounding may put a point outside


class UnreachableError(InvalidInputError):
    """A foot was sent where the leg does not reach; the message says which foot and where."""


@dataclass(frozen=True, kw_only=True)
class LegGeometry:
    """Legs of a robot whose rotator and elevator axes meet in the hip.

    Row ``i`` of every array belongs to leg ``LEGS[i]``. Hind legs are fore legs mirrored fore and
    aft, right legs are left legs mirrored sideways, and angles are mirrored with them: rotators
    swing forelegs forwards and hind legs backwards, elevators raise legs outwards, knees bend.

    Attributes:
        hips: Where the axes meet (4, 3) [m], body frame.
        thigh: Knee's axis below the hip [m], all joints at zero.
        knee_offset: The same, towards the end of the robot [m]: forwards in front.
        shank: From the knee's axis to the foot's centre (4,) [m], in the plane of the knee.
        shank_angle: By which that line leans towards the middle of the robot at zero (4,) [rad].
        foot_offset: Of the foot's centre, outwards [m].
        limits: Lowest and highest angles (4, 3, 2) [rad].
    """

    hips: Array
    thigh: float
    knee_offset: float
    shank: Array
    shank_angle: Array
    foot_offset: float
    limits: Array

    @functools.cached_property
    def signs(self) -> Array:
        """Of forwards, outwards and up (4, 3): +-1, what mirrors each leg to the fore left one."""
        return np.column_stack([np.sign(self.hips[:, :2]), np.ones(4)])

    def feet(self, angles: ArrayLike) -> Array:
        """Centres of the feet (..., 4, 3) [m], body frame, at joint angles (..., 4, 3) [rad]."""
        angle = _legs(angles, "joint angles")
        rotator, elevator, knee = np.moveaxis(angle, -1, 0)
        x = self.knee_offset + self.shank * np.sin(knee - self.shank_angle)
        down = self.thigh + self.shank * np.cos(knee - self.shank_angle)
        y = self.foot_offset * np.cos(elevator) + down * np.sin(elevator)
        z = self.foot_offset * np.sin(elevator) - down * np.cos(elevator)
        c, s = np.cos(rotator), np.sin(rotator)
        local = np.stack([c * x - s * z, y, s * x + c * z], axis=-1)
        return self.hips + self.signs * local

    def solve(self, feet: ArrayLike) -> tuple[Array, NDArray[np.bool_]]:
        """Joint angles for feet, and which of them the legs reach; does not raise for the others.

        Of the up to four ways to reach a point this is the one with the knee bent (more than 0.21
        rad on the ERS-7's forelegs, 0.33 on its hind legs) and the elevator below some 1.45 rad.

        Args:
            feet: Centres (..., 4, 3) [m], body frame.

        Returns:
            Angles (..., 4, 3) [rad], and a mask (..., 4) of the feet that are reached within the
            joints' limits. Where it is false the angles are of the nearest reach, in the limits.

        Raises:
            InvalidInputError: Another shape, or a number that is not finite.
        """
        points = _legs(feet, "feet")
        angles, reached = _solve(
            np.ascontiguousarray(points).reshape(-1, 4, 3), self.hips, self.signs, self.thigh,
            self.knee_offset, self.shank, self.shank_angle, self.foot_offset, self.limits,
        )  # fmt: skip
        return angles.reshape(points.shape), reached.reshape(points.shape[:-1])

    def angles(self, feet: ArrayLike) -> Array:
        """Joint angles (..., 4, 3) [rad] that put the feet at (..., 4, 3) [m], body frame.

        Raises:
            UnreachableError: Says which foot, where, and how many more.
            InvalidInputError: Another shape, or a number that is not finite.
        """
        angle, reached = self.solve(feet)
        if not reached.all():
            bad = np.argwhere(~reached)
            *row, leg = bad[0].tolist()
            x, y, z = 1e3 * np.asarray(feet, dtype=np.float64)[(*row, leg)]
            where = f" of row {tuple(row)}" if row else ""
            more = f", nor {len(bad) - 1} others" if len(bad) > 1 else ""
            raise UnreachableError(
                f"foot {LEGS[leg]}{where} cannot reach ({x:.0f}, {y:.0f}, {z:.0f}) mm within "
                f"its joints' limits{more}; body frame, x forward, y left, z up from the hips"
            )
        return angle


@njit
def _solve(points, hips, signs, thigh, knee_offset, shank, shank_angle, foot_offset, limits):
    """Angles (m, 4, 3) and mask (m, 4) of :meth:`LegGeometry.solve` for points (m, 4, 3)."""
    angles = np.empty(points.shape)
    reached = np.empty(points.shape[:2], dtype=np.bool_)
    upper = math.hypot(thigh, knee_offset)
    for i in range(points.shape[0]):
        for leg in range(4):
            x = (points[i, leg, 0] - hips[leg, 0]) * signs[leg, 0]
            y = (points[i, leg, 1] - hips[leg, 1]) * signs[leg, 1]
            z = (points[i, leg, 2] - hips[leg, 2]) * signs[leg, 2]
            # in the plane of thigh and shank only the knee changes the distance from the hip
            flat = x * x + y * y + z * z - foot_offset**2
            bend = (flat - upper**2 - shank[leg] ** 2) / (2.0 * upper * shank[leg])
            fits = abs(bend) <= 1.0 + _SLACK
            straight = math.atan2(knee_offset, thigh) + shank_angle[leg]
            knee = straight + math.acos(min(max(bend, -1.0), 1.0))
            ahead = knee_offset + shank[leg] * math.sin(knee - shank_angle[leg])
            down = thigh + shank[leg] * math.cos(knee - shank_angle[leg])
            # the rotator leaves the sideways distance to the elevator
            side = y / math.hypot(foot_offset, down)
            fits = fits and abs(side) <= 1.0 + _SLACK
            elevator = math.atan2(down, foot_offset) - math.acos(min(max(side, -1.0), 1.0))
            depth = foot_offset * math.sin(elevator) - down * math.cos(elevator)
            rotator = math.atan2(z, x) - math.atan2(depth, ahead)
            rotator = (rotator + math.pi) % (2.0 * math.pi) - math.pi
            for k, angle in enumerate((rotator, elevator, knee)):
                low, high = limits[leg, k, 0], limits[leg, k, 1]
                fits = fits and low - _SLACK <= angle <= high + _SLACK
                angles[i, leg, k] = min(max(angle, low), high)
            reached[i, leg] = fits
    return angles, reached


def _legs(values: ArrayLike, what: str) -> Array:
    array = np.asarray(values, dtype=np.float64)
    if array.shape[-2:] != (4, 3):
        raise InvalidInputError(f"{what} must have shape (..., 4, 3); got {array.shape}")
    if not np.isfinite(array).all():
        raise InvalidInputError(f"{what} must be finite")
    return array


def _ers7() -> LegGeometry:
    fore = np.radians([[-115.0, 130.0], [-10.0, 88.0], [-25.0, 122.0]])
    hind = np.radians([[-130.0, 115.0], [-10.0, 88.0], [-25.0, 122.0]])
    return LegGeometry(
        hips=1e-3 * np.array([[65, 62.5, 0], [65, -62.5, 0], [-65, 62.5, 0], [-65, -62.5, 0]]),
        thigh=0.0695,
        knee_offset=0.009,
        shank=np.array([0.065434, 0.065434, 0.067647, 0.067647]),
        shank_angle=np.radians([4.4088, 4.4088, 11.537, 11.537]),
        foot_offset=0.0047,
        limits=np.array([fore, fore, hind, hind]),
    )


# Sony AIBO ERS-7: geometry from Tekkotsu's ERS-7.kin, limits from its ERS7Info.h
ERS7 = _ers7()
