"""Films: recorded states rendered with overlays, side by side if there are several."""

import copy
import dataclasses
import math
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import cv2
import mujoco
import numpy as np
from numpy.typing import NDArray

from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.film_options import FilmOptions
from mjmr.finite import finite
from mjmr.footage import Footage
from mjmr.overlay import draw_notes, draw_text, draw_trails, palette
from mjmr.pillar import Pillars
from mjmr.recording import Recording
from mjmr.render import Renderer
from mjmr.video import VideoWriter

MAX_SECONDS = 60.0
Picture = NDArray[np.uint8]
_HEADER = 44
_TRAIL_POINTS = 400
_PILLAR_SIDES = 64  # of round shapes where there are large ones
_EYE_SIDES = 360  # the same from near


class Film:
    """Recordings shown side by side under one clock."""

    def __init__(self, title: str, options: FilmOptions | None = None):
        """Args: title: Written at the top. options: How it looks."""
        self.title, self.options = title, options or FilmOptions()
        self._panels: list[tuple[Any, ...]] = []

    def add(
        self,
        shown: Recording | Footage,
        label: str = "",
        area: Sequence[float] | None = None,
        **changes: Any,
    ) -> None:
        """Add a panel to the right of those there are: what has been recorded by now.

        Args:
            shown: Recording or footage.
            label: Written in its corner.
            area: What ``overview`` and ``corner`` show (xmin, ymin, xmax, ymax) [m] in place of the
                whole world.
            changes: Of the film's options, for this panel: ``camera``, ``follow`` and
                ``trail``.

        Raises:
            InvalidInputError: An area that is not four numbers, or is empty.
        """
        footage = shown.footage() if isinstance(shown, Recording) else shown
        if area is not None:
            footage = dataclasses.replace(footage, bounds=_bounds(area))
        own = dataclasses.replace(self.options, **changes)
        self._panels.append((_Panel, footage, label, own))

    def add_eye(
        self,
        shown: Recording | Footage,
        camera: str,
        label: str = "",
        paint: Callable[[Picture], Picture] | None = None,
        size: tuple[int, int] = (320, 240),
    ) -> None:
        """Add a panel of what a camera of the model sees, and below what is made of it.

        Args:
            shown: Recording or footage.
            camera: Its name in the model: ``robot0/eye`` for one mounted as ``eye``.
            label: Written in its corner.
            paint: Makes of a picture (h, w, 3) another one of the same shape; None: only one.
            size: Width and height of the pictures before they are fitted into the panel [px].

        Raises:
            UnknownNameError: The model has no such camera; lists those it has.
        """
        footage = shown.footage() if isinstance(shown, Recording) else shown
        model = footage.model
        names = [model.camera(k).name for k in range(model.ncam)]
        if camera not in names:
            raise UnknownNameError("camera of the model", camera, [n for n in names if n])
        self._panels.append((_EyePanel, footage, label, (camera, paint, size)))

    def write(self, path: str | Path) -> Path:
        """Render every frame and write the file; returns its path.

        Raises:
            MissingGLError: No off-screen OpenGL.
            InvalidInputError: No panel was added.
        """
        frames = self._frame_times()
        options = self.options
        with VideoWriter(path, options.width, options.height, options.fps) as video:
            for picture in self._pictures(frames):
                video.write(picture)
        return Path(path)

    def still(self, time: float) -> NDArray[np.uint8]:
        """The picture at ``time`` [s], RGB."""
        self._frame_times()
        return next(iter(self._pictures([time])))

    @property
    def speed(self) -> float:
        """Simulated seconds shown a second."""
        return self.options.speed or max(1.0, math.ceil(self._length() / MAX_SECONDS * 10) / 10)

    def _length(self) -> float:
        return max(float(r.times[-1] - r.times[0]) for _, r, _, _ in self._panels)

    def _frame_times(self) -> Sequence[float]:
        if not self._panels:
            raise InvalidInputError("a film needs at least one recording")
        seconds = min(self._length() / self.speed, MAX_SECONDS)
        start = float(self._panels[0][1].times[0])
        count = max(1, round(seconds * self.options.fps))
        return [start + k * self.speed / self.options.fps for k in range(count)]

    def _pictures(self, times: Sequence[float]) -> Iterator[NDArray[np.uint8]]:
        """Whole pictures; the next one is rendered while the caller encodes the last."""
        options, count = self.options, len(self._panels)
        width, height = options.width // count // 2 * 2, options.height - _HEADER
        panels = [
            _PanelThread(kind, r, label, width, height, own) for kind, r, label, own in self._panels
        ]
        try:
            ahead = [panel.picture(times[0]) for panel in panels]
            for k, time in enumerate(times):
                ready = [future.result() for future in ahead]
                if k + 1 < len(times):
                    ahead = [panel.picture(times[k + 1]) for panel in panels]
                canvas = np.full((options.height, options.width, 3), 24, dtype=np.uint8)
                for i, picture in enumerate(ready):
                    canvas[_HEADER:, i * width : (i + 1) * width] = picture
                clock = f"t = {time:6.2f} s   {self.speed:g} x"
                draw_text(canvas, self.title, (14, 29), 0.6)
                draw_text(canvas, clock, (options.width - 14, 29), 0.6, align="right")
                yield canvas
        finally:
            for panel in panels:
                panel.close()


class _PanelThread:
    """A panel and the one thread that may use its GL context."""

    def __init__(self, kind: Any, *arguments: Any):
        self._thread = ThreadPoolExecutor(max_workers=1)
        self._panel = self._thread.submit(kind, *arguments)

    def picture(self, time: float) -> "Future[NDArray[np.uint8]]":
        return self._thread.submit(lambda: self._panel.result().picture(time))

    def close(self) -> None:
        def end() -> None:
            if self._panel.exception() is None:
                self._panel.result().close()

        self._thread.submit(end)
        self._thread.shutdown()


def overview_camera(
    bounds: NDArray[np.float64], aspect: float, model: mujoco.MjModel
) -> mujoco.MjvCamera:
    """Camera above a world that just shows all of it, tilted 15 degrees off the vertical.

    Args:
        bounds: Of the world (4,) [m].
        aspect: Width over height of the picture.
        model: Whose global field of view the camera has.
    """
    size = bounds[2:] - bounds[:2]
    half = max(size[1] / 2 * 1.12, size[0] / 2 / aspect * 1.12)
    camera = mujoco.MjvCamera()
    camera.lookat[:2], camera.lookat[2] = (bounds[2:] + bounds[:2]) / 2, 0.0
    camera.distance = half / math.tan(math.radians(model.vis.global_.fovy / 2))
    camera.azimuth, camera.elevation = 90.0, -75.0
    return camera


def corner_camera(
    bounds: NDArray[np.float64], aspect: float, model: mujoco.MjModel
) -> mujoco.MjvCamera:
    """Camera that shows a whole world from above its lower left corner; see `overview_camera`."""
    camera = mujoco.MjvCamera()
    camera.azimuth, camera.elevation = 68.0, -47.0
    turn, slant = math.radians(camera.azimuth), math.radians(-camera.elevation)
    right = np.array([math.sin(turn), -math.cos(turn), 0.0])
    ahead = np.array([math.cos(turn) * math.cos(slant), math.sin(turn) * math.cos(slant),
                      -math.sin(slant)])  # fmt: skip
    middle = np.array([*(bounds[:2] + bounds[2:]) / 2, 0.3])
    x, y, z = np.meshgrid(bounds[[0, 2]], bounds[[1, 3]], [0.0, 1.0])
    corners = np.column_stack([x.ravel(), y.ravel(), z.ravel()]) - middle
    across = math.tan(math.radians(model.vis.global_.fovy / 2))
    wide = np.abs(corners @ right) / (across * aspect)
    high = np.abs(corners @ np.cross(right, ahead)) / across
    camera.distance = 1.04 * float((np.maximum(wide, high) - corners @ ahead).max())
    camera.lookat[:] = middle
    return camera


def _boxes_for_planes(model: mujoco.MjModel) -> None:
    """Draw finite planes as flat boxes: the same pixels seen from above, in 4/5 of the time."""
    thick = 0.01
    planes = (model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE) & (model.geom_size[:, :2] > 0).all(1)
    for k in np.flatnonzero(planes):
        up = np.empty(3)
        mujoco.mju_rotVecQuat(up, np.array([0.0, 0.0, 1.0]), model.geom_quat[k])
        model.geom_type[k] = mujoco.mjtGeom.mjGEOM_BOX
        model.geom_size[k, 2] = thick
        model.geom_pos[k] -= thick * up
        model.geom_sameframe[k] = mujoco.mjtSameFrame.mjSAMEFRAME_NONE
        model.geom_rbound[k] = np.linalg.norm(model.geom_size[k])


def _bounds(area: Sequence[float]) -> NDArray[np.float64]:
    """An area as bounds (4,)."""
    found = finite(area, (4,))
    if found is None or not (found[:2] < found[2:]).all():
        raise InvalidInputError(
            f"an area is (xmin, ymin, xmax, ymax) [m], the first two below the last two; got {area}"
        )
    return found


def _show(model: mujoco.MjModel, data: mujoco.MjData, footage: Footage, time: float) -> int:
    """Put everything where it was at ``time`` [s]; which sample of the footage that is."""
    index = min(int(np.searchsorted(footage.times, time - 1e-9)), len(footage.times) - 1)
    data.qpos[:] = footage.positions[index]
    mujoco.mj_kinematics(model, data)
    mujoco.mj_camlight(model, data)
    mujoco.mj_tendon(model, data)
    return index


class _Panel:
    """One recording in one rectangle."""

    def __init__(self, footage: Footage, label: str, width: int, height: int, options: FilmOptions):
        n = len(footage.radii)
        if options.camera == "chase" and not 0 <= options.follow < n:
            raise InvalidInputError(f"no robot {options.follow} to follow; valid: 0 to {n - 1}")
        self._footage, self._label, self._options = footage, label, options
        self._model = copy.copy(footage.model)
        if options.look == "draft":
            _boxes_for_planes(self._model)
        self._data = mujoco.MjData(self._model)
        self._pillars = Pillars(self._model)
        self._colours = palette(len(footage.radii))
        sides = _PILLAR_SIDES if self._pillars.any else 0
        self._renderer = Renderer(self._model, width, height, options.look, sides)
        self._azimuth: float | None = None
        whole = corner_camera if options.camera == "corner" else overview_camera
        self._whole = whole(footage.bounds, width / height, self._model)

    def picture(self, time: float) -> NDArray[np.uint8]:
        """Picture at ``time`` [s], RGB."""
        footage, model, data = self._footage, self._model, self._data
        times = footage.times
        index = _show(model, data, footage, time)
        poses = footage.poses[index]
        renderer = self._renderer
        self._pillars.resize(renderer.model, float(times[index]))
        image = renderer.picture(data, self._camera(index))
        view = renderer.view()
        rows = self._trail_rows(index)
        lifts = None if footage.lifts is None else footage.lifts[rows]
        draw_trails(image, view, footage.poses[rows, :, :2], self._colours, lifts)
        draw_notes(image, view, poses, footage.radii, footage.note(index), self._colours)
        heads = view.on_floor(poses[:, :2], z=0.16)
        for i, colour in enumerate(self._colours):
            draw_text(image, str(i), (heads[i, 0] + 14, heads[i, 1] - 10), 0.45, colour)
        draw_text(image, self._label, (14, 26), 0.6)
        draw_text(image, footage.caption(index), (14, renderer.height - 14), 0.55)
        return image

    def _trail_rows(self, index: int) -> NDArray[np.int64]:
        """Instants that trails go through, as far back as they last, oldest first."""
        poses, trail = self._footage.poses, self._options.trail
        steps = trail / self._footage.period
        back = 0 if steps >= index else index - round(steps)
        # thinned at fixed instants, so that an old trail does not shimmer as it grows
        every = max(3, math.ceil(len(poses) / _TRAIL_POINTS)) if steps > 400 else 3
        rows = np.arange(back + (-back) % every, index + 1, every)
        return np.append(rows, index)

    def _camera(self, index: int) -> str | mujoco.MjvCamera:
        options, tracks = self._options, self._footage.poses
        if options.camera != "chase":
            return self._whole
        robot = options.follow
        x, y, yaw = tracks[index, robot]
        # behind the direction of travel, which holonomic robots choose freely, turning slowly
        back = max(0, index - 10)
        move = tracks[index, robot, :2] - tracks[back, robot, :2]
        azimuth = yaw if self._azimuth is None else self._azimuth
        if np.hypot(*move) > 0.02:
            aim = math.atan2(move[1], move[0])
            share = 1.0 if self._azimuth is None else 0.06
            azimuth += share * math.remainder(aim - azimuth, 2 * math.pi)
        self._azimuth = azimuth
        camera = mujoco.MjvCamera()
        camera.lookat[:] = (x, y, 0.1)
        camera.distance, camera.elevation = 1.3, -28.0
        camera.azimuth = math.degrees(azimuth)
        return camera

    def close(self) -> None:
        self._renderer.close()


class _EyePanel:
    """What a camera of the model sees, and below it what is made of that."""

    def __init__(self, footage: Footage, label: str, width: int, height: int, options: Any):
        self._camera, self._paint, size = options
        self._footage, self._label = footage, label
        self._width, self._height = width, height
        model = footage.model
        self._data = mujoco.MjData(model)
        self._pillars = Pillars(model)
        sides = _EYE_SIDES if self._pillars.any else 0
        self._renderer = Renderer(model, *size, sides=sides)

    def picture(self, time: float) -> Picture:
        """Picture at ``time`` [s], RGB."""
        footage, data = self._footage, self._data
        index = _show(footage.model, data, footage, time)
        self._pillars.resize(self._renderer.model, float(footage.times[index]))
        seen = self._renderer.picture(data, self._camera)
        shown = [seen] if self._paint is None else [seen, self._paint(seen)]
        canvas = np.full((self._height, self._width, 3), 24, dtype=np.uint8)
        room = self._height // len(shown)
        scale = min(self._width / seen.shape[1], (room - 8) / seen.shape[0])
        w, h = round(seen.shape[1] * scale), round(seen.shape[0] * scale)
        left = (self._width - w) // 2
        for k, picture in enumerate(shown):
            top = k * room + (room - h) // 2
            canvas[top : top + h, left : left + w] = cv2.resize(
                picture, (w, h), interpolation=cv2.INTER_NEAREST
            )
        draw_text(canvas, self._label, (14, 26), 0.6)
        return canvas

    def close(self) -> None:
        self._renderer.close()
