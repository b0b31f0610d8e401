"""Meters: what happened between bodies, from truth; never seen by a controller."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mjmr.overlap import overlap

if TYPE_CHECKING:
    from mjmr.kinematics import KinematicSimulation
    from mjmr.simulation import Simulation

Array = NDArray[np.float64]


class OverlapMeter:
    """Interpenetration depth times the time spent in it, in a kinematic simulation.

    The metric of Bruce and Veloso 2005, section 5, summed over robot pairs and, apart, over
    robots and boxes or walls. Each control period is a known ramp: whether two robots overlap in
    it, and how deep, is exact; the integral over time is taken at ``samples`` instants (midpoint
    rule), as are depths in fixed things.

    Attributes:
        robots: Over robot pairs [m s].
        outsiders: Over pairs with an outsider, not counted in ``robots`` [m s].
        obstacles: Over robots and boxes, carts or walls [m s].
        deepest: Deepest overlap of a pair seen, outsiders apart [m].
        last_overlap: Last instant at which a pair overlapped [s]; NaN if none did.
    """

    def __init__(
        self, simulation: "KinematicSimulation", samples: int = 8, outsiders: Sequence[int] = ()
    ):
        """Watch.

        Args:
            simulation: What to watch.
            samples: Instants a control period.
            outsiders: Robots of the team, by index, whose pairs are counted apart.
        """
        self._simulation, self._samples = simulation, samples
        team = simulation.team
        self._radii = team.radii
        self._outside = _mask(team.n, outsiders)
        self._boxes, self._bounds = simulation.world.boxes, simulation.world.bounds
        self._carts = bool(simulation.world.carts)
        self.robots = self.outsiders = self.obstacles = self.deepest = 0.0
        self.last_overlap = np.nan
        self._previous: tuple[Array, Array] | None = None
        self._before = self._boxes
        simulation.observe(self._measure)

    def _measure(self) -> None:
        simulation = self._simulation
        team, truth = simulation.team, simulation.truth
        pose = team.stack([truth.poses(g) for g in team.groups])
        twist = team.stack([truth.twists(g) for g in team.groups])
        boxes = self._boxes
        if self._carts:
            boxes = np.concatenate([boxes, truth.carts()])
        if self._previous is not None:
            pairs, depth, apart, fixed = overlap(
                *self._previous, twist, self._radii, self._outside, self._before, boxes,
                self._bounds, simulation.control_period, self._samples,
            )  # fmt: skip
            self.obstacles += fixed
            self.outsiders += apart
            if pairs > 0.0:
                self.robots += pairs
                self.deepest = max(self.deepest, depth)
                self.last_overlap = simulation.time
        self._previous, self._before = (pose, twist), boxes


def _mask(n: int, indices: Sequence[int]) -> NDArray[np.bool_]:
    mask = np.zeros(n, dtype=bool)
    mask[list(indices)] = True
    return mask


class ContactMeter:
    """Time and impulse of contacts, seen at every physics step.

    Attributes:
        robots: Time in contact summed over robot pairs [s].
        outsiders: The same over pairs with an outsider, not counted in ``robots`` [s].
        obstacles: Time in contact summed over robots touching a wall, fixed box or cart [s].
        robot_impulse: Normal impulse summed over robot pairs [N s].
        obstacle_impulse: The same over robots and walls or boxes [N s].
        episodes: Robot-robot contacts begun.
    """

    def __init__(self, simulation: "Simulation", outsiders: Sequence[int] = ()):
        """Watch.

        Args:
            simulation: What to watch.
            outsiders: Robots of the team, by index, whose pairs are counted apart.
        """
        import mujoco

        self._data = simulation.data
        self._dt = simulation.timestep
        model = simulation.model
        robots = np.full(model.nbody, -1, dtype=np.int64)
        for i, name in enumerate(simulation.team.names):
            for body in range(model.nbody):
                if model.body(body).name.startswith(f"{name}/"):
                    robots[body] = i
        self._robot = robots[model.geom_bodyid]
        fixed = (model.geom_bodyid == 0) & (model.geom_type != mujoco.mjtGeom.mjGEOM_PLANE)
        carts = [model.geom(name).id for name, _ in simulation.world.carts]
        fixed[carts] = True
        self._fixed = fixed
        self._outsiders = frozenset(outsiders)
        self.robots = self.outsiders = self.obstacles = 0.0
        self.robot_impulse = self.obstacle_impulse = 0.0
        self.episodes = 0
        self._touching: set[tuple[int, int]] = set()
        simulation.watch_steps(self._measure)

    def _measure(self) -> None:
        data = self._data
        if data.ncon == 0:
            self._touching = set()
            return
        contact = data.contact
        geom = contact.geom
        first, second = self._robot[geom[:, 0]], self._robot[geom[:, 1]]
        near = contact.dist <= 0.0
        pair = near & (first >= 0) & (second >= 0)
        wall = near & (
            ((first >= 0) & self._fixed[geom[:, 1]]) | ((second >= 0) & self._fixed[geom[:, 0]])
        )
        touching: set[tuple[int, int]] = set()
        if pair.any():
            low, high = np.minimum(first, second)[pair], np.maximum(first, second)[pair]
            touching = set(zip(low.tolist(), high.tolist(), strict=True))
            apart = sum(not self._outsiders.isdisjoint(pair) for pair in touching)
            self.outsiders += apart * self._dt
            self.robots += (len(touching) - apart) * self._dt
            self.robot_impulse += self._normal_force(pair) * self._dt
            self.episodes += len(touching - self._touching)
        self._touching = touching
        if wall.any():
            robot = np.maximum(first, second)[wall]
            self.obstacles += len(set(robot.tolist())) * self._dt
            self.obstacle_impulse += self._normal_force(wall) * self._dt

    def _normal_force(self, chosen: NDArray[np.bool_]) -> float:
        # with elliptic cones the first row of a contact is its normal force
        address = self._data.contact.efc_address[chosen]
        return float(self._data.efc_force[address[address >= 0]].sum())
