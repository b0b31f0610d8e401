"""Worlds as dm_control environments, for its viewer and for reinforcement learning.

    from mjmr import Pioneer2DX, World, environment

    def build():
        world = World.rectangle(6.0, 6.0)
        world.add_group(Pioneer2DX, [[-2, -2, 0], [-2, 2, 0], [2, -2, 0], [2, 2, 0]])
        return world

    def reward(simulation):  # [1/s] for being near the middle
        poses = simulation.truth.poses(simulation.world.groups[0])
        return -np.hypot(*poses[:, :2].T).mean()

    env = environment(build, reward=reward, control_period=0.1, time_limit=20.0)
    step = env.reset()
    while not step.last():
        step = env.step(policy(step.observation))  # or dm_control.viewer.launch(env)

What advances is :meth:`Simulation.ticks`: one step of the environment is one control period, with
servo ramps, firmware frames, sensors at their own rates and the divergence guard.
"""

import math
from collections import OrderedDict
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import dm_env
import mujoco
import numpy as np
from dm_control.mujoco import Physics, wrapper
from dm_control.rl import control
from dm_env import specs
from numpy.typing import ArrayLike, NDArray

from mjmr.errors import InvalidInputError, SimulationDivergedError, UnknownNameError
from mjmr.randomness import Streams
from mjmr.simulation import Simulation
from mjmr.world import World

Array = NDArray[np.float64]
Reward = Callable[[Simulation], float]
Termination = Callable[[Simulation], bool]
Starts = Callable[[np.random.Generator], Mapping[str, ArrayLike]]
_FOREVER = 1e9  # [s] of simulated time


def environment(
    build: Callable[[], World],
    *,
    reward: Reward,
    termination: Termination | None = None,
    starts: Starts | None = None,
    observations: Sequence[str] | None = None,
    control_period: float = 0.1,
    dt_max: float = 0.005,
    time_limit: float = math.inf,
    seed: int = 0,
) -> "WorldEnvironment":
    """Make a world an environment.

    **Actions** are one flat array, ``env.action_spec()``: the commands of every group in order,
    robot by robot, bounded by what the platforms take; the spec's name says which entry is which,
    ``pioneer2dx0/forward`` and so on, separated by tabs. Reshape ``(n * c,)`` to ``(n, c)`` to have
    a group's commands. What a platform cannot do, though each entry is within bounds, is scaled
    down and counted as in :meth:`mjmr.group.Group.drive`.

    **Observations** are the newest readings of the sensors, ``group/sensor`` (``world/sensor`` of
    those that stand in the world), and ``group/command``, the commands in force; read-only arrays.
    The truth is not among them. Where a sensor delivers NaN (nothing yet, lost) so do they.

    **Episodes** begin alike but for the random streams, which depend on ``seed`` and the number of
    the episode alone: the k-th reset gives the same bits whatever was done before it. One whose
    physics diverges ends with :class:`SimulationDivergedError`, since there is nothing true to
    observe; the step after it begins the next.

    Args:
        build: Makes the world; called once.
        reward: Of the control period just over. It is given the simulation and may read its
            ``truth``.
        termination: Whether the episode ends here (with discount 0), likewise.
        starts: Draws start poses (n, 3) by the groups' names from the episode's own stream.
        observations: Names of those wanted; by default all, cameras included.
        control_period: Between two steps [s].
        dt_max: Largest timestep of the physics [s].
        time_limit: Of an episode [s]; then it ends with discount 1.
        seed: Of every random stream.

    Raises:
        UnknownNameError: An observation there is not; lists those there are.
        InvalidInputError: What the world, the simulation or a time limit cannot be.
    """
    if not time_limit > 0:
        raise InvalidInputError(f"a time limit must be positive; got {time_limit} s")
    physics = WorldPhysics(build(), starts, seed, control_period, dt_max)
    task = WorldTask(physics.simulation, reward, termination, observations)
    # dm_control counts steps up to a quotient that rounding may lift over a whole number
    return WorldEnvironment(
        physics,
        task,
        time_limit=time_limit * (1.0 - 1e-9),
        n_sub_steps=physics.simulation.substeps,
    )


class WorldPhysics(Physics):
    """dm_control's view of the model and data that a simulation has; the same, not copies.

    A ``copy()`` has no simulation and steps bare MuJoCo.

    Attributes:
        simulation: Of the present episode.
        episode: Its number; -1 before the first reset.
    """

    simulation: Any = None
    episode = -1

    def __init__(
        self, world: World, starts: Starts | None, seed: int, control_period: float, dt_max: float
    ):
        """Compile the world; see :func:`environment`."""
        self._world, self._starts, self._streams = world, starts, Streams(seed)
        self._home = {group.name: group.start for group in world.groups}
        self.simulation = Simulation(world, control_period=control_period, dt_max=dt_max)
        self._ticks: Iterator[float] = iter(())
        super().__init__(wrapper.MjData(self.simulation.data))

    def reset(self, keyframe_id: int | None = None) -> None:
        """Begin the next episode: a new simulation that adopts model and data."""
        if self.simulation is None:
            super().reset(keyframe_id)
            return
        if keyframe_id is not None:
            raise InvalidInputError("an episode begins at the robots' starts, not at a keyframe")
        self.episode += 1
        stream, old = f"episode{self.episode}", self.simulation
        self._ticks = iter(())
        old.close()
        if self._starts is not None:
            self._world.start_at(self._home)
            self._world.start_at(self._starts(self._streams.generator(f"{stream}/starts")))
        mujoco.mj_resetData(old.model, old.data)
        self.simulation = Simulation(
            self._world,
            seed=int(self._streams.sequence(stream).generate_state(1)[0]),
            control_period=old.control_period,
            model=old.model,
            data=old.data,
        )

    def after_reset(self) -> None:
        """Take the first samples and wait for the first command."""
        if self.simulation is None:
            super().after_reset()
            return
        self._ticks = self.simulation.ticks(_FOREVER)
        next(self._ticks)

    def step(self, nstep: int = 1) -> None:
        """Advance by one control period, which is ``nstep`` timesteps.

        Raises:
            InvalidInputError: Another number of timesteps, or no episode is under way.
            SimulationDivergedError: The physics left the plausible range.
        """
        if self.simulation is None:
            super().step(nstep)
            return
        if nstep != self.simulation.substeps:
            raise InvalidInputError(
                f"this physics steps by whole control periods, {self.simulation.substeps} "
                f"timesteps; got {nstep}"
            )
        if next(self._ticks, None) is None:
            raise InvalidInputError("no episode is under way; reset the environment first")


class WorldTask(control.Task):
    """Commands in, sensor readings out, reward and termination in between."""

    def __init__(
        self,
        simulation: Simulation,
        reward: Reward,
        termination: Termination | None,
        observations: Sequence[str] | None,
    ):
        """Lay out actions and observations; see :func:`environment`."""
        self._reward, self._termination = reward, termination
        self._groups = simulation.world.groups
        self._action_spec = _action_spec(simulation)
        self._splits = np.cumsum([g.command.size for g in self._groups])[:-1]
        found = _observations(simulation)
        names = list(found) if observations is None else list(observations)
        for name in names:
            if name not in found:
                raise UnknownNameError("observation", name, found)
        self._specs = OrderedDict((name, found[name][0]) for name in names)
        self._read = [(name, found[name][1]) for name in names]
        self._verdict: tuple[float, float | None] = (0.0, None)

    def initialize_episode(self, physics: WorldPhysics) -> None:
        """Judge the end of every control period, before a policy is to act and truth is shut."""
        simulation = physics.simulation

        def judge() -> None:
            if simulation.step:
                self._verdict = (self._rewarded(simulation), self._over(simulation))

        simulation.observe(judge)

    def before_step(self, action: ArrayLike, physics: WorldPhysics) -> None:
        """Radio the commands.

        Raises:
            InvalidInputError: Another shape, or NaN or infinity (names the robots).
        """
        flat = np.asarray(action, dtype=np.float64)
        if flat.shape != self._action_spec.shape:
            raise InvalidInputError(
                f"an action must have shape {self._action_spec.shape}; got {flat.shape}"
            )
        for group, part in zip(self._groups, np.split(flat, self._splits), strict=True):
            group.drive(part.reshape(group.command.shape))

    # dm_control's own methods here have no bodies, which pyright takes for returning None
    def action_spec(  # pyright: ignore[reportIncompatibleMethodOverride]
        self, physics: WorldPhysics
    ) -> specs.BoundedArray:
        """Every group's commands, one after the other."""
        return self._action_spec

    def observation_spec(self, physics: WorldPhysics) -> "OrderedDict[str, specs.Array]":
        """By name."""
        return self._specs

    def get_observation(  # pyright: ignore[reportIncompatibleMethodOverride]
        self, physics: WorldPhysics
    ) -> "OrderedDict[str, NDArray[Any]]":
        """By name."""
        return OrderedDict((name, read()) for name, read in self._read)

    def get_reward(  # pyright: ignore[reportIncompatibleMethodOverride]
        self, physics: WorldPhysics
    ) -> float:
        """Of the control period just over."""
        return self._verdict[0]

    def get_termination(  # pyright: ignore[reportIncompatibleMethodOverride]
        self, physics: WorldPhysics
    ) -> float | None:
        """The final discount, or None to go on."""
        return self._verdict[1]

    def _rewarded(self, simulation: Simulation) -> float:
        reward = float(self._reward(simulation))
        if not math.isfinite(reward):
            raise InvalidInputError(f"a reward must be finite; got {reward}")
        return reward

    def _over(self, simulation: Simulation) -> float | None:
        if self._termination is None:
            return None
        over = self._termination(simulation)
        if not isinstance(over, bool | np.bool_):
            raise InvalidInputError(f"a termination is True or False; got {over!r}")
        return 0.0 if over else None


class WorldEnvironment(control.Environment):
    """What :func:`environment` makes."""

    def step(self, action: ArrayLike) -> dm_env.TimeStep:
        """Drive for one control period.

        Raises:
            InvalidInputError: An action of another shape, or not finite (names the robots).
            SimulationDivergedError: The episode cannot go on; the next step begins another.
        """
        try:
            return super().step(action)
        except SimulationDivergedError:
            self._reset_next_step = True
            raise

    def close(self) -> None:
        """Free the GL contexts of the world's cameras."""
        self.physics.simulation.close()


def _action_spec(simulation: Simulation) -> specs.BoundedArray:
    groups = simulation.world.groups
    bounds = [np.tile(g.platform.command_bounds, (1, g.n)) for g in groups]
    names = [f"{robot}/{c}" for g in groups for robot in g.names for c in g.platform.command_names]
    low, high = np.concatenate(bounds, axis=1)
    return specs.BoundedArray((len(names),), np.float64, low, high, name="\t".join(names))


def _observations(
    simulation: Simulation,
) -> dict[str, tuple[specs.Array, Callable[[], NDArray[Any]]]]:
    """Spec and reader of everything a policy may see, by name."""
    found = {}
    world = simulation.world
    owners: list[tuple[str, Any]] = [*((g.name, g) for g in world.groups), ("world", world)]
    for owner, has in owners:
        for key, sensor in has.sensors.items():
            name, blank = f"{owner}/{key}", sensor.nothing()
            found[name] = _bounded(name, blank, *sensor.reading_bounds), sensor.read
        if has is not world:
            name = f"{owner}/command"
            spec = _bounded(name, has.command, *has.platform.command_bounds)
            found[name] = spec, lambda group=has: group.command
    return found


def _bounded(name: str, blank: NDArray[Any], low: ArrayLike, high: ArrayLike) -> specs.Array:
    """Spec of arrays like ``blank``, bounded if anything of them is."""
    if np.isinf(low).all() and np.isinf(high).all():
        return specs.Array(blank.shape, blank.dtype, name=name)
    if blank.dtype.kind in "iu":  # whole numbers have no infinity
        kind = np.iinfo(blank.dtype)
        low, high = np.maximum(low, kind.min), np.minimum(high, kind.max)
    return specs.BoundedArray(blank.shape, blank.dtype, low, high, name=name)
