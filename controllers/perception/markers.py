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
    """

    def __init__(self, marker: Marker, cameras: Sequence[Pinhole]):
        """Set what is looked for and with what.

        Args:
            marker: What all robots carry.
            cameras: In the robot's frame, their axes level.
        """
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
        stretch = 1.0 + self._marker.radius / math.hypot(depth, across)
        local = np.array([across * stretch, 0.0, depth * stretch])
        x, y = (camera.position + camera.rotation @ local)[:2]
        return math.hypot(x, y), math.atan2(y, x)


@dataclass(frozen=True)
class _Spot:
    """A spot of one colour: middle, height of its rectangle, area [px], cut by an edge or not."""

    x: float
    height: float
    area: float
    cut: bool


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
    edge = left == 0 or left + width == mask.shape[1] or top == 0
    cut = bool(edge or top + height == mask.shape[0])
    middle = moments["m10"] / moments["m00"] + left + 0.5
    return _Spot(x=middle, height=spread, area=float(area), cut=cut)
