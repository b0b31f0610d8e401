"""Lidar: ranges along a fan of beams, to exactly the collision geometry."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.sensors.base import Sensor
from mjmr.sensors.mount import carrier_model, site_place
from mjmr.sensors.range_errors import METHODS, RangeErrors, fan_angles

if TYPE_CHECKING:
    import mujoco

    from mjmr.group import Group

Array = NDArray[np.float64]
_HOUSING = (0.1, 0.1, 0.1)  # m


class Lidar(Sensor):
    """A scanner in a plane of its own, on every robot of a group.

    A scan is taken in an instant; beams have no width. It sees every robot but its own, props,
    walls and the floor where its plane, which tilts with the robot, meets them. **Beams pass over
    what is lower than they are**: the wall of a ``World`` is 0.1 m high unless ``wall_height`` says
    otherwise, and many scanners look over it. Props and walls of material ``mirror`` or ``black``
    stop a beam and return nothing.

    Ranges follow ROS's REP 117: infinite where nothing returns within ``max_range``, minus infinite
    for returns nearer than ``min_range``, NaN for what was dropped out.

    Attributes:
        angles: Of the beams (b,) [rad] to the mount's x axis, anticlockwise, increasing.
        field_of_view: [rad].
        max_range: [m].
        errors: What becomes of true ranges.
    """

    name = "lidar"

    def __init__(
        self,
        *,
        beams: int = 181,
        field_of_view: float = math.pi,
        max_range: float = 8.0,
        min_range: float = 0.0,
        rate: float = 10.0,
        latency: float = 0.0,
        phase: float = 0.0,
        noise: float = 0.0,
        proportional_noise: float = 0.0,
        drop_out: float = 0.0,
        site: str = "",
        position: ArrayLike | None = None,
        yaw: float = 0.0,
        housing: ArrayLike | None = None,
        method: str = "auto",
    ):
        """Set fan, schedule, errors and place.

        Args:
            beams: Number of beams.
            field_of_view: Between the first and the last beam [rad]; of a full turn, 2 pi, the last
                beam is one step before the first.
            max_range: [m].
            min_range: [m].
            rate: Scans a second [Hz].
            latency: From a scan to its delivery [s].
            phase: Instant of the first scan [s].
            noise: Standard deviation of a range [m], Gaussian.
            proportional_noise: The same as a share of the range; the larger of both counts.
            drop_out: Probability that a beam is lost.
            site: Of the robot's model, where it is mounted, x forward; default: ``lidar``, unless
                a position is given.
            position: Instead of a site: (3,) [m] in the frame of the robot's base.
            yaw: Of the middle beam there [rad].
            housing: Length, width and height [m] of the scanner's body, a box that stands on the
                mount and that others see and touch; the beams leave from its middle. Its mass is
                taken to be in the robot's. Default: a cube of 0.1 m on a site; none at a position,
                where the beams leave from the position itself.
            method: How rays are cast, see :class:`mjmr.sensors.ray_scene.RayScene`.

        Raises:
            InvalidInputError: Counts, angles, ranges, rates or shares that cannot be.
            UnknownNameError: Unknown method.
        """
        super().__init__(rate=rate, latency=latency, phase=phase)
        if not (beams == int(beams) and beams >= 1):
            raise InvalidInputError(f"a lidar has a whole number of beams, 1 or more; got {beams}")
        if not 0 < field_of_view <= 2 * math.pi + 1e-12:
            raise InvalidInputError(
                f"field_of_view lies above 0 and is at most 2 pi rad; got {field_of_view}"
            )
        self.errors = RangeErrors(
            min_range=min_range,
            max_range=max_range,
            noise=noise,
            proportional_noise=proportional_noise,
            drop_out=drop_out,
        )
        if method not in METHODS:
            raise UnknownNameError("method of casting rays", method, METHODS)
        if site and position is not None:
            raise InvalidInputError("give a lidar either the name of a site or a position")
        self._place = None if position is None else np.array(position, dtype=np.float64)
        if self._place is not None and not (
            self._place.shape == (3,) and np.isfinite(self._place).all() and math.isfinite(yaw)
        ):
            raise InvalidInputError(
                f"position is three finite numbers and yaw one; got {position} and {yaw}"
            )
        if yaw and position is None:
            raise InvalidInputError("a site has a heading of its own; yaw goes with a position")
        if housing is None and position is None:
            housing = _HOUSING
        self._housing = None if housing is None else np.array(housing, dtype=np.float64)
        if self._housing is not None and not (
            self._housing.shape == (3,) and (self._housing > 0).all()
            and np.isfinite(self._housing).all()
        ):  # fmt: skip
            raise InvalidInputError(
                f"a housing has a positive length, width and height; got {housing}"
            )
        self.max_range = float(max_range)
        self.field_of_view, self.method = float(field_of_view), method
        self.angles = fan_angles(int(beams), self.field_of_view)
        self.angles.setflags(write=False)
        self._at, self._yaw = site or ("" if position is not None else "lidar"), float(yaw)

    @classmethod
    def lms200(cls, *, beams: int = 181, **options: Any) -> "Lidar":
        """SICK LMS200: 180 degrees, 181 or 361 beams, 8 m, 75 or 37.5 scans a second.

        Its mirror turns at 75 Hz and one turn has beams of 1 degree; 361 beams take two turns. Over
        the common 38.4 kBd line about 10 scans a second arrive: give ``rate=10``. Deviation 5 mm up
        to 8 m, mm mode (technical description; grade B). A scan is late by the time it takes, 13.3
        or 26.7 ms; the line's time is left out. Housing 156 x 155 x 210 mm; that beams leave from
        its middle is assumed.

        Raises:
            InvalidInputError: Another number of beams.
        """
        if beams not in (181, 361):
            raise InvalidInputError(f"an LMS200 has 181 or 361 beams; got {beams}")
        turns = 1 if beams == 181 else 2
        preset = {
            "rate": 75.0 / turns,
            "latency": turns / 75.0,
            "noise": 0.005,
            "housing": (0.156, 0.155, 0.210),
        }
        return cls(**(preset | {"beams": beams, "field_of_view": math.pi} | options))

    @classmethod
    def urg04lx(cls, **options: Any) -> "Lidar":
        """Hokuyo URG-04LX: 682 beams 360/1024 degrees apart, 0.02 to 4 m, 10 scans a second.

        Steps 44 to 725 of 1024, 600 turns a minute (SCIP 2.0 protocol, answer to PP; grade B).
        Stated accuracy 10 mm up to 1 m and 1 % beyond, taken as three deviations (grade C); for
        what surfaces add see Kneip and others, "Characterization of the compact Hokuyo URG-04LX 2D
        laser range scanner", ICRA 2009. Housing 50 x 50 x 70 mm; that beams leave from its middle,
        and that a scan is late by the 0.1 s it takes, is assumed.
        """
        preset = {
            "beams": 682,
            "field_of_view": 681 * 2 * math.pi / 1024,
            "max_range": 4.0,
            "min_range": 0.02,
            "rate": 10.0,
            "latency": 0.1,
            "noise": 0.010 / 3,
            "proportional_noise": 0.010 / 3,
            "housing": (0.05, 0.05, 0.07),
        }
        return cls(**(preset | options))

    @property
    def mount(self) -> Array:
        """Where the fan begins, (3,): x, y, yaw [m, m, rad] in the base's frame, robot at home."""
        if self._simulation is None:
            raise InvalidInputError("the lidar can be asked once its group is in a simulation")
        return self._simulation.rays.mounts(self._sites()[0])[0]

    def read(self) -> Array:
        """Newest scan delivered by now, shape (n, b) [m]; see the class for what is not finite.

        NaN throughout before the first delivery.
        """
        return super().read()

    def add_to(self, spec: "mujoco.MjSpec", prefixes: Sequence[str], key: str) -> None:
        """Add the optics as a site, and the housing, to each robot."""
        import mujoco

        robot = carrier_model(self)
        if self._place is None:
            body, place, quat = site_place(robot, self._at)
        else:
            body, place = robot.body(1).name, self._place
            quat = np.array([math.cos(self._yaw / 2), 0.0, 0.0, math.sin(self._yaw / 2)])
        if self._housing is not None:
            up = np.empty(3)
            mujoco.mju_rotVecQuat(up, np.array([0.0, 0.0, self._housing[2] / 2]), quat)
            place = place + up
        for prefix in prefixes:
            carrier = spec.body(f"{prefix}{body}")
            carrier.add_site(name=f"{prefix}{key}_optics", pos=place, quat=quat, group=3)
            if self._housing is not None:
                carrier.add_geom(
                    name=f"{prefix}{key}_housing",
                    type=mujoco.mjtGeom.mjGEOM_BOX,
                    pos=place,
                    quat=quat,
                    size=self._housing / 2,
                    rgba=[0.06, 0.12, 0.38, 1.0],
                    mass=0.0,
                    friction=[0.3, 0.005, 0.0001],
                    group=0,
                )

    def prepare(self, sequence: np.random.SeedSequence, group: "Group") -> None:
        """Set up the noise streams, and remember what the model calls the optics."""
        self._streams = self.errors.streams(sequence, (group.n, len(self.angles)))
        key = next(key for key, sensor in group.sensors.items() if sensor is self)
        self._optics = f"{key}_optics"
        self._found: NDArray[np.int64] | None = None
        assert self._simulation is not None
        rows = self._simulation.team.rows(group)
        self._rows = np.arange(rows.start, rows.stop)

    def observe(self, time: float) -> Any:
        """Where everything is now."""
        assert self._simulation is not None
        return self._simulation.visible_state()

    def compute(self, state: Any, number: int) -> Array:
        """Cast the beams, then spoil the ranges."""
        assert self._simulation is not None
        scene = self._simulation.rays
        scene.show(state)
        origins, frames = scene.frames(self._sites())
        ranges, hits, _ = scene.cast(
            origins, frames, self._rows, self.angles, self.max_range, self.method
        )
        scene.drop_dark(ranges, hits)
        return self.errors.apply(ranges, self._streams, number)

    def nothing(self) -> Array:
        """All NaN."""
        return np.full((self._group.n, len(self.angles)), np.nan)

    def _sites(self) -> NDArray[np.int64]:
        assert self._simulation is not None
        if self._found is None:
            self._found = self._simulation.rays.sites(self._group.prefixes, [self._optics])
        return self._found
