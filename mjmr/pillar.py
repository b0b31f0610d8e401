"""Pillar: an upright cylinder that stands where it is and may grow or shrink with time."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError

if TYPE_CHECKING:
    import mujoco

Array = NDArray[np.float64]
_GROWTH = "growth of "  # of a pillar's entry among a model's custom numbers: traces keep it


def radii_at(first: ArrayLike, rate: ArrayLike, limit: ArrayLike, time: float) -> Array:
    """Radii at ``time`` [s] of what grows or shrinks steadily until a limit: the one such law.

    Args:
        first: Radii at time 0 and before [m].
        rate: Of their change [m/s].
        limit: Where it ends [m]; what does not change has none.
        time: [s].

    Returns:
        Radii of the arguments' common shape [m].
    """
    first, rate, limit = (np.asarray(given, dtype=np.float64) for given in (first, rate, limit))
    now = first + rate * max(time, 0.0)
    stopped = np.where(rate > 0, np.minimum(now, limit), np.maximum(now, limit))
    return np.where(rate == 0, first, stopped)


@dataclass(frozen=True, kw_only=True)
class Pillar:
    """A fixed upright cylinder; a spill, a tree, a column.

    Its radius is a function of time alone, which nothing that touches it changes: the environment
    grows, by no force. Between two control periods its shape is another one; what touches it is
    pressed back as deep as it overlaps, and the solver knows nothing of the speed of its surface.
    That is fair while growth is slow against the depth of contacts: 0.0125 m/s are 1.25 mm in a
    period of 0.1 s.

    Attributes:
        x: Centre [m], world frame.
        y: Centre [m], world frame.
        radius: At time 0 [m].
        growth: Of the radius [m/s], negative if it shrinks.
        limit: Radius at which that ends [m]; needed if it grows or shrinks.
        height: [m].
        rgba: Colour, 0 to 1.

    Raises:
        InvalidInputError: A size that is not positive and finite, or a change without a limit or
            away from it.
    """

    x: float
    y: float
    radius: float
    growth: float = 0.0
    limit: float | None = None
    height: float = 0.4
    rgba: tuple[float, float, float, float] = (0.85, 0.05, 0.05, 1.0)

    def __post_init__(self):
        if not (math.isfinite(self.x) and math.isfinite(self.y)):
            raise InvalidInputError(f"a pillar's place must be finite; got {self.x}, {self.y}")
        for name in ("radius", "height"):
            value = getattr(self, name)
            if not 0 < value < math.inf:
                raise InvalidInputError(
                    f"a pillar's {name} must be positive and finite; got {value}"
                )
        if not math.isfinite(self.growth):
            raise InvalidInputError(f"a pillar's growth must be finite; got {self.growth} m/s")
        if self.growth == 0.0:
            return
        if self.limit is None or not 0 < self.limit < math.inf:
            raise InvalidInputError(
                f"a pillar that grows or shrinks needs a positive limit; got {self.limit} m"
            )
        if (self.limit - self.radius) * self.growth < 0:
            raise InvalidInputError(
                f"a pillar of radius {self.radius:g} m that changes by {self.growth:g} m/s gets "
                f"away from its limit of {self.limit:g} m"
            )

    @property
    def largest(self) -> float:
        """Largest radius it ever has [m]."""
        grows = self.growth > 0 and self.limit is not None
        return self.limit if grows else self.radius  # pyright: ignore[reportReturnType]


def add_pillar(spec: "mujoco.MjSpec", name: str, pillar: Pillar) -> None:
    """Add a pillar to the world of ``spec``, at its largest.

    The bounds by which MuJoCo sorts out what cannot touch are computed when a model is compiled;
    those of the largest radius hold for every other one.
    """
    import mujoco

    spec.worldbody.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_CYLINDER,
        pos=[pillar.x, pillar.y, pillar.height / 2],
        size=[pillar.largest, pillar.height / 2, 0],
        rgba=pillar.rgba,
        group=0,
    )
    limit = pillar.radius if pillar.limit is None else pillar.limit
    spec.add_numeric(
        name=_GROWTH + name,
        size=3,
        data=[pillar.radius, pillar.growth, limit if pillar.growth else pillar.radius],
    )


class Pillars:
    """The pillars in one compiled model, or a copy of it, which says itself how they change.

    Attributes:
        geoms: Their geoms (k,).
        any: Whether there are any.
        change: Whether one of them grows or shrinks.
    """

    def __init__(self, model: "mujoco.MjModel"):
        """Look them up."""
        told = [model.numeric(i) for i in range(model.nnumeric)]
        told = [entry for entry in told if entry.name.startswith(_GROWTH)]
        names = [entry.name.removeprefix(_GROWTH) for entry in told]
        self.geoms = np.array([model.geom(name).id for name in names], dtype=np.int64)
        self._first, self._rate, self._limit = (
            np.array([entry.data for entry in told], dtype=np.float64).reshape(-1, 3).T
        )
        self.any = bool(told)
        self.change = bool(self._rate.any())

    def radii(self, time: float) -> Array:
        """Radii (k,) at ``time`` [s], in m; see :func:`radii_at`."""
        return radii_at(self._first, self._rate, self._limit, time)

    def resize(self, model: "mujoco.MjModel", time: float) -> None:
        """Give them in ``model`` the radii they have at ``time`` [s]; their bounds stay."""
        if self.any:
            model.geom_size[self.geoms, 0] = self.radii(time)
