"""VisualArc: what a camera on a robot makes out, by rays: the nearest surface of every column."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError
from mjmr.pillar import Pillars
from mjmr.sensors.base import Sensor
from mjmr.sensors.mount import carrier_model, site_place
from mjmr.sensors.range_errors import RangeErrors, fan_angles

if TYPE_CHECKING:
    import mujoco

    from mjmr.group import Group

Array = NDArray[np.float64]
NOTHING, FIXED, ROBOT, MOVER, PILLAR = 0, 1, 2, 3, 4
KINDS = ("nothing", "fixed", "robot", "mover", "pillar")


class VisualArc(Sensor):
    """A fan of rays in place of a camera's columns, on every robot of a group.

    Each column tells the range of the nearest surface at one height and what kind of thing it is:
    a robot, a prop that can be moved, a pillar, or what is fixed (walls, boxes). Which one of its
    kind is not told, as by a camera that knows things by their colours. What is behind something
    else is hidden, what is lower than the plane is not seen, and the carrier does not see itself.
    The fan is level whatever the robot's tilt, and turns with the site it is at.

    Attributes:
        angles: Of the columns (c,) [rad] to the site's x axis, anticlockwise, increasing.
        field_of_view: [rad].
        max_range: [m].
        errors: What becomes of true ranges.
    """

    name = "visual_arc"

    def __init__(
        self,
        *,
        site: str,
        height: float,
        columns: int = 128,
        field_of_view: float = math.pi / 2,
        max_range: float = 3.0,
        rate: float = 10.0,
        latency: float = 0.0,
        phase: float = 0.0,
        noise: float = 0.0,
        proportional_noise: float = 0.0,
    ):
        """Set place, fan, schedule and errors.

        Args:
            site: Of the robot's model, above which the fan's origin lies; x is the middle.
            height: Of the plane above the floor [m].
            columns: Number of rays.
            field_of_view: Between the first ray and the last one [rad].
            max_range: [m].
            rate: Looks a second [Hz].
            latency: [s].
            phase: Instant of the first look [s].
            noise: Standard deviation of a range [m], Gaussian.
            proportional_noise: The same as a share of the range; the larger of both counts.

        Raises:
            InvalidInputError: Counts, angles, ranges or rates that cannot be.
        """
        super().__init__(rate=rate, latency=latency, phase=phase)
        if not (columns == int(columns) and columns >= 2):
            raise InvalidInputError(f"a visual arc has at least 2 columns; got {columns}")
        if not 0 < field_of_view <= 2 * math.pi:
            raise InvalidInputError(
                f"field_of_view lies above 0 and is at most 2 pi rad; got {field_of_view}"
            )
        if not (height > 0 and math.isfinite(height)):
            raise InvalidInputError(f"the plane's height must be positive; got {height} m")
        self.errors = RangeErrors(
            min_range=0.0,
            max_range=max_range,
            noise=noise,
            proportional_noise=proportional_noise,
            drop_out=0.0,
        )
        self.site, self.height = site, float(height)
        self.field_of_view, self.max_range = float(field_of_view), float(max_range)
        self.angles = fan_angles(int(columns), self.field_of_view)
        self.angles.setflags(write=False)

    def read(self) -> Array:
        """Newest look delivered by now, shape (n, c, 2): range [m] and index into ``KINDS``.

        Where nothing is seen the range is infinite and the kind 0; so it is everywhere before the
        first delivery.
        """
        return super().read()

    @property
    def reading_bounds(self) -> tuple[Array, Array]:
        """Least and largest range and kind."""
        return np.array([0.0, 0.0]), np.array([np.inf, len(KINDS) - 1.0])

    def add_to(self, spec: "mujoco.MjSpec", prefixes: Sequence[str], key: str) -> None:
        """Check that the robot has the site."""
        site_place(carrier_model(self), self.site)

    def prepare(self, sequence: np.random.SeedSequence, group: "Group") -> None:
        """Set up the noise streams."""
        assert self._simulation is not None
        self._streams = self.errors.streams(sequence, (group.n, len(self.angles)))
        rows = self._simulation.team.rows(group)
        self._rows = np.arange(rows.start, rows.stop)
        self._sites: NDArray[np.int64] | None = None
        self._kinds = np.zeros(0)

    def observe(self, time: float) -> Any:
        """Where everything is now."""
        assert self._simulation is not None
        return self._simulation.visible_state()

    def compute(self, state: Any, number: int) -> Array:
        """Cast the rays, spoil the ranges, tell the kinds."""
        assert self._simulation is not None
        scene = self._simulation.rays
        if self._sites is None:
            self._sites = scene.sites(self._group.prefixes, [self.site])
            self._kinds = kinds_of(scene.model, scene.names)
        scene.show(state)
        origins, frames = scene.frames(self._sites)
        origins[:, 2] = self.height
        ranges, hits, _ = scene.cast(
            origins, _level(frames), self._rows, self.angles, self.max_range
        )
        kinds = self._kinds[hits]
        ranges = self.errors.apply(ranges, self._streams, number)
        return np.stack([ranges, kinds], axis=2)

    def nothing(self) -> Array:
        """Nothing is seen."""
        blank = np.zeros((self._group.n, len(self.angles), 2))
        blank[..., 0] = np.inf
        return blank


def _level(frames: Array) -> Array:
    """Rotations (m, 3, 3) about the vertical with the same x axes as seen from above."""
    x, y = frames[:, 0, 0], frames[:, 1, 0]
    length = np.maximum(np.hypot(x, y), 1e-12)
    level = np.zeros_like(frames)
    level[:, 0, 0] = level[:, 1, 1] = x / length
    level[:, 1, 0], level[:, 0, 1] = y / length, -y / length
    level[:, 2, 2] = 1.0
    return level


def kinds_of(model: Any, robots: Sequence[str]) -> Array:
    """Kind of every geom (ngeom + 1,); of geom -1, nothing, the last entry."""
    kinds = np.full(model.ngeom + 1, float(FIXED))
    names, known = [model.body(b).name for b in range(model.nbody)], set(robots)
    for geom in range(model.ngeom):
        body = model.geom_bodyid[geom]
        if names[body].split("/")[0] in known:
            kinds[geom] = ROBOT
        elif model.body_dofnum[model.body_weldid[body]] > 0:
            kinds[geom] = MOVER
    kinds[Pillars(model).geoms] = PILLAR
    kinds[-1] = NOTHING
    return kinds
