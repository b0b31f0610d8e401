"""Columns of a picture: how far the nearest coloured thing is, by its lowest pixel."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from controllers.perception.blobs import BlobFinder
from mjmr.geometry import Pinhole

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Paint:
    """How one kind of thing is known.

    Attributes:
        kind: Index into the kinds of surfaces.
        colour: RGB, 0 to 1.
        foot: Height of its lower edge above the floor [m].
    """

    kind: int
    colour: tuple[float, float, float]
    foot: float = 0.0


class FloorColumns:
    """Turns pictures of a level floor into columns of kinds and ranges.

    Things stand on the floor and are told by their colours (blobs by hue and saturation, OpenCV).
    In every column of the picture the lowest pixel of a colour is the lower edge of the nearest
    thing of that kind; its row says how far away that is. What is nearer than the picture's lower
    edge shows reads as that edge, which is too far by a little.

    Attributes:
        columns: Of a picture.
        resolution: Error of a range at 1 m, in which a row is 1 px too high or low [m].
    """

    def __init__(self, camera: Pinhole, paints: Sequence[Paint]):
        """Precompute where every pixel's lower edge meets the floor, and the planes of the feet.

        Args:
            camera: In the frame of the arc: origin on the floor, x ahead, z up.
            paints: Of every kind that is to be told from the others.
        """
        self._paints = tuple(paints)
        self._blobs = BlobFinder([paint.colour for paint in paints])
        # lower edges of pixels, from the right of the picture to the left: bearings increase
        u = np.arange(camera.width)[::-1] + 0.5
        v = np.arange(camera.height) + 1.0
        pixels = np.stack(np.meshgrid(u, v), axis=-1)
        self._ranges, self._bearings = [], []
        for paint in paints:
            at = camera.on_plane(pixels, paint.foot)
            there = np.hypot(at[..., 0], at[..., 1])
            self._ranges.append(np.where(np.isfinite(there), there, np.inf))
            self._bearings.append(np.arctan2(at[..., 1], at[..., 0]))
        ahead = camera.rays(np.column_stack([u, np.full_like(u, camera.height / 2)]))
        self._ahead = np.arctan2(ahead[:, 1], ahead[:, 0])
        self.columns = camera.width
        lowest = max((paint.foot for paint in paints), default=0.0)
        self.resolution = 1.0 / ((float(camera.position[2]) - lowest) * camera.focal)

    def look(self, images: NDArray[np.uint8]) -> tuple[Array, Array, Array]:
        """Columns of n pictures.

        Args:
            images: RGB (n, height, width, 3).

        Returns:
            Bearings (n, c) [rad], increasing; ranges (n, c) [m], infinite where nothing stands;
            kinds (n, c), there 0.
        """
        n, c = len(images), self.columns
        bearings = np.tile(self._ahead, (n, 1))
        ranges, kinds = np.full((n, c), np.inf), np.zeros((n, c))
        every = np.arange(c)
        for i, image in enumerate(images):
            self._blobs.look(image)
            for k, paint in enumerate(self._paints):
                upside_down = self._blobs.mask(k)[::-1, ::-1]
                row = len(upside_down) - 1 - upside_down.argmax(axis=0)
                found = np.where(upside_down.any(axis=0), self._ranges[k][row, every], np.inf)
                nearer = found < ranges[i]
                ranges[i, nearer], kinds[i, nearer] = found[nearer], paint.kind
                bearings[i, nearer] = self._bearings[k][row, every][nearer]
        return bearings, ranges, kinds
