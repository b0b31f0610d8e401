"""Both variants of the turret's vision, from a sample to objects: rays, and rendered pictures."""

from typing import Any

import numpy as np

from controllers.perception.arc_objects import MOVER, ROBOT, ArcObjects, Objects
from controllers.perception.floor_columns import FloorColumns, Paint
from experiments.versatile_pushing.worlds import ARC_NOISE, ORANGE, RANGE, TEAM
from mjmr.geometry import Pinhole
from mjmr.group import Group
from mjmr.robots.markings import TEAM_COLOURS
from mjmr.robots.round_pusher import RoundPusher

SKIRT = 0.04  # m: the team's colour begins above it
MOST = 16  # objects kept of an arc


class ArcSight:
    """Fast: rays of the same field, range and occlusion as the camera."""

    def __init__(self, robots: Group, disc_radius: float):
        """Args: robots: Carry a ``VisualArc`` named ``arc``. disc_radius: Of all discs [m]."""
        self._arc: Any = robots.sensors["arc"]
        self._objects = ArcObjects(
            robot_radius=RoundPusher.radius,
            mover_radius=disc_radius,
            max_range=RANGE,
            most=MOST,
            resolution=ARC_NOISE,
        )

    def look(self) -> Objects:
        """Objects in the frames of the turrets."""
        seen = self._arc.read()
        return self._objects.find(self._arc.angles, seen[..., 0], seen[..., 1])


class CameraSight:
    """Physical: pictures of the turret's camera and the colours in them."""

    def __init__(self, robots: Group, disc_radius: float):
        """Args: robots: Carry a ``Camera`` named ``eye``. disc_radius: Of all discs [m]."""
        self._eye: Any = robots.sensors["eye"]
        self._disc_radius = disc_radius
        self._columns: FloorColumns | None = None
        self._objects: ArcObjects | None = None

    def look(self) -> Objects:
        """Objects in the frames of the turrets."""
        if self._columns is None or self._objects is None:
            image = self._eye.calibration
            # the camera is on the turret's axis: the arc's frame has its origin below it
            camera = Pinhole(
                np.array([0.0, 0.0, LENS]), image.rotation, image.focal, image.width, image.height
            )
            paints = (
                Paint(kind=MOVER, colour=ORANGE),
                Paint(kind=ROBOT, colour=TEAM_COLOURS[TEAM][:3], foot=SKIRT),
            )
            self._columns = FloorColumns(camera, paints)
            self._objects = ArcObjects(
                robot_radius=RoundPusher.radius,
                mover_radius=self._disc_radius,
                max_range=RANGE,
                most=MOST,
                resolution=self._columns.resolution,
            )
        return self._objects.find(*self._columns.look(self._eye.read()))


LENS = 0.2  # m, height of the camera; a test holds it to the model


def nothing(n: int) -> Objects:
    """What n robots see whose cameras deliver nothing."""
    return Objects(
        kind=np.zeros((n, MOST), dtype=np.int64),
        centre=np.full((n, MOST, 2), np.nan),
        gap=np.full((n, MOST), np.inf),
        whole=np.zeros((n, MOST), dtype=bool),
    )


def sight(vision: str, robots: Group, disc_radius: float) -> ArcSight | CameraSight:
    """The variant called ``arcs`` or ``camera``."""
    return (CameraSight if vision == "camera" else ArcSight)(robots, disc_radius)
