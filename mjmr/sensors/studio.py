"""Studio: where the cameras of one simulation take their pictures, late and out of its way."""

from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from mjmr.cart_servos import CartServos
from mjmr.geometry import Pinhole, rotation_matrix
from mjmr.render import Renderer

if TYPE_CHECKING:
    from mjmr.loop import TickedSimulation


class Studio:
    """A private copy of the state, and one renderer for each size of picture.

    A simulation without MuJoCo gets a model here, compiled from its world at the first picture, in
    which the robots are placed.

    Attributes:
        model: Of the simulation, or the one compiled here.
        label_names: What each label of a segmentation stands for: the team's robots first, then the
            props in order of declaration, ``floor`` (with its lines), ``wall`` and ``other``.
    """

    def __init__(self, simulation: "TickedSimulation"):
        """Compile what is needed; opens no GL context yet."""
        world, team = simulation.world, simulation.team
        model: Any = getattr(simulation, "model", None)
        self._drives: list[Any] = []
        self._actuated = simulation.actuated
        if model is None:
            model = world.spec().compile()
            self._drives = [
                (team.rows(g), g.platform.bind(model, g.prefixes)) for g in world.groups
            ]
        self.model: mujoco.MjModel = model
        self._data: Any = mujoco.MjData(model)
        self._carts = CartServos(model, world)
        props = [name for name, _ in world.named_props()]
        self.label_names = (*team.names, *props, "floor", "wall", "other")
        self._labels = _labels(model, self.label_names, team.n)
        self._renderers: dict[tuple[int, int], Renderer] = {}

    def show(self, state: Any) -> None:
        """Put the scene as it was when ``simulation.visible_state()`` returned ``state``."""
        data, model = self._data, self.model
        if self._drives:
            time, poses, *parts = state
            for rows, drive in self._drives:
                drive.place(data, poses[rows])
            for sensor, moved in zip(self._actuated, parts, strict=False):
                sensor.place(data, moved)
            self._carts.place(data, time)
        else:
            data.qpos[:], data.mocap_pos[:], data.mocap_quat[:] = state
        mujoco.mj_kinematics(model, data)
        mujoco.mj_camlight(model, data)
        mujoco.mj_tendon(model, data)

    def picture(self, modality: str, camera: int, width: int, height: int) -> NDArray[Any]:
        """Picture of the scene shown; see :class:`mjmr.sensors.camera.Camera` for its type."""
        renderer = self._renderer(width, height)
        if modality == "rgb":
            return renderer.picture(self._data, camera)
        if modality == "depth":
            return renderer.depth(self._data, camera)
        return self._labels[renderer.geoms(self._data, camera)]

    def calibration(self, camera: int, width: int, height: int) -> Pinhole:
        """Camera number ``camera`` of the model in the frame of the body that carries it."""
        model = self.model
        rotation = rotation_matrix(model.cam_quat[camera]) * [1.0, -1.0, -1.0]
        focal = height / 2 / np.tan(np.radians(model.cam_fovy[camera]) / 2)
        return Pinhole(model.cam_pos[camera].copy(), rotation, float(focal), width, height)

    def close(self) -> None:
        """Free the GL contexts; the next picture opens new ones."""
        while self._renderers:
            self._renderers.popitem()[1].close()

    def _renderer(self, width: int, height: int) -> Renderer:
        size = (width, height)
        if size not in self._renderers:
            self._renderers[size] = Renderer(self.model, width, height)
        return self._renderers[size]


def _labels(model: Any, names: tuple[str, ...], robots: int) -> NDArray[np.int32]:
    """Label of every geom, and -1 at the end: geom -1, nothing, is -1."""
    label = {name: k for k, name in enumerate(names)}
    labels = np.full(model.ngeom + 1, -1, dtype=np.int32)
    for geom in range(model.ngeom):
        body = model.body(model.geom_bodyid[geom]).name
        own = model.geom(geom).name
        robot = label.get(body.split("/")[0], -1)
        if "/" in body and 0 <= robot < robots:
            labels[geom] = robot
        elif body != "world":
            labels[geom] = label.get(body, label["other"])
        elif own.startswith("wall_"):
            labels[geom] = label["wall"]
        else:
            # lines and stripes, drawn on the floor, have no names
            labels[geom] = label.get(own, label["other"] if own else label["floor"])
    return labels
