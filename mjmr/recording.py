"""Recording: states of a run over time, with what the controller wants to show beside them."""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError, MjmrError
from mjmr.footage import Footage, lift_counts
from mjmr.watch import watching

if TYPE_CHECKING:
    from mjmr.loop import TickedSimulation

Array = NDArray[np.float64]


class Recording:
    """Positions of every robot and free prop after each control period, for films and traces.

    Attributes:
        world: What was simulated.
        team: Whose rows the arrays have.
        period: Between two records [s].
    """

    def __init__(self, simulation: "TickedSimulation", caption: Callable[[], str] | None = None):
        """Start recording.

        Args:
            simulation: What to record, from its present state on.
            caption: Called at every record for a line of text under the picture; it may read
                truth. None takes the simulation's own.
        """
        self.world, self.team = simulation.world, simulation.team
        self.period = simulation.control_period
        simulation.noted = True
        self._simulation = simulation
        self._times: list[float] = []
        self._poses: list[Array] = []
        self._movers: list[Array] = []
        self._positions: list[Array] = []
        self._parts: list[tuple[Any, ...]] = []
        self._notes: list[dict[str, Array]] = []
        self._captions: list[str] = []
        self._caption = caption
        self._lifts: list[tuple[float, int, Array]] = []
        simulation.lift_followers.append(self._follow)
        simulation.observe(self._capture)

    def note(self, **arrays: ArrayLike) -> None:
        """Say what to draw from now on; see :meth:`mjmr.loop.TickedSimulation.note`."""
        self._simulation.note(**arrays)

    def _follow(self, robots: NDArray[np.int64], poses: Array) -> None:
        time = self._simulation.time
        self._lifts.extend((time, int(i), p) for i, p in zip(robots, poses, strict=True))

    @property
    def lifts(self) -> list[tuple[float, int, Array]]:
        """Robots that were lifted: when [s], index in the team, where to (3,)."""
        return list(self._lifts)

    def _capture(self) -> None:
        simulation = self._simulation
        truth = simulation.truth
        self._times.append(simulation.time)
        self._poses.append(self.team.stack([truth.poses(g) for g in self.team.groups]))
        self._movers.append(truth.movers())
        positions = simulation.full_positions()
        if positions is not None:
            self._positions.append(positions)
        else:
            self._parts.append(simulation.moved_parts())
        self._notes.append(simulation.notes)
        self._captions.append((self._caption or simulation.caption)())

    def __len__(self) -> int:
        return len(self._times)

    @property
    def times(self) -> Array:
        """Instants [s], shape (k,)."""
        return np.array(self._times)

    @property
    def poses(self) -> Array:
        """Robots' poses, shape (k, n, 3)."""
        return np.stack(self._poses)

    @property
    def movers(self) -> Array:
        """Free props' poses, shape (k, m, 7)."""
        return np.stack(self._movers)

    @property
    def positions(self) -> Array | None:
        """Every coordinate of the physics, shape (k, nq); None of a kinematic simulation."""
        return np.stack(self._positions) if self._positions else None

    def footage(self) -> Footage:
        """What was recorded so far, as films show it.

        Raises:
            InvalidInputError: Nothing was recorded.
        """
        if not self._times:
            raise InvalidInputError("this recording is empty; tick its simulation first")
        model = getattr(self._simulation, "model", None) or self.world.spec().compile()
        positions = self.positions
        return Footage(
            model=model,
            bounds=self.world.bounds,
            radii=self.team.radii,
            period=self.period,
            times=self.times,
            positions=self._placed(model) if positions is None else positions,
            poses=self.poses,
            notes=list(self._notes),
            captions=list(self._captions),
            lifts=lift_counts(self.times, self.poses, self._lifts),
        )

    def _placed(self, model: Any) -> Array:
        """``qpos`` (k, nq) of a kinematic simulation: robots and props put where they were."""
        import mujoco

        from mjmr.cart_servos import CartServos
        from mjmr.prop_places import PropPlaces

        data = mujoco.MjData(model)
        team = self.team
        drives = [(team.rows(g), g.platform.bind(model, g.prefixes)) for g in team.groups]
        props = PropPlaces(model, self.world)
        carts = CartServos(model, self.world)
        positions = np.empty((len(self), model.nq))
        for k, (poses, movers) in enumerate(zip(self._poses, self._movers, strict=True)):
            for rows, drive in drives:
                drive.place(data, poses[rows])
            props.place(data, movers)
            carts.place(data, self._times[k])
            for sensor, moved in zip(self._simulation.actuated, self._parts[k], strict=True):
                sensor.place(data, moved)
            positions[k] = data.qpos
        return positions

    def notes(self, index: int) -> dict[str, Array]:
        """What was noted for record ``index``."""
        return self._notes[index]

    def caption(self, index: int) -> str:
        """Line of text of record ``index``."""
        return self._captions[index]


def record(trial: Callable[..., Any], condition: Mapping[str, Any], seed: int) -> Recording:
    """Run a trial and record the simulation it builds.

    Args:
        trial: ``(condition, seed) -> metrics``; see :meth:`mjmr.study.Study.bound_trial`.
        condition: A complete condition.
        seed: Of the trial.

    Raises:
        MjmrError: The trial builds no simulation.
    """
    kept: list[Recording] = []
    with watching(lambda simulation: kept.append(Recording(simulation))):
        trial(condition, seed)
    if not kept:
        raise MjmrError("there is nothing to record: the trial built no simulation")
    return kept[0]
