"""RayScene: one simulation as rays see it, in the state a sample was taken in."""

import copy
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.materials import DARK
from mjmr.sensors.range_errors import METHODS
from mjmr.sensors.ray_kernels import cast_fans, clear_segments, incidence
from mjmr.sensors.shape_table import geom_owners, seen_geoms, shape_table
from mjmr.sensors.stage import Stage

if TYPE_CHECKING:
    from mjmr.loop import TickedSimulation

Array = NDArray[np.float64]
# groups of the private model that MuJoCo's rays go by
_REST, _KNOWN, _OUT = 0, 1, 5


class RayScene(Stage):
    """Casts rays at exactly the collision geometry: every geom of group 0.

    Two casters, checked against each other: ``compiled`` (:mod:`mjmr.sensors.ray_kernels`) knows
    boxes, spheres, ellipsoids, cylinders, capsules and planes, however they stand; ``mujoco`` is
    MuJoCo's ``mj_ray``, which knows meshes and height fields too and takes a hundred times as long
    among many bodies. ``auto`` casts compiled rays, and MuJoCo's at such shapes alone, where there
    are any.

    Attributes:
        names: Of the robots, which are "owners" by their index.
    """

    def __init__(self, simulation: "TickedSimulation"):
        """Make the tables of shapes."""
        super().__init__(simulation)
        # groups are changed to leave robots out, in a model of one's own
        self.model = model = copy.copy(self.model)
        self.names = simulation.team.names
        self._owners = geom_owners(model, self.names)
        self._table, rest = shape_table(model, self._owners)
        seen = seen_geoms(model)
        model.geom_group[:] = np.where(rest, _REST, np.where(seen, _KNOWN, _OUT))
        self._own = [np.flatnonzero((self._owners == k) & seen) for k in range(len(self.names))]
        self._bases = np.array([_base(model, name) for name in self.names])
        self._other_kinds = sorted({mujoco.mjtGeom(t).name for t in model.geom_type[rest]})
        names = np.array([model.mat(k).name for k in range(model.nmat)] + [""])
        dark = np.isin(names, DARK)[model.geom_matid]
        self._dark = dark if dark.any() else None
        data = self.data
        # live views, which stay where they are
        self._places = (data.geom_xpos, data.geom_xmat, data.xpos, data.xmat)
        self._mask = np.zeros(mujoco.mjNGROUP, dtype=np.uint8)
        row_of = {int(geom): row for row, geom in enumerate(self._table.geoms)}
        self._pillar_rows = [row_of[int(geom)] for geom in self.pillars.geoms]
        self._resize()

    def show(self, state: Any) -> None:
        """Put everything where it was when ``simulation.visible_state()`` returned ``state``."""
        super().show(state)
        if self.pillars.change:
            self._resize()

    def _resize(self) -> None:
        self.pillars.resize(self.model, self.time)
        self._table.sizes[self._pillar_rows, 0] = self.model.geom_size[self.pillars.geoms, 0]

    def sites(self, prefixes: Sequence[str], names: Sequence[str]) -> NDArray[np.int64]:
        """Sites of robots (n, k) by their names in the robot's model."""
        return np.array([[self.model.site(f"{p}{name}").id for name in names] for p in prefixes])

    def frames(self, sites: NDArray[np.int64]) -> tuple[Array, Array]:
        """Positions (m, 3) [m] and rotations (m, 3, 3) of m sites in the state shown."""
        flat = sites.ravel()
        return self.data.site_xpos[flat], self.data.site_xmat[flat].reshape(-1, 3, 3)

    def bases(self) -> tuple[Array, Array]:
        """Positions (n, 3) [m] and rotations (n, 3, 3) of the robots' bases in the state shown."""
        data = self.data
        return data.xpos[self._bases], data.xmat[self._bases].reshape(-1, 3, 3)

    def mounts(self, sites: NDArray[np.int64]) -> Array:
        """Poses (k, 3) [m, m, rad] of sites (k,) of one robot in its base's frame, at home."""
        data = mujoco.MjData(self.model)
        mujoco.mj_kinematics(self.model, data)
        base = self.model.body_rootid[self.model.site_bodyid[sites[0]]]
        turn = data.xmat[base].reshape(3, 3)
        places = (data.site_xpos[sites] - data.xpos[base]) @ turn
        ahead = data.site_xmat[sites].reshape(-1, 3, 3)[:, :, 0] @ turn
        return np.column_stack([places[:, :2], np.arctan2(ahead[:, 1], ahead[:, 0])])

    def cast(
        self,
        origins: Array,
        frames: Array,
        owners: NDArray[np.int64],
        angles: Array,
        reach: float,
        method: str = "auto",
        cosines: bool = False,
    ) -> tuple[Array, NDArray[np.int32], Array | None]:
        """Nearest hits of m fans of b beams each, none of which sees the robot it is on.

        From inside a shape a beam meets the face through which it leaves.

        Args:
            origins: (m, 3) [m], world frame.
            frames: Rotations (m, 3, 3): columns are the middle beam, its left, the plane's normal.
            owners: Robots that the fans are on (m,), -1 for none.
            angles: Of the beams to the middle one (b,) [rad], evenly spaced, symmetric.
            reach: What is further away is not hit [m].
            method: One of ``METHODS``.
            cosines: Whether the third result is wanted.

        Returns:
            Ranges (m, b) [m], infinite where nothing is hit; geoms hit (m, b), there -1; cosines of
            the angles of incidence (m, b), there 0, or None.
        """
        self._check(method)
        cos, sin = np.cos(angles), np.sin(angles)
        slopes = None
        if method == "mujoco":
            ranges = np.full((len(origins), len(angles)), np.inf)
            hits = np.full(ranges.shape, -1, dtype=np.int32)
            slopes = np.zeros(ranges.shape) if cosines else None
            groups: tuple[int, ...] = (_REST, _KNOWN)
        else:
            ranges, hits = cast_fans(
                origins, frames, owners, cos, sin, reach, tuple(self._table), *self._places
            )
            if cosines:
                model = self.model
                slopes = incidence(
                    origins, frames, cos, sin, ranges, hits, model.geom_type, model.geom_size,
                    *self._places[:2],
                )  # fmt: skip
            groups = (_REST,) if self._other_kinds and method == "auto" else ()
        if groups:
            ways = cos[:, None] * frames[:, None, :, 0] + sin[:, None] * frames[:, None, :, 1]
            self._mask[:] = 0
            self._mask[list(groups)] = 1
            for i, ways_i in enumerate(ways):
                self._mujoco_rays(
                    origins[i], ways_i, int(owners[i]), reach, ranges[i], hits[i],
                    None if slopes is None else slopes[i],
                )  # fmt: skip
        return ranges, hits, slopes

    def drop_dark(self, ranges: Array, hits: NDArray[np.int32]) -> None:
        """Make ranges (m, b) infinite where what was hit is of a material that returns no light."""
        if self._dark is not None:
            ranges[self._dark[hits] & (hits >= 0)] = np.inf

    def clear(
        self,
        starts: Array,
        ends: Array,
        start_owners: NDArray[np.int64],
        end_owners: NDArray[np.int64],
    ) -> NDArray[np.bool_]:
        """Whether nothing is between points (a, 3) and (b, 3) [m]: (a, b).

        Args:
            starts: World frame.
            ends: World frame.
            start_owners: Robots that the starts are on (a,), -1 for none; no robot is in the way of
                what starts or ends on it.
            end_owners: The same of the ends (b,).
        """
        clear = clear_segments(
            starts, ends, start_owners, end_owners, tuple(self._table), *self._places
        )
        if self._other_kinds and len(ends):
            self._mask[:] = 0
            self._mask[_REST] = 1
            for i, start in enumerate(starts):
                way = ends - start
                length = np.maximum(np.linalg.norm(way, axis=1), 1e-12)
                ranges = length.copy()
                hits = np.full(len(ends), -1, dtype=np.int32)
                units = way / length[:, None]
                self._mujoco_rays(
                    start, units, int(start_owners[i]), float(length.max()), ranges, hits, None
                )
                owner = np.where(hits < 0, -2, self._owners[hits])
                clear[i] &= (hits < 0) | ((owner >= 0) & (owner == end_owners))
        return clear

    def _mujoco_rays(
        self,
        origin: Array,
        ways: Array,
        owner: int,
        reach: float,
        ranges: Array,
        hits: NDArray[np.int32],
        slopes: Array | None,
    ) -> None:
        """Improve ranges (b,), hits and cosines by MuJoCo's rays along unit vectors (b, 3)."""
        count, group = len(ways), self.model.geom_group
        model, data, mask = self.model, self.data, self._mask
        own = self._own[owner] if owner >= 0 else self._own[0][:0]
        kept = group[own]
        group[own] = _OUT  # MuJoCo can leave out one body alone
        found, geoms = np.empty(count), np.empty((count, 1), dtype=np.int32)
        normals = np.empty((count, 3))
        # one by one: mj_multiRay (MuJoCo 3.17) misses some bodies that mj_ray hits
        for k, way in enumerate(ways):
            found[k] = mujoco.mj_ray(model, data, origin, way, mask, 1, -1, geoms[k], normals[k])
        group[own] = kept
        better = (found >= 0.0) & (found < np.minimum(ranges, reach))
        ranges[better], hits[better] = found[better], geoms[better, 0]
        if slopes is not None:
            slopes[better] = np.abs((normals * ways).sum(axis=1))[better]

    def _check(self, method: str) -> None:
        if method not in METHODS:
            raise UnknownNameError("method of casting rays", method, METHODS)
        if method == "compiled" and self._other_kinds:
            raise InvalidInputError(
                f"compiled rays cannot see {', '.join(self._other_kinds)} in the collision group; "
                'use method="auto"'
            )


def _base(model: Any, robot: str) -> int:
    """First body of a robot."""
    return next(b for b in range(model.nbody) if model.body(b).name.startswith(f"{robot}/"))
