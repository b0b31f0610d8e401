"""Bumper: switches around every robot that close when something presses on its body."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mjmr.contacts import normal_forces
from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.robots.platform import FLOOR
from mjmr.sensors.base import Sensor, physics_of

if TYPE_CHECKING:
    from mjmr.group import Group

Flags = NDArray[np.bool_]


class Bumper(Sensor):
    """k switches, each a sector of the circle around the body; closed at a force or above.

    It feels the normal forces of contacts with anything but the floor and the robot itself, by the
    bearing of the place they act on; neither who presses nor how hard.

    By default a switch that closed in any physics step since the sample before counts, as the
    firmware of a real base polls its switches much faster than it reports them: a short bump is not
    missed. ``latch=False`` reads the switches at the instant of the sample alone.

    It needs forces: :class:`mjmr.simulation.Simulation`.
    """

    name = "bumper"

    def __init__(
        self,
        *,
        sectors: int = 8,
        start: float | None = None,
        threshold: float = 1.0,
        geoms: Sequence[str] = (),
        latch: bool = True,
        rate: float = 10.0,
        latency: float = 0.0,
        phase: float = 0.0,
    ):
        """Set schedule, sectors and force.

        Args:
            sectors: Number of switches, k.
            start: Bearing at which sector 0 begins; it goes anticlockwise [rad]. Default: half a
                sector to the right, so that the middle of sector 0 is straight ahead.
            threshold: Sum of the normal forces in a sector that closes its switch [N]; 1 N is
                assumed.
            geoms: Names of the shapes in the robot's model that carry the bumper; default: all.
            latch: Whether a switch that closed between two samples counts.
            rate: Reports a second [Hz].
            latency: [s].
            phase: Instant of the first report [s].

        Raises:
            InvalidInputError: No sector, a bearing that is not finite, or a force that is not
                positive.
        """
        super().__init__(rate=rate, latency=latency, phase=phase)
        if sectors != int(sectors) or sectors < 1:
            raise InvalidInputError(f"a bumper has 1 sector or more; got {sectors}")
        if not (threshold > 0 and math.isfinite(threshold)):
            raise InvalidInputError(
                f"a bumper's threshold must be positive and finite; got {threshold} N"
            )
        begin = -math.pi / sectors if start is None else float(start)
        if not math.isfinite(begin):
            raise InvalidInputError(f"the start of a bumper's sectors must be finite; got {start}")
        self.sectors, self.start, self.threshold = int(sectors), begin, float(threshold)
        self.latch = latch
        self._names = (geoms,) if isinstance(geoms, str) else tuple(geoms)

    def read(self) -> Flags:
        """Newest report delivered by now, shape (n, k): which switches were closed.

        All open before the first delivery.
        """
        return super().read()

    @property
    def reading_bounds(self) -> tuple[bool, bool]:
        """Least and largest value of a reading."""
        return False, True

    def prepare(self, sequence: np.random.SeedSequence, group: "Group") -> None:
        """Find out which shapes belong to whom; nothing is random.

        Raises:
            UnknownNameError: The robot has no shape named in ``geoms``.
        """
        simulation = physics_of(self, group)
        model = simulation.model
        self._simulation_physics: Any = simulation
        # the last entry is of geom -1, a flex
        self._robot, self._switch = _carriers(model, group.names, self._names)
        self._floor = np.zeros(model.ngeom + 1, dtype=bool)
        self._floor[model.geom(FLOOR).id] = True
        bodies = [model.body(i).name for i in range(model.nbody)]
        self._bases = np.array(
            [next(i for i, b in enumerate(bodies) if b.startswith(p)) for p in group.prefixes]
        )
        self._closed = self.nothing()
        if self.latch:
            simulation.watch_steps(self._poll)

    def observe(self, time: float) -> Any:
        """Switches closed now, or since the sample before."""
        if not self.latch:
            return self._pressed()
        closed, self._closed = self._closed, self.nothing()
        return closed

    def compute(self, state: Any, number: int) -> Flags:
        """As observed."""
        return state

    def nothing(self) -> Flags:
        """All open."""
        return np.zeros((self._group.n, self.sectors), dtype=bool)

    def state(self) -> Any:
        """What the sensor remembers, and the switches that have closed since the last sample."""
        return super().state(), self._closed.copy()

    def set_state(self, state: Any) -> None:
        """Put back what :meth:`state` returned."""
        samples, closed = state
        super().set_state(samples)
        self._closed = closed.copy()

    def _poll(self) -> None:
        if self._simulation_physics.data.ncon:
            self._closed |= self._pressed()

    def _pressed(self) -> Flags:
        """Switches that the contacts of the last physics step close (n, k)."""
        model, data = self._simulation_physics.model, self._simulation_physics.data
        force = np.zeros(self._group.n * self.sectors)
        pairs = data.contact.geom
        robots = self._robot[pairs]
        # with the floor, or within one robot
        touching = ~self._floor[pairs].any(axis=1) & (robots[:, 0] != robots[:, 1])
        touching &= self._switch[pairs].any(axis=1)
        if touching.any():
            forces, places = normal_forces(model, data)[touching], data.contact.pos[touching]
            pairs, robots = pairs[touching], robots[touching]
            for side in range(2):  # a contact may close switches of both robots
                mine = self._switch[pairs[:, side]]
                robot = robots[mine, side]
                body = self._bases[robot]
                away = places[mine] - data.xpos[body]
                # rows of R_body_world are the columns of xmat
                frame = data.xmat[body]
                x = (away * frame[:, 0::3]).sum(axis=1)
                y = (away * frame[:, 1::3]).sum(axis=1)
                turn = (np.arctan2(y, x) - self.start) / (2.0 * math.pi)
                # the remainder of a tiny negative turn may round to the whole circle
                sector = (turn % 1.0 * self.sectors).astype(np.int64) % self.sectors
                cell = robot * self.sectors + sector
                force += np.bincount(cell, weights=forces[mine], minlength=len(force))
        return (force >= self.threshold).reshape(self._group.n, self.sectors)


def _carriers(
    model: Any, robots: Sequence[str], names: Sequence[str]
) -> tuple[NDArray[np.int64], Flags]:
    """Index of the robot of each geom, -1 of none, and whether it carries the bumper."""
    index = {name: i for i, name in enumerate(robots)}
    robot = np.full(model.ngeom + 1, -1)
    switch = np.zeros(model.ngeom + 1, dtype=bool)
    own = [model.geom(i).name.partition("/")[2] for i in range(model.ngeom)]
    for geom in range(model.ngeom):
        owner = model.body(model.geom_bodyid[geom]).name.partition("/")[0]
        robot[geom] = index.get(owner, -1)
        switch[geom] = robot[geom] >= 0 and (not names or own[geom] in names)
    for name in names:
        if name not in {own[i] for i in np.flatnonzero(robot[:-1] >= 0)}:
            valid = [own[i] for i in np.flatnonzero(robot[:-1] == 0) if own[i]]
            raise UnknownNameError("shape of the robot's model", name, valid)
    return robot, switch
