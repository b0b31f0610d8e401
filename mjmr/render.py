"""Off-screen pictures of a model: one renderer with the looks mjmr uses.

MuJoCo frees a context's objects by number in whichever context is current, so one that Python's
collector frees while another is drawing spoils that one's picture. Here a renderer nobody holds any
more is set aside and freed, made current first, before the next picture of its thread.
"""

import atexit
import copy
import functools
import threading
import weakref
from types import TracebackType
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from mjmr.errors import GL_ADVICE, MissingGLError, UnknownNameError
from mjmr.film_options import LOOKS
from mjmr.geometry import Pinhole

_HIDDEN = 5  # a group that no picture shows
_LAMP_QUADS = 8  # pieces along each side of a flat shape
# renderers set aside, with the threads that may free them
_forgotten: list[tuple[int, mujoco.Renderer]] = []
_open: "weakref.WeakSet[Renderer]" = weakref.WeakSet()


class Renderer:
    """Renders RGB pictures; ``draft`` without shadows and anti-aliasing, ``fine`` with both.

    Attributes:
        leaves_out: Whether what is wholly outside of a camera's view is kept from OpenGL; the
            pictures are the same, benchmarks compare.
        model: A copy of what was given.
        width: [px].
        height: [px].
    """

    leaves_out = True

    def __init__(
        self, model: mujoco.MjModel, width: int, height: int, look: str = "draft", sides: int = 0
    ):
        """Open an off-screen context.

        Args:
            model: What to render; it stays as it is.
            width: [px].
            height: [px].
            look: One of ``LOOKS``.
            sides: Of what stands for a circle; 0: what the look has.

        Raises:
            MissingGLError: No OpenGL; the message says what to install.
            UnknownNameError: Unknown look.
        """
        if look not in LOOKS:
            raise UnknownNameError("look", look, LOOKS)
        model = copy.copy(model)  # sizes and quality are set in it
        model.vis.global_.offwidth = max(width, 1)
        model.vis.global_.offheight = max(height, 1)
        quality = model.vis.quality
        quality.offsamples = 4 if look == "fine" else 0
        if look == "draft":
            # in software half of the time went into the triangles of round shapes and the floor
            quality.numslices, quality.numstacks = 20, 6
            # a lamp shades corners only, and what lies between is interpolated
            lamps = model.light_type != mujoco.mjtLightType.mjLIGHT_DIRECTIONAL
            quality.numquads = _LAMP_QUADS if lamps.any() else 1
            quality.shadowsize = 0  # the map would take 64 MiB in every context
        if sides:
            quality.numslices = sides
        _free_forgotten()
        try:
            self._renderer = mujoco.Renderer(model, height, width)
        except Exception as error:  # each GL backend raises its own kind
            raise MissingGLError(GL_ADVICE) from error
        keep = (threading.get_ident(), self._renderer)
        self._forget = weakref.finalize(self, _forgotten.append, keep)
        self._forget.atexit = False
        _open.add(self)
        _close_at_exit()
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
        self._aim(data, camera)
        return self._renderer.render()

    def depth(self, data: mujoco.MjData, camera: Any) -> NDArray[np.float32]:
        """Depth along the optical axis [m], shape (height, width); infinite where nothing is."""
        self._aim(data, camera)
        self._renderer.enable_depth_rendering()
        try:
            depth = self._renderer.render()
        finally:
            self._renderer.disable_depth_rendering()
        far = self.model.vis.map.zfar * self.model.stat.extent
        depth[depth > 0.999 * far] = np.inf
        return depth

    def geoms(self, data: mujoco.MjData, camera: Any) -> NDArray[np.int32]:
        """Geom seen by each pixel, shape (height, width); -1 where there is none."""
        self._aim(data, camera)
        self._renderer.enable_segmentation_rendering()
        try:
            seen = self._renderer.render()
        finally:
            self._renderer.disable_segmentation_rendering()
        return np.where(seen[..., 1] == mujoco.mjtObj.mjOBJ_GEOM, seen[..., 0], -1).astype(np.int32)

    def _aim(self, data: mujoco.MjData, camera: Any) -> None:
        _free_forgotten()
        groups = self.model.geom_group.copy()
        self._leave_out(data, camera)
        try:
            self._renderer.update_scene(data, camera, scene_option=self._option)
        finally:
            self.model.geom_group[:] = groups  # what one camera does not see another may
        flags = self._renderer.scene.flags
        flags[mujoco.mjtRndFlag.mjRND_SHADOW] = self._fine
        flags[mujoco.mjtRndFlag.mjRND_REFLECTION] = 0
        flags[mujoco.mjtRndFlag.mjRND_SKYBOX] = 0
        flags[mujoco.mjtRndFlag.mjRND_HAZE] = 0

    def _leave_out(self, data: mujoco.MjData, camera: Any) -> None:
        """Hide what is wholly outside of what a camera of the model sees.

        MuJoCo hands all shapes to OpenGL: of five trucks, seen by one with round shapes of 360
        sides, drawing took ten times as long. Where there are shadows, whoever casts one counts.
        """
        model = self.model
        named = isinstance(camera, (int, np.integer, str))
        if self._fine or not self.leaves_out or not named:
            return
        index = model.camera(camera).id
        perspective = model.cam_projection[index] == mujoco.mjtProjection.mjPROJ_PERSPECTIVE
        if not perspective or model.cam_sensorsize[index].any():
            return  # its view is no cone, or not about its axis
        turn = data.cam_xmat[index].reshape(3, 3)
        x, y, z = (data.geom_xpos - data.cam_xpos[index]).dot(turn).T
        up = np.radians(model.cam_fovy[index]) / 2.0
        aside = np.arctan(np.tan(up) * self.width / self.height)
        # MuJoCo's cameras look along -z; a little more than what is needed
        # planes have no bounding sphere: they may be seen from everywhere
        radii = np.where(model.geom_rbound > 0, model.geom_rbound, np.inf)
        reach = 1.01 * radii + 0.01
        seen = z < reach
        for across, angle in ((x, aside), (y, up)):
            seen &= np.abs(across) * np.cos(angle) + z * np.sin(angle) < reach
        model.geom_group[~seen] = _HIDDEN

    def view(self) -> Pinhole:
        """Camera of the last picture, in the world frame."""
        left, camera = self._renderer.scene.camera
        # MuJoCo draws a single picture from midway between its two eyes
        position = (np.array(left.pos, dtype=np.float64) + camera.pos) / 2.0
        forward = np.array(camera.forward, dtype=np.float64)
        down = -np.array(camera.up, dtype=np.float64)
        right = np.cross(down, forward)
        focal = 0.5 * self.height * camera.frustum_near / camera.frustum_top
        rotation = np.column_stack([right, down, forward])
        return Pinhole(position, rotation, float(focal), self.width, self.height)

    def close(self) -> None:
        """Free the context; closing again does nothing."""
        if self._forget.detach():
            _free(self._renderer)

    def __enter__(self) -> "Renderer":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()


def _free(renderer: mujoco.Renderer) -> None:
    context = renderer._gl_context  # pyright: ignore[reportAttributeAccessIssue]
    if context:
        context.make_current()
    renderer.close()


def _free_forgotten() -> None:
    here = threading.get_ident()
    for entry in [e for e in _forgotten if e[0] == here]:
        _forgotten.remove(entry)
        _free(entry[1])


@functools.cache
def _close_at_exit() -> None:
    """Free what is left when the process ends: EGL complains about contexts that outlive it.

    Called after the first context was opened, so that the hook runs before MuJoCo's own.
    """

    @atexit.register
    def _() -> None:
        for renderer in list(_open):
            renderer.close()
        _free_forgotten()
