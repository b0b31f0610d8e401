"""Nims: a carriage on a cable, with a sensor package on a winch (assets/nims/README.md)."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.robots.cable import Cable, swing_period
from mjmr.robots.markings import TEAM_COLOURS, draw_digit
from mjmr.robots.platform import Array, Drive, DriveLimits, Platform

if TYPE_CHECKING:
    import mujoco

    from mjmr.sensors.base import Sensor
    from mjmr.world import World

CABLES = ("curve", "tendon")
# span, height, sag, line [m]; what the carriage of each size is, see nims_rig.Size
SIZES: dict[str, tuple[tuple[float, float, float, float], dict[str, Any]]] = {
    "lab": (
        (6.0, 2.25, 0.25, 1.0),
        {
            "scale": 1.0, "carriage": 2.0, "package": 0.5, "supports": "towers", "foot": 0.5,
            "post": 0.025, "rope": 0.004, "axial_stiffness": 2e4,
        },
    ),
    "field": (
        (70.0, 17.33, 3.5, 6.0),
        {
            "scale": 1.8, "carriage": 8.0, "package": 2.0, "supports": "trees", "foot": 2.2,
            "post": 0.30, "rope": 0.015, "axial_stiffness": 4e5,
        },
    ),
}  # fmt: skip
SUPPORTS = ("towers", "trees")
# of the model file [m]: the winch below the cable, half the package's height
_WINCH_DROP, _PACKAGE_HALF = 0.19, 0.066
_SHORTEST, _FLOOR_CLEARANCE = 0.25, 0.05


class Nims(Platform):
    """Networked infomechanical system; commands are (travel [m/s], winch [m/s]).

    Travel is horizontal, forwards along the cable; the winch lets the line out when positive. The
    poses a group is given say where the rig stands: on the floor below the middle of the cable, yaw
    along it. The robot itself is the carriage: its pose is the carriage's x and y and the cable's
    yaw, and ``radius`` and ``height`` are the carriage's.

    Attributes:
        cable: Its shape.
        reach: Furthest place of the carriage from the middle, either way [m].
        along: Where the carriage starts [m] from the middle.
        line: How far the package's centre starts below the winch [m].
        lines: Shortest and longest line [m].
        max_winch: Speed of the line [m/s].
        winch_acceleration: [m/s^2].
        wheel_radii: Of the counters' wheels, travel and winch [m].
        package_mass: [kg].
        mass: Of carriage and package [kg].
    """

    name = "nims"
    title = "Networked Info-Mechanical System"
    grade = "C"
    command_names = ("travel", "winch")
    radius = 0.19
    height = 0.33
    max_twist = (1.0, 0.0)
    max_winch = 0.3
    winch_acceleration = 0.3
    braking = 1.0
    wheels = ("travel", "winch")
    wheel_radii = (0.034, 0.022)
    anchored = True

    def __init__(
        self,
        *,
        size: str = "lab",
        cable: str = "curve",
        along: float = 0.0,
        acceleration: float | None = None,
        span: float | None = None,
        height: float | None = None,
        sag: float | None = None,
        line: float | None = None,
        supports: str = "",
        axial_stiffness: float | None = None,
        swing_damping: float = 0.02,
    ):
        """Choose size and model of the cable.

        Args:
            size: ``"lab"`` or ``"field"``: carriage, package, supports, and what is not given.
            cable: ``"curve"``: the carriage slides on a parabola. ``"tendon"``: two elastic cables
                with real tensions pull it along that parabola.
            along: Where the carriage starts [m] from the middle of the cable.
            acceleration: Bound of the travel's changes [m/s^2]; by default top speed in one swing
                of the line it starts with, which leaves that swing at rest.
            span: Between the supports [m].
            height: Of the cable's ends [m].
            sag: Of its middle below its ends [m].
            line: Of the package's centre below the winch, at the start [m].
            supports: ``"towers"`` or ``"trees"``.
            axial_stiffness: Of the cable, EA [N]; for ``"tendon"``.
            swing_damping: Share of critical, on the line it starts with.

        Raises:
            UnknownNameError: Unknown size, cable or supports.
            InvalidInputError: A shape, length or bound that cannot be.
        """
        if size not in SIZES:
            raise UnknownNameError("size of Nims", size, SIZES)
        if cable not in CABLES:
            raise UnknownNameError("cable of Nims", cable, CABLES)
        shape, parts = SIZES[size]
        self._parts = dict(parts)
        if supports:
            if supports not in SUPPORTS:
                raise UnknownNameError("supports of Nims", supports, SUPPORTS)
            self._parts["supports"] = supports
        if axial_stiffness is not None:
            self._parts["axial_stiffness"] = _positive("axial_stiffness", axial_stiffness, "N")
        given = (span, height, sag)
        span, height, sag = (b if a is None else a for a, b in zip(given, shape, strict=False))
        self.cable = Cable(span=span, height=height, sag=sag)
        self.cable_model = cable
        scale = self._parts["scale"]
        self.radius, self.height = scale * Nims.radius, scale * Nims.height
        self.reach = span / 2 - self._parts["post"] - self.radius - 0.05
        self.winch_drop = _WINCH_DROP * scale
        lowest = height - sag - self.winch_drop - _PACKAGE_HALF * scale - _FLOOR_CLEARANCE
        self.lines = (_SHORTEST * scale, lowest)
        self.line = min(shape[3], lowest) if line is None else float(line)
        if not (self.reach > 0 and self.lines[0] < self.lines[1]):
            raise InvalidInputError(
                f"a carriage of size {size!r} has no room on a cable of {span:g} m that hangs "
                f"{height - sag:g} m high"
            )
        if not self.lines[0] <= self.line <= self.lines[1]:
            raise InvalidInputError(
                f"the line can be {self.lines[0]:.3g} to {self.lines[1]:.4g} m long here; "
                f"got {self.line}"
            )
        if not abs(along) <= self.reach:
            raise InvalidInputError(
                f"the carriage can start up to {self.reach:.4g} m from the middle; got {along}"
            )
        if not 0 <= swing_damping < 1:
            raise InvalidInputError(f"swing_damping is a share, 0 to 1; got {swing_damping}")
        self.along, self._damping = float(along), float(swing_damping)
        self.package_mass = self._parts["package"]
        self.mass = self._parts["carriage"] + self.package_mass
        bound = self.max_twist[0] / self.swing_period(self.line)
        if acceleration is not None:
            bound = _positive("acceleration", acceleration, "m/s^2")
        self.limits = DriveLimits(
            max_speed=self.max_twist[0], acceleration=bound, deceleration=bound
        )

    def swing_period(self, length: Any) -> Any:
        """Period [s] of small swings on a line of ``length`` [m], any shape.

        A change of speed that takes a whole number of periods, at constant acceleration, leaves the
        package at rest.
        """
        # a cylinder of the package's size about an axis across it
        radius, half = 0.05 * self._parts["scale"], _PACKAGE_HALF * self._parts["scale"]
        return swing_period(length, math.sqrt(radius**2 / 4 + half**2 / 3))

    def package_height(self, along: ArrayLike, line: ArrayLike) -> Array:
        """Height [m] of the hanging package's centre, carriage at ``along``; any shapes."""
        return self.cable.curve(along) - self.winch_drop - np.asarray(line)

    def starts(self, poses: Array) -> Array:
        """Poses (n, 3) of the carriages of rigs at ``poses``."""
        forward = np.column_stack([np.cos(poses[:, 2]), np.sin(poses[:, 2]), 0.0 * poses[:, 2]])
        return poses + self.along * forward

    def heights(self, poses: Array, sites: Array) -> Array:
        """Heights (n,) [m] of the cable where the carriages are."""
        yaw = sites[:, 2]
        x, y = (poses - sites)[:, :2].T
        return self.cable.curve(x * np.cos(yaw) + y * np.sin(yaw))

    def check_site(self, world: "World", poses: Array, names: Sequence[str]) -> None:
        """Refuse supports whose feet are not inside the walls.

        Raises:
            InvalidInputError: Says which, and by how much.
        """
        out = self.cable.span / 2
        feet = np.array([-out, out])[:, None, None] * np.stack(
            [np.cos(poses[:, 2]), np.sin(poses[:, 2])], axis=-1
        )
        feet = feet + poses[:, :2]
        foot = self._parts["foot"]
        low, high = world.bounds[:2] + foot, world.bounds[2:] - foot
        beyond = np.maximum(low - feet, feet - high).max(axis=(0, 2))
        if (beyond > 0).any():
            far = zip(names, beyond, strict=True)
            told = ", ".join(f"{name} by {by:.2f} m" for name, by in far if by > 0)
            raise InvalidInputError(
                f"these rigs' {self._parts['supports']} stand outside the walls or touch them: "
                f"{told}; they are {self.cable.span:g} m apart and need {foot:g} m around them"
            )

    def model(self, number: int, team: str) -> "mujoco.MjSpec":
        """Model of one rig; the team's colour is on carriage and package, the number behind."""
        from mjmr.robots.nims_rig import Rig, Size, build

        spec = build(
            Rig(
                size=Size(**self._parts),
                cable=self.cable,
                tendon=self.cable_model == "tendon",
                reach=self.reach,
                line=self.line,
                lines=self.lines,
                damping=self._damping,
            )
        )
        spec.material("team").rgba = TEAM_COLOURS[team]
        scale = self._parts["scale"]
        draw_digit(spec.site("back"), spec.body("base"), number % 10, height=0.045 * scale)
        return spec

    def bind(self, model: "mujoco.MjModel", prefixes: Sequence[str]) -> Drive:
        """Drive of the robots attached under ``prefixes``."""
        from mjmr.robots.cable_drive import CurveDrive, TendonDrive

        kind = TendonDrive if self.cable_model == "tendon" else CurveDrive
        stops = np.array([self.braking, self.winch_acceleration])
        return kind(model, prefixes, self.wheel_radii, stops)

    def default_sensors(self) -> "dict[str, Sensor]":
        """Counters of travel and line at 10 Hz."""
        from mjmr.sensors.encoders import WheelEncoders

        return {"encoders": WheelEncoders(rate=10.0, counts_per_turn=4096.0)}

    @property
    def always_allowed(self) -> float:
        """A command none of whose entries is above this needs no clamping."""
        return min(self.max_twist[0], self.max_winch)

    def clamp(self, command: Array) -> Array:
        """Cut travel and winch of commands (n, 2) to their top speeds, each by itself."""
        most = np.array([self.max_twist[0], self.max_winch])
        return np.clip(command, -most, most)

    def twist_of(self, command: Array) -> Array:
        """Twists (n, 3): along the cable alone."""
        twists = np.zeros((len(command), 3))
        twists[:, 0] = command[:, 0]
        return twists

    def pace_of(self, command: Array) -> Array:
        """Speeds (n, 3) of travel and winch; the third column is empty."""
        return np.column_stack([command, np.zeros(len(command))])

    def wheel_turns(self, way: Array) -> Array:
        """Angles [rad] of the counters (n, 2) after travel and winch came to ``way`` (n, 3)."""
        return way[:, :2] / self.wheel_radii

    def slew(self, current: Array, target: Array, period: float) -> Array:
        """Commands (n, 2) as near to ``target`` as the accelerations allow in one period."""
        step = np.array([self.limits.acceleration, self.winch_acceleration]) * period
        return current + np.clip(target - current, -step, step)

    def brake(self, twist: Array, period: float) -> Array:
        """Next cycle's command (n, 2) of an emergency stop; the package will swing."""
        step = np.array([self.braking, self.winch_acceleration]) * period
        return np.sign(twist) * np.maximum(0.0, np.abs(twist) - step)


def _positive(name: str, value: float, unit: str) -> float:
    if not (value > 0 and math.isfinite(value)):
        raise InvalidInputError(f"{name} of Nims must be positive and finite; got {value} {unit}")
    return float(value)
