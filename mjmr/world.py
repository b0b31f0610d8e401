"""World: floor, walls, props and robots, declared once and built into an MjSpec.

The declaration is what planners, meters and films read; the MjSpec is built from it when a
simulation or a film needs one, so that a kinematic run loads no MuJoCo.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.cart import Cart
from mjmr.disc import Disc
from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.finite import finite
from mjmr.group import Group
from mjmr.mark import Mark
from mjmr.materials import check_material
from mjmr.pillar import Pillar

if TYPE_CHECKING:
    import mujoco

    from mjmr.robots.platform import Platform
    from mjmr.sensors.base import Sensor
    from mjmr.sensors.camera import Camera

FLOORS = ("carpet", "concrete")
LIGHTINGS = ("even", "uneven")
_PROPS = ("box", "ball", "cart", "disc", "pillar")  # what named_props() calls them, before a number
_GROUP_NAME = re.compile(rf"(?!({'|'.join(_PROPS)})\d*$)[^/]+")


@dataclass(frozen=True, kw_only=True)
class Box:
    """A box that stands on the floor; fixed, or free to be pushed when it has a mass.

    Attributes:
        x: Centre [m], world frame.
        y: Centre [m], world frame.
        yaw: Heading of the length axis [rad].
        length: Along the length axis [m].
        width: Across it [m].
        height: [m].
        mass: [kg]; None for a fixed box.
        material: One of ``mjmr.materials.MATERIALS``; ``mirror`` and ``black`` return no light to
            lidars and infra-red rangers.
    """

    x: float
    y: float
    yaw: float = 0.0
    length: float
    width: float
    height: float = 0.3
    mass: float | None = None
    material: str = "plain"

    def __post_init__(self):
        check_material(self.material)
        if min(self.length, self.width, self.height) <= 0:
            raise InvalidInputError(
                f"a box needs a positive length, width and height; got "
                f"{self.length} x {self.width} x {self.height} m"
            )
        if self.mass is not None and self.mass <= 0:
            raise InvalidInputError(f"a box's mass must be positive or None; got {self.mass} kg")


@dataclass(frozen=True, kw_only=True)
class Ball:
    """A free ball at rest on the floor.

    Attributes:
        x: Centre [m], world frame.
        y: Centre [m], world frame.
        radius: [m].
        mass: [kg].
        shell: Whether all mass is in the surface; else it fills the ball.
        friction: Against whatever it touches: sliding, torsional [m], rolling [m].
        solref: MuJoCo's time constant [s] and damping ratio of its contacts. The time constant
            must be twice the timestep or more.
        rgba: Colour, 0 to 1.

    Raises:
        InvalidInputError: A number that is not positive, or negative friction.
    """

    x: float
    y: float
    radius: float
    mass: float
    shell: bool = False
    friction: tuple[float, float, float] = (0.5, 0.002, 0.0004)
    # stiffer than MuJoCo's default and underdamped: it bounces, and sinks in less
    solref: tuple[float, float] = (0.0085, 0.4)
    rgba: tuple[float, float, float, float] = (0.95, 0.4, 0.05, 1.0)

    def __post_init__(self):
        if not min(self.radius, self.mass, *self.solref) > 0:
            raise InvalidInputError(
                f"a ball needs a positive radius, mass and solref; got {self.radius} m, "
                f"{self.mass} kg and {self.solref}"
            )
        if len(self.friction) != 3 or not min(self.friction) >= 0:
            raise InvalidInputError(
                f"a ball's friction is three numbers, 0 or more (sliding, torsional, rolling); "
                f"got {self.friction}"
            )


class World:
    """A rectangular floor with a wall around it, and what stands on it.

    Attributes:
        bounds: Inner faces of the wall (4,) [m].
        field: Marked playing field (4,) [m], or None.
        props: Boxes, balls, carts, discs and pillars, in order of declaration.
        marks: Painted on the floor.
        groups: Robots, in order of declaration.
        sensors: Cameras and other sensors that stand in the world, by name.
        simulation: The one that has the robots now.
    """

    def __init__(
        self,
        *,
        bounds: ArrayLike,
        field: ArrayLike | None = None,
        wall_height: float = 0.1,
        floor: str = "carpet",
        lighting: str = "even",
        overlap: bool = False,
        wall_material: str = "plain",
    ):
        """Declare an empty world.

        Args:
            bounds: Inner faces of the wall ``(xmin, ymin, xmax, ymax)`` [m], world frame.
            field: Rectangle of a marked playing field, same form, or None.
            wall_height: [m]; lidars and rangers mounted higher look over it.
            floor: One of ``FLOORS``; carpet carries field lines when there is a field.
            lighting: One of ``LIGHTINGS``; uneven: a lamp near the lower left corner, which makes
                that side of the floor about twice as bright as the other.
            overlap: Whether robots may start inside each other, which contact then drives apart.
            wall_material: As a :class:`Box`'s material.

        Raises:
            InvalidInputError: Bounds without area.
            UnknownNameError: Unknown floor, lighting or material.
        """
        self.bounds = _rectangle(bounds, "bounds")
        self.field = None if field is None else _rectangle(field, "field")
        self.wall_height = float(wall_height)
        if not 0 < self.wall_height < np.inf:
            raise InvalidInputError(f"wall_height must be positive and finite; got {wall_height} m")
        if floor not in FLOORS:
            raise UnknownNameError("floor", floor, FLOORS)
        if lighting not in LIGHTINGS:
            raise UnknownNameError("lighting", lighting, LIGHTINGS)
        check_material(wall_material)
        self.floor, self.lighting, self.overlap = floor, lighting, overlap
        self.wall_material = wall_material
        self.props: list[Box | Ball | Cart | Disc | Pillar] = []
        self.groups: list[Group] = []
        self.sensors: dict[str, Sensor] = {}
        self.simulation: Any = None
        self.marks: list[Mark] = []
        self._edits: list[Callable[[Any], None]] = []

    @classmethod
    def rectangle(
        cls, length: float, width: float, *, border: float = 0.0, **options: Any
    ) -> "World":
        """World centred on the origin: a field of length x width [m] and a border [m] around it."""
        half = np.array([length, width]) / 2.0
        outer = half + border
        field = np.concatenate([-half, half]) if border > 0 else None
        return cls(bounds=np.concatenate([-outer, outer]), field=field, **options)

    def add_box(self, x: float, y: float, length: float, width: float, **options: Any) -> Box:
        """Stand a box on the floor; see :class:`Box` for the options."""
        box = Box(x=x, y=y, length=length, width=width, **options)
        self.props.append(box)
        return box

    def add_wall(
        self, start: ArrayLike, end: ArrayLike, *, thickness: float = 0.1, **options: Any
    ) -> Box:
        """Stand a fixed box along the line between two points (2,) [m], as long as the line.

        Args:
            start: World frame.
            end: World frame.
            thickness: Across the line, half of it to each side [m].
            options: ``height`` and ``material``; see :class:`Box`.

        Raises:
            InvalidInputError: Start and end are one point or none, or an option is out of range.
        """
        if not 0 < thickness < np.inf:
            raise InvalidInputError(
                f"a wall's thickness must be positive and finite; got {thickness} m"
            )
        (x0, y0), (x1, y1) = _point(start, "a wall's start"), _point(end, "a wall's end")
        length = float(np.hypot(x1 - x0, y1 - y0))
        yaw = float(np.arctan2(y1 - y0, x1 - x0))
        return self.add_box((x0 + x1) / 2, (y0 + y1) / 2, length, thickness, yaw=yaw, **options)

    def add_mark(self, x: float, y: float, **options: Any) -> Mark:
        """Paint a disc or rectangle on the floor; see :class:`mjmr.mark.Mark` for the options.

        Raises:
            InvalidInputError: Its centre is outside the walls, or a mark cannot be so.
        """
        mark = Mark(x=x, y=y, **options)
        xmin, ymin, xmax, ymax = self.bounds
        if not (xmin <= x <= xmax and ymin <= y <= ymax):
            raise InvalidInputError(
                f"a mark's centre must lie within the walls, x {xmin:g} to {xmax:g} and y {ymin:g} "
                f"to {ymax:g} m; got ({x:g}, {y:g})"
            )
        self.marks.append(mark)
        return mark

    def add_golf_ball(self, x: float, y: float) -> Ball:
        """Lay the small size league's ball (a golf ball, 42.7 mm, 46 g) on the floor."""
        ball = Ball(x=x, y=y, radius=0.02135, mass=0.046)
        self.props.append(ball)
        return ball

    def add_ball(self, x: float, y: float, **options: Any) -> Ball:
        """Lay a ball on the floor: by default the Four-Legged League's, of thin plastic.

        It is 85 mm wide, has 50 g, and rolls some 3 m from 1 m/s; see
        assets/aibo_ers7/README.md for where that comes from and :class:`Ball` for the options.
        """
        league: dict[str, Any] = {
            "radius": 0.0425,
            "mass": 0.05,
            "shell": True,
            "friction": (0.5, 0.005, 0.0012),
            "solref": (0.02, 0.7),
        }
        ball = Ball(x=x, y=y, **(league | options))
        self.props.append(ball)
        return ball

    def add_cart(self, x: float, y: float, length: float, width: float, **options: Any) -> Cart:
        """Put a box on a rail that goes to and fro; see :class:`mjmr.cart.Cart` for the options."""
        cart = Cart(x=x, y=y, length=length, width=width, **options)
        self.props.append(cart)
        return cart

    def add_disc(
        self, x: float, y: float, radius: float, friction_force: float, **options: Any
    ) -> Disc:
        """Lay a disc on the floor that slides; see :class:`mjmr.disc.Disc` for the options."""
        disc = Disc(x=x, y=y, radius=radius, friction_force=friction_force, **options)
        self._check_disc(disc)
        self.props.append(disc)
        return disc

    def add_pillar(self, x: float, y: float, radius: float, **options: Any) -> Pillar:
        """Stand an upright cylinder that may grow; see :class:`mjmr.pillar.Pillar` for the options.

        Raises:
            InvalidInputError: It is not within the walls, or will not be when it has grown.
        """
        pillar = Pillar(x=x, y=y, radius=radius, **options)
        low, high = self.bounds[:2] + pillar.largest, self.bounds[2:] - pillar.largest
        if not (low[0] <= x <= high[0] and low[1] <= y <= high[1]):
            (x0, y0), (x1, y1) = self.bounds[:2], self.bounds[2:]
            raise InvalidInputError(
                f"a pillar of up to {pillar.largest:g} m radius at ({x:g}, {y:g}) does not fit "
                f"between the walls, which enclose x {x0:g} to {x1:g} and y {y0:g} to {y1:g} m"
            )
        self.props.append(pillar)
        return pillar

    def add_group(
        self, platform: "type[Platform] | Platform", poses: ArrayLike, **options: Any
    ) -> Group:
        """Add robots of one platform.

        Args:
            platform: A platform class, or an instance with options of its own.
            poses: Start poses, shape (n, 3): x, y, yaw [m, m, rad], world frame.
            options: See :class:`mjmr.group.Group`.

        Raises:
            InvalidInputError: Poses of another shape, not finite or outside the walls, or robots
                that would be called like others or like props.
        """
        instance = platform() if isinstance(platform, type) else platform
        taken = sum(g.platform.name == instance.name for g in self.groups)
        options.setdefault("name", instance.name if not taken else f"{instance.name}_{taken}_")
        group = Group(instance, poses, **options)
        self._check_inside(group)
        group.check_site(self)
        if any(g.name == group.name for g in self.groups):
            raise InvalidInputError(f"there is a group named {group.name!r} already")
        if not _GROUP_NAME.fullmatch(group.name):
            raise InvalidInputError(
                f"a group's name has no slash and is none of {', '.join(_PROPS)}, which props are "
                f"called, with or without a number; got {group.name!r}"
            )
        shared = {name for g in self.groups for name in g.names}.intersection(group.names)
        if shared:
            raise InvalidInputError(
                f"there are robots named {', '.join(sorted(shared))} already; give the group "
                f"{group.name!r} another name"
            )
        self.groups.append(group)
        return group

    def start_at(self, poses: Mapping[str, ArrayLike]) -> None:
        """Let groups start elsewhere in the next simulation.

        Args:
            poses: Start poses (n, 3) by the groups' names, world frame.

        Raises:
            UnknownNameError: No such group; lists those there are.
            InvalidInputError: Poses of another shape, not finite or outside the walls. Then all
                groups start where they did.
        """
        groups = {group.name: group for group in self.groups}
        before = [(group, group.start) for group in self.groups]
        try:
            for name, start in poses.items():
                if name not in groups:
                    raise UnknownNameError("group", name, groups)
                groups[name].start_at(start)
                self._check_inside(groups[name])
        except InvalidInputError:
            for group, start in before:
                group.start = start
            raise

    def add_camera(
        self,
        camera: "Camera",
        *,
        position: ArrayLike,
        look_at: ArrayLike | None = None,
        quaternion: ArrayLike | None = None,
        name: str = "camera",
    ) -> "Camera":
        """Stand a camera in the world; it is sampled like the robots' sensors.

        Args:
            camera: Not mounted elsewhere.
            position: (3,) [m], world frame.
            look_at: A point it looks at (3,) [m]; up in the image is up, or +y straight down.
            quaternion: Its orientation (w, x, y, z) instead, MuJoCo's convention: it looks along
                its -z, +y is up in the image.
            name: Of the camera.

        Returns:
            The camera.

        Raises:
            InvalidInputError: The name is taken, or the camera or its pose cannot be used.
        """
        self._check_free(name)
        camera.stand(position, look_at, quaternion)
        return self.mount(camera, name)

    def mount(self, sensor: Any, name: str | None = None) -> Any:
        """Let a sensor stand in the world; it is sampled like the robots' sensors.

        Args:
            sensor: Not mounted elsewhere.
            name: Default: the sensor's own name.

        Returns:
            The sensor.

        Raises:
            InvalidInputError: The name is taken, or the sensor is mounted already or needs a robot
                that carries it.
        """
        key = name or sensor.name
        self._check_free(key)
        if not sensor.stands:
            raise InvalidInputError(f"a {sensor.name} is mounted on robots: group.mount(...)")
        if sensor.carrier is not None or sensor in self.sensors.values():
            raise InvalidInputError(f"this {sensor.name} is mounted already; make another one")
        self.sensors[key] = sensor
        return sensor

    def edit(self, change: "Callable[[mujoco.MjSpec], None]") -> None:
        """Register a change to the MjSpec, applied at the end of every build."""
        self._edits.append(change)

    @property
    def boxes(self) -> NDArray[np.float64]:
        """Fixed boxes, shape (k, 5): x, y, yaw, half length, half width [m, m, rad, m, m]."""
        rows = [
            (b.x, b.y, b.yaw, b.length / 2, b.width / 2)
            for b in self.props
            if isinstance(b, Box) and b.mass is None
        ]
        return np.array(rows, dtype=np.float64).reshape(-1, 5)

    @property
    def movers(self) -> Sequence[tuple[str, Box | Ball | Disc]]:
        """Props that can be moved, with their body names in the built model."""
        return [
            (name, prop)
            for name, prop in self.named_props()
            if isinstance(prop, Ball | Disc) or (isinstance(prop, Box) and prop.mass is not None)
        ]

    @property
    def carts(self) -> Sequence[tuple[str, Cart]]:
        """Boxes that go to and fro by themselves, with their names in the built model."""
        return [(name, prop) for name, prop in self.named_props() if isinstance(prop, Cart)]

    def named_props(self) -> Sequence[tuple[str, Box | Ball | Cart | Disc | Pillar]]:
        """Props with their names in the built model."""
        return [(f"{type(p).__name__.lower()}{i}", p) for i, p in enumerate(self.props)]

    def spec(self) -> "mujoco.MjSpec":
        """Build the MjSpec of this world; each call builds a new one."""
        from mjmr.world_spec import build_spec

        spec = build_spec(self)
        for change in self._edits:
            change(spec)
        return spec

    def to_xml(self, timestep: float = 1 / 240) -> str:
        """MJCF text of this world, which MuJoCo's own viewer opens.

        Its keyframe ``start`` has the robots where they start; timestep and force limits are those
        of a :class:`mjmr.simulation.Simulation` with this timestep.

        Args:
            timestep: Of the physics [s].
        """
        from mjmr.world_spec import export_xml

        return export_xml(self, timestep)

    def _check_free(self, name: str) -> None:
        if name in self.sensors:
            raise InvalidInputError(f"there is a sensor named {name!r} in this world already")

    def _check_disc(self, disc: Disc) -> None:
        low, high = self.bounds[:2] + disc.radius, self.bounds[2:] - disc.radius
        if not (low[0] <= disc.x <= high[0] and low[1] <= disc.y <= high[1]):
            raise InvalidInputError(
                f"a disc of radius {disc.radius:g} m at ({disc.x:g}, {disc.y:g}) is outside the "
                f"walls or in them; its centre must lie within x {low[0]:g} to {high[0]:g} and y "
                f"{low[1]:g} to {high[1]:g} m"
            )

    def check_inside(
        self, group: Group, rows: ArrayLike, poses: ArrayLike, what: str = "start"
    ) -> None:
        """Refuse places of robots of a group that are not within the walls.

        Args:
            group: Whose robots.
            rows: Their indices in the group (k,).
            poses: Where they are to be (k, 3), world frame.
            what: They do there, for the message.

        Raises:
            InvalidInputError: Says who would be outside, and by how much.
        """
        r, where = group.platform.radius, np.asarray(poses)[:, :2]
        low, high = self.bounds[:2] + r, self.bounds[2:] - r
        beyond = np.maximum(low - where, where - high).max(axis=1)
        if (beyond > 0).any():
            names = ", ".join(
                f"{group.names[row]} by {1e3 * off:.0f} mm"
                for row, off in zip(np.asarray(rows), beyond, strict=True)
                if off > 0
            )
            raise InvalidInputError(
                f"these robots {what} outside the walls or touch them: {names}; centres must lie "
                f"within x {low[0]:g} to {high[0]:g} and y {low[1]:g} to {high[1]:g} m"
            )

    def _check_inside(self, group: Group) -> None:
        self.check_inside(group, range(group.n), group.start)


def _point(values: ArrayLike, name: str) -> NDArray[np.float64]:
    point = finite(values, (2,))
    if point is None:
        raise InvalidInputError(f"{name} must be two finite numbers (x, y); got {values}")
    return point


def _rectangle(values: ArrayLike, name: str) -> NDArray[np.float64]:
    rectangle = finite(values, (4,))
    if rectangle is None:
        raise InvalidInputError(f"{name} must be four finite numbers (xmin, ymin, xmax, ymax)")
    if (rectangle[2:] <= rectangle[:2]).any():
        raise InvalidInputError(f"{name} must have xmin < xmax and ymin < ymax; got {values}")
    rectangle.setflags(write=False)
    return rectangle
