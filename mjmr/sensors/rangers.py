"""Sonar and InfraredRanger: the nearest return in a cone, from arrays of named sites."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError
from mjmr.sensors.base import Sensor
from mjmr.sensors.mount import carrier_model, numbered_sites, site_place
from mjmr.sensors.range_errors import RangeErrors, fan_angles

if TYPE_CHECKING:
    import mujoco

    from mjmr.group import Group

Array = NDArray[np.float64]


class Ranger(Sensor):
    """Rangers on k sites of every robot of a group, each of which reports its nearest return.

    A cone is sampled by flat fans of rays through its axis, the outermost along its edges; what
    fits between two rays is missed. All rangers measure in one instant and none hears another. Each
    sees every robot but its own, props, walls and the floor.

    Ranges follow ROS's REP 117: infinite where nothing returns within ``max_range``, minus infinite
    for a nearest return nearer than ``min_range``, NaN for what was dropped out.

    Attributes:
        beam_width: Full angle of the cone [rad].
        max_range: [m].
        errors: What becomes of true ranges.
        max_incidence: Surfaces met further off their normal than this return nothing [rad].
    """

    name = "ranger"
    _light = True

    def __init__(
        self,
        *,
        sites: str | Sequence[str],
        beam_width: float,
        max_range: float,
        min_range: float,
        max_incidence: float,
        rate: float,
        latency: float = 0.0,
        phase: float = 0.0,
        noise: float = 0.0,
        proportional_noise: float = 0.0,
        drop_out: float = 0.0,
        rays: int = 15,
        fans: int = 1,
    ):
        """Set cones, schedule, errors and places; subclasses say what is usual.

        Args:
            sites: Stem of an array of sites of the robot's model, ``sonar`` for ``sonar0``,
                ``sonar1`` and so on, or the names themselves; x is the axis.
            beam_width: Full angle of the cone [rad].
            max_range: [m].
            min_range: [m].
            max_incidence: [rad], above 0 to pi / 2.
            rate: Measurements a second of every ranger [Hz].
            latency: [s].
            phase: Instant of the first measurement [s].
            noise: Standard deviation [m], Gaussian.
            proportional_noise: The same as a share of the range; the larger of both counts.
            drop_out: Probability that a measurement is lost.
            rays: Of a fan.
            fans: Of a cone, turned about its axis by pi / fans from one to the next; the first one
                lies in the site's x-y plane, the only one by default: what is above or below is not
                seen, nor is the floor.

        Raises:
            InvalidInputError: Angles, ranges, counts, rates or shares that cannot be.
        """
        super().__init__(rate=rate, latency=latency, phase=phase)
        if not 0 < beam_width < math.pi:
            raise InvalidInputError(f"beam_width lies between 0 and pi rad; got {beam_width}")
        if not 0 < max_incidence <= math.pi / 2:
            raise InvalidInputError(
                f"max_incidence lies above 0 and is at most pi / 2 rad; got {max_incidence}"
            )
        if not (rays == int(rays) and rays >= 2 and fans == int(fans) and fans >= 1):
            raise InvalidInputError(
                f"a cone has at least 1 fan of at least 2 rays, whole numbers; got {fans} of {rays}"
            )
        self.errors = RangeErrors(
            min_range=min_range,
            max_range=max_range,
            noise=noise,
            proportional_noise=proportional_noise,
            drop_out=drop_out,
        )
        if not isinstance(sites, str) and not len(sites):
            raise InvalidInputError(f"a {self.name} needs at least one site; got none")
        self.beam_width, self.max_incidence = float(beam_width), float(max_incidence)
        self.max_range = float(max_range)
        self._asked = sites if isinstance(sites, str) else tuple(sites)
        self._angles = fan_angles(int(rays), self.beam_width)
        rolls = np.pi * np.arange(int(fans)) / int(fans)
        self._rolls = np.array(
            [[[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]] for a in rolls]
        )

    def read(self) -> Array:
        """Newest ranges delivered by now, shape (n, k) [m]; see the class for what is not finite.

        NaN throughout before the first delivery.
        """
        return super().read()

    @property
    def site_names(self) -> tuple[str, ...]:
        """Names of the sites, in the order of the ranges."""
        if isinstance(self._asked, tuple):
            return self._asked
        return numbered_sites(carrier_model(self), self._asked)

    @property
    def mounts(self) -> Array:
        """Where the cones begin, (k, 3): x, y, yaw [m, m, rad] in the base's frame, at home."""
        if self._simulation is None:
            raise InvalidInputError(f"the {self.name} can be asked once it is in a simulation")
        return self._simulation.rays.mounts(self._sites()[0])

    def add_to(self, spec: "mujoco.MjSpec", prefixes: Sequence[str], key: str) -> None:
        """Check that the robot has the sites."""
        robot = carrier_model(self)
        for name in self._asked if isinstance(self._asked, tuple) else ():
            site_place(robot, name)
        if isinstance(self._asked, str):
            numbered_sites(robot, self._asked)

    def prepare(self, sequence: np.random.SeedSequence, group: "Group") -> None:
        """Set up the noise streams."""
        assert self._simulation is not None
        self._names = self.site_names
        self._streams = self.errors.streams(sequence, (group.n, len(self._names)))
        self._found: NDArray[np.int64] | None = None
        rows = self._simulation.team.rows(group)
        each = len(self._names) * len(self._rolls)
        self._rows = np.arange(rows.start, rows.stop).repeat(each)

    def observe(self, time: float) -> Any:
        """Where everything is now."""
        assert self._simulation is not None
        return self._simulation.visible_state()

    def compute(self, state: Any, number: int) -> Array:
        """Cast the rays, keep what returns, take the nearest, then spoil it."""
        assert self._simulation is not None
        scene = self._simulation.rays
        scene.show(state)
        origins, frames = scene.frames(self._sites())
        count = len(self._rolls)
        frames = np.einsum("mij,fjk->mfik", frames, self._rolls).reshape(-1, 3, 3)
        ranges, hits, cosines = scene.cast(
            origins.repeat(count, axis=0), frames, self._rows, self._angles, self.max_range,
            cosines=True,
        )  # fmt: skip
        # an angle at the very limit still returns
        assert cosines is not None
        ranges[cosines < math.cos(self.max_incidence) - 1e-9] = np.inf
        if self._light:
            scene.drop_dark(ranges, hits)
        nearest = ranges.reshape(self._group.n, len(self._names), -1).min(axis=2)
        return self.errors.apply(nearest, self._streams, number)

    def nothing(self) -> Array:
        """All NaN."""
        return np.full((self._group.n, len(self._names)), np.nan)

    def _sites(self) -> NDArray[np.int64]:
        assert self._simulation is not None
        if self._found is None:
            self._found = self._simulation.rays.sites(self._group.prefixes, self._names)
        return self._found


class Sonar(Ranger):
    """Ultrasonic rangers: wide cones, and smooth surfaces met at a slant reflect the sound away.

    Light or dark makes no difference. Defaults are those of the Polaroid 6500 ranging module with
    an environmental transducer, as on the Pioneer 2-DX: -6 dB at about 15 degrees off the axis,
    1 % of the range, 0.15 m on (grade C, as remembered from its data sheet); what a slant loses and
    5 m as the longest range are assumed. Neither cross-talk, nor echoes that come back round a
    corner, nor the order in which a ring fires is modelled.
    """

    name = "sonar"
    _light = False

    def __init__(
        self,
        *,
        sites: str | Sequence[str] = "sonar",
        beam_width: float = math.radians(30.0),
        max_range: float = 5.0,
        min_range: float = 0.15,
        max_incidence: float = math.radians(25.0),
        rate: float = 3.0,
        **options: Any,
    ):
        """See :class:`Ranger`; by default every sonar fires three times a second."""
        super().__init__(
            sites=sites, beam_width=beam_width, max_range=max_range, min_range=min_range,
            max_incidence=max_incidence, rate=rate, **options,
        )  # fmt: skip


class InfraredRanger(Ranger):
    """Infra-red rangers: narrow cones; what is ``mirror`` or ``black`` returns nothing.

    Defaults (assumed) are of a small reflective sensor. Reflectance of the surface and ambient
    light, which such sensors do feel, are not modelled.
    """

    name = "infrared"

    def __init__(
        self,
        *,
        sites: str | Sequence[str] = "ir",
        beam_width: float = math.radians(10.0),
        max_range: float = 0.5,
        min_range: float = 0.0,
        max_incidence: float = math.radians(80.0),
        rate: float = 50.0,
        rays: int = 7,
        **options: Any,
    ):
        """See :class:`Ranger`."""
        super().__init__(
            sites=sites, beam_width=beam_width, max_range=max_range, min_range=min_range,
            max_incidence=max_incidence, rate=rate, rays=rays, **options,
        )  # fmt: skip
