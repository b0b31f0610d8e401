"""A safety filter: the velocities nearest to the wished ones that keep everybody apart.

Control barrier functions for single integrators: with h_ij = |p_i - p_j|^2 - D^2, velocities that
satisfy dh_ij/dt >= -gamma h_ij never let h become negative. Nearest velocities under these linear
rows are one quadratic program over the team. Source: L. Wang, A. D. Ames and M. Egerstedt, Safety
barrier certificates for collisions-free multirobot systems, IEEE T-RO 33(3), 2017, in the
single-integrator form with a linear class-K function. What a body cannot follow at once (its
acceleration, its turning) has to be in D.

Who is too near already (h < 0) has to separate. One pair that is deeper than top speed can answer
for makes the program of the whole team infeasible: then everybody brakes, and it is counted.
"""

from dataclasses import dataclass
from numbers import Integral
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError
from mjmr.finite import finite, numbers

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
_SIDES = 4  # pairs of opposite sides of the polygon inside the circle of top speed
_FREE = 1e6  # a row nobody feels: OSQP's infinity is 1e30, which would spoil its scaling
_SOLVED, _INACCURATE = 1, 2  # status of the solver
_MET = 1e-3  # by how much an inaccurate solution may miss a row


@dataclass(frozen=True, kw_only=True)
class BarrierConfig:
    """The filter's numbers.

    Attributes:
        distance: D, between the centres of two robots, margins included [m].
        clearance: From a robot's centre to the surface of obstacles, margins included [m].
        rate: gamma [1/s]: how fast a gap may be used up; at most 1 over the control period.
        top_speed: [m/s]; velocities stay in an octagon inside this circle.
        obstacles: Points of obstacles a robot that :meth:`BarrierFilter.filter` takes, at most.
        tolerance: Of the solver, absolute and relative.
        max_iterations: Of the solver.

    Raises:
        InvalidInputError: A number that is not positive, negative clearance, or obstacles or
            max_iterations that are no whole number.
    """

    distance: float
    clearance: float = 0.0
    rate: float = 2.0
    top_speed: float = 1.0
    obstacles: int = 0
    tolerance: float = 1e-4
    max_iterations: int = 4000

    def __post_init__(self):
        values = (self.distance, self.rate, self.top_speed, self.tolerance, self.max_iterations)
        if not min(values) > 0:
            raise InvalidInputError(
                "distance, rate, top_speed, tolerance and max_iterations must be positive; got "
                f"{', '.join(f'{v:g}' for v in values)}"
            )
        if not self.clearance >= 0:
            raise InvalidInputError(f"clearance is 0 or more; got {self.clearance} m")
        for name in ("obstacles", "max_iterations"):
            given = getattr(self, name)
            if not isinstance(given, Integral) or given < 0:
                raise InvalidInputError(f"{name} is a whole number, 0 or more; got {given}")


class BarrierFilter:
    """One quadratic program over n robots, set up once, updated in place and warm-started.

    Attributes:
        n: Robots.
        config: The numbers.
        solved: Ticks whose program was solved.
        infeasible: Ticks for which there was no safe set of velocities or none was found in time
            that misses no row by more than 1e-3: then everybody is told to stop.
        iterations: Of the solver in the last tick.
        changed: How far the last velocities are from the wished ones (n,) [m/s].
    """

    def __init__(self, n: int, config: BarrierConfig):
        """Set the program up.

        Args:
            n: 1 or more.
            config: The numbers.

        Raises:
            InvalidInputError: No robot.
        """
        if n < 1:
            raise InvalidInputError(f"a safety filter is for 1 robot or more; got {n}")
        import osqp  # a third of a second with scipy.sparse, for who filters alone
        import scipy.sparse as sparse

        self.n, self.config = n, config
        self.solved = self.infeasible = self.iterations = 0
        self.changed = np.zeros(n)
        self._i, self._j = np.triu_indices(n, 1)
        pairs, walls = len(self._i), n * config.obstacles
        robots = np.repeat(np.arange(n), config.obstacles)
        rows, columns = [], []
        for robot in (self._i, self._j):  # -2 d.u_i, then +2 d.u_j
            for axis in (0, 1):
                rows.append(np.arange(pairs))
                columns.append(2 * robot + axis)
        for axis in (0, 1):
            rows.append(pairs + np.arange(walls))
            columns.append(2 * robots + axis)
        sides = np.arange(n * _SIDES)
        angle = np.pi * (np.arange(_SIDES) + 0.5) / _SIDES
        speed = np.stack([np.cos(angle), np.sin(angle)])
        for axis in (0, 1):
            rows.append(pairs + walls + sides)
            columns.append(2 * (sides // _SIDES) + axis)
        self._speed = np.concatenate([np.tile(s, n) for s in speed])
        row, column = np.concatenate(rows), np.concatenate(columns)
        # stored entries in the order OSQP keeps them: by column, then by row
        self._order = np.lexsort((row, column))
        size = pairs + walls + n * _SIDES
        pointers = np.searchsorted(column[self._order], np.arange(2 * n + 1))
        self._matrix = sparse.csc_matrix(
            (np.ones(len(row)), row[self._order], pointers), shape=(size, 2 * n)
        )
        limit = config.top_speed * np.cos(np.pi / (2 * _SIDES))
        self._upper = np.full(size, _FREE)
        self._upper[pairs + walls :] = limit
        self._lower = np.full(size, -_FREE)
        self._lower[pairs + walls :] = -limit
        self._pairs, self._walls, self._wall_robots = pairs, walls, robots
        self._program = osqp.OSQP()
        self._program.setup(
            sparse.csc_matrix(np.eye(2 * n)), np.zeros(2 * n), self._matrix, self._lower,
            self._upper, verbose=False, warm_starting=True, eps_abs=config.tolerance,
            eps_rel=config.tolerance, max_iter=config.max_iterations, check_termination=5,
            polishing=False,
        )  # fmt: skip

    def filter(
        self, position: ArrayLike, wish: ArrayLike, obstacles: ArrayLike | None = None
    ) -> Array:
        """Velocities (n, 2) [m/s] nearest to ``wish`` that keep all apart.

        Args:
            position: (n, 2) [m].
            wish: (n, 2) [m/s], same axes.
            obstacles: Nearest points of what stands there (n, k, 2) [m], k at most the
                configuration's; NaN where there is none.

        Raises:
            InvalidInputError: Shapes that do not fit, or numbers that are not finite.
        """
        position, wish = self._array("position", position), self._array("wish", wish)
        config, pairs, walls = self.config, self._pairs, self._walls
        apart = position[self._i] - position[self._j]
        gap = (apart**2).sum(axis=1) - config.distance**2
        upper = self._upper.copy()
        # -2 d.(u_i - u_j) <= gamma h
        upper[:pairs] = config.rate * gap
        toward, room = self._obstacle_rows(position, obstacles)
        upper[pairs : pairs + walls] = np.where(np.isfinite(room), config.rate * room, _FREE)
        values = np.concatenate([
            -2 * apart[:, 0], -2 * apart[:, 1], 2 * apart[:, 0], 2 * apart[:, 1],
            toward[:, 0], toward[:, 1], self._speed,
        ])  # fmt: skip
        self._matrix.data[:] = values[self._order]
        self._program.update(q=-wish.ravel(), u=upper, Ax=self._matrix.data)
        found = self._program.solve(raise_error=False)
        self.iterations = int(found.info.iter)
        if not self._good(found, upper):
            self.infeasible += 1
            # what the solver remembers of an infeasible program leads nowhere
            self._program.warm_start(x=np.zeros(2 * self.n), y=np.zeros(len(upper)))
            velocity = np.zeros((self.n, 2))
        else:
            self.solved += 1
            velocity = np.array(found.x).reshape(self.n, 2)
        self.changed = np.hypot(*(velocity - wish).T)
        return velocity

    def _good(self, found: Any, upper: Array) -> bool:
        """Whether a solution is one; an inaccurate one only if it misses no row by much."""
        status, x = found.info.status_val, np.asarray(found.x)
        if status not in (_SOLVED, _INACCURATE) or not np.isfinite(x).all():
            return False
        if status == _SOLVED:
            return True
        rows = self._matrix @ x
        return bool((rows <= upper + _MET).all() and (rows >= self._lower - _MET).all())

    def _array(self, name: str, given: ArrayLike) -> Array:
        array = finite(given, (self.n, 2))
        if array is None:
            raise InvalidInputError(
                f"{name} must be finite and of shape ({self.n}, 2); got {_shape(given)}"
            )
        return array

    def _obstacle_rows(self, position: Array, obstacles: ArrayLike | None) -> tuple[Array, Array]:
        """Rows -2 (p - o).u <= gamma h of obstacles: vectors (n k, 2) and h (n k,), inf: none."""
        k = self.config.obstacles
        points = np.full((self.n, k, 2), np.nan)
        if obstacles is not None:
            given = numbers(obstacles)
            fits = given is not None and given.ndim == 3 and given.shape[::2] == (self.n, 2)
            if given is None or not fits or given.shape[1] > k:
                raise InvalidInputError(
                    f"obstacles have shape ({self.n}, k, 2), k at most {k}; got {_shape(obstacles)}"
                )
            points[:, : given.shape[1]] = given
        away = (position[:, None] - points).reshape(-1, 2)
        there = np.asarray(np.isfinite(away).all(axis=1))
        away = np.where(there[:, None], away, 0.0)
        room = np.where(there, (away**2).sum(axis=1) - self.config.clearance**2, np.inf)
        return -2 * away, room


def _shape(given: ArrayLike) -> str:
    found = numbers(given)
    return "what are no numbers in rows of one length" if found is None else str(found.shape)


def keep_right(position: Array, wish: Array, reach: float, angle: float) -> Array:
    """Wished velocities turned right while somebody is near ahead; breaks symmetric deadlocks.

    Ours: a team whose wishes are mirror images of each other stands still under any filter that
    treats all alike. Apply it before the filter.

    Args:
        position: (n, 2) [m].
        wish: (n, 2) [m/s].
        reach: Within which others count [m].
        angle: By how much to turn [rad], clockwise.
    """
    apart = position[None] - position[:, None]
    near = (apart**2).sum(axis=2) < reach**2
    np.fill_diagonal(near, False)
    ahead = np.einsum("ijk,ik->ij", apart, wish) > 0
    turned = (near & ahead).any(axis=1)
    c, s = np.cos(angle), np.sin(angle)
    right = np.column_stack([c * wish[:, 0] + s * wish[:, 1], c * wish[:, 1] - s * wish[:, 0]])
    return np.where(turned[:, None], right, wish)
