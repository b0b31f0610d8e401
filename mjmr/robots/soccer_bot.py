"""SoccerBot: a RoboCup F180 robot, 90 mm in radius, 2.5 kg (assets/soccer_bot/README.md)."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mjmr.assets import model_path
from mjmr.errors import UnknownNameError
from mjmr.robots.markings import TEAM_COLOURS, DotPattern, draw_digit
from mjmr.robots.platform import Drive, DriveLimits, Platform

if TYPE_CHECKING:
    import mujoco

    from mjmr.sensors.base import Sensor

# front left, back left, back right, front right: the league's layout keeps the front open
_DOTS = np.array([[0.035, 0.0548], [-0.0548, 0.035], [-0.0548, -0.035], [0.035, -0.0548]])
_DOTS.setflags(write=False)
_HALF_DOT = 0.0006  # m, half the thickness of a dot
# what each drive follows in every direction, measured: assets/soccer_bot/README.md
DRIVES = {
    "planar": DriveLimits(max_speed=2.0, acceleration=3.0, deceleration=6.0),
    "omni": DriveLimits(max_speed=2.0, acceleration=3.0, deceleration=3.0),
}


class SoccerBot(Platform):
    """Holonomic soccer robot; commands are body-frame twists (forward, left, anticlockwise).

    Attributes:
        pattern: The dots on its top, for overhead cameras.
    """

    name = "soccer_bot"
    title = "RoboCup F180 soccer robot"
    grade = "C"
    radius = 0.090
    height = 0.150
    max_twist = (3.0, 12.0)
    braking = 6.0
    pattern = DotPattern(dots=_DOTS, dot_radius=0.020, centre_radius=0.025, height=0.1538)
    limits = DRIVES["planar"]

    def __init__(self, drive: str = "planar"):
        """Choose the drive.

        Args:
            drive: ``"planar"``: two slides and a hinge with force-limited velocity servos.
                ``"omni"``: a free body on four omni-wheels, moved by their contact with the floor.

        Raises:
            UnknownNameError: Unknown drive.
        """
        if drive not in DRIVES:
            raise UnknownNameError("drive of SoccerBot", drive, DRIVES)
        self.drive_name = drive
        self.limits = DRIVES[drive]
        self.braking = self.limits.deceleration

    def model(self, number: int, team: str) -> "mujoco.MjSpec":
        """Model of one robot with its team's ring, its dot pattern and its number on the back."""
        import mujoco

        variant = "" if self.drive_name == "planar" else self.drive_name
        spec = mujoco.MjSpec.from_file(str(model_path(self.name, variant)))
        for key in list(spec.keys):
            spec.delete(key)
        rgba = TEAM_COLOURS[team]
        spec.material("team").rgba = rgba
        base = spec.body("base")
        top = np.array(spec.site("top").pos)
        pattern = self.pattern
        dots = [(0.0, 0.0, pattern.centre_radius, rgba)]
        for (x, y), colour in zip(pattern.dots, pattern.colours(number), strict=True):
            dots.append((x, y, pattern.dot_radius, colour))
        for x, y, radius, colour in dots:
            base.add_geom(
                type=mujoco.mjtGeom.mjGEOM_CYLINDER,
                pos=top + [x, y, _HALF_DOT],
                size=[radius, _HALF_DOT, 0],
                rgba=colour,
                contype=0,
                conaffinity=0,
                group=1,
                mass=0,
            )
        draw_digit(spec.site("back"), base, number % 10, height=0.05)
        return spec

    def finish(self, spec: "mujoco.MjSpec", prefixes: Sequence[str]) -> None:
        """Let omni-wheels touch the floor."""
        if self.drive_name == "omni":
            from mjmr.robots.omni import roll_on_floor

            roll_on_floor(spec, prefixes)

    def bind(self, model: "mujoco.MjModel", prefixes: Sequence[str]) -> Drive:
        """Drive of the robots attached under ``prefixes``."""
        if self.drive_name == "omni":
            from mjmr.robots.omni import OmniDrive

            return OmniDrive(model, prefixes)
        from mjmr.robots.planar import PlanarDrive

        return PlanarDrive(model, prefixes)

    def default_sensors(self) -> "dict[str, Sensor]":
        """An exact overhead localizer at 60 Hz."""
        from mjmr.sensors.localizer import Localizer

        return {"localizer": Localizer(rate=60.0)}
