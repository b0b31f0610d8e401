"""Off-screen pictures of a model: one renderer with the looks mjmr uses."""

from types import TracebackType
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from mjmr.errors import GL_ADVICE, MissingGLError, UnknownNameError
from mjmr.film_options import LOOKS


class Renderer:
    """Renders RGB pictures; ``draft`` without shadows and anti-aliasing, ``fine`` with both."""

    def __init__(self, model: mujoco.MjModel, width: int, height: int, look: str = "draft"):
        """Open an off-screen context.

        Args:
            model: What to render; its off-screen buffer size and samples are set here.
            width: [px].
            height: [px].
            look: One of ``LOOKS``.

        Raises:
            MissingGLError: No OpenGL; the message says what to install.
            UnknownNameError: Unknown look.
        """
        if look not in LOOKS:
            raise UnknownNameError("look", look, LOOKS)
        model.vis.global_.offwidth = max(width, 1)
        model.vis.global_.offheight = max(height, 1)
        quality = model.vis.quality
        quality.offsamples = 4 if look == "fine" else 0
        if look == "draft":
            # in software half of the time went into the triangles of round shapes and the floor
            quality.numslices, quality.numstacks, quality.numquads = 20, 6, 1
            quality.shadowsize = 0  # the map would take 64 MiB in every context
        try:
            self._renderer = mujoco.Renderer(model, height, width)
        except Exception as error:  # each GL backend raises its own kind
            raise MissingGLError(GL_ADVICE) from error
        self.model, self.width, self.height = model, width, height
        self._fine = look == "fine"
        self._option = mujoco.MjvOption()
        self._option.geomgroup[:] = (1, 1, 0, 0, 0, 0)
        self._option.sitegroup[:] = 0

    def picture(self, data: mujoco.MjData, camera: Any) -> NDArray[np.uint8]:
        """RGB picture, shape (height, width, 3), a new array.

        Args:
            data: State whose kinematics are up to date.
            camera: Name or index of a model's camera, or an ``mujoco.MjvCamera``.
        """
        self._renderer.update_scene(data, camera, scene_option=self._option)
        flags = self._renderer.scene.flags
        flags[mujoco.mjtRndFlag.mjRND_SHADOW] = self._fine
        flags[mujoco.mjtRndFlag.mjRND_REFLECTION] = 0
        flags[mujoco.mjtRndFlag.mjRND_SKYBOX] = 0
        flags[mujoco.mjtRndFlag.mjRND_HAZE] = 0
        return self._renderer.render()

    def view(self) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
        """Camera of the last picture: position (3,), rotation (3, 3), focal length [px].

        The rotation's columns are the image's right, down and forward in the world frame.
        """
        left, camera = self._renderer.scene.camera
        # MuJoCo draws a single picture from midway between its two eyes
        position = (np.array(left.pos, dtype=np.float64) + camera.pos) / 2.0
        forward = np.array(camera.forward, dtype=np.float64)
        down = -np.array(camera.up, dtype=np.float64)
        right = np.cross(down, forward)
        focal = 0.5 * self.height * camera.frustum_near / camera.frustum_top
        return (
            position,
            np.column_stack([right, down, forward]),
            float(focal),
        )

    def close(self) -> None:
        """Free the context."""
        self._renderer.close()

    def __enter__(self) -> "Renderer":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()
