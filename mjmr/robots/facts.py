"""What there is to know about a platform: from the platform, its compiled model and its README."""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from mjmr.assets import asset_folder
from mjmr.robots.platform import Array, Platform
from mjmr.simulation import Simulation
from mjmr.world import World

if TYPE_CHECKING:
    import mujoco

_PAINTED = ("top", "back")  # sites that carry team colour and number, not instruments


@dataclass(frozen=True, kw_only=True)
class Facts:
    """A platform in numbers.

    Attributes:
        platform: The platform.
        size: Length, width, height (3,) [m] of its collision geometry, at rest; the height from the
            floor if it stands there.
        mass: Of all that moves [kg].
        sites: Names of the sites of its model that can carry a sensor.
        cameras: Names of the cameras of its model.
    """

    platform: Platform
    size: Array
    mass: float
    sites: tuple[str, ...]
    cameras: tuple[str, ...]


def stage(platform: Platform, world: World | None = None) -> Simulation:
    """A simulation of one robot at the origin, heading along x, at rest for half a second.

    Args:
        platform: Of the robot.
        world: To put it into; by default an empty floor.
    """
    if world is None:
        half = needed(platform)
        world = World(bounds=[-half, -half, half, half])
    world.add_group(platform, [[0.0, 0.0, 0.0]])
    simulation = Simulation(world, control_period=0.1, dt_max=0.002)
    for _ in simulation.ticks(0.5):
        pass
    return simulation


def needed(platform: Platform) -> float:
    """How far from the origin a floor has to reach for a robot put there [m].

    That is 1 m more than its model does, with what of it is fixed to the world.
    """
    import mujoco

    model = platform.model(0, "yellow").compile()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    ends = np.abs(data.geom_xpos[:, :2]) + model.geom_rbound[:, None]
    return 1.0 + max(platform.radius, float(ends.max()))


def facts(simulation: Simulation) -> Facts:
    """Measure the first robot of a simulation made by :func:`stage`."""
    import mujoco

    group = simulation.world.groups[0]
    model, prefix = simulation.model, group.prefixes[0]
    low, high = box_around(simulation, seen=False)
    if low[2] < 0.02:
        low[2] = 0.0
    led = model.wrap_objid[model.wrap_type == mujoco.mjtWrap.mjWRAP_SITE]  # tendons go there
    sites = [model.site(k).name.removeprefix(prefix) for k in range(model.nsite) if k not in led]
    cameras = [model.camera(k).name for k in range(model.ncam)]
    return Facts(
        platform=group.platform,
        size=high - low,
        mass=float(model.body_mass[_moving(model, prefix)].sum()),
        sites=tuple(s for s in sites if s and s not in _PAINTED),
        cameras=tuple(c.removeprefix(prefix) for c in cameras if c.startswith(prefix)),
    )


def box_around(simulation: Simulation, seen: bool) -> tuple[Array, Array]:
    """Corners (3,), (3,) [m] of the upright box around the first robot, world frame.

    Args:
        simulation: Of :func:`stage`.
        seen: Around what is drawn too; else around the collision geometry.
    """
    model, data = simulation.model, simulation.data
    own = _moving(model, simulation.world.groups[0].prefixes[0])[model.geom_bodyid]
    group = model.geom_group
    touches = (model.geom_contype | model.geom_conaffinity) > 0
    own &= (group < 2) if seen else (group == 0) & touches
    reach = np.array([_reach(model, data, k) for k in np.flatnonzero(own)])
    centres = data.geom_xpos[own]
    return (centres - reach).min(axis=0), (centres + reach).max(axis=0)


def collapse(names: Iterable[str]) -> str:
    """Names separated by commas, those that differ by a number alone as one: ``sonar0-15``."""
    stems: dict[str, list[int]] = {}
    for name in names:
        found = re.fullmatch(r"(.*?)(\d+)?", name)
        stem, number = found.groups() if found else (name, None)
        stems.setdefault(stem, []).extend([] if number is None else [int(number)])
    told = []
    for stem, numbers in stems.items():
        if len(numbers) > 1:
            told.append(f"{stem}{min(numbers)}-{max(numbers)}")
        else:
            told.append(stem + "".join(map(str, numbers)))
    return ", ".join(told)


def number_tables(robot: str) -> list[tuple[str, list[list[str]]]]:
    """Tables of the README beside a robot's model whose first column is ``number``.

    Returns:
        For each the heading it stands under and its rows, the header first; none without a README.
    """
    path = asset_folder() / robot / "README.md"
    if not path.is_file():
        return []
    tables: list[tuple[str, list[list[str]]]] = []
    heading, inside = "", False
    for line in path.read_text().splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if line.startswith("#"):
            heading = line.lstrip("# ")
        if not line.startswith("|"):
            inside = False
        elif inside:
            if not set(line) <= set("|-: "):
                tables[-1][1].append(cells)
        elif cells[0] == "number":
            inside = True
            tables.append((heading.replace("`", ""), [cells]))
    return tables


def _moving(model: "mujoco.MjModel", prefix: str) -> Any:
    """Which bodies of the model (nbody,) belong to the robot and are not fixed to the world."""
    own = [model.body(k).name.startswith(prefix) for k in range(model.nbody)]
    return np.array(own) & (model.body_weldid > 0)


def _reach(model: "mujoco.MjModel", data: "mujoco.MjData", geom: Any) -> Array:
    """Half of the extents (3,) [m] of a geom along the axes of the world."""
    import mujoco

    kinds = mujoco.mjtGeom
    kind, size = kinds(int(model.geom_type[geom])), model.geom_size[geom]
    turned = data.geom_xmat[geom].reshape(3, 3)
    if kind in (kinds.mjGEOM_SPHERE, kinds.mjGEOM_CAPSULE):
        along = size[1] if kind == kinds.mjGEOM_CAPSULE else 0.0
        return size[0] + along * np.abs(turned[:, 2])
    if kind == kinds.mjGEOM_ELLIPSOID:
        return np.sqrt((turned * size) ** 2 @ np.ones(3))
    if kind == kinds.mjGEOM_CYLINDER:
        axis = np.abs(turned[:, 2])
        return size[1] * axis + size[0] * np.sqrt(np.maximum(0.0, 1.0 - axis**2))
    return np.abs(turned) @ model.geom_aabb[geom, 3:]
