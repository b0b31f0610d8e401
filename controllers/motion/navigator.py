"""The navigation of a group: plan, motion control and safety search in one call a cycle.

Source: Bruce and Veloso 2005. One compiled call steps all robots.
"""

import dataclasses
import math
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from controllers.motion.clearance import Scene, check_bounds, prepare_boxes
from controllers.motion.errt import ErrtConfig, make_forest, plan
from controllers.motion.plane import along_velocity, synchronised_velocity
from controllers.motion.safety import braking_command, choose_commands, make_search
from controllers.motion.streams import seed_streams
from controllers.motion.trapezoid import Dynamics, Limits
from mjmr.errors import InvalidInputError
from mjmr.jit import njit


@dataclasses.dataclass(frozen=True, kw_only=True)
class NavigatorConfig:
    """Parameters of :class:`Navigator`; defaults are the paper's robot where it gives a number.

    Attributes:
        radius: Radius of every robot [m].
        limits: Bounds of speed and acceleration.
        period: Command period [s].
        margin: Added to the radius in the safety search [m].
        search: Whether the safety search is on; off commands what motion control wants.
        samples: Random accelerations tried by the search.
        planner: ``errt``, or ``straight`` to head for the goal whatever is in the way.
        plan_around_robots: Whether the planner sees the other robots as discs.
        box_clearance: Space the planner keeps between body and boxes [m].
        robot_clearance: Space the planner keeps between two bodies [m].
        goal_probability: Planner's p.
        waypoint_probability: Planner's q.
        cache_size: Waypoints the planner keeps a robot.
        max_nodes: Most growth attempts of one plan.
        motion: ``paper`` (along and across) or ``bisection`` (an ablation, not in the paper).
        fail_safe: Search also stays clear of robots that brake instead of obeying; not in the
            paper.
        strangers: Robots, by index, that do not take part: never commanded, expected to keep
            their velocity for ``foresight`` and to brake then; not in the paper.
        foresight: See ``strangers`` [s]; boxes that move are expected to go on for as long.

    Raises:
        InvalidInputError: A value is outside its range.
    """

    radius: float = 0.09
    limits: Limits = Limits()
    period: float = 1.0 / 60.0
    margin: float = 0.0
    search: bool = True
    samples: int = 50
    planner: Literal["errt", "straight"] = "errt"
    plan_around_robots: bool = True
    box_clearance: float = 0.015
    robot_clearance: float = 0.03
    goal_probability: float = 0.1
    waypoint_probability: float = 0.6
    cache_size: int = 200
    max_nodes: int = 2000
    motion: Literal["paper", "bisection"] = "paper"
    fail_safe: bool = False
    strangers: tuple[int, ...] = ()
    foresight: float = 0.35

    def __post_init__(self) -> None:
        for name in ("radius", "period", "foresight"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise InvalidInputError(f"{name} is {value}; it must be positive and finite")
        if not (math.isfinite(self.margin) and self.margin >= 0.0):
            raise InvalidInputError(f"margin is {self.margin} m; it must be finite and at least 0")
        if self.samples < 0:
            raise InvalidInputError(f"samples is {self.samples}; it must be at least 0")
        for name, allowed in (
            ("planner", ("errt", "straight")),
            ("motion", ("paper", "bisection")),
        ):
            if getattr(self, name) not in allowed:
                raise InvalidInputError(
                    f"{name} is {getattr(self, name)!r}; it must be one of {', '.join(allowed)}"
                )
        self.errt()

    def errt(self) -> ErrtConfig:
        """The planner's part of the parameters."""
        return ErrtConfig(
            goal_probability=self.goal_probability,
            waypoint_probability=self.waypoint_probability,
            cache_size=self.cache_size,
            max_nodes=self.max_nodes,
            box_clearance=self.box_clearance,
            disc_clearance=self.robot_clearance,
        )


class Output(NamedTuple):
    """What a step leaves beside the command; see :class:`Navigator`."""

    waypoints: NDArray[np.float64]
    desired: NDArray[np.float64]
    sampled: NDArray[np.bool_]
    plan_nodes: NDArray[np.int64]


class Navigator:
    """Drives n robots to their goals, one :meth:`step` a command period.

    Args:
        bounds: Shape (4,): xmin, ymin, xmax, ymax [m], world frame, that bodies stay within.
        boxes: Shape (k, 5): x, y, yaw, half-length, half-width [m, rad]; None for none. They may
            overlap each other and the bounds.
        n: Robots.
        config: Parameters.
        rng: Seeds the streams of each robot's planner and search, once; nothing else is random.

    Attributes:
        waypoints: Shape (n, 2) [m], world frame, points steered for in the last step.
        desired: Shape (n, 2) [m/s], world frame, what motion control wanted.
        sampled: Shape (n,) bool, robots whose desired command was not clear.
        plan_nodes: Shape (n,) int, nodes of each robot's tree; 0 for a free straight line.

    The attributes are read-only views of what the last step wrote; copy what is to be kept.

    Raises:
        InvalidInputError: An argument is not acceptable.
    """

    def __init__(
        self,
        bounds: ArrayLike,
        boxes: ArrayLike | None,
        n: int,
        config: NavigatorConfig,
        rng: np.random.Generator,
    ):
        if n < 1:
            raise InvalidInputError(f"n is {n}; there must be at least one robot")
        self.config = config
        self._n = n
        stranger = np.zeros(n, dtype=np.bool_)
        for index in config.strangers:
            if not 0 <= index < n:
                raise InvalidInputError(f"strangers names robot {index}; valid: 0 to {n - 1}")
            stranger[index] = True
        c, limits = config, config.limits
        waypoints, desired = np.zeros((n, 2)), np.zeros((n, 2))
        sampled, plan_nodes = np.zeros(n, dtype=np.bool_), np.zeros(n, dtype=np.int64)
        self.waypoints = _read_only(waypoints)
        self.desired = _read_only(desired)
        self.sampled = _read_only(sampled)
        self.plan_nodes = _read_only(plan_nodes)
        self._out = Output(waypoints, desired, sampled, plan_nodes)
        self._everyone = ~stranger
        streams = seed_streams(rng, 2 * n)
        sides, obstacles = check_bounds(bounds, c.radius), prepare_boxes(boxes)
        self._dynamics = Dynamics(
            *(float(x) for x in (limits.max_speed, limits.acceleration, limits.deceleration)),
            T=float(c.period),
        )
        self._scene = Scene(
            sides,
            float(c.radius),
            obstacles,
            float(c.radius + c.box_clearance),
            np.zeros((n, 3)),
            float(c.radius + c.robot_clearance),
        )
        self._scene.discs[:, 2] = c.radius
        self._forest = make_forest(n, c.errt(), streams)
        self._search = make_search(
            sides, obstacles, c.radius + c.margin, c.fail_safe, c.samples, stranger, c.foresight,
            streams, n,
        )  # fmt: skip
        self._obstacles = obstacles
        self._direction = np.zeros((n, 2))
        # Plan, plan around robots, the paper's motion control, search: True or False each.
        self._parts = (
            c.planner == "errt",
            bool(c.plan_around_robots),
            c.motion == "paper",
            bool(c.search),
        )

    def step(
        self,
        position: ArrayLike,
        velocity: ArrayLike,
        goals: ArrayLike,
        active: ArrayLike | None = None,
    ) -> NDArray[np.float64]:
        """Commands for the coming period.

        Args:
            position: Shape (n, 2) [m], world frame, as reported.
            velocity: Shape (n, 2) [m/s], world frame.
            goals: Shape (n, 2) [m], world frame.
            active: Shape (n,) bool, robots under control; None for all. One that is not is
                taken to brake, gets braking as its command, and stays an obstacle to the others.

        Returns:
            Command, shape (n, 2) [m/s], world frame, to be reached at the end of the period.

        Raises:
            InvalidInputError: A shape is wrong or a number is not finite; nothing has changed.
        """
        x = self._checked("position", position)
        v = self._checked("velocity", velocity)
        g = self._checked("goals", goals)
        on = self._everyone if active is None else np.ascontiguousarray(active)
        if on.shape != (self._n,) or on.dtype != np.bool_:
            raise InvalidInputError(
                f"active has shape {on.shape} and type {on.dtype}; it must be ({self._n},) bool"
            )
        if self.config.strangers:
            on = on & self._everyone
        command = np.empty((self._n, 2))
        bad = _step(
            x,
            v,
            g,
            on,
            self._parts,
            self._dynamics,
            self._scene,
            self._forest,
            self._search,
            self._direction,
            self._out,
            command,
        )
        if bad >= 0:
            which, robot = divmod(bad, self._n)
            name, value = (("position", x), ("velocity", v), ("goals", g))[which]
            raise InvalidInputError(
                f"{name} of robot {robot} is {value[robot].tolist()}; it must be finite"
            )
        return command

    def see_boxes(self, boxes: ArrayLike, velocity: ArrayLike) -> None:
        """Take in where the boxes are and how they move; they are expected to go on like that.

        Args:
            boxes: As many as the navigator was made with, shape (k, 5): x, y, yaw, half-length,
                half-width [m, rad].
            velocity: Shape (k, 2) [m/s], world frame.

        Raises:
            InvalidInputError: Another number of boxes, one that is no box, or velocities of
                another shape or not finite.
        """
        rows, drift = prepare_boxes(boxes), np.asarray(velocity, dtype=np.float64)
        if rows.shape != self._obstacles.shape:
            raise InvalidInputError(
                f"boxes has {len(rows)} rows; the navigator was made with {len(self._obstacles)}"
            )
        if drift.shape != (len(rows), 2) or not np.isfinite(drift).all():
            raise InvalidInputError(f"velocity must be ({len(rows)}, 2) and finite")
        self._obstacles[:] = rows
        self._search.drift[:] = drift

    def _checked(self, name: str, value: ArrayLike) -> NDArray[np.float64]:
        a = np.array(value, dtype=np.float64, order="C")  # compiled for arrays of its own
        if a.shape != (self._n, 2):
            raise InvalidInputError(f"{name} has shape {a.shape}; it must be ({self._n}, 2)")
        return a


def _read_only(a: NDArray) -> NDArray:
    view = a.view()
    view.flags.writeable = False
    return view


@njit
def _first_bad(arrays):
    """Index over (array, robot) of the first number that is not finite, or -1."""
    at = 0
    for a in arrays:
        for i in range(a.shape[0]):
            if not (math.isfinite(a[i, 0]) and math.isfinite(a[i, 1])):
                return at
            at += 1
    return -1


@njit
def _step(
    position,
    velocity,
    goals,
    active,
    parts,
    dynamics,
    scene,
    forest,
    search,
    direction,
    out,
    command,
):
    """All robots' cycle; the arguments are those of :class:`Navigator`.

    Returns:
        -1, or the index over (array, robot) of a number that is not finite.
    """
    bad = _first_bad((position, velocity, goals))
    if bad >= 0:
        return bad
    planning, around_robots, along_and_across, searching = parts
    V, A, B, T = dynamics
    n = position.shape[0]
    for i in range(n):
        scene.discs[i, 0] = position[i, 0]
        scene.discs[i, 1] = position[i, 1]
    seen = Scene(
        scene.bounds,
        scene.radius,
        scene.boxes,
        scene.box_clearance,
        scene.discs if around_robots else scene.discs[:0],
        scene.disc_clearance,
    )
    for i in range(n):
        px = position[i, 0]
        py = position[i, 1]
        vx = velocity[i, 0]
        vy = velocity[i, 1]
        gx = goals[i, 0]
        gy = goals[i, 1]
        nodes = 0
        if not active[i]:
            gx = px
            gy = py
            wx, wy = braking_command(vx, vy, B, T)
        else:
            if planning:
                gx, gy, _, nodes, _ = plan(px, py, gx, gy, seen, i, forest, i)
            if along_and_across:
                wx, wy = along_velocity(px, py, vx, vy, gx, gy, direction[i], V, A, B, T)
            else:
                wx, wy = synchronised_velocity(gx - px, gy - py, vx, vy, V, A, B, T)
        out.plan_nodes[i] = nodes
        out.waypoints[i, 0] = gx
        out.waypoints[i, 1] = gy
        out.desired[i, 0] = wx
        out.desired[i, 1] = wy
        out.sampled[i] = False
        command[i, 0] = wx
        command[i, 1] = wy
    if searching:
        choose_commands(
            position, velocity, out.desired, active, dynamics, search, command, out.sampled
        )
    return -1
