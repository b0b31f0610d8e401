"""What sensors share that read MuJoCo's own sensors at a site of every robot."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.finite import finite
from mjmr.sensors.base import Sensor, carrier_body, physics_of

if TYPE_CHECKING:
    import mujoco

    from mjmr.group import Group

Array = NDArray[np.float64]


class SiteSensor(Sensor):
    """Two 3-vectors MuJoCo measures in the frame of a site, on every robot.

    A sample is what the last physics step before its instant measured, unfiltered: up to a timestep
    old, and with the ripple of contacts.
    """

    kinds: tuple[str, str]  # names of mujoco.mjtSensor without the prefix

    def _place(self, site: str, body: str, position: ArrayLike) -> None:
        """Say where: a site of the robot's model, or a place on one of its bodies."""
        where = finite(position, (3,))
        if where is None:
            raise InvalidInputError(f"a {self.name}'s position has three finite numbers")
        if site and (body or where.any()):
            raise InvalidInputError(
                f"the model's site {site!r} has a body and place of its own; give its name alone"
            )
        self._site, self._body, self._position = site, body, where

    def add_to(self, spec: "mujoco.MjSpec", prefixes: Sequence[str], key: str) -> None:
        """Add the site, unless the model has the one named, and MuJoCo's sensors.

        Raises:
            UnknownNameError: The model has no such site or body.
            InvalidInputError: It has a site of the sensor's name.
        """
        import mujoco

        for prefix in prefixes:
            if self._site:
                own = [s.name for s in spec.sites if s.name.startswith(prefix)]
                name = f"{prefix}{self._site}"
                if name not in own:
                    valid = [s.removeprefix(prefix) for s in own]
                    raise UnknownNameError("site of the robot's model", self._site, valid)
            else:
                name = f"{prefix}{key}"
                if any(s.name == name for s in spec.sites):
                    raise InvalidInputError(
                        f"the robot's model has a site {key!r} of its own: mount the {self.name} "
                        f"there (site={key!r}) or under another name"
                    )
                body = carrier_body(spec, prefix, self._body)
                body.add_site(name=name, pos=self._position, group=3)
            for kind in self.kinds:
                spec.add_sensor(
                    name=f"{prefix}{key}_{kind.lower()}",
                    type=getattr(mujoco.mjtSensor, f"mjSENS_{kind}"),
                    objtype=mujoco.mjtObj.mjOBJ_SITE,
                    objname=name,
                )

    def prepare(self, sequence: np.random.SeedSequence, group: "Group") -> None:
        """Look the sensors' places in ``sensordata`` up."""
        simulation = physics_of(self, group)
        self._data: Any = simulation.data
        key = next(key for key, sensor in group.sensors.items() if sensor is self)
        names = [[f"{p}{key}_{kind.lower()}" for kind in self.kinds] for p in group.prefixes]
        first = np.array([[simulation.model.sensor(s).adr[0] for s in row] for row in names])
        self._columns = (first[:, :, None] + np.arange(3)).reshape(group.n, 6)

    def observe(self, time: float) -> Any:
        """What MuJoCo measured in the last physics step (n, 6)."""
        return self._data.sensordata[self._columns]

    def nothing(self) -> Array:
        """All NaN."""
        return np.full((self._group.n, 6), np.nan)
