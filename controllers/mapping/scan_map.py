"""ScanMap: walls as scans show them, in the robot's own frame, as polygons of grown obstacles."""

import math

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError
from mjmr.geometry import transform_points

Array = NDArray[np.float64]


class ScanMap:
    """A grid of what returned an echo, grown by a radius; what was never seen counts as free.

    The map is as good as the poses it is fed with: it corrects none.

    Attributes:
        cell: Of the grid [m].
        version: Changes when the map does.
    """

    def __init__(self, *, radius: float, reach: float, cell: float = 0.05, half: float = 40.0):
        """Start with an empty map around the origin.

        Args:
            radius: That obstacles are grown by [m].
            reach: Echoes further off are not taken [m].
            cell: Of the grid [m].
            half: The map ends this far from the origin along x and y [m].

        Raises:
            InvalidInputError: A number that is not positive and finite.
        """
        for name, value in (("radius", radius), ("reach", reach), ("cell", cell), ("half", half)):
            if not 0 < value < math.inf:
                raise InvalidInputError(f"{name} must be positive and finite; got {value} m")
        self.radius, self.reach, self.cell = float(radius), float(reach), float(cell)
        self.version = 0
        self._size = 2 * math.ceil(half / cell)
        self._hit = np.zeros((self._size, self._size), dtype=bool)
        self._grown = np.zeros((self._size, self._size), dtype=np.uint8)
        self._low, self._high = np.full(2, self._size), np.zeros(2, dtype=np.int64)

    def add(self, pose: ArrayLike, ranges: Array, angles: Array) -> None:
        """Enter a scan.

        Args:
            pose: Of the scanner (3,) [m, m, rad].
            ranges: (b,) [m]; not finite where nothing returned.
            angles: Of the beams (b,) [rad] to the pose's heading.
        """
        taken = (ranges > 0) & (ranges < self.reach)
        local = ranges[taken, None] * np.column_stack(
            [np.cos(angles[taken]), np.sin(angles[taken])]
        )
        cells = np.floor(transform_points(pose, local) / self.cell).astype(int) + self._size // 2
        inside = ((cells >= 0) & (cells < self._size)).all(axis=1)
        cells = cells[inside]
        fresh = cells[~self._hit[cells[:, 0], cells[:, 1]]]
        if not len(fresh):
            return
        self.version += 1
        self._hit[fresh[:, 0], fresh[:, 1]] = True
        for i, j in fresh:
            # radius with four bits of fraction; OpenCV's x is the column
            cv2.circle(
                self._grown, (int(j) << 4, int(i) << 4), round(16 * self.radius / self.cell), 255,
                cv2.FILLED, cv2.LINE_8, 4,
            )  # fmt: skip
        margin = math.ceil(self.radius / self.cell) + 2
        self._low = np.maximum(np.minimum(self._low, fresh.min(axis=0) - margin), 0)
        self._high = np.minimum(np.maximum(self._high, fresh.max(axis=0) + margin), self._size)

    def edges(self) -> tuple[Array, NDArray[np.int64], NDArray[np.int64]]:
        """Rims of the grown obstacles.

        Returns:
            Edges (m, 4): x0, y0, x1, y1 [m], free space on the left of each; the index of the edge
            after each (m,) and of the one before each (m,).
        """
        (top, left), (bottom, right) = self._low, self._high
        window = self._grown[top:bottom, left:right]
        rims = []
        if window.size:
            rims, _ = cv2.findContours(window, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
        pieces, after, before, count = [], [], [], 0
        for rim in rims:
            if len(rim) < 4:
                continue
            rim = cv2.approxPolyDP(rim, 0.6, True)[:, 0].astype(np.float64)
            if len(rim) < 3:
                continue
            # rows are x and columns y here, which leaves the obstacle on the left of OpenCV's order
            corners = (rim[::-1, ::-1] + [top, left] - self._size // 2 + 0.5) * self.cell
            following = np.roll(corners, -1, axis=0)
            pieces.append(np.column_stack([corners, following]))
            index = count + np.arange(len(corners))
            after.append(np.roll(index, -1))
            before.append(np.roll(index, 1))
            count += len(corners)
        if not pieces:
            return np.empty((0, 4)), np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64)
        return np.concatenate(pieces), np.concatenate(after), np.concatenate(before)
