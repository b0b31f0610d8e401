"""Studio: where the cameras of one simulation take their pictures, late and out of its way."""

from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from mjmr.geometry import Pinhole, rotation_matrix
from mjmr.render import Renderer
from mjmr.sensors.stage import Stage

if TYPE_CHECKING:
    from mjmr.loop import TickedSimulation


class Studio(Stage):
    """A private copy of the state, and one renderer for each size of picture.

    Attributes:
        label_names: What each label of a segmentation stands for: the team's robots first, then the
            props in order of declaration, ``floor`` (with its lines), ``wall`` and ``other``.
    """

    def __init__(self, simulation: "TickedSimulation"):
        """Compile what is needed; opens no GL context yet."""
        super().__init__(simulation)
        world, team = simulation.world, simulation.team
        props = [name for name, _ in world.named_props()]
        self.label_names = (*team.names, *props, "floor", "wall", "other")
        self._labels = _labels(self.model, self.label_names, team.n)
        self._renderers: dict[tuple[int, int], Renderer] = {}

    def show(self, state: Any) -> None:
        """Put the scene as it was when ``simulation.visible_state()`` returned ``state``."""
        super().show(state)
        mujoco.mj_camlight(self.model, self.data)
        mujoco.mj_tendon(self.model, self.data)

    def picture(self, modality: str, camera: int, width: int, height: int) -> NDArray[Any]:
        """Picture of the scene shown; see :class:`mjmr.sensors.camera.Camera` for its type."""
        renderer = self._renderer(width, height)
        self.pillars.resize(renderer.model, self.time)
        if modality == "rgb":
            return renderer.picture(self.data, camera)
        if modality == "depth":
            return renderer.depth(self.data, camera)
        return self._labels[renderer.geoms(self.data, camera)]

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
            # a cylinder of 20 sides would be 1.2 % too small between its corners, and seen so
            sides = 360 if self.pillars.any else 0
            self._renderers[size] = Renderer(self.model, width, height, sides=sides)
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
