"""Stage: a private copy of a simulation's state, put up as it was when a sample was taken."""

from typing import TYPE_CHECKING, Any

import mujoco

from mjmr.cart_servos import CartServos
from mjmr.pillar import Pillars

if TYPE_CHECKING:
    from mjmr.loop import TickedSimulation


class Stage:
    """A model and data that show one visible state after another.

    A simulation without MuJoCo gets a model here, compiled from its world, in which the robots are
    placed.

    Attributes:
        model: Of the simulation, or the one compiled here.
        data: Private; where everything is in the state shown.
        time: Of the state shown [s].
        pillars: Whose radii at that time subclasses put where they need them: the model is not
            theirs.
    """

    def __init__(self, simulation: "TickedSimulation"):
        """Compile what is needed."""
        world, team = simulation.world, simulation.team
        model: Any = getattr(simulation, "model", None)
        self._drives: list[Any] = []
        # sensors that move parts of the robots
        self._actuated: list[Any] = getattr(simulation, "actuated", [])
        if model is None:
            model = world.spec().compile()
            self._drives = [
                (team.rows(g), g.platform.bind(model, g.prefixes)) for g in world.groups
            ]
        self.model: mujoco.MjModel = model
        self.data: Any = mujoco.MjData(model)
        self._carts = CartServos(model, world)
        self.pillars = Pillars(model)
        self.time = 0.0

    def show(self, state: Any) -> None:
        """Put everything where it was when ``simulation.visible_state()`` returned ``state``."""
        data, model = self.data, self.model
        self.time = state[0]
        if self._drives:
            time, poses, *parts = state
            for rows, drive in self._drives:
                drive.place(data, poses[rows])
            for sensor, moved in zip(self._actuated, parts, strict=False):
                sensor.place(data, moved)
            self._carts.place(data, time)
        else:
            data.qpos[:], data.mocap_pos[:], data.mocap_quat[:] = state[1:]
        mujoco.mj_kinematics(model, data)
