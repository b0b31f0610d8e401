"""Columns of a picture: how far the foot of the nearest coloured thing is, by its lowest pixel."""

import numpy as np
from numpy.typing import NDArray

from controllers.perception.blobs import BlobFinder
from mjmr.geometry import Pinhole

Array = NDArray[np.float64]


class FloorColumns:
    """Turns pictures of a level floor into columns of kinds and ranges.

    Things stand on the floor and are told by their colours (blobs by hue and saturation, OpenCV).
    In every column of the picture the lowest coloured pixel is the foot of the nearest thing; its
    row says how far away that is. What is nearer than the picture's lower edge shows reads as that
    edge, which is too far by a little.

    Attributes:
        columns: Of a picture.
        resolution: Error of a range at 1 m, in which a row is 1 px too high or low [m].
    """

    def __init__(self, camera: Pinhole, colours: dict[int, tuple[float, float, float]]):
        """Precompute where every pixel's lower edge meets the floor.

        Args:
            camera: In the frame of the arc: origin on the floor, x ahead, z up.
            colours: RGB, 0 to 1, by kind.
        """
        self._kinds = np.array(list(colours))
        self._blobs = BlobFinder(list(colours.values()))
        v, u = np.mgrid[0 : camera.height, 0 : camera.width] + np.array([1.0, 0.5])[:, None, None]
        ways = np.stack(
            [
                (u - camera.width / 2) / camera.focal,
                (v - camera.height / 2) / camera.focal,
                np.ones_like(u),
            ],
            axis=-1,
        ) @ np.asarray(camera.rotation).T
        down = np.where(ways[..., 2] < -1e-9, -ways[..., 2], np.nan)
        floor = camera.position[:2] + ways[..., :2] * (camera.position[2] / down)[..., None]
        # from the right edge of the picture to the left: bearings increase
        self._range = np.hypot(floor[..., 0], floor[..., 1])[:, ::-1]
        self._bearing = np.arctan2(ways[..., 1], ways[..., 0])[:, ::-1]
        self._level = np.argmin(np.abs(ways[:, camera.width // 2, 2]))
        self.columns = camera.width
        self.resolution = 1.0 / (float(camera.position[2]) * camera.focal)

    def look(self, images: NDArray[np.uint8]) -> tuple[Array, Array, Array]:
        """Columns of n pictures.

        Args:
            images: RGB (n, height, width, 3).

        Returns:
            Bearings (n, c) [rad], increasing; ranges (n, c) [m], infinite where nothing stands;
            kinds (n, c), there 0.
        """
        n, c = len(images), self.columns
        bearings = np.tile(self._bearing[self._level], (n, 1))
        ranges, kinds = np.full((n, c), np.inf), np.zeros((n, c))
        every = np.arange(c)
        for i, image in enumerate(images):
            self._blobs.look(image)
            lowest = np.full(c, -1)
            for k, kind in enumerate(self._kinds):
                mask = self._blobs.mask(k)[::-1, ::-1]
                row = np.where(mask.any(axis=0), len(mask) - 1 - mask.argmax(axis=0), -1)
                nearer = row > lowest
                lowest[nearer], kinds[i, nearer] = row[nearer], kind
            seen = lowest >= 0
            ranges[i, seen] = self._range[lowest[seen], every[seen]]
            bearings[i, seen] = self._bearing[lowest[seen], every[seen]]
        # a foot at or above the horizon is of no thing on the floor
        lost = ~np.isfinite(ranges)
        kinds[lost] = 0
        return bearings, ranges, kinds
