"""KinematicSimulation: commands executed exactly, no contact, no MuJoCo.

It serves what a paper itself simulated without dynamics; every table names it where it was used.
"""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mjmr.loop import TickedSimulation
from mjmr.ramp import integrate_ramp

if TYPE_CHECKING:
    from mjmr.group import Group
    from mjmr.world import World

Array = NDArray[np.float64]


class KinematicSimulation(TickedSimulation):
    """Every robot's twist ramps linearly, in its body frame, to its command in one period.

    Bodies pass through each other, walls and boxes; free props stay where they are, carts go their
    way exactly.
    """

    def __init__(
        self,
        world: "World",
        *,
        seed: int = 0,
        control_period: float = 1 / 60,
        dt_max: float = 0.005,
    ):
        """Start at the groups' start poses, at rest.

        Args:
            world: What is simulated.
            seed: Of every random stream of the trial.
            control_period: Between two ticks [s].
            dt_max: Sensors are sampled on a grid of at most this step [s].
        """
        super().__init__(world, seed=seed, control_period=control_period, dt_max=dt_max)
        team = self.team
        self._rows = {id(g): team.rows(g) for g in team.groups}
        self._pose = team.stack([g.start for g in team.groups]).copy()
        self._twist = np.zeros_like(self._pose)
        self._rate = np.zeros_like(self._pose)
        self._pace = np.zeros_like(self._pose)
        self._way = np.zeros_like(self._pose)
        self._bind()

    def poses_of(self, group: "Group") -> Array:
        """True poses (n, 3)."""
        return self._pose[self._rows[id(group)]].copy()

    def twists_of(self, group: "Group") -> Array:
        """True twists (n, 3), body frame."""
        return self._twist[self._rows[id(group)]].copy()

    def wheel_angles_of(self, group: "Group") -> Array:
        """Angles of the wheels (n, k) [rad] that roll without slip."""
        return group.platform.wheel_turns(self._way[self._rows[id(group)]])

    def mover_poses(self) -> Array:
        """Poses (k, 7) of the free props: where they were put."""
        rows = []
        for _, prop in self.world.movers:
            yaw = getattr(prop, "yaw", 0.0)
            z = getattr(prop, "height", 0.0) / 2 or getattr(prop, "radius", 0.0)
            rows.append([prop.x, prop.y, z, np.cos(yaw / 2), 0.0, 0.0, np.sin(yaw / 2)])
        return np.array(rows, dtype=np.float64).reshape(-1, 7)

    def cart_boxes(self) -> Array:
        """Carts as boxes (k, 5)."""
        rows = [cart.box(cart.along(self.time)[0]) for _, cart in self.world.carts]
        return np.array(rows).reshape(-1, 5)

    def visible_state(self) -> tuple[Any, ...]:
        """Time, which places the carts, poses of the whole team (n, 3), and parts that move."""
        return self.time, self._pose.copy(), *self.moved_parts()

    def _lift(self, group: "Group", rows: Any, poses: Array) -> None:
        where = np.arange(self.team.n)[self._rows[id(group)]][rows]
        self._pose, self._twist, self._pace = (
            _replaced(array, where, value)
            for array, value in ((self._pose, poses), (self._twist, 0.0), (self._pace, 0.0))
        )

    def _begin_period(self) -> None:
        team, time, period = self.team, self.time, self.control_period
        platforms = [g.platform for g in team.groups]
        ramps = [
            tuple(p.mistuned(command) for command in g.next_ramp(time, period))
            for p, g in zip(platforms, team.groups, strict=True)
        ]
        pairs = list(zip(platforms, ramps, strict=True))
        self._twist = team.stack([p.twist_of(start) for p, (start, _) in pairs])
        self._target = team.stack([p.twist_of(target) for p, (_, target) in pairs])
        self._rate = (self._target - self._twist) / period
        # what wheels count, which is not the twist of every robot
        self._pace = team.stack([p.pace_of(start) for p, (start, _) in pairs])
        self._pace_target = team.stack([p.pace_of(target) for p, (_, target) in pairs])
        self._pace_rate = (self._pace_target - self._pace) / period
        for sensor in self.actuated:
            sensor.actuate(None, period)

    def _advance(self, steps: int) -> None:
        dt = self.control_period if steps == self.substeps else steps * self.timestep
        end = self._target if steps == self.substeps else self._twist + self._rate * dt
        self._pose = integrate_ramp(self._pose, self._twist, end, dt)
        pace = self._pace_target if steps == self.substeps else self._pace + self._pace_rate * dt
        self._way = self._way + (self._pace + pace) * (dt / 2.0)
        self._twist, self._pace = end, pace

    def _end_period(self) -> None:
        """Nothing to check: finite commands move finite poses."""

    def _physics_state(self) -> Array:
        return np.stack([self._pose, self._twist, self._pace, self._way])

    def _set_physics_state(self, state: Array) -> None:
        self._pose, self._twist, self._pace, self._way = (part.copy() for part in state)


def _replaced(array: Array, rows: Any, values: Any) -> Array:
    """A copy with other rows: what was an array before may be shared with groups."""
    fresh = array.copy()
    fresh[rows] = values
    return fresh
