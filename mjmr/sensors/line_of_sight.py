"""Lines of sight between robots, and from robots to points."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError
from mjmr.sensors.base import Sensor

if TYPE_CHECKING:
    from mjmr.loop import TickedSimulation
    from mjmr.sensors.ray_scene import RayScene

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]


def clear_lines(
    from_points: ArrayLike,
    to_points: ArrayLike,
    scene: "RayScene",
    *,
    from_robots: ArrayLike | None = None,
    to_robots: ArrayLike | None = None,
) -> Bools:
    """Whether nothing is between points, in the state that ``scene`` shows.

    Args:
        from_points: (a, 3) [m], world frame.
        to_points: (b, 3) [m], world frame.
        scene: ``simulation.rays``, after ``scene.show(simulation.visible_state())`` or a state
            captured earlier.
        from_robots: Robot that each point is on (a,), index in the team, -1 for none; no robot is
            in the way of a line that begins or ends on it. Default: none.
        to_robots: The same (b,).

    Returns:
        Shape (a, b).

    Raises:
        InvalidInputError: Another shape, or a point that is not finite.
    """
    starts, ends = _points(from_points), _points(to_points)
    return scene.clear(
        starts, ends, _robots(from_robots, len(starts)), _robots(to_robots, len(ends))
    )


def line_of_sight(
    simulation: "TickedSimulation", *, height: float | None = None, state: Any = None
) -> Bools:
    """Which robots of the team see each other, shape (n, n), symmetric, each sees itself.

    It is truth: for sensors, the radio, metrics and films, not for controllers.

    Args:
        simulation: Whose team.
        height: Of the ends of the lines above the robots' origins [m], along their own upward axis;
            default: half of each platform's height.
        state: Of ``simulation.visible_state()`` at an earlier instant; default: now.
    """
    scene = simulation.rays
    scene.show(simulation.visible_state() if state is None else state)
    points = robot_points(simulation, height)
    robots = np.arange(len(points))
    return scene.clear(points, points, robots, robots)


def robot_points(simulation: "TickedSimulation", height: float | None = None) -> Array:
    """Ends of the lines of sight (n, 3) [m] in the state shown; see :func:`line_of_sight`."""
    heights = [g.platform.height / 2 if height is None else height for g in simulation.team.groups]
    each = np.repeat(heights, [g.n for g in simulation.team.groups])
    places, turns = simulation.rays.bases()
    return places + each[:, None] * turns[:, :, 2]


class LineOfSight(Sensor):
    """Which robots, or points, each robot of a group sees; mounted in the world, each of the team.

    Lines run between single points, half the robots' height up unless told otherwise. Robots,
    props, walls and the floor are in the way, the two robots concerned are not. There is no limit
    of range.
    """

    name = "line_of_sight"
    stands = True

    def __init__(
        self,
        *,
        points: ArrayLike | None = None,
        height: float | None = None,
        rate: float = 10.0,
        latency: float = 0.0,
        phase: float = 0.0,
    ):
        """Set what is looked for, and the schedule.

        Args:
            points: (k, 3) [m], world frame; default: the robots of the whole team.
            height: Above the robots' origins [m]; default: half of each platform's height.
            rate: Reports a second [Hz].
            latency: [s].
            phase: Instant of the first report [s].

        Raises:
            InvalidInputError: Points of another shape, or a height that is not finite.
        """
        super().__init__(rate=rate, latency=latency, phase=phase)
        if height is not None and not np.isfinite(height):
            raise InvalidInputError(f"a height must be finite; got {height}")
        self._points, self._height = None if points is None else _points(points), height

    def read(self) -> Bools:
        """Newest report delivered by now: shape (n, team) or (n, k); nobody sees before the first.

        Rows are the group's robots, or the team's when mounted in the world.
        """
        return super().read()

    def prepare(self, sequence: np.random.SeedSequence, group: Any) -> None:
        """Nothing is random."""
        assert self._simulation is not None
        team = self._simulation.team
        self._rows = slice(0, team.n) if group is None else team.rows(group)

    def observe(self, time: float) -> Any:
        """Where everything is now."""
        assert self._simulation is not None
        return self._simulation.visible_state()

    def compute(self, state: Any, number: int) -> Bools:
        """Try the lines."""
        assert self._simulation is not None
        scene = self._simulation.rays
        scene.show(state)
        places = robot_points(self._simulation, self._height)
        robots = np.arange(len(places))
        starts, own = places[self._rows], robots[self._rows]
        if self._points is None:
            return scene.clear(starts, places, own, robots)
        return scene.clear(starts, self._points, own, np.full(len(self._points), -1))

    def nothing(self) -> Bools:
        """All False."""
        assert self._simulation is not None
        count = self._simulation.team.n if self._points is None else len(self._points)
        return np.zeros((self._rows.stop - self._rows.start, count), dtype=bool)


def _points(values: ArrayLike) -> Array:
    points = np.array(values, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 3 or not np.isfinite(points).all():
        raise InvalidInputError(f"points must be finite and of shape (k, 3); got {points.shape}")
    return points


def _robots(values: ArrayLike | None, count: int) -> NDArray[np.int64]:
    robots = np.full(count, -1) if values is None else np.array(values, dtype=np.int64)
    if robots.shape != (count,):
        raise InvalidInputError(f"give one robot a point, shape ({count},); got {robots.shape}")
    return robots
