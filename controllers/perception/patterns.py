"""PatternFinder: poses and identities of robots from the dots on their tops, one image at a time.

As the overhead vision of RoboCup's small size league does it: J. Bruce and M. Veloso, Fast and
accurate vision-based pattern detection and identification, ICRA 2003. The team's dot says where a
robot may be, the dots around it say how it is turned and, by their colours, which one it is.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from controllers.perception.blobs import BlobFinder, Blobs
from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.geometry import Pinhole, rotate, wrap_angle

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Identity = tuple[str, int]
# areas of dots as shares of what they should be: below the second, something hides a part of the
# dot and its middle is off, but its colour still tells
_LEAST, _WHOLE, _MOST = 0.2, 0.7, 1.7
_NEAR, _NEAR_PART = 0.009, 0.014  # m between a dot, whole or not, and where it should be
_CLOSE = 0.45  # px; further off than this, a dot is left out of the pose if enough others are left
_FEWEST = 3


class PatternLayout(Protocol):
    """What the dots look like; lengths in m, robot frame, colours RGB 0 to 1."""

    @property
    def dots(self) -> Array:
        """Middles of the bits' dots (k, 2); the team's dot is at the origin."""
        ...

    @property
    def dot_radius(self) -> float:
        """Of the bits' dots."""
        ...

    @property
    def centre_radius(self) -> float:
        """Of the team's dot."""
        ...

    @property
    def height(self) -> float:
        """Of the dots above the floor."""
        ...

    @property
    def bit_colours(self) -> tuple[Sequence[float], Sequence[float]]:
        """Of a 0 and of a 1."""
        ...

    @property
    def team_colours(self) -> Mapping[str, Sequence[float]]:
        """By team."""
        ...

    @property
    def codes(self) -> Sequence[int]:
        """By number; bit k belongs to dot k."""
        ...


class PatternFinder:
    """Finds known robots in single images from a calibrated camera; remembers nothing.

    A robot is found by its team's dot and at least three of its others. One whose code cannot be
    read whole is found if only one robot that has not been found fits what can be seen.

    Attributes:
        robots: Team and number of each row of the result.
    """

    def __init__(self, camera: Pinhole, layout: PatternLayout, robots: Sequence[Identity]):
        """Prepare for one camera and the robots on the field.

        Args:
            camera: Its calibration, in the frame that poses are wanted in.
            layout: What the patterns look like.
            robots: Team and number of every robot to report.

        Raises:
            UnknownNameError: A team without a colour.
            InvalidInputError: A number without a code, or a robot named twice.
        """
        for team, number in robots:
            if team not in layout.team_colours:
                raise UnknownNameError("team", team, layout.team_colours)
            if not 0 <= number < len(layout.codes):
                raise InvalidInputError(
                    f"numbers are 0 to {len(layout.codes) - 1} in this layout; got {number}"
                )
        if len(set(robots)) != len(robots):
            raise InvalidInputError("each robot can be looked for once; one is named twice")
        self.robots = tuple(robots)
        self._camera, self._layout = camera, layout
        self._teams = sorted({team for team, _ in robots})
        names = list(layout.team_colours)
        # every team's colour counts, played or not: the ring of a stranger must not look like ours
        self._finder = BlobFinder([*layout.bit_colours, *layout.team_colours.values()])
        self._colour = {team: 2 + names.index(team) for team in self._teams}
        self._rows = {
            team: {layout.codes[n]: row for row, (t, n) in enumerate(robots) if t == team}
            for team in self._teams
        }
        self._dots = np.array(layout.dots, dtype=np.float64)
        self._radius = np.hypot(*self._dots.T)
        self._middle = self._scale(camera.centre[None])[0]
        self._close = _CLOSE / np.sqrt(self._middle)
        self._angle = np.arctan2(self._dots[:, 1], self._dots[:, 0])

    def find(self, image: NDArray[np.uint8]) -> Array:
        """Poses of the robots in an image.

        Args:
            image: RGB, shape (height, width, 3), uint8.

        Returns:
            Poses (n, 3) [m, m, rad] in the order of ``robots``; NaN rows for those not found.

        Raises:
            InvalidInputError: An image of another shape or type.
        """
        shape = (self._camera.height, self._camera.width, 3)
        if image.shape != shape or image.dtype != np.uint8:
            raise InvalidInputError(
                f"the camera's images are {shape} uint8; got {image.shape} {image.dtype}"
            )
        self._finder.look(image)
        spots = [self._spots(bit, self._layout.dot_radius) for bit in (0, 1)]
        dots, whole = (np.concatenate(both) for both in zip(*spots, strict=True))
        bits = np.repeat([0, 1], [len(seen) for seen, _ in spots])
        poses = np.full((len(self.robots), 3), np.nan)
        for team in self._teams:
            centres, entire = self._spots(self._colour[team], self._layout.centre_radius)
            found = [self._sightings(centre, dots, whole, bits) for centre in centres[entire]]
            self._identify([f for f in found if f], self._rows[team], poses)
        return poses

    def _spots(self, colour: int, radius: float) -> tuple[Array, Flags]:
        """Spots (k, 2) of one colour that may be dots of this radius, and which are whole."""
        camera, height = self._camera, self._layout.height
        # the area a dot has anywhere in the image is checked below; this only saves work
        size = np.pi * radius**2 * self._middle
        blobs: Blobs = self._finder.find(colour, 0.5 * _LEAST * size, 4 * np.sqrt(size))
        share = blobs.area / (np.pi * radius**2 * self._scale(blobs.centre))
        likely = (share > _LEAST) & (share < _MOST)
        return camera.on_plane(blobs.centre[likely], height), share[likely] > _WHOLE

    def _scale(self, pixels: Array) -> Array:
        """Pixels (k,) that a square metre of the dots' plane covers around pixels (k, 2)."""
        rise = self._camera.rays(pixels)[..., 2]
        depth = (self._layout.height - self._camera.position[2]) / rise
        return self._camera.focal**2 * np.abs(rise) / depth**2

    def _sightings(
        self, centre: Array, dots: Array, whole: Flags, bits: NDArray[np.int64]
    ) -> "list[_Sighting]":
        """Every way to see a robot around a team's dot with as many dots as possible."""
        away = dots - centre
        distance = np.hypot(away[:, 0], away[:, 1])
        tolerance = np.where(whole, _NEAR, _NEAR_PART)
        low, high = self._radius.min() - tolerance, self._radius.max() + tolerance
        near = np.flatnonzero((distance > low) & (distance < high))
        if len(near) < _FEWEST:
            return []
        away, whole, bits, tolerance = away[near], whole[near], bits[near], tolerance[near]
        angle = np.arctan2(away[:, 1], away[:, 0])
        # every heading that puts one of the layout's dots on one of those seen
        heading = (angle[:, None] - self._angle).ravel()
        c, s = np.cos(heading)[:, None], np.sin(heading)[:, None]
        x, y = self._dots.T
        expected = np.stack([c * x - s * y, s * x + c * y], axis=-1)
        error = np.linalg.norm(expected[:, :, None] - away, axis=-1)
        match, off = error.argmin(axis=2), error.min(axis=2)
        hits = off < tolerance[match]
        count = hits.sum(axis=1)
        most = count.max()
        if most < _FEWEST:
            return []
        found: dict[tuple, _Sighting] = {}
        for k in np.flatnonzero(count == most):
            seen = np.flatnonzero(hits[k])
            key = (*seen, *match[k, seen])
            if key not in found:
                at = match[k, seen]
                use = whole[at] if whole[at].sum() >= 2 else np.full(len(at), True)
                residual, pose = _fit(
                    centre, self._dots[seen][use], centre + away[at][use], self._close
                )
                known, value = (1 << seen).sum(), (bits[at] << seen).sum()
                found[key] = _Sighting(len(seen), residual, int(known), int(value), pose)
        return list(found.values())

    def _identify(self, spots: "list[list[_Sighting]]", rows: dict[int, int], poses: Array) -> None:
        """Give the spots of one team to its robots: whole codes first, then what is left."""
        spots.sort(key=lambda ways: (-ways[0].dots, ways[0].residual))
        settled = False
        while not settled:
            settled = True
            for ways in spots:
                options = [
                    (row, way.pose)
                    for way in ways
                    for code, row in rows.items()
                    if code & way.known == way.value and np.isnan(poses[row, 0])
                ]
                if len(options) == 1:
                    poses[options[0][0]] = options[0][1]
                    spots.remove(ways)
                    settled = False
                    break


@dataclass(frozen=True)
class _Sighting:
    """One way to see a robot.

    Attributes:
        dots: How many fit.
        residual: The largest [m].
        known: Bits whose dots were seen.
        value: Their values.
        pose: (3,).
    """

    dots: int
    residual: float
    known: int
    value: int
    pose: Array


def _fit(centre: Array, layout: Array, seen: Array, close: float) -> tuple[float, Array]:
    """Residual [m] and pose (3,) that lay the team's dot and ``layout`` onto what was seen.

    Rigid least squares in the plane (Kabsch). A dot further off than ``close`` [m], which may be
    half hidden, is left out as long as three are left.
    """
    q, p = np.vstack([np.zeros(2), layout]), np.vstack([centre, seen])
    while True:
        dq, dp = q - q.mean(axis=0), p - p.mean(axis=0)
        cross = (dq[:, 0] * dp[:, 1] - dq[:, 1] * dp[:, 0]).sum()
        yaw = np.arctan2(cross, (dq * dp).sum())
        turned = rotate(q, yaw)
        shift = (p - turned).mean(axis=0)
        off = np.hypot(*(p - turned - shift).T)
        worst = int(off.argmax())
        if off[worst] < close or len(q) <= 3:
            return float(off.max()), np.array([*shift, float(wrap_angle(yaw))])
        q, p = np.delete(q, worst, axis=0), np.delete(p, worst, axis=0)
