"""Where ray-based sensors are: sites of a robot's model, by name or by numbered array."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError, UnknownNameError

if TYPE_CHECKING:
    from mjmr.sensors.base import Sensor

Array = NDArray[np.float64]


def carrier_model(sensor: "Sensor") -> Any:
    """Compiled model of one robot that carries ``sensor``.

    Raises:
        InvalidInputError: None does.
    """
    if sensor.carrier is None:
        raise InvalidInputError(f"a {sensor.name} is mounted on robots: group.mount(...)")
    group = sensor.carrier
    return group.platform.model(group.first_number, group.team).compile()


def site_names(robot: Any) -> list[str]:
    """Names of the sites of a robot's model."""
    return [robot.site(k).name for k in range(robot.nsite)]


def site_place(robot: Any, name: str) -> tuple[str, Array, Array]:
    """Body that carries a site, and the site's position (3,) [m] and quaternion (4,) on it.

    Raises:
        UnknownNameError: There is no such site; lists those there are.
    """
    if name not in site_names(robot):
        raise UnknownNameError("site of the robot's model", name, site_names(robot))
    k = robot.site(name).id
    return robot.body(robot.site_bodyid[k]).name, robot.site_pos[k], robot.site_quat[k]


def numbered_sites(robot: Any, stem: str) -> tuple[str, ...]:
    """Sites called ``stem`` and a number, in the numbers' order.

    Raises:
        UnknownNameError: There is none; lists the stems there are.
    """
    names = site_names(robot)
    found = [n for n in names if n.startswith(stem) and n.removeprefix(stem).isdecimal()]
    if not found:
        stems = dict.fromkeys(n.rstrip("0123456789") for n in names if n[-1:].isdecimal())
        raise UnknownNameError("array of sites of the robot's model", stem, stems)
    return tuple(sorted(found, key=lambda n: int(n.removeprefix(stem))))
