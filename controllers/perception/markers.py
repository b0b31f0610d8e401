"""Markers: upright coloured cylinders on robots, found in images all round, placed by their size.

The vision that Sgorbissa and Arkin suppose in section 6.1: a well identifiable marker on each
robot, its place computed from where and how large it appears.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from controllers.perception.blobs import BlobFinder
from mjmr.geometry import Pinhole

Array = NDArray[np.float64]
_SMALLEST = 6.0  # px: a spot with fewer is not taken for a marker


@dataclass(frozen=True, kw_only=True)
class Marker:
    """The cylinder all robots carry.

    Attributes:
        length: Upright [m].
        radius: [m].
        colours: RGB, 0 to 1, of each robot's.
    """

    length: float
    radius: float
    colours: Sequence[Sequence[float]]


class MarkerFinder:
    """Bearings and distances of markers from images of level cameras on one robot.

    A spot of a marker's colour tells its bearing by the middle of its pixels and its distance by
    its height: the height of a rectangle with the same second moment, which counts all pixels and
    so resolves parts of one. Where a jamb hides a part of the width, the height remains; the
    bearing is that of the part seen.

    One camera that has no neighbour sees a marker at its picture's side in part only, for long:
    ``complete`` places such a one by the side of it that is in the picture.
    """

    def __init__(self, marker: Marker, cameras: Sequence[Pinhole], *, complete: bool = False):
        """Set what is looked for and with what.

        Args:
            marker: What all robots carry.
            cameras: In the robot's frame, their axes level.
            complete: A spot that the left or the right side of its picture cuts off is taken for a
                part of a cylinder whose width its height tells; else the bearing is the part's.
        """
        self._complete = complete
        self._marker, self._cameras = marker, list(cameras)
        self._blobs = BlobFinder(marker.colours)

    def find(self, images: Sequence[NDArray[np.uint8]]) -> Array:
        """Look at the cameras' images of one instant.

        Args:
            images: RGB (height, width, 3), one a camera.

        Returns:
            Distance [m] and bearing [rad] of each colour's marker (k, 2), from the robot's origin,
            in its frame; NaN where it was not found.
        """
        found = np.full((len(self._marker.colours), 2), np.nan)
        best = np.zeros(len(found))
        for image, camera in zip(images, self._cameras, strict=True):
            self._blobs.look(image)
            for k in range(len(found)):
                spot = _largest(self._blobs.mask(k))
                # a spot cut off by the image's edge is whole in the next camera
                if spot is None or spot.area * (0.2 if spot.cut else 1.0) <= best[k]:
                    continue
                best[k] = spot.area * (0.2 if spot.cut else 1.0)
                found[k] = self._place(spot, camera)
        return found

    def _place(self, spot: "_Spot", camera: Pinhole) -> tuple[float, float]:
        """Distance [m] and bearing [rad] of the cylinder's axis from the robot's origin."""
        depth = camera.focal * self._marker.length / spot.height
        across = depth * (spot.x - camera.centre[0]) / camera.focal
        # its near side is what shows: the axis is a radius further
        near = math.hypot(depth, across)
        if self._complete and spot.edge is not None:
            turn = self._axis(spot.edge, spot.side, near, camera)
            away = near + self._marker.radius
            local = away * np.array([math.sin(turn), 0.0, math.cos(turn)])
        else:
            local = np.array([across, 0.0, depth]) * (1.0 + self._marker.radius / near)
        x, y = (camera.position + camera.rotation @ local)[:2]
        return math.hypot(x, y), math.atan2(y, x)

    def _axis(self, edge: float, side: float, near: float, camera: Pinhole) -> float:
        """Angle to the right [rad] of a cylinder's axis, if ``edge`` [px] is its ``side``."""
        tangent = math.atan((edge - camera.centre[0]) / camera.focal)
        radius = self._marker.radius
        return tangent - side * math.asin(radius / (near + radius))


@dataclass(frozen=True)
class _Spot:
    """A spot of one colour.

    Attributes:
        x: Its middle [px].
        height: Of a rectangle with the same second moment [px].
        area: [px].
        cut: Whether an edge of the picture cuts it.
        edge: If one side of the picture cuts it, where its other side is [px]; else None.
        side: Which side of the spot that is: 1 the right one, -1 the left one.
    """

    x: float
    height: float
    area: float
    cut: bool
    edge: float | None
    side: float


def _largest(mask: NDArray[np.uint8]) -> _Spot | None:
    count, labels, stats, _ = cv2.connectedComponentsWithStats(mask, connectivity=8)
    if count < 2:
        return None
    k = 1 + int(np.argmax(stats[1:, cv2.CC_STAT_AREA]))
    left, top, width, height, area = stats[k]
    if area < _SMALLEST:
        return None
    own = (labels[top : top + height, left : left + width] == k).astype(np.uint8)
    moments = cv2.moments(own, binaryImage=True)
    # n pixels in a column have a variance of (n^2 - 1) / 12
    spread = math.sqrt(12.0 * moments["mu02"] / moments["m00"] + 1.0)
    sides = left == 0, left + width == mask.shape[1]
    cut = bool(any(sides) or top == 0 or top + height == mask.shape[0])
    middle = moments["m10"] / moments["m00"] + left + 0.5
    edge = None
    if sides[0] != sides[1]:
        edge = float(left + width if sides[0] else left)
    side = 1.0 if sides[0] else -1.0
    return _Spot(x=middle, height=spread, area=float(area), cut=cut, edge=edge, side=side)
